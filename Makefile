# `make` alone only lists the targets: pack_install runs it, and after it
# `make check` and `make install`.

SWIPL ?= swipl
# Of the experiments: one figure or all, runs of each case, runs at a time.
FIGURE ?= all
RUNS ?= 3
JOBS ?= 3
# Of what attacks: how long, or how many inputs, and the seed.
SECONDS ?= 600
COUNT ?= 100000
SEED ?= 1
MAKEFLAGS += --no-print-directory
ENTRY_POINTS = prolog/typhon.pl app/typhon.pl test/run.pl \
    $(wildcard experiments/*.pl bench/run.pl)
# check/0 without the options of predicates: for read_term/3, 9.2.9 has
# the types wrong.
CHECKS = list_undefined, list_trivial_fails, list_format_errors, \
    list_redefined, list_void_declarations, list_autoload

.PHONY: help tools tools-all demo demo-robots experiments \
    experiments-allocation experiments-learning experiments-sieve \
    experiments-sync test chaos fuzz check bench test-portability install \
    clean

help:
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | \
	    while IFS='	' read -r target text; do \
	        printf '  make %-22s %s\n' "$$target" "$$text"; \
	    done

demo: tools             ## sixty hosts, ten agents, six tasks in step
	@$(SWIPL) experiments/synchronisation.pl -- --out out/demo

demo-robots: tools      ## simulated robots carry a pole, and push boxes
	@$(SWIPL) experiments/robots.pl -- --out out/robots

experiments: experiments-sync experiments-sieve ## all; what has been run stays
experiments: experiments-learning experiments-allocation

experiments-sync: tools ## chapters 5 and 6; one figure: FIGURE=5.6, RUNS=3, JOBS=3
	@case '$(FIGURE)' in 6.3*|6.4*) ;; *) \
	    $(SWIPL) experiments/figures.pl -- --figure '$(FIGURE)' \
	        --runs $(RUNS) --jobs $(JOBS) ;; esac
	@for figure in 6.3 6.4; do \
	    case '$(FIGURE)' in all|$$figure*) \
	        $(SWIPL) experiments/population.pl -- --figure $$figure \
	            --nodes 50,100 --runs $(RUNS) --jobs $(JOBS) \
	            --out out/population/figure-$$figure || exit 1 ;; esac; \
	done

experiments-sieve: tools ## chapter 3; one figure: FIGURE=3.4, RUNS=3, JOBS=3
	@$(SWIPL) experiments/sieve.pl -- --figure '$(FIGURE)' --runs $(RUNS) \
	    --jobs $(JOBS)

experiments-learning: tools ## chapter 4; one figure: FIGURE=4.9, RUNS=3, JOBS=3
	@$(SWIPL) experiments/learning.pl -- --figure '$(FIGURE)' \
	    --runs $(RUNS) --jobs $(JOBS)
	@case '$(FIGURE)' in all) \
	    $(SWIPL) experiments/algorithms.pl -- --runs $(RUNS) \
	        --jobs $(JOBS) ;; esac

# Runs disturb each other: not as many at a time, unless JOBS is given.
experiments-allocation: tools ## chapter 7; one figure: FIGURE=7.1, RUNS=3
	@$(SWIPL) experiments/allocation.pl -- --figure '$(FIGURE)' \
	    --runs $(RUNS) $(if $(filter file,$(origin JOBS)),,--jobs $(JOBS))

test: tools             ## install what is missing, run every test suite
	@$(SWIPL) test/run.pl

chaos: tools            ## attack a network of processes; SECONDS=600, SEED=1
	@$(SWIPL) test/chaos/run.pl -- --seconds $(SECONDS) --seed $(SEED)

check:                  ## a quick look for mistakes, offline
	@$(SWIPL) doc/rooms.pl -- check
	@for file in $(ENTRY_POINTS); do \
	    $(SWIPL) -q --on-error=status --on-warning=status \
	        -g '$(CHECKS)' -t halt -l $$file || exit 1; \
	done

fuzz:                   ## what nobody should send; COUNT=100000, SEED=1
	@$(SWIPL) test/chaos/fuzz.pl -- --count $(COUNT) --seed $(SEED)

bench: tools            ## measure; one line per figure
	@$(SWIPL) bench/run.pl -- --out out/bench

test-portability:       ## the suites on other Prologs (root); SWIPL=one more
	@SWIPL='$(SWIPL)' test/portability/run

clean:                  ## remove what runs have left in out/
	@rm -rf out

tools:                  ## install what the core needs and is missing
	@.ci/install

tools-all:              ## install all that .ci/packages lists
	@.ci/install all

install:
	@:
