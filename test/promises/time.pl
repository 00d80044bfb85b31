%   What doc/time.md promises, see ../promises.pl.

promise(host_clock_shows_the_time_of_day, host,
        'prolog/typhon/kernel/host/hosting.pl',
        "    ;   Epoch = 0, Rate = 1\n"-
        "    ;   monotonic_time(Epoch), Rate = 1\n").
promise(network_clock_counts_from_its_start, virtual,
        'prolog/typhon/network/building.pl',
        "    time_now(Epoch),\n\c
         \s   (   plan_option(Plan, clock(Rate0)),"-
        "    Epoch = 0,\n\c
         \s   (   plan_option(Plan, clock(Rate0)),").
promise(virtual_time_begins_at_zero, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    flag(typhon_virtual_now, _, 0.0),\n"-
        "").
promise(set_clock_changes_no_wait, set_clock,
        'prolog/typhon/kernel/base/monotonic.pl',
        "    (   abs(Error) =< 0.03 "-
        "    (   abs(Error) =< 3.0e9 ").
promise(now_does_not_go_back, set_clock,
        'prolog/typhon/kernel/base/monotonic.pl',
        "    abs(Wall-Middle) =< 0.05,\n"-
        "    Wall-Middle =< 0.05,\n").
promise(processes_started_have_its_clock, set_clock,
        'prolog/typhon/kernel/base/monotonic.pl',
        "        setenv('TYPHON_CLOCK', Ahead)\n"-
        "        true\n").
promise(time_stands_still_while_an_agent_is_ready, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    (   Count > 0\n\c
         \s   ->  run(Count,"-
        "    (   Count > 1\n\c
         \s   ->  run(Count,").
promise(runs_are_alike, virtual,
        'prolog/typhon/kernel/agent/identity.pl',
        "flag(typhon_agent_id, _, 0)"-
        "true").
promise(time_waits_for_the_top_level, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "run(_, [], Queue, Alarms) :-\n\c
         \s   !,\n\c
         \s   wait_for_request(Queue, Alarms).\n"-
        "").
promise(advance_reaches_its_time, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    ->  set_time(End),\n\c
         \s       partition("-
        "    ->  partition(").
promise(appointment_is_in_host_seconds, virtual,
        'prolog/typhon/network/networks.pl',
        "    Stamp is Epoch+Time/Rate,\n\c
         \s   alarm_set(Stamp, Network, at(N))."-
        "    Stamp is Epoch+Time*Rate,\n\c
         \s   alarm_set(Stamp, Network, at(N)).").
promise(saved_network_is_whole, saving,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    exclude(is_over, All0, Alarms),\n"-
        "    All0 = _,\n\c
         \s   Alarms = [],\n").
promise(loaded_network_draws_alike, saving,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    set_random(state(Random)),\n"-
        "    Random = _,\n").
promise(schedule_is_saved, saving,
        'prolog/typhon/network/saving.pl',
        "            ( member(N-Goal, Pairs), due(Network,"-
        "            ( member(N-Goal, Pairs), fail, due(Network,").
promise(endless_goal_is_reported, virtual,
        'prolog/typhon/options/virtual.pl',
        "    (   Steps-Steps0 =< 1 "-
        "    (   Steps-Steps0 < 0 ").
promise(endless_instant_is_reported, virtual,
        'prolog/typhon/options/virtual.pl',
        "    ;   print_message(warning, typhon(virtual_busy(Now)))\n"-
        "    ;   Now = Now\n").
promise(agents_run_in_the_order_in_which_they_became_ready, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    \\+ has_messages(Queue),\n\c
         \s   \\+ ( member"-
        "    \\+ ( member").
promise(alarms_go_off_in_their_order, virtual,
        'prolog/typhon/options/virtual/virtual_loop.pl',
        "    add_to_heap(Heap0, at(Stamp, Count0), What, Heap),\n"-
        "    add_to_heap(Heap0, at(Stamp, 0), What, Heap),\n").
promise(random_numbers_follow_the_seed, virtual,
        'prolog/typhon/options/virtual.pl',
        "typhon_time:seed(virtual, Seed) :-\n\c
         \s   send_loop(do(goal(set_random(seed(Seed)))))."-
        "typhon_time:seed(virtual, _) :-\n\c
         \s   send_loop(do(goal(set_random(seed(1))))).").
promise(choices_follow_the_seed, strategy,
        'prolog/typhon/options/migration/memory.pl',
        "    chance_hash(s(Seed0, Name, Number, HomeName), Seed)."-
        "    Seed0-Name-Number-HomeName = _,\n\c
         \s   Seed is random(1<<30).").
promise(called_goal_cannot_wait, virtual,
        'prolog/typhon/kernel/lifecycle/join.pl',
        "outcome_received(_, timeout)."-
        "outcome_received(_, unknown).").
promise(virtual_network_is_one_process, virtual,
        'prolog/typhon/network/plan.pl',
        "elsewhere(processes(P)) :-\n\c
         \s   P > 1.\n"-
        "").
promise(virtual_host_reaches_no_process, virtual,
        'prolog/typhon/kernel/host/runtime.pl',
        "    time_apart(Kind, Address),\n"-
        "    Kind == none,\n\c
         \s   time_apart(Kind, Address),\n").
promise(one_kind_of_time, virtual,
        'prolog/typhon/kernel/host/runtime.pl',
        "must_agree(time(Kind)) :-\n\c
         \s   \\+ time_kind(Kind),\n"-
        "must_agree(time(Kind)) :-\n\c
         \s   \\+ time_kind(_),\n").
