%   What doc/population.md promises, see ../promises.pl.

promise(turns_in_the_order_of_arrival, population,
        'agents/population/queue.pl',
        "    append(Line0, [Agent], Line)."-
        "    Line = [Agent|Line0].").
promise(only_the_head_has_a_turn, population,
        'agents/population/queue.pl',
        "call_head([Head|_], [Head|_]) :-\n\c
         \s   !.\n"-
        "").
promise(queue_has_an_agent_once, population,
        'agents/population/queue.pl',
        "changed(Agent-join, Line0, Line) :-\n\c
         \s   \\+ memberchk(Agent, Line0),\n\c
         \s   !,"-
        "changed(Agent-join, Line0, Line) :-\n\c
         \s   !,").
promise(lifetime_grows_by_a_reward, population,
        'agents/population/replication.pl',
        "    prolonged(Lifetime0, Reward, Extension, Lifetime),"-
        "    prolonged(Lifetime0, 0*Reward, Extension, Lifetime),").
promise(resource_is_charged_on_each_turn, population,
        'agents/population/replication.pl',
        "              Resource),\n\c
         \s   keep(resource(Resource)),\n\c
         \s   lifetime"-
        "              Resource),\n\c
         \s   ( Reward =:= 1 -> keep(resource(Resource)) ; true ),\n\c
         \s   lifetime").
promise(clones_after_a_reward, population,
        'agents/population/replication.pl',
        "    (   Reward =:= 1\n\c
         \s   ->  true\n\c
         \s   ;   parameter(replication, always)\n\c
         \s   ),"-
        "    Reward = Reward,").
promise(only_fertile_agents_clone, population,
        'agents/population/replication.pl',
        "replicate(Reward, Length, Role) :-\n\c
         \s   fertile,"-
        "replicate(Reward, Length, Role) :-\n\c
         \s   true,").
promise(clone_begins_with_the_least_resource, population,
        'agents/population/replication.pl',
        "    log(cloned),\n\c
         \s   parameter(cr_min, Resource),"-
        "    log(cloned),\n\c
         \s   resource(Resource),").
promise(clone_has_a_short_lifetime, population,
        'agents/population/replication.pl',
        "    parameter(lifetime, Lifetime),\n\c
         \s   keep(lifetime(Lifetime)),\n\c
         \s   forget"-
        "    forget").
promise(leaves_after_a_tick, population,
        'agents/population/cloning.pl',
        "    age(Since),\n\c
         \s   leave_queue,"-
        "    age(Since),").
promise(lifetime_falls_by_ticks, population,
        'agents/population/cloning.pl',
        "    Ticks is (Now - Since)/Tick,"-
        "    Ticks is Now - Since + 0*Tick,").
promise(clone_dies_at_zero, population,
        'agents/population/replication.pl',
        "    (   Lifetime > 0\n\c
         \s   ->  true\n\c
         \s   ;   die\n\c
         \s   )."-
        "    true.").
promise(parent_never_dies, population,
        'agents/population/replication.pl',
        "older(_) :-\n\c
         \s   lifetime(inf),\n\c
         \s   !."-
        "older(_) :-\n\c
         \s   lifetime(inf),\n\c
         \s   !,\n\c
         \s   keep(lifetime(0)).").
promise(setting_replaces_a_default, population,
        'agents/lib/parameters.pl',
        "    (   setting(Name, Value0)\n\c
         \s   ->  Value = Value0\n\c
         \s   ;   default(Name, Value)\n\c
         \s   )."-
        "    default(Name, Value).").
promise(slots_of_a_queue, population,
        'agents/population/replication.pl',
        "default(q_th, 4). "-
        "default(q_th, 5). ").
promise(rounded_half_away_from_zero, population,
        'agents/population/resource.pl',
        "    Count is round(Pressure * Resource/Maximum)."-
        "    Count is ceiling(Pressure * Resource/Maximum - 0.5).").
promise(clones_without_a_reward, population,
        'agents/population/replication.pl',
        "    ;   parameter(replication, always)\n"-
        "    ;   parameter(replication, sometimes)\n").
promise(head_computes_the_pressure, population,
        'agents/population/queue.pl',
        "    length([Head|Line], Length),"-
        "    length(Line, Length),").
promise(dying_agent_gets_an_answer, population,
        'agents/population/queue.pl',
        "answer(Agent-quit) :-\n\c
         \s   !,\n\c
         \s   send(Agent, gone).\n"-
        "").
promise(waits_no_longer_than_its_lifetime, population,
        'agents/population/cloning.pl',
        "    (   receive(Queue-turn(Length0), Seconds)"-
        "    (   receive(Queue-turn(Length0), 1000+0*Seconds)").
promise(vanished_head_is_removed, population,
        'agents/population/queue.pl',
        "    (   receive(Agent-What, Seconds)"-
        "    (   receive(Agent-What), Seconds = Seconds").
promise(turn_at_once_without_a_queue, population,
        'agents/population/cloning.pl',
        "await_turn(Length) :-\n\c
         \s   host_load(Length)."-
        "await_turn(Length) :-\n\c
         \s   sleep(1), host_load(Length).").
promise(positive_stimulus, specialist,
        'agents/sync/specialist.pl',
        "    excite,\n\c
         \s   remember,\n\c
         \s   stimulate(positive)."-
        "    excite,\n\c
         \s   remember,\n\c
         \s   stimulate(negative).").
promise(negative_stimulus, specialist,
        'agents/sync/specialist.pl',
        "    stimulate(negative).\n\c
         visit(0) :-                     % S2"-
        "    true.\n\c
         visit(0) :-                     % S2").
promise(active_at_zero, specialist,
        'agents/sync/specialist.pl',
        "    (   Psi =:= 0\n\c
         \s   ->  turn_to(active)"-
        "    (   Psi < 1.0e-9, Psi > 0\n\c
         \s   ->  turn_to(active)").
promise(active_agent_clones, specialist,
        'agents/sync/specialist.pl',
        "fertile :-\n\c
         \s   mood(active)."-
        "fertile.").
promise(failed_task_is_executed_again, specialist,
        'agents/sync/specialist.pl',
        "    ignore(take(task(Sequence, Task, failed(_), _))),\n"-
        "").
promise(sequences_share_the_queues, specialist,
        'agents/population/operator.pl',
        "    furnish(Host, queue, sense(queue(_)), agents(population/queue), []),"-
        "    furnish(Host, queue(Sequence), fail, agents(population/queue), []),").
promise(one_worker_for_each_sequence, specialist,
        'agents/population/operator.pl',
        "    furnish(Host, worker(Sequence),\n"-
        "    furnish(Host, worker,\n").
promise(threshold_counts_as_zero, specialist,
        'agents/sync/stimulation.pl',
        "    (   Psi1 < Threshold\n\c
         \s   ->  Psi = 0"-
        "    (   Psi1 =< Threshold\n\c
         \s   ->  Psi = 0").
promise(no_dispersion_of_equal_ends, specialist,
        'agents/sync/stimulation.pl',
        "    Last > First,\n\c
         \s   !,"-
        "    Last >= First,\n\c
         \s   !,").
promise(mean_over_the_existing_values, specialist,
        'agents/sync/stimulation.pl',
        "    Deviation is sqrt(Squares/Count)."-
        "    Deviation is sqrt(Squares/5) + 0*Count.").
promise(history_grows_with_larger_differences, specialist,
        'agents/sync/stimulation.pl',
        "    Difference =< Last,\n\c
         \s   !."-
        "    Difference < Last,\n\c
         \s   !.").
promise(first_task_counts_from_the_start, specialist,
        'agents/sync/specialist.pl',
        "due_since(Since) :-\n\c
         \s   previous(none),\n\c
         \s   !,\n\c
         \s   start(Since)."-
        "due_since(Since) :-\n\c
         \s   previous(none),\n\c
         \s   !,\n\c
         \s   now(Since).").
promise(previous_task_must_be_completed, specialist,
        'agents/sync/specialist.pl',
        "    mood(active),\n\c
         \s   \\+ lacks_previous,\n\c
         \s   lacks_mine,"-
        "    mood(active),\n\c
         \s   lacks_mine,").
promise(all_clones_or_none, population,
        'agents/population/resource.pl',
        "conferred(Resource, _, _, Resource, 0)."-
        "conferred(Resource0, Count0, Minimum, Resource, Count) :-\n\c
         \s   Count0 > 0, Count1 is Count0 - 1, !,\n\c
         \s   conferred(Resource0, Count1, Minimum, Resource, Count).\n\c
         conferred(Resource, _, _, Resource, 0).").
promise(agent_keeps_the_least_resource, population,
        'agents/population/resource.pl',
        "    Resource >= Minimum,\n\c
         \s   !."-
        "    Resource >= 0,\n\c
         \s   !.").
promise(taken_slot_keeps_the_resource, population,
        'agents/population/replication.pl',
        "multiplied(refused, _, parent)."-
        "multiplied(refused, Count, Role) :-\n\c
         \s   multiplied(parent(none), Count, Role).").
promise(constant_y_is_one, population,
        'agents/population/resource.pl',
        "    Pressure > 1,\n\c
         \s   !,\n\c
         \s   Factor is exp(1 - 1/Pressure)."-
        "    Pressure > 2,\n\c
         \s   !,\n\c
         \s   Factor is exp(1 - 1/Pressure).").
promise(lifetimes_fall_in_queues_only, population,
        'agents/population/cloning.pl',
        "    Seconds is Lifetime * Tick."-
        "    Seconds is Lifetime + 0*Tick.").
promise(clone_has_visited_only_its_birth, population,
        'agents/population/replication.pl',
        "    keep(lifetime(Lifetime)),\n\c
         \s   forget_visits."-
        "    keep(lifetime(Lifetime)).").
