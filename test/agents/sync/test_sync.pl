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

%   equation(Name, Goal, Value, Expected): Value is of Goal.

equation(equation_5_1, increase(P0, 15, 100, P), P, Is) :-
    member(P0-Is, [95-100, 60-75]).
equation(equation_5_1, decrease(P0, Theta, P), P, Is) :-
    member(P0-Theta-Is, [60-15-45, 3-3.1-0]).
equation(equation_5_2, theta([15, 9], 50, 100, Bias, Theta), Theta, Is) :-
    member(Bias-Is, [0-6, 0.5-6.5]).            % (15 + 9)/2 * 50/100
equation(theta_of_a_full_potential, theta([15], 100, 100, 0, T), T, 15).
equation(theta_averages_the_window, theta([2, 4, 9], 100, 100, 0.5, T), T, 5.5).
equation(bias_is_outside_the_product, theta([15], 0, 100, 0.8, T), T, 0.8).
equation(window_grows, slide(3, [1, 2], 3, H), H, [1, 2, 3]).
equation(window_slides, slide(3, [1, 2, 3], 4, H), H, [2, 3, 4]).
equation(penalties_by_hand, penalised(Drive0, 100, 15, 0.5, _, Drive), Drive,
         Is) :-
    member(Drive0-Is,
           [ drive(100, [15])-drive(84.5, [15, 15.5]),
             drive(84.5, [15, 15.5])    % (15 + 15.5)/2 * 0.845 + 0.5
             -drive(71.11375, [15, 15.5, 13.38625]) ]).
equation(reward_enters_the_window, rewarded(drive(40, [10]), 80, 15, Theta, D),
         Theta-D, 5-drive(45, [10, 5])).
equation(steps, steps(Delta, [], One, Zero), One/Zero, Is) :-
    member(Delta-Is, [ 0.2-72/76, 0.3-51/54, 0.5-35/37, 0.8-25/26,
                       1.0-22/23 ]).
equation(rewards_only_postpone, steps(Delta, [1, 2, 3, 5, 7, 10, 13], _, Zero),
         Zero, Is) :-
    member(Delta-Is, [0.2-90, 0.3-67, 0.5-48, 0.8-37, 1.0-34]).

:- begin_tests(potential).

