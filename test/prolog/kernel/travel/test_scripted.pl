:- module(test_scripted, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/scripted_hops').
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).

/** <module> Hops with a single disturbed frame

At each frame of a scenario the connection is cut, or stalls, or a process
dies, and the result must be as doc/agents.md guarantees. Long scenarios are
sampled here; `make scripted` runs all cases.
*/

%   each(-Way, -Scenarios, -Whens, :Disturbs): call(Disturbs, Scenario, Link,
%   When) for these Scenarios, their links and Whens.

each(short, All, [inside,after], disturbs(known, cut)) :-
    all_scenarios(All).
each(Way, [there_and_back,clone,refused,follow,chase], [inside,after],
     disturbs(Program, cut)) :-
    member(Way-Program, [short-forgotten, both-known, long-known]).
each(short, All, [inside], disturbs(known, cut_twice)) :-
    all_scenarios(All).
each(short, [ring,clone,follow], [before], disturbs(known, hold(0.1))).
each(short, [there_and_back,follow], [inside], disturbs(known, mute)).
each(short, [there_and_back,ring,follow], [before], stops(look)).
each(short, [there_and_back,ring], [before], stops(dispose)).

all_scenarios(All) :-
    findall(Scenario, scenario(Scenario, _), All).

disturbs(Program, Action, Scenario, Link, When) :-
    each_frame(Scenario, Program, Link, When, Action).

stops(Act, Scenario, Link, When) :-
    each_stop(Scenario, known, Link, When, Act).

:- begin_tests(scripted).

test(each_frame, forall(each(Way, Scenarios, Whens, Disturbs))) :-
    with_scripted(Way,
                  forall(( scenario(Scenario, Links),
                           memberchk(Scenario, Scenarios),
                           member(Link, Links),
                           member(When, Whens) ),
                         call(Disturbs, Scenario, Link, When))).
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
