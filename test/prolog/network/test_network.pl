:- module(test_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2, nth1/3]).
:- use_module(library(ordsets), [ord_subset/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module('../../lib/virtual_networks', [network_shape/5]).

:- meta_predicate
    quiet(0),
    seconds(0, -),
    nothing_left(0).

%   with_network(+Topology, +Options, :Goal): call(Goal, Network).

with_network(Topology, Options, Goal) :-
    with_network(Topology, Options, Network,
        once(call(Goal, Network))).

%   Messages that a test provokes are not printed.

:- dynamic expected/1, printed/1.
:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(typhon(Message), _, _) :-
    expected(Message),
    assertz(printed(Message)).

quiet(Goal) :-
    retractall(printed(_)),
    setup_call_cleanup(
        maplist([M]>>assertz(expected(M)),
                [ node_down(_, _, _, _, _), node_killed(_, _),
                  node_order(_, _, _) ]),
        once(Goal),
        retractall(expected(_))).

%   As no_leaks/1, except for message queues: those of sessions are removed by
%   the garbage collector at any time.

nothing_left(Goal) :-
    things(Before),
    once(Goal),
    wait_until(none_but(Before), 5).

none_but(Before) :-
    things(Now),
    ord_subset(Now, Before).

things(Things) :-
    findall(Thing, thing(Thing), List),
    sort(List, Things).

thing(thread(Thread)) :-
    thread_property(Thread, status(_)),
    Thread \== gc.
thing(stream(Stream)) :-
    stream_property(Stream, mode(_)).
thing(process(Pids)) :-
    expand_file_name('/proc/self/task/*/children', Files),
    member(File, Files),
    catch(read_file_to_string(File, Pids, []), error(_, _), fail),
    Pids \== "".

alive(Pid) :-
    atom_concat('/proc/', Pid, Dir),
    exists_directory(Dir),
    atom_concat(Dir, '/stat', Stat),
    catch(read_file_to_string(Stat, Text, []), error(_, _), fail),
    split_string(Text, ")", "", Parts),
    last(Parts, Rest),
    split_string(Rest, " ", " ", [State|_]),
    State \== "Z".

ended(Pids) :-
    \+ ( member(Pid, Pids), alive(Pid) ).

hosts(Network, Hosts) :-
    network_property(Network, hosts(Hosts)).

pids(Network, Pids) :-
    network_property(Network, processes(Pids)).

seconds(Goal, Seconds) :-
    get_time(T0),
    once(Goal),
    get_time(T1),
    Seconds is T1 - T0.

hosts_there(Network) :-
    hosts(Network, [_|_]).

:- begin_tests(networks).

test(in_one_process) :-
    network_shape(grid(6, 10), [], _, _, Edges),
    nothing_left(with_network(grid(6, 10), [], Network,
        ( current_prolog_flag(pid, Me),
          pids(Network, [Me]),
          hosts(Network, Hosts),
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
          host_property(n1, address(First)) ))).

%   edges_are(+Edges, +Network): Edges are pairs of positions among the hosts.

edges_are(Edges, Network) :-
    hosts(Network, Hosts),
    findall(A-B,
            ( member(I-J, Edges), nth1(I, Hosts, A), nth1(J, Hosts, B) ),
            Expected),
    network_property(Network, edges(Expected)).

test(in_four_processes) :-
    network_shape(grid(6, 10), [], _, _, Edges),
    nothing_left(with_network(grid(6, 10), [processes(4)], Network,
        ( current_prolog_flag(pid, Me),
          pids(Network, Pids),
          length(Pids, 4),
          sort(Pids, Distinct),
          length(Distinct, 4),
          \+ memberchk(Me, Pids),
          maplist(alive, Pids),
          edges_are(Edges, Network),
          hosts(Network, Hosts),
          maplist([Host, Endpoint]>>atomic_list_concat([_, Endpoint], @, Host),
                  Hosts, Endpoints),
          blocks(Endpoints, Blocks),
          Blocks == [15, 15, 15, 15],
          nth1(15, Hosts, Last),
          nth1(16, Hosts, Next),
          call_cleanup(host_property(Last, neighbours(Ns)), Det = true),
          assertion(Det == true),
          memberchk(Next, Ns),
          host_property(Next, neighbours(Back)),
          memberchk(Last, Back) ))).

blocks([], []).
blocks([E|Es], [N|Ns]) :-
    run(Es, E, 1, N, Rest),
    blocks(Rest, Ns).

run([E|Es], E, N0, N, Rest) :-
    !,
    N1 is N0 + 1,
    run(Es, E, N1, N, Rest).
run(Es, _, N, N, Es).

test(every_topology,
     forall(member(T, [star_bus(3,4), ring(7), tree(7), grid(2,3), mesh(6),
                       random(8, 0.4), edges([a-b, b-3])]))) :-
    network_shape(T, [seed(5)], _, _, Edges),
    with_network(T, [processes(2), seed(5)], Network,
                 edges_are(Edges, Network)).
test(no_more_processes_than_hosts, Count == 2) :-
    network_start(ring(2), Network, [processes(5)]),
    pids(Network, Pids),
    length(Pids, Count),
    network_stop(Network).
test(starts_fast, true(Seconds < 30)) :-
    seconds(with_network(grid(6, 10), [processes(4)], Network,
                         hosts_there(Network)), Seconds).

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
                           ( step(N) :- next_host(conscientious, H), move(H),
                                        assertz(at(H)), N1 is N - 1,
                                        step(N1) ) ]),
                 Agent, [host(First)]),
    agent_join(Agent, done, 20),
    remote(First, take(round(Count))).

