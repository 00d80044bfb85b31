:- module(test_learning, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fake_agent').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, reverse/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).
:- include('../../../agents/learning/resources').

/** <module> Learning agents: equations, trainers, and the four states

See test_learning_maze.pl for the problem and the algorithm of the thesis,
test_learning_network.pl for agents that meet.
*/

                /*******************************
                *           EQUATIONS          *
                *******************************/

%   equation(Name, Goal, Value, Expected): Value is of Goal.

equation(equation_4_1, bag_weight([a-1, b-2.5, c-3], Pi), Pi, 6.5).
equation(weight_of_an_empty_bag, bag_weight([], Pi), Pi, 0).
equation(equation_4_2, migration_penalty(10, 2, 10, Rho), Rho, Is) :-
    Is is 10*exp(-2).
equation(a_hop_with_an_empty_bag, migration_penalty(10, 0, 10, Rho), Rho, 9.0).
equation(bag_without_profit_equals_an_empty_one,
         migration_penalty(5, -3, 10, Rho), Rho, 4.5).
equation(heavy_bag_takes_all_potential,
         migration_penalty(10, 5000, 10, Rho), Rho, 0).
equation(hops_of_an_empty_bag, hops(10, 0, Hops), Hops, 22).
equation(equation_4_3_and_4_4, migration_reward(2, 4, 6, 0.5, 10, Rho), Rho,
         4.5).
equation(potential_never_exceeds_the_maximum,
         migration_reward(9, 4, 6, 0.5, 10, Rho), Rho, 10).
equation(first_gain_doubles, migration_reward(1.5, 0, 0.01, 0.2, 10, Rho), Rho,
         3.5).
equation(initial_potential, initial_potential(2, 3, 2, Xi), Xi, 10).
equation(equation_4_5, action_cost(4, 1.5, Xi), Xi, 2.5).
equation(equation_4_6, action_reward(4, 0.5, Xi), Xi, 4.5).

hops(Rho, Hops, Hops) :-
    Rho < 1,
    !.
hops(Rho0, Hops0, Hops) :-
    migration_penalty(Rho0, 0, 10, Rho),
    Hops1 is Hops0 + 1,
    hops(Rho, Hops1, Hops).

:- begin_tests(learning_equations).

test(equation, [ forall(equation(_, Goal, Value, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal).

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
    append([ Facts0, Clauses, [(acts(Acts) :- test_learning:acts(Acts))] ],
           Facts),
    fake_agent('agents/learning/learner.pl', Facts, [trainer(t)|Tuples]).

%   expected(+Replies): the trainer t answers plans, whatever they are, with
%   feedback(Units, Outcome) in turn; other agents o, Other, answer requests for
%   units with o-shared(Units, Solution), or as in fake_reply/2.

expected(Replies) :-
    forall(member(Reply, Replies),
           ( reply(Reply, To, From), fake_reply(To, From) )).

reply(feedback(Units, Outcome), t-execute(_, _),
      t-feedback(begin, Units, Outcome)).
reply(shared(Other, Units, Solution), Other-share(_),
      Other-shared(units(Units, Solution))).
reply(To>From, To, From).

%   acts(-Acts): the acts of the agent; consecutive moves are moves(Count).

acts(Acts) :-
    did(Acts0),
    foldl(together, Acts0, [], Acts3),
    reverse(Acts3, Acts).

together(move(_), [moves(N0)|Acts], [moves(N)|Acts]) :-
    !,
    N is N0 + 1.
together(move(_), Acts, [moves(1)|Acts]) :-
    !.
together(Act, Acts, [Act|Acts]).

%   lives(Name, Settings, Tuples, Replies, Mail, Checks): a whole life, see
%   expected/1, acts/1 and fake_run/4.

lives(algorithm_1, [], [],
      [feedback([a-1], unreached), feedback([b-1, a-1], reached([a]))], [],
      [ acts=[ send(t, execute([], 3)),
               log(executed(1, 0, 1, unreached)), moves(22),
               send(t, execute([a], 4)),
               log(executed(2, 1, 2, reached)), log(reached(1)), moves(22),
               log(converged(2, 3, [a])) ] ]).
lives(potential_is_computed_from_the_plan, [k_d-2, search-5], [],
      [feedback([a-1, b-1], unreached), feedback([], reached([a]))], [],
      [ ( findall(Xi, fake_host:did(send(t, execute(_, Xi))), Xis),
          Xis == [10, 14] ) ]).         % k_d * (length + search)
lives(waits_for_the_start_order, [start-order], [], [], [],
      [end=fail, acts=[]]).
lives(starts_on_the_order, [start-order], [], [feedback([], reached([]))],
      [user-begin], [acts=[send(t, execute([], 3))|_]]).
lives(units_of_others_are_collected, [], [queued(o)],
      [ feedback([a-1], unreached), feedback([a-1], reached([a,b])),
        shared(o, [a-1, b-2], none) ], [],
      [ acts=[ send(t, execute([], 3)), % 10, 9, + 5 = 10, 1.35, 0.18
               log(executed(1, 0, 1, unreached)), moves(1),
               send(o, share(next)), log(shared(o, 1)), moves(1),
               send(o, share(next)), moves(1),
               send(t, execute([a,b], 5)),
               log(executed(2, 2, 1, reached)), log(reached(2)), moves(22),
               log(converged(2, 3, [a,b])) ],
        shareable=[a-1], bag=[] ]).     % emptied, and not shared
lives(gain_continues_the_search, [], [queued(o)], % 10, 9, + 5 = 10, 3.68,
      [ feedback([], unreached), feedback([], reached([x])), % + 5 = 8.68, 1.17,
        shared(o, [a-1], none), shared(o, [a-1, b-1], none) ], [], % 0.16
      [ ( findall(A, fake_host:did(A), Acts),
          once(append(Collecting, [send(t, execute([a,b], _))|_], Acts)),
          aggregate_all(count, member(move(_), Collecting), Count),
          Count == 4 ) ]).
lives(first_agent_with_new_units_is_taken, [],
      [queued(o1), queued(o2), queued(o3)],
      [ feedback([a-1], unreached), shared(o1, [a-1], none),
        shared(o2, [a-1, b-5000], none), feedback([], reached([x])) ], [],
      [ ( findall(A, fake_host:did(A), Acts),
          once(append(Before, [log(shared(_, _))|After], Acts)),
          findall(Other, member(send(Other, share(_)), Before), [o1, o2]),
          memberchk(log(shared(o2, 1)), Acts),
          \+ memberchk(log(shared(_, _)), After) ) ]).
lives(silent_agent_is_removed_from_the_queue, [], [queued(o)],
      [feedback([], unreached), feedback([], reached([x]))], [],
      [ tuples=[trainer(t)],
        ( aggregate_all(count, fake_host:did(send(o, _)), Asked),
          Asked == 1 ) ]).
lives(answers_while_waiting, [], [],    % the second while the trainer executes
      [ feedback([a-1], reached([a])), p-_ > x-noise,
        q-_ > r-share(next) ],          % comes after the feedback
      [p-share(here), q-share(there)],
      [ ( findall(To-What, ( fake_host:did(send(To, What)),
                             What = shared(_) ), Answers),
          Answers == [ p-shared(units([], none)), q-shared(nothing),
                       r-shared(units([a-1], solution([a]))) ] ) ]).
lives(no_messages_without_sharing, [sharing-false], [queued(o)],
      [feedback([], reached([]))], [p-noise],
      [ ( findall(To, fake_host:did(send(To, _)), All), All == [t] ) ]).
lives(better_solution_is_requested_and_collected_again, [], [queued(o)],
      [ feedback([a-1, b-1], reached([a,b])), shared(o, [c-1], solution([c])),
        feedback([], reached([c])) ], [],
      [ acts=[ send(t, execute([], 3)), log(executed(1, 0, 2, reached)),
               log(reached(2)), moves(1),
               send(o, share(next)), log(shared(o, 1)), moves(1),
               send(o, share(next)), moves(2),
               send(t, execute([a,b,c], 6)),
               log(executed(2, 3, 2, reached)), log(reached(1)), moves(22),
               log(converged(2, 3, [c])) ] ]).
lives(solution_that_is_no_better_is_ignored, [], [queued(o)],
      [ feedback([a-1], reached([a])), shared(o, [b-1], solution([b])),
        shared(o, [b-1], none), feedback([], reached([a])) ], [],
      [count=1, bag=[]]).
lives(silent_trainer, [], [], [t-execute(_, _) > x-noise,
                               feedback([], reached([]))], [],
      [ acts=[ send(t, execute([], 3)), log(unanswered(t)), moves(22),
               send(t, execute([], 3)), log(executed(1, 0, 0, reached)),
               log(reached(0)), moves(22), log(converged(1, 3, [])) ] ]).

:- begin_tests(learner).

test(learner_lives, [ forall(lives(_, Settings, Tuples, Replies, Mail, Checks)),
                      Wrong == [] ]) :-
    learner(Settings, Tuples),
    expected(Replies),
    maplist(fake_mail, Mail),
    fake_run([], main, Checks, Wrong).
test(units_of_the_bag_are_not_passed_on, Units == [a-1]) :-
    learner([], []),
    assertz(fake_agent:shareable([a-1])),
    assertz(fake_agent:bag([b-2])),
    fake_agent:respond(share(here), p),
    did([send(p, shared(units(Units, none)))]).
test(all_new_units_are_taken, Shared-Bag == 2-[b-2, c-3]) :-
    learner([], []),
    assertz(fake_agent:shareable([a-1])),
    assertz(fake_agent:bag([])),
    expected([shared(o, [a-1, b-2, c-3], none)]),
    once(fake_agent:ask([o], anything, _)),
    did(Acts),
    memberchk(log(shared(o, Shared)), Acts),
    fake_agent:bag(Bag).
test(agent_of_a_dead_process_is_removed_from_the_queue,
     Tuples == [trainer(t)]) :-
    learner([], [queued(o)]),
    expected([feedback([], unreached), feedback([], reached([x]))]),
    fake_dead(o),
    once(fake_agent:main),
    tuples(Tuples).
test(no_answer_to_an_agent_of_a_dead_process) :-
    learner([], []),
    expected([feedback([], reached([]))]),
    fake_dead(p),
    fake_mail(p-share(here)),
    once(fake_agent:main).
test(missed_goal_is_no_solution, fail) :-
    learner([], []),
    retractall(fake_agent:collector),
    assertz(fake_agent:collector),
    assertz(fake_agent:solution([a])),
    fake_agent:after(unreached),
    fake_agent:solution(_).
test(learner_without_an_algorithm_waits, Lingered == 3) :-
    learner([], []),
    abolish(fake_agent:plan/3),
    expected([feedback([a-1], unreached), feedback([], reached([a]))]),
    retractall(fake_agent:linger),
    assertz(( fake_agent:linger :- fake_host:log(lingers),
                                   test_learning:third_time )),
    once(fake_agent:main),
    did(Acts),
    aggregate_all(count, member(log(lingers), Acts), Lingered),
    memberchk(send(t, execute([a], 4)), Acts).
test(without_an_algorithm_no_solution_is_better, Executions == 1) :-
    learner([], [queued(o)]),
    abolish(fake_agent:better/2),
    expected([ feedback([a-1, b-1], reached([a,b])),
               shared(o, [c-1], solution([c])) ]),
    once(fake_agent:main),
    fake_agent:count(Executions).
test(error_of_the_algorithm_ends_the_wait,
     error(existence_error(procedure, _))) :-
    learner([], []),
    expected([feedback([a-1], unreached)]),
    retractall(fake_agent:plan(_, _, _)),
    assertz(( fake_agent:plan(_, _, _) :- no_such_thing )),
    once(fake_agent:main).

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
test(an_execution_begins_with_a_seed_of_30_bits, Begun == [Beginning]) :-
    trainer([seed-1]),
    fake_agent:chance(Chance),
    typhon_prng:chance_below(1073741824, Seed, Chance, _),
    typhon_prng:chance_seed(Seed, Beginning),
    asserta((fake_agent:start(From, _) :-
                 assertz(fake_host:did(begun(From))), fail)),
    trains([], 1, _, _),
    findall(From, fake_host:did(begun(From)), Begun).
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
