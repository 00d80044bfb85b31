%   What doc/agents.md promises, see ../promises.pl.

promise(directive_is_not_run, program,
        'prolog/typhon/kernel/program/parts.pl',
        "    ;   Formal = domain_error(directive, Directive)\n"-
        "    ;   fail\n").
promise(program_has_an_entry, program,
        'prolog/typhon/kernel/program/parts.pl',
        "    \\+ ( member(PI, PIs), is_entry(PI) ),\n"-
        "    PIs == [],\n").
promise(library_is_a_name, [imports, program],
        'prolog/typhon/kernel/program/libraries.pl',
        "    \\+ ( sub_atom(Name, _, 1, _, Char),\n"-
        "    \\+ ( Name == (..), Char = (..),\n").
promise(library_is_no_symbolic_link, [imports, program],
        'prolog/typhon/kernel/program/libraries.pl',
        "        is_link(Name, File)\n\c
         \s   ->"-
        "        Name = File\n\c
         \s   ->").
promise(program_has_its_hash, arrival,
        'prolog/typhon/kernel/program/code.pl',
        "        maplist(is_import, Libraries),\n\c
         \s       program_hash(Program, Hash)\n"-
        "        maplist(is_import, Libraries)\n").
promise(program_is_sent_once, hop,
        'prolog/typhon/kernel/agent/image.pl',
        "            assertz(has_program(Endpoint, Hash)))."-
        "            true).").
promise(changed_file_is_read_again, program,
        'prolog/typhon/kernel/program/loaded.pl',
        "    loaded(Key, Sources, Loaded0),\n\c
         \s   source_same(Sources),\n"-
        "    loaded(Key, _, Loaded0),\n").
promise(program_cache_is_bounded, program,
        'prolog/typhon/kernel/program/loaded.pl',
        "    Count > Max,\n\c
         \s   loaded(Key, _, _),"-
        "    Count > 100*Max,\n\c
         \s   loaded(Key, _, _),").
promise(handler_in_the_state_counts, agent,
        'prolog/typhon/kernel/agent/agent_module.pl',
        "number_of_clauses(N)),\n\c
         \s       N > 0\n\c
         \s   ).\n\c
         \n\c
         \s               /*"-
        "number_of_clauses(N)),\n\c
         \s       N < 0\n\c
         \s   ).\n\c
         \n\c
         \s               /*").
promise(order_before_message, agent,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "    (   \\+ agent_ordered(Id),\n\c
         \s       mail_take"-
        "    (   mail_take").
promise(failed_agent_is_kept, faulty,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "    agent_fails(Id, failed, Goals0)."-
        "    Goals0 = Goals0,\n\c
         \s   ignore(agent_end(Id, failed)).").
promise(agent_that_raised_is_kept, faulty,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "conclude(raised(Error), Goals0, turn(Id, _, _), stop) :-\n\c
         \s   agent_fails(Id, raised(Error), Goals0)."-
        "conclude(raised(Error), _, turn(Id, _, _), stop) :-\n\c
         \s   ignore(agent_end(Id, raised(Error))).").
promise(error_can_travel, faulty,
        'prolog/typhon/kernel/agent/fault.pl',
        "    printable_fallback(Outcome1-Goal0, Outcome-Goal),\n\c
         \s   life_hops(Life, Hops),\n\c
         \s   get_time(Stamp).\n\c
         \n\c
         %   advised"-
        "    Outcome-Goal = Outcome1-Goal0,\n\c
         \s   life_hops(Life, Hops),\n\c
         \s   get_time(Stamp).\n\c
         \n\c
         %   advised").
promise(outcomes_are_bounded, bounds,
        'prolog/typhon/kernel/travel/home.pl',
        "    bounded(outcome(_, _, _), typhon_whereabouts:outcomes,\n\c
         \s           durable_assertz(outcome(Id, Outcome, Hops))),"-
        "    durable_assertz(outcome(Id, Outcome, Hops)),").
promise(agent_that_does_not_understand_stays, [agent, faulty],
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "                   ;   message_failed(From, Message)\n"-
        "                   ;   fail\n").
promise(faulty_agent_keeps_its_mail, faulty,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    mail_keep(Id, Messages),\n\c
         \s   fail."-
        "    Messages = [_|_],\n\c
         \s   fail.").
promise(faulty_agent_takes_no_capacity, [faulty, agent],
        'prolog/typhon/kernel/lifecycle/ending.pl',
        "        assertz(kept(Id)),\n\c
         \s       host_leave(Host)\n"-
        "        assertz(kept(Id))\n").
promise(faulty_agent_answers_at_once, results,
        'prolog/typhon/kernel/travel/home.pl',
        "    put_fault(Id, Outcome, Hops-Stamp),\n\c
         \s   waiters(Id, Askers)."-
        "    put_fault(Id, Outcome, Hops-Stamp),\n\c
         \s   Askers = [].").
promise(join_waits_after_resume, faulty,
        'prolog/typhon/kernel/travel/home.pl',
        "    ;   faulty(Id, Outcome, _),\n\c
         \s       Outcome \\== none\n"-
        "    ;   faulty(Id, Outcome, _)\n").
promise(faulty_agent_takes_orders, [faulty, agent],
        'prolog/typhon/kernel/lifecycle/orders.pl',
        "idle(faulty(_)).\n"-
        "").
promise(faulty_until_resumed, faulty,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "    ->  agent_stays(Id, Goals)\n"-
        "    ->  ignore(agent_end(Id, disposed)), Goals = _\n").
promise(new_program_applies_to_later_calls, faulty,
        'prolog/typhon/tools/administration/change.pl',
        "    append(PIs, Empty, Declared),\n"-
        "    Declared = Empty,\n\c
         \s   PIs = _,\n").
promise(faulty_agents_are_bounded, agent,
        'prolog/typhon/kernel/lifecycle/ending.pl',
        "    Count > Max,\n\c
         \s   kept(Id),"-
        "    Count > 100*Max,\n\c
         \s   kept(Id),").
promise(mail_of_faulty_agents_is_bounded, faulty,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    (   Count < Max\n\c
         \s   ->  mail_put(Id, [Message])"-
        "    (   Count < 100*Max\n\c
         \s   ->  mail_put(Id, [Message])").
promise(last_result_counts, results,
        'prolog/typhon/kernel/agent/payloads.pl',
        "    !,\n\c
         \s   assertz(Module:'$legacy'(result(Term))),\n\c
         \s   once(retract(Module:'$legacy'(result(_))))."-
        "    Term = Term,\n\c
         \s   !.").
promise(no_result_at_the_timeout, results,
        'prolog/typhon/kernel/lifecycle/join.pl',
        "    \\+ memberchk(Outcome, [timeout, lost(_)]),\n\c
         \s   results_of"-
        "    results_of").
promise(no_result_is_an_error, results,
        'prolog/typhon/kernel/lifecycle/join.pl',
        "    ;   existence_error(result, Agent)\n"-
        "    ;   fail\n").
promise(results_are_bounded, results,
        'prolog/typhon/kernel/travel/outcomes.pl',
        "           bounded(left(_, _), typhon_outcomes:results,\n\c
         \s                  durable_assertz(left(Id, Item))))."-
        "           durable_assertz(left(Id, Item))).").
promise(family_has_clones_of_clones, results,
        'prolog/typhon/kernel/lifecycle/join.pl',
        "    append(Clones, Agents, Others),\n"-
        "    append(Agents, [], Others), Clones = _,\n").
promise(unborn_clone_is_no_member, results,
        'prolog/typhon/kernel/travel/transfer.pl',
        "    clone_unborn(Id, CloneId),\n"-
        "").
promise(ambiguous_host_is_an_error, [host_names, network],
        'prolog/typhon/kernel/host/host_names.pl',
        "the_only([Address], _, Address) :-"-
        "the_only([Address|_], _, Address) :-").
promise(one_agent_takes_a_fact, host,
        'prolog/typhon/kernel/host/tuples.pl',
        "    retract(Place:('$tuple'(Fact) :- Body0)),\n\c
         \s   !,\n"-
        "    clause(Place:'$tuple'(Fact), Body0),\n\c
         \s   !,\n\c
         \s   retractall(Place:'$tuple'(Fact)),\n").
promise(new_fact_is_new, tuples,
        'prolog/typhon/kernel/host/tuples.pl',
        "               ( \\+ Place:'$tuple'(Fact),\n"-
        "               ( \\+ ( Place:'$tuple'(Found), Found == Fact ),\n").
promise(leave_new_is_atomic, tuples,
        'prolog/typhon/kernel/host/tuples.pl',
        "    with_mutex(typhon_tuples,\n\c
         \s              ( \\+ Place"-
        "    call(\n\c
         \s              ( \\+ Place").
promise(result_is_bounded, results,
        'prolog/typhon/kernel/agent/payloads.pl',
        "    (   Length =< Most\n"-
        "    (   Length =< 10*Most\n").
promise(random_ties_are_ordered, pheromone,
        'prolog/typhon/options/migration/pheromone.pl',
        "    sort(Nexts0, Nexts),\n"-
        "    Nexts = Nexts0,\n").
promise(order_of_neighbours_does_not_matter, strategy,
        'prolog/typhon/options/migration/strategy.pl',
        "    sort(Neighbours, Hosts),\n"-
        "    Hosts = Neighbours,\n").
promise(oldest_message_is_taken, [mailbox, agent],
        'prolog/typhon/kernel/base/fifo.pl',
        "    (   Seen0 \\== found,\n\c
         \s       Next = Message\n"-
        "    (   Seen0 \\== found,\n\c
         \s       ( Left > 0 -> Next == Message ; Next = Message )\n").
promise(other_messages_keep_their_order, [mailbox, agent],
        'prolog/typhon/kernel/base/fifo.pl',
        "        ;   rotate(Left, found, Queue, Message)\n"-
        "        ;   true\n").
promise(receive_fails_at_its_timeout, agent,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "    answer_at(receive(Message, Seconds), fail, Hole)."-
        "    Message-Seconds = _,\n\c
         \s   Hole = true.").
promise(condition_travels, machine,
        'prolog/typhon/kernel/program/machine.pl',
        "    Frame = Sub-(Sub->Then;Else),\n"-
        "    Frame = Sub-(Sub->Then;fail),\n").
promise(catch_travels, [machine, agent],
        'prolog/typhon/kernel/program/machine.pl',
        "    Frame = Sub-catch(Sub,Catcher,Recovery),\n"-
        "    Frame = Sub-Sub,\n").
promise(error_of_the_move_is_raised_at_its_source, agent,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "raised_at(Control, Error, Hole-Goals, _, go(Goals)) :-\n\c
         \s   answer_at(Control, throw(Error), Hole)."-
        "raised_at(_, Error, _-Goals, Id-_, stop) :-\n\c
         \s   agent_fails(Id, raised(Error), Goals).").
promise(no_stop_inside_a_native_goal, agent,
        'prolog/typhon/kernel/vocabulary/words.pl',
        "receive(_, _) :-\n\c
         \s   misplaced(receive/2)."-
        "receive(_, _) :-\n\c
         \s   fail.").
promise(rules_are_those_of_the_call, [machine, program],
        'prolog/typhon/kernel/program/machine.pl',
        "    ;   state_rule(Agent, Goal)\n\c
         \s   ->  prolog_current_choice(Barrier),\n"-
        "    ;   fail,\n\c
         \s       state_rule(Agent, Goal)\n\c
         \s   ->  prolog_current_choice(Barrier),\n").
promise(constraint_does_not_survive_a_stop, agent,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "    parts_call(acts, Here, [Id, clone]),\n\c
         \s   can_be_kept(Goals),\n"-
        "    parts_call(acts, Here, [Id, clone]),\n").
promise(move_to_its_own_host_is_no_hop, agent,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "    (   Dest == local(Here)\n\c
         \s   ->  Hole = true,\n"-
        "    (   fail\n\c
         \s   ->  Hole = true,\n").
promise(full_host_refuses, agent,
        'prolog/typhon/kernel/host/hosts.pl',
        "    Count < Capacity,\n\c
         \s   Count1 is Count+1,\n\c
         \s   set_flag(Load, Count1),"-
        "    Count < Capacity+1,\n\c
         \s   Count1 is Count+1,\n\c
         \s   set_flag(Load, Count1),").
promise(token_is_required, agent,
        'prolog/typhon/kernel/host/hosts.pl',
        "        admits(Name, [], Capacity, Load),\n"-
        "        admits(Name, _, Capacity, Load),\n").
promise(unknown_host_is_a_refusal, agent,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "          error(existence_error(host, _), _),\n\c
         \s         throw(error(move_refused(Host, unknown_host), _)))."-
        "          error(existence_error(endpoint, _), _),\n\c
         \s         throw(error(move_refused(Host, unknown_host), _))).").
promise(unreachable_host_is_an_error, agent,
        'prolog/typhon/kernel/travel/transfer.pl',
        "    transfer_stays(Transfer, host_unreachable(Address))."-
        "    transfer_stays(Transfer, connection_lost(Address)).").
promise(goals_must_be_mobile, agent,
        'prolog/typhon/kernel/travel/within.pl',
        "    agent_state_mobile(Module, Until0, Until),\n\c
         \s   mobile_term(Life-Goals),\n"-
        "    agent_state_mobile(Module, Until0, Until),\n").
promise(changed_state_must_be_mobile, agent,
        'prolog/typhon/kernel/agent/agent_module.pl',
        "        Last > Since,                   % tested first: few changed\n"-
        "        Since =:= 0,\n").
promise(static_agent_stays, agent,
        'prolog/typhon/kernel/agent/life.pl',
        "life_goes(life(Parent, Hops0, Most, Tokens, Payloads, false, []),"-
        "life_goes(life(Parent, Hops0, Most, Tokens, Payloads, _, []),").
promise(lifetime_ends_at_the_move, agent,
        'prolog/typhon/kernel/agent/life.pl',
        "        Hops0 < Most\n\c
         \s   ),\n\c
         \s   Hops is"-
        "        Hops0 =< Most\n\c
         \s   ),\n\c
         \s   Hops is").
promise(clone_has_the_tokens, agent,
        'prolog/typhon/kernel/agent/life.pl',
        "life_clone(Id, life(_, _, Most, Tokens, Payloads, Static, Extras0),\n\c
         \s          life(Id, 0, Most, Tokens, Payloads, Static, Extras)) :-"-
        "life_clone(Id, life(_, _, Most, _, Payloads, Static, Extras0),\n\c
         \s          life(Id, 0, Most, [], Payloads, Static, Extras)) :-").
promise(clone_is_at_home_here, agent,
        'prolog/typhon/kernel/lifecycle/beginning.pl',
        "clone_id(Id, CloneId) :-\n\c
         \s   agent(Id, Host, _, _, _),\n\c
         \s   host(Host, Address, _),\n"-
        "clone_id(Id, CloneId) :-\n\c
         \s   agent_home(Id, Address),\n").
promise(full_host_refuses_a_clone, agent,
        'prolog/typhon/kernel/host/hosts.pl',
        "    (   Load < Capacity\n\c
         \s   ->  Load1 is Load+1,"-
        "    (   Load =< Capacity\n\c
         \s   ->  Load1 is Load+1,").
promise(order_at_the_next_control_predicate, agent,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "    (   agent_ordered(Id),\n\c
         \s       term_attvars(Goals, [])"-
        "    (   Control = sleep(_),\n\c
         \s       agent_ordered(Id),\n\c
         \s       term_attvars(Goals, [])").
promise(order_wakes_a_waiting_agent, agent,
        'prolog/typhon/kernel/lifecycle/orders.pl',
        "idle(waiting(_, _)).\n"-
        "").
promise(sleep_continues_after_an_order, agent,
        'prolog/typhon/kernel/lifecycle/effect.pl',
        "    ;   Hole = sleep_until(Until),\n\c
         \s       wait("-
        "    ;   Hole = true,\n\c
         \s       wait(").
promise(failed_order_is_reported, agent,
        'prolog/typhon/kernel/travel/transfer.pl',
        "report(warning, failed_orders, Id, typhon(order_failed(Id, Formal)))"-
        "true").
promise(move_can_be_awaited, moves,
        'prolog/typhon/kernel/lifecycle/orders.pl',
        "    move_awaited(Id, Asker),\n\c
         \s   obey(move(Host), Id, Goals)."-
        "    obey(move(Host), Id, Goals),\n\c
         \s   answered(Asker, answer(arrived)).").
promise(disposal_reports_what_runs_on, disposal,
        'prolog/typhon/kernel/lifecycle/disposal.pl',
        "    ;   print_message(warning, typhon(runs_on(Agent, Seconds)))\n"-
        "    ;   true\n").
promise(forced_agent_has_ended, disposal,
        'prolog/typhon/kernel/lifecycle/disposal.pl',
        "                  ; force(Agent, Deadline)\n\c
         \s                 ))."-
        "                  ; Deadline = Deadline,\n\c
         \s                   ignore(agent_asked(Agent, force, 10, _))\n\c
         \s                 )).").
promise(name_has_no_hidden_characters, agent,
        'prolog/typhon/kernel/base/names.pl',
        "        is_printable(Name)\n\c
         \s   ->"-
        "        atom(Name)\n\c
         \s   ->").
promise(ambiguous_name_is_an_error, named,
        'prolog/typhon/kernel/lifecycle/questions.pl',
        "the_only([Id], _, Id) :-"-
        "the_only([Id|_], _, Id) :-").
promise(ended_agent_takes_no_orders, named,
        'prolog/typhon/kernel/lifecycle/questions.pl',
        "    (   Ended == true\n\c
         \s   ->  has_ended(Id)"-
        "    (   Ended == ended\n\c
         \s   ->  has_ended(Id)").
promise(refused_agent_keeps_its_mail, hand_over,
        'prolog/typhon/kernel/travel/transfer.pl',
        "    mail_back(Id, Mail),\n\c
         \s   (   Hole == ordered"-
        "    Mail = Mail,\n\c
         \s   (   Hole == ordered").
promise(agent_sent_by_request_keeps_its_mail, hand_over,
        'prolog/typhon/kernel/travel/hand_over.pl',
        "    ;   with_agent(Id, mail_returned(Id, Mail)),\n\c
         \s       fail\n"-
        "    ;   fail\n").
promise(older_messages_come_first, mailbox,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    append(Older, Newer, Messages),\n"-
        "    append(Newer, Older, Messages),\n").
promise(message_to_no_agent_is_an_error, message,
        'prolog/typhon/kernel/travel/post.pl',
        "go(nowhere, Id) :-\n\c
         \s   existence_error(agent, Id)."-
        "go(nowhere, _).").
promise(lost_message_of_an_agent_is_reported, message,
        'prolog/typhon/kernel/vocabulary/words.pl',
        "    ( Formal = existence_error(agent, Agent)\n\c
         \s   ; Formal"-
        "    ( Formal = existence_error(agent, Agent),\n\c
         \s     Id == Agent\n\c
         \s   ; Formal").
promise(message_to_no_process_is_an_error, message,
        'prolog/typhon/kernel/travel/routing.pl',
        "    ;   throw(error(host_unreachable(Failed), _))\n"-
        "    ;   true\n").
promise(dead_letter_is_reported, message,
        'prolog/typhon/kernel/travel/backlog.pl',
        "    mail_lost(Formal, Id, Mail),\n\c
         \s   conclude(done, Id, _, 0)."-
        "    Mail = Mail,\n\c
         \s   conclude(done, Id, _, 0).").
promise(mail_of_ended_agents_is_dropped, message,
        'prolog/typhon/kernel/travel/routing.pl',
        "    (   ( Sent == [] ; agent_outcome(Id, _) )\n"-
        "    (   Sent == []\n").
promise(mailbox_is_bounded, full_mailbox,
        'prolog/typhon/kernel/travel/post.pl',
        "post_way(Id, From, _, _) :-\n\c
         \s   mail_full(Id, From),\n\c
         \s   resource_error(mailbox).\n"-
        "").
promise(agent_that_sends_to_a_full_mailbox_goes_on, full_mailbox,
        'prolog/typhon/kernel/vocabulary/words.pl',
        "    ; Formal = resource_error(mailbox)\n"-
        "    ; Formal = resource_error(none)\n").
promise(mail_from_elsewhere_fits, full_mailbox,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "        Space is max(0, Max-Count),\n"-
        "        Space is Max,\n").
promise(lost_mail_from_elsewhere_is_reported, full_mailbox,
        'prolog/typhon/kernel/travel/routing.pl',
        "mail_lost(resource_error(mailbox), Id, Rest) )."-
        "true ).").
promise(platform_messages_fit, full_mailbox,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    ( Space > 0 ; Mail = mail(_, system, _) ),\n"-
        "    Space > 0,\n").
promise(hop_is_taken_once, arrival,
        'prolog/typhon/kernel/travel/arrival.pl',
        "        Hops0 >= Hops\n\c
         \s   ;   gone_on"-
        "        Hops0 > Hops\n\c
         \s   ;   gone_on").
promise(hop_is_taken_once_after_the_end, arrival,
        'prolog/typhon/kernel/travel/arrival.pl',
        "    ;   agent_heard_of(Id, Hops0),\n\c
         \s       Hops0 >= Hops\n"-
        "    ;   agent_heard_of(Id, Hops0),\n\c
         \s       Hops0 > Hops\n").
promise(hop_is_taken_once_on_the_short_path, arrival,
        'prolog/typhon/kernel/travel/whereabouts.pl',
        "    home_knows(Id, _, Hops0, _),\n\c
         \s   !,\n\c
         \s   Hops0 < Hops,\n"-
        "    home_knows(Id, _, Hops0, _),\n\c
         \s   !,\n\c
         \s   integer(Hops0),\n").
promise(ended_agent_does_not_come_again, arrival,
        'prolog/typhon/kernel/travel/whereabouts.pl',
        "         Hops0 >= Hops ).\n\c
         \n\c
         %!  whereabouts"-
        "         Hops0 > Hops ).\n\c
         \n\c
         %!  whereabouts").
promise(global_variables_survive_stops, thread_state,
        'prolog/typhon/kernel/program/thread_state.pl',
        "             ( is_storable(Fact) ->"-
        "             ( \\+ is_storable(Fact) ->").
promise(thread_is_restored, thread_state,
        'prolog/typhon/kernel/program/thread_state.pl',
        "noted(set_prolog_stack(Stack, Property), stack(Stack, Name)) :-\n\c
         \s   ("-
        "noted(none(Stack, Property), stack(Stack, Name)) :-\n\c
         \s   (").
promise(process_predicates_raise, thread_state,
        'prolog/typhon/kernel/program/thread_state.pl',
        "refused_now(thread_detach(Thread), 'the platform joins this thread') :-\n\c
         \s   thread_self(Thread).\n"-
        "").
promise(abort_ends_the_agent, thread_state,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "    ;   Outcome = disposed\n\c
         \s   )."-
        "    ;   Outcome = done\n\c
         \s   ).").
promise(abort_is_reported, thread_state,
        'prolog/typhon/kernel/lifecycle/turn.pl',
        "    ;   report(warning, agents_aborted, Id, typhon(aborted(Id)))\n"-
        "    ;   true\n").
promise(unknown_options_are_errors, [host, agent],
        'prolog/typhon/kernel/base/options.pl',
        "    ;   wrong_option(Domain, Option)\n"-
        "    ;   Domain \\== host_option\n\c
         \s   ->  wrong_option(Domain, Option)\n\c
         \s   ;   true\n").
promise(remote_can_be_refused, remote,
        'prolog/typhon/kernel/host/remote.pl',
        "    (   host_option(Name, remote(false))\n\c
         \s   ->"-
        "    (   host_option(Name, remote(none))\n\c
         \s   ->").
promise(unknown_host_is_an_error, remote,
        'prolog/typhon/kernel/host/remote.pl',
        "conclude(unknown_host, Host, _) :-\n\c
         \s   host_unknown(Host)."-
        "conclude(unknown_host, _, _) :-\n\c
         \s   fail.").
promise(state_travels, rules,
        'prolog/typhon/kernel/agent/agent_module.pl',
        "    (   clause(Module:Head, Body)\n\c
         \s   *-> ("-
        "    (   clause(Module:Head, Body)\n\c
         \s   ->  (").
promise(predicate_without_clauses_travels, rules,
        'prolog/typhon/kernel/agent/agent_module.pl',
        "    ;   functor(Head, Name, Arity),\n\c
         \s       Item = (:- dynamic(Name/Arity))\n"-
        "    ;   fail\n").
promise(payload_redefines_nothing, agent,
        'prolog/typhon/kernel/agent/payloads.pl',
        "    maplist(free(Module, Program), PIs),\n"-
        "    atom(Program),\n").
promise(newest_news_counts, news,
        'prolog/typhon/kernel/travel/news.pl',
        "    \\+ newer(News, Known),\n\c
         \s   !."-
        "    \\+ newer(News, Known),\n\c
         \s   news_lasts(News),\n\c
         \s   !.").
