:- module(test_engines, []).

% Engines with TLS, with users of few rights, with a replica and a sentinel, and
% behind connections that are cut.

:- use_module('../../../lib/authority').
:- use_module('../../../lib/common').
:- use_module('../../../lib/cutting_proxy').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module('../../../lib/texts', [file_lines/2]).
:- use_module('../../../lib/vanishing_relay').
:- use_module('../../../../app/typhon/engine_options', [engine_options/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- needs([fleet, openssl]).

:- meta_predicate
    in_fleet(+, 0),
    with_engines(-, -, -, 0).

%   in_fleet(+Joins, :Goal): Goal in a member of `lab` with the host alpha.

in_fleet(Joins, Goal) :-
    setup_call_cleanup(
        fleet_join(lab, Joins),
        ( host_start(alpha, [fleet(lab), tags([x])]), once(Goal) ),
        ( forall(typhon_host:host(Host, _, _), host_stop(Host)),
          fleet_leave(lab) )).

up(Names) :-
    wait_until(test_engines:hosts([state(up)], Names), 30).

hosts(Options, Names) :-
    catch(fleet_hosts(lab, Hosts, Options), error(_, _), fail),
    findall(Name, ( member(Host, Hosts), atomic_list_concat([Name|_], @, Host) ),
            Names0),
    sort(Names0, Names).

%   tour(+Peers, -Outcome): of an agent that moves to them and back.

tour(Peers, Outcome) :-
    findall(move(Host), ( member(Peer, Peers), peer_host(Peer, Host) ), Moves),
    address(alpha, Alpha),
    foldl(then, Moves, true, There),
    create([(main :- There, move(Alpha))], Agent, [host(alpha)]),
    joined(Agent, Outcome).

then(Goal, Goals, (Goals,Goal)).

%   tls(+Dir, -Port, -Options): Redis with the keys of Dir, as arguments.

tls(Dir, Port, ['--port', 0, '--tls-port', Port, '--tls-cert-file', Cert,
                '--tls-key-file', Key, '--tls-ca-cert-file', Ca]) :-
    keys(Dir, alpha, [cacert(Ca), key(Key), cert(Cert)]).

keys(Dir, Name, [cacert(Ca), key(Key), cert(Cert)]) :-
    keys_of(Name, Dir, Own),
    directory_file_path(Own, 'ca.pem', Ca),
    directory_file_path(Own, 'key.pem', Key),
    directory_file_path(Own, 'cert.pem', Cert).

:- meta_predicate with_tls(-, -, 0).

with_tls(Dir, Address, Goal) :-
    no_leaks(with_authority([alpha,beta], [], Dir,
                            test_engines:with_tls_in(Dir, Address, Goal))).

:- public with_tls_in/3.

with_tls_in(Dir, Address, Goal) :-
    tls(Dir, Port, Options),
    Redis = redis(Port, _, _),
    with_redis(Options, Redis, ( redis_address(Redis, Address), Goal )).

:- begin_tests(engine_tls).

test(members_with_certificates_meet, Names == [alpha,beta]) :-
    with_tls(Dir, Address,
             ( keys(Dir, beta, Keys),
               Joins = [redis(Address), tls(true), lease(60)|Keys],
               in_fleet(Joins,
                        with_peers([beta-[ setup(fleet_join(lab, Joins)),
                                           host([ fleet(lab),
                                                  journal(redis('lab/b')) ]) ]],
                                   ( hosts([state(up)], Names),
                                     tour([beta], done) ))) )).

test(certificate_of_another_authority_is_refused,
     throws(error(resource_error(fleet(lab)), _))) :-
    with_tls(Dir, Address,
             ( self_made_host(Dir, beta),
               keys(Dir, beta, Keys),
               in_fleet([redis(Address), tls(true)|Keys], true) )).

test(server_of_another_authority_is_refused,
     throws(error(resource_error(fleet(lab)), context(_, Why)))) :-
    with_tls(Dir, Address,
             ( keys(Dir, beta, [_|Keys]),
               keys_of(member, Dir, Own),
               directory_file_path(Own, 'cert.pem', Other),
               in_fleet([redis(Address), tls(true), cacert(Other)|Keys], true) )),
    assertion(sub_atom(Why, _, _, _, 'certificate verify failed')).

test(plain_connection_is_refused,
     throws(error(resource_error(fleet(lab)), _))) :-
    with_tls(_, Address, in_fleet([redis(Address)], true)).

test(options_of_the_command_line_reach_the_engine, Names == []) :-
    with_tls(Dir, Address,
             ( keys(Dir, beta, Keys),
               Address = Host:Port,
               atomic_list_concat([Host,Port], :, Redis),
               engine_options(host, [fleet(lab), redis(Redis)|Keys], Joins),
               fleet_join(lab, Joins),
               call_cleanup(fleet_hosts(lab, Names, []), fleet_leave(lab)) )).

test(files_are_needed, [ forall(member(Option, [cacert,key,cert])),
                         throws(error(existence_error(option, Option), _)) ]) :-
    Files = [cacert(a), key(b), cert(c)],
    findall(File, ( member(File, Files), \+ functor(File, Option, 1) ), Some),
    fleet_join(lab, [redis(localhost:1), tls(true)|Some]).

:- end_tests(engine_tls).

%   acl(-Rule): of the document, with the password `secret`.

acl(Rule) :-
    project_file('doc/fleets.md', File),
    file_lines(File, Lines),
    member(Line, Lines),
    string_concat("    user ", Rule0, Line),
    atomic_list_concat(Parts, 'SECRET', Rule0),
    Parts = [_,_],
    !,
    atomic_list_concat(Parts, secret, Rule).

:- meta_predicate with_user(-, 0).

with_user(Joins, Goal) :-
    acl(Rule),
    split_string(Rule, " ", "", Words),
    Words = [User|_],
    Joins = [redis(Address), user(User), password(secret)],
    append(['--user'|Words], ['--user', default, off], Options),
    no_leaks(with_redis(Options, Redis,
                        ( redis_address(Redis, Address), Goal ))).

all_done(Names) :-
    fleet_watch(lab, print, Watch),
    create([(main :- receive(_-go))], Agent, [host(any(x))]),
    wait_until(test_engines:registered(Agent), 30),
    fleet_drain(alpha, []),
    fleet_unwatch(Watch),
    wait_until(test_engines:hosts([tag(x)], [beta]), 30),
    agent_send(Agent, go),
    joined(Agent, done),
    hosts([], Names).

registered(Agent) :-
    typhon_registry:asked(agents, Agent, _).

%   refuses(+Redis, +User, +Command): Command with as few arguments as it has.

refuses(Redis, User, Command) :-
    redis_line(Redis, [command,info,Command], [_,Text|_]),
    number_string(Arity, Text),
    Count is abs(Arity)-1,
    findall('f:{lab}:x', between(1, Count, _), Args),
    redis_line(Redis, [acl,dryrun,User,Command|Args], [Line|_]),
    sub_string(Line, _, _, _, "no permissions to run").

command_of_script(Command) :-
    project_file('prolog/typhon/options/fleet/scripts', Dir),
    findall(C, ( directory_member(Dir, File, [extensions([lua])]),
                 file_lines(File, Lines),
                 member(Line, Lines),
                 split_string(Line, "'", "", Parts),
                 append(_, [Before,C|_], Parts),
                 string_concat(_, "call(", Before) ),
            Commands0),
    sort(Commands0, Commands),
    assertion(memberchk("ZADD", Commands)),
    member(Command, Commands).

:- begin_tests(engine_users).

%   All that a fleet does, with the rights that the document gives.

test(rights_of_the_document_suffice, Names == [beta]) :-
    with_user(Joins,
              in_fleet([lease(60), recover(true), report(0.2)|Joins],
                       with_peers([beta-[ setup(fleet_join(lab,
                                                           [lease(60)|Joins])),
                                          host([ fleet(lab), tags([x]),
                                                 journal(redis('lab/b')) ]) ]],
                                  all_done(Names)))).

test(each_command_of_a_script_is_permitted, Refused == []) :-
    acl(Rule),
    split_string(Rule, " ", "", [User|Words]),
    with_redis(['--user',User|Words], Redis,
               findall(Command,
                       ( command_of_script(Command),
                         refuses(Redis, User, Command) ),
                       Refused)).

test(rights_end_at_the_keys_of_the_fleet,
     [ forall(member(Command, [ flushall, get('f:{other}:epoch'), keys(*),
                                config(get, *), shutdown, acl(list),
                                subscribe(x) ])),
       throws(error(permission_error(authenticate, fleet, lab), _)) ]) :-
    with_user(Joins, in_fleet(Joins, typhon_engine:engine(lab, Command, _))).

%   library(redis) asks for an echo after an error.

test(connection_is_not_used_after_an_error_that_closed_it, Names == [alpha]) :-
    no_leaks(with_redis(['--user', default, off,
                         '--user', robot, on, '>secret', '~*', '+@all', '-echo'],
                        Redis,
        ( redis_address(Redis, Address),
          in_fleet([redis(Address), user(robot), password(secret)],
                   ( catch(typhon_engine:engine(lab, hget(key), _),
                           error(redis_error(_, _), _), true),
                     hosts([], Names) )) ))).

test(user_that_was_deleted_is_refused,
     throws(error(permission_error(authenticate, fleet, lab), _))) :-
    no_leaks(with_redis(Redis,
        ( redis_address(Redis, Address),
          redis_line(Redis, [acl, setuser, robot, on, '>secret', '~*', '+@all'],
                     _),
          in_fleet([redis(Address), user(robot), password(secret)],
                   ( redis_line(Redis, [acl, deluser, robot], _),
                     fleet_hosts(lab, _, []) )) ))).

:- end_tests(engine_users).

%   with_engines(-Master, -Replica, -Joins, :Goal): Goal, while a sentinel watches
%   the two.

with_engines(Master, Replica, Joins, Goal) :-
    no_leaks(with_redis(Master, replicated(Master, Replica, Joins, Goal))).

:- meta_predicate replicated(+, -, -, 0).

replicated(Master, Replica, [sentinel(lab), sentinels([At])], Goal) :-
    Master = redis(Port, _, _),
    Replica = redis(Own, _, _),
    with_redis(['--replicaof', '127.0.0.1', Port, '--replica-announce-ip',
                '127.0.0.1', '--replica-announce-port', Own], Replica,
               ( wait_until(test_engines:copies(Replica), 30),
                 with_sentinel(Port, At,
                               ( wait_until(test_engines:knows_replica(At), 30),
                                 Goal )) )).

copies(Replica) :-
    redis_line(Replica, [info,replication], Lines),
    member("master_link_status:up", Lines).

knows_replica(_:Port) :-
    redis_line(redis(Port, _, _), [sentinel,replicas,lab], Lines),
    memberchk("flags", Lines).

fails_over(Master, [N1,N2,N3,N4]) :-
    counter(beta, Agent),
    counts(Agent, N1),
    up([alpha,beta]),
    redis_signal(Master, kill),
    counts(Agent, N2),
    up([alpha,beta]),
    counts(Agent, N3),
    host_start(gamma, [fleet(lab)]),
    up([alpha,beta,gamma]),
    counts(Agent, N4).

counter(Peer, Agent) :-
    peer_agent(Peer, [ (:- agent(counter)), (:- dynamic(n/1)),
                       (main :- receive(From-next), retract(n(N0)), N is N0+1,
                                assertz(n(N)), send(From, count(N)), main) ],
               [n(0)], Agent).

counts(Counter, N) :-
    create([ (main :- send(Counter, next), receive(_-count(M)), result(M)) ],
           Asker, [host(alpha)]),
    agent_join(Asker, done, 60),
    agent_result(Asker, N, 10).

%   with_vanished(-Address, :Goal): no packet to Address is answered.

:- meta_predicate with_vanished(-, 0).

with_vanished('127.0.0.1':Port, Goal) :-
    with_tmp_dir(Dir, vanished_in(Dir, Port, Goal)).

:- public vanished_in/3.
:- meta_predicate vanished_in(+, -, 0).

vanished_in(Dir, Port, Goal) :-
    directory_file_path(Dir, none, Socket),
    setup_call_cleanup(
        vanishing_start(Socket, Relay, Port),
        ( vanishing_order(Relay, vanish), once(Goal) ),
        vanishing_stop(Relay)).

vanishes(redis(_, Dir, _), Names) :-
    directory_file_path(Dir, socket, Socket),
    setup_call_cleanup(
        vanishing_start(Socket, Relay, Port),
        replicated(redis(Port, Dir, []), Replica, Joins,
                   in_fleet([lease(2)|Joins],
                            ( notices_after(6000, Joins),
                              vanishing_order(Relay, vanish),
                              wait_until(test_engines:is_master(Replica), 60),
                              up([alpha]),
                              hosts([], Names) ))),
        vanishing_stop(Relay)).

%   When the sentinel notices, several attempts to connect have failed.

notices_after(Milliseconds, Joins) :-
    memberchk(sentinels([_:Port]), Joins),
    redis_line(redis(Port, _, _),
               [sentinel,set,lab,'down-after-milliseconds',Milliseconds], _).

is_master(Replica) :-
    redis_line(Replica, [role], ["master"|_]).

refuses(Master) :-
    redis_line(Master, [set,'f:{other}:x',1], [Line|_]),
    sub_string(Line, 0, _, _, "NOREPLICAS").

:- begin_tests(engine_failover).

%   An agent in a process whose journal is in the engine counts messages.

test(members_and_journals_go_on_at_the_replica, Counts == [1,2,3,4]) :-
    with_engines(Master, _, Joins0,
        ( Joins = [lease(2)|Joins0],
          in_fleet(Joins,
                   with_peers([beta-[ setup(fleet_join(lab, Joins)),
                                      host([ fleet(lab),
                                             journal(redis('lab/b')) ]) ]],
                              fails_over(Master, Counts))) )).

test(sentinel_whose_machine_is_gone_does_not_matter, Names == [alpha]) :-
    with_engines(_, _, [sentinel(lab), sentinels([Live])],
        with_vanished(Gone,
                      in_fleet([ sentinel(lab), sentinels([Gone,Live]) ],
                               hosts([], Names)))).

%   The machine of the master vanishes: connections to it hang.

test(master_whose_machine_vanishes_is_replaced, Names == [alpha]) :-
    no_leaks(with_redis(['--unixsocket', socket], Master,
                        vanishes(Master, Names))).

%   With min-replicas-to-write.

test(master_without_a_replica_takes_no_changes, Heard == later) :-
    with_engines(Master, Replica, Joins,
        ( redis_line(Master, [config,set,'min-replicas-to-write',1], _),
          redis_line(Master, [config,set,'min-replicas-max-lag',1], _),
          redis_signal(Replica, kill),
          wait_until(test_engines:refuses(Master), 30),
          capturing(in_fleet([lease(2)|Joins],
                             ( assertion(\+ was_printed(error, _)),
                               ( was_printed(warning,
                                             typhon(fleet_later(alpha, lab)))
                               -> Heard = later
                               ;  Heard = known ),
                               redis_restart(Replica),
                               up([alpha]) )),
                    _) )).

:- end_tests(engine_failover).

%   with_cut(-Proxy, :Goal): peer beta reaches the engine through Proxy; gamma is
%   not in the fleet.

:- meta_predicate with_cut(-, 0).

with_cut(Proxy, Goal) :-
    with_fleet([lease(2)], Redis, [alpha-[]],
               ( redis_address(Redis, Host:Port),
                 atomic_list_concat([Host,Port], :, Target),
                 with_proxy(Target, Proxy, behind(Proxy, Goal)) )).

:- meta_predicate behind(+, 0).

behind(Proxy, Goal) :-
    proxy_address(Proxy, Address0),
    atomic_list_concat([Host,Port0], :, Address0),
    atom_number(Port0, Port),
    with_peers([beta-[ setup(( fleet_join(lab, [lease(2), redis(Host:Port)]),
                               set_setting(typhon_fleet:engine_seconds, 2) )),
                       host([fleet(lab)]) ],
                gamma],
               ( up([alpha,beta]), once(Goal) )).

was_cut(Proxy) :-
    proxy_cuts(Proxy, N),
    N > 0.

:- begin_tests(engine_cuts).

%   SWI-Prolog 9.0.4 would wait for ever there.

test(fleet_is_joined_in_a_setup_while_a_signal_is_pending,
     throws(error(resource_error(fleet(lab)), _))) :-
    thread_self(Me),
    no_leaks(setup_call_cleanup(( thread_signal(Me, true),
                                  fleet_join(lab, [redis(localhost:1)]) ),
                                true,
                                true)).

test(member_without_the_engine_is_away_and_hops_go_on, Outcome == done) :-
    with_cut(Proxy,
             ( proxy_hold(Proxy, up),
               proxy_hold(Proxy, down),
               wait_until(test_engines:hosts([state(away)], [beta]), 30),
               tour([beta,gamma,beta], Outcome),
               hosts([state(up)], [alpha]),
               proxy_release(Proxy, up),
               proxy_release(Proxy, down),
               up([alpha,beta]) )).

test(seconds_for_which_an_engine_is_asked_are_those_of_now,
     throws(error(resource_error(fleet(lab)), _))) :-
    set_setting(typhon_fleet:engine_seconds, 100 000),
    with_fleet([], Redis, [],
               setup_call_cleanup(redis_signal(Redis, stop),    % 2 seconds
                                  fleet_hosts(lab, _, []),
                                  redis_signal(Redis, cont))).
test(connections_that_break_do_not_matter) :-
    with_cut(Proxy,
             ( forall(between(1, 5, _),
                      ( proxy_cut(Proxy),
                        peer_do(beta, fleet_hosts(lab, _, [])) )),
               up([alpha,beta]) )).

test(one_new_connection_that_breaks_does_not_matter) :-
    with_cut(Proxy,
             ( forall(between(1, 5, _),
                      ( proxy_cut_after(Proxy, down, 1),
                        proxy_cut(Proxy),
                        peer_do(beta, fleet_hosts(lab, _, [])) )),
               up([alpha,beta]) )).

test(answer_that_is_cut_is_an_error_or_comes_again,
     [forall(member(Bytes, [1,5,20]))]) :-
    with_cut(Proxy,
             ( proxy_cut_after(Proxy, down, Bytes),
               wait_until(test_engines:was_cut(Proxy), 30),
               up([alpha,beta]) )).

:- end_tests(engine_cuts).
