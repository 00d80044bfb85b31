:- use_module('../../lib/fake_agent').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- include('../../../agents/sync/potential').

/** <module> Synchronised execution: equations and decisions

The decisions of agents are tested on a simulated host; for networks see
test_sync_network.pl.
*/

                /*******************************
                *           EQUATIONS          *
                *******************************/

%   steps(+Delta, +Rewarded, -ToOne, -ToZero): the number of steps until the
%   potential is at most 1, and until it is 0, of an agent that is rewarded
%   in the steps Rewarded and penalised in all others.

steps(Delta, Rewarded, ToOne, ToZero) :-
    drive_after(Delta, Rewarded, 1, 0, drive(100, [15]), ToOne),
    drive_after(Delta, Rewarded, 0, 0, drive(100, [15]), ToZero).

drive_after(_, _, Level, N, drive(P, _), N) :-
    P =< Level,
    !.
drive_after(Delta, Rewarded, Level, N0, Drive0, N) :-
    N1 is N0 + 1,
    (   memberchk(N1, Rewarded)
    ->  rewarded(Drive0, 100, 15, _, Drive)
    ;   penalised(Drive0, 100, 15, Delta, _, Drive)
    ),
    drive_after(Delta, Rewarded, Level, N1, Drive, N).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-9.

:- begin_tests(potential).

test(equation_5_1, Ps == [100, 75, 45, 0]) :-
    increase(95, 15, 100, P1),
    increase(60, 15, 100, P2),
    decrease(60, 15, P3),
    decrease(3, 3.1, P4),
    Ps = [P1, P2, P3, P4].
test(equation_5_2, [ forall(member(Bias-Size, [0-6, 0.5-6.5])),
                     Theta =:= Size ]) :-       % (15 + 9)/2 * 50/100
    theta([15, 9], 50, 100, Bias, Theta).
test(theta_of_a_full_potential, Theta =:= 15) :-
    theta([15], 100, 100, 0, Theta).
test(theta_averages_the_window, Theta =:= 5.5) :-
    theta([2, 4, 9], 100, 100, 0.5, Theta).
test(bias_is_outside_the_product, Theta =:= 0.8) :-
    theta([15], 0, 100, 0.8, Theta).
test(window_grows, H == [1, 2, 3]) :-
    slide(3, [1, 2], 3, H).
test(window_slides, H == [2, 3, 4]) :-
    slide(3, [1, 2, 3], 4, H).
test(two_penalties_by_hand) :-
    penalised(drive(100, [15]), 100, 15, 0.5, T1, D1),
    D1 = drive(P1, H1),
    close_to(T1, 15.5),
    close_to(P1, 84.5),
    H1 == [15, T1],
    penalised(D1, 100, 15, 0.5, T2, drive(P2, _)),
    close_to(T2, 13.38625),         % (15 + 15.5)/2 * 0.845 + 0.5
    close_to(P2, 71.11375).
test(reward_enters_the_window, Drive == drive(45, [10, 5])) :-
    rewarded(drive(40, [10]), 80, 15, 5, Drive).
test(steps, [ forall(member(Delta-ToOne/ToZero,
                            [ 0.2-72/76, 0.3-51/54, 0.5-35/37,
                              0.8-25/26, 1.0-22/23 ])),
              One/Zero == ToOne/ToZero ]) :-
    steps(Delta, [], One, Zero).
test(rewards_only_postpone,
     [ forall(member(Delta-ToZero,
                     [ 0.2-90, 0.3-67, 0.5-48, 0.8-37, 1.0-34 ])),
       Zero == ToZero ]) :-
    steps(Delta, [1, 2, 3, 5, 7, 10, 13], _, Zero).
test(stalls_without_bias, true(P > 10)) :-
    numlist(1, 2000, Steps),
    foldl(unbiased, Steps, drive(100, [15]), drive(P, _)).

unbiased(_, Drive0, Drive) :-
    penalised(Drive0, 100, 15, 0, _, Drive).

test(random_histories_stay_within_bounds, Wrong == []) :-
    findall(Seed, ( between(1, 100, Seed), out_of_bounds(Seed) ), Wrong).
