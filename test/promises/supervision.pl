%   What doc/supervision.md promises, see ../promises.pl.

promise(end_is_reported_once, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    (   monitor_remove(Watcher, Agent)\n    ->  notify"-
        "    (   monitor(_, Watcher, Agent)\n    ->  notify").
promise(end_before_is_reported_at_once, monitors,
        'prolog/typhon/kernel/travel/home.pl',
        "    (   outcome(Id, Outcome, _)\n    ;   faulty(Id, Outcome, _),\n        \c
         Outcome \\== none\n    ),\n    !.\nwait_or_answer"-
        "    faulty(Id, Outcome, _),\n    Outcome \\== none,\n    !.\n\c
         wait_or_answer").
promise(fate_is_shared_by_the_monitoring_agent, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    (   Shared == true\n    ->  monitor_add(ends(Id), Agent)\n    \c
         ;   true\n    ),\n"-
        "").
promise(fate_is_shared_by_the_monitored_agent, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    ;   shares(Agent, monitor_add(ends(Agent), Id))\n    )."-
        "    ;   true\n    ).").
promise(outcome_done_ends_no_other, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "notify(ends(_), _, done) :-\n    !.\n"-"").
promise(follower_gets_no_message, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    !,\n    monitor_add(ends(Id), Agent).\nmonitor_begin"-
        "    !,\n    monitor_add(ends(Id), Agent),\n    \c
         monitor_add(Id, Agent).\nmonitor_begin").
promise(follower_is_linked_from_the_start, monitors,
        'prolog/typhon/options/supervision/monitor_words.pl',
        "    agent_home_endpoint(Parent, _),\n    \c
         monitor_begin(Id, Parent, self)."-
        "    agent_home_endpoint(Parent, _).").
promise(followers_are_listed, monitors,
        'prolog/typhon/options/supervision/monitor_words.pl',
        "member(follows(Agent, Id), Relations)"-
        "member(follows(Id, Agent), Relations)").
promise(unmonitored_agent_is_not_reported, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    ignore(monitor_remove(Id, Agent)),\n    ignore("-"    ignore(").
promise(unmonitor_ends_shared_fate, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    ignore(monitor_remove(ends(Id), Agent)),\n    \c
         shares(Agent, monitor_remove(ends(Agent), Id))."-
        "    shares(Agent, monitor_remove(ends(Agent), Id)).").
promise(unknown_agent_is_reported, monitors,
        'prolog/typhon/kernel/travel/home.pl',
        "wait_or_answer(_, _, _, unknown)."-"wait_or_answer(_, _, _, wait).").
promise(monitors_follow_both_agents, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    post_on(Id, [system-down(Agent, Outcome)])."-
        "    agent_on(Id, _),\n    \c
         post_on(Id, [system-down(Agent, Outcome)]).").
promise(second_monitor_has_no_effect, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "add(Key, _, _, false) :-\n    monitor(Key, _, _),\n    !.\n"-"").
promise(lost_agent_is_disposed_of, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    ;   orphans_end(Agents),\n"-"    ;   true,\n").
promise(agent_of_a_dead_process_is_lost, monitors,
        'prolog/typhon/options/supervision/monitored_agents.pl',
        "    forall(member(at(Agent, Address, _, _), Lost),\n           \c
         report_lost(Agent, Address))."-
        "    forall(member(at(Agent, Address, _, none), Lost),\n           \c
         report_lost(Agent, Address)).").
promise(process_with_a_journal_is_not_gone, monitors,
        'prolog/typhon/kernel/wire/peer_cache.pl',
        "    endpoint_left(Address),\n    \\+ endpoint_lasting(Address)."-
        "    endpoint_left(Address).").
promise(monitors_are_restored, restored,
        'prolog/typhon/options/supervision/monitors.pl',
        "    durable_assertz(monitor(Key, Watcher, Agent))."-
        "    assertz(monitor(Key, Watcher, Agent)).").
promise(goal_of_a_monitor_is_called_once, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    catch(ignore(call(Goal, Agent, Outcome)), Ball,"-
        "    catch(forall(call(Goal, Agent, Outcome), true), Ball,").
promise(monitoring_needs_no_host, monitors,
        'prolog/typhon/options/supervision/monitors.pl',
        "    runtime_acquire(monitor(N), []),\n"-"").
promise(children_start_in_order, supervisor,
        'agents/supervisor.pl',
        "    findall(Name, child(Name, _, _), Names),\n    \c
         start_all(Names),\n    serve."-
        "    findall(Name, child(Name, _, _), Names0),\n    \c
         reverse(Names0, Names),\n    start_all(Names),\n    serve.").
promise(one_for_one_restarts_one, supervisor,
        'agents/supervisor.pl',
        "with_it(one_for_one, Name, _, [Name])."-
        "with_it(one_for_one, _, All, All).").
promise(one_for_all_restarts_all, supervisor,
        'agents/supervisor.pl',
        "with_it(one_for_all, _, All, All)."-
        "with_it(one_for_all, Name, _, [Name]).").
promise(rest_for_one_restarts_the_rest, supervisor,
        'agents/supervisor.pl',
        "    !,\n    Rest = [Name|Others]."-
        "    !,\n    Rest = [Name],\n    Others = _.").
promise(children_end_in_reverse_order, supervisor,
        'agents/supervisor.pl',
        "    reverse(Pairs0, Pairs),\n"-"    Pairs = Pairs0,\n").
promise(restarts_are_bounded, supervisor,
        'agents/supervisor.pl',
        "    ( Count > Most -> TooMany"-"    ( Count > Most+1 -> TooMany").
promise(old_restarts_do_not_count, supervisor,
        'agents/supervisor.pl',
        "    forget_before(Since),\n    aggregate_all"-"    aggregate_all").
promise(three_restarts_in_five_seconds_by_default, supervisor,
        'agents/supervisor.pl',
        "Most = 3, Seconds = 5 ),"-"Most = 3, Seconds = 50 ),").
promise(standby_takes_over, supervisor,
        'agents/supervisor.pl',
        "        stop_all(Names),\n        supervise\n"-
        "        stop_all(Names)\n").
promise(permanent_child_starts_again, supervisor,
        'agents/supervisor.pl',
        "starts_again(permanent, _)."-
        "starts_again(permanent, Outcome) :-\n    Outcome \\== done.").
promise(transient_child_starts_again_after_a_failure, supervisor,
        'agents/supervisor.pl',
        "starts_again(transient, Outcome) :-\n    Outcome \\== done."-
        "starts_again(transient, _).").
promise(temporary_child_does_not_start_again, supervisor,
        'agents/supervisor.pl',
        "    (   starts_again(Restart, Outcome)\n"-
        "    (   ( starts_again(Restart, Outcome) ; Restart == temporary )\n\c
         ").
promise(child_starts_on_its_previous_host, supervisor,
        'agents/supervision/places.pl',
        "    (   stood(Name, Host)\n    ->  true\n    \c
         ;   option(host(Host), Options)\n    ->  true\n    \c
         ;   here(Host)\n    )."-
        "    here(Host),\n    Name-Options = _.").
promise(least_loaded_host_is_chosen, supervisor,
        'agents/supervision/places.pl',
        "    keysort(Pairs0, Pairs),\n"-"    sort(1, @>=, Pairs0, Pairs),\n").
promise(tagged_host_is_chosen, supervisor,
        'agents/supervision/places.pl',
        "catch(remote(Host, sense(tag(Tag))), error(_, _), fail)"-
        "catch(remote(Host, \\+ sense(tag(Tag))), error(_, _), fail)").
promise(places_are_tried_in_order, supervisor,
        'agents/supervision/places.pl',
        "    append(First, Rest, Places)."-"    append(Rest, First, Places).").
promise(start_is_tried_again, supervisor,
        'agents/supervisor.pl',
        "    findall(Name, pending(Name), Names),\n    start_all(Names).\n\c
         handle"-
        "    true.\nhandle").
promise(stop_ends_the_children_and_the_supervisor, supervisor,
        'agents/supervisor.pl',
        "    findall(Name, running(Name, _), Names),\n    \c
         stop_all(Names).\nserved"-
        "    true.\nserved").
promise(restart_on_demand, supervisor,
        'agents/supervisor.pl',
        "handle(restart(Name), _) :-\n    again(Name)."-
        "handle(restart(_), _).").
promise(children_are_answered, supervisor,
        'agents/supervisor.pl',
        "    tell(From, children(Pairs))."-"    From-Pairs = _.").
promise(child_does_not_outlive_its_supervisor, supervisor,
        'agents/supervisor.pl',
        "[host(Host),follows(true)|Options]"-"[host(Host)|Options]").
promise(child_may_be_a_supervisor, supervisor,
        'agents/supervisor.pl',
        "    catch(( create(Program, Agent, [host(Host)"-
        "    catch(( Program \\== self,\n            \c
         create(Program, Agent, [host(Host)").
promise(failed_child_is_kept, supervisor,
        'agents/supervisor.pl',
        "    log(down(Name, Outcome)),\n"-
        "    log(down(Name, Outcome)),\n    end(Agent),\n").
promise(new_offer_replaces_the_first, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    remove(Agent, Service),\n    forall(is_lapsed"-
        "    forall(is_lapsed").
promise(withdrawn_offer_is_not_found, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    with_mutex(typhon_offers, remove(Agent, Service))."-
        "    Agent-Service = _.").
promise(nearest_offers_come_first, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    append(Levels, Found)."-
        "    reverse(Levels, Farthest),\n    append(Farthest, Found).").
promise(offer_must_be_ground, directory,
        'prolog/typhon/options/directory/directory_words.pl',
        "    must_be(ground, Service),\n"-"").
promise(offer_lapses_when_the_agent_leaves, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    life_hops(Life, Hops),\n    !."-
        "    life_hops(Life, Hops0),\n    \c
         ( var(Hops) -> Hops = Hops0 ; true ),\n    !.").
promise(offer_lapses_when_the_agent_is_faulty, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    agent_hops(Agent, Host, Hops),\n    \c
         \\+ agent_status(Agent, faulty(_), _)."-
        "    agent_hops(Agent, Host, Hops).").
promise(offers_are_selected_by_properties, directory,
        'prolog/typhon/options/directory/offers.pl',
        "           ( member(One, Own), \\+ One \\= Property ))."-
        "           ( member(_, Own), Property = _ )).").
promise(farther_hosts_are_not_queried, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    (   ( Radius == 0 ; Count >= Most )\n"-
        "    (   ( Radius == 0 ; Count > Most )\n").
promise(offers_are_found_within_the_radius, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    Less is Radius-1."-"    Less is max(1, Radius-1).").
promise(offers_are_restored, restored,
        'prolog/typhon/options/directory/offers.pl',
        "    durable_assertz(offer(Agent, N, Host, Hops, Service, Properties))."-
        "    assertz(offer(Agent, N, Host, Hops, Service, Properties)).").
