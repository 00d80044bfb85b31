:- module(chaos_scripted, []).

/** <module> Every disturbance at every frame of a hop

    swipl test/chaos/scripted.pl [-- scenario ...]

runs all cases that test/prolog/kernel/travel/test_scripted.pl samples, prints
a line for each kind of disturbance, and ends with the number of cases that
violate the guarantees of doc/agents.md.

*Threading*: the main thread.
*/

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../lib/common', []).
:- use_module('../lib/scripted_hops').
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- dynamic violations/1.

violations(0).

:- public main/1.

main(Argv) :-
    arguments(Argv, Names, []),
    forall(( scenario(Scenario, Links), wanted(Names, Scenario) ),
           all_of(Scenario, Links)),
    violations(Count),
    format('~d violated~n', [Count]),
    (   Count =:= 0
    ->  true
    ;   halt(1)
    ).

wanted([], _) :-
    !.
wanted(Names, Scenario) :-
    member(Scenario, Names), !.

%   After a violation the others begin with new processes.

all_of(Scenario, Links) :-
    findall(Case, scripted(Scenario, Links, Case), Cases),
    some(Cases).

some([]) :-
    !.
some(Cases) :-
    Cases = [Way-_|_],
    with_scripted(Way, until_violated(Cases, Way, Rest)),
    some(Rest).

%   until_violated(+Cases, +Way, -Rest): those of Way, up to a violation.

until_violated([Way-Case|Cases], Way, Rest) :-
    !,
    get_time(Start),
    catch(Case, Error, true),
    get_time(End),
    Seconds is End-Start,
    Case =.. [_|Words],
    findall(W, ( member(Word, Words), term_to_atom(Word, W) ), Texts),
    atomic_list_concat([Way|Texts], ' ', Line),
    format('~w~t~1f~60| s~n', [Line, Seconds]),
    (   var(Error)
    ->  until_violated(Cases, Way, Rest)
    ;   print_message(error, Error),
        retract(violations(Count0)),
        Count is Count0+1,
        assertz(violations(Count)),
        Rest = Cases
    ).
until_violated(Rest, _, Rest).

scripted(Scenario, Links, Way-Case) :-
    member(Way, [short, both, long]),
    member(Program, [known, new, forgotten]),
    member(Link, Links),
    (   member(Action, [cut, cut_twice, hold(0.2), mute]),
        member(When, [before, inside, after]),
        Case = each_frame(Scenario, Program, Link, When, Action)
    ;   member(Act, [look, dispose]),
        Case = each_stop(Scenario, Program, Link, before, Act)
    ;   Way == short,
        Link = A-B,
        member(Peer, [A, B]),
        member(When, [before, after]),
        member(Restart, [now, later]),
        Case = each_crash(Scenario, Program, Link, When, Peer, Restart)
    ).
