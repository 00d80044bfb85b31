:- module(test_takeover, []).

% Processes of a fleet that are replaced, fenced or drained.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

:- needs([fleet]).

%   up(+Names): hosts with these names are up.

up(Names) :-
    wait_until(test_takeover:are_up(Names), 30).

are_up(Names) :-
    catch(fleet_hosts(lab, Hosts, [state(up)]), error(_, _), fail),
    findall(Name, ( member(Host, Hosts), atomic_list_concat([Name|_], @, Host) ),
            Names0),
    sort(Names0, Names).

%   traveller(+Host, -Id): born in the peer, on Host now; it ends after a message.

traveller(Host, Id) :-
    peer_agent(beta, [ (:- agent(traveller)),
                       (main :- move(Host), receive(_-go), result(1), result(2)) ],
               [], Id),
    wait_until(test_takeover:found(Id, Host), 30).

ended(Id, Outcome) :-
    catch(agent_join(Id, Outcome, 30), error(_, _), fail).

found(Id, Host) :-
    catch(agent_where(Id, Host0), error(_, _), fail),
    Host0 = Host.

%   The engine knows where Id is.

stored(Redis, Id) :-
    atomic_list_concat([_,_,Home], @, Id),
    atom_concat('f:{lab}:agents:', Home, Key),
    redis_line(Redis, [hexists, Key, Id], ["1"]).

%   counting(+Redis, -Agent, :Goal): Goal in a member without a journal; peer
%   `beta` has its journal in the engine, and an agent that counts messages.

:- meta_predicate counting(+, -, 0).

counting(Redis, Agent, Goal) :-
    member_spec(Redis, beta, [], [journal(redis('lab/beta'))], Beta),
    with_peers([Beta],
               ( peer_agent(beta, [ (:- agent(counter)), (:- dynamic(n/1)),
                                    (main :- receive(From-next), retract(n(N0)),
                                             N is N0+1, assertz(n(N)),
                                             send(From, count(N)), main) ],
                            [n(0)], Agent),
                 up([alpha,beta]),
                 asked(Agent, 1),
                 peer_host(beta, Host),
                 call_cleanup(Goal, end_of_stand_in(Redis, Host)) )).

%   Whatever process has the address of Host ends, if it is not the peer.

end_of_stand_in(Redis, Host) :-
    atomic_list_concat([_,Endpoint], @, Host),
    atom_concat('f:{lab}:p:', Endpoint, Key),
    redis_line(Redis, [hget, Key, pid], [Text]),
    number_string(Pid, Text),
    (   peer_pid(beta, Pid)
    ->  true
    ;   process_kill(Pid, term),
        wait_until(is_dead(Pid), 30)
    ).

%   the counter says N next.

asked(Counter, N) :-
    create([ (main :- send(Counter, next), receive(_-count(N)), result(N)) ],
           Asker, [host(alpha)]),
    agent_join(Asker, Outcome, 60),
    assertion(Outcome == done),
    agent_result(Asker, Said, 10),
    assertion(Said == N).

%   moved(+Peer, +Host, -Result): an agent of Peer moves to Host; Result is the
%   error, or `none`.

moved(Peer, Host, Result) :-
    peer_agent(Peer, [ (:- agent(mover, [state([to/1])])),
                       (main :- to(H),
                                catch(( move(H), E = none ), error(E, _), true),
                                result(E)) ],
               [to(Host)], Agent),
    agent_result(Agent, Result, 60).

%   Another process goes on in place of the peer, which does not run.

stands_in(Redis, Agent) :-
    peer_host(beta, Host),
    lease_lapses(Redis, Host),
    are_up([alpha]),
    journal_lapses(Redis, Host),
    up([alpha,beta]),
    asked(Agent, 2),
    asked(Agent, 3).

%   The peer renews its lease, or ends, since another process has its place.

