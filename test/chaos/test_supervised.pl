:- module(test_supervised, []).
:- use_module('../lib/common').
:- use_module(library(plunit)).
:- use_module(supervised, [supervised/2]).

/** <module> A short form of the attack of `make chaos` on supervisors

*Threading*: the main thread.
*/

:- begin_tests(supervised).

test(each_child_runs_once, Wrong == []) :-
    random_between(1, 1000000, Seed),
    format('% seed ~d~n', [Seed]),
    no_leaks(supervised([seed(Seed), seconds(10), rounds(6)], Wrong)).

:- end_tests(supervised).
