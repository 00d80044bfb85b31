:- module(test_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [intersection/3, member/2, nth1/3]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_keys_values/3]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module('../../lib/virtual_networks', [network_shape/5]).

:- meta_predicate quiet(0).

%   Messages that a test provokes are not printed.

quiet(Goal) :-
    capturing(Goal, _).

printed(Message) :-
    was_printed(_, typhon(Message)).

alive(Pid) :-
    \+ is_dead(Pid).

ended(Pids) :-
    \+ ( member(Pid, Pids), alive(Pid) ).

hosts(Network, Hosts) :-
    network_property(Network, hosts(Hosts)).

pids(Network, Pids) :-
    network_property(Network, processes(Pids)).

:- begin_tests(networks).

test(in_one_process) :-
    network_shape(grid(6, 10), [], _, _, Edges),
    with_network(grid(6, 10), [], Network, Hosts,
        ( current_prolog_flag(pid, Me),
          pids(Network, [Me]),
          length(Hosts, 60),
          maplist([Host, Name]>>atomic_list_concat([Name, _], @, Host),
                  Hosts, Names),
          findall(Name, ( between(1, 60, I), atom_concat(n, I, Name) ), Names),
          edges_are(Edges, Network),
          nth1(1, Hosts, First),
          nth1(2, Hosts, Second),
          nth1(11, Hosts, Below),
          host_property(n1, neighbours(Neighbours)),
          msort(Neighbours, Sorted),
          msort([Second, Below], Sorted),
          host_property(n1, address(First)) )).

%   edges_are(+Edges, +Network): Edges are pairs of positions among the hosts.

edges_are(Edges, Network) :-
    hosts(Network, Hosts),
    findall(A-B,
            ( member(I-J, Edges), nth1(I, Hosts, A), nth1(J, Hosts, B) ),
            Expected),
    network_property(Network, edges(Expected)).

test(in_four_processes, true(soon(Seconds, 30))) :-
    network_shape(grid(6, 10), [], _, _, Edges),
    elapsed(with_network(grid(6, 10), [processes(4)], Network, Hosts,
                         four(Edges, Network, Hosts)), Seconds).

four(Edges, Network, Hosts) :-
    current_prolog_flag(pid, Me),
    pids(Network, Pids),
    length(Pids, 4),
    sort(Pids, Distinct),
    length(Distinct, 4),
    \+ memberchk(Me, Pids),
    maplist(alive, Pids),
    edges_are(Edges, Network),
    maplist([Host, Endpoint]>>atomic_list_concat([_, Endpoint], @, Host),
            Hosts, Endpoints),
    pairs_keys_values(Pairs, Endpoints, Hosts),
    group_pairs_by_key(Pairs, Blocks),
    maplist([_-Block]>>length(Block, 15), Blocks),
    length(Blocks, 4),
    nth1(15, Hosts, Last),
    nth1(16, Hosts, Next),
    call_cleanup(host_property(Last, neighbours(Ns)), Det = true),
    assertion(Det == true),
    memberchk(Next, Ns),
    host_property(Next, neighbours(Back)),
    memberchk(Last, Back).

test(every_topology,
     forall(member(T, [star_bus(3,4), ring(7), tree(7), grid(2,3), mesh(6),
                       random(8, 0.4), edges([a-b, b-3])]))) :-
    network_shape(T, [seed(5)], _, _, Edges),
    with_network(T, [seed(5)], Network,
                 edges_are(Edges, Network)).
test(agents_travel_over_the_whole_network, Count == 12) :-
    with_network(ring(12), [processes(3)], Network, round_trip(Count, Network)).

round_trip(Count, Network) :-
    hosts(Network, [First|_]),
    agent_create(clauses([ (:- agent(rounder, [state([at/1])])),
                           ( main :- neighbours([_|_]), here(H),
                                     assertz(at(H)), step(12) ),
                           ( step(0) :- !, findall(H, at(H), Hs),
                                        sort(Hs, Set), length(Set, N),
                                        leave(round(N)) ),
                           ( step(N) :- next(H), move(H),
                                        assertz(at(H)), N1 is N - 1,
                                        step(N1) ),
                           ( next(H) :- neighbours(Hs), member(H, Hs),
                                        \+ at(H), ! ),
                           ( next(H) :- home(H) ) ]),
                 Agent, [host(First)]),
    agent_join(Agent, done, 20),
    remote(First, take(round(Count))).

