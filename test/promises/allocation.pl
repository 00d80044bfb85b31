%   What doc/allocation.md promises, see ../promises.pl.

promise(requirement_unifies_with_a_property, allocation,
        'agents/allocation/common/requirements.pl',
        "holds(Requirement, Properties) :-\n\c
         \s   member(Requirement, Properties)."-
        "holds(Requirement, Properties) :-\n\c
         \s   functor(Requirement, Name, Arity), functor(P, Name, Arity),\n\c
         \s   member(P, Properties).").
promise(bound_of_a_state_is_included, allocation,
        'agents/allocation/common/requirements.pl',
        "    Value >= Least."-
        "    Value > Least.").
promise(team_needs_its_count, allocation,
        'agents/allocation/common/requirements.pl',
        "    Have < Count."-
        "    Have =< Count.").
promise(task_takes_the_sum_of_its_teams, allocation,
        'agents/allocation/common/requirements.pl',
        "    Count is Count0 + Count1."-
        "    Count is max(Count0, Count1).").
promise(detail_goal_or_a_sleep, allocation,
        'agents/allocation/common/requirements.pl',
        "    detail(duration, Details, 5, Seconds),"-
        "    detail(duration, Details, 1, Seconds),").
promise(goal_runs_in_a_clone, allocation,
        'agents/allocation/robot/execution.pl',
        "    send(Robot, finished(Ref, Outcome)),\n\c
         \s   dispose."-
        "    send(Robot, finished(Ref, done)), Outcome = Outcome,\n\c
         \s   dispose.").
promise(deadline_from_the_start, allocation,
        'agents/allocation/allocator/deadline.pl',
        "    Until is Now + Seconds,\n\c
         \s   keep(until(Until))."-
        "    Until is Seconds + 0*Now,\n\c
         \s   keep(until(Until)).").
promise(rest_ends_at_the_deadline, allocation,
        'agents/allocation/allocator/deadline.pl',
        "    Seconds is max(0, min(Seconds0, Until - Now))."-
        "    Seconds is max(0, Seconds0) + 0*(Until - Now).").
promise(missed_task_releases_all, [allocation_network],
        'agents/allocation/allocator.pl',
        "    deallocate([reserved, started, done])."-
        "    deallocate([reserved]).").
promise(urgent_task_takes_over, allocation,
        'agents/allocation/robot/reservation.pl',
        "    New > Old."-
        "    New >= Old.").
promise(executing_robot_is_kept, allocation,
        'agents/allocation/robot/reservation.pl',
        "yields(Held, reserved, Need) :-"-
        "yields(Held, _, Need) :-").
promise(robot_out_of_order_refuses, allocation,
        'agents/allocation/robot/reservation.pl',
        "verdict(_, refused(failed)) :-\n\c
         \s   failed,\n\c
         \s   !.\n"-
        "").
promise(robots_agent_names_the_cost, allocation,
        'agents/allocation/robot/reservation.pl',
        "verdict(Need, bid(Cost)) :-\n\c
         \s   able(Need, Cost)."-
        "verdict(Need, bid(0)) :-\n\c
         \s   able(Need, _).").
promise(allocator_agrees_to_the_cost, allocation,
        'agents/allocation/allocator/negotiation.pl',
        "    agreed(Cost, Details, Backoffs),\n\c
         \s   !,"-
        "    ( agreed(Cost, Details, Backoffs) ; true ),\n\c
         \s   !,").
promise(hop_reduces_the_resource, allocation,
        'agents/allocation/allocator/migration.pl',
        "migrate :-\n\c
         \s   decay,\n"-
        "migrate :-\n").
promise(reserved_robot_increases_the_resource, allocation,
        'agents/allocation/allocator/negotiation.pl',
        "    assertz(held(Host, Robot, Ref, Team, reserved)),\n\c
         \s   reward(Before)."-
        "    assertz(held(Host, Robot, Ref, Team, reserved)), Before = Before.").
promise(taken_robot_reduces_the_resource, allocation,
        'agents/allocation/allocator/negotiation.pl',
        "    taken(Need),\n\c
         \s   penalty."-
        "    taken(Need).").
promise(backs_off_when_used_up, allocation,
        'agents/allocation/allocator.pl',
        "proceed :-\n\c
         \s   exhausted,\n\c
         \s   !,\n\c
         \s   back_off.\n"-
        "").
promise(rests_for_the_round_of_its_children, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Interval is Theta + Turn*Range."-
        "    Interval is Turn*(Theta + Range).").
promise(range_doubles_with_each_back_off, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Range is min(2.0**min(Backoffs, 60) * Theta, Maximum),"-
        "    Range is min(2.0*min(Backoffs, 60) * Theta, Maximum),").
promise(range_is_bounded, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "* Theta, Maximum),\n\c
         \s   Interval"-
        "* Theta, Maximum*Maximum),\n\c
         \s   Interval").
promise(host_measures_the_time_of_a_hop, allocation_network,
        'agents/allocation/allocator/contention.pl',
        "hop_time(in, stats(_, _, Seconds, _))"-
        "hop_time(in, stats(_, _, _, Seconds))").
promise(begins_again_for_the_robots_it_knows, allocation,
        'agents/allocation/allocator/mobility_resource.pl',
        "    Visited > Found,\n\c
         \s   !."-
        "    Visited >= Found,\n\c
         \s   !.").
promise(child_releases_the_robots, allocation,
        'agents/allocation/allocator/deallocation.pl',
        "    release_all(Share, Until),\n\c
         \s   log_communications,\n\c
         \s   dispose."-
        "    release_all(Share, Until),\n\c
         \s   log_communications.").
promise(child_takes_short_cuts, allocation,
        'agents/allocation/allocator/trail.pl',
        "    keysort(Pairs, [Distance-Host|_]),"-
        "    reverse(Pairs, [Distance-Host|_]),").
promise(trail_leaves_out_detours, allocation,
        'agents/allocation/allocator/trail.pl',
        "detour([Host|_], Host, _, Later, Trail) :-\n\c
         \s   !,\n\c
         \s   Trail = Later.\n"-
        "").
promise(trail_leads_to_each_robot, allocation,
        'agents/allocation/allocator/trail.pl',
        "    memberchk(Goal, Wanted),\n\c
         \s   !,\n\c
         \s   reverse(Before, Nearer),"-
        "    Wanted == none,\n\c
         \s   !,\n\c
         \s   reverse(Before, Nearer),").
promise(broken_route_is_left, allocation,
        'agents/allocation/allocator/deallocation.pl',
        "way_on(_, Distance, Host, Distance) :-\n\c
         \s   next_host(conscientious, Host).\n"-
        "").
promise(silent_robots_are_queried, allocation,
        'agents/allocation/allocator/execution.pl',
        "    forall(held(Host, Robot, Ref, _, started),\n\c
         \s          ignore(post(Host, Robot, status(Ref)))),\n"-
        "").
promise(silent_robot_is_replaced, allocation,
        'agents/allocation/allocator/execution.pl',
        "             memberchk(Robot, Asked) ),\n\c
         \s          give_up(Host, Ref, silent)),"-
        "             memberchk(Robot, Asked) ),\n\c
         \s          log(silent(Host, Ref))),").
promise(completed_part_counts, allocation,
        'agents/allocation/allocator/held_robots.pl',
        "    (   Phase == done\n\c
         \s   ->  assertz(achieved(Team))"-
        "    (   Phase == started\n\c
         \s   ->  assertz(achieved(Team))").
promise(failing_robot_is_asked_after_a_back_off, allocation_network,
        'agents/allocation/allocator/held_robots.pl',
        "    ->  assertz(avoided(Host))"-
        "    ->  true").
promise(robots_are_released_at_the_end, [allocation_network],
        'agents/allocation/allocator.pl',
        "    log(completed(Name)),\n\c
         \s   deallocate([done])."-
        "    log(completed(Name)).").
promise(no_robot_is_reserved_twice, allocation,
        'agents/allocation/robot/reservation.pl',
        "    hold(_, _, Held, _, Phase),\n\c
         \s   \\+ yields(Held, Phase, Need),\n\c
         \s   !,"-
        "    hold(_, _, Held, _, Phase), Phase \\== reserved,\n\c
         \s   \\+ yields(Held, Phase, Need),\n\c
         \s   !,").
promise(no_robot_stays_without_a_holder, allocation,
        'agents/allocation/robot.pl',
        "overdue(answer) :-\n\c
         \s   lose(lapsed)."-
        "overdue(answer).").
promise(robot_asks_its_holder, allocation,
        'agents/allocation/robot.pl',
        "    ignore(tell(Contact, still(Ref)))."-
        "    ignore(Contact-Ref).").
promise(lapsed_robot_stops, allocation_network,
        'agents/allocation/robot/reservation.pl',
        "    remind_nothing,\n\c
         \s   stop(Phase),"-
        "    remind_nothing, Phase = Phase,").
promise(faults_of_reservations, [allocation],
        'agents/allocation/reservations.pl',
        "    (   get_assoc(Robot, Holders0, holder(Other, _))\n\c
         \s   ->  Faults"-
        "    (   get_assoc(Robot, Holders0, holder(Other, _)), Other \\== Owner\n\c
         \s   ->  Faults").
promise(held_at_the_end, allocation,
        'agents/allocation/reservations.pl',
        "    append(Faults1, Held, Faults)."-
        "    Faults = Faults1, Held = Held.").
promise(stray_robots, allocation,
        'agents/allocation/reservations.pl',
        "    (   get_assoc(Robot, Holders, Holder),\n\c
         \s       Holder == holder(Owner, Task)\n"-
        "    (   ( get_assoc(Robot, Holders, Holder) -> Holder = holder(Owner, Task) ; true )\n").
promise(nearest_costs_the_distance, allocation,
        'payloads/allocation/nearest.pl',
        "    Cost is sqrt((X - X0)**2 + (Y - Y0)**2)."-
        "    Cost is (X - X0) + (Y - Y0).").
promise(energy_is_enough, allocation,
        'payloads/allocation/energy.pl',
        "    Charge >= Energy,\n\c
         \s   Charge > 0,"-
        "    Charge > 0,").
promise(budget_doubles, allocation,
        'payloads/allocation/thrifty.pl',
        "Budget * 2**Backoffs"-
        "Budget * (1 + Backoffs)").
promise(sequence_on_exactly_these, allocation_network,
        'agents/allocation/sequence.pl',
        "    maplist(completed(Name, Last), Robots),\n\c
         \s   maplist(dismiss"-
        "    maplist(dismiss").
promise(lost_robot_executes_no_more, allocation_studies,
        'agents/allocation/sequence.pl',
        "    maplist(retire(Name), Lost)."-
        "    Name = Name, Lost = Lost.").
promise(new_robot_executes_the_whole_sequence, allocation_studies,
        'agents/allocation/sequence.pl',
        "    maplist(population_join(Name), New)."-
        "    Name = Name.").
promise(news_are_left_and_collected, allocation,
        'agents/allocation/allocator/news.pl',
        "    parameter(sharing, shared),\n\c
         \s   !,"-
        "    parameter(sharing, own),\n\c
         \s   !,").
promise(newer_news_count, allocation,
        'agents/allocation/allocator/news.pl',
        "    Newer >= Time,\n\c
         \s   !."-
        "    Newer =< Time,\n\c
         \s   !.").
promise(moves_to_a_free_neighbour, allocation,
        'agents/allocation/allocator/news.pl',
        "    last(Sorted, _-Host)."-
        "    Sorted = [_-Host|_].").
promise(children_share_the_robots, allocation,
        'agents/allocation/allocator/deallocation.pl',
        "    Size is ceiling(Length/Count),"-
        "    Size is floor(Length/Count),").
promise(child_lives_so_long, allocation,
        'agents/allocation/allocator/deallocation.pl',
        "    Now >= Until,\n\c
         \s   !,\n\c
         \s   pairs_keys(Robots, Hosts),"-
        "    Now >= Until + 1000,\n\c
         \s   !,\n\c
         \s   pairs_keys(Robots, Hosts),").
promise(message_counts_for_each_link, allocation,
        'agents/allocation/allocator/messages.pl',
        "    count(message, Links)."-
        "    count(message, min(1, Links)).").
promise(local_messages_are_not_counted, allocation,
        'agents/allocation/allocator/negotiation.pl',
        "    ask(Robot, Ref, reserve(Ref, Me, Need), Answer),"-
        "    ask(Robot, Ref, reserve(Ref, Me, Need), Answer), count(message, 1),").
promise(refusals_are_counted, allocation,
        'agents/allocation/allocator/migration.pl',
        "    count(refusal, 1),\n\c
         \s   pause."-
        "    pause.").
promise(unknown_setting_is_refused, allocation,
        'agents/lib/settings.pl',
        "known(Names, Pair) :-\n\c
         \s   unknown_setting(Names, Pair)."-
        "known(_, _).").
promise(allocator_waits_for_begin, allocation,
        'agents/lib/await_order.pl',
        "    !,\n\c
         \s   receive(_-begin)."-
        "    !.").
