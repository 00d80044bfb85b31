:- module(test_overview, []).

% The overview before events arrive, and the same events in a log.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, min_list/2, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/watch), [overview/3]).

:- dynamic told/1.

note(Event) :-
    assertz(test_overview:told(Event)).

:- begin_tests(overview).

test(hosts_and_agents) :-
    with_hosts([alpha-[capacity(5), tokens([secret])], beta], seen).

seen :-
    address(alpha, Alpha),
    address(beta, Beta),
    link(alpha, beta, [cost(3)]),
    create([on_message(_, _)], A, [host(alpha), tokens([secret])]),
    overview([alpha, beta], [process(_, Pid, Hosts, Agents)], []),
    current_prolog_flag(pid, Me),
    assertion(Pid == Me),
    assertion(Hosts = [ host(Alpha, _, 1, [capacity(5)], [Beta-3]),
                        host(Beta, _, 0, [], [Alpha-3]) ]),
    assertion(Agents = [agent(A, Alpha, test, resident, 0)]),
    overview(beta, [process(_, _, OnlyBeta, None)], []),
    assertion(OnlyBeta = [host(Beta, _, 0, [], _)]),
    assertion(None == []).

test(all_processes_of_a_network) :-
    no_leaks(( network_start(ring(6), Network, [processes(3)]),
               network_property(Network, hosts(All)),
               overview(Network, Processes, Silent),
               network_property(Network, processes(Pids)),
               network_stop(Network) )),
    assertion(Silent == []),
    findall(Pid, member(process(_, Pid, _, _), Processes), Seen),
    assertion(subtract(Pids, Seen, [])),
    findall(Host, ( member(process(_, _, Hosts, _), Processes),
                    member(host(Host, _, _, _, [_, _]), Hosts) ), Found0),
    msort(Found0, Found),
    assertion(Found == All).

test(silent_process, Silent == [Endpoint]) :-
    no_leaks(( network_start(ring(4), Network, [processes(2)]),
               network_property(Network, hosts([_, _, _, H4])),
               atomic_list_concat([_, Endpoint], @, H4),
               network_property(Network, processes([_, Pid])),
               capturing(( process_kill(Pid, kill),
                           wait_until(network_property(Network, processes([_])),
                                      10),
                           overview(Network, [_], Silent),
                           network_stop(Network) ), _) )).

%   Agents travel while a watch begins: the overview and the later events lead
%   to the hosts on which they are in the end.

test(no_event_is_missed_after_the_overview) :-
    with_settings([ typhon_watches:last_seconds=20,
                    typhon_watch_senders:events=1 000 000 ],
                  with_hosts([alpha, beta], follow)).

follow :-
    findall(A, ( between(1, 20, _), wanderer(A) ), As),
    watch([alpha, beta], note, Watch),
    overview([alpha, beta], [process(_, _, Hosts, Agents)], []),
    forall(member(A, As), agent_send(A, rest)),
    wait_until(forall(member(A, As), state_of(A, resident)), 20),
    unwatch(Watch),
    findall(A-H, ( member(A, As), agent_property(A, host(H)) ), There),
    findall(A-H, ( member(A, As), followed(A, Hosts, Agents, H) ), Followed),
    assertion(There == Followed).

wanderer(A) :-
    create([ (main :- ( receive(_-rest, 0) -> true ; go, main )),
             (go :- here(H), other(H, O), move(O)),
             (other(H, O) :- ( sub_atom(H, 0, _, _, alpha)
                             -> O = beta ; O = alpha )),
             on_message(_, _) ],
           A, [host(alpha)]).

%   The hosts were read one after the other: events since the first was read
%   count, on all of them, or an older arrival would replace a newer one.

followed(A, Hosts, Agents, Host) :-
    (   memberchk(agent(A, Host0, _, _, _), Agents)
    ->  true
    ;   Host0 = none
    ),
    findall(Since, member(host(_, Since, _, _, _), Hosts), All),
    min_list(All, First),
    findall(Time-H, ( test_overview:told(event(Time, H, A, arrived(_, _))),
                      Time > First ), Later0),
    keysort(Later0, Later),
    (   append(_, [_-Last], Later)
    ->  Host = Last
    ;   Host = Host0
    ).

test(links_hosts_and_faults_in_the_log) :-
    no_leaks(with_tmp_dir(logged(Events))),
    findall(What, member(event(_, _, _, What), Events), Whats),
    assertion(memberchk(started, Whats)),
    assertion(memberchk(link(_), Whats)),
    assertion(memberchk(unlink(_), Whats)),
    assertion(memberchk(stopped, Whats)),
    assertion(memberchk(fault(fault(_, _, _, _)), Whats)).

logged(Events, Dir) :-
    directory_file_path(Dir, 'log.pl', File),
    network_start(line(2), Network,
                  [ clock(virtual), log(File, [hosts, links, faults]) ]),
    network_property(Network, hosts([H1, H2])),
    unlink(H1, H2),
    capturing(( create([(main :- foo(_) is _)], A, [host(H1)]),
                joined(A, raised(_)) ), _),
    network_stop(Network),
    log_events(File, Events).

:- end_tests(overview).