test(agents_of_a_network) :-
    with_network(ring(2), [], Network, Hosts, census(Network, Hosts)).

%   An agent and its clone are created on A, and stay on B until they get `go`;
%   a visitor from a host outside the network is with them. The network has
%   agents until they have ended.

census(Network, [A, B]) :-
    with_hosts([elsewhere],
        ( agent_create(clauses([ (:- agent(twin, [])),
                                 ( main :- neighbours([B]), clone(_), move(B),
                                           self(Me), leave(here(Me)),
                                           receive(_-go) ) ]),
                       Agent, [host(A)]),
          agent_create(clauses([ (:- agent(visitor, [])),
                                 ( main :- move(B), leave(visitor),
                                           receive(_-go) ) ]),
                       Visitor, [host(elsewhere)]),
          wait_until(remote(B, take(visitor)), 5),
          wait_until(remote(B, take(here(One))), 5),
          wait_until(remote(B, take(here(Two))), 5),
          network_property(Network, agents(Agents)),
          msort(Agents, Sorted),
          msort([One, Two], Sorted),
          forall(member(Id, [Agent, Visitor]), gone(Id)),
          network_property(Network, agents([Clone])),
          gone(Clone) )),
    network_property(Network, agents([])).

gone(Agent) :-
    agent_send(Agent, go),
    agent_join(Agent, done, 10).

%   There are no more processes than hosts, no command line or environment has
%   the cookie, and SIGINT ends the processes.

test(two_processes) :-
    quiet(with_network(ring(2), [processes(5), hosts([capacity(3)])],
                       Network, Hosts,
        ( pids(Network, Pids),
          assertion(length(Pids, 2)),
          forall(member(Host, Hosts),
                 assertion(host_property(Host, capacity(3)))),
          census(Network, Hosts),
          typhon_handshake:cookie(Cookie),
          forall(( member(Pid, Pids), member(Which, [cmdline, environ]) ),
                 ( format(atom(File), '/proc/~w/~w', [Pid, Which]),
                   read_file_to_string(File, Text, [encoding(octet)]),
                   \+ sub_string(Text, _, _, _, Cookie) )),
          forall(member(Pid, Pids), process_kill(Pid, int)),
          wait_until(ended(Pids), 10) ))).
test(two_networks_at_once, Both == []) :-
    with_network(ring(3), [processes(2)], _, HostsA,
        with_network(ring(3), [processes(2)], _, HostsB,
                     intersection(HostsA, HostsB, Both))).
%   A setup leaves signals pending.

test(network_with_restart_starts_in_a_setup) :-
    thread_create(started_in_a_setup, Thread),
    wait_until(\+ thread_property(Thread, status(running)), 60),
    thread_join(Thread, true).

started_in_a_setup :-
    thread_self(Me),
    setup_call_cleanup(
        ( thread_signal(Me, true),
          network_start(ring(2), Network, [processes(2), restart(true)]) ),
        true,
        network_stop(Network)).

:- end_tests(networks).

:- begin_tests(network_time).

%   At least one of ten hops is not delayed by other work.

test(hop_time, true(( Least >= 1, Least < 4 ))) :-
    with_network(ring(2),
                 [processes(2), clock(10), hop_time(uniform(1, 2))], Network,
        ( hosts(Network, [A, B]),
          agent_create(clauses([ (:- agent(hopper, [])),
                                 ( main :- home(A), neighbours([B]),
                                           hops(5, B, A, Times),
                                           min_list(Times, Least),
                                           leave(least(Least)) ),
                                 hops(0, _, _, []),
                                 ( hops(N, B, A, [T1,T2|Ts]) :-
                                       N > 0, hop(B, T1), hop(A, T2),
                                       N1 is N - 1, hops(N1, B, A, Ts) ),
                                 ( hop(To, T) :- now(T0), move(To), now(T1),
                                                 T is T1 - T0 ) ]),
                       Agent, [host(A)]),
          agent_join(Agent, done, 20),
          remote(A, take(least(Least))),
          nonvar(B) )).

:- end_tests(network_time).

:- begin_tests(network_log).

%   Each agent reads its host's clock between two readings of the machine's
%   clock. If all clocks were started at one time, that is after the latest
%   start that the first readings imply, and before the earliest that the
%   second readings imply. Then they log much, and others stay.