%   An agent and its clone are created on A, and stay on B until they get `go`;
%   a visitor from a host outside the network is with them.

test(network_runs_until_its_agents_end, forall(member(P, [1, 2]))) :-
    with_network(ring(2), [processes(P)], Network,
        ( setup_call_cleanup(
              host_start(elsewhere),
              visited(Network),
              host_stop(elsewhere)),
          network_property(Network, agents([])) )).

visited(Network) :-
    hosts(Network, [A, B]),
    agent_create(clauses([ (:- agent(twin, [])),
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
    all_agents(Network, [One, Two]),
    forall(member(Id, [Agent, Visitor]), gone(Id)),
    network_property(Network, agents([Clone])),
    gone(Clone).

all_agents(Network, Expected) :-
    network_property(Network, agents(Agents)),
    msort(Agents, Sorted),
    msort(Expected, Sorted).

gone(Agent) :-
    agent_send(Agent, go),
    agent_join(Agent, done, 10).

test(two_networks_at_once, true(Disjoint)) :-
    setup_call_cleanup(
        network_start(ring(3), A, [processes(2)]),
        with_network(ring(3), [processes(2)], Network,
                     other(A, Disjoint, Network)),
        network_stop(A)).

other(A, Disjoint, B) :-
    hosts(A, HostsA),
    hosts(B, HostsB),
    (   member(Host, HostsA),
        memberchk(Host, HostsB)
    ->  Disjoint = false
    ;   Disjoint = true
    ).

test(host_options) :-
    with_network(ring(2), [processes(2), hosts([capacity(3)])], Network,
                 capacity(3, Network)).

capacity(N, Network) :-
    hosts(Network, Hosts),
    forall(member(Host, Hosts), host_property(Host, capacity(N))).

test(machines_are_reached_by_a_program_like_ssh) :-
    with_tmp_dir(machines).

machines(Dir) :-
    directory_file_path(Dir, 'rsh', Program),
    shell_script(Program, "echo noise; shift; exec sh -c \"$*\""),
    with_settings([typhon_children:ssh=Program],
                 with_network(ring(5),
                              [ machines(['user@127.0.0.1',
                                          machine(other,
                                                  [bind('127.0.0.1')])]) ],
                              Network, spread(2, Network))).

spread(Count, Network) :-
    pids(Network, Pids),
    length(Pids, Count),
    edges_are([1-2, 1-5, 2-3, 3-4, 4-5], Network).

:- end_tests(networks).

:- begin_tests(network_time).

test(one_clock_for_all_hosts) :-
    with_tmp_dir(clocks).

%   Each agent reads its host's clock between two readings of the machine's
%   clock. If all clocks were started at one time, that is after the latest
%   start that the first readings imply, and before the earliest that the
%   second readings imply.

clocks(Dir) :-
    directory_file_path(Dir, log, File),
    get_time(T0),
    with_network(ring(4), [processes(2), clock(20), log(File)], Network,
                 tell_time(Network)),
    get_time(T1),
    log_events(File, Events),
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
           ( Now > 0, Time >= Now, Time < Most )).

tell_time(Network) :-
    hosts(Network, Hosts),
    findall(Agent,
            ( member(Host, Hosts),
              agent_create(clauses([ (:- agent(clock, [])),
                                     ( main :- get_time(Before), now(T),
                                               get_time(After),
                                               log(at(Before, T, After)) ) ]),
                           Agent, [host(Host)]) ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 10)).

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

test(no_event_is_lost, Counts == [2000, 2000]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, log, File),
          with_network(ring(4), [processes(2), log(File)], Network,
                       flood_all(File, Network)),
          log_events(File, Events),
          aggregate_all(count, member(event(_, _, _, n(_)), Events), Count),
          findall(A-N, member(event(_, _, A, n(N)), Events), Pairs),
          sort(Pairs, Distinct),
          length(Distinct, Count2),
          Counts = [Count, Count2] )).

