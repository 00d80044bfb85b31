/*  Hostile agents at random, on a host that guards.

    swipl test/chaos/hostile.pl -- [--count N] [--seed N] [--cell KIND]

Each agent has a seed of its own, from the one given on: `--count 1 --seed I`
repeats one.  Harm is printed with the seeds between which it was detected;
the exit status is then 1. The end of the process is harm, too: its seeds are
the last that were printed. */

:- use_module('../lib/common').
:- use_module(hostile_run).
:- use_module(library(main), [argv_options/3, main/0]).

:- initialization(main, main).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

%   Messages about hostile agents are not printed.

user:message_hook(Term, Kind, _) :-
    memberchk(Kind, [error, warning, informational]),
    nonvar(Term),
    Term = typhon(_).

opt_type(count, count, nonneg).
opt_type(seed, seed, nonneg).
opt_type(cell, cell, oneof([none,owner,host])).
opt_help(count, 'agents (default 500)').
opt_help(seed, 'the first seed (default 1)').
opt_help(cell, 'where they run: none, owner or host (default none)').
opt_meta(count, 'N').
opt_meta(seed, 'N').
opt_meta(cell, 'KIND').

main(Argv) :-
    argv_options(Argv, _, Options),
    hostile([progress(true)|Options], Faults),
    forall(member(Fault, Faults), format("~p~n", [Fault])),
    length(Faults, Count),
    format("~d faults~n", [Count]),
    (   Faults == []
    ->  true
    ;   halt(1)
    ).