test(penalties_alone_come_to_exactly_zero, Wrong == []) :-
    findall(Seed, ( between(1, 100, Seed), \+ comes_to_zero(Seed) ), Wrong).

%   The constants of an agent, drawn from Seed.

drawn(Seed, Maximum, Theta, Window, Delta) :-
    set_random(seed(Seed)),
    Maximum is 1 + random(1000),
    Theta is Maximum * random_float,
    Window is 1 + random(20),
    Delta is 0.01 + random_float.

out_of_bounds(Seed) :-
    drawn(Seed, Maximum, Theta, Window, Delta),
    numlist(1, 150, Steps),
    \+ foldl(within_bounds(Maximum, Window, Delta), Steps,
             drive(Maximum, [Theta]), _).

within_bounds(Maximum, Window, Delta, Step, Drive0, drive(P, History)) :-
    (   random_float < 0.4
    ->  rewarded(Drive0, Maximum, Window, Theta, drive(P, History)),
        Theta >= 0
    ;   penalised(Drive0, Maximum, Window, Delta, Theta, drive(P, History)),
        Theta >= Delta
    ),
    P >= 0,
    P =< Maximum,
    last(History, Theta),
    length(History, Length),
    Length =:= min(Window, Step + 1).

comes_to_zero(Seed) :-
    drawn(Seed, Maximum, Theta, Window, Delta),
    Most is ceiling(Maximum / Delta),
    zero_within(Most, drive(Maximum, [Theta]), Maximum, Window, Delta).

zero_within(_, drive(P, _), _, _, _) :-
    P =:= 0,
    !.
zero_within(Steps, Drive0, Maximum, Window, Delta) :-
    Steps > 0,
    penalised(Drive0, Maximum, Window, Delta, _, Drive),
    Steps1 is Steps - 1,
    zero_within(Steps1, Drive, Maximum, Window, Delta).

:- end_tests(potential).

                /*******************************
                *           DECISIONS          *
                *******************************/

%   The sequence `house`, in its first version.

traveller(Facts, Tuples) :-
    fake_agent('agents/sync/traveller.pl',
               [ plan(house, 1, [1-floor, 2-walls, 3-ceiling]) | Facts ],
               Tuples),
    fake_at(7),
    fake_agent:fill_new.

worker(Tuples) :-
    fake_agent('agents/sync/worker.pl', [sequence(house)], Tuples),
    fake_at(7).

drive(Task, Potential, History) :-
    fake_agent:drive(Task, Potential, History).

%   The state after a finished search.

exhaust(Task) :-
    fake_agent:keep(Task, drive(0, [15, 0.2])).

:- begin_tests(decisions).

test(begins_full, P-H == 100-[15]) :-
    traveller([], []),
    drive(2, P, H).
test(settings_replace_defaults, P-H == 80-[10]) :-
    traveller([setting(maximum, 80), setting(theta, 10)], []),
    drive(2, P, H).
test(searches_the_first_task_first, Task == 1) :-
    traveller([], []),
    fake_agent:current(Task).
test(searches_the_next_task, Task == 2) :-
    traveller([], []),
    exhaust(1),
    fake_agent:current(Task).
test(ends_after_the_last_task, fail) :-
    traveller([], []),
    forall(member(Task, [1, 2, 3]), exhaust(Task)),
    fake_agent:current(_).
test(services_a_host_that_lacks_the_task) :-
    traveller([], [worker(house, w)]),
    exhaust(1),
    fake_host:leave(task(house, 1, completed, 5)),
    fake_agent:keep(2, drive(50, [10])),
    fake_agent:visit(2),
    just_tuples([ task(house, 1, completed, 5),
                  plan(house, 1, [1-floor, 2-walls, 3-ceiling]),
                  task(house, 2, executing, 7)
                ]),
    did_just([send(w, execute(2, walls)), log(reward(2, 55, 5))]),
    drive(2, 55, [10, 5]).
test(leaves_an_executing_host_alone) :-
    traveller([], [task(house, 1, executing, 5)]),
    fake_agent:visit(1),
    did_just([]),
    drive(1, 100, [15]).