test(one_log_and_one_clock_for_all_hosts) :-
    get_time(T0),
    with_logged_network(ring(4), [processes(2), clock(20)], Hosts, File,
        ( network_property(_, log(File)),
          on_each(Hosts, [ (:- agent(clock, [])),
                           ( main :- get_time(Before), now(T), get_time(After),
                                     log(at(Before, T, After)) ) ], Clocks),
          all_end(Clocks),
          get_time(T1),
          flood(Hosts),
          on_each(Hosts, [(:- agent(resident, [])), main, on_message(_, _)],
                  _) ), Events),
    findall(Time-At, ( member(event(Time, _, _, At), Events),
                       At = at(_, _, _) ), Told),
    length(Told, 4),
    aggregate_all(max(Before-Now/20), member(_-at(Before, Now, _), Told),
                  Latest),
    aggregate_all(min(After-Now/20), member(_-at(_, Now, After), Told),
                  Earliest),
    Latest < Earliest+0.001,
    Latest > T0,
    Most is (T1-T0)*20,
    forall(member(Time-at(_, Now, _), Told),
           ( Now > 0, Time >= Now, Time < Most )),
    all_numbers(Events, 2000),
    aggregate_all(count, member(event(_, _, _, ended(_)), Events), Ends),
    assertion(Ends == 12).              % four of the residents
test(no_event_is_lost_within_a_process) :-
    with_logged_network(ring(1), [], Hosts, _, flood(Hosts), Events),
    all_numbers(Events, 500).

on_each(Hosts, Clauses, Agents) :-
    findall(Agent, ( member(Host, Hosts),
                     agent_create(clauses(Clauses), Agent, [host(Host)]) ),
            Agents).

all_end(Agents) :-
    forall(member(Agent, Agents), agent_join(Agent, done, 20)).

flood(Hosts) :-
    on_each(Hosts, [ (:- agent(talker, [])),
                     ( main :- forall(between(1, 500, N), log(n(N))) ) ],
            Agents),
    all_end(Agents).

all_numbers(Events, Count) :-
    findall(A-N, member(event(_, _, A, n(N)), Events), Pairs),
    sort(Pairs, Distinct),
    assertion(length(Pairs, Count)),
    assertion(length(Distinct, Count)).

:- end_tests(network_log).

:- begin_tests(network_ends).

test(stopped_twice, error(existence_error(network, _))) :-
    network_start(ring(2), Network, []),
    network_stop(Network),
    network_stop(Network).
test(other_hosts_remain) :-
    with_hosts([bystander],
               ( with_network(ring(2), [], _, [_|_], true),
                 host_property(bystander, state(running)) )).
test(dead_process_is_noticed_and_all_end_at_the_stop) :-
    quiet(with_network(ring(8), [processes(4)], Network,
        ( pids(Network, Pids),
          Pids = [Pid|_],
          process_kill(Pid, kill),
          wait_until(( pids(Network, Rest), length(Rest, 3) ), 5),
          wait_until(printed(node_down(Network, Pid, killed(9), _, _)), 5) ))),
    ended(Pids),
    \+ network_property(_, hosts(_)).
test(warning_names_hosts_and_agents_of_a_dead_process) :-
    with_hosts([bystander],
        quiet(with_network(ring(4), [processes(2)], Network, [First,_,Third|_],
            ( Program = clauses([(:- agent(still, [])), on_message(_, _)]),
              agent_create(Program, There, [host(bystander)]),
              agent_create(Program, Other, [host(bystander)]),
              agent_create(Program, _, [host(First)]),
              agent_move(There, First, [wait(10)]),
              agent_move(Other, Third, [wait(10)]),
              wait_until(agent_property(There, host(First)), 5),
              pids(Network, [Pid|_]),
              process_kill(Pid, kill),
              wait_until(printed(node_down(Network, Pid, killed(9), _, _)), 5),
              printed(node_down(Network, Pid, _, Hosts, Agents)),
              assertion(Hosts == [n1, n2]),
              assertion(Agents == [There]) )))).
test(warning_names_ten_hosts_and_counts_the_others) :-
    numlist(1, 12, Hosts),
    Message = typhon(node_down(network0, 7, killed(9), Hosts, [bob])),
    message_text(Message, Text),
    split_string(Text, "\n", "", Parts),
    assertion(Parts = [ "Process 7 of network0 ended: killed(9)",
                        "  its hosts: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more",
                        "  agents of this process that were there: bob"|_ ]).

