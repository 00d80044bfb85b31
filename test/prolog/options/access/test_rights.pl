:- module(test_rights, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/access), []).
:- use_module(library(typhon/options/identity/sender_rights), []).
:- use_module(library(typhon/kernel/wire), [endpoint_address/1]).
:- use_module(library(typhon/kernel/wire/kinds), [arrives/6]).

/** <module> Rights by proofs, on which hosts, and what the audit keeps

The peer is this process, which has the cookie.

*Threading*: one test at a time.
*/

right(Right) :-
    typhon_kinds:right(Right, _, _).

%   has_row(+Right): the table of rights in doc/security.md has a row of Right.

has_row(Right) :-
    project_file('doc/security.md', File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    format(string(Row), "\n| `~w` | ", [Right]),
    sub_string(Text, _, _, _, Row),
    !.

%   has(+Proof, +Host, -Rights)

has(Proof, Host, Rights) :-
    findall(R, ( right(R), typhon_rights:proof_may(Proof, Host, R) ), Rights).

permitted(Right, Scope) :-
    endpoint_address(Me),
    typhon_kinds:peer_permitted(Right, Scope, term(x), Me),
    !.

answers(Goals, Answers) :-
    findall(A, ( member(G, Goals), ( call(G) -> A = yes ; A = no ) ), Answers).

:- begin_tests(rights).

test(without_rules_the_secret_of_the_process_gives_all_rights,
     All-Others == [agents,messages,orders,remote,watch,log]
                   -[agents,messages,orders,watch]) :-
    with_hosts([g], ( has(cookie, g, All), has(certificate(x), g, Others) )).
test(rules_give_the_rights_of_the_first_that_matches, Rights ==
     [ [agents,messages,orders,remote,watch,log], [agents,log], [watch],
       [] ]) :-
    with_hosts([g-[peer([ cookie-all, certificate(lab)-[log,agents],
                          certificate(x)-[watch], certificate(x)-all ])]],
               findall(Rs, ( member(P, [ cookie, certificate(lab),
                                         certificate(x), certificate(y) ]),
                             has(P, g, Rs) ), Rights)).
test(rule_of_all_certificates_matches_no_cookie, Rights == [[],[watch]]) :-
    with_hosts([g-[peer([certificate(_)-[watch]])]],
               findall(Rs,
                       ( member(P, [cookie,certificate(x)]), has(P, g, Rs) ),
                       Rights)).
test(rights_are_needed_on_the_hosts_of_the_scope,
     Answers == [no,yes,no,yes,yes,no,no]) :-
    with_hosts([g-[peer([cookie-[orders]])], h-[peer([cookie-[watch]])]],
               ( create([on_message(_, _)], A, [host(g)]),
                 create([on_message(_, _)], B, [host(h)]),
                 wait_state(A, resident), wait_state(B, resident),
                 answers([ permitted(watch, host(g)), permitted(watch, host(h)),
                           permitted(watch, all), permitted(watch, some),
                           permitted(watch, agent(B)),
                           permitted(watch, agent(A)), permitted(log, some) ],
                         Answers) )).
test(agents_that_are_elsewhere_concern_all_hosts, Answers == [no,yes]) :-
    with_hosts([g-[peer([cookie-[orders]])], h-[peer([cookie-[watch,orders]])]],
               answers([ permitted(watch, agent('x.0@z@1.2.3.4:1')),
                         permitted(orders, agent('x.0@z@1.2.3.4:1')) ],
                       Answers)).
test(without_a_host_the_proof_decides, Answers == [yes,yes]) :-
    with_hosts([g-[peer([cookie-[]])]],
               answers([permitted(watch, host(no)), permitted(log, host(no))],
                       Answers)).
test(records_are_for_peers_that_may_run_goals, Answers ==
     [ no,yes, no,yes, yes,yes, yes,no ]) :-
    with_hosts([g], text_only([cookie,certificate(x)], A1)),
    with_hosts([g], ( host_start(h, []), text_only([cookie,certificate(x)], A2),
                      host_stop(h) )),
    with_hosts([g-[remote(false)]], text_only([cookie,certificate(x)], A3)),
    with_hosts([g-[peer([certificate(x)-[remote]])]],
               text_only([cookie,certificate(x)], A4)),
    append_all([A1,A2,A3,A4], Answers).
test(orders_need_the_secret_of_the_parent, Answers == [no,yes,no]) :-
    setup_call_cleanup(
        typhon_rights:parent_secret(right),
        answers([ parent(order(wrong, x)), parent(order(right, x)),
                  parent(order(_, x)) ], Answers),
        retractall(typhon_rights:secret(_))).
test(declared_terms_need_rights_of_the_table, Unknown == []) :-
    findall(Right, ( arrives(_, _, _, Right, _, _),
                     \+ memberchk(Right, [none,asked,gate,parent]),
                     \+ right(Right) ), Unknown).
test(rights_of_no_table_are_given_to_no_peer, Answers == [no,no,no]) :-
    with_hosts([g], answers([ permitted(bogus, host(g)), permitted(bogus, all),
                              permitted(bogus, host(no)) ], Answers)).
test(documents_have_each_right, Missing == []) :-
    findall(Right, ( right(Right), \+ has_row(Right) ), Missing).
test(rules_are_checked, Answers ==
     [yes,yes,yes,yes,no,no,no,no,no,no,no]) :-
    findall(A, ( member(Rules, [ [], [cookie-all], [certificate(x)-[agents]],
                                 [_-[agents,messages,orders,remote,watch,log]],
                                 [cookie-[bogus]], [cookie-watch], [x-all],
                                 [cookie-[_]], [cookie], [cookie-[watch|_]],
                                 cookie ]),
                 ( catch(typhon_access:must_be_peer_rules(Rules), error(_, _),
                         fail) -> A = yes ; A = no ) ), Answers).

:- end_tests(rights).

parent(Term) :-
    \+ \+ ( arg(1, Term, Secret), ( var(Secret) -> Secret = wrong ; true ),
            typhon_kinds:peer_permitted(parent, none, Term, 'x:1') ).

text_only(Proofs, Answers) :-
    findall(A, ( member(P, Proofs),
                 ( typhon_handshake:text_only(P) -> A = yes ; A = no ) ),
            Answers).

append_all([], []).
append_all([L|Ls], All) :-
    append_all(Ls, Rest),
    append(L, Rest, All).

                /*******************************
                *             AUDIT            *
                *******************************/

%   audit(+Options, :Goal, -Entries): Goal happens on the host g.

:- meta_predicate audit(+, 0, -), audit_in(+, 0, -, +).

audit(Options, Goal, Entries) :-
    with_tmp_dir(audit_in(Options, Goal, Entries)).

audit_in(Options, Goal, Entries, Dir) :-
    directory_file_path(Dir, audit, File),
    with_hosts([g-[audit(File)|Options]], Goal),
    read_file_to_terms(File, Terms, []),
    setup_call_cleanup(open(File, read, In, [encoding(utf8)]),
                       read_string(In, _, Text), close(In)),
    assertion(\+ sub_string(Text, _, _, _, "\u202E")),
    split_string(Text, "\n", "", Lines),
    assertion(( length(Terms, N), length(Lines, M), M =:= N+1 )),
    findall(Peer-Proof-What, member(audit(_, g, Peer, Proof, What), Terms),
            Entries0),
    findall(Proof-What, member(_-Proof-What, Entries0), Entries).

noted(Goal, Whats) :-
    audit([], Goal, Entries),
    findall(What, member(_-What, Entries), Whats).

:- begin_tests(audit).

test(refusals_and_orders_are_lines,
     Entries == [ cookie-refused(watch), cookie-remote(true),
                  cookie-order(a, question(a, dispose)),
                  cookie-undeclared(k) ]) :-
    audit([peer([cookie-[remote,orders]])],
          ( endpoint_address(Me),
            ( typhon_kinds:peer_permitted(watch, host(g), x, Me) -> true
            ; true ),
            once(typhon_kinds:peer_permitted(remote, host(g), remote(g, true),
                                             Me)),
            once(typhon_kinds:peer_permitted(orders, host(g),
                                             question(a, dispose),
                                             Me)),
            once(typhon_kinds:peer_permitted(undeclared(k), all, x, Me)) ),
          Entries0),
    findall(E, ( member(E0, Entries0),
                 ( E0 = P-order(_, O) -> E = P-order(a, O) ; E = E0 ) ),
            Entries).
test(order_names_its_agent_or_host,
     Of == [order(a, dispose),order(g, link(g, h)),order(all, end([], []))]) :-
    findall(What,
            ( member(Scope-Term, [ agent(a)-question(a, dispose),
                                   host(g)-link(g, h), all-end([], []) ]),
              typhon_rights:used(orders, Scope, Term, What) ), Of).
test(large_entries_are_abridged, Sizes == [small,small,small]) :-
    numlist(1, 100 000, L),
    atom_of(100 000, Atom),
    findall(S, ( member(T, [L,Atom,f(L, Atom)]),
                 typhon_access:brief(refused(T), Brief),
                 format(string(Text), "~q", [Brief]),
                 string_length(Text, N),
                 ( N < 2000 -> S = small ; S = N ) ), Sizes).
test(short_entries_are_kept,
     [ forall(member(T, [refused(watch), order(a, f(X, X)), "text", 'it''s'])),
       B =@= T ]) :-
    typhon_access:brief(T, B).
test(entries_of_less_than_two_thousand_characters_are_kept, Kept == [yes,no]) :-
    findall(K, ( member(N, [1 999,2 000]), atom_of(N, A),
                 ( typhon_access:brief(A, A) -> K = yes ; K = no ) ), Kept).
test(text_of_peers_stays_on_its_line,
     Whats == [undeclared('a\nb\e[2J\u202Ec')]) :-
    noted(( endpoint_address(Me),
            once(typhon_kinds:peer_permitted(undeclared('a\nb\e[2J\u202Ec'),
                                             all,
                                             x, Me)) ), Whats).

test(entries_of_peers_are_short, [true(Length < 1000)]) :-
    atom_of(100 000, Long),
    noted(( endpoint_address(Me),
            once(typhon_kinds:peer_permitted(undeclared(Long), all, x, Me)) ),
          Whats),
    format(string(Text), "~q", [Whats]),
    string_length(Text, Length).
test(audit_is_for_its_user_alone, Mode == "-rw-------") :-
    with_tmp_dir(audit_mode(Mode)).
test(message_in_the_name_of_another_is_noted, [true(Noted == yes)]) :-
    noted(( endpoint_address(Me),
            create([on_message(_, _)], A, [host(g)]),
            capturing(typhon_sender_rights:report_forged(Me, A, other), _) ),
          Whats),
    ( memberchk(refused(A, from(other)), Whats) -> Noted = yes
    ; Noted = Whats ).

:- end_tests(audit).

audit_mode(Mode, Dir) :-
    directory_file_path(Dir, audit, File),
    with_hosts([g-[audit(File)]],
               ( endpoint_address(Me),
                 once(typhon_kinds:peer_permitted(undeclared(k), all, x,
                                                  Me)) )),
    format(atom(Command), 'ls -l ~w', [File]),
    setup_call_cleanup(open(pipe(Command), read, In), read_string(In, _, Line),
                       close(In)),
    sub_string(Line, 0, 10, _, Mode).

atom_of(N, Atom) :-
    length(Codes, N),
    findall(0'x, member(_, Codes), Xs),
    atom_codes(Atom, Xs).