test(leaves_the_worker_of_another_sequence_alone) :-
    traveller([], [worker(garden, w)]),
    fake_agent:visit(1),
    just_tuples([worker(garden, w)]),
    did_just([]),
    drive(1, 100, [15]).
test(is_penalised_where_the_task_is_completed) :-
    traveller([], [worker(house, w), task(house, 1, completed, 5)]),
    fake_agent:visit(1),
    just_tuples([task(house, 1, completed, 5), worker(house, w)]),
    did_just([log(penalty(1, 84.5, 15.5))]),
    drive(1, 84.5, [15, 15.5]).
test(algorithm_2, Moves == 111) :-      % gives up what is done everywhere
    host_with([1, 2, 3], [], Tuples),
    traveller([], Tuples),
    fake_agent:main,
    did([log(begun)|Acts]),
    aggregate_all(count, member(move(next), Acts), Moves),  % three times 37
    aggregate_all(count, member(log(penalty(_, _, _)), Acts), Moves),
    potentials(Ps),
    Ps == [0, 0, 0].
test(waits_for_the_order_to_begin, Before-After == []-[log(begun)]) :-
    host_with([1, 2, 3], [], Tuples),
    traveller([setting(start, order), setting(delta, 1000)], Tuples),
    \+ fake_agent:main,                 % receive/1 fails without mail
    did(Before),
    fake_mail(user-begin),
    fake_agent:main,
    did(Acts),
    Acts = [First|_],
    After = [First].
test(waits_where_it_cannot_move, Time == 15) :-
    host_with([1, 2, 3], [], Tuples),
    traveller([setting(delta, 1000), setting(patience, 2)], Tuples),
    fake_at(9),
    fake_refusal(next),
    fake_agent:main,                    % a pause for each of the penalties
    fake_host:now(Time).

:- end_tests(decisions).

                /*******************************
                *       SEVERAL SEQUENCES      *
                *******************************/

%   The plan of a house is on the host, and its worker belongs to a pool.

pooled(Facts, Tuples) :-
    traveller([setting(pool, robots)|Facts],
              [plan(house, 1, []), worker(robots, w)|Tuples]).

:- begin_tests(several).

test(worker_of_a_pool_gets_the_sequence,
     Acts == [send(w, execute(house, 1, floor)), log(reward(1, 100, 15))]) :-
    pooled([], []),
    fake_agent:visit(1),
    did(Acts).
test(host_without_plan_has_no_part, Acts == []) :-
    traveller([setting(pool, robots)], [worker(robots, w)]),
    fake_agent:visit(1),
    did(Acts).
test(busy_worker_of_a_pool_is_left_alone, Acts == []) :-
    traveller([setting(pool, robots)], [plan(house, 1, [])]),
    fake_agent:visit(1),
    did(Acts).
test(task_waits_for_a_task_of_another_sequence) :-
    pooled([after(1, garden, dig)], [plan(garden, 1, [])]),
    fake_agent:keep(1, drive(50, [10])),
    fake_agent:visit(1),
    did_just([log(reward(1, 55, 5))]),
    fake_host:tuple(worker(robots, w)).
test(completed_task_releases_the_waiting_one) :-
    pooled([after(1, garden, dig)],
           [plan(garden, 1, []), task(garden, dig, completed, 3)]),
    fake_agent:visit(1),
    did([send(w, execute(house, 1, floor))|_]).
test(host_without_the_other_sequence_does_not_wait) :-
    pooled([after(1, garden, dig)], []),
    fake_agent:visit(1),
    did([send(w, execute(house, 1, floor))|_]).

:- end_tests(several).

                /*******************************
                *            HEALING           *
                *******************************/

serviced(Task) :-
    fake_host:tuple(task(house, Task, executing, 7)).

%   A host of which the tasks Completed are completed.

host_with(Completed, More, Tuples) :-
    findall(task(house, Task, completed, 5), member(Task, Completed), Tuples0),
    append([[worker(house, w)], Tuples0, More], Tuples).

