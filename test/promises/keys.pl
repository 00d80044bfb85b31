%   What doc/keys.md promises, see ../promises.pl.

promise(private_keys_stay_private, certificates,
        'app/typhon/keys.pl',
        "    chmod(Own, 0o700),\n\c
         \s   own(Name, 'key.pem', Key),"-
        "    own(Name, 'key.pem', Key),").
promise(directory_has_four_files, certificates,
        'app/typhon/keys.pl',
        "    directory_file_path(Directory, Request, RequestFile),\n\c
         \s   delete_file(RequestFile),\n"-
        "").
promise(revocation_is_written_to_directories, certificates,
        'app/typhon/keys.pl',
        "    forall(( directory_member_with_keys(Directory, Own) ),\n\c
         \s          replace_file(Directory, 'crl.pem', Own))."-
        "    ignore(( directory_member_with_keys(Directory, Own),\n\c
         \s            replace_file(Directory, 'crl.pem', Own) )).").
promise(revocations_are_read_again, certificates,
        'prolog/typhon/options/keys.pl',
        "    (   loaded(File, Stamp, Loaded0)\n"-
        "    (   loaded(File, _, Loaded0)\n").
promise(key_is_not_made_again, certificates,
        'app/typhon/keys.pl',
        "    (   exists_directory(Own)\n\c
         \s   ->  permission_error(create, key, Name)\n\c
         \s   ;   make_directory(Own)\n\c
         \s   ),"-
        "    make_directory_path(Own),").
promise(only_tls_1_3, secure,
        'prolog/typhon/options/tls/secure.pl',
        "                  min_protocol_version(tlsv1_3),\n"-
        "").
promise(session_of_another_is_refused, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    ->  permission_error(authenticate, peer, other)\n"-
        "    ->  Theirs \\== Hello\n").
