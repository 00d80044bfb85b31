%   What doc/learning.md promises, see ../promises.pl.

promise(executions_are_logged, learning,
        'agents/learning/learner.pl',
        "    Count is Count0 + 1,\n\c
         \s   keep(count(Count)),"-
        "    Count is Count0 + 2,\n\c
         \s   keep(count(Count)),").
promise(shared_counts_new_units, learning,
        'agents/learning/sharing.pl',
        "        length(New, Size),"-
        "        length(Units, Size),").
promise(converged_has_the_solution, learning,
        'agents/learning/learner.pl',
        "    log(converged(Count, Hops, Actions))."-
        "    log(converged(Count, Count, Actions)), Hops = Hops.").
promise(unanswered_trainer, learning,
        'agents/learning/learner.pl',
        "    ;   log(unanswered(Trainer)),\n\c
         \s       collector"-
        "    ;   log(unanswered(Trainer)),\n\c
         \s       executor(Plan)").
promise(plan_is_executed_first, learning,
        'agents/learning/trainer.pl',
        "    step(Action, At0, At1, Step),\n\c
         \s   pay(Xi0, Xi),\n\c
         \s   executed(Plan, Xi,"-
        "    step(Action, At0, At1, Step),\n\c
         \s   pay(Xi0, Xi), Plan = Plan,\n\c
         \s   executed([], Xi,").
promise(until_the_potential_is_used_up, learning,
        'agents/learning/trainer.pl',
        "    (   Xi =< 0\n\c
         \s   ;   reached(State)\n\c
         \s   ),"-
        "    (   Xi =< 1\n\c
         \s   ;   reached(State)\n\c
         \s   ),").
promise(until_the_goal_is_reached, learning,
        'agents/learning/trainer.pl',
        "    (   Xi =< 0\n\c
         \s   ;   reached(State)\n\c
         \s   ),"-
        "    (   Xi =< 0\n\c
         \s   ;   fail, reached(State)\n\c
         \s   ),").
promise(begins_with_an_empty_plan, learning,
        'agents/learning/learner.pl',
        "    executor([]).\n"-
        "    executor([forward]).\n").
promise(units_are_added_to_the_shareable, learning,
        'agents/learning/learner.pl',
        "    ord_union(Old, Units, All),\n\c
         \s   keep(shareable(All)),"-
        "    All = Units, Old = Old,\n\c
         \s   keep(shareable(All)),").
promise(asks_the_agents_before_it, learning,
        'agents/learning/sharing.pl',
        "    ;   ask(Others, Wanted, Gain)\n\c
         \s   )."-
        "    ;   Others = Others, Gain = none\n\c
         \s   ).").
promise(takes_all_new_units, learning,
        'agents/learning/sharing.pl',
        "    ord_subtract(New0, Bag, New),\n\c
         \s   New \\== []."-
        "    ord_subtract(New0, Bag, [First|_]), New = [First].").
promise(answers_agents_that_arrive_later, learning,
        'agents/learning/sharing.pl',
        "    ;   respond(What, From),\n\c
         \s       await_until(Agent, Reply, Until)\n\c
         \s   )."-
        "    ;   await_until(Agent, Reply, Until)\n\c
         \s   ).").
promise(new_units_give_a_reward, learning,
        'agents/learning/learner.pl',
        "    visit(anything, Gain),\n\c
         \s   rewarded(Gain, Rho1, Rho),"-
        "    visit(anything, _),\n\c
         \s   rewarded(none, Rho1, Rho),").
promise(exhausted_agent_assimilates, learning,
        'agents/learning/learner.pl',
        "    Rho < Minimum."-
        "    Rho < Minimum/2.").
promise(plan_from_own_units_and_bag, learning,
        'agents/learning/learner.pl',
        "    ord_union(Own, Bag, Units),"-
        "    Units = Own, Bag = Bag,").
promise(bag_is_emptied, learning,
        'agents/learning/learner.pl',
        "    !,\n\c
         \s   keep(bag([])),\n\c
         \s   executor(Plan)."-
        "    !,\n\c
         \s   executor(Plan).").
promise(asks_only_for_better, learning,
        'agents/learning/sharing.pl',
        "    better(Others, Actions)."-
        "    ( better(Others, Actions) ; true ).").
promise(collector_again, learning,
        'agents/learning/learner.pl',
        "    ->  converger(Rho)\n\c
         \s   ;   collector\n\c
         \s   )."-
        "    ->  converger(Rho)\n\c
         \s   ;   converger(Rho)\n\c
         \s   ).").
promise(converged_agent_ends, learning,
        'agents/learning/learner.pl',
        "    exhausted(Rho),\n\c
         \s   !,\n\c
         \s   solution(Actions),"-
        "    Rho < 0.5,\n\c
         \s   !,\n\c
         \s   solution(Actions),").
promise(silent_agent_is_removed, learning,
        'agents/learning/sharing.pl',
        "    ;   ignore(take(queued(Other))),\n\c
         \s       fail"-
        "    ;   fail").
promise(k_d_and_search, learning,
        'agents/learning/learner.pl',
        "    parameter(search, Search),\n\c
         \s   parameter(k_d, Kd),"-
        "    Search = 3,\n\c
         \s   parameter(k_d, Kd),").
promise(without_sharing_no_messages, learning,
        'agents/learning/sharing.pl',
        "    parameter(sharing, false),\n\c
         \s   !,"-
        "    parameter(sharing, none),\n\c
         \s   !,").
promise(seed_of_the_trainers, learning,
        'agents/lib/chance.pl',
        "    (   integer(Seed0)\n\c
         \s   ->  typhon_prng"-
        "    (   atom(Seed0), integer(Seed0)\n\c
         \s   ->  typhon_prng").
promise(trainers_differ, learning,
        'agents/lib/chance.pl',
        "    seed_chance(Name)."-
        "    seed_chance(here), Name = Name.").
promise(units_in_the_standard_order, learning,
        'agents/learning/learner.pl',
        "    sort(Units0, Units),\n\c
         \s   shareable(Old),"-
        "    Units = Units0,\n\c
         \s   shareable(Old),").
promise(algorithm_may_be_exchanged, learning,
        'agents/learning/learner.pl',
        "    provided(plan/3),\n"-
        "").
promise(algorithms_in_turn, learning_network,
        'agents/learning/operator.pl',
        "    Index is Number mod Kinds,"-
        "    Index is Number mod Kinds * 0,").
promise(empty_bag_counts_as_a_doubling, learning,
        'agents/learning/resources.pl',
        "gain(_, _, 1)."-
        "gain(_, After, After).").
promise(nothing_exceeds_rho_max, learning,
        'agents/learning/resources.pl',
        "    Rho is min(Maximum, Rho0"-
        "    Rho is min(2*Maximum, Rho0").
promise(initial_potential_of_plan_and_search, learning,
        'agents/learning/resources.pl',
        "    Xi is Kd * (Length + Search)."-
        "    Xi is Kd * Length + Search.").
promise(rewards_beyond_the_plan, learning,
        'agents/learning/trainer.pl',
        "    step(Action, At0, At1, Step),\n\c
         \s   pay(Xi0, Xi),"-
        "    step(Action, At0, At1, Step),\n\c
         \s   pay(Xi0, Xi1), feedback(Step, Xi1, Xi),").
promise(own_units_are_passed_on, learning,
        'agents/learning/sharing.pl',
        "    shareable(Units),\n\c
         \s   (   solution(Actions)"-
        "    shareable(Own), bag(Bag), ord_union(Own, Bag, Units),\n\c
         \s   (   solution(Actions)").
promise(missed_goal_is_no_solution, learning,
        'agents/learning/learner.pl',
        "    retractall(solution(_)),\n\c
         \s   collector."-
        "    collector.").
promise(light_is_finite_at_the_goal, learning_maze,
        'payloads/learning/maze.pl',
        "    Light is Brightest/(1 + sqrt("-
        "    Light is Brightest/(2 + sqrt(").
promise(no_light_in_front_of_a_wall, learning_maze,
        'payloads/learning/maze.pl',
        "    ->  Obstacle = 1,\n\c
         \s       Light = 0.0"-
        "    ->  Obstacle = 1,\n\c
         \s       Light = 1.0").
promise(vectors_carry_the_cell, learning_maze,
        'payloads/learning/maze.pl',
        "    Cell is (Size + 1)*Y + X."-
        "    Cell is Size*Y + X.").
promise(turn_is_part_of_the_next_move, learning_maze,
        'payloads/learning/maze.pl',
        "    ->  turning(Turned, Vector0, Turned1),"-
        "    ->  turning(Turned, Vector0, _), Turned1 = none,").
promise(several_turns_are_one, learning_maze,
        'payloads/learning/maze.pl',
        "turning(none, Vector, from(Vector)) :-\n\c
         \s   !.\n\c
         turning(Turned, _, Turned)."-
        "turning(_, Vector, from(Vector)).").
promise(branch_length_in_links, learning_maze,
        'payloads/learning/greedy.pl',
        "    Length is Length0 + 1,"-
        "    Length is Length0 + Count,").
promise(heaviest_then_fewest_actions, learning_maze,
        'payloads/learning/greedy.pl',
        "    Saving is Saving0 - Count,"-
        "    Saving is Saving0 + Count,").
promise(fewer_actions_are_better, learning_maze,
        'payloads/learning/greedy.pl',
        "    Length < OthersLength."-
        "    Length =< OthersLength.").