potentials(Ps) :-
    findall(P, ( member(Task, [1, 2, 3]), drive(Task, P, _) ), Ps).

:- begin_tests(healing).

test(algorithm_2_line_29) :-            % as in Figure 5.3
    host_with([1, 3], [], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:keep(3, drive(40, [15, 10])),
    fake_agent:visit(3),
    did_just([ log(revived(2, 10)),
               send(w, execute(2, walls)),
               log(reward(2, 11.5, 1.5))
             ]),
    drive(2, 11.5, [15, 1.5]),
    drive(3, 40, [15, 10]),
    fake_agent:current(Task),
    Task == 2.
test(the_first_one_missing_is_serviced_first) :-
    traveller([], [worker(house, w)]),
    exhaust(1),
    exhaust(2),
    fake_agent:visit(3),
    serviced(Task),
    Task == 1.
test(later_ones_do_not_matter_yet) :-
    host_with([1], [], Tuples),
    traveller([], Tuples),
    fake_agent:visit(1),
    did_just([log(penalty(1, 84.5, 15.5))]).
test(mark_of_an_atomic_failure_is_removed) :-
    host_with([1, 3], [task(house, 2, failed(atomic), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:keep(3, drive(40, [15, 10])),
    fake_agent:visit(3),
    potentials(Ps),
    Ps == [0, 11.5, 40],
    serviced(2),
    \+ fake_host:tuple(task(_, _, failed(_), _)).
test(cascaded_failure_fills_the_task_and_all_later_ones) :-
    host_with([1], [task(house, 2, failed(cascaded(2)), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:keep(3, drive(40, [15, 10])),
    fake_agent:visit(3),
    did([Revived|_]),
    Revived == log(revived(2, 100)),
    serviced(2),
    \+ fake_host:tuple(task(_, _, failed(_), _)),
    drive(1, 0, _),
    drive(2, 100, [15, 15]),            % the history begins again
    drive(3, 100, [15]).
test(cascaded_failure_of_the_task_itself_fills_the_later_ones) :-
    host_with([1], [task(house, 2, failed(cascaded(2)), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    fake_agent:keep(2, drive(50, [10])),
    exhaust(3),
    fake_agent:visit(2),
    potentials(Ps),
    Ps == [0, 55, 100],
    did([send(w, execute(2, walls)), log(reward(2, 55, 5))]).
test(cascaded_failure_is_healed_from_its_first_task_on) :-
    host_with([1], [task(house, 2, failed(cascaded(1)), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:keep(3, drive(40, [15, 10])),
    fake_agent:visit(3),
    potentials(Ps),
    Ps == [100, 100, 100],
    did_just([log(revived(1, 100))]),
    fake_host:tuple(worker(house, _)),
    \+ fake_host:tuple(task(_, _, executing, _)).
test(known_cascaded_failure_is_healed_task_by_task) :-
    host_with([1], [task(house, 2, failed(cascaded(1)), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    fake_agent:keep(2, drive(50, [10])),
    fake_agent:visit(2),
    potentials(Ps),
    Ps == [0, 55, 100],
    serviced(2).
test(last_task_is_healed, true(Ps == [0, 0, 100])) :-
    host_with([1, 2], [task(house, 3, failed(cascaded(3)), 6)], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:visit(3),
    potentials(Ps).

:- end_tests(healing).

                /*******************************
                *             PLANS            *
                *******************************/

agent_plan(Plan) :-
    Plan = plan(_, _, _),
    call(fake_agent:Plan),
    !.

:- begin_tests(plans).

test(newer_plan_is_adopted) :-
    New = plan(house, 2, [1-floor, door-hang, 3-ceiling]),
    traveller([], [New]),
    exhaust(1),
    fake_agent:compare_plans,
    agent_plan(Plan),
    Plan == New,
    findall(Task-P, drive(Task, P, _), Drives0),
    msort(Drives0, Drives),
    Drives == [1-0, 3-100, door-100],
    just_tuples([New]),
    did_just([log(adopted(2))]),
    fake_agent:current(Task),
    Task == door.
test(older_plan_is_replaced, Tuples == [plan(house, 1, [1-floor, 2-walls,
                                                        3-ceiling])]) :-
    traveller([], [plan(house, 0.5, [1-floor])]),
    fake_agent:compare_plans,
    tuples(Tuples),
    did([]),
    drive(2, 100, _).
test(same_plan_is_left_alone, Tuples == [plan(house, 1, [])]) :-
    traveller([], [plan(house, 1, [])]),
    fake_agent:compare_plans,
    tuples(Tuples),
    did([]).
test(plan_of_another_sequence_is_left_alone) :-
    traveller([], [plan(garden, 2, [dig-dig])]),
    fake_agent:compare_plans,
    agent_plan(plan(Sequence, _, _)),
    Sequence == house,
    just_tuples([plan(garden, 2, [dig-dig])]).
test(new_code_of_a_task_is_handed_over) :-
    traveller([], [plan(house, 2, [1-better_floor]), worker(house, w)]),
    fake_agent:compare_plans,
    fake_agent:visit(1),
    did(Acts),
    memberchk(send(w, execute(1, better_floor)), Acts).
test(new_task_before_completed_ones_is_next) :-
    host_with([1, 2], [plan(house, 2, [1-a, new-b, 2-c])], Tuples),
    traveller([], Tuples),
    exhaust(1),
    exhaust(2),
    fake_agent:compare_plans,
    fake_agent:current(Task),
    fake_agent:visit(Task),
    serviced(Serviced),
    Serviced == new.

:- end_tests(plans).

                /*******************************
                *            WORKER            *
                *******************************/

:- begin_tests(worker).

test(announces_that_it_is_free, Tuples == [worker(house, me)]) :-
    worker([]),
    fake_agent:main,
    tuples(Tuples).
test(executes) :-
    worker([task(house, 1, executing, 5)]),
    fake_agent:on_message(someone, execute(1, leave(tile))),
    just_tuples([ tile, task(house, 1, completed, 7), worker(house, me) ]),
    did_just([log(executing(house, 1)), log(completed(house, 1))]).
test(task_that_raises_has_failed) :-
    worker([task(house, 1, executing, 5)]),
    fake_agent:on_message(someone, execute(1, atom_length(_, _))),
    just_tuples([task(house, 1, failed(atomic), 7), worker(house, me)]),
    did_just([ log(executing(house, 1)),
               log(raised(house, 1, instantiation_error)),
               log(failed(house, 1))
             ]).
test(any_raised_term_is_a_failure) :-
    worker([task(house, 1, executing, 5)]),
    fake_agent:on_message(someone, execute(1, throw(hammer))),
    just_tuples([task(house, 1, failed(atomic), 7), worker(house, me)]),
    did(Acts),
    memberchk(log(raised(house, 1, hammer)), Acts).
test(task_that_fails_has_failed) :-
    worker([task(house, 1, executing, 5)]),
    fake_agent:on_message(someone, execute(1, fail)),
    just_tuples([task(house, 1, failed(atomic), 7), worker(house, me)]).
test(waits_twice_as_long_after_each_failure_until_one_succeeds) :-
    worker([]),
    maplist(seconds_of, [fail, fail, fail, true, fail], Seconds),
    Seconds == [1, 2, 4, 0, 1].
test(waits_for_32_seconds_at_most) :-
    worker([]),
    length(Goals, 8),
    maplist(=(fail), Goals),
    maplist(seconds_of, Goals, Seconds),
    Seconds == [1, 2, 4, 8, 16, 32, 32, 32].
test(task_failed_from_outside_meanwhile) :-
    worker([task(house, 1, failed(cascaded(1)), 6)]),
    fake_agent:on_message(someone, execute(1, true)),
    just_tuples([task(house, 1, failed(cascaded(1)), 6), worker(house, me)]),
    did_just([log(executing(house, 1))]).

%   The time for which the worker is busy after its task.

seconds_of(Goal, Seconds) :-
    fake_host:now(Before),
    fake_host:leave(task(house, 1, executing, Before)),
    fake_agent:on_message(someone, execute(1, Goal)),
    fake_host:now(Now),
    Seconds is Now - Before.

:- end_tests(worker).