flood_all(File, Network) :-
    network_property(Network, log(File)),
    hosts(Network, Hosts),
    findall(Agent,
            ( member(Host, Hosts),
              agent_create(clauses([ (:- agent(talker, [])),
                                     ( main :- forall(between(1, 500, N),
                                                      log(n(N))) ) ]),
                           Agent, [host(Host)]) ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 20)).

test(no_event_is_lost_within_a_process, Count == 500) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, log, File),
          with_network(ring(1), [log(File)], Network, flood_all(File, Network)),
          log_events(File, Events),
          aggregate_all(count, member(event(_, _, _, n(_)), Events), Count) )).
test(ends_of_resident_agents_are_logged, Ends == 4) :-
    with_tmp_dir(residents(Ends)).

residents(Ends, Dir) :-
    directory_file_path(Dir, log, File),
    with_network(ring(4), [processes(2), log(File)], Network, settle(Network)),
    log_events(File, Events),
    aggregate_all(count, member(event(_, _, _, ended(_)), Events), Ends).

settle(Network) :-
    hosts(Network, Hosts),
    forall(member(Host, Hosts),
           agent_create(clauses([ (:- agent(resident, [])),
                                  main,
                                  on_message(_, _) ]),
                        _, [host(Host)])).

:- end_tests(network_log).

:- begin_tests(network_ends).

test(stop_ends_the_processes, true) :-
    network_start(ring(8), Network, [processes(4)]),
    pids(Network, Pids),
    network_stop(Network),
    ended(Pids),
    \+ network_property(_, hosts(_)).
test(stopped_twice, error(existence_error(network, _))) :-
    network_start(ring(2), Network, []),
    network_stop(Network),
    network_stop(Network).
test(other_hosts_remain, true) :-
    setup_call_cleanup(
        host_start(bystander),
        ( with_network(ring(2), [], Network, hosts_there(Network)),
          host_property(bystander, state(running)) ),
        host_stop(bystander)).
test(dead_process, Count == 3) :-
    quiet(nothing_left(with_network(ring(8), [processes(4)], Network,
                                    bury(Count, Network)))).

bury(Count, Network) :-
    pids(Network, [Pid|_]),
    process_kill(Pid, kill),
    wait_until(( pids(Network, Rest), length(Rest, Count), Count < 4 ), 5),
    wait_until(printed(node_down(Network, Pid, killed(9), _, _)), 5).

test(warning_names_hosts_and_agents_of_a_dead_process) :-
    setup_call_cleanup(
        host_start(bystander),
        quiet(with_network(ring(4), [processes(2)], Network,
            ( network_property(Network, hosts([First, _, Third|_])),
              Program = clauses([(:- agent(still, [])), on_message(_, _)]),
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
              assertion(Agents == [There]) ))),
        host_stop(bystander)).
test(warning_names_ten_hosts_and_counts_the_others) :-
    numlist(1, 12, Hosts),
    Message = typhon(node_down(network0, 7, killed(9), Hosts, [bob])),
    phrase('$messages':translate_message(Message), Lines),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text, "\n", "", Parts),
    assertion(Parts = [ "Process 7 of network0 ended: killed(9)",
                        "  its hosts: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more",
                        "  agents of this process that were there: bob"|_ ]).

%   If links change, a change soon waits for the hanging process.

test(hanging_process,
     [ forall(member(Dynamic, [[], [ clock(1000),
                                     dynamic(links(uniform(1,1), 1, 1)) ]])),
       true(Seconds < 20) ]) :-
    quiet(nothing_left(seconds(with_settings(
                [typhon_children:stop_seconds=1],
                with_network(ring(8), [processes(4)|Dynamic], Network,
                             freeze(Network))),
                               Seconds))),
    once(printed(node_killed(_, _))).

