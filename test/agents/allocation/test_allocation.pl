:- module(test_allocation, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../prolog/typhon').
:- use_module('../../../agents/allocation/reservations').
:- use_module('../../../agents/allocation/operator').
:- include('../../../agents/allocation/allocator/mobility_resource').
:- include('../../../agents/allocation/common/backoff_interval').
:- include('../../../agents/allocation/common/requirements').
:- include('../../../agents/allocation/allocator/trail').

/** <module> Allocation: equations, and decisions on a simulated host
*/

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

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

:- begin_tests(mobility_resource).

test(equation_7_1, Chi =:= 3.0) :-            % 2 (1 + 1/2 * 10/10)
    rewarded(2, 0.5, 10, 0, Chi).
test(reward_falls_with_the_missing_robots) :-     % 2 (1 + 1/2 * 1/10)
    rewarded(2, 0.5, 10, 9, Chi),
    close_to(Chi, 2.1).
test(equation_7_2) :-                        % 2 (1 - 1/2 * 2/(2 + 6))
    penalised(2, 0.5, 2, 10, 4, Chi),
    close_to(Chi, 1.75).
test(penalty_decrements_and_is_above_zero,
     [ forall(( member(Held, [0, 5, 9]), member(Times, [1, 10, 100]) )) ]) :-
    penalised(2, 1, Times, 10, Held, Chi),
    Chi < 2,
    Chi > 0.
test(decay_on_new_hosts_is_a_fifth, Chi =:= 8.0) :-
    decayed(10, 7, 8, 5, Chi).
test(decay_at_the_joint_is_a_fifth) :-          % tan(pi/4) = 1
    decayed(10, 7, 7, 5, Chi),
    close_to(Chi, 8).
test(decay_is_slow_in_a_large_network) :-
    decayed(1, 100, 0, 5, Chi),
    close_to(Chi, 0.9939571).                   % 1 - tan(pi/104)/5
test(equation_7_3) :-
    decayed(1, 8, 0, 5, Chi),
    close_to(Chi, 0.9464102).                   % 1 - tan(15 degrees)/5
test(first_search_on_new_hosts_lasts_31_hops, Hops == 31) :-
    lasts(10, 0, 1, Hops).
test(equation_7_4, [ forall(member(Found-Chi,
                              [10-0.028, 30-0.050, 100-0.100])) ]) :-
    restarted(Found, 5, 0.01, Chi0),
    abs(Chi0 - Chi) < 0.0005.
test(restart_lasts_one_hop_more_than_robots_are_known,
     [ forall(member(Found, [0, 1, 10, 30, 57, 100, 200])),
       Hops =:= Found + 1 ]) :-
    restarted(Found, 5, 0.01, Chi),
    lasts(Chi, Found, 0, Hops).
test(equation_7_5) :-
    interval(15, 1, 500, 0.5, Middle),
    Middle =:= 30.0,                            % 15 + 30/2
    interval(15, 2, 500, 1.0, Longest),
    Longest =:= 75.0,                           % 15 + 60
    interval(15, 3, 500, 0.0, Shortest),
    Shortest =:= 15.0.
test(equation_7_6, Theta =:= 15.0) :-
    reach_time(30, 0.5, Theta).
test(intervals_are_bounded, [ forall(member(Count, [6, 60, 5000])),
                              Interval =:= 515.0 ]) :-
    interval(15, Count, 500, 1.0, Interval).
test(equation_7_7, Thetas == [10, 10, 70]) :-
    maplist([Bids, Theta]>>bid_time(Bids, 10, Theta), [0, 1, 7], Thetas).

:- end_tests(mobility_resource).

                /*******************************
                *       NEEDS, WAYS, LOGS      *
                *******************************/

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

test(step, Trail == [d, c, b, a]) :-
    stepped(d, [c, e], [], [c, b, a], Trail).
test(step_over_a_removed_link, Trail == [d, c, b, a]) :-
    stepped(d, [], [a], [c, b, a], Trail).
test(cycle_is_removed, Trail == [b, a]) :-
    stepped(b, [d, c], [], [d, c, b, a], Trail).
test(detour_is_shortened, Trail == [e, b, a]) :-
    stepped(e, [b, d], [a], [d, c, b, a], Trail).
test(path_is_not_shortened_past_a_robot, Trail == [e, c, b, a]) :-
    stepped(e, [d, c, b], [c], [d, c, b, a], Trail).
test(round_trip_with_a_robot_is_kept, Trail == [b, d, c, b, a]) :-
    stepped(b, [d], [c, x], [d, c, b, a], Trail).
test(round_trip_to_a_robot, Trail == [c, b, a]) :-
    stepped(c, [d], [c], [d, c, b, a], Trail).
test(links, Counts == [0, 2, 4]) :-
    maplist([Host, Count]>>links(Host, [d, c, b, a], Count), [d, b, x],
            Counts).
test(back_step_by_step, Host-Distance == c-2) :-
    nearer([d, c, b, a], [a], [x, c], 4, Host, Distance).
test(back_by_a_shortcut, Host-Distance == b-1) :-
    nearer([d, c, b, a], [a], [c, b], 4, Host, Distance).
test(path_to_the_nearest_robot, Host-Distance == c-0) :-
    nearer([d, c, b, a], [a, c], [c, b], 4, Host, Distance).
test(path_leads_forward_too, Host-Distance == d-0) :-
    nearer([d, c, b, a], [d], [a, d, b], 4, Host, Distance).
test(neighbour_that_is_not_nearer_is_ignored, fail) :-
    nearer([d, c, b, a], [a], [c], 2, _, _).
test(broken_path, fail) :-
    nearer([c, b, a], [a], [x, y], 3, _, _).
test(path_without_robots, fail) :-
    nearer([c, b, a], [z], [c, b], 3, _, _).

cost_of(Payload, Details, Properties, Cost) :-
    payload_clauses(Payload, Clauses),
    maplist([Clause]>>assertz(test_allocation_payload:Clause), Clauses),
    call_cleanup(
        once(test_allocation_payload:cost(need(t, [], Details), Properties,
                                          Cost)),
        abolish(test_allocation_payload:cost/3)).

payload_clauses(Payload, Clauses) :-
    typhon_programs:payload_load(Payload, payload(_, _, Clauses)).

test(nearest, Cost =:= 5.0) :-
    cost_of(payloads(allocation/nearest), [at(p(4, 6))], [position=p(1, 2)],
            Cost).
test(path_to_the_same_host_costs_nothing, Cost =:= 0) :-
    cost_of(payloads(allocation/nearest), [], [position=p(1, 2)], Cost).
test(energy, Cost =:= 0.5) :-
    cost_of(payloads(allocation/energy), [energy(2)], [battery=4], Cost).
test(too_little_energy, fail) :-
    cost_of(payloads(allocation/energy), [energy(2)], [battery=1], _).
test(thrifty_accepts_higher_costs_with_each_round, Agreed == [2-0, 4-1, 8-2]) :-
    payload_clauses(payloads(allocation/thrifty), [Clause]),
    assertz(test_allocation_payload:Clause),
    call_cleanup(
        findall(Cost-Count,
                ( member(Count, [0, 1, 2]), member(Cost, [8, 4, 2]),
                  once(test_allocation_payload:agreed(Cost, [budget(2)],
                                                      Count)) ),
                All),
        abolish(test_allocation_payload:agreed/3)),
    findall(Most-Count,
            ( member(Count, [0, 1, 2]),
              findall(Cost, member(Cost-Count, All), Costs),
              max_list(Costs, Most) ),
            Agreed).

faults(Whats, Faults) :-
    findall(event(Time, h, r, What), nth1(Time, Whats, What), Events),
    reservation_faults(Events, Faults).

test(no_faults, Faults == []) :-
    faults([ begun(t), reserved(h, a, t), executed(h, a, t), ended(done),
             released(h, a, t), reserved(h, b, u), released(h, b, u) ],
           Faults).
test(reserved_twice, Faults == [twice(h, a, b, 2)]) :-
    faults([ reserved(h, a, t), reserved(h, b, u), released(h, b, u) ],
           Faults).
test(reserved_twice_by_one_allocator, Faults == [twice(h, a, a, 2)]) :-
    faults([ reserved(h, a, t), reserved(h, a, t), released(h, a, t) ],
           Faults).
test(stray_robots,
     Faults == [ stray(h, a, executed, 1), stray(h, b, executed, 3),
                 stray(h, b, released, 4), held(h, a, t) ]) :-
    faults([ executed(h, a, t), reserved(h, a, t), executed(h, b, t),
             released(h, b, t) ],
           Faults).
test(still_reserved, Faults == [held(h, a, t)]) :-
    faults([reserved(h, a, t)], Faults).

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

need(Task, need(Task, [push], [])).
need(Task, Priority, need(Task, [push], [priority(Priority)])).

%   say(+From, +Message, -Acts): Acts are the robot's reaction to Message.

say(From, Message, Acts) :-
    retractall(fake_host:did(_)),
    ignore(fake_agent:handle(From-Message)),
    did(Acts).

reserved(Ref, From) :-
    need(Ref, Need),
    say(From, reserve(Ref, owner, Need), Acts),
    Acts == [ log(reserved(here, owner, Ref)),
              send(From, answer(Ref, reserved)) ].

hold(Ref, Phase) :-
    fake_agent:hold(Ref, _, _, _, Phase).

%   Sets the clock to the time at which the agent asks or gives up.

overdue(Acts) :-
    fake_agent:due(Time, _),
    fake_at(Time),
    retractall(fake_host:did(_)),
    fake_agent:next(Event),
    fake_agent:handle(Event),
    did(Acts).

:- begin_tests(allocation_robot).

test(bids, Acts == [send(x, answer(r, bid(3)))]) :-
    robot([]),
    need(t, Need),
    say(x, ask(r, Need), Acts).
test(unfit, [ forall(member(Requirements, [[fly], [battery>=2]])),
              Acts == [send(x, answer(r, refused(unfit)))] ]) :-
    robot([]),
    say(x, ask(r, need(t, Requirements, [])), Acts).
test(cost_payload_refuses,
     Acts == [send(x, answer(r, refused(unfit)))]) :-
    robot([property(lift)]),
    say(x, ask(r, need(t, [lift], [])), Acts).
test(reserved_once,
     Acts1-Acts2 == [send(y, answer(s, refused(reserved)))]
                    -[send(y, answer(s, refused(reserved)))]) :-
    robot([]),
    reserved(r, x),
    need(t, Need),
    say(y, ask(s, Need), Acts1),
    say(y, reserve(s, other, Need), Acts2),
    hold(r, reserved).
test(repeated_request_gets_the_same_answer,
     Acts == [send(x, answer(r, reserved))]) :-
    robot([]),
    reserved(r, x),
    need(r, Need),
    say(x, reserve(r, owner, Need), Acts).
test(released_by_the_reserving_allocator,
     Acts == [ log(released(here, owner, r)),
               send(child, answer(r, released))
             ]) :-
    robot([]),
    reserved(r, x),
    say(child, release(s), [send(child, answer(s, released))]),
    hold(r, reserved),
    say(child, release(r), Acts),
    \+ hold(_, _),
    \+ fake_agent:due(_, _).
test(urgent_task_preempts_reservation,
     Acts == [ log(released(here, owner, r)), send(x, lost(r, preempted)),
               log(reserved(here, other, u)), send(y, answer(s, reserved))
             ]) :-
    robot([]),
    reserved(r, x),
    need(u, 1, Need),
    say(y, ask(s, Need), [send(y, answer(s, bid(3)))]),
    say(y, reserve(s, other, Need), Acts),
    hold(s, reserved).
test(equal_task_does_not_preempt,
     Acts == [send(y, answer(s, refused(reserved)))]) :-
    robot([]),
    need(t, 1, Need),
    say(x, reserve(r, owner, Need), _),
    say(y, reserve(s, other, Need), Acts).
test(executing_robot_is_not_preempted,
     Acts == [send(y, answer(s, refused(executing)))]) :-
    robot([]),
    reserved(r, x),
    say(x, start(r, true), [send(x, answer(r, started))]),
    need(u, 9, Need),
    say(y, reserve(s, other, Need), Acts).
test(start_without_reservation,
     Acts == [send(x, answer(r, refused(none)))]) :-
    robot([]),
    say(x, start(r, true), Acts).
test(start_without_capacity, Acts == [send(x, answer(r, refused(capacity)))]) :-
    robot([]),
    reserved(r, x),
    fake_clone(error(move_refused(here, capacity), _)),
    say(x, start(r, true), Acts),
    hold(r, reserved).
test(executed, Acts == [log(executed(here, owner, r)), send(x, done(r))]) :-
    robot([]),
    reserved(r, x),
    say(x, start(r, true), _),
    say(x, status(r), [send(x, answer(r, status(executing)))]),
    say(child, finished(r, done), Acts),
    say(x, status(r), [send(x, answer(r, status(done)))]),
    hold(r, done).
test(message_of_an_earlier_execution_thread_is_ignored, Acts == []) :-
    robot([]),
    reserved(r, x),
    say(x, start(r, true), _),
    say(other, finished(r, done), Acts).
test(failed_execution, Acts == [ log(released(here, owner, r)),
                                 send(x, lost(r, raised(oops))) ]) :-
    robot([]),
    reserved(r, x),
    say(x, start(r, true), _),
    say(child, finished(r, raised(oops)), Acts),
    \+ hold(_, _).
test(execution_thread_performs_the_task,
     [ forall(member(Goal-Outcome,
                     [ true-done, fail-failed, throw(oops)-raised(oops),
                       atom_length(_, _)-raised(instantiation_error) ])),
       Act == send(robot, finished(r, Outcome)) ]) :-
    robot([]),
    reserved(r, x),
    retractall(fake_host:did(_)),
    fake_clone(clone(robot)),
    catch(fake_agent:handle(x-start(r, Goal)), disposed, true),
    did([Act]).
test(status_without_reservation, Acts == [send(x, answer(r, status(none)))]) :-
    robot([]),
    say(x, status(r), Acts).
test(failure, Acts == [ log(robot(failed)), log(released(here, owner, r)),
                        send(x, lost(r, failed)) ]) :-
    robot([]),
    reserved(r, x),
    say(user, fail, Acts),
    need(t, Need),
    say(x, ask(s, Need), [send(x, answer(s, refused(failed)))]),
    say(user, repair, [log(robot(repaired))]),
    say(x, ask(s, Need), [send(x, answer(s, bid(3)))]).
test(state_changes, Acts == [send(x, answer(r, bid(3)))]) :-
    robot([]),
    Need = need(t, [push, battery=<0.5], []),
    say(x, ask(r, Need), [send(x, answer(r, refused(unfit)))]),
    say(user, state(battery=0.2), []),
    say(x, ask(r, Need), Acts).
test(robot_asks_whether_it_is_still_needed,
     Asked-Time == [send(x, still(r))]-60) :-
    robot([]),
    reserved(r, x),
    fake_agent:due(Time, _),
    overdue(Asked).
test(silent_allocator_frees_the_robot, Acts == [ log(released(here, owner, r)),
                                                 send(x, lost(r, lapsed)) ]) :-
    robot([setting(watch, 10), setting(patience, 3)]),
    reserved(r, x),
    overdue(_),
    overdue(Acts),
    fake_host:time(13).
test(positive_answer_keeps_the_reservation) :-
    robot([setting(watch, 10), setting(patience, 3)]),
    reserved(r, x),
    overdue(_),
    say(x, yes(s), []),
    fake_agent:due(13, answer),
    say(x, yes(r), []),
    fake_agent:due(20, ask),
    hold(r, reserved).
test(negative_answer_frees_the_robot,
     Acts == [log(released(here, owner, r))]) :-
    robot([]),
    reserved(r, x),
    overdue(_),
    say(x, no(r), Acts).
test(allocator_is_checked_during_execution,
     Acts == [ log(released(here, owner, r)),
               send(x, lost(r, lapsed)) ]) :-
    robot([]),
    reserved(r, x),
    say(x, start(r, true), _),
    overdue(_),
    overdue(Acts).
test(checks_can_be_disabled) :-
    robot([setting(watch, inf)]),
    reserved(r, x),
    \+ fake_agent:due(_, _).
test(invalid_messages_are_ignored, Acts == []) :-
    robot([]),
    say(x, hello(r), Acts).

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

push(ask(ref(me, 0, 3, 1), need(t, [push], [duration(4)]))).
lift(ask(ref(me, 0, 3, 2), need(t, [lift], [duration(4)]))).

answers(Team, What) :-
    fake_mail(r-answer(ref(me, 0, 3, Team), What)).

chi(Chi) :-
    fake_agent:chi(Chi).

:- begin_tests(allocation_allocator).

test(reservation_is_rewarded) :-       % 1 (1 + 1/2 * 3/3)
    allocator([]),
    answers(1, bid(3)),
    answers(1, reserved),
    fake_agent:negotiate,
    push(Push),
    Push = ask(Ref, Need),
    did([send(r, Push), send(r, reserve(Ref, me, Need))]),
    fake_agent:held(here, r, Ref, 1, reserved),
    \+ fake_agent:sent(message, _),    % the robot is at the same host
    chi(Chi),
    Chi =:= 1.5.
test(second_reward_is_less) :-          % 1 (1 + 2/2 * 2/3)
    allocator([held(b, q, x, 1, reserved)]),
    retractall(fake_agent:sojourn(_, _, _, _)),
    assertz(fake_agent:sojourn(3, 2, 1, 0)),
    answers(1, bid(3)),
    answers(1, reserved),
    fake_agent:negotiate,
    chi(Chi),
    close_to(Chi, 5/3).
test(robot_for_the_other_team) :-
    allocator([]),
    answers(1, refused(unfit)),
    answers(2, bid(0)),
    answers(2, reserved),
    fake_agent:negotiate,
    push(Push),
    lift(Lift),
    did([send(r, Push), send(r, Lift), send(r, reserve(_, _, _))]),
    fake_agent:held(here, r, _, 2, reserved).
test(complete_team_gets_no_request) :-
    allocator([held(b, q, x, 1, reserved), achieved(1)]),
    answers(2, refused(unfit)),
    fake_agent:negotiate,
    lift(Lift),
    did([send(r, Lift)]).
test(refusal_is_penalised, [ forall(member(Reason, [reserved, executing])) ]) :-
    allocator([]),                      % 1 (1 - 1/2 * 1/(1 + 3))
    answers(1, refused(Reason)),
    fake_agent:negotiate,
    chi(Chi),
    close_to(Chi, 0.875).
test(no_penalty, [ forall(member(What, [refused(failed), bid(11)])) ]) :-
    allocator([]),
    answers(1, What),
    fake_agent:negotiate,
    chi(1),
    \+ fake_agent:held(_, _, _, _, _).
test(expensive_robot_is_not_reserved, Acts == [send(r, Push)]) :-
    allocator([]),
    push(Push),
    answers(1, bid(11)),
    answers(1, reserved),
    fake_agent:negotiate,
    did(Acts).
test(silent_robot_is_skipped, Time == 20) :-
    allocator([]),
    fake_agent:negotiate,
    chi(1),
    fake_host:time(Time).
test(already_reserved_robot_gets_no_request) :-
    allocator([held(here, r, x, 1, reserved)]),
    fake_agent:negotiate,
    did([]).
test(migrates) :-                       % 3 found, 3 visited: a fifth
    allocator([]),
    fake_agent:proceed,
    did([move(next)]),
    chi(Chi),
    close_to(Chi, 0.8),
    fake_agent:sojourn(4, 3, 0, 0),
    fake_agent:sent(migration, 1).
test(refused_move_counts) :-
    allocator([]),
    fake_refusal(next),
    fake_agent:proceed,
    fake_agent:sent(refusal, 1),
    fake_agent:sojourn(3, 2, 0, 0),
    fake_host:time(1).
test(backs_off) :-
    allocator([ held(b, q, x, 1, reserved), held(a, p, y, 2, done),
                setting(backoff, constant) ]),
    retractall(fake_agent:chi(_)),
    assertz(fake_agent:chi(0.01)),
    fake_agent:proceed,
    did([log(backoff(Interval))]),      % a child is about
    Interval >= 10,
    Interval =< 30,
    fake_host:time(Interval),
    fake_agent:backoffs(1),
    \+ fake_agent:held(_, _, _, _, _),
    fake_agent:achieved(2),
    fake_agent:sojourn(0, 0, 0, 0),
    fake_agent:trail([here]),
    restarted(3, 5, 0.01, Chi),
    chi(Chi).
test(newer_information_is_carried_and_left) :-
    allocator([ setting(sharing, shared), news(b, [push], taken, 5),
                news(a, [lift], free, 7) ]),
    fake_host:leave(robots([ news(b, [push], free, 6),
                             news(a, [lift], taken, 6) ])),
    fake_agent:exchange,
    fake_host:tuple(robots(News)),
    msort(News, [news(a, [lift], free, 7), news(b, [push], free, 6)]),
    fake_agent:news(b, [push], free, 6).
test(without_sharing_no_information_is_left,
     [forall(member(S, [none, own]))]) :-
    allocator([setting(sharing, S), news(b, [push], free, 5)]),
    fake_agent:exchange,
    \+ fake_host:tuple(robots(_)).
test(migrates_to_the_last_reported_free_neighbour, Host == c) :-
    allocator([ setting(sharing, own), news(b, [push], free, 5),
                news(c, [push], free, 6), news(d, [push], taken, 7),
                news(e, [fly], free, 8), news(f, [push], free, 9) ]),
    fake_neighbours([b, c, d, e]),
    fake_agent:next_place(Host).
test(no_free_neighbour_is_known, Host == next) :-
    allocator([setting(sharing, own), news(f, [push], free, 9)]),
    fake_neighbours([b, c]),
    fake_agent:next_place(Host).
test(reservations_and_releases_are_shared) :-
    allocator([setting(sharing, own)]),
    answers(1, bid(3)),
    answers(1, reserved),
    fake_agent:negotiate,
    fake_agent:news(here, [push], taken, _),
    fake_at(9),
    fake_agent:deallocate([reserved]),
    fake_agent:news(here, [push], free, 9).
test(executing_robots_are_not_released) :-
    allocator([ held(b, q, x, 1, started), setting(backoff, constant) ]),
    fake_agent:back_off,
    fake_agent:held(b, q, x, 1, started),
    fake_agent:trail([here, b, a]).
test(child_returns, Acts-Dies ==
                    [ move(b), send(q, release(x)),
                      move(a), send(p, release(y)),
                      log(communications(child, 2)) ]-true) :-
    allocator([ held(a, p, y, 2, reserved), held(b, q, x, 1, reserved) ]),
    fake_clone(clone(me)),
    fake_neighbours([b, a, c]),
    catch(fake_agent:deallocate([reserved]), disposed, Dies = true),
    did(Acts).
test(child_skips_a_host_that_refuses_it) :-
    allocator([ held(a, p, y, 2, reserved), held(b, q, x, 1, reserved) ]),
    fake_clone(clone(me)),
    fake_neighbours([b, a, c]),
    fake_refusal(b),
    fake_refusal(next),
    catch(fake_agent:deallocate([reserved]), disposed, true),
    did(Acts),
    Acts = [ move(a), send(p, release(y)), log(not_reached([b])) | Sums ],
    memberchk(log(communications(child, 1)), Sums),
    memberchk(log(communications(refusal, Count)), Sums),
    Count > 200.
test(no_capacity_for_a_child) :-
    allocator([ held(a, p, y, 2, reserved), held(b, q, x, 1, reserved) ]),
    fake_clone(error(move_refused(here, capacity), _)),
    fake_agent:deallocate([reserved]),
    did(Acts),
    msort(Acts, [send(p, release(y)), send(q, release(x))]),
    fake_agent:sent(message, 3).
test(shares, Shares == [[a, b, c], [d, e]]) :-
    allocator([]),
    fake_agent:shares(2, [a, b, c, d, e], Shares).
test(no_more_shares_than_robots, Shares == [[a], [b]]) :-
    allocator([]),
    fake_agent:shares(5, [a, b], Shares).
test(robot_asks_whether_it_is_needed) :-
    allocator([held(a, p, y, 2, reserved)]),
    fake_mail(p-still(y)),
    fake_mail(q-still(x)),
    fake_agent:attend,
    did([send(p, yes(y)), send(q, no(x))]),
    fake_agent:sent(message, 4).        % two links, there and back
test(lost_robot) :-
    allocator([held(a, p, y, 2, reserved)]),
    fake_mail(p-lost(z, preempted)),
    fake_mail(p-lost(y, preempted)),
    fake_agent:attend,
    did([log(lost(a, preempted))]),
    \+ fake_agent:held(_, _, _, _, _).
test(task_of_a_lost_robot_stays_done) :-
    allocator([held(a, p, y, 2, done)]),
    fake_mail(p-lost(y, lapsed)),
    fake_agent:attend,
    \+ fake_agent:held(_, _, _, _, _),
    fake_agent:achieved(2).
test(deadline_counts_from_the_start, Until == 27) :-
    allocator([]),
    retractall(fake_agent:task(_, _, _)),
    assertz(fake_agent:task(t, [1-[push]], [deadline(20)])),
    fake_at(7),
    fake_agent:prepare,
    fake_agent:until(Until).
test(deadline, throws(missed)) :-
    allocator([]),
    retractall(fake_agent:until(_)),
    assertz(fake_agent:until(30)),
    fake_at(30),
    fake_agent:attend.
test(back_off_ends_at_the_deadline, Time == 30) :-
    allocator([]),
    retractall(fake_agent:until(_)),
    assertz(fake_agent:until(30)),
    catch(fake_agent:rest(100), missed, true),
    fake_host:time(Time).
test(executes, Outcome == done) :-
    allocator([ held(a, p, y, 1, reserved), held(b, q, x, 2, reserved),
                achieved(1) ]),
    forall(member(From-What, [ p-answer(y, started), q-done(x), p-done(y) ]),
           fake_mail(From-What)),
    fake_agent:execute(Outcome),
    did([send(p, start(y, sleep(4))), send(q, start(x, sleep(4)))]).
test(refused_robot_is_missing, Outcome == missing) :-
    allocator([ held(a, p, y, 1, reserved), held(b, q, x, 2, reserved),
                achieved(1) ]),
    fake_mail(p-answer(y, refused(none))),
    fake_agent:execute(Outcome),
    fake_agent:held(b, q, x, 2, started).
test(silent_robot_is_removed, Outcome-Time == missing-20) :-
    allocator([ held(a, p, y, 1, reserved), held(b, q, x, 2, done),
                achieved(1) ]),
    fake_agent:execute(Outcome),
    fake_host:time(Time),
    did_just([ send(p, start(y, sleep(4))), send(p, status(y)),
               log(lost(a, silent)), send(p, release(y)) ]).
test(answering_robot_is_kept, Outcome == done) :-
    allocator([ held(a, p, y, 1, started), held(b, q, x, 2, done),
                achieved(1) ]),
    fake_agent:inquire([], Asked),
    Asked == [p],
    fake_mail(p-answer(y, status(done))),
    fake_agent:monitor(Asked, 10, Outcome).

:- end_tests(allocation_allocator).
