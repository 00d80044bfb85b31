:- module(test_learning, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fake_agent').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3, maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).
:- include('../../../agents/learning/resources').

/** <module> Learning agents: equations, trainers, and the four states

See test_learning_maze.pl for the problem and the algorithm of the thesis,
test_learning_network.pl for agents that meet.
*/

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

                /*******************************
                *           EQUATIONS          *
                *******************************/

:- begin_tests(learning_equations).

test(equation_4_1, Pi =:= 6.5) :-
    bag_weight([a-1, b-2.5, c-3], Pi).
test(weight_of_an_empty_bag, Pi =:= 0) :-
    bag_weight([], Pi).
test(equation_4_2, true(close_to(Rho, 1.353352832))) :-
    migration_penalty(10, 2, 10, Rho).
test(a_hop_with_an_empty_bag, true(close_to(Rho, 9.0))) :-
    migration_penalty(10, 0, 10, Rho).
test(bag_without_profit_equals_an_empty_one, true(close_to(Rho, 4.5))) :-
    migration_penalty(5, -3, 10, Rho).
test(heavy_bag_takes_all_potential, Rho =:= 0) :-
    migration_penalty(10, 5000, 10, Rho).
test(hops_of_an_empty_bag, Hops == 22) :-
    hops(10, 0, Hops).
test(equation_4_3_and_4_4, true(close_to(Rho, 4.5))) :-
    migration_reward(2, 4, 6, 0.5, 10, Rho).
test(potential_never_exceeds_the_maximum, Rho =:= 10) :-
    migration_reward(9, 4, 6, 0.5, 10, Rho).
test(first_gain_doubles, true(close_to(Rho, 3.5))) :-
    migration_reward(1.5, 0, 0.01, 0.2, 10, Rho).
test(initial_potential, Xi =:= 10) :-
    initial_potential(2, 3, 2, Xi).
test(equation_4_5, Xi =:= 2.5) :-
    action_cost(4, 1.5, Xi).
test(equation_4_6, Xi =:= 4.5) :-
    action_reward(4, 0.5, Xi).

hops(Rho, Hops, Hops) :-
    Rho < 1,
    !.
hops(Rho0, Hops0, Hops) :-
    migration_penalty(Rho0, 0, 10, Rho),
    Hops1 is Hops0 + 1,
    hops(Rho, Hops1, Hops).

:- end_tests(learning_equations).

                /*******************************
                *            LEARNER           *
                *******************************/

%   The algorithm is: all units are actions, and fewer actions are better.

algorithm([ ( plan(begin, Units, Plan) :-
                  findall(Action, member(Action-_, Units), Plan) ),
            ( better(Actions, Others) :-
                  length(Actions, N), length(Others, M), N < M )
          ]).

learner(Settings, Tuples) :-
    algorithm(Clauses),
    findall(setting(Name, Value), member(Name-Value, Settings), Facts0),
    append(Facts0, Clauses, Facts),
    fake_agent('agents/learning/learner.pl', Facts, [trainer(t)|Tuples]).

%   feeds_back(+Units, +Outcome): the feedback to the next plan, whatever the
%   plan is.

feeds_back(Units, Outcome) :-
    fake_reply(t-execute(_, _), t-feedback(begin, Units, Outcome)).

shares(Other, Units, Solution) :-
    fake_reply(Other-share(_), Other-shared(units(Units, Solution))).

lives :-
    once(fake_agent:main).

%   acts(-Acts): the acts of the agent; consecutive moves are moves(Count).

acts(Acts) :-
    did(Acts0),
    together(Acts0, Acts).

together([], []).
together([move(_)|Acts0], [moves(Count)|Acts]) :-
    !,
    moves(Acts0, 1, Count, Acts1),
    together(Acts1, Acts).
together([Act|Acts0], [Act|Acts]) :-
    together(Acts0, Acts).

moves([move(_)|Acts0], Count0, Count, Acts) :-
    !,
    Count1 is Count0 + 1,
    moves(Acts0, Count1, Count, Acts).
moves(Acts, Count, Count, Acts).

:- begin_tests(learner).

test(algorithm_1,
     Acts == [ send(t, execute([], 3)),
               log(executed(1, 0, 1, unreached)), moves(22),
               send(t, execute([a], 4)),
               log(executed(2, 1, 2, reached)), log(reached(1)), moves(22),
               log(converged(2, 3, [a])) ]) :-
    learner([], []),
    feeds_back([a-1], unreached),
    feeds_back([b-1, a-1], reached([a])),
    lives,
    acts(Acts).
test(potential_is_computed_from_the_plan,
     [Xi1, Xi2] == [10, 14]) :-         % k_d * (length + search)
    learner([k_d-2, search-5], []),
    feeds_back([a-1, b-1], unreached),
    feeds_back([], reached([a])),
    lives,
    did(Acts),
    findall(Xi, member(send(t, execute(_, Xi)), Acts), [Xi1, Xi2]).
test(waits_for_the_start_order, Acts == []) :-
    learner([start-order], []),
    \+ fake_agent:main,
    acts(Acts).
test(starts_on_the_order, First == send(t, execute([], 3))) :-
    learner([start-order], []),
    fake_mail(user-begin),
    feeds_back([], reached([])),
    lives,
    acts([First|_]).
test(units_of_others_are_collected,
     Acts == [ send(t, execute([], 3)),
               log(executed(1, 0, 1, unreached)), moves(1),
               send(o, share(next)), log(shared(o, 1)), moves(1),
               send(o, share(next)), moves(1),
               send(t, execute([a,b], 5)),
               log(executed(2, 2, 1, reached)), log(reached(2)), moves(22),
               log(converged(2, 3, [a,b])) ]) :-
    learner([], [queued(o)]),
    feeds_back([a-1], unreached),
    feeds_back([a-1], reached([a,b])),
    shares(o, [a-1, b-2], none),        % 10, 9, + 5 = 10, 1.35, 0.18
    lives,
    acts(Acts).
test(bag_is_emptied_and_not_shared,
     Own-Bag == [a-1]-[]) :-
    learner([], [queued(o)]),
    feeds_back([a-1], unreached),
    feeds_back([a-1], reached([a,b])),
    shares(o, [a-1, b-2], none),
    lives,
    fake_agent:shareable(Own),
    fake_agent:bag(Bag).
test(units_of_the_bag_are_not_passed_on, Units == [a-1]) :-
    learner([], []),
    assertz(fake_agent:shareable([a-1])),
    assertz(fake_agent:bag([b-2])),
    fake_agent:respond(share(here), p),
    did([send(p, shared(units(Units, none)))]).
test(gain_continues_the_search,         % 10, 9, + 5 = 10, 3.68, + 5 = 8.68,
     Count == 4) :-                     % 1.17, 0.16
    learner([], [queued(o)]),
    feeds_back([], unreached),
    feeds_back([], reached([x])),
    shares(o, [a-1], none),
    shares(o, [a-1, b-1], none),
    lives,
    did(Acts),
    once(append(Collecting, [send(t, execute([a,b], _))|_], Acts)),
    aggregate_all(count, member(move(_), Collecting), Count).
test(first_agent_with_new_units_is_taken,
     Asked-Shared == [o1, o2]-[o2-1]) :-
    learner([], [queued(o1), queued(o2), queued(o3)]),
    feeds_back([a-1], unreached),
    shares(o1, [a-1], none),
    shares(o2, [a-1, b-5000], none),
    feeds_back([], reached([x])),
    lives,
    did(Acts0),
    findall(Other-Count, member(log(shared(Other, Count)), Acts0), Shared),
    once(append(Before, [log(shared(_, _))|_], Acts0)),
    findall(Other, member(send(Other, share(_)), Before), Asked).
test(all_new_units_are_taken, Shared-Bag == 2-[b-2, c-3]) :-
    learner([], []),
    assertz(fake_agent:shareable([a-1])),
    assertz(fake_agent:bag([])),
    shares(o, [a-1, b-2, c-3], none),
    once(fake_agent:ask([o], anything, _)),
    did(Acts),
    memberchk(log(shared(o, Shared)), Acts),
    fake_agent:bag(Bag).
test(silent_agent_is_removed_from_the_queue,
     Asked-Tuples == 1-[trainer(t)]) :-
    learner([], [queued(o)]),
    feeds_back([], unreached),
    feeds_back([], reached([x])),
    lives,
    did(Acts),
    aggregate_all(count, member(send(o, _), Acts), Asked),
    tuples(Tuples).
test(agent_of_a_dead_process_is_removed_from_the_queue,
     Tuples == [trainer(t)]) :-
    learner([], [queued(o)]),
    feeds_back([], unreached),
    feeds_back([], reached([x])),
    fake_dead(o),
    lives,
    tuples(Tuples).
test(no_answer_to_an_agent_of_a_dead_process) :-
    learner([], []),
    feeds_back([], reached([])),
    fake_dead(p),
    fake_mail(p-share(here)),
    lives.
test(answers_while_waiting,
     Answers == [ p-shared(units([], none)), q-shared(nothing),
                  r-shared(units([a-1], solution([a]))) ]) :-
    learner([], []),
    fake_mail(p-share(here)),           % while the trainer executes
    fake_mail(q-share(there)),
    feeds_back([a-1], reached([a])),
    fake_reply(p-_, x-noise),
    fake_reply(q-_, r-share(next)),     % comes after the feedback
    lives,
    did(Acts),
    findall(To-What, ( member(send(To, What), Acts), What = shared(_) ),
            Answers).
test(no_messages_without_sharing, Acts == [send(t, execute([], 3))]) :-
    learner([sharing-false], [queued(o)]),
    feeds_back([], reached([])),
    fake_mail(p-noise),
    lives,
    did(Acts0),
    include(sends, Acts0, Acts).
test(better_solution_is_requested_and_collected_again,
     Acts == [ send(t, execute([], 3)), log(executed(1, 0, 2, reached)),
               log(reached(2)), moves(1),
               send(o, share(next)), log(shared(o, 1)), moves(1),
               send(o, share(next)), moves(2),
               send(t, execute([a,b,c], 6)),
               log(executed(2, 3, 2, reached)), log(reached(1)), moves(22),
               log(converged(2, 3, [c])) ]) :-
    learner([], [queued(o)]),
    feeds_back([a-1, b-1], reached([a,b])),
    shares(o, [c-1], solution([c])),
    feeds_back([], reached([c])),
    lives,
    acts(Acts).
test(solution_that_is_no_better_is_ignored, Executions-Bag == 1-[]) :-
    learner([], [queued(o)]),
    feeds_back([a-1], reached([a])),
    shares(o, [b-1], solution([b])),
    shares(o, [b-1], none),
    feeds_back([], reached([a])),       % is not asked for
    lives,
    fake_agent:count(Executions),
    fake_agent:bag(Bag).
test(missed_goal_is_no_solution, fail) :-
    learner([], []),
    retractall(fake_agent:collector),
    assertz(fake_agent:collector),
    assertz(fake_agent:solution([a])),
    fake_agent:after(unreached),
    fake_agent:solution(_).
test(silent_trainer,
     Acts == [ send(t, execute([], 3)), log(unanswered(t)), moves(22),
               send(t, execute([], 3)), log(executed(1, 0, 0, reached)),
               log(reached(0)), moves(22), log(converged(1, 3, [])) ]) :-
    learner([], []),
    fake_reply(t-execute(_, _), x-noise),
    feeds_back([], reached([])),
    lives,
    acts(Acts).
test(learner_without_an_algorithm_waits, Lingered == 3) :-
    learner([], []),
    abolish(fake_agent:plan/3),
    feeds_back([a-1], unreached),
    feeds_back([], reached([a])),
    retractall(fake_agent:linger),
    assertz(( fake_agent:linger :- fake_host:log(lingers),
                                   test_learning:third_time )),
    lives,
    did(Acts),
    aggregate_all(count, member(log(lingers), Acts), Lingered),
    memberchk(send(t, execute([a], 4)), Acts).
test(without_an_algorithm_no_solution_is_better, Executions == 1) :-
    learner([], [queued(o)]),
    abolish(fake_agent:better/2),
    feeds_back([a-1, b-1], reached([a,b])),
    shares(o, [c-1], solution([c])),
    lives,
    fake_agent:count(Executions).
test(error_of_the_algorithm_ends_the_wait,
     error(existence_error(procedure, _))) :-
    learner([], []),
    feeds_back([a-1], unreached),
    retractall(fake_agent:plan(_, _, _)),
    assertz(( fake_agent:plan(_, _, _) :- no_such_thing )),
    lives.

sends(send(_, _)).

:- end_tests(learner).

third_time :-
    did(Acts),
    aggregate_all(count, member(log(lingers), Acts), Count),
    (   Count =:= 3
    ->  algorithm([Plan|_]),
        assertz(fake_agent:Plan)
    ;   true
    ).

                /*******************************
                *            TRAINER           *
                *******************************/

%   In a maze from (5,0) to (0,5).

trainer(Settings) :-
    project_file('payloads/learning/maze.pl', File),
    read_file_to_terms(File, [(:- payload(_, _))|Maze], []),
    findall(setting(Name, Value),
            member(Name-Value, [size-5|Settings]), Facts),
    append(Facts, Maze, All),
    fake_agent('agents/learning/trainer.pl', All, []),
    fake_agent:main.

%   trains(+Plan, +Xi, -Steps, -Feedback)

trains(Plan, Xi, Steps, Feedback) :-
    once(fake_agent:execute(Plan, Xi, Steps, Feedback)).

%   potentials(+Steps, +PlanLength, +Xi0, -Xis): after each step, with k_d 1
%   and k_r 0.5.

potentials([], _, _, []).
potentials([step(_, _, _, Weight)|Steps], Planned0, Xi0, [Xi|Xis]) :-
    (   Planned0 =< 0,
        Weight > 0
    ->  Xi is Xi0 - 1 + 0.5
    ;   Xi is Xi0 - 1
    ),
    Planned is Planned0 - 1,
    potentials(Steps, Planned, Xi, Xis).

forwards(Count, Plan) :-
    findall(forward, between(1, Count, _), Plan).

:- begin_tests(trainer).

test(trainer_answers_requests, To-Kind == a-feedback) :-
    trainer([seed-1]),
    fake_agent:on_message(a, execute([forward], 1)),
    did([send(To, Feedback)]),
    functor(Feedback, Kind, 3).
test(agent_that_moved_to_a_dead_process) :-
    trainer([seed-1]),
    fake_dead(a),
    once(fake_agent:on_message(a, execute([forward], 1))).
test(trainer_logs_for_observers, Log == tried(a, [forward, turn_left])) :-
    trainer([seed-1, trace-true]),
    fake_agent:on_message(a, execute([forward, turn_left], 2)),
    did([log(Log)|_]).
test(plan_is_executed_first, First == Plan) :-
    trainer([seed-1]),
    Plan = [forward, turn_left, backward],
    trains(Plan, 6, Steps, _),
    findall(Action, member(step(_, Action, _, _), Steps), Actions),
    length(First, 3),
    append(First, _, Actions),
    !.
test(no_more_than_the_potential_allows, Count == 2) :-
    trainer([seed-1]),
    trains([forward, forward, forward], 2, Steps, _),
    length(Steps, Count).
test(potential_is_used_up_exactly, Bad == []) :-
    findall(Seed-Xis,
            ( between(1, 100, Seed),
              trainer([seed-Seed]),
              trains([forward, backward], 5, Steps, _),
              potentials(Steps, 2, 5, Xis),
              \+ used_up(Xis) ),
            Bad).
test(plan_without_gain, Count == 4) :- % but costs
    trainer([seed-1, k_r-100]),
    forwards(4, Plan),
    trains(Plan, 4, Steps, _),
    length(Steps, Count).
test(without_reward_each_action_costs, Count == 4) :- % 5/1.5
    trainer([seed-1, k_r-0, k_d-1.5]),
    trains([], 5, Steps, _),
    length(Steps, Count).
test(goal_ends_the_execution, Outcome-Actions == reached(Way)-Way) :-
    trainer([seed-1]),
    way(Way),
    append(Way, [backward, backward], Plan),
    trains(Plan, 100, Steps, feedback(_, _, Outcome)),
    findall(Action, member(step(_, Action, _, _), Steps), Actions).
test(goal_missed_by_one, Outcome == unreached) :-
    trainer([seed-1]),
    way(Way),
    trains(Way, 10, _, feedback(_, _, Outcome)).
test(feedback_contains_the_start, Start == sv(Light, 0, up, 5)) :-
    trainer([seed-1]),
    trains([forward], 1, _, feedback(Start, _, _)),
    Light is 100/(1 + sqrt(50)).
test(darker_units_are_not_shared, Actions == [[forward]]) :-
    trainer([seed-1]),
    trains([forward, backward], 2, _, feedback(_, Units, _)),
    findall(A, member(unit(_, A, _)-_, Units), Actions).
test(same_seed_same_execution, Again == Once) :-
    tried(7, Once),
    tried(7, Again).
test(other_seed_other_execution, true(Other \== Once)) :-
    tried(7, Once),
    tried(8, Other).
test(trainers_of_two_hosts_differ, true(( Same == A, A \== B ))) :-
    maplist(tried_at, ['a@x:1', 'b@x:1', 'a@y:2'], [A, B, Same]).
test(executions_differ, true(Second \== First)) :-
    tried(7, [First, Second|_]).

%   After each step but the last something is left.

used_up(Xis) :-
    append(Before, [Last], Xis),
    Last =< 0,
    \+ ( member(Xi, Before), Xi =< 0 ).

way([ forward, forward, forward, forward, forward, turn_left,
      forward, forward, forward, forward, forward ]).

tried_at(Host, Steps) :-
    trainer([seed-7]),
    assertz(fake_host:did(move(Host))),
    fake_agent:seed_chance_here,
    trains([], 20, Steps, _).

tried(Seed, Tried) :-
    trainer([seed-Seed]),
    findall(Steps, ( between(1, 3, _), trains([], 20, Steps, _) ), Tried).

:- end_tests(trainer).
