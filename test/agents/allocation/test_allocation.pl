:- module(test_allocation, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(terms), [mapargs/3]).
:- use_module(library(yall)).
:- use_module('../../../prolog/typhon').
:- use_module('../../../prolog/typhon/kernel/program',
              [payload_load/2]).
:- use_module('../../../agents/allocation/reservations').
:- use_module('../../../agents/allocation/operator').
:- include('../../../agents/allocation/allocator/mobility_resource').
:- include('../../../agents/allocation/common/backoff_interval').
:- include('../../../agents/allocation/common/requirements').
:- include('../../../agents/allocation/allocator/trail').

/** <module> Allocation: equations, and decisions on a simulated host
*/

                /*******************************
                *           EQUATIONS          *
                *******************************/

%   lasts(+Chi, +Found, +Visited, -Hops): the number of hops on known hosts
%   until the resource is used up.

lasts(Chi, _, _, 0) :-
    exhausted(Chi, 0.01),
    !.
lasts(Chi0, Found, Visited0, Hops) :-
    decayed(Chi0, Found, Visited0, 5, Chi),
    Visited is Visited0 + 1,
    lasts(Chi, Found, Visited, Hops0),
    Hops is Hops0 + 1.

%   equation(Name, Goal, Value): Value is the last argument that Goal lacks.

equation(equation_7_1, rewarded(2, 0.5, 10, 0), 3).     % 2 (1 + 1/2 * 10/10)
equation(reward_falls_with_the_missing_robots,
         rewarded(2, 0.5, 10, 9), 2.1).                 % 2 (1 + 1/2 * 1/10)
equation(equation_7_2, penalised(2, 0.5, 2, 10, 4), 1.75). % 2 (1 - 1/2 * 2/8)
equation(decay_on_new_hosts_is_a_fifth, decayed(10, 7, 8, 5), 8).
equation(decay_at_the_joint_is_a_fifth, decayed(10, 7, 7, 5), 8). % tan(pi/4)
equation(decay_is_slow_in_a_large_network, decayed(1, 100, 0, 5), Chi) :-
    Chi is 1 - tan(pi/104)/5.
equation(equation_7_3, decayed(1, 8, 0, 5), Chi) :-
    Chi is 1 - tan(pi/12)/5.
equation(first_search_on_new_hosts_lasts_31_hops, lasts(10, 0, 1), 31).
equation(equation_7_5, interval(15, 1, 500, 0.5), 30).  % 15 + 30/2
equation(longest_interval, interval(15, 2, 500, 1.0), 75). % 15 + 60
equation(shortest_interval, interval(15, 3, 500, 0.0), 15).
equation(intervals_are_bounded, interval(15, Count, 500, 1.0), 515) :-
    member(Count, [6, 60, 5000]).
equation(equation_7_6, reach_time(30, 0.5), 15).
equation(equation_7_7, bid_time(Bids, 10), Theta) :-
    member(Bids-Theta, [0-10, 1-10, 7-70]).

:- begin_tests(mobility_resource).

