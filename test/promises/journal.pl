%   What doc/journal.md promises, see ../promises.pl.

promise(first_host_opens_the_journal, journal,
        'prolog/typhon/options/journal/recovery.pl',
        "    guests_leave,\n    endpoint_address(_),\n    !,\n    not_here"-
        "    guests_leave,\n    fail,\n    not_here").
promise(hosts_are_restored, restored,
        'prolog/typhon/options/journal/recovery.pl',
        "    restore_all(Others),\n"-"    restore_all([]),\n").
promise(links_are_restored, restored,
        'prolog/typhon/kernel/host/links.pl',
        "    durable_put(link, Key, 0, link(Name, Address, Now))."-
        "    true.").
promise(agents_are_restored, restored,
        'prolog/typhon/options/journal/journaled_agents.pl',
        "agent(Host, Hash, Life, State, Status, Goals), _)."-
        "agent(Host, Hash, Life, State, resident, Goals), _).").
promise(mailboxes_are_restored, restored,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    durable_number(N),\n    durable_put(mail, Id, N, Message),"-
        "    durable_number(N),").
promise(taken_messages_are_not_restored, journal,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    ->  durable_drop(mail, Id, N)\n"-"    ->  true\n").
promise(tuple_spaces_are_restored, restored,
        'prolog/typhon/options/journal/journaled_tuples.pl',
        "    deferred_put(tuple, Host, N, Noted),\n    (   effects"-
        "    (   effects").
promise(taken_facts_are_not_restored, restored,
        'prolog/typhon/options/journal/journaled_tuples.pl',
        "        deferred_drop(tuple, Host, N)\n"-"        true\n").
promise(payloads_are_restored, restored,
        'prolog/typhon/kernel/host/place.pl',
        "    ->  durable_put(payload, Key, 0, payload(Host, payload(Name, PIs, Clauses)))\n\c
         "-
        "    ->  true\n").
promise(programs_are_restored, restored,
        'prolog/typhon/options/journal/journaled_agents.pl',
        "               ;   changes_put_at_once(code, Hash, 0, Sent),\n                   \c
         assertz"-
        "               ;   assertz").
promise(outcomes_are_restored, restored,
        'prolog/typhon/kernel/travel/home.pl',
        "            durable_assertz(outcome(Id, Outcome, Hops))),"-
        "            assertz(outcome(Id, Outcome, Hops))),").
promise(results_are_restored, restored,
        'prolog/typhon/kernel/travel/outcomes.pl',
        "                   durable_assertz(left(Id, Item))))."-
        "                   assertz(left(Id, Item)))).").
promise(port_is_restored, restored,
        'prolog/typhon/kernel/wire/endpoint.pl',
        "        ( Port0 =:= 0 -> Port = Port1 ; Port = Port0 ),"-
        "        Port1 = _, Port = Port0,").
promise(agents_continue, journal,
        'prolog/typhon/options/journal/recovery.pl',
        "    forall(member(Id, All), agent_reschedule(Id))."-
        "    forall(member(_, All), true).").
promise(restored_host_may_be_started_once, journal,
        'prolog/typhon/options/journal/recovery.pl',
        "    (   retract(restored(Name))\n"-"    (   restored(Name)\n").
promise(sync_full_survives_a_power_failure, store,
        'prolog/typhon/options/journal/database.pl',
        "    pragma(Connection, synchronous, Sync),\n"-"").
promise(last_host_rests, restored,
        'prolog/typhon/kernel/host/hosting.pl',
        "    stop_steps([ close_last(Name),\n                 \c
         host_close(Name),\n                 each(closes(Name)),\n                 \c
         evacuate(Name),"-
        "    stop_steps([ host_close(Name),\n                 \c
         each(closes(Name)),\n                 evacuate(Name),\n                 \c
         close_last(Name),").
promise(host_beside_others_ends, restored,
        'prolog/typhon/kernel/host/hosts.pl',
        "    durable_drop(host, Name, 0),\n"-"").
promise(later_changes_are_dropped, stop,
        'prolog/typhon/options/journal/committing.pl',
        "    with_mutex(typhon_entries, retract(queue(Entries, _, _))),"-
        "    queue(Entries, _, _),").
promise(last_commit_is_made, restored,
        'prolog/typhon/options/journal/committing.pl',
        "    catch(commit_all(Entries), error(Formal, Context),\n          \c
         ( print_message(error, error(Formal, Context)),\n            \c
         assertz(reported(error(Formal, Context))) )),\n    \c
         retractall(unsaved"-
        "    retractall(unsaved").
promise(stop_goes_on_after_an_error, stop,
        'prolog/typhon/kernel/base/own_thread.pl',
        "    catch(forall(Module:Goal, true), error(Formal, Context),\n          \c
         print_error(error, error(Formal, Context)))."-
        "    forall(Module:Goal, true).").
promise(step_is_committed_as_a_whole, journal,
        'prolog/typhon/options/journal/units_of_work.pl',
        "    (   durable_on\n    \c
         ->  setup_call_cleanup(nb_setval(typhon_deferred, true),\n                           \c
         once(Goal),"-
        "    (   durable_on\n    \c
         ->  setup_call_cleanup(nb_setval(typhon_deferred, false),\n                           \c
         once(Goal),").
promise(effects_and_next_goals_are_one_entry, restored,
        'prolog/typhon/options/journal/journaled_agents.pl',
        "        agent_note(Id, ready, Goals),\n        enqueue_changes,"-
        "        enqueue_changes,\n        agent_note(Id, ready, Goals),").
promise(interrupted_step_is_repeated, restored,
        'prolog/typhon/options/journal/units_of_work.pl',
        "    forall(retract(deferred(Change)), changes_add(Change))."-
        "    true.").
promise(left_facts_are_visible_to_others_later, restored,
        'prolog/typhon/options/journal/journaled_tuples.pl',
        "        deferred_call(typhon_journaled_tuples:leave_due(Place, N))\n\c
         "-
        "        leave_due(Place, N)\n").
promise(own_facts_are_visible_at_once, restored,
        'prolog/typhon/kernel/host/tuples.pl',
        "    effects_deferred,\n    due(Place, Fact, mine)."-
        "    fail,\n    due(Place, Fact, mine).").
promise(log_events_arrive_once, journal,
        'prolog/typhon/options/journal/units_of_work.pl',
        "    unit_of_work(( durable_drop(Kind, Key, N),\n                   \c
         ignore("-
        "    unit_of_work(( true,\n                   ignore(").
promise(changes_of_a_large_state_are_logged, state_log,
        'prolog/typhon/options/journal/state_log.pl',
        "    assertz(Log:added(Ref, Name, Arity, first))."-
        "    assertz(Log:added(Ref, Name, Arity, last)).").
promise(failed_change_of_a_large_state_is_kept, journal,
        'prolog/typhon/options/journal/journaled_agents.pl',
        "    forall(member(put(state, Id, _, _), Changes),\n           \c
         put_logged(Id, none, 0, 0, 0))."-
        "    forall(member(put(none, Id, _, _), Changes),\n           \c
         put_logged(Id, none, 0, 0, 0)).").
promise(frame_follows_the_commit, restored,
        'prolog/typhon/options/journal/committing.pl',
        "    save(Changes2, Items),\n    (   Items == []\n    ->  true\n    \c
         ;   release(Items)\n    )."-
        "    (   Items == []\n    ->  true\n    ;   release(Items)\n    \c
         ),\n    save(Changes2, Items).").
promise(frames_wait_while_commits_fail, restored,
        'prolog/typhon/options/journal/committing.pl',
        "          ( assertz(unsaved(Changes, Items)),\n"-
        "          ( assertz(unsaved(Changes, [])),\n").
promise(changes_wait_while_commits_fail, restored,
        'prolog/typhon/options/journal/committing.pl',
        "          ( assertz(unsaved(Changes, Items)),\n            throw"-
        "          ( assertz(unsaved([], Items)),\n            throw").
promise(arrival_is_committed_before_the_answer, restored,
        'prolog/typhon/kernel/wire/outbox.pl',
        "    (   durable_on\n    \c
         ->  send_committed(Session, Bytes, none, later)\n    \c
         ;   session_locked(Session, put_frame(Session, Bytes, none, buffer))\n    \c
         )."-
        "    session_locked(Session, put_frame(Session, Bytes, none, buffer)).").
promise(accepted_hops_are_recognised_by_number, arrival,
        'prolog/typhon/kernel/travel/arrival.pl',
        "    HopId = hop_id(Process, N, _),\n    accepted(Process, N),\n    \c
         !."-
        "    fail.").
promise(process_keeps_its_id, restored,
        'prolog/typhon/kernel/wire/endpoint.pl',
        "        atom_concat(j, New, Process),\n"-"        Process = New,\n").
promise(posts_are_kept_until_acknowledged, channel,
        'prolog/typhon/options/journal/channel.pl',
        "          changes_add(Change),\n          enqueue_changes,\n          \c
         assertz(out"-
        "          assertz(out").
promise(posts_are_sent_again, channel,
        'prolog/typhon/options/journal/channel.pl',
        "    ;   send_again(Endpoint)\n    )."-"    ;   true\n    ).").
promise(no_post_is_accepted_twice, channel,
        'prolog/typhon/options/journal/channel.pl',
        "    N =< Seen,\n"-"    N < Seen,\n").
promise(no_post_is_skipped, channel,
        'prolog/typhon/options/journal/channel.pl',
        "in_order(Before, Key) :-\n    seen(Key, Before)."-
        "in_order(Before, Key) :-\n    seen(Key, Seen),\n    \c
         Seen =< Before.").
promise(agent_send_waits_for_the_commit, stop,
        'prolog/typhon/kernel/base/durable_changes.pl',
        "    once(Goal),\n    (   durable_on\n    ->  sync\n"-
        "    once(Goal),\n    (   durable_on\n    ->  true\n").
promise(running_process_locks_its_journal, store,
        'prolog/typhon/options/journal/database.pl',
        "    pragma(Connection, locking_mode, exclusive),\n    \c
         pragma(Connection, journal_mode, wal),"-
        "    pragma(Connection, journal_mode, wal),").
promise(damaged_term_is_detected, store,
        'prolog/typhon/options/journal/store.pl',
        "    (   check_sum(Bytes, Sum)\n"-"    (   check_sum(Bytes, _)\n").
promise(damaged_database_is_not_touched, store,
        'prolog/typhon/options/journal/store.pl',
        "    (   database_wrong(Base, Connection, Why)\n"-
        "    (   fail, database_wrong(Base, Connection, Why)\n").
promise(journal_of_another_version_is_refused, store,
        'prolog/typhon/options/journal/store.pl',
        "    (   Version0 == Version,\n        Sample0"-"    (   Sample0").
promise(full_disk_loses_nothing, store,
        'prolog/typhon/options/journal/database.pl',
        "error_words(sqlite(_), ['is full'], full)."-
        "error_words(sqlite(_), ['is full'], unwritten).").
promise(nothing_is_committed_after_a_failed_sync, store,
        'prolog/typhon/options/journal/store.pl',
        "    (   Error = error(journal_unwritten(_, _), _)\n    \c
         ->  assertz(broken(Error))\n"-
        "    (   Error = error(journal_unwritten(_, _), _)\n    ->  true\n").
promise(keys_are_bounded, store,
        'prolog/typhon/options/journal/units_of_work.pl',
        "    Length =< 500,"-"    Length =< 5000,").
promise(changes_are_committed_in_order, restored,
        'prolog/typhon/options/journal/committing.pl',
        "    reverse(Changes0, Newest),"-"    Newest = Changes0,").
promise(unit_of_work_is_one_transaction, store,
        'prolog/typhon/options/journal/store.pl',
        "    sql_execute(begin, []),\n    \c
         forall(member(Change, Changes), change(Change)),\n    \c
         crash_point(in_commit),\n    sql_execute(commit, [])."-
        "    forall(member(Change, Changes), change(Change)),\n    \c
         crash_point(in_commit).").
promise(failed_unit_leaves_nothing, restored,
        'prolog/typhon/options/journal/units_of_work.pl',
        "                           ( nb_setval(typhon_durable_unit, false),\n                             \c
         drop_pending ))"-
        "                           ( enqueue,\n                             \c
         nb_setval(typhon_durable_unit, false) ))").
promise(idle_changes_are_committed_soon, restored,
        'prolog/typhon/options/journal/committing.pl',
        "    with_mutex(typhon_entries, put_entry(Entry)),\n    wake(idle)."-
        "    with_mutex(typhon_entries, put_entry(Entry)).").
promise(sync_waits_for_the_commit, restored,
        'prolog/typhon/options/journal/units_of_work.pl',
        "typhon_durable_changes:sync :-\n    enqueue,\n    commit_queue,"-
        "typhon_durable_changes:sync :-\n    enqueue,").
promise(change_that_came_too_late_is_reported, stop,
        'prolog/typhon/options/journal/committing.pl',
        "        nb_setval(typhon_changes_dropped, Start)\n"-
        "        nb_setval(typhon_changes_dropped, -Start)\n").
promise(numbers_grow, restored,
        'prolog/typhon/options/journal/units_of_work.pl',
        "    (   N mod 10000 =:= 0\n    ->  number_bound(N)\n    ;   true\n    \c
         )."-
        "    true.").