freeze(Network) :-
    pids(Network, [_, Pid|_]),
    process_kill(Pid, stop).

test(hanging_process_is_killed_soon, true(Seconds < 10)) :-
    quiet(nothing_left(( network_start(ring(4), Network, [processes(4)]),
                         go_round(Network),
                         freeze(Network),
                         seconds(network_stop(Network), Seconds) ))).

go_round(Network) :-
    hosts(Network, [A,B|_]),
    agent_create(clauses([ (:- agent(busy, [])),
                           ( main :- round(A, B) ),
                           ( round(X, Y) :- move(X), move(Y), round(X, Y) )
                         ]), _, [host(A)]).

%   The end of the output and the signal race.

test(every_killed_process_is_noticed, forall(member(_, [1, 2, 3, 4]))) :-
    quiet(with_network(ring(5), [processes(5)], Network, all_killed(Network))).

all_killed(Network) :-
    pids(Network, Pids),
    forall(member(Pid, Pids), process_kill(Pid, kill)),
    forall(member(Pid, Pids),
           wait_until(printed(node_down(_, Pid, killed(9), _, _)), 20)).

test(busy_agent_does_not_delay_the_stop, true(Seconds < 25)) :-
    nothing_left(seconds(with_network(ring(4), [processes(2)], Network,
                                      busy(Network)),
                         Seconds)).

busy(Network) :-
    hosts(Network, Hosts),
    forall(member(Host, Hosts),
           agent_create(clauses([ (:- agent(busy, [])),
                                  ( main :- repeat, fail ) ]),
                        _, [host(Host)])).

test(children_end_on_sigterm, true) :-
    quiet(with_network(ring(2), [processes(2)], Network,
        ( pids(Network, Pids),
          forall(member(Pid, Pids), process_kill(Pid, term)),
          wait_until(ended(Pids), 10) ))).
test(children_end_when_their_parent_is_killed,
     forall(member(Signal, [kill, term]))) :-
    project_file(prolog, Library),
    format(atom(Path), 'library=~w', [Library]),
    Goal = 'use_module(library(typhon/network)),\c
            network_start(ring(6),N,[processes(3)]),\c
            network_property(N,processes(P)),\c
            format("~q.~n",[P]),flush_output,thread_get_message(x)',
    with_swipl(['-f', none, '-p', Path, '-g', Goal], Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 term_string(Pids, Line),
                 maplist(alive, Pids),
                 process_kill(Pid, Signal) )),
    length(Pids, 3),
    wait_until(ended(Pids), 10).
test(failed_host_start_stops_the_network,
     error(domain_error(host_option, colour(red)))) :-
    nothing_left(( catch(network_start(ring(4), _, [ processes(2),
                                                     hosts([colour(red)]) ]),
                         Error, true),
                   nonvar(Error) )),
    throw(Error).
test(failed_host_start_stops_the_network_within_a_process,
     error(permission_error(start, host, n3))) :-
    setup_call_cleanup(
        host_start(n3),
        nothing_left(( catch(network_start(ring(4), _, []), Error, true),
                       \+ own_host(n1) )),
        host_stop(n3)),
    throw(Error).
own_host(Name) :-
    host_property(Host, state(_)),
    Host == Name.

test(unreachable_machine,
     error(system_error(process_ended(exit(1))))) :-
    with_settings([typhon_children:ssh=false],
                 network_start(ring(4), _, [machines([nowhere])])).
test(silent_machine, error(timeout_error(start, _))) :-
    with_settings([typhon_processes:start_seconds=0.5],
        with_settings([typhon_children:stop_seconds=0.5],
            with_tmp_dir(silent))).

%   The goal is the setup of a cleanup, with a signal pending.

silent(Dir) :-
    directory_file_path(Dir, rsh, Program),
    shell_script(Program, "exec sleep 60"),
    with_settings([typhon_children:ssh=Program],
                 quiet(setup_call_cleanup(
                           ( fill_atoms,
                             network_start(ring(4), _,
                                           [machines([nowhere])]) ),
                           true,
                           true))).

fill_atoms :-
    forall(between(1, 30000, N), atom_concat(test_network_, N, _)).

test(missing_program, error(existence_error(_, _))) :-
    with_settings([typhon_children:ssh=no_such_program],
                 network_start(ring(4), _, [machines([nowhere])])).
