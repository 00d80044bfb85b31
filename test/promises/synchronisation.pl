%   What doc/synchronisation.md promises, see ../promises.pl.

promise(task_runs_on_the_host, sync,
        'agents/sync/execution.pl',
        "    catch(Goal, Ball, raised(Sequence, Task, Ball))."-
        "    catch(true, Ball, raised(Sequence, Task, Ball)), Goal = Goal.").
promise(hosts_record_completed_tasks, sync,
        'agents/sync/worker.pl',
        "    leave(task(Sequence, Task, Status, Time)),\n\c
         \s   functor"-
        "    leave(task(Sequence, Task, completed, Time)),\n\c
         \s   functor").
promise(only_named_hosts_take_part, sync,
        'agents/sync/dependence.pl',
        "    take(worker(Pool, Worker))."-
        "    Pool = Pool, take(worker(_, Worker)).").
promise(other_hosts_without_reward, sync,
        'agents/sync/traveller.pl',
        "        penalise(Task)\n\c
         \s   ).\n\c
         visit(_)."-
        "        penalise(Task)\n\c
         \s   ).\n\c
         visit(Task) :-\n\c
         \s   penalise(Task).").
promise(completed_tasks_stay, sync,
        'agents/sync/traveller.pl',
        "    \\+ sense(task(Sequence, Missing, completed, _)),\n\c
         \s   !."-
        "    \\+ sense(task(Sequence, Missing, executing, _)),\n\c
         \s   !.").
promise(atomic_failure_affects_one_task, sync_network,
        'agents/sync/operator.pl',
        "lost(atomic, _, Task, _, [Task], [completed])."-
        "lost(atomic, Sequence, Task, Host, Tasks, Statuses) :-\n\c
         \s   lost(cascaded, Sequence, Task, Host, Tasks, Statuses).").
promise(cascaded_failure_of_all_later_tasks, sync_network,
        'agents/sync/operator.pl',
        "    append(_, [Task|Later], Names),\n\c
         \s   !."-
        "    append(_, [Task|_], Names), Later = [],\n\c
         \s   !.").
promise(executing_task_of_a_cascade, sync_network,
        'agents/sync/operator.pl',
        "[Task|Later], [completed, executing]) :-"-
        "[Task|Later], [completed]) :-").
promise(failure_of_a_completed_task, sync_network,
        'agents/sync/operator.pl',
        "    remote(Host, sense(task(Sequence, Task, completed, _))),\n\c
         \s   lost"-
        "    lost").
promise(plan_spreads_with_agents, sync,
        'agents/sync/plans.pl',
        "    (   Mine > Theirs\n\c
         \s   ->  replace(Sequence, Theirs)"-
        "    (   Mine < Theirs\n\c
         \s   ->  replace(Sequence, Theirs)").
promise(completed_task_stays_completed, sync,
        'agents/sync/plans.pl',
        "( member(Task-_, Tasks), \\+ drive(Task, _, _) ),"-
        "member(Task-_, Tasks),").
promise(new_task_with_full_potential, sync,
        'agents/sync/plans.pl',
        "        forget_removed,\n\c
         \s       fill_new,\n"-
        "        forget_removed,\n").
promise(removed_task_is_dropped, sync,
        'agents/sync/plans.pl',
        "        forget_removed,\n\c
         \s       fill_new,"-
        "        fill_new,").
promise(as_many_agents_as_starts, starts,
        'agents/lib/starts.pl',
        "    in_turn(Count, Hosts, Hosts, Starts)."-
        "    Hosts = [Host|_], in_turn(Count, [Host], [Host], Starts).").
promise(seed_of_the_starts, starts,
        'agents/lib/starts.pl',
        "    option(seed(Seed), Options, Any),"-
        "    Seed = Any, Options = Options,").
promise(pool_has_one_worker, sync_network,
        'agents/sync/operator.pl',
        "                     ; sense(pool(Pool))\n"-
        "").
promise(delta_is_the_least_penalty, sync,
        'agents/sync/potential.pl',
        "    Theta is Sum/Count * Potential/Maximum + Bias."-
        "    Theta is (Sum/Count + Bias) * Potential/Maximum.").
promise(history_has_the_last_values, sync,
        'agents/sync/potential.pl',
        "    (   Count > Window\n\c
         \s   ->"-
        "    (   Count > Window + 1\n\c
         \s   ->").
promise(potential_stays_below_the_maximum, sync,
        'agents/sync/potential.pl',
        "    Potential is min(Maximum, Potential0 + Theta)."-
        "    Potential is min(2*Maximum, Potential0 + Theta).").
promise(potential_comes_to_zero, sync,
        'agents/sync/potential.pl',
        "    Potential is max(0, Potential0 - Theta)."-
        "    Potential is max(0.001, Potential0 - Theta).").
promise(default_of_delta, sync,
        'agents/sync/traveller.pl',
        "default(delta, 0.5). "-
        "default(delta, 0.6). ").
promise(isolated_agent_waits, sync,
        'agents/sync/traveller.pl',
        "    catch(move(Host), error(_, _), pause)."-
        "    catch(move(Host), error(_, _), true).").
promise(visits_until_an_agent_gives_up, sync,
        'agents/sync/traveller.pl',
        "    Potential =\\= 0,\n\c
         \s   !."-
        "    Potential > 1,\n\c
         \s   !.").
promise(on_each_host_in_order, sync,
        'agents/sync/traveller.pl',
        "missing([Earlier-_|Tasks], Sequence, Task, Missing) :-\n\c
         \s   Earlier \\== Task,"-
        "missing([Earlier-_|Tasks], Sequence, Task, Missing) :-\n\c
         \s   Earlier == Earlier,").
promise(busy_pool_is_passed, sync,
        'agents/sync/dependence.pl',
        "    ;   sense(plan(Sequence, _, _))\n\c
         \s   ),"-
        "    ;   Sequence = Sequence\n\c
         \s   ),").
promise(task_that_waits, sync,
        'agents/sync/dependence.pl',
        "    \\+ sense(task(Other, First, completed, _)),\n\c
         \s   !."-
        "    sense(task(Other, First, completed, _)),\n\c
         \s   !.").
promise(waiting_task_is_rewarded, sync,
        'agents/sync/traveller.pl',
        "    give_back(Worker),\n\c
         \s   reward(Missing)."-
        "    give_back(Worker).").
promise(circular_dependences_are_refused, sync_network,
        'agents/sync/several.pl',
        "    (   top_sort(Graph, _)\n\c
         \s   ->  true"-
        "    (   ( top_sort(Graph, _) ; true )\n\c
         \s   ->  true").
promise(unknown_task_to_wait_for, sync_network,
        'agents/sync/several.pl',
        "    forall(( member(First-_, Edges), \\+ memberchk(First, All) ),\n\c
         \s          existence_error(task, First)),\n"-
        "").
promise(free_worker_is_a_tuple, sync,
        'agents/sync/worker.pl',
        "main :-\n\c
         \s   sequence(Sequence),\n\c
         \s   self(Me),\n\c
         \s   leave(worker(Sequence, Me))."-
        "main.").
promise(service_is_rewarded, sync,
        'agents/sync/traveller.pl',
        "    send(Worker, Order),\n\c
         \s   reward(Task)."-
        "    send(Worker, Order).").
promise(executing_host_is_passed, sync,
        'agents/sync/traveller.pl',
        "    seize(Worker),\n\c
         \s   !,\n\c
         \s   (   missing"-
        "    ( seize(Worker) -> true ; Worker = none ),\n\c
         \s   !,\n\c
         \s   (   missing").
promise(completed_host_is_a_penalty, sync,
        'agents/sync/traveller.pl',
        "    ;   give_back(Worker),\n\c
         \s       penalise(Task)\n\c
         \s   )."-
        "    ;   give_back(Worker)\n\c
         \s   ).").
promise(worker_is_given_back, sync,
        'agents/sync/traveller.pl',
        "    ;   give_back(Worker),\n\c
         \s       penalise(Task)\n\c
         \s   )."-
        "    ;   penalise(Task)\n\c
         \s   ).").
promise(revived_by_the_last_theta, sync,
        'agents/sync/traveller.pl',
        "    drive(Task, _, History),\n\c
         \s   last(History, Theta),"-
        "    drive(Task, _, [Theta|_]),").
promise(cascade_begins_again, sync,
        'agents/sync/traveller.pl',
        "    forall(member(Next-_, Later), fill(Next)),\n"-
        "    Later = Later,\n").
promise(revived_task_has_a_new_history, sync,
        'agents/sync/traveller.pl',
        "    keep(Missing, drive(Potential, [Theta0])),"-
        "    keep(Missing, drive(Potential, [Theta])), Theta0 = Theta0,").
promise(mark_is_removed_when_serviced, sync,
        'agents/sync/traveller.pl',
        "    ignore(take(task(Sequence, Task, failed(_), _))),\n"-
        "").
promise(mark_of_the_task_itself_fills_none, sync,
        'agents/sync/traveller.pl',
        "    Missing \\== Task."-
        "    Missing = Missing, Task = Task.").
promise(cascade_during_an_execution, sync,
        'agents/sync/worker.pl',
        "    take(task(Sequence, Task, executing, _)),\n\c
         \s   !,"-
        "    ignore(take(task(Sequence, Task, executing, _))),\n\c
         \s   !,").
promise(failed_task_is_atomic, sync,
        'agents/sync/worker.pl',
        "    ;   settle(Sequence, Task, failed(atomic)),"-
        "    ;   settle(Sequence, Task, completed),").
promise(pause_doubles, sync,
        'agents/sync/worker.pl',
        "    Seconds is 2**min(Count0, 5),"-
        "    Seconds is 1 + min(Count0, 31),").
promise(pause_of_32_seconds, sync,
        'agents/sync/worker.pl',
        "    Seconds is 2**min(Count0, 5),"-
        "    Seconds is 2**min(Count0, 6),").
promise(pause_begins_again, sync,
        'agents/sync/worker.pl',
        "    ->  settle(Sequence, Task, completed),\n\c
         \s       retractall(failures(_))"-
        "    ->  settle(Sequence, Task, completed)").
promise(newer_plan_has_a_greater_version, sync_network,
        'agents/sync/operator.pl',
        "    Version is max(Version0, Found + 0.001)."-
        "    Version is min(Version0, Found).").
promise(tasks_are_distinct, sync_network,
        'agents/sync/operator.pl',
        "        length(Distinct, Count)\n\c
         \s   ->  true"-
        "        length(Distinct, _)\n\c
         \s   ->  true").
promise(bias_above_zero, sync_network,
        'agents/sync/operator.pl',
        "    number(Value),\n\c
         \s   Value > 0,\n\c
         \s   !."-
        "    number(Value),\n\c
         \s   !.").
