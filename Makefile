# `make` alone only lists the targets: pack_install runs it, and after it
# `make check` and `make install`.

SWIPL ?= swipl
# Of studies: runs of each case, runs at a time.
RUNS ?= 10
JOBS ?= 2
# Of what attacks: how long, or how many inputs, and the seed.
SECONDS ?= 600
COUNT ?= 100000
SEED ?= 1
TLS ?= false
# Of `make stability`: busy processes beside, and the only processor used.
BUSY ?= 0
PIN ?=
CELL ?= none
# Of what is changed, see test/mutants/run.pl.
PART ?= all
DOCUMENTS ?=
TOUCHED ?=
MAKEFLAGS += --no-print-directory
# What is checked in one process: not two files without a module.
ALONE = $(wildcard prolog/typhon.pl bench/run.pl)
TOGETHER = $(wildcard app/typhon.pl test/run.pl experiments/study.pl)
# Of a target whose files the small archive lacks.
NEEDS = @[ -e $(1) ] || { echo "make $@: $(1) is not part of this" \
    "installation: install the full archive" >&2; exit 2; }
# check/0 without the options of predicates: for read_term/3, 9.2.9 has
# the types wrong. Only the check of layers infers meta predicates.
CHECKS = list_undefined([infer_meta_predicates(false)]), \
    list_trivial_fails, list_format_errors, list_redefined, \
    list_void_declarations

.PHONY: help tools tools-peers tools-all tools-ros demo demo-robots demo-ros \
    demo-page page-tools playground thesis beyond thesis-real test test-quick stability \
    chaos scripted fuzz fuzz-programs hostile mutants check check-all \
    doc pictures vscode release bench bench-peers profile \
    test-portability test-boards install clean

# In the environment of pack_install there is where libraries of C go.
help:
	@if [ -n "$$PACKSODIR$$SWIPL_MODULE_DIR" ]; then \
	    case "$$(pwd -P)" in \
	    */pack/typhon) ;; \
	    *) echo "the pack is a link: keep $$(pwd -P)" ;; \
	    esac; \
	else \
	    sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | \
	        while IFS='	' read -r target text; do \
	            printf '  make %-22s %s\n' "$$target" "$$text"; \
	        done; \
	fi

demo: tools             ## sixty hosts, ten agents, six tasks in step
	$(call NEEDS,experiments)
	@$(SWIPL) experiments/study.pl -- demo --runs 1 --real --logs \
	    --out out/demo

demo-robots: tools      ## simulated robots carry a pole, and push boxes
	$(call NEEDS,experiments)
	@$(SWIPL) experiments/study.pl -- pole boxes --runs 1 --out out/robots

demo-ros: tools tools-ros       ## agents drive robots of ROS 2, simulated
	$(call NEEDS,app/demo_ros.pl)
	@$(SWIPL) -q app/demo_ros.pl

demo-page: tools page-tools     ## sixty hosts, in a browser; PORT=8080
	$(call NEEDS,app/demo_page.pl)
	@$(SWIPL) app/demo_page.pl $(if $(PORT),-- --port=$(PORT))

thesis: tools page-tools ## every figure of the thesis anew; RUNS=10, JOBS=2
	$(call NEEDS,experiments)
	@$(SWIPL) experiments/study.pl -- thesis --runs $(RUNS) \
	    --jobs $(JOBS) --replays --out out/thesis

beyond: tools page-tools ## the studies beyond the thesis; RUNS=10, JOBS=2
	$(call NEEDS,experiments)
	@$(SWIPL) experiments/study.pl -- beyond --runs $(RUNS) \
	    --jobs $(JOBS) --replays --out out/beyond

thesis-real: tools      ## one case of each chapter, over sockets as well
	$(call NEEDS,experiments)
	@$(SWIPL) experiments/study.pl -- thesis --real --runs $(RUNS) \
	    --jobs $(JOBS) --out out/thesis

test: tools             ## install what is missing, run every test suite
	@$(SWIPL) test/run.pl

test-quick: tools       ## suites that the change touches, and some; two minutes
	@$(SWIPL) test/quick.pl

stability: tools        ## all suites RUNS=10 times, see test/stability.md; BUSY=8, PIN=0
	@$(SWIPL) test/stability.pl -- --runs $(RUNS) --busy $(BUSY) \
	    $(if $(PIN),--pin $(PIN))

chaos: tools            ## attack networks, and journals; SECONDS=600, SEED=1
	@$(SWIPL) test/chaos/run.pl -- --seconds $(SECONDS) --seed $(SEED)
	@$(SWIPL) test/chaos/lasting/run.pl -- --seconds $(SECONDS) \
	    --seed $(SEED)
	@$(SWIPL) test/chaos/lasting/run.pl -- --fleet --power 0 --seed $(SEED) \
	    --faults '[kill,kill_all,stop,cut,engine_kill,engine_stop,usurp]' \
	    --seconds $(SECONDS)
	@$(SWIPL) -g supervised_main test/chaos/supervised.pl -- \
	    --seconds=$(SECONDS) --seed=$(SEED)

scripted: tools         ## break each frame of a hop in every way
	@$(SWIPL) test/chaos/scripted.pl

# Of an installed pack only whether it loads.
check:                  ## a quick look for mistakes, offline
	@if [ -n "$$PACKSODIR$$SWIPL_MODULE_DIR" ]; then \
	    $(SWIPL) -q --on-error=status --on-warning=status \
	        -g true -t halt -l prolog/typhon.pl; \
	else \
	    $(MAKE) check-all; \
	fi