%   If links change, a change soon waits for the hanging process.

test(hanging_process,
     [ forall(member(Dynamic, [[], [ clock(1000),
                                     dynamic(links(uniform(1,1), 1, 1)) ]])),
       true(soon(Seconds, 20)) ]) :-
    quiet(elapsed(with_settings([typhon_children:stop_seconds=1],
                                with_network(ring(8), [processes(4)|Dynamic],
                                             Network, freeze(Network))),
                  Seconds)),
    once(printed(node_killed(_, _))).

freeze(Network) :-
    pids(Network, [_, Pid|_]),
    process_kill(Pid, stop).

test(hanging_process_is_killed_soon, true(soon(Seconds, 10))) :-
    quiet(with_network(ring(4), [processes(4)], Network, [A,B|_],
        ( agent_create(clauses([ (:- agent(busy, [])),
                                 ( main :- move(B), move(A), main ) ]),
                       _, [host(A)]),
          freeze(Network),
          elapsed(network_stop(Network), Seconds) ))).

%   The end of the output and the signal race.

test(every_killed_process_is_noticed) :-
    quiet(with_network(ring(5), [processes(5)], Network, all_killed(Network))).

all_killed(Network) :-
    pids(Network, Pids),
    forall(member(Pid, Pids), process_kill(Pid, kill)),
    forall(member(Pid, Pids),
           wait_until(printed(node_down(_, Pid, killed(9), _, _)), 20)).

test(busy_agent_does_not_delay_the_stop, true(soon(Seconds, 25))) :-
    Busy = [(:- agent(busy, [])), ( main :- repeat, fail )],
    Soon = set_setting(typhon_hosting:stop_seconds, 0.3),
    elapsed(with_network(ring(4), [processes(2)], _, Hosts,
                         forall(member(Host, Hosts),
                                ( remote(Host, Soon),
                                  agent_create(clauses(Busy), _,
                                               [host(Host)]) ))),
            Seconds).
test(children_end_when_their_parent_is_killed,
     forall(member(Signal, [kill, term]))) :-
    fresh(( network_start(ring(6), N, [processes(3)]),
            network_property(N, processes(P)),
            format("~q.~n", [P]), flush_output, thread_get_message(x) ), Args),
    with_swipl(Args, Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 term_string(Pids, Line),
                 maplist(alive, Pids),
                 process_kill(Pid, Signal) )),
    length(Pids, 3),
    wait_until(ended(Pids), 10).

%   fresh(+Goal, -Args): another process with the library runs Goal.

fresh(Goal, ['-f', none, '-p', Path, '-g', Text]) :-
    project_file(prolog, Library),
    format(atom(Path), 'library=~w', [Library]),
    format(atom(Text), '~q', [( use_module(library(typhon)), Goal )]).

test(failed_host_start_stops_the_network,
     error(domain_error(host_option, colour(red)))) :-
    no_leaks(catch(network_start(ring(4), _,
                                 [processes(2), hosts([colour(red)])]),
                   Error, true)),
    throw(Error).
test(failed_host_start_stops_the_network_within_a_process,
     error(permission_error(start, host, n3))) :-
    with_hosts([n3],
               ( no_leaks(catch(network_start(ring(4), _, []), Error, true)),
                 \+ ( host_property(Host, state(_)), Host == n1 ) )),
    throw(Error).
test(unreachable_machine, Text == "A process of the network ended before \c
                                   it was ready: exit(1)\n") :-
    catch(with_settings([typhon_children:ssh=false],
                        network_start(ring(4), _, [machines([nowhere])])),
          Error, true),
    message_text(Error, Text).

%   The goal is the setup of a cleanup, with a signal pending.

test(silent_machine, error(timeout_error(start, _))) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, rsh, Program),
          shell_script(Program, "exec sleep 60"),
          with_settings(
              [ typhon_processes:start_seconds=0.5,
                typhon_children:stop_seconds=0.5,
                typhon_children:ssh=Program ],
              quiet(setup_call_cleanup(
                        ( fill_atoms,
                          network_start(ring(4), _, [machines([nowhere])]) ),
                        true,
                        true))) )).

fill_atoms :-
    forall(between(1, 30000, N), atom_concat(test_network_, N, _)).

test(missing_program, error(existence_error(_, _))) :-
    with_settings([typhon_children:ssh=no_such_program],
                 network_start(ring(4), _, [machines([nowhere])])).
