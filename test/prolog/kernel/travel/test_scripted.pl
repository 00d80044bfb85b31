:- module(test_scripted, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/scripted_hops').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

/** <module> Hops with a single disturbed frame

At each frame of a scenario the connection is cut, or stalls, or a process
dies, and the result must be as doc/agents.md guarantees. Long scenarios are
sampled here; `make scripted` runs all cases.
*/

:- begin_tests(scripted).

test(connection_is_cut_at_each_frame,
     [forall(member(Way-Program, [ short-known,
                                   short-forgotten,
                                   both-known,
                                   long-known ]))]) :-
    with_scripted(Way,
                  forall(( scenario(Scenario, Links),
                           member(Link, Links),
                           member(When, [before, inside, after]) ),
                         each_frame(Scenario, Program, Link, When, cut))).
test(connection_is_cut_twice) :-
    with_scripted(short,
                  forall(( scenario(Scenario, Links),
                           member(Link, Links),
                           member(When, [before, inside]) ),
                         each_frame(Scenario, known, Link, When,
                                    cut_twice))).
test(each_frame_is_delayed) :-
    with_scripted(short,
                  forall(( member(Scenario, [ring, clone, follow]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_frame(Scenario, known, Link, before,
                                    hold(0.1)))).
test(peer_is_silent_at_each_frame) :-
    with_scripted(short,
                  forall(( member(Scenario, [there_and_back, follow]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_frame(Scenario, known, Link, inside, mute))).
test(agent_is_queried_at_each_frame) :-
    with_scripted(short,
                  forall(( member(Scenario, [there_and_back, ring, follow]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_stop(Scenario, known, Link, before, look))).
test(agent_is_disposed_of_at_each_frame) :-
    with_scripted(short,
                  forall(( member(Scenario, [there_and_back, ring]),
                           scenario(Scenario, Links),
                           member(Link, Links) ),
                         each_stop(Scenario, known, Link, before, dispose))).
test(peer_crashes_at_each_frame) :-
    with_scripted(short,
                  forall(crash(Scenario, Link, When, Peer, Restart),
                         each_crash(Scenario, known, Link, When, Peer,
                                    Restart))).

:- end_tests(scripted).

crash(there_and_back, b-a, before, b, now).
crash(there_and_back, b-a, before, b, later).
crash(ring, b-c, after, b, now).
crash(clone, a-b, after, b, later).
crash(follow, a-b, before, a, now).