check-all:
ifneq ($(wildcard doc/layers.pl),)
	@$(SWIPL) -q --on-error=status doc/layers.pl -- check
	@$(SWIPL) -q --on-error=status -g check_promises -t halt test/promises.pl
endif
	@for file in $(ALONE); do \
	    $(SWIPL) -q --on-error=status --on-warning=status \
	        -g '$(CHECKS)' -t halt -l $$file || exit 1; \
	done
	@$(SWIPL) -q --on-error=status --on-warning=status \
	    $(foreach file,$(wordlist 2,9,$(TOGETHER)),-g "ensure_loaded('$(file)')") \
	    -g '$(CHECKS)' -t halt -l $(firstword $(TOGETHER))
	@echo "check: no mistakes found"

fuzz:                   ## send malformed frames; COUNT=100000, SEED=1, TLS=true
	@$(SWIPL) test/chaos/fuzz.pl -- --count $(COUNT) --seed $(SEED) --tls=$(TLS)

fuzz-programs:          ## random programs, compiled and interpreted; COUNT, SEED=1
	@TYPHON_PROGRAMS=$(COUNT) TYPHON_SEED=$(SEED) TYPHON_SUITE_SECONDS=36000 \
	    $(SWIPL) test/run.pl -- chunks

hostile:                ## hostile agents on a guarded host; COUNT=100000, SEED=1, CELL=owner
	@$(SWIPL) test/chaos/hostile.pl -- --count $(COUNT) --seed $(SEED) \
	    --cell $(CELL)

# COUNT is 300 here, and the time not bounded, if they are not given.
GIVEN = $(filter command,$(firstword $(origin $(1))))
mutants: tools          ## take something away, look whether a test fails; COUNT, SEED, PART
	$(call NEEDS,test/mutants)
	@$(SWIPL) test/mutants/run.pl -- --seed $(SEED) --part $(PART) \
	    --count $(if $(call GIVEN,COUNT),$(COUNT),300) \
	    $(if $(call GIVEN,SECONDS),--seconds $(SECONDS)) \
	    $(if $(DOCUMENTS),--documents $(DOCUMENTS)) \
	    $(if $(TOUCHED),--touched $(TOUCHED))

pictures: tools page-tools ## make all pictures of README and doc; KINDS=page
	$(call NEEDS,doc/pictures.pl)
	@.ci/install page
	@RUNS=$(RUNS) $(SWIPL) doc/pictures.pl -- doc/img $(KINDS)

vscode:                 ## pack the extension for VS Code, by vsce from npm
	@mkdir -p out
	@cd app/editors/vscode && ../../../.ci/vsce package \
	    --allow-missing-repository --out ../../../out/typhon-agents.vsix

playground: tools       ## programs in a browser, without a server of ours, in out/playground
	$(call NEEDS,app/playground/build.js)
	@.ci/install wasm page
	@rm -rf out/playground
	@node app/playground/build.js out/playground

doc: tools              ## the documents as a site, in out/doc
	@.ci/install doc
	@rm -rf out/doc
	@$(SWIPL) doc/site.pl -- out/doc

release:                ## the archives of a release, full and small; URL=https://... of its home
	@app/packaging/release out/release "$(URL)"

bench: tools            ## measure; one line per figure
	$(call NEEDS,bench)
	@$(SWIPL) bench/run.pl -- --out out/bench

bench-peers: tools      ## compare with Erlang, JADE, SPADE, Pekko, Mesa, if there
	$(call NEEDS,bench)
	@$(SWIPL) bench/run.pl -- --out out/bench-peers peers

profile: tools          ## which module takes how long of a hop
	$(call NEEDS,bench)
	@$(SWIPL) bench/profile.pl

test-portability:       ## the suites on other Prologs (root); SWIPL=one more
	$(call NEEDS,test/portability)
	@SWIPL='$(SWIPL)' test/portability/run

test-boards:            ## suites on Debian for arm64 and armhf, by qemu (root)
	$(call NEEDS,test/portability)
	@SWIPL='$(SWIPL)' test/portability/run --boards

clean:                  ## remove what runs have left in out/
	@rm -rf out

tools:                  ## install what the core needs and is missing
	@.ci/install

page-tools:             ## get what plots and layouts of the page need
	@.ci/page-tools

PEER_JARS = for name in jade pekko; do \
	    bench/peers/$$name --get >/dev/null || \
	        echo "$$name is not to be had: what needs it is left out" >&2; \
	done

tools-peers:            ## install what `make bench-peers` compares with
	$(call NEEDS,bench)
	@.ci/install peers
	@$(PEER_JARS)

tools-ros:              ## install ROS 2 from PyPI for library(typhon/ros)
	$(call NEEDS,.ci/ros-tools)
	@.ci/ros-tools

tools-all:              ## install all that .ci/packages lists, JADE and Pekko
	@.ci/install all
	@$(PEER_JARS)

# Of a copy, not of a link to a clone, in which files change.
install:
	@if [ -n "$$PACKSODIR$$SWIPL_MODULE_DIR" ]; then \
	    case "$$(pwd -P)" in \
	    */pack/typhon) $(SWIPL) -q app/typhon/compile.pl ;; \
	    esac; \
	fi
