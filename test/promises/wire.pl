%   What doc/wire.md promises, see ../promises.pl.

promise(handshake_line_is_bounded, auth,
        'prolog/typhon/kernel/wire/transport.pl',
        "    ;   Space > 0\n    ->  Codes"-"    ;   true\n    ->  Codes").
promise(handshake_time_is_bounded, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    Deadline is Now+Seconds,\n    thread_self(Me),"-
        "    Deadline is Now+20*Seconds,\n    thread_self(Me),").
promise(proof_names_the_role, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "[Role, Client, Server]"-"[proof, Client, Server]").
promise(proof_is_for_these_nonces, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    random_hex(16, Nonce),\n"-"    Nonce = '0123456789abcdef',\n").
promise(proof_is_for_these_hellos, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    format(string(Data), \"~w\\n~w\\n~w\", [Role, Client, Server]),"-
        "    split_string(Client, \" \", \"\", [_, _, C|_]),\n    \c
         split_string(Server, \" \", \"\", [_, _, S|_]),\n    \c
         format(string(Data), \"~w\\n~w\\n~w\", [Role, C, S]),").
promise(client_proves_itself, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, client, Theirs, Ours),\n"-
        "    line_read(In, Deadline, _),\n").
promise(server_proves_itself, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, server, Ours, Theirs).\n"-
        "    line_read(In, Deadline, _).\n").
promise(peer_is_not_this_process, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "          check_self(Theirs, Hello),\n"-"").
promise(wrong_proof_is_answered, protocol,
        'prolog/typhon/kernel/wire/connection.pl',
        "          ( line_write(Out, refused),\n            throw("-
        "          ( true,\n            throw(").
promise(other_version_is_answered, unauthenticated_clients,
        'prolog/typhon/kernel/wire/handshake.pl',
        "        line_write(Out, Protocol)\n"-"        true\n").
promise(other_first_byte_ends_the_connection, protocol,
        'prolog/typhon/kernel/wire/transport.pl',
        "client(_, other)."-"client(_, plain).").
promise(smaller_key_counts_first, protocol,
        'prolog/typhon/kernel/wire/connection.pl',
        "    MyKey @< Key,\n"-"    MyKey @> Key,\n").
promise(first_of_two_connections_stays, wire,
        'prolog/typhon/kernel/wire/connection.pl',
        "                     ( must_be_needed(Role, Session),\n                       \c
         session_retire"-
        "                     ( session_retire").
promise(unproved_connections_are_bounded, endpoint,
        'prolog/typhon/kernel/wire/acceptor.pl',
        "    Count < Max.\n"-"    Count < 2*Max.\n").
promise(unknown_address_is_evicted_first, unauthenticated_clients,
        'prolog/typhon/kernel/wire/acceptor.pl',
        "rank(Known, Free, Spoke, Since)"-"rank(Free, Spoke, Since)").
promise(crowded_address_is_evicted_next, unauthenticated_clients,
        'prolog/typhon/kernel/wire/acceptor.pl',
        "    Free is -Count.\n"-"    Free = 0.\n").
promise(silent_client_is_evicted_next, unauthenticated_clients,
        'prolog/typhon/kernel/wire/acceptor.pl',
        "stage_rank(silent, Spoke) =>\n    Spoke = 0."-
        "stage_rank(silent, Spoke) =>\n    Spoke = 1.").
promise(oldest_client_is_evicted_last, unauthenticated_clients,
        'prolog/typhon/kernel/wire/acceptor.pl',
        "    keysort(Ranked, [_-(Thread-Ip)|_])."-
        "    keysort(Ranked, Sorted),\n    last(Sorted, _-(Thread-Ip)).").
promise(cookie_is_ascii, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    must_be_ascii(Line, File),\n"-"").
promise(cookie_file_is_made_private, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    random_hex(32, Cookie),\n"-"    random_hex(8, Cookie),\n").
promise(cookie_file_of_others_is_refused, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    ;   sub_string(Line, 4, 6, _, \"------\")\n"-
        "    ;   sub_string(Line, 4, 6, _, _)\n").
promise(frame_length_is_bounded, protocol,
        'prolog/typhon/kernel/wire/frame.pl',
        "    Length > MaxBytes,\n"-"    Length > 2*MaxBytes,\n").
promise(check_covers_the_counts, frame,
        'prolog/typhon/kernel/wire/frame.pl',
        "(Hash + 7919*(R + R>>19) + 104729*(S + S>>19))"-
        "(Hash + 7919*R + 104729*(S + S>>19))").
promise(damaged_frame_is_not_decoded, protocol,
        'prolog/typhon/kernel/wire/frame.pl',
        "        (   Found =:= Check\n"-"        (   Found >= 0\n").
promise(damaged_frame_is_sent_again, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "    (   Times < 3\n"-"    (   Times < 1\n").
promise(always_damaged_frame_is_skipped, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "    ;   sig_atomic(( session_object(Session, spoilt),\n                     \c
         session_count"-
        "    ;   sig_atomic(( true,\n                     session_count").
promise(text_is_quoted_for_all_versions, frame,
        'prolog/typhon/kernel/base/text.pl',
        "text_options([ quoted(true), ignore_ops(true), fullstop(true),\n               \c
         module(typhon_text_syntax) ])."-
        "text_options([ quoted(true), fullstop(true) ]).").
promise(undecodable_request_is_answered, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "    (   bytes_mark(Bytes, Mark0)\n"-"    (   fail\n").
promise(undecodable_frame_is_objected_to, protocol,
        'prolog/typhon/kernel/wire/request.pl',
        "unreadable(_, Session) :-               % the frame may be a hand-over\n    \c
         session_object(Session, spoilt)."-
        "unreadable(_, _).").
promise(records_need_equal_word_size, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    (   Word1 == Word2,\n        Order1"-"    (   Order1").
promise(records_need_equal_byte_order, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "        Order1 == Order2,\n"-"").
promise(records_need_tested_versions, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "record_format(90000, 90299)."-"record_format(90000, 109999).").
promise(records_can_be_switched_off, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    setting(records, false),\n    !."-
        "    setting(records, none),\n    !.").
promise(unknown_frame_is_skipped, protocol,
        'prolog/typhon/kernel/wire/request.pl',
        "           typhon(endpoint, unknown_frame(Frame))).\n\n"-
        "           typhon(endpoint, unknown_frame(Frame))),\n    \c
         domain_error(frame, Frame).\n\n").
promise(frames_are_handled_once, settlement,
        'prolog/typhon/kernel/wire/unacked.pl',
        "    Gone is max(0, min(Count-Count0, Size)),"-"    Gone = 0,").
promise(frames_keep_their_order, [settlement, endpoint],
        'prolog/typhon/kernel/wire/unacked.pl',
        "    message_queue_property(Waiting, size(0)),\n"-"").
promise(lost_frames_are_sent_again, protocol,
        'prolog/typhon/kernel/wire/unacked.pl',
        "    fifo_empty(Sent, Frames),\n    forall("-
        "    fifo_empty(Sent, _),\n    Frames = [],\n    forall(").
promise(control_is_not_counted, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "handle(ping, Session, In, State) :-\n    !,\n"-
        "handle(ping, Session, In, State) :-\n    !,\n    \c
         session_count(Session, _),\n").
promise(waiting_frame_settles_what_it_did, settlement,
        'prolog/typhon/kernel/wire/unacked.pl',
        "counts(Count, Settled),\n               Bytes) :-"-
        "counts(Count, Count),\n               Bytes) :-").
promise(control_before_waiting_frames_settles_no_more, settlement,
        'prolog/typhon/kernel/wire/unacked.pl',
        "    (   Most == room\n    ->  Settled = Count,"-
        "    (   true\n    ->  Settled = Count,").
promise(counts_are_sent_after_32_frames, protocol,
        'prolog/typhon/kernel/wire/unacked.pl',
        "ack_frames(32)."-"ack_frames(64).").
promise(ping_is_answered, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "handle(ping, Session, In, State) :-\n    !,\n    \c
         acknowledge(Session, In, State)."-
        "handle(ping, _, _, _) :-\n    !.").
promise(settlement_is_sent_soon, protocol,
        'prolog/typhon/kernel/wire/request.pl',
        "verdict(accepted, _, _, _, _) :-\n    !,\n    session_owes."-
        "verdict(accepted, _, _, _, _) :-\n    !.").
promise(count_of_unsent_frames_ends_the_connection, protocol,
        'prolog/typhon/kernel/wire/unacked.pl',
        "    (   Ahead =< Size\n    ->  true\n    \c
         ;   domain_error(acknowledged, Ahead)\n    ),\n    \c
         take_received(Ahead, Count0, Sent, Handed, 0, Bytes),"-
        "    Some is min(Ahead, Size),\n    \c
         take_received(Some, Count0, Sent, Handed, 0, Bytes),").
promise(lower_count_is_ignored, [protocol, frame],
        'prolog/typhon/kernel/wire/frame.pl',
        "    Ahead < 0x80000000."-"    Ahead < 0x100000000.").
promise(resume_settles_nothing, settlement,
        'prolog/typhon/kernel/wire/settlement.pl',
        "    forall(member(N-Token, Handed), assertz(unsettled(Key, N, Token)))."-
        "    Key-Handed = _.").
promise(sender_does_not_block, settlement,
        'prolog/typhon/kernel/wire/unacked.pl',
        "65536-(Written-Acked)"-"1000000-(Written-Acked)").
promise(received_frame_makes_room, settlement,
        'prolog/typhon/kernel/wire/unacked.pl',
        "    Bytes1 is Bytes0+Bytes,\n    set_flag(AckedBytes, Bytes1),\n    \c
         message_queue_property(Queue"-
        "    message_queue_property(Queue").
promise(bundle_is_bounded, frame,
        'prolog/typhon/kernel/wire/frame.pl',
        "most_parts(100)."-"most_parts(1000).").
promise(bundled_posts_are_short, frame,
        'prolog/typhon/kernel/wire/frame.pl',
        "longest_part(512)."-"longest_part(51).").
promise(session_is_resumed_by_the_endpoint, endpoint,
        'prolog/typhon/kernel/wire/connection_manager.pl',
        "    session_unfinished(Session),\n    !,\n    \c
         session_reconnect(Session)."-
        "    session_unfinished(Session),\n    !.").
promise(silent_peer_is_given_up, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "        (   Count < 3\n        ->  session_control"-
        "        (   Count < 1000\n        ->  session_control").
promise(silent_peer_is_pinged, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "        ->  session_control(Session, ping)\n"-"        ->  true\n").
promise(restarted_peer_is_another, endpoint,
        'prolog/typhon/kernel/wire/connection.pl',
        "        atomic_list_concat([P2, S2], '.', Key)\n"-
        "        P1 \\== P2,\n        Key = peer\n").
promise(bye_closes_the_session, protocol,
        'prolog/typhon/kernel/wire/reader.pl',
        "    ignore(manager_notify(gone(Key)))."-
        "    ignore(manager_notify(wanted(Key))).").
promise(resting_sessions_are_bounded, wire,
        'prolog/typhon/kernel/wire/connection_manager.pl',
        "    (   Count > Max,\n        retract(resting"-
        "    (   Count > 10*Max,\n        retract(resting").
promise(no_listener_is_unreachable_at_once, attempts,
        'prolog/typhon/kernel/wire/attempts.pl',
        "    \\+ may_pass(Formal),\n    \\+ soon_there"-
        "    Formal == never,\n    \\+ soon_there").
promise(expected_process_is_awaited, attempts,
        'prolog/typhon/kernel/wire/attempts.pl',
        "soon_there(socket_error(econnrefused, _), Address) :-\n    \c
         peer_expected(Address)."-
        "soon_there(_, 'none:1').").
promise(broken_handshake_is_tried_again, attempts,
        'prolog/typhon/kernel/wire/attempts.pl',
        "may_pass(io_error(_, _)).\nmay_pass(syntax_error(end_of_file)).\n"-
        "").
promise(attempts_are_few, attempts,
        'prolog/typhon/kernel/wire/attempts.pl',
        "    Count >= Many."-"    Count >= 10*Many.").
promise(refused_address_is_gone, endpoint,
        'prolog/typhon/kernel/wire/connection.pl',
        "    ->  peer_gone(Address)\n"-"    ->  true\n").
promise(failed_request_is_answered, protocol,
        'prolog/typhon/kernel/wire/request.pl',
        "    ->  true\n    ;   spoil(ReplyTo, Kind)\n    ).\n\npost_in"-
        "    ->  true\n    ;   true\n    ).\n\npost_in").
promise(refused_hand_over_is_objected_to, protocol,
        'prolog/typhon/kernel/wire/outbox.pl',
        "    Number is Count+1,\n"-"    Number is Count+2,\n").
promise(deferred_frame_is_answered, protocol,
        'prolog/typhon/kernel/wire/request.pl',
        "    Id is -(Count+1),"-"    Id is -Count,").
promise(request_to_a_gone_peer_is_lost, endpoint,
        'prolog/typhon/kernel/wire/request.pl',
        "    forall(open_request(Id, Key, _), conclude(lost, Id, Key)),"-
        "    forall(open_request(Id, Key, _), conclude(unreachable, Id, Key)),").
promise(hand_over_has_one_result, settlement,
        'prolog/typhon/kernel/wire/settlement.pl',
        "            ;   member(Token, Unsent),\n                \c
         Result = unsent"-
        "            ;   member(Token, Unsent),\n                \c
         Result = lost").
promise(undeclared_term_is_refused, [kinds, protocol],
        'prolog/typhon/kernel/wire/kinds.pl',
        "        Verdict = undeclared\n"-"        Verdict = ok\n").
promise(right_is_needed, arrivals,
        'prolog/typhon/kernel/wire/kinds.pl',
        "        ;   Verdict = refused(Right)\n"-"        ;   Verdict = ok\n").
promise(refused_terms_are_audited, arrivals,
        'prolog/typhon/kernel/wire/kinds.pl',
        "    ;   ignore(peer_permitted(undeclared(Kind), all, Term, Peer)),\n\c
         "-
        "    ;   true,\n").
promise(types_of_arguments_are_checked, kinds,
        'prolog/typhon/kernel/wire/kinds.pl',
        "tests(Type, Term, [is_a(Type, Term)]) :-\n    type(Type),\n    !."-
        "tests(Type, _, []) :-\n    type(Type),\n    !.").
promise(name_is_bounded, kinds,
        'prolog/typhon/kernel/wire/kinds.pl',
        "    Length =< 65 536."-"    Length =< 655 360.").
promise(known_hop_has_no_effect_when_the_agent_is_there, arrival,
        'prolog/typhon/kernel/travel/arrival.pl',
        "    (   agent(Id, _, _, _, Life)\n    \c
         ->  life_hops(Life, Hops0),\n        Hops0 >= Hops\n    \c
         ;   gone_on(Id, Hops)\n    ).\n\ngone_on"-
        "    gone_on(Id, Hops).\n\ngone_on").
promise(known_hop_has_no_effect_when_the_agent_has_ended, arrival,
        'prolog/typhon/kernel/travel/arrival.pl',
        "    (   agent_outcome(Id, _)\n    ->  true\n    ;   agent_heard_of"-
        "    (   agent_heard_of").
promise(refused_hop_raises_at_the_move, hand_over,
        'prolog/typhon/kernel/travel/hand_over.pl',
        "    settled(Result, Transfer).\n\nsettled(accepted"-
        "    settled(Result, Transfer).\n\nsettled(refused(_), _) :-\n    \c
         !.\nsettled(accepted").
promise(mail_follows_the_agent, hand_over,
        'prolog/typhon/kernel/travel/hand_over.pl',
        "    agent_gone(Id, Hops, Mail),\n    post_on(Id, Mail)."-
        "    agent_gone(Id, Hops, _).").
promise(lost_hop_asks_all_processes, faults,
        'prolog/typhon/kernel/travel/in_doubt.pl',
        "    (   memberchk(true, All)\n    ->  transfer_arrived(Transfer)\n    \c
         ;   HomeAnswer"-
        "    (   HomeAnswer").
promise(newest_news_of_an_agent_counts, news,
        'prolog/typhon/kernel/travel/news.pl',
        "    \\+ newer(News, Known),\n    !."-"    News == Known,\n    !.").
promise(news_share_a_frame, news,
        'prolog/typhon/kernel/travel/news.pl',
        "when_due(_, Home, soon) :-\n    assertz(pauses(Home))."-
        "when_due(_, _, now).").
promise(image_is_checked_before_anything_changes, arrival,
        'prolog/typhon/kernel/agent/image.pl',
        "    is_list(Mail),\n    \c
         forall(member(Message, Mail), subsumes_term(_-_, Message))."-
        "    is_list(Mail).").
promise(program_is_sent_with_its_hash, arrival,
        'prolog/typhon/kernel/program/code.pl',
        "        maplist(is_import, Libraries),\n        \c
         program_hash(Program, Hash)\n"-
        "        maplist(is_import, Libraries)\n").