beats(Peer) :-
    catch(peer_do(Peer, typhon_members:fleet_beat(lab)),
          error(system_error(peer_died(Peer)), _), true).

:- begin_tests(drain).

test(agents_go_to_hosts_of_the_first_tag, Where == [beta,beta,gamma,gamma]) :-
    with_fleet([], _, [alpha-[x,y], beta-[x], gamma-[x], delta-[y]],
               ( findall(A, ( between(1, 4, _),
                              create([(main :- receive(_-go))], A, [host(alpha)]) ),
                         Agents),
                 fleet_drain(alpha, []),
                 findall(Name, ( member(A, Agents), agent_where(A, Host),
                                 atomic_list_concat([Name|_], @, Host) ),
                         Where0),
                 msort(Where0, Where),
                 up([beta,delta,gamma]) )).

test(agents_go_where_the_option_says, Name == delta) :-
    with_fleet([], _, [alpha-[x,y], beta-[x], delta-[y]],
               ( create([(main :- receive(_-go))], A, [host(alpha)]),
                 fleet_drain(alpha, [to(y)]),
                 agent_where(A, Host),
                 atomic_list_concat([Name|_], @, Host) )).

test(static_agents_stay_and_are_listed, Stay == [A]) :-
    with_fleet([], _, [alpha-[x], beta-[x]],
               ( create([(main :- receive(_-go))], A, [host(alpha), static(true)]),
                 create([(main :- receive(_-go))], _, [host(alpha)]),
                 fleet_drain(alpha, [stay(Stay)]),
                 up([beta]) )).

test(warning_lists_what_stays) :-
    with_fleet([], _, [alpha-[x], beta-[x]],
               ( create([(main :- receive(_-go))], A, [host(alpha), static(true)]),
                 capturing(fleet_drain(alpha, []), _),
                 assertion(was_printed(warning,
                                       typhon(fleet_drained(alpha, [A])))) )).

test(host_with_no_other_is_not_drained,
     throws(error(resource_error(hosts(x)), _))) :-
    with_fleet([], _, [alpha-[x], beta-[y]],
               call_cleanup(fleet_drain(alpha, []), up([alpha,beta]))).

test(nothing_chooses_a_drained_host,
     throws(error(resource_error(hosts(x)), _))) :-
    with_fleet([], _, [alpha-[x], beta-[y]],
               ( fleet_drain(alpha, [to(y)]),
                 create([(main :- true)], _, [host(any(x))]) )).

wrong(fleet_drain(nowhere, []), existence_error(host, nowhere)).
wrong(fleet_drain(beta, []), existence_error(fleet_of_host, beta)).
wrong(fleet_drain(alpha, [too(x)]), domain_error(drain_option, too(x))).

test(wrong, [forall(wrong(Goal, Formal)), throws(error(Formal, _))]) :-
    with_fleet([], _, [alpha-[x]],
               setup_call_cleanup(host_start(beta), Goal, host_stop(beta))).

:- end_tests(drain).

:- begin_tests(registry).

test(agent_is_found_without_its_home, Host == Alpha) :-
    with_fleet([report(0.2)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [], [], Beta),
                 address(alpha, Alpha),
                 with_peers([Beta],
                            ( traveller(Alpha, Agent),
                              peer_kill(beta),
                              agent_where(Agent, Host) )) )).

%   Also if the engine has not learnt yet where the agent is, and when it is gone.

test(outcome_and_results_outlive_the_home,
     [ forall(member(Report, [0.2, 600])),
       true(Outcome-Result == done-2) ]) :-
    with_fleet([report(Report)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [], [], Beta),
                 address(alpha, Alpha),
                 with_peers([Beta],
                            ( traveller(Alpha, Agent),
                              peer_kill(beta),
                              agent_join(Agent, timeout, 0.1),
                              agent_send(Agent, go),
                              agent_join(Agent, done, 30),
                              redis_signal(Redis, kill),
                              agent_join(Agent, Outcome, 30),
                              agent_result(Agent, Result, 30) )) )).

