:- module(test_hostile, []).
:- use_module('../lib/common').
:- use_module('../lib/fixtures').
:- use_module(hostile_kinds).
:- use_module(hostile_run).
:- use_module(library(plunit)).

/** <module> The short form of hostile.pl

The seed differs each time; a failure shows it.

*Threading*: one test at a time.
*/

:- begin_tests(hostile).

test(hostile_agents_do_no_harm, Faults-Seed == []-Seed) :-
    Seed is random(1 000 000 000),
    capturing(no_leaks(hostile([count(600), seed(Seed)], Faults)), _).
test(each_kind_is_held, [forall(hostile_class(Class)), Failed-Seed == []-Seed]) :-
    Seed is random(1 000 000 000),
    capturing(hostile_kinds([count(100), seed(Seed), classes([Class])],
                            [row(Class, _, Failed)]), _).

:- end_tests(hostile).
