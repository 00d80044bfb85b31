:- module(test_secure, []).

% TLS between processes: admitted and refused certificates, with the reasons.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/networks').
:- use_module('../../../lib/peers').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [endpoint_proof/2, endpoint_reply/2]).

:- use_module('../../../../app/typhon/keys', [keys_revoke/2]).

:- needs([openssl]).

:- dynamic told/1, broken/0.
:- multifile
    user:message_hook/3,
    typhon_endpoint:requested/4,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(request, who_am_i, _, none, none).

user:message_hook(typhon(endpoint, turned_away(_, Why)), _, _) :-
    assertz(told(Why)).

typhon_endpoint:requested(who_am_i, _, Peer, ReplyTo) :-
    endpoint_proof(Peer, Proof),
    endpoint_reply(ReplyTo, Proof).

%   with_keys(+Names, -Ours, :Goal): an authority with the hosts Names;
%   with_secure_host(+Ours, -Address, :Goal): the host alpha of Ours;
%   with_beta(-Dir, -Address, :Goal): and the process beta, with the keys Dir.

:- meta_predicate
    with_keys(+, -, 0),
    with_secure_host(+, -, 0),
    with_beta(-, -, 0).

with_keys(Names, Ours, Goal) :-
    with_authority(Names, [], Ours, Goal).

with_secure_host(Ours, Address, Goal) :-
    keys_of(alpha, Ours, Dir),
    retractall(told(_)),
    setup_call_cleanup(
        host_start(alpha, [tls(Dir)]),
        ( host_property(alpha, address(Address)), once(Goal) ),
        host_stop(alpha)).

with_beta(Dir, Address, Goal) :-
    with_keys([alpha, beta], Ours,
        ( keys_of(beta, Ours, Dir),
          with_peers([beta-[host([tls(Dir)])]],
                     with_secure_host(Ours, Address, Goal)) )).

%   The peer, with those keys, queries Address: Here is the reason for its
%   refusal on its side, There the one on ours, or `ok`.

tries(Keys, Address, Here-There) :-
    retractall(told(_)),
    atomic_list_concat([_, Endpoint], @, Address),
    peer_do(beta,
            ( host_stop(beta),
              host_start(beta, Keys),
              catch(( host_property(Address, address(_)), Here = ok ),
                    error(_, _),
                    ( typhon_wire:endpoint_missed(Endpoint, Formal),
                      Formal = permission_error(authenticate, peer, Here) ))
            )),
    (   Here == ok
    ->  There = ok
    ;   wait_until(test_secure:told(_), 10),
        once(told(There))
    ).

%   The first only: later handshakes are not interrupted.

once_broken(Negotiated) :-
    call(Negotiated),
    (   broken
    ->  true
    ;   assertz(broken),
        throw(wire_thread_end(test))
    ).

:- begin_tests(tls).

test(only_valid_certificates_of_the_authority_are_accepted) :-
    with_authority([alpha, beta, gamma, delta, mallory], [alice],
                   clients_connect).

clients_connect(Ours) :-
    keys_revoke(gamma, Ours),
    expired_host(Ours, delta),
    self_made_host(Ours, mallory),
    with_authority([other], [], clients_connect(Ours)).

clients_connect(Ours, Others) :-
    findall(Keys-Verdict, connected(Ours, Others, Keys, Verdict), Clients),
    no_leaks(with_peers([beta],
        forall(member(Keys-Expected, Clients),
               ( with_secure_host(Ours, Address, tries(Keys, Address, Verdict)),
                 assertion(Verdict == Expected) )))).

connected(Ours, Others, [tls(Dir)], Verdict) :-
    came(Of, Name, Verdict),
    (   Of == ours
    ->  keys_of(Name, Ours, Dir)
    ;   keys_of(Name, Others, Dir)
    ).
connected(_, _, [], tls(wanted)-tls(missing)).

came(ours, beta, ok-ok).
came(ours, gamma, tls(his(revoked))-tls(revoked)).
came(ours, delta, tls(his(expired))-tls(expired)).
came(ours, alice, tls(his(wrong_use))-tls(wrong_use)).
came(ours, mallory, tls(his(foreign))-tls(self_made)).
came(others, other, tls(foreign)-tls(his(foreign))).

test(thread_interrupted_after_a_handshake_leaves_nothing_open,
     Verdict == ok-ok) :-
    with_keys([alpha, beta], Ours,
        ( keys_of(beta, Ours, Dir),
          no_leaks(with_peers([beta],
              setup_call_cleanup(
                  wrap_predicate(ssl:ssl_negotiate(_, _, _, _, _), interrupted,
                                 Negotiated,
                                 test_secure:once_broken(Negotiated)),
                  with_secure_host(Ours, Address,
                                   tries([tls(Dir)], Address, Verdict)),
                  unwrap_predicate(ssl:ssl_negotiate/5, interrupted)))) )),
    assertion(broken).
test(tls_client_is_refused_by_a_host_without_keys,
     Verdict == tls(plain)-tls(unknown)) :-
    with_keys([beta], Ours,
        ( keys_of(beta, Ours, Dir),
          setup_call_cleanup(
              host_start(alpha),
              ( host_property(alpha, address(Address)),
                with_peers([beta], tries([tls(Dir)], Address, Verdict)) ),
              host_stop(alpha)) )).
test(host_is_revoked_at_run_time,
     Before-After == (ok-ok)-(tls(his(revoked))-tls(revoked))) :-
    with_keys([alpha, beta], Ours,
        ( keys_of(beta, Ours, Dir),
          with_peers([beta], with_secure_host(Ours, Address,
              ( tries([tls(Dir)], Address, Before),
                keys_revoke(beta, Ours),
                tries([tls(Dir)], Address, After) ))) )).
