/*  A fuzzer of the wire protocol.

    swipl test/chaos/fuzz.pl -- [--count N] [--seed N] [--tls]

sends N inputs to a process with a host, which has keys with --tls. Each has a
seed of its own, from the one given on: `--count 1 --seed I` repeats one. Faults
are printed with the seeds between which they were seen; the exit status is then
1. */

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../lib/common').
:- use_module(fuzz_run).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

opt_type(count, count, nonneg).
opt_type(seed, seed, nonneg).
opt_type(tls, tls, boolean).
opt_help(count, 'inputs (default 2000)').
opt_help(seed, 'the first seed (default 1)').
opt_help(tls, 'over TLS, too').
opt_meta(count, 'N').
opt_meta(seed, 'N').

main(Argv) :-
    arguments(Argv, [], Options),
    fuzz([progress(true)|Options], Faults),
    forall(member(Fault, Faults), format('~p~n', [Fault])),
    length(Faults, Count),
    format('~d faults~n', [Count]),
    (   Faults == []
    ->  true
    ;   halt(1)
    ).
