:- module(test_scripted, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/scripted_hops').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

/** <module> Hops of which single frames are disturbed

For each frame of a scenario the connection is cut there, or stalls, or a
process dies, and the story has to end as doc/agents.md says. What takes long
is sampled here; `make scripted` does all of it.
*/

:- begin_tests(scripted).

test(cut_at_each_frame) :-
    with_scripted(forall(( scenario(Scenario, Links),
                           member(Program, [known, forgotten]),
                           member(Link, Links),
                           member(When, [before, inside, after]) ),
                         each_frame(Scenario, Program, Link, When, cut))).
test(cut_twice) :-
    with_scripted(forall(( scenario(Scenario, Links),
                           member(Link, Links),
                           member(When, [before, inside]) ),
                         each_frame(Scenario, known, Link, When,
                                    cut_twice))).
test(hold_each_frame) :-
    with_scripted(forall(( member(Scenario, [ring, clone, follow]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_frame(Scenario, known, Link, before,
                                    hold(0.1)))).
test(mute_at_each_frame) :-
    with_scripted(forall(( member(Scenario, [there_and_back, follow]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_frame(Scenario, known, Link, inside, mute))).
test(crash_at_each_frame) :-
    with_scripted(forall(( crash(Scenario, Link, When, Peer),
                           member(Restart, [now, later]) ),
                         each_crash(Scenario, known, Link, When, Peer,
                                    Restart))).

:- end_tests(scripted).

crash(there_and_back, b-a, before, b).
crash(ring, b-c, after, b).
crash(clone, a-b, after, b).
crash(follow, a-b, before, a).
