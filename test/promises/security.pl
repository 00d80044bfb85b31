%   What doc/security.md promises, see ../promises.pl.

promise(first_matching_rule_applies, [access, arrivals],
        'prolog/typhon/options/access.pl',
        "    subsumes_term(Peer, Proof),\n    !,\n"-
        "    subsumes_term(Peer, Proof),\n").
promise(abort_cannot_be_caught, [guard, guard_escapes],
        'prolog/typhon/options/guard/guard_calls.pl',
        "ends_thread('$aborted').\n"-"").
promise(constructs_are_refused, guard_rules,
        'prolog/typhon/options/guard/constructs.pl',
        "construct(@(_,_), refused).\n"-
        "").
promise(no_rule_allows_a_construct, guard_rules,
        'prolog/typhon/options/guard/guard_bodies.pl',
        "guard_construct(refused, Goal, _, _) :-\n\c
         \s   refuse(Goal)."-
        "guard_construct(refused, Goal, own(_, Policy), Goal) :-\n\c
         \s   ( allowed(Policy, Goal, _) -> true ; refuse(Goal) ).").
promise(only_named_payloads_are_attached, guard_rules,
        'prolog/typhon/options/guard/guard_calls.pl',
        "    Spec = payloads(Path),\n\c
         \s   path_below(Path),\n"-
        "    Spec = payloads(Path),\n\c
         \s   ground(Path),\n").
promise(only_followers_are_ended, guard_escapes,
        'prolog/typhon/options/supervision/monitor_words.pl',
        "    (   is_checked,\n\c
         \s       \\+ follows(Agent, Id)\n"-
        "    (   is_checked,\n\c
         \s       Agent == Id\n").
promise(library_typhon_adds_nothing, guard_rules,
        'prolog/typhon/options/guard/guard_clauses.pl',
        "    exclude(is_typhon, Libraries0, Libraries),\n\c
         \s   maplist(library_allowed, Libraries),\n"-
        "    exclude(is_typhon, Libraries0, Others),\n\c
         \s   maplist(library_allowed, Others),\n\c
         \s   Libraries = Libraries0,\n").
promise(no_other_library_is_imported, guard_rules,
        'prolog/typhon/options/guard/allowed.pl',
        "                  heaps, yall ]"-
        "                  heaps, yall, gensym ]").
promise(measures_of_the_machine_are_withheld, guard_rules,
        'prolog/typhon/options/guard/allowed.pl',
        "nb_current/2,\n\c
         \s               abolish_all_tables/0, thread_self/1,\c
         \sstatistics/2,"-
        "nb_current/2,\n\c
         \s               abolish_all_tables/0, thread_self/1,").
promise(terms_are_not_changed_in_place, guard_rules,
        'prolog/typhon/options/guard/allowed.pl',
        "                setarg/3,               % checked terms must\c
         \snot change\n"-
        "").
promise(only_services_of_a_place_are_called, guard,
        'prolog/typhon/options/guard.pl',
        "    set_module(View:base(typhon_vocabulary)),\n\c
         \s   forall(place_service(Place, PI), show(Place, View, PI)),\n"-
        "    set_module(View:base(Place)),\n\c
         \s   forall(place_service(Place, PI), show(Place, View, PI)),\n").
promise(service_calls_are_counted, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "acts(Host, Agent, service(PI)) =>\n\c
         \s   spend(Host, Agent, calls(PI))."-
        "acts(_, _, service(_)) =>\n\c
         \s   true.").
promise(names_of_the_system_are_taken, guard_rules,
        'prolog/typhon/options/guard/allowed.pl',
        "    (   \\+ predicate_property(typhon_vocabulary:Head, visible)\n\c
         \s   ->  true\n\c
         \s   ;   free(Head)\n\c
         \s   )."-
        "    (   \\+ construct(Head, _)\n\c
         \s   ->  true\n\c
         \s   ;   free(Head)\n\c
         \s   ).").
promise(names_of_the_platform_are_reserved, guard_rules,
        'prolog/typhon/options/guard/allowed.pl',
        "    \\+ sub_atom(Name, 0, _, _, $),\n\c
         \s   \\+ sub_atom(Name, 0, _, _, 'mobile ')."-
        "    \\+ sub_atom(Name, 0, _, _, 'mobile ').").
promise(long_atoms_are_not_made, guard_rules,
        'prolog/typhon/options/guard/guard_limits.pl',
        "    joined_length(Goal, Length),\n\c
         \s   Length =< Max,\n"-
        "    joined_length(Goal, Length),\n\c
         \s   Length =< 2*Max,\n").
promise(long_texts_are_not_read, guard_rules,
        'prolog/typhon/options/guard/guard_limits.pl',
        "    most_characters(Max),\n\c
         \s   Length =< Max,\n\c
         \s   made(Length)."-
        "    made(Length).").
promise(atoms_count_as_stack, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "        ( Length1 > Most -> quota_passed(stack) ; true )\n"-
        "        ( Length > Most -> quota_passed(stack) ; true )\n").
promise(other_directives_are_refused, guard_rules,
        'prolog/typhon/options/guard/guard_limits.pl',
        "`~wqadDsefgcrRnt|+`"-
        "`~wqadDsefgcrRnt|+pi`").
promise(counts_of_directives_are_short, guard_rules,
        'prolog/typhon/options/guard/guard_limits.pl',
        "    digits(3),\n"-
        "    digits(9),\n").
promise(known_goals_are_checked_before_admission, guard,
        'prolog/typhon/options/guard.pl',
        "    code_known(Hash, _),\n\c
         \s   !,\n\c
         \s   guarded_module(Policy, Hash, _)."-
        "    code_known(Hash, _),\n\c
         \s   !,\n\c
         \s   policy_read(Policy).").
promise(unknown_goals_are_checked_when_called, guard_names,
        'prolog/typhon/options/guard/guard_bodies.pl',
        "guarded(Goal, _, '$checked'(Goal)) :-\n\c
         \s   var(Goal),"-
        "guarded(Goal, _, Goal) :-\n\c
         \s   var(Goal),").
promise(what_runs_is_a_copy, guard_escapes,
        'prolog/typhon/options/guard/guard_bodies.pl',
        "guard_construct(parts(Parts0, Goal, Parts), _, Own, Goal) :-\n\c
         \s   maplist(guard_part(Own), Parts0, Parts)."-
        "guard_construct(parts(Parts0, Goal1, Parts), Goal0, Own, Goal)\c
         \s:-\n\c
         \s   maplist(guard_part(Own), Parts0, Parts),\n\c
         \s   ( Parts == Parts0 -> Goal = Goal0 ; Goal = Goal1 ).").
promise(nothing_is_loaded_before_admission, imports,
        'prolog/typhon/kernel/program/libraries.pl',
        "file_export(File, Export) :-\n\c
         \s   (   module_property(Module, file(File))\n"-
        "file_export(File, Export) :-\n\c
         \s   use_module(File, []),\n\c
         \s   (   module_property(Module, file(File))\n").
promise(cells_need_a_policy, cell_hosts,
        'prolog/typhon/options/cell/cell_hosts.pl',
        "    ;   memberchk(cell(Kind), Options),\n\c
         \s       Kind \\== none\n"-
        "    ;   memberchk(cell(Kind), Options),\n\c
         \s       Kind == always\n").
promise(cells_count_no_inferences, cell_rules,
        'prolog/typhon/options/cell/cell_hosts.pl',
        "    memberchk(quota(Quotas), Options),\n\c
         \s   memberchk(inferences(N), Quotas),\n"-
        "    memberchk(quota(Quotas), Options),\n\c
         \s   Quotas = [inferences(N)],\n").
promise(cells_live_in_real_time, cell_rules,
        'prolog/typhon/options/cell/cell_hosts.pl',
        "    (   memberchk(clock(Kind), Options)\n\c
         \s   ;   time_kind(Kind)\n\c
         \s   ),"-
        "    time_kind(Kind),").
promise(solutions_are_bounded, cell_rules,
        'prolog/typhon/options/cell/cell_acts.pl',
        "    (   Count =< Most\n\c
         \s   ->  true\n\c
         \s   ;   resource_error(solutions)"-
        "    (   Count =< More\n\c
         \s   ->  true\n\c
         \s   ;   resource_error(solutions)").
promise(frames_are_bounded, cell_rules,
        'prolog/typhon/options/cell/cell_frames.pl',
        "    (   Length =< Most\n\c
         \s   ->  true\n\c
         \s   ;   resource_error(cell_frame)\n\c
         \s   ),"-
        "    Most > 0,").
promise(cells_are_at_most_sixteen, cell_rules,
        'prolog/typhon/options/cell/cells.pl',
        "    Count < Most."-
        "    Count =< Most.").
promise(cell_serves_one_owner, cell_rules,
        'prolog/typhon/options/cell/gatekeeper.pl',
        "    atomic_list_concat([Host, Policy, Owner], ' ', Key)."-
        "    ( Owner == Host -> true ; true ),\n\c
         \s   atomic_list_concat([Host, Policy], ' ', Key).").
promise(idle_cells_end, cell_rules,
        'prolog/typhon/options/cell/cells.pl',
        "    Now-Since > Idle."-
        "    Now-Since > 2*Idle.").
promise(refused_requests_end_the_cell, cell_rules,
        'prolog/typhon/options/cell/cell_acts.pl',
        "    (   Count < Most\n\c
         \s   ->  Count1 is Count+1,"-
        "    (   Count =< Most\n\c
         \s   ->  Count1 is Count+1,").
promise(functors_are_charged, cell_rules,
        'prolog/typhon/options/cell/cell_functors.pl',
        "        counted(Owner, 1)\n"-
        "        counted(Name, 1)\n").
promise(outcomes_are_of_their_turn, cell_rules,
        'prolog/typhon/options/cell/gatekeeper.pl',
        "    N0 == N."-
        "    N0 = N.").
promise(clauses_are_of_the_declared_predicate, cell_rules,
        'prolog/typhon/options/cell/cell_acts.pl',
        "    maplist(is_clause_of(Head), Clauses),\n"-
        "").
promise(long_numbers_are_not_read, cell_rules,
        'prolog/typhon/options/cell/cell_frames.pl',
        "    no_long_number(Text),\n\c
         \s   text_term"-
        "    text_term").
promise(record_of_an_agent_stays, cell_rules,
        'prolog/typhon/options/cell/cell_frames.pl',
        "    exclude(reserved_clause, Clauses0, Clauses)."-
        "    Clauses = Clauses0.").
promise(defaults_where_guarded, quota_bounds,
        'prolog/typhon/options/quotas.pl',
        "default(hops(10 000)).\n"-
        "").
promise(given_quotas_precede_defaults, quota_bounds,
        'prolog/typhon/options/quotas.pl',
        "    append(Given, Defaults, Quotas),"-
        "    append(Defaults, Given, Quotas),").
promise(seconds_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/quota_enforcer.pl',
        "    Seconds > Most,\n\c
         \s   !."-
        "    Seconds >= Most,\n\c
         \s   !.").
promise(stack_is_bounded, quota_bounds,
        'prolog/typhon/options/quotas/quota_enforcer.pl',
        "    Used > Most,\n\c
         \s   !."-
        "    Used >= Most,\n\c
         \s   !.").
promise(state_is_bounded, quota_bounds,
        'prolog/typhon/options/quotas/quota_agents.pl',
        "    add(Id, Length, Count),\n\c
         \s       (   Count =< Most\n"-
        "    add(Id, Length, Count),\n\c
         \s       (   Length =< Most\n").
promise(terms_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    spend(Host, Agent, log),\n\c
         \s   must_be_small(Host, What)."-
        "    spend(Host, Agent, log),\n\c
         \s   ( atomic(What) -> true ; true ).").
promise(clones_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    (   Count =< Most,\n\c
         \s       clones_in_second"-
        "    (   Count =< Most+1,\n\c
         \s       clones_in_second").
promise(payloads_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "        Count >= Most\n\c
         \s   ->  quota_passed(payloads)"-
        "        Count > Most\n\c
         \s   ->  quota_passed(payloads)").
promise(tuples_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    left_by(Host, agent, Agent, Count),\n\c
         \s   Count >= Most,"-
        "    left_by(Host, agent, Agent, Count),\n\c
         \s   Count > Most,").
promise(mailboxes_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/quota_agents.pl',
        "    Space is max(0, integer(Most)-There),"-
        "    Space is max(0, integer(Most)+1-There),").
promise(lifetime_is_bounded, quotas,
        'prolog/typhon/options/quotas/quota_agents.pl',
        "    Until is Now+Seconds."-
        "    Until is Now+2*Seconds.").
promise(acts_of_a_second_are_bounded, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    (   Count =< Most\n\c
         \s   ->  true\n\c
         \s   ;   quota_passed(What)\n\c
         \s   ).\n\c
         \n\c
         %   Agents that have left"-
        "    (   Count =< Most+1\n\c
         \s   ->  true\n\c
         \s   ;   quota_passed(What)\n\c
         \s   ).\n\c
         \n\c
         %   Agents that have left").
promise(agents_of_an_owner_are_bounded, quotas,
        'prolog/typhon/options/quotas/quota_agents.pl',
        "    quota_owned(Host, Key, Count),\n\c
         \s   Count >= Most."-
        "    quota_owned(Host, Key, Count),\n\c
         \s   Count > Most.").
promise(owners_share_a_quota, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    Count > Most,\n\c
         \s   !.\n\c
         too_often"-
        "    Count >= Most,\n\c
         \s   !.\n\c
         too_often").
promise(no_agent_ends_for_what_others_use, quota_bounds,
        'prolog/typhon/options/quotas/usage.pl',
        "    All > Most,\n\c
         \s   \\+ ( shared(Host, What, Other, _, More),\n\c
         \s        Other \\== all,\n\c
         \s        More > Count )."-
        "    All > Most.").
promise(agent_without_space_is_refused, quota_bounds,
        'prolog/typhon/options/quotas/quota_agents.pl',
        "    brought(From, Entrant, Count),\n\c
         \s   Count > Most."-
        "    brought(From, Entrant, Count),\n\c
         \s   Count > Most+1.").
promise(remote_goals_and_logs_need_the_secret, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "secret_needed(log).\n"-
        "").
promise(surveys_need_the_right_on_all_hosts, kinds,
        'prolog/typhon/kernel/wire/kinds.pl',
        "arrives(request, survey, look(_:count), watch, all, inventory)."-
        "arrives(request, survey, look(_:count), watch, some, inventory).").
promise(right_is_needed_where_the_agent_is, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "    (   agent_scope(Id, Host)\n\c
         \s   ->  Hosts = [Host]\n"-
        "    (   agent_scope(Id, _)\n\c
         \s   ->  scope_hosts(some, Hosts)\n").
promise(undeclared_terms_are_refused, kinds,
        'prolog/typhon/kernel/wire/kinds.pl',
        "    ;   ignore(peer_permitted(undeclared(Kind), all, Term,\c
         \sPeer)),\n\c
         \s       Verdict = undeclared\n"-
        "    ;   peer_permitted(undeclared(Kind), all, Term, Peer)\n\c
         \s   ->  Verdict = ok\n\c
         \s   ;   Verdict = undeclared\n").
promise(children_obey_their_parent, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "    (   arg(1, Term, Secret),\n\c
         \s       secret(Secret)\n"-
        "    (   arg(1, Term, Secret),\n\c
         \s       secret(_),\n\c
         \s       atom(Secret)\n").
promise(records_need_the_right_to_run_goals, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "    *-> \\+ ( proof_may(Proof, Host, remote),\n\c
         \s            \\+ host_option(Host, remote(false)) )\n"-
        "    *-> \\+ proof_may(Proof, Host, remote)\n").
promise(refusals_are_audited, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "    ;   security_event(Host, Peer, refused(Right)),\n\c
         \s       fail\n"-
        "    ;   fail\n").
promise(undeclared_terms_are_audited, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "           security_event(Host, Peer, undeclared(Kind)))."-
        "           security_event(Host, Peer, undeclared)).").
promise(forged_senders_are_audited, rights,
        'prolog/typhon/options/identity/sender_rights.pl',
        "    ->  security_event(Host, Peer, refused(Id, from(From)))\n"-
        "    ->  ignore(Host == From)\n").
promise(orders_and_goals_are_audited, rights,
        'prolog/typhon/kernel/host/rights.pl',
        "audited(remote).\n"-
        "").
promise(audit_has_no_control_characters, rights,
        'prolog/typhon/options/access.pl',
        "        write_portable(Out, Entry,\n\c
         \s                      [ignore_ops(true), fullstop(true),\c
         \snl(true)]),"-
        "        format(Out, '~w.~n', [Entry]),").
promise(audit_is_private, rights,
        'prolog/typhon/options/access.pl',
        "        private_open(File, append, Out, [encoding(utf8)]),"-
        "        open(File, append, Out, [encoding(utf8)]),").
