%   What doc/hierarchy.md promises, see ../promises.pl.

promise(leader_disposes_of_late_workers, hierarchy_agents,
        'agents/hierarchy/leader.pl',
        "    Left is max(0, Start + Limit - Now),"-
        "    Left is max(0, Start + Limit - Now) + 5000,").
promise(leader_reads_the_facts_on_its_hosts, hierarchy,
        'agents/hierarchy/leader.pl',
        "        append(Here, Facts0, Facts1)"-
        "        Facts1 = Facts0, Here = Here").
promise(observer_waits_for_all_leaders, [hierarchy_agents, hierarchy],
        'agents/hierarchy/observer.pl',
        "    (   length(Reports0, Count)\n\c
         \s   ->"-
        "    (   Reports0 = [_|_], Count = Count\n\c
         \s   ->").
promise(observer_sends_each_leader_its_parameters, [hierarchy],
        'agents/hierarchy/observer.pl',
        "forall(member(One-Changes, Orders), send(One, change(Round, Changes)))"-
        "forall(member(One-_, Orders), send(One, change(Round, [])))").
promise(reports_in_the_order_of_leaders, hierarchy_agents,
        'agents/hierarchy/observer.pl',
        "        sort(Reports0, Reports),"-
        "        Reports = Reports0,").
promise(leader_without_an_observer_decides, hierarchy,
        'agents/hierarchy/operator.pl',
        "decider(leaders, _, _, self)."-
        "decider(leaders, _, _, none).").
promise(no_level_changes_nothing, hierarchy,
        'agents/hierarchy/operator.pl',
        "decider(none, _, _, none)."-
        "decider(none, _, _, self).").
promise(delta_until_the_step_fits, hierarchy,
        'payloads/hierarchy/steps.pl',
        "    Change is Least/max(0.001, 2*Most),"-
        "    Change is Least/max(0.001, Most),").
promise(delta_rises_by_a_fifth, hierarchy,
        'payloads/hierarchy/steps.pl',
        "min(1.2, max(0.2, Change))"-
        "min(2, max(0.2, Change))").
promise(delta_falls_fast, hierarchy,
        'payloads/hierarchy/steps.pl',
        "min(1.2, max(0.2, Change))"-
        "min(1.2, max(0.5, Change))").
promise(spread_over_all_leaders, hierarchy,
        'payloads/hierarchy/steps.pl',
        "            ( member(_-report(_, _, Facts), Reports),\n\c
         \s             member(done"-
        "            ( Reports = [_-report(_, _, Facts)|_],\n\c
         \s             member(done").
promise(workers_in_proportion_to_the_work, hierarchy,
        'payloads/hierarchy/crews.pl',
        "              Work is Last*Count ),"-
        "              Work is Last + 0*Count ),").
promise(half_of_an_equal_share, hierarchy,
        'payloads/hierarchy/crews.pl',
        "    Least is max(1, Workers // (2*Count)),"-
        "    Least is max(1, Workers // (4*Count)),").
promise(number_of_workers_is_constant, hierarchy,
        'payloads/hierarchy/crews.pl',
        "    Count is max(Least, min(Workers - Least*Others, Share)),"-
        "    Count is max(Least, Share) + 0*Others,").
promise(round_ends_when_all_have_served, [hierarchy_agents, hierarchy],
        'agents/hierarchy/customer.pl',
        "    receive(Leader-served(Round)),\n\c
         \s   wait(Leaders, Round)."-
        "    receive(Leader-served(Round)), Leaders = Leaders.").
