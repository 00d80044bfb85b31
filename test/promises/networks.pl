%   What doc/networks.md promises, see ../promises.pl.

promise(line_is_a_chain, topology,
        'prolog/typhon/network/topology.pl',
        "    between(2, N, J),\n\c
         \s   I is J - 1."-
        "    between(3, N, J),\n\c
         \s   I is J - 1.").
promise(ring_closes, topology,
        'prolog/typhon/network/topology.pl',
        "    N > 2.\n\c
         linked(star"-
        "    N > 3.\n\c
         linked(star").
promise(star_has_a_centre, topology,
        'prolog/typhon/network/topology.pl',
        "linked(star(N), 1, J) :-\n\c
         \s   between(2, N, J)."-
        "linked(star(N), 1, J) :-\n\c
         \s   between(3, N, J).").
promise(hubs_are_a_chain, topology,
        'prolog/typhon/network/topology.pl',
        "    (   Arm < Arms,\n\c
         \s       J is I + Len\n"-
        "    (   Arm < Arms - 1,\n\c
         \s       J is I + Len\n").
promise(tree_is_binary, topology,
        'prolog/typhon/network/topology.pl',
        "    I is J // 2."-
        "    I is (J + 1) // 2.").
promise(rows_of_a_grid_are_linked, topology,
        'prolog/typhon/network/topology.pl',
        "    ;   Row < Rows,\n\c
         \s       J is I + Cols\n"-
        "    ;   Row < Rows - 1,\n\c
         \s       J is I + Cols\n").
promise(mesh_has_all_links, topology,
        'prolog/typhon/network/topology.pl',
        "linked(mesh(N), I, J) :-\n\c
         \s   pair_below(N, I, J)."-
        "linked(mesh(N), I, J) :-\n\c
         \s   pair_below(N, I, J),\n\c
         \s   J < N.").
promise(random_network_is_connected, topology,
        'prolog/typhon/network/topology.pl',
        "    append(Ties, Drawn, Edges)."-
        "    append([], Drawn, Edges), Ties = _.").
promise(cost_is_one_by_default, costs,
        'prolog/typhon/kernel/host/links.pl',
        "    ->  Cost = Cost0\n\c
         \s   ;   Cost = 1\n"-
        "    ->  Cost = Cost0\n\c
         \s   ;   Cost = 0\n").
promise(linking_again_keeps_the_cost, costs,
        'prolog/typhon/kernel/host/links.pl',
        "set_cost(same, _, _) :-\n\c
         \s   !.\n"-
        "set_cost(same, Name, Address) :-\n\c
         \s   !,\n\c
         \s   retractall(cost(Name, Address, _)).\n").
promise(unlink_removes_the_cost, costs,
        'prolog/typhon/kernel/host/links.pl',
        "    retractall(cost(Name, Address, _)),\n\c
         \s   forall"-
        "    forall").
promise(links_come_before_goals, host_setup,
        'prolog/typhon/network/building.pl',
        "    plan_links(Plan, Links),\n\c
         \s   wire_links(Network, P, Links),\n\c
         \s   plan_host_setup(Plan, Goals),\n\c
         \s   wire_goals(Network, P, Goals),\n"-
        "    plan_host_setup(Plan, Goals),\n\c
         \s   wire_goals(Network, P, Goals),\n\c
         \s   plan_links(Plan, Links),\n\c
         \s   wire_links(Network, P, Links),\n").
promise(contents_are_for_that_host_alone, host_setup,
        'prolog/typhon/network/host_setup.pl',
        "    ->  host_name(Host, Name),\n\c
         \s       item("-
        "    ->  host_name(Host, _),\n\c
         \s       item(").
promise(changes_follow_the_seed, dynamics,
        'prolog/typhon/network/dynamics.pl',
        "    chance_seed(Seed, Chance0),\n\c
         \s   empty_heap"-
        "    Seed = _,\n\c
         \s   chance_seed(1, Chance0),\n\c
         \s   empty_heap").
promise(pending_goals_are_saved, saving,
        'prolog/typhon/network/saving.pl',
        "            ( member(N-Goal, Pairs), due(Network, at(N), Stamp) ),"-
        "            ( member(N-Goal, Pairs), N == none, Stamp = 0 ),").
promise(clock_of_a_network_continues, saving,
        'prolog/typhon/network/saving.pl',
        "    time_now(Now),\n    dynamics"-"    Now = 0,\n    dynamics").
promise(saving_has_a_deadline, saving,
        'prolog/typhon/network/saving.pl',
        "    (   memberchk(late, Answers)\n    ->  throw"-
        "    (   fail\n    ->  throw").
promise(file_ends_with_its_checksum, saving,
        'prolog/typhon/network/saving.pl',
        "    (   sum_of(Body, Sum)\n"-"    (   sum_of(Body, _)\n").
promise(older_file_is_replaced_when_the_new_one_is_complete, saving,
        'prolog/typhon/network/saving.pl',
        "    private_write(File, write_all([Header|Terms]))."-
        "    write_all([Header|Terms], File).").
promise(host_outside_the_network_is_refused, saving,
        'prolog/typhon/network/saving.pl',
        "    permission_error(save, host, Address)."-
        "    print_message(silent, beside(Address)).").
promise(cut_file_is_refused, saving,
        'prolog/typhon/network/saving.pl',
        "    (   append(Lines, [End, \"\"], Parts),\n"-
        "    (   append(Lines, [End|_], Parts),\n").
promise(file_of_another_version_is_refused, saving,
        'prolog/typhon/network/saving.pl',
        "    (   format_version(Version)\n"-"    (   integer(Version)\n").
