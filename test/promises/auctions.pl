%   What doc/auctions.md promises, see ../promises.pl.

promise(message_over_a_link_counts, auction,
        'agents/allocation/auctions/flooding.pl',
        "    body_kind(Body, Kind),\n\c
         \s   count(Kind, Count)."-
        "    body_kind(Body, Kind),\n\c
         \s   count(Kind, min(1, Count)).").
promise(counts_are_logged_and_reset, auction,
        'agents/allocation/common/communications.pl',
        "    forall(retract(sent(Kind, Count)), log"-
        "    forall(sent(Kind, Count), log").
promise(message_takes_a_hop, auction,
        'agents/allocation/auctions/flooding.pl',
        "    Due is Now + Seconds."-
        "    Due is Now + Seconds/2.").
promise(message_waits_until_it_is_due, auction,
        'agents/allocation/auctions/agenda.pl',
        "    Due =< Now,\n\c
         \s   !,"-
        "    Due =< Now + 1,\n\c
         \s   !,").
promise(forwarding_counts_from_the_due_time, auction,
        'agents/allocation/auctions/agenda.pl',
        "    perform(What, Due),"-
        "    perform(What, Now),").
promise(flood_is_forwarded_once, auction,
        'agents/allocation/auctions/flooding.pl',
        "        assertz(wave(Id, -1, Froms)),\n\c
         \s       (   onward"-
        "        assertz(wave(Id, Due, Froms)),\n\c
         \s       (   onward").
promise(flood_does_not_return, auction,
        'agents/allocation/auctions/flooding.pl',
        "    (   Host \\== From,\n\c
         \s       peer(Host, _)"-
        "    (   From = From,\n\c
         \s       peer(Host, _)").
promise(first_copy_that_is_due_counts, auction,
        'agents/allocation/auctions/flooding.pl',
        "    (   Due0 =< Due\n\c
         \s   ->  true"-
        "    (   Due0 \\== inf\n\c
         \s   ->  true").
promise(counted_but_not_sent, auction,
        'agents/allocation/auctions/flooding.pl',
        "    subtract(Others, Froms, Tos),"-
        "    Tos = Others, Froms = Froms,").
promise(known_floods_are_bounded, auction,
        'agents/allocation/auctions/flooding.pl',
        "    make_room(wave(_, _, _), Most),\n"-
        "    Most = Most,\n").
promise(announcement_names_the_closing_time, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    Close is Now + Window,"-
        "    Close is Now + 2*Window,").
promise(one_auction_at_a_time, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    \\+ engaged(Offer, Now),\n"-
        "    Now = Now,\n").
promise(bids_again_when_lost, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    ;   retractall(hold(Job, Round, _, _))\n\c
         \s   ).\n\c
         \n\c
         take_on"-
        "    ;   true\n\c
         \s   ).\n\c
         \n\c
         take_on").
promise(more_urgent_auction_comes_first, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    New =< Old."-
        "    New =< Old + 1.0e9.").
promise(busy_robots_do_not_bid, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    ;   Bids == []\n\c
         \s   ->  retractall(hold(Job, Round, _, _))\n"-
        "    ;   Bids == none\n\c
         \s   ->  retractall(hold(Job, Round, _, _))\n").
promise(cheapest_robots_win, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "    sort(Offers0, Offers),\n\c
         \s   length(Chosen, Count),"-
        "    sort(0, @>=, Offers0, Offers),\n\c
         \s   length(Chosen, Count),").
promise(equal_costs_by_the_name_of_the_host, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "    sort(Offers0, Offers),\n\c
         \s   length(Chosen, Count),"-
        "    keysort(Offers0, Offers),\n\c
         \s   length(Chosen, Count),").
promise(as_many_as_the_task_needs, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "    append(Chosen, _, Offers),\n\c
         \s   !,"-
        "    ( append(Chosen, _, Offers) ; append(Offers, _, Chosen) ),\n\c
         \s   !,").
promise(too_few_bids_back_off, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    (   Hosts == []\n\c
         \s   ->  true\n\c
         \s   ;   tell_robots(Job, Hosts, release(Job, Round, all))"-
        "    (   Hosts = Hosts\n\c
         \s   ->  true\n\c
         \s   ;   tell_robots(Job, Hosts, release(Job, Round, all))").
promise(theta_of_the_bids, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Theta is max(1, Bids)*Minimum."-
        "    Theta is max(1, min(2, Bids))*Minimum.").
promise(failed_round_counts_as_one_bid, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Theta is max(1, Bids)*Minimum."-
        "    Theta is Bids*Minimum.").
promise(winner_that_refuses_is_replaced, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    ;   try_again(Job)\n\c
         \s   ).\n\c
         proceed(executing"-
        "    ;   back_off(Job)\n\c
         \s   ).\n\c
         proceed(executing").
promise(silent_winner_is_released, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    give_back(Job, Round, Silent),"-
        "    Silent = Silent,").
promise(at_most_three_rounds, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    (   Tries < Most\n\c
         \s   ->  open_auction(Job)"-
        "    (   Tries =< Most\n\c
         \s   ->  open_auction(Job)").
promise(starts_when_all_are_reserved, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "proceed(awarding, Places, Ats, Job) :-\n\c
         \s   \\+ memberchk(awarded, Ats),\n\c
         \s   !,"-
        "proceed(awarding, Places, Ats, Job) :-\n\c
         \s   memberchk(reserved, Ats),\n\c
         \s   !,").
promise(all_are_released_at_the_end, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "conclude(Job) :-\n\c
         \s   release_all(Job, _),"-
        "conclude(Job) :-\n").
promise(contract_ends_without_renewal, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    (   Until =< Now\n\c
         \s   ->  give_up(Job, Round),"-
        "    (   Until =< Now\n\c
         \s   ->  true,").
promise(contract_is_renewed, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    assertz(contract(Job, Round, Ref, Details, Now, Until)),\n\c
         \s   (   Phase"-
        "    assertz(contract(Job, Round, Ref, Details, Now, 0)), Until = Until,\n\c
         \s   (   Phase").
promise(contractor_that_is_silent_is_replaced, auction_sides,
        'agents/allocation/auctions/auctioneer.pl',
        "    (   Lost == []\n\c
         \s   ->  true\n\c
         \s   ;   proceed(Job)\n\c
         \s   )."-
        "    (   Lost = Lost\n\c
         \s   ->  true\n\c
         \s   ;   proceed(Job)\n\c
         \s   ).").
promise(node_releases_its_robot, auction_sides,
        'agents/allocation/auctions/contractor.pl',
        "    retractall(contract(Job, _, _, _, _, _)),\n\c
         \s   forall(sense"-
        "    retractall(contract(Job, _, _, _, _, _)),\n\c
         \s   forall(( fail, sense").
promise(tree_down_to_a_level, auction,
        'agents/allocation/anta.pl',
        "    Level0 < Levels,"-
        "    Level0 =< Levels,").
promise(node_reports_once, auction,
        'agents/allocation/anta.pl',
        "    Report is Begin + (Close - Begin)*(2*Levels - Level)/(2*Levels),"-
        "    Report is Begin + (Close - Begin)*(Levels - Level)/Levels,").
promise(lowest_bids_are_reported, auction,
        'agents/allocation/anta.pl',
        "    lowest(Places, All, List),"-
        "    Places = Places, List = All,").
promise(awards_split_on_the_way, auction,
        'agents/allocation/anta.pl',
        "        cross(Child, robots(Job, Hosts, Body), Now)"-
        "        cross(Child, robots(Job, [Child|Hosts], Body), Now)").
promise(answers_go_up_the_tree, auction,
        'agents/allocation/anta.pl',
        "        Parent \\== none,\n\c
         \s       now(Now),"-
        "        Parent == none,\n\c
         \s       now(Now),").
promise(floods_if_the_way_is_lost, auction,
        'agents/allocation/anta.pl',
        "    (   Left == []\n\c
         \s   ->  true\n\c
         \s   ;   flood("-
        "    (   Left = Left\n\c
         \s   ->  true\n\c
         \s   ;   flood(").
promise(one_channel_by_share, auction,
        'agents/allocation/auctions/flooding.pl',
        "    Due is max(Now, Until) + Share*Seconds,"-
        "    Due is Now + Share*Seconds + 0*Until,").
promise(completed_part_counts_for_the_auction, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "becomes(done, _, done) :-\n\c
         \s   !.\n"-
        "").
promise(reports_in_any_order, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "becomes(done, _, done) :-\n\c
         \s   !.\n\c
         becomes(Before, Phase, After) :-\n\c
         \s   later_phase(Before, Phase, After)."-
        "becomes(_, Phase, Phase) :-\n\c
         \s   later_phase(awarded, Phase, _).").
promise(each_team_its_own, auction_sides,
        'agents/allocation/auctions/awards.pl',
        "( member(Host-Bids, Bids0), \\+ memberchk(Host-_, Team) ),"-
        "member(Host-Bids, Bids0),").
