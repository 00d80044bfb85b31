:- module(chaos_scripted, []).

/** <module> Every disturbance at every frame of a hop

    swipl test/chaos/scripted.pl [-- scenario ...]

does all that test/prolog/kernel/travel/test_scripted.pl samples, prints a line
for each kind of disturbance, and ends with the number of those after which
the agents were not as doc/agents.md says.

*Threading*: the main thread.
*/

:- use_module('../lib/common', []).
:- use_module('../lib/scripted_hops').
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- dynamic violations/1.

violations(0).

:- public main/1.

main(Names) :-
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
    with_scripted(until_violated(Cases, Rest)),
    some(Rest).

until_violated([], []).
until_violated([Case|Cases], Rest) :-
    get_time(Start),
    catch(Case, Error, true),
    get_time(End),
    Seconds is End-Start,
    Case =.. [_|Words],
    findall(W, ( member(Word, Words), term_to_atom(Word, W) ), Texts),
    atomic_list_concat(Texts, ' ', Line),
    format('~w~t~1f~60| s~n', [Line, Seconds]),
    (   var(Error)
    ->  until_violated(Cases, Rest)
    ;   print_message(error, Error),
        retract(violations(Count0)),
        Count is Count0+1,
        assertz(violations(Count)),
        Rest = Cases
    ).

scripted(Scenario, Links, Case) :-
    member(Program, [known, new, forgotten]),
    member(Link, Links),
    (   member(Action, [cut, cut_twice, hold(0.2), mute]),
        member(When, [before, inside, after]),
        Case = each_frame(Scenario, Program, Link, When, Action)
    ;   Link = A-B,
        member(Peer, [A, B]),
        member(When, [before, after]),
        member(Restart, [now, later]),
        Case = each_crash(Scenario, Program, Link, When, Peer, Restart)
    ).