test(hook_gets_the_proof_of_the_peer, Proof == certificate(beta)) :-
    with_beta(_, Address,
        ( atomic_list_concat([_, Endpoint], @, Address),
          peer_do(beta, typhon_wire:endpoint_call(Endpoint, who_am_i, x,
                                                  answer(Proof), 10)) )).
test(remote_goals_need_the_option_besides_a_certificate,
     By-Then = permission_error(remote, host, _)-none) :-
    with_beta(_, Address,
        ( goal_of(beta, Address, By),
          remote(alpha, true),          % connections of our own processes work
          host_change(alpha, peer([certificate(beta)-all])),
          goal_of(beta, Address, Then) )).

goal_of(Peer, Address, Error) :-
    peer_do(Peer, catch(( remote(Address, true), Error = none ),
                        error(Error, _), true)).

test(only_tls_1_3_is_accepted,
     [forall(member(Version-Expected, ['-tls1_2'-no, '-tls1_3'-yes])),
      Said == Expected]) :-
    with_keys([alpha, beta], Ours,
        ( keys_of(beta, Ours, Dir),
          with_secure_host(Ours, Address,
                           s_client(Dir, Version, Said, Address)) )).

%   s_client(+Keys, +Version, -Said, +Address): Said is `yes` if openssl gets a
%   greeting.

s_client(Dir, Version, Said, Address) :-
    atomic_list_concat([_, Endpoint], @, Address),
    Args = [ Version, '-connect', Endpoint, '-cert', 'cert.pem', '-key',
             'key.pem', '-CAfile', 'ca.pem', '-quiet', '-no_ign_eof' ],
    setup_call_cleanup(
        process_create(path(openssl), [s_client|Args],
                       [ cwd(Dir), stdin(pipe(In)), stdout(pipe(Out)),
                         stderr(null), process(Pid) ]),
        ( read_line_to_string(Out, Line),
          ( Line == "typhon tls" -> Said = yes ; Said = no ) ),
        ( close(In, [force(true)]), close(Out), process_wait(Pid, _) )).

test(slow_handshake_is_refused, Why == slow) :-
    with_settings([typhon_handshake:handshake_time=1],
        with_keys([alpha], Ours,
                  no_leaks(with_secure_host(Ours, Address,
                                            dribbles(Why, Address))))).

%   A record of 512 bytes is announced; one comes every 0.2 seconds.

dribbles(Why, Address) :-
    atomic_list_concat([_, Endpoint], @, Address),
    atomic_list_concat([_, Text], :, Endpoint),
    atom_number(Text, Port),
    tcp_socket(Socket),
    tcp_connect(Socket, '127.0.0.1':Port),
    tcp_open_socket(Socket, In, Out),
    call_cleanup(catch(dribble(Out, [0x16, 3, 1, 2, 0, 1, 0, 1, 252]),
                       error(_, _), true),
                 ( close(Out, [force(true)]), close(In, [force(true)]) )),
    wait_until(test_secure:told(_), 10),
    once(told(Why)).

dribble(Out, Bytes) :-
    forall(member(Byte, Bytes), put_byte(Out, Byte)),
    flush_output(Out),
    forall(between(1, 60, _),
           ( told(_)
           -> throw(error(turned_away, _))
           ;  put_byte(Out, 1), flush_output(Out), sleep(0.1) )).

:- end_tests(tls).

:- begin_tests(work_over_tls).

test(large_data_in_both_directions) :-
    with_beta(_, Address, much_both_ways(4, Address)).

%   Agents of 100 kB cross each other while small ones hop.

much_both_ways(Rounds, Address) :-
    peer_host(beta, Beta),
    length(Codes, 100000),
    maplist(=(0'x), Codes),
    atom_codes(Load, Codes),
    Program = clauses([ (:- agent(walker, [state([left/1, other/1, load/1])])),
                        (main :- retract(left(N)), N > 0, !, N1 is N-1,
                                 assertz(left(N1)), other(O), home(H),
                                 move(O), move(H), main),
                        main ]),
    findall(Agent,
            ( member(Size-Left, [big-Rounds, big-Rounds, small-25, small-25]),
              ( Size == big -> Loads = [load(Load)] ; Loads = [] ),
              agent_create(Program, Agent,
                           [facts([left(Left), other(Beta)|Loads])]) ),
            Agents),
    peer_do(beta,
            ( agent_create(Program, Big,
                           [facts([left(Rounds), other(Address), load(Load)])]),
              agent_join(Big, done, 100) )),
    forall(member(Agent, Agents),
           ( agent_join(Agent, Outcome, 100), assertion(Outcome == done) )).

test(long_running_handler_releases_the_connection) :-
    with_beta(_, Address, long_stay_at(Address)).

long_stay_at(Address) :-
    peer_do(beta, agent_create(clauses([ (:- agent(worker, [])),
                                         (main :- move(Address),
                                                  sleep_here(0.6)),
                                         (sleep_here(T) :- get_time(T0),
                                             repeat, get_time(T1),
                                             T1-T0 > T, !) ]), A)),
    get_time(T0),
    peer_do(beta, ( host_property(Address, address(_)),
                    agent_join(A, Outcome, 20) )),
    get_time(T1),
    assertion(Outcome == done),
    Seconds is T1-T0,
    assertion(soon(Seconds, 10)).

test(processes_of_a_network_get_keys, Proofs == [2]) :-
    with_keys([alpha], Ours,
        ( keys_of(alpha, Ours, Dir),
          with_network(ring(2), [processes(2), tls(Dir)], _, [First|_],
                       findall(2, remote(First, typhon_keys:own_keys(_)),
                               Proofs)) )).

:- end_tests(work_over_tls).
