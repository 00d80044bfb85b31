/*  Hostile agents at random, on a host that guards.

    swipl test/chaos/hostile.pl -- [--count N] [--seed N] [--cell KIND]

Each agent has a seed of its own, from the one given on: `--count 1 --seed I`
repeats one.  Harm is printed with the seeds between which it was detected;
the exit status is then 1. The end of the process is harm, too: its seeds are
the last that were printed.

Then the kinds of hostile_kinds.pl are attempted, each as often, and a table
shows how many attempts of each class were held. */

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../lib/common').
:- use_module(hostile_kinds).
:- use_module(hostile_run).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/3]).

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
    arguments(Argv, [], Options),
    option(count(Count), Options, 500),
    hostile([progress(true)|Options], Faults),
    hostile_kinds(Options, Rows),
    forall(( member(row(Class, _, Failed), [row(mixed, Count, Faults)|Rows]),
             member(Fault, Failed) ),
           format("~w: ~p~n", [Class, Fault])),
    format("~w~t~10|~t~w~20|~t~w~30|~t~w~40|~n",
           [class, attempts, held, failed]),
    forall(member(Row, [row(mixed, Count, Faults)|Rows]), print_row(Row)),
    (   member(row(_, _, [_|_]), [row(mixed, Count, Faults)|Rows])
    ->  halt(1)
    ;   true
    ).

print_row(row(Class, Attempts, Faults)) :-
    length(Faults, Failed),
    Held is Attempts-Failed,
    format("~w~t~10|~t~D~20|~t~D~30|~t~D~40|~n",
           [Class, Attempts, Held, Failed]).