promise(replayed_proof_is_refused, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    random_hex(16, Nonce),\n\c
         \s   hello_line"-
        "    Nonce = '000102030405060708090a0b0c0d0e0f',\n\c
         \s   hello_line").
promise(only_the_owner_creates_its_agents, births,
        'prolog/typhon/options/identity/birth.pl',
        "        agent_owned(Id, Owner),\n\c
         \s       at_home(Id),\n"-
        "        atom(Owner),\n\c
         \s       at_home(Id),\n").
promise(id_belongs_to_one_program, births,
        'prolog/typhon/options/identity/birth.pl',
        "    known(Id, birth(_, Hash, _, _)).\n\c
         proved"-
        "    known(Id, _),\n\c
         \s   atom(Hash).\n\c
         proved").
promise(program_changes_with_the_keys_of_the_owner, owners,
        'prolog/typhon/options/identity/birth.pl',
        "    (   agent_owned(Id)\n\c
         \s   ->  true\n\c
         \s   ;   permission_error(change, agent_program, Id)\n\c
         \s   )."-
        "    (   atom(Id)\n\c
         \s   ->  true\n\c
         \s   ;   permission_error(change, agent_program, Id)\n\c
         \s   ).").
promise(agent_without_birth_is_refused, owners,
        'prolog/typhon/options/identity/birth.pl',
        "    \\+ proved(Papers, Proof, Id, Hash),\n"-
        "    \\+ proved(Papers, Proof, Id, Hash),\n\c
         \s   \\+ known(Id, _),\n").
promise(senders_are_authenticated, births,
        'prolog/typhon/options/identity/sender_rights.pl',
        "    atom(Id),\n\c
         \s   agent_owned(Id, Name)."-
        "    atom(Id),\n\c
         \s   atom(Name).").
promise(forged_messages_are_not_delivered, owners,
        'prolog/typhon/options/identity/sender_rights.pl',
        "        partition(is_from(Good), Mail, Accepted, Forged),"-
        "        partition(is_from(Good), Mail, _, Forged),\n\c
         \s       Accepted = Mail,").
promise(forged_news_is_ignored, owners,
        'prolog/typhon/kernel/travel/whereabouts.pl',
        "    peer_may_send_for(Peer, Births, Id)."-
        "    ( peer_may_send_for(Peer, Births, Id) -> true ; atom(Id) ).").
promise(revoked_signatures_are_invalid, certificates,
        'prolog/typhon/options/keys.pl',
        "    of_authority(Authority, Certificate),\n\c
         \s   \\+ revoked(List, Certificate),\n"-
        "    of_authority(Authority, Certificate),\n\c
         \s   is_list(List),\n").
promise(expired_certificates_are_invalid, certificates,
        'prolog/typhon/options/keys.pl',
        "    From =< Now,\n\c
         \s   Now =< To."-
        "    From =< Now,\n\c
         \s   From =< To.").
promise(foreign_certificates_are_invalid, certificates,
        'prolog/typhon/options/keys.pl',
        "    pem_certificate(Pem, Certificate),\n\c
         \s   of_authority(Authority, Certificate),\n"-
        "    pem_certificate(Pem, Certificate),\n\c
         \s   nonvar(Authority),\n").
promise(signature_is_of_the_text, certificates,
        'prolog/typhon/options/keys.pl',
        "    atom_concat('3031300d060960864801650304020105000420',\c
         \sDigest, Expected),\n\c
         \s   atom_string(Expected, PlainText),\n\c
         \s   string_lower(PlainHex, PlainText)."-
        "    string_lower(PlainHex, PlainText),\n\c
         \s   atom_string(_, PlainText),\n\c
         \s   string_length(Digest, 64).").
promise(only_authors_sign_programs, authors,
        'prolog/typhon/options/identity/signatures.pl',
        "    keys_verify(Keys, Text, Signature, author(Author))."-
        "    keys_verify(Keys, Text, Signature, Holder),\n\c
         \s   arg(1, Holder, Author).").
promise(only_named_authors_are_admitted, authors,
        'prolog/typhon/options/identity/authors.pl',
        "    program_author(Keys, Hash, Author),\n\c
         \s   memberchk(Author, Authors),\n"-
        "    program_author(Keys, Hash, Author),\n\c
         \s   Authors = [_|_],\n").
promise(changed_payload_is_unsigned, authors,
        'prolog/typhon/options/identity/authors.pl',
        "    arg(2, Mark, Signature),\n\c
         \s   signature_by(Authors, Hash, Signature),\n\c
         \s   !."-
        "    arg(2, Mark, Signature),\n\c
         \s   typhon_signatures:signature(Known, Signature),\n\c
         \s   signature_by(Authors, Known, Signature),\n\c
         \s   atom(Hash),\n\c
         \s   !.").
promise(received_is_what_was_handed, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "is_received(received(_, What), What)."-
        "is_received(received(_, _), _).").
promise(links_are_signed_together, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    format(string(All), '~w ~w ~w', [Id, Last, Text]),"-
        "    format(string(All), '~w ~w', [Id, Text]),\n\c
         \s   nonvar(Last),").
promise(trail_belongs_to_its_agent, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    format(string(All), '~w ~w ~w', [Id, Last, Text]),"-
        "    format(string(All), '~w ~w', [Last, Text]),\n\c
         \s   atom(Id),").
promise(process_without_hand_over_is_invalid, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "    ;   Name == Before,\n\c
         \s       \\+ is_received(Event, _)\n"-
        "    ;   atom(Before), atom(Name),\n\c
         \s       \\+ is_received(Event, _)\n").
promise(hand_over_is_followed_by_a_receipt, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "    (   Earlier = handed(To, What)\n\c
         \s   ->  is_received(Event, What),\n\c
         \s       arg(1, Event, At),\n\c
         \s       address_parts(To, Host, _),     % a process may have\c
         \sseveral\n\c
         \s       address_parts(At, Host, _)      % addresses\n"-
        "    (   Earlier = handed(To, What),\n\c
         \s       is_received(Event, What)\n\c
         \s   ->  arg(1, Event, At),\n\c
         \s       address_parts(To, Host, _),     % a process may have\c
         \sseveral\n\c
         \s       address_parts(At, Host, _)      % addresses\n").
promise(receipt_names_the_host, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "        address_parts(At, Host, _)      % addresses\n"-
        "        address_parts(At, _, _),\n\c
         \s       atom(Host)\n").
promise(last_links_are_missed, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "    subsumes_term(at(N, _, _, Last, _), At)."-
        "    subsumes_term(at(_, _, _, _, _), At),\n\c
         \s   integer(N),\n\c
         \s   atomic(Last).").
promise(discarded_links_are_reported, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "    ->  Verdict = since(Since)\n"-
        "    ->  Verdict = whole\n").
promise(hosts_alone_sign_trails, trail_steps,
        'prolog/typhon/options/trail/trail_verified.pl',
        "    keys_verify(Keys, Signed, signature(Pem, Hex), host(Name))."-
        "    keys_verify(Keys, Signed, signature(Pem, Hex), Holder),\n\c
         \s   arg(1, Holder, Name).").
promise(oldest_links_are_dropped, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    Count =< Most,\n\c
         \s   !.\n\c
         newest"-
        "    Count =< Most+1,\n\c
         \s   !.\n\c
         newest").
promise(clones_begin_their_own_trail, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    exclude(of_trail, Clauses0, Clauses)."-
        "    ( exclude(of_trail, Clauses0, []) -> Clauses = [] ; Clauses\c
         \s= Clauses0 ).").
promise(host_option_disables_trails, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    (   host_option(Host, trail(false))\n"-
        "    (   host_option(Host, trail(none))\n").
promise(receipt_is_signed_with_the_next_link, trail_steps,
        'prolog/typhon/options/trail/trail.pl',
        "    ->  Pending = received(Where)\n\c
         \s   ;   Pending = received(Where, What)\n\c
         \s   ),\n\c
         \s   Raw = '$trail'(At, Chain, Pems, Pending)."-
        "    ->  Pending = received(Where)\n\c
         \s   ;   Pending = received(Where, What)\n\c
         \s   ),\n\c
         \s   Raw = '$trail'(At, Chain, Pems, none),\n\c
         \s   nonvar(Pending).").
promise(seal_is_for_one_receiver, certificates,
        'prolog/typhon/options/keys.pl',
        "    rsa_private_decrypt(Private, ForUs, KeyHex,\c
         \s[padding(pkcs1_oaep)]),"-
        "    rsa_private_decrypt(Private, ForUs, KeyHex, [padding(none)]),").
promise(changed_seal_is_refused, certificates,
        'prolog/typhon/options/keys.pl',
        "Key, Nonce, Text, [tag(Tag)])."-
        "Key, Nonce, Text,\n\c
         \s                       [tag(Tag), min_tag_length(4)]).").
promise(seal_uses_a_fresh_key, certificates,
        'prolog/typhon/options/keys.pl',
        "    crypto_n_random_bytes(12, Nonce),"-
        "    numlist(1, 12, Nonce),").