test(bad_arguments,
     [ forall(member(Goal-Formal,
                     [ network_start(torus(3), _, [])-
                       domain_error(topology, torus(3)),
                       network_property(atlantis, hosts(_))-
                       existence_error(network, atlantis) ])),
       error(Formal) ]) :-
    call(Goal).
test(network_is_named,
     [ forall(( member(Network-Formal,
                       [ _-instantiation_error, 7-type_error(atom, 7),
                         atlantis-existence_error(network, atlantis) ]),
                member(Goal, [ network_advance(Network, 1),
                               network_at(Network, 1, true),
                               network_save(Network, '/no/such/file') ]) )),
       error(Formal) ]) :-
    call(Goal).
test(bad_options,
     [ forall(member(Option-Formal,
                     [ colour(red)-domain_error(network_option, colour(red)),
                       processes(0)-type_error(positive_integer, 0),
                       clock(0)-domain_error(clock_rate, 0),
                       hop_time(3)-domain_error(hop_time, 3),
                       dynamic(chaos)-domain_error(dynamic_model, chaos) ])),
       error(Formal) ]) :-
    network_start(ring(3), _, [Option]).
test(output_of_children_is_printed) :-
    fresh(( network_start(ring(2), N, [processes(2)]),
            network_property(N, hosts([_,H])),
            agent_create(clauses([(:- agent(a, [])), (main :- writeln(hello))]),
                         A, [host(H)]),
            agent_join(A, _, 10), network_stop(N), halt ), Args),
    run_swipl(Args, [], exit(0), Text, _),
    sub_string(Text, _, _, _, "hello\n").

:- end_tests(network_ends).

:- begin_tests(dynamic_networks).

test(links_come_and_go) :-
    network_shape(grid(3, 3), [], _, _, Edges),
    with_network(grid(3, 3), [ processes(2), clock(50), seed(1),
                               dynamic(dynamic_1) ], Network, Hosts,
        ( changed(Network, Now),
          forall(member(A-B, Now),
                 ( nth1(I, Hosts, A), nth1(J, Hosts, B),
                   memberchk(I-J, Edges) )) )).

changed(Network, Now) :-
    network_property(Network, edges(Before)),
    wait_until(( network_property(Network, edges(Now)), Now \== Before ), 10).

test(isolated_host_keeps_its_agents_until_it_is_linked) :-
    with_network(mesh(4), [ processes(2), clock(50),
                            dynamic(links(uniform(1, 1), each(1), 0)) ],
                 Network,
        ( hosts(Network, [A, B|_]),
          wait_until(network_property(Network, edges([])), 10),
          agent_create(clauses([ (:- agent(prisoner, [])),
                                 ( main :- neighbours([H|_]), !, move(H),
                                           leave(escaped) ),
                                 ( main :- sleep(1), main ) ]),
                       Agent, [host(A)]),
          \+ agent_join(Agent, done, 0.5),
          agent_property(Agent, host(A)),
          free(Agent, A, B),
          remote(B, take(escaped)) )).

%   The link may be dropped again before the agent sees it.

free(Agent, A, B) :-
    link(A, B),
    agent_join(Agent, Outcome, 0.2),
    (   Outcome == done
    ->  true
    ;   free(Agent, A, B)
    ).

%   Which link goes first.

test(changes_follow_the_seed, A == B) :-
    first_to_go(A),
    first_to_go(B).

first_to_go(I-J) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'log.pl', File),
          with_network(ring(6), [ seed(3), clock(100), log(File, [links]),
                                  dynamic(links(uniform(10, 500), 1, 0)) ],
                       _, Hosts,
                       ( wait_until(( log_events(File, Events),
                                      memberchk(event(_, A, none, unlink(B)),
                                                Events) ), 20),
                         nth1(I, Hosts, A),
                         nth1(J, Hosts, B) )) )).

test(dead_process_does_not_stop_the_changes) :-
    quiet(with_network(mesh(8), [ processes(4), clock(100),
                                  dynamic(links(uniform(1, 2), 0.5, 0.5)) ],
                       Network,
        ( pids(Network, [Pid|_]),
          process_kill(Pid, kill),
          wait_until(printed(node_down(_, Pid, _, _, _)), 5),
          changed(Network, _) ))).

:- end_tests(dynamic_networks).