test(engine_that_lost_all_knows_agents_and_ends_again, Host-Outcome == Alpha-done) :-
    with_fleet([report(0.2)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [], [], Beta),
                 address(alpha, Alpha),
                 with_peers([Beta],
                            ( traveller(Alpha, Agent),
                              traveller(Alpha, Other),
                              peer_kill(beta),
                              agent_send(Other, go),
                              agent_join(Other, done, 30),
                              wait_until(test_takeover:stored(Redis, Agent), 30),
                              redis_empty(Redis),
                              typhon_members:fleet_beat(lab),
                              wait_until(test_takeover:stored(Redis, Agent), 30),
                              agent_where(Agent, Host),
                              wait_until(test_takeover:ended(Other, Outcome),
                                         30) )) )).

test(agent_that_no_fleet_knows,
     throws(error(existence_error(agent, 'no.1@x@127.0.0.1:1'), _))) :-
    with_fleet([], _, [alpha-[]], agent_where('no.1@x@127.0.0.1:1', _)).

:- end_tests(registry).

:- begin_tests(takeover).

test(killed_process_goes_on_in_a_stand_in) :-
    with_fleet([recover(true)], Redis, [alpha-[]],
               counting(Redis, Agent,
                        ( peer_kill(beta), stands_in(Redis, Agent) ))).

%   One that was suspended meanwhile sends nothing more, and ends with status 75.

test(suspended_process_is_fenced) :-
    with_fleet([recover(true)], Redis, [alpha-[]],
               counting(Redis, Agent,
                        ( peer_signal(beta, stop),
                          stands_in(Redis, Agent),
                          peer_signal(beta, cont),
                          beats(beta),
                          peer_ends(beta, Status),
                          assertion(Status == exit(75)),
                          asked(Agent, 4) ))).

%   The engine has the address of the stand-in, at which no process has listened
%   before.

test(stand_in_is_reached_by_a_member_that_joins_later, Result == none) :-
    with_fleet([recover(true)], Redis, [alpha-[]],
               counting(Redis, Agent,
                        ( peer_kill(beta),
                          stands_in(Redis, Agent),
                          member_spec(Redis, gamma, [], [], Gamma),
                          test_peers:start(Gamma),
                          peer_host(beta, Host),
                          moved(gamma, Host, Result) ))).

test(process_that_comes_back_in_time_keeps_its_journal) :-
    with_fleet([recover(true)], Redis, [alpha-[]],
               counting(Redis, Agent,
                        ( peer_signal(beta, stop),
                          peer_host(beta, Host),
                          lease_lapses(Redis, Host),
                          are_up([alpha]),
                          peer_signal(beta, cont),
                          beats(beta),
                          up([alpha,beta]),
                          asked(Agent, 2) ))).

test(command_starts_a_stand_in_with_endpoint_and_journal, Text == Wanted) :-
    with_tmp_dir(Dir, told_command(Dir, Text, Wanted)).

told_command(Dir, Text, Wanted) :-
    directory_file_path(Dir, told, File),
    format(atom(Script), 'echo "$1 $2" > ~w.new && mv ~w.new ~w',
           [File, File, File]),
    Command = [sh, '-c', Script, sh, '{endpoint}', 'j={journal}'],
    with_fleet([recover(Command)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [],
                             [journal(redis('lab/beta'))], Beta),
                 with_peers([Beta],
                            ( up([alpha,beta]),
                              peer_host(beta, Host),
                              peer_kill(beta),
                              lease_lapses(Redis, Host),
                              journal_lapses(Redis, Host),
                              wait_until(exists_file(File), 60) )) )),
    read_file_to_string(File, Text, []),
    atomic_list_concat([_,Endpoint], @, Host),
    format(string(Wanted), '~w j=beta~n', [Endpoint]).

:- end_tests(takeover).