test(equation, [ forall(equation(_, Goal, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal, Value).
test(penalty_decrements_and_is_above_zero,
     [ forall(( member(Held, [0, 5, 9]), member(Times, [1, 10, 100]) )) ]) :-
    penalised(2, 1, Times, 10, Held, Chi),
    Chi < 2,
    Chi > 0.
test(equation_7_4, [ forall(member(Found-Chi,
                              [10-0.028, 30-0.050, 100-0.100])) ]) :-
    restarted(Found, 5, 0.01, Chi0),
    abs(Chi0 - Chi) < 0.0005.
test(restart_lasts_one_hop_more_than_robots_are_known,
     [ forall(member(Found, [0, 1, 10, 30, 57, 100, 200])),
       Hops =:= Found + 1 ]) :-
    restarted(Found, 5, 0.01, Chi),
    lasts(Chi, Found, 0, Hops).

:- end_tests(mobility_resource).

                /*******************************
                *       NEEDS, WAYS, LOGS      *
                *******************************/

%   trail(Name, Goal, Trail), way(Name, Goal, Host-Distance): what Goal adds, or
%   `none`. Trails begin with the last host.

trail(step, stepped(d, [c, e], [], [c, b, a]), [d, c, b, a]).
trail(step_over_a_removed_link, stepped(d, [], [a], [c, b, a]), [d, c, b, a]).
trail(cycle_is_removed, stepped(b, [d, c], [], [d, c, b, a]), [b, a]).
trail(detour_is_shortened, stepped(e, [b, d], [a], [d, c, b, a]), [e, b, a]).
trail(path_is_not_shortened_past_a_robot,
      stepped(e, [d, c, b], [c], [d, c, b, a]), [e, c, b, a]).
trail(round_trip_with_a_robot_is_kept,
      stepped(b, [d], [c, x], [d, c, b, a]), [b, d, c, b, a]).
trail(round_trip_to_a_robot, stepped(c, [d], [c], [d, c, b, a]), [c, b, a]).

way(back_step_by_step, nearer([d, c, b, a], [a], [x, c], 4), c-2).
way(back_by_a_shortcut, nearer([d, c, b, a], [a], [c, b], 4), b-1).
way(path_to_the_nearest_robot, nearer([d, c, b, a], [a, c], [c, b], 4), c-0).
way(path_leads_forward_too, nearer([d, c, b, a], [d], [a, d, b], 4), d-0).
way(neighbour_that_is_not_nearer_is_ignored,
    nearer([d, c, b, a], [a], [c], 2), none).
way(broken_path, nearer([c, b, a], [a], [x, y], 3), none).
way(path_without_robots, nearer([c, b, a], [z], [c, b], 3), none).

%   costs(Payload, Details, Properties, Cost)

costs(nearest, [at(p(4, 6))], [position=p(1, 2)], 5.0).
costs(nearest, [], [position=p(1, 2)], 0).      % to the same host
costs(energy, [energy(2)], [battery=4], 0.5).
costs(energy, [energy(2)], [battery=1], none).

%   faults(Name, Events, Faults)

faults(no_faults, [ begun(t), reserved(h, a, t), executed(h, a, t), ended(done),
                    released(h, a, t), reserved(h, b, u), released(h, b, u) ],
       []).
faults(reserved_twice, [ reserved(h, a, t), reserved(h, b, u),
                         released(h, b, u) ], [twice(h, a, b, 2)]).
faults(reserved_twice_by_one_allocator,
       [reserved(h, a, t), reserved(h, a, t), released(h, a, t)],
       [twice(h, a, a, 2)]).
faults(stray_robots, [ executed(h, a, t), reserved(h, a, t), executed(h, b, t),
                       released(h, b, t) ],
       [ stray(h, a, executed, 1), stray(h, b, executed, 3),
         stray(h, b, released, 4), held(h, a, t) ]).
faults(still_reserved, [reserved(h, a, t)], [held(h, a, t)]).

:- begin_tests(allocation_terms).

robot([push, lift(50), battery=0.5, position=p(1, 2)]).

test(fit, [ forall(member(Requirements,
                          [ [], [push], [lift(_)], [battery>=0.5],
                            [battery=<0.5], [lift(X), position=p(_, _), push]
                          ])) ]) :-
    robot(Properties),
    fit(Requirements, Properties),
    var(X).
test(unfit, [ forall(member(Requirements,
                            [ [fly], [push, fly], [lift(60)], [battery>=0.6],
                              [battery=<0.4], [charge>=0],
                              [position=p(Z, Z)] ])),
              fail ]) :-
    robot(Properties),
    fit(Requirements, Properties).
test(required, Count == 5) :-
    required([3-[push], 2-[lift(_)]], Count).
test(open_teams, Open == [2]) :-
    findall(Team, open_team([1-[a], 2-[b], 1-[c]], [3, 2, 1], Team, _),
            Open).
test(what_each_robot_executes,
     [ forall(member(Details-Is, [ []-sleep(5), [duration(2)]-sleep(2),
                                   [duration(2), goal(dig)]-dig ])),
       Goal == Is ]) :-
    task_goal(Details, Goal).
test(trail_is_short_and_passes_the_robots,
     [ forall(trail(_, Goal, Expected)), Trail == Expected ]) :-
    call(Goal, Trail).
test(links, Counts == [0, 2, 4]) :-
    maplist([Host, Count]>>links(Host, [d, c, b, a], Count), [d, b, x],
            Counts).
test(way_to_the_next_robot,
     [forall(way(_, Goal, Expected)), Way == Expected]) :-
    ( call(Goal, Host, Distance) -> Way = Host-Distance ; Way = none ).

with_payload(Payload, Goal) :-
    payload_load(payloads(allocation/Payload), payload(_, _, Clauses)),
    setup_call_cleanup(
        maplist([Clause]>>assertz(test_allocation_payload:Clause), Clauses),
        once(Goal),
        ( abolish(test_allocation_payload:cost/3),
          abolish(test_allocation_payload:agreed/3) )).

test(cost_of_a_payload, [ forall(costs(Payload, Details, Properties, Expected)),
                          Cost = Expected ]) :-
    with_payload(Payload,
                 (   test_allocation_payload:cost(need(t, [], Details),
                                                  Properties, Cost)
                 ;   Cost = none )).
test(thrifty_accepts_higher_costs_with_each_round, Agreed == [2-0, 4-1, 8-2]) :-
    with_payload(thrifty,
                 findall(Most-Count,
                         ( member(Count, [0, 1, 2]),
                           aggregate_all(max(Cost),
                                         ( member(Cost, [8, 4, 2]),
                                           test_allocation_payload:agreed(
                                               Cost, [budget(2)], Count) ),
                                         Most) ),
                         Agreed)).
test(faults_of_reservations, [ forall(faults(_, Whats, Expected)),
                               Faults == Expected ]) :-
    findall(event(Time, h, r, What), nth1(Time, Whats, What), Events),
    reservation_faults(Events, Faults).

test(wrong_tasks, [ forall(member(Task,
                                  [ _, task(t), task(t, [], []),
                                    task(t, [0-[a]], []), task(t, [a], []),
                                    task(t, [1-[a]], x),
                                    task(f(x), [1-[a]], []) ])),
                    error(type_error(task, _)) ]) :-
    task_allocate(Task, nowhere, [], _).
test(wrong_setting, error(domain_error(setting, chj-1))) :-
    task_allocate(task(t, [1-[a]], []), nowhere, [settings([chj-1])], _).

:- end_tests(allocation_terms).

                /*******************************
                *            A ROBOT           *
                *******************************/

%   robot(+Facts): a robot that can push; a push costs 3, a throw only time.

robot(Facts) :-
    fake_agent('agents/allocation/robot.pl',
               [ property(push), property(battery=1),
                 (cost(need(_, [push|_], _), _, 3) :- true)
               | Facts
               ],
               []),
    hear.

%   The messages that the agent sends are among its recorded acts.

hear :-
    retractall(fake_agent:tell(_, _)),
    assertz((fake_agent:tell(Agent, Message) :-
                 fake_host:send(Agent, Message))).

%   step(+Step, -Result): a message, From-Message, has the reaction of the robot
%   as its result, in which To-Message is sent; n(Task) and n(Task, Priority)
%   are needs of a push. With `overdue` the time advances to that at which the
%   robot asks or gives up.

step(reserve, Acts) :-
    step(x-reserve(r, owner, n(r)), Acts0),
    ( Acts0 == [log(reserved(here, owner, r)), x-answer(r, reserved)]
    -> Acts = done ; Acts = Acts0 ).
step(overdue, Acts) :-
    fake_agent:due(Time, _),
    fake_at(Time),
    reaction(( fake_agent:next(Event), fake_agent:handle(Event) ), Acts).
step(hold, Holds) :-
    findall(Ref-Phase, fake_agent:hold(Ref, _, _, _, Phase), Holds).
step(due, Dues) :-
    findall(Time-Event, fake_agent:due(Time, Event), Dues).
step(time, Time) :-
    fake_host:time(Time).
step(From-Message0, Acts) :-
    mapargs(need, Message0, Message),
    reaction(fake_agent:handle(From-Message), Acts).

need(Arg, Need) :-
    (   nonvar(Arg), Arg = n(Task)
    ->  Need = need(Task, [push], [])
    ;   nonvar(Arg), Arg = n(Task, Priority)
    ->  Need = need(Task, [push], [priority(Priority)])
    ;   Need = Arg
    ).

reaction(Goal, Acts) :-
    retractall(fake_host:did(_)),
    ignore(Goal),
    did(Acts0),
    maplist([Act0, Act]>>( Act0 = send(To, What) -> Act = To-What
                         ; Act = Act0 ), Acts0, Acts).

%   talk(Name, Facts, Steps): Steps are Step=Result, or Step where it is `done`.

talk(bids, [], [x-ask(r, n(t)) = [x-answer(r, bid(3))]]).
talk(unfit, [property(lift)],
     [ x-ask(r, need(t, [fly], [])) = [x-answer(r, refused(unfit))],
       x-ask(r, need(t, [battery>=2], [])) = [x-answer(r, refused(unfit))],
       x-ask(r, need(t, [lift], [])) = [x-answer(r, refused(unfit))] ]).
talk(reserved_once, [],
     [ reserve, y-ask(s, n(t)) = [y-answer(s, refused(reserved))],
       y-reserve(s, other, n(t)) = [y-answer(s, refused(reserved))],
       hold = [r-reserved] ]).
talk(repeated_request_gets_the_same_answer, [],
     [reserve, x-reserve(r, owner, n(r)) = [x-answer(r, reserved)]]).
talk(released_by_the_reserving_allocator, [],
     [ reserve, child-release(s) = [child-answer(s, released)],
       hold = [r-reserved],
       child-release(r) = [ log(released(here, owner, r)),
                            child-answer(r, released) ],
       hold = [], due = [] ]).
talk(urgent_task_preempts_reservation, [],
     [ reserve, y-ask(s, n(u, 1)) = [y-answer(s, bid(3))],
       y-reserve(s, other, n(u, 1))
       = [ log(released(here, owner, r)), x-lost(r, preempted),
           log(reserved(here, other, u)), y-answer(s, reserved) ],
       hold = [s-reserved] ]).
talk(equal_task_does_not_preempt, [],
     [ x-reserve(r, owner, n(t, 1)) = [_, _],
       y-reserve(s, other, n(t, 1)) = [y-answer(s, refused(reserved))] ]).
talk(executing_robot_is_not_preempted, [],
     [ reserve, x-start(r, true) = [x-answer(r, started)],
       y-reserve(s, other, n(u, 9)) = [y-answer(s, refused(executing))] ]).
talk(without_reservation, [],
     [ x-start(r, true) = [x-answer(r, refused(none))],
       x-status(r) = [x-answer(r, status(none))] ]).
talk(executed, [],
     [ reserve, x-start(r, true) = [x-answer(r, started)],
       x-status(r) = [x-answer(r, status(executing))],
       child-finished(r, done) = [log(executed(here, owner, r)), x-done(r)],
       x-status(r) = [x-answer(r, status(done))], hold = [r-done] ]).
talk(message_of_an_earlier_execution_thread_is_ignored, [],
     [reserve, x-start(r, true) = [_], other-finished(r, done) = []]).
talk(failed_execution, [],
     [ reserve, x-start(r, true) = [_],
       child-finished(r, raised(oops)) = [ log(released(here, owner, r)),
                                           x-lost(r, raised(oops)) ],
       hold = [] ]).
talk(failure, [],
     [ reserve, user-fail = [ log(robot(failed)), log(released(here, owner, r)),
                              x-lost(r, failed) ],
       x-ask(s, n(t)) = [x-answer(s, refused(failed))],
       user-repair = [log(robot(repaired))],
       x-ask(s, n(t)) = [x-answer(s, bid(3))] ]).
talk(state_changes, [],
     [ x-ask(r, need(t, [push, battery=<0.5], []))
       = [x-answer(r, refused(unfit))],
       user-state(battery=0.2) = [],
       x-ask(r, need(t, [push, battery=<0.5], [])) = [x-answer(r, bid(3))] ]).
talk(robot_asks_whether_it_is_still_needed, [],
     [reserve, due = [60-_], overdue = [x-still(r)]]).
talk(silent_allocator_frees_the_robot,
     [setting(watch, 10), setting(patience, 3)],
     [ reserve, overdue = [_],
       overdue = [log(released(here, owner, r)), x-lost(r, lapsed)],
       time = 13 ]).
talk(positive_answer_keeps_the_reservation,
     [setting(watch, 10), setting(patience, 3)],
     [ reserve, overdue = [_], x-yes(s) = [], due = [13-answer], x-yes(r) = [],
       due = [20-ask], hold = [r-reserved] ]).
talk(negative_answer_frees_the_robot, [],
     [reserve, overdue = [_], x-no(r) = [log(released(here, owner, r))]]).
talk(allocator_is_checked_during_execution, [],
     [ reserve, x-start(r, true) = [_], overdue = [_],
       overdue = [log(released(here, owner, r)), x-lost(r, lapsed)] ]).
talk(checks_can_be_disabled, [setting(watch, inf)], [reserve, due = []]).
talk(invalid_messages_are_ignored, [], [x-hello(r) = []]).

wrong(Step0, Step-Result) :-
    ( Step0 = (Step=Expected) -> true ; Step = Step0, Expected = done ),
    step(Step, Result),
    !,
    \+ alike(Expected, Result).

:- begin_tests(allocation_robot).

test(robot_reacts, [forall(talk(_, Facts, Steps)), Wrong == []]) :-
    robot(Facts),
    convlist(wrong, Steps, Wrong).
test(start_without_capacity,
     Acts-Holds == [x-answer(r, refused(capacity))]-[r-reserved]) :-
    robot([]),
    step(reserve, done),
    fake_clone(error(move_refused(here, capacity), _)),
    step(x-start(r, true), Acts),
    step(hold, Holds).
test(execution_thread_performs_the_task,
     [ forall(member(Goal-Outcome,
                     [ true-done, fail-failed, throw(oops)-raised(oops),
                       atom_length(_, _)-raised(instantiation_error) ])),
       Acts == [robot-finished(r, Outcome)] ]) :-
    robot([]),
    step(reserve, done),
    fake_clone(clone(robot)),
    reaction(catch(fake_agent:handle(x-start(r, Goal)), disposed, true), Acts).

:- end_tests(allocation_robot).

                /*******************************
                *         AN ALLOCATOR         *
                *******************************/

%   allocator(+Facts): an allocator that needs two robots that push and one
%   that lifts, has made two hops, and is at the end of its third.

allocator(Facts) :-
    fake_agent('agents/allocation/allocator.pl',
               [ task(t, [2-[push], 1-[lift]], [duration(4)]),
                 sojourn(3, 2, 0, 0), chi(1), backoffs(0), until(never),
                 trail([here, b, a]), chance(chance(1, 2)),
                 found(here), found(b), found(a),
                 (agreed(Cost, _, _) :- Cost < 10)
               | Facts
               ],
               [robot(r)]),
    hear.

ref(Team, ref(me, 0, 3, Team)).

push(send(r, ask(Ref, need(t, [push], [duration(4)])))) :- ref(1, Ref).
lift(send(r, ask(Ref, need(t, [lift], [duration(4)])))) :- ref(2, Ref).

%   negotiation(Name, Facts, Answers, Checks): the robot gives Answers,
%   Team-What.

negotiation(reservation_is_rewarded, [], [1-bid(3), 1-reserved],
            [ did=[Push, send(r, reserve(Ref, me, _))],
              held(here, r, Ref, 1, reserved),
              \+ sent(message, _),      % the robot is at the same host
              chi=1.5 ]) :-             % 1 (1 + 1/2 * 3/3)
    push(Push),
    ref(1, Ref).
negotiation(reservations_are_shared, [setting(sharing, own)],
            [1-bid(3), 1-reserved], [news(here, [push], taken, _)]).
negotiation(robot_for_the_other_team, [],
            [1-refused(unfit), 2-bid(0), 2-reserved],
            [ did=[Push, Lift, send(r, reserve(_, _, _))],
              held(here, r, _, 2, reserved) ]) :-
    push(Push),
    lift(Lift).
negotiation(complete_team_gets_no_request,
            [held(b, q, x, 1, reserved), achieved(1)], [2-refused(unfit)],
            [did=[Lift]]) :-
    lift(Lift).
negotiation(refusal_is_penalised, [], [1-refused(Reason)], [chi=0.875]) :-
    member(Reason, [reserved, executing]). % 1 (1 - 1/2 * 1/(1 + 3))
negotiation(no_penalty, [], [1-What], [chi=1, \+ held(_, _, _, _, _)]) :-
    member(What, [refused(failed), bid(11)]).
negotiation(expensive_robot_is_not_reserved, [], [1-bid(11), 1-reserved],
            [did=[Push]]) :-
    push(Push).
negotiation(silent_robot_is_skipped, [], [], [chi=1, time=20]).
negotiation(already_reserved_robot_gets_no_request,
            [held(here, r, x, 1, reserved)], [], [did=[]]).

%   acts(Name, Facts, Before, Goal, Checks), see fake_run/4.

acts(waits_for_the_order_to_begin, [setting(start, order)], [], main,
     [end=fail, did=[]]).
acts(second_reward_is_less, [held(b, q, x, 1, reserved)],
     [ fake_fact(sojourn(3, 2, 1, 0)), fake_mail(r-answer(Ref, bid(3))),
       fake_mail(r-answer(Ref, reserved)) ], negotiate, [chi=Chi]) :-
    ref(1, Ref),
    Chi is 5/3.                         % 1 (1 + 2/2 * 2/3)
acts(migrates, [], [], proceed,         % 3 found, 3 visited: a fifth
     [did=[move(next)], chi=0.8, sojourn(4, 3, 0, 0), sent(migration, 1)]).
acts(refused_move_counts, [], [fake_refusal(next)], proceed,
     [sent(refusal, 1), sojourn(3, 2, 0, 0), time=1]).
acts(backs_off, [ held(b, q, x, 1, reserved), held(a, p, y, 2, done),
                  setting(backoff, constant) ], [fake_fact(chi(0.01))], proceed,
     [ did=[log(backoff(Interval))],    % a child is about
       time=Interval, ( fake_host:time(T), T >= 10, T =< 30 ), backoffs=1,
       \+ held(_, _, _, _, _), achieved=2, sojourn(0, 0, 0, 0), trail=[here],
       chi=Chi ]) :-
    restarted(3, 5, 0.01, Chi).
acts(newer_information_is_carried_and_left,
     [ setting(sharing, shared), news(b, [push], taken, 5),
       news(a, [lift], free, 7) ],
     [fake_host:leave(robots([ news(b, [push], free, 6),
                               news(a, [lift], taken, 6) ]))], exchange,
     [ ( sense(robots(News)),
         msort(News, [news(a, [lift], free, 7), news(b, [push], free, 6)]) ),
       news(b, [push], free, 6) ]).
acts(without_sharing_no_information_is_left,
     [setting(sharing, Sharing), news(b, [push], free, 5)], [], exchange,
     [\+ sense(robots(_))]) :-
    member(Sharing, [none, own]).
acts(migrates_to_the_last_reported_free_neighbour,
     [ setting(sharing, own), news(b, [push], free, 5),
       news(c, [push], free, 6), news(d, [push], taken, 7),
       news(e, [fly], free, 8), news(f, [push], free, 9) ],
     [fake_neighbours([b, c, d, e])], next_place(Host), [Host == c]).
acts(no_free_neighbour_is_known,
     [setting(sharing, own), news(f, [push], free, 9)],
     [fake_neighbours([b, c])], next_place(Host), [Host == next]).
acts(releases_are_shared,
     [setting(sharing, own), held(here, r, x, 1, reserved)], [fake_at(9)],
     deallocate([reserved]), [news(here, [push], free, 9)]).
acts(only_what_is_released_is_reported_free, [setting(sharing, Sharing)|Held],
     [fake_at(9)],
     ( deallocate([reserved]),
       findall(At-Needs-Time, news(At, Needs, free, Time), News) ),
     [News == Reported]) :-
    Held = [ held(here, r, x, 2, reserved), held(b, q, y, 1, started),
             held(c, p, z, 1, done) ],
    member(Sharing-Reported, [own-[here-[lift]-9], none-[]]).
acts(executing_robots_are_not_released,
     [held(b, q, x, 1, started), setting(backoff, constant)], [], back_off,
     [held(b, q, x, 1, started), trail=[here, b, a]]).
acts(child_returns, Held, [fake_clone(clone(me)), fake_neighbours([b, a, c])],
     deallocate([reserved]),
     [ end=disposed,
       did=[ move(b), send(q, release(x)), move(a), send(p, release(y)),
             log(communications(child, 2)) ] ]) :-
    two_reserved(Held).
acts(child_skips_a_host_that_refuses_it, Held,
     [ fake_clone(clone(me)), fake_neighbours([b, a, c]), fake_refusal(b),
       fake_refusal(next) ], deallocate([reserved]),
     [ end=disposed, time=300,          % its life
       did=[move(a), send(p, release(y)), log(not_reached([b]))|_],
       fake_host:did(log(communications(child, 1))),
       ( fake_host:did(log(communications(refusal, Count))), Count > 200 ) ]) :-
    two_reserved(Held).
acts(no_capacity_for_a_child, Held,
     [fake_clone(error(move_refused(here, capacity), _))],
     deallocate([reserved]),
     [ ( findall(Act, fake_host:did(Act), Acts),
         msort(Acts, [send(p, release(y)), send(q, release(x))]) ),
       sent(message, 3) ]) :-
    two_reserved(Held).
acts(shares, [], [], shares(2, [a, b, c, d, e], Shares),
     [Shares == [[a, b, c], [d, e]]]).
acts(no_more_shares_than_robots, [], [], shares(5, [a, b], Shares),
     [Shares == [[a], [b]]]).
acts(robot_asks_whether_it_is_needed, [held(a, p, y, 2, reserved)],
     [fake_mail(p-still(y)), fake_mail(q-still(x))], attend,
     [ did=[send(p, yes(y)), send(q, no(x))],
       sent(message, 4) ]).             % two links, there and back
acts(lost_robot, [held(a, p, y, 2, reserved)],
     [fake_mail(p-lost(z, preempted)), fake_mail(p-lost(y, preempted))], attend,
     [did=[log(lost(a, preempted))], \+ held(_, _, _, _, _)]).
acts(task_of_a_lost_robot_stays_done, [held(a, p, y, 2, done)],
     [fake_mail(p-lost(y, lapsed))], attend,
     [\+ held(_, _, _, _, _), achieved=2]).
acts(deadline_counts_from_the_start, [],
     [fake_fact(task(t, [1-[push]], [deadline(20)])), fake_at(7)], prepare,
     [until=27]).
acts(deadline, [], [fake_fact(until(30)), fake_at(30)], attend, [end=missed]).
acts(back_off_ends_at_the_deadline, [], [fake_fact(until(30))], rest(100),
     [end=missed, time=30]).
acts(executes, Held,
     [ fake_mail(p-answer(y, started)), fake_mail(q-done(x)),
       fake_mail(p-done(y)) ], execute(Outcome),
     [ Outcome == done,
       did=[send(p, start(y, sleep(4))), send(q, start(x, sleep(4)))] ]) :-
    team(reserved, reserved, Held).
acts(refused_robot_is_missing, Held, [fake_mail(p-answer(y, refused(none)))],
     execute(Outcome), [Outcome == missing, held(b, q, x, 2, started)]) :-
    team(reserved, reserved, Held).
acts(silent_robot_is_removed, Held, [], execute(Outcome),
     [ Outcome == missing, time=20,
       did=[ send(p, start(y, sleep(4))), send(p, status(y)),
             log(lost(a, silent)), send(p, release(y)) ] ]) :-
    team(reserved, done, Held).
acts(answering_robot_is_kept, Held, [],
     ( inquire([], Asked), test_fake_agent:fake_mail(p-answer(y, status(done))),
       monitor(Asked, 10, Outcome) ),
     [Asked == [p], Outcome == done]) :-
    team(started, done, Held).

two_reserved([held(a, p, y, 2, reserved), held(b, q, x, 1, reserved)]).

team(P, Q, [held(a, p, y, 1, P), held(b, q, x, 2, Q), achieved(1)]).

:- begin_tests(allocation_allocator).

test(allocator_negotiates, [ forall(negotiation(_, Facts, Answers, Checks)),
                             Wrong == [] ]) :-
    allocator(Facts),
    findall(fake_mail(r-answer(Ref, What)),
            ( member(Team-What, Answers), ref(Team, Ref) ), Before),
    fake_run(Before, negotiate, Checks, Wrong).
test(allocator_acts, [ forall(acts(_, Facts, Before, Goal, Checks)),
                       Wrong == [] ]) :-
    allocator(Facts),
    fake_run(Before, Goal, Checks, Wrong).

:- end_tests(allocation_allocator).