test(equation, [ forall(equation(_, Goal, Value, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal).
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
                *           TRAVELLERS         *
                *******************************/

%   The sequence `house`, in its first version.

traveller(Facts, Tuples) :-
    plan(Plan),
    fake_agent('agents/sync/traveller.pl', [Plan|Facts], Tuples),
    fake_at(7),
    fake_agent:fill_new.

plan(plan(house, 1, [1-floor, 2-walls, 3-ceiling])).

%   host_with(+Completed, +More, -Tuples): a host with a worker, of which the
%   tasks Completed are completed.

host_with(Completed, More, [worker(house, w)|Tuples]) :-
    findall(task(house, Task, completed, 5), member(Task, Completed), Tuples0),
    append(Tuples0, More, Tuples).

%   acts(Name, Facts, Tuples, Searched, Left, Goal, Checks): the searches for
%   the tasks Searched have ended, Left is the drive of others, Task-Drive; see
%   fake_run/4. Also `potentials`=List is a check.

%   Decisions

acts(begins_full, [], [], [], [], true, [drive(2, 100, [15])]).
acts(settings_replace_defaults, [setting(maximum, 80), setting(theta, 10)], [],
     [], [], true, [drive(2, 80, [10])]).
acts(searches_the_next_task, [], [], Searched, [], current(Task),
     [Task == Is]) :-
    member(Searched-Is, [[]-1, [1]-2]).
acts(ends_after_the_last_task, [], [], [1, 2, 3], [], current(_), [end=fail]).
acts(services_a_host_that_lacks_the_task, [],
     [worker(house, w), task(house, 1, completed, 5)], [1],
     [2-drive(50, [10])], visit(2),
     [ tuples=[ task(house, 1, completed, 5), Plan,
                task(house, 2, executing, 7) ],
       did=[send(w, execute(2, walls)), log(reward(2, 55, 5))],
       drive(2, 55, [10, 5]) ]) :-
    plan(Plan).
acts(leaves_a_busy_host_alone, [], [Tuple], [], [], visit(1),
     [tuples=[Tuple], did=[], drive(1, 100, [15])]) :-
    member(Tuple, [task(house, 1, executing, 5), worker(garden, w)]).
acts(is_penalised_where_the_task_is_completed, [],
     [worker(house, w), task(house, 1, completed, 5)], [], [], visit(1),
     [ tuples=[task(house, 1, completed, 5), worker(house, w)],
       did=[log(penalty(1, 84.5, 15.5))], drive(1, 84.5, [15, 15.5]) ]).
acts(waits_where_it_cannot_move, [setting(delta, 1000), setting(patience, 2)],
     Tuples, [], [], ( assertz(fake_host:refuses(next)), main ),
     [time=13]) :-                      % a pause for each of the penalties
    host_with([1, 2, 3], [], Tuples).

%   Several sequences: the plan of a house is on the host, and its worker
%   belongs to a pool.

acts(worker_of_a_pool_gets_the_sequence, [setting(pool, robots)],
     [plan(house, 1, []), worker(robots, w)], [], [], visit(1),
     [did=[send(w, execute(house, 1, floor)), log(reward(1, 100, 15))]]).
acts(busy_worker_of_a_pool_is_left_alone, [setting(pool, robots)], [Tuple], [],
     [], visit(1), [did=[]]) :-
    member(Tuple, [worker(robots, w), plan(house, 1, [])]). % or without part
acts(task_waits_for_a_task_of_another_sequence,
     [setting(pool, robots), after(1, garden, dig)],
     [plan(house, 1, []), worker(robots, w), plan(garden, 1, [])], [],
     [1-drive(50, [10])], visit(1),
     [did=[log(reward(1, 55, 5))], sense(worker(robots, w))]).
acts(completed_task_releases_the_waiting_one,
     [setting(pool, robots), after(1, garden, dig)],
     [plan(house, 1, []), worker(robots, w)|Garden], [], [], visit(1),
     [did=[send(w, execute(house, 1, floor))|_]]) :-
    member(Garden, [ [plan(garden, 1, []), task(garden, dig, completed, 3)],
                     [] ]).             % or a host without a garden

%   Healing, see Figure 5.3 for the first.

acts(algorithm_2_line_29, [], Tuples, [1, 2], [3-drive(40, [15, 10])], visit(3),
     [ did=[ log(revived(2, 10)), send(w, execute(2, walls)),
             log(reward(2, 11.5, 1.5)) ],
       drive(2, 11.5, [15, 1.5]), drive(3, 40, [15, 10]), current(2) ]) :-
    host_with([1, 3], [], Tuples).
acts(the_first_one_missing_is_serviced_first, [], [worker(house, w)], [1, 2],
     [], visit(3), [executing=[1]]).
acts(later_ones_do_not_matter_yet, [], Tuples, [], [], visit(1),
     [did=[log(penalty(1, 84.5, 15.5))]]) :-
    host_with([1], [], Tuples).
acts(mark_of_an_atomic_failure_is_removed, [], Tuples, [1, 2],
     [3-drive(40, [15, 10])], visit(3),
     [ potentials=[0, 11.5, 40], executing=[2],
       \+ sense(task(_, _, failed(_), _)) ]) :-
    host_with([1, 3], [task(house, 2, failed(atomic), 6)], Tuples).
acts(cascaded_failure_fills_the_task_and_all_later_ones, [], Tuples, [1, 2],
     [3-drive(40, [15, 10])], visit(3),
     [ did=[log(revived(2, 100))|_], executing=[2],
       \+ sense(task(_, _, failed(_), _)), drive(1, 0, _),
       drive(2, 100, [15, 15]),         % the history begins again
       drive(3, 100, [15]) ]) :-
    host_with([1], [task(house, 2, failed(cascaded(2)), 6)], Tuples).
acts(cascaded_failure_of_the_task_itself_fills_the_later_ones, [], Tuples,
     [1, 3], [2-drive(50, [10])], visit(2),
     [ potentials=[0, 55, 100],
       did=[send(w, execute(2, walls)), log(reward(2, 55, 5))] ]) :-
    host_with([1], [task(house, 2, failed(cascaded(2)), 6)], Tuples).
acts(cascaded_failure_is_healed_from_its_first_task_on, [], Tuples, [1, 2],
     [3-drive(40, [15, 10])], visit(3),
     [ potentials=[100, 100, 100], did=[log(revived(1, 100))],
       sense(worker(house, _)), executing=[] ]) :-
    host_with([1], [task(house, 2, failed(cascaded(1)), 6)], Tuples).
acts(known_cascaded_failure_is_healed_task_by_task, [], Tuples, [1],
     [2-drive(50, [10])], visit(2), [potentials=[0, 55, 100], executing=[2]]) :-
    host_with([1], [task(house, 2, failed(cascaded(1)), 6)], Tuples).
acts(last_task_is_healed, [], Tuples, [1, 2], [], visit(3),
     [potentials=[0, 0, 100]]) :-
    host_with([1, 2], [task(house, 3, failed(cascaded(3)), 6)], Tuples).

%   Plans

acts(newer_plan_is_adopted, [], [New], [1], [], compare_plans,
     [ plan(house, 2, [1-floor, door-hang, 3-ceiling]), tuples=[New],
       did=[log(adopted(2))], current(door), drive(1, 0, _), drive(3, 100, _),
       drive(door, 100, _), \+ drive(2, _, _) ]) :-
    New = plan(house, 2, [1-floor, door-hang, 3-ceiling]).
acts(older_plan_is_replaced, [], [plan(house, 0.5, [1-floor])], [], [],
     compare_plans, [tuples=[Plan], did=[], drive(2, 100, _)]) :-
    plan(Plan).
acts(same_plan_is_left_alone, [], [plan(house, 1, [])], [], [], compare_plans,
     [tuples=[plan(house, 1, [])], did=[]]).
acts(plan_of_another_sequence_is_left_alone, [], [plan(garden, 2, [dig-dig])],
     [], [], compare_plans,
     [\+ plan(garden, _, _), Plan, tuples=[plan(garden, 2, [dig-dig])]]) :-
    plan(Plan).
acts(new_code_of_a_task_is_handed_over, [],
     [plan(house, 2, [1-better_floor]), worker(house, w)], [], [],
     ( compare_plans, visit(1) ),
     [fake_host:did(send(w, execute(1, better_floor)))]).
acts(new_task_before_completed_ones_is_next, [], Tuples, [1, 2], [],
     ( compare_plans, current(Task), visit(Task) ), [executing=[new]]) :-
    host_with([1, 2], [plan(house, 2, [1-a, new-b, 2-c])], Tuples).

:- begin_tests(travellers).

test(traveller_acts,
     [ forall(acts(_, Facts, Tuples, Searched, Left, Goal, Checks)),
       Wrong == [] ]) :-
    traveller([( potentials(Ps) :- findall(P, ( member(Task, [1, 2, 3]),
                                                drive(Task, P, _) ), Ps) ),
               ( executing(Tasks) :-
                     findall(Task, sense(task(_, Task, executing, _)), Tasks) )
              |Facts], Tuples),
    findall(Task-drive(0, [15, 0.2]), member(Task, Searched), Ended),
    append(Ended, Left, Drives),
    findall(fake_agent:keep(Task, Drive), member(Task-Drive, Drives), Before),
    fake_run(Before, Goal, Checks, Wrong).
test(algorithm_2, [Moves, Ps] == [111, [0, 0, 0]]) :- % three times 37
    host_with([1, 2, 3], [], Tuples),
    traveller([], Tuples),
    fake_agent:main,                    % gives up what is done everywhere
    did([log(begun)|Acts]),
    aggregate_all(count, member(move(next), Acts), Moves),
    aggregate_all(count, member(log(penalty(_, _, _)), Acts), Moves),
    findall(P, fake_agent:drive(_, P, _), Ps).
test(waits_for_the_order_to_begin, Before-First == []-log(begun)) :-
    host_with([1, 2, 3], [], Tuples),
    traveller([setting(start, order), setting(delta, 1000)], Tuples),
    \+ fake_agent:main,                 % receive/1 fails without mail
    did(Before),
    fake_mail(user-begin),
    fake_agent:main,
    did([First|_]).

:- end_tests(travellers).

                /*******************************
                *            WORKER            *
                *******************************/

worker(Tuples) :-
    fake_agent('agents/sync/worker.pl', [sequence(house)], Tuples),
    fake_at(7).

%   executes(Name, Status, Goal, NewStatus, Acts): the worker executes Goal as
%   the task 1, which has Status on the host.

executes(executes, executing, leave(tile), completed,
         [log(completed(house, 1))]).
executes(task_that_raises_has_failed, executing, atom_length(_, _),
         failed(atomic),
         [ log(raised(house, 1, instantiation_error)), log(failed(house, 1)) ]).
executes(any_raised_term_is_a_failure, executing, throw(hammer), failed(atomic),
         [log(raised(house, 1, hammer)), log(failed(house, 1))]).
executes(task_that_fails_has_failed, executing, fail, failed(atomic), [_]).
executes(task_failed_from_outside_meanwhile, failed(cascaded(1)), true,
         failed(cascaded(1)), []).

%   The time for which the worker is busy after its task.

seconds_of(Goal, Seconds) :-
    fake_host:now(Before),
    fake_host:leave(task(house, 1, executing, Before)),
    fake_agent:on_message(someone, execute(1, Goal)),
    fake_host:now(Now),
    Seconds is Now - Before.

:- begin_tests(worker).

test(announces_that_it_is_free, Tuples == [worker(house, me)]) :-
    worker([]),
    fake_agent:main,
    tuples(Tuples).
test(executes_a_task, [ forall(executes(_, Status, Goal, Then, Acts)),
                        Wrong == [] ]) :-
    ( Status == executing -> Times = 5-7 ; Times = 6-6 ),
    Times = Before-After,
    worker([task(house, 1, Status, Before)]),
    ( Goal = leave(Tuple) -> Left = [Tuple] ; Left = [] ),
    append(Left, [task(house, 1, Then, After), worker(house, me)], Tuples),
    fake_run([], on_message(someone, execute(1, Goal)),
             [did=[log(executing(house, 1))|Acts], tuples=Tuples], Wrong).
test(waits_twice_as_long_after_each_failure_until_one_succeeds,
     [ forall(member(Goals-Expected,
                     [ [fail, fail, fail, true, fail]-[1, 2, 4, 0, 1],
                       [fail, fail, fail, fail, fail, fail, fail, fail]
                       -[1, 2, 4, 8, 16, 32, 32, 32] ])),
       Seconds == Expected ]) :-
    worker([]),
    maplist(seconds_of, Goals, Seconds).

:- end_tests(worker).