test(options, [ forall(member(Option-Formal,
                              [ colour(red)-
                                domain_error(network_option, colour(red)),
                                processes(0)-type_error(positive_integer, 0),
                                clock(0)-domain_error(clock_rate, 0),
                                hop_time(3)-domain_error(hop_time, 3),
                                dynamic(chaos)-
                                domain_error(dynamic_model, chaos) ])),
                error(Formal) ]) :-
    network_start(ring(3), _, [Option]).
test(topology, error(domain_error(topology, torus(3)))) :-
    network_start(torus(3), _, []).
test(unknown_network, error(existence_error(network, atlantis))) :-
    network_property(atlantis, hosts(_)).
test(cookie_is_in_no_argument_list, true) :-
    typhon_handshake:cookie(Cookie0),
    format(string(Cookie), "~w", [Cookie0]),
    with_network(ring(2), [processes(2)], Network,
        ( pids(Network, Pids),
          forall(( member(Pid, Pids), member(Which, [cmdline, environ]) ),
                 ( format(atom(File), '/proc/~w/~w', [Pid, Which]),
                   read_file_to_string(File, Text, [encoding(octet)]),
                   \+ sub_string(Text, _, _, _, Cookie) )) )).
test(output_of_children_is_printed) :-
    project_file(prolog, Library),
    format(atom(Path), 'library=~w', [Library]),
    Goal = 'use_module(library(typhon)),use_module(library(typhon/network)),\c
            network_start(ring(2),N,[processes(2)]),\c
            network_property(N,hosts([_,H])),\c
            agent_create(clauses([(:-agent(a,[])),(main:-writeln(hello))]),\c
                         A,[host(H)]),\c
            agent_join(A,_,10),network_stop(N),halt',
    run_swipl(['-f', none, '-p', Path, '-g', Goal], [], exit(0), Text, _),
    sub_string(Text, _, _, _, "hello\n").

:- end_tests(network_ends).

:- begin_tests(dynamic_networks).

test(links_come_and_go, true) :-
    network_shape(grid(3, 3), [], _, _, Edges),
    with_network(grid(3, 3), [ processes(2), clock(50), seed(1),
                               dynamic(dynamic_1) ], Network,
                 changing(Edges, Network)).

changing(Edges, Network) :-
    network_property(Network, edges(Before)),
    wait_until(( network_property(Network, edges(Now)), Now \== Before ), 10),
    hosts(Network, Hosts),
    forall(member(A-B, Now),
           ( nth1(I, Hosts, A), nth1(J, Hosts, B),
             memberchk(I-J, Edges) )).

test(isolated_host_keeps_its_agents_until_it_is_linked) :-
    with_network(mesh(4), [ processes(2), clock(50),
                            dynamic(links(uniform(1, 1), each(1), 0)) ],
                 Network,
        ( hosts(Network, [A, B|_]),
          wait_until(network_property(Network, edges([])), 10),
          agent_create(clauses([ (:- agent(prisoner, [])),
                                 ( main :- next_host(random, H), !, move(H),
                                           leave(escaped) ),
                                 ( main :- sleep(1), main ) ]),
                       Agent, [host(A)]),
          \+ agent_join_soon(Agent),
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

agent_join_soon(Agent) :-
    agent_join(Agent, done, 0.5).

%   Which link goes first.

test(changes_follow_the_seed, A == B) :-
    with_tmp_dir(first_to_go(A)),
    with_tmp_dir(first_to_go(B)).

first_to_go(Link, Dir) :-
    directory_file_path(Dir, 'log.pl', File),
    with_network(ring(6), [ seed(3), clock(100), log(File, [links]),
                            dynamic(links(uniform(10, 500), 1, 0)) ],
                 Network, first_dropped(File, Link, Network)).

first_dropped(File, I-J, Network) :-
    wait_until(( log_events(File, Events),
                 memberchk(event(_, A, none, unlink(B)), Events) ), 20),
    hosts(Network, Hosts),
    nth1(I, Hosts, A),
    nth1(J, Hosts, B).

test(dead_process_does_not_stop_the_changes) :-
    quiet(with_network(mesh(8), [ processes(4), clock(100),
                                  dynamic(links(uniform(1, 2), 0.5, 0.5)) ],
                       Network, limping(Network))).

limping(Network) :-
    pids(Network, [Pid|_]),
    process_kill(Pid, kill),
    wait_until(printed(node_down(_, Pid, _, _, _)), 5),
    network_property(Network, edges(Before)),
    wait_until(( network_property(Network, edges(Now)), Now \== Before ), 10).

:- end_tests(dynamic_networks).
