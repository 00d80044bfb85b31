:- module(test_network_journal, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures', 
              [capturing/2, printed_message/2, with_hosts/2]).
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2, nth0/3, nth1/3, sum_list/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_codes/3, read_line_to_string/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/network/plan), []).

:- needs([journal]).

/** <module> Tests of networks that survive their processes
*/

:- meta_predicate
    network(+, +, +, -, -, 0),
    quiet(0).

%   network(+Dir, +Topology, +Options, -Network, -Hosts, :Goal): with a journal
%   in Dir.

network(Dir, Topology, Options, Network, Hosts, Goal) :-
    with_network(Topology, [journal(Dir)|Options], Network, Hosts, Goal).

%   Messages that a test provokes are not printed.

quiet(Goal) :-
    capturing(Goal, _).

printed(Message) :-
    printed_message(_, typhon(Message)).

pids(Network, Pids) :-
    network_property(Network, processes(Pids)).

kill(Network, I) :-
    pids(Network, Pids),
    nth1(I, Pids, Pid),
    process_kill(Pid, kill),
    wait_until(( pids(Network, Now), \+ memberchk(Pid, Now) ), 10).

%   The agent makes so many rounds, and counts at each host; the hosts count
%   visits.

walker(Program) :-
    walks([ (go(H) :- move(H)) ], Program).

%   A process that is killed with others may notice their death first.

patient(Program) :-
    walks([ (go(H) :- catch(( move(H), Where = there ),
                            error(host_unreachable(_), _),
                            Where = here),
                      gone(Where, H)),
            gone(there, _),
            (gone(here, H) :- sleep(0.05), go(H)) ], Program).

walks(Go,
      clauses([ (:- agent(walker, [state([made/1, todo/1, nap/1])])),
                 made(0),
                 (main :- made(N), todo(N), !, result(N)),
                 (main :- made(N), neighbours(Hosts),
                          length(Hosts, L), I is N mod L, nth0(I, Hosts, H),
                          go(H),
                          retract(made(_)), N1 is N+1, assertz(made(N1)),
                          ( take(visits(V)) -> true ; V = 0 ),
                          V1 is V+1, leave(visits(V1)),
                          ( nap(S) -> true ; S = 0.01 ),
                          sleep(S),
                          main)
                | Go ])).

walkers(Hosts, Hops, Agents) :-
    born(walker, Hosts, Hops, Agents).

born(Kind, Hosts, Hops, Agents) :-
    call(Kind, Program),
    findall(Agent,
            ( member(Host, Hosts),
              agent_create(Program, Agent, [host(Host), facts([todo(Hops)])]) ),
            Agents).

%   Each agent has ended once, with the right count, and the hosts' counts
%   agree.

all_arrived(Hosts, Hops, Agents) :-
    forall(member(Agent, Agents), agent_result(Agent, Hops, 60)),
    length(Agents, Count),
    Sum is Count*Hops,
    visits(Hosts, Sum).

visits(Hosts, Sum) :-
    findall(V,
            ( member(Host, Hosts),
              remote(Host, findall(V0, sense(visits(V0)), Vs)),
              member(V, Vs) ),
            Visits),
    sum_list(Visits, Sum).

:- begin_tests(network_journal).

test(agents_survive_killed_processes) :-
    quiet(with_tmp_dir(Dir,
        network(Dir, ring(4), [processes(2), restart(true)], Network, Hosts,
            ( network_property(Network, edges(Edges)),
              walkers(Hosts, 80, Agents),
              forall(member(I, [1, 2, 1]), kill(Network, I)),
              all_arrived(Hosts, 80, Agents),
              network_property(Network, hosts(Hosts)),
              network_property(Network, edges(Edges)),
              network_property(Network, agents([])) )))).
test(agents_survive_killed_processes_on_other_machines) :-
    quiet(with_tmp_dir(Dir,
        ( directory_file_path(Dir, rsh, Program),
          shell_script(Program, "echo noise; shift; exec sh -c \"$*\""),
          directory_file_path(Dir, journal, Journal),
          current_prolog_flag(executable, Swipl),
          Machines = machines([ machine('user@127.0.0.1', [swipl(Swipl)]),
                                machine(other, [ bind('127.0.0.2'),
                                                 swipl(Swipl) ]) ]),
          with_settings([typhon_children:ssh=Program],
              ( network(Journal, ring(4), [Machines, restart(true)], N, Hosts,
                        ( walkers(Hosts, 60, Agents),
                          forall(member(I, [1, 2]), kill(N, I)) )),
                network(Journal, ring(4), [], _, Hosts,
                        all_arrived(Hosts, 60, Agents)) )) ))).
test(stopped_network_resumes) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'log.pl', Log),
          Options = [processes(2), seed(7), log(Log, [hops])],
          network(Dir, ring(4), Options, N1, Hosts,
                  begun(N1, Hosts, Agents, Keeper, Edges, Time)),
          network(Dir, ring(4), [], N2, Hosts,
                  goes_on(N2, Hosts, Agents, Keeper, Edges, Time)),
          log_events(Log, Events) )),
    forall(member(Agent, Agents),
           ( findall(x, member(event(_, _, Agent, ended(done)), Events), [_]),
             findall(x, member(event(_, _, Agent, arrived(_, _)), Events),
                     Arrivals),
             length(Arrivals, Count),
             Count > 50 )).

begun(Network, Hosts, Agents, Keeper, Edges, Time) :-
    Hosts = [A, B, C|_],
    unlink(A, B),
    network_property(Network, edges(Edges)),
    walkers(Hosts, 60, Agents),
    agent_create(clauses([ (:- agent(keeper, [state([got/1])])),
                           (on_message(_, M) :- assertz(got(M))) ]),
                 Keeper, [host(A)]),
    agent_send(Keeper, one),
    agent_move(Keeper, C),
    remote(A, leave(here(f(_)))),
    remote(A, now(Time)).

goes_on(Network, Hosts, Agents, Keeper, Edges, Time) :-
    network_property(Network, edges(Edges)),
    network_property(Network, seed(7)),
    Hosts = [A, _, C|_],
    wait_until(agent_property(Keeper, host(C)), 10),
    agent_send(Keeper, two),
    remote(A, findall(F, sense(here(F)), [f(_)])),
    remote(A, now(Now)),
    Now > Time, Now < Time+100,
    all_arrived(Hosts, 60, Agents),
    wait_until(agent_property(Keeper, facts([got(one), got(two)])), 5).

test(processes_stop_after_all_agents_rest) :-
    with_tmp_dir(Dir,
        ( network(Dir, mesh(3), [processes(3)], _, Hosts,
                  sets_out(Hosts, Agents)),
          network(Dir, mesh(3), [], _, Hosts, pauses(Hosts)),
          network(Dir, mesh(3), [], _, Hosts,
                  ( forall(member(Agent, Agents), agent_join(Agent, done, 30)),
                    all_visits(All),
                    visits(Hosts, All) )) )).

sets_out(Hosts, Agents) :-
    walker(Program),
    findall(Agent,
            ( member(Host, Hosts),
              way(Hops, Nap),
              agent_create(Program, Agent,
                           [host(Host), facts([todo(Hops), nap(Nap)])]) ),
            Agents),
    wait_until(( visits(Hosts, Now), Now > 15 ), 20),
    ends_last(Hosts).

%   At any time of the stop some agents are about to leave.

way(Hops, Nap) :-
    between(1, 8, I),
    Hops is 1+8//I,
    Nap is 0.3*I.

pauses(Hosts) :-
    visits(Hosts, Before),
    all_visits(All),
    wait_until(( visits(Hosts, Now), Now >= min(All, Before+15) ), 20),
    ends_last(Hosts).

all_visits(All) :-
    aggregate_all(sum(3*Hops), way(Hops, _), All).

%   The second process ends only after the first, and notices its end soon.

ends_last([A, B|_]) :-
    atomic_list_concat([_, Endpoint], @, A),
    remote(B, settings:set_setting(typhon_connection_manager:connect_time, 0.2)),
    remote(B, \+ \+ thread_create(
                        with_mutex(typhon_hosting,
                                   ( repeat,
                                     system:sleep(0.02),
                                     typhon_peer_cache:endpoint_left(Endpoint),
                                     !,
                                     system:sleep(1) )), _, [detached(true)])).

test(network_with_a_hanging_and_a_dead_process_stops_soon,
     true(soon(Seconds, 12))) :-
    quiet(with_tmp_dir(Dir,
        ( network(Dir, mesh(4), [processes(4)], Network, Hosts,
              ( born(patient, Hosts, 30, Agents),
                wait_until(( visits(Hosts, Now), Now > 20 ), 20),
                pids(Network, [_, Dead, Hanging|_]),
                process_kill(Dead, kill),
                process_kill(Hanging, stop),
                get_time(T0),
                network_stop(Network),
                get_time(T1),
                Seconds is T1-T0 )),
          network(Dir, mesh(4), [], _, Hosts,
                  all_arrived(Hosts, 30, Agents)) ))).
test(killed_network_of_one_process_resumes,
     [forall(member(Processes, [1, 2]))]) :-
    with_tmp_dir(Dir,
        ( first_life(Dir, Processes, Hosts, Agents),
          network(Dir, ring(3), [], _, Hosts,
                  all_arrived(Hosts, 60, Agents)) )).

first_life(Dir, Processes, Hosts, Agents) :-
    project_file(prolog, Library),
    format(atom(Path), 'library=~w', [Library]),
    patient(Program),
    format(atom(Goal),
           'use_module(library(typhon)), ~q=Program, \c
            network_start(ring(3), N, [journal(~q), processes(~d)]), \c
            network_property(N, hosts(Hosts)), \c
            findall(A, ( member(H, Hosts), \c
                         agent_create(Program, A, [host(H), facts([todo(60)])]) ), \c
                    Agents), \c
            format("~~q.~~n", [Hosts-Agents]), flush_output, \c
            thread_get_message(x)', [Program, Dir, Processes]),
    with_swipl(['-f', none, '-p', Path, '-g', Goal], Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 term_string(Hosts-Agents, Line),
                 process_kill(Pid, kill) )).

test(stopped_network_in_this_process_ends_no_agent,
     Ends == [done]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'log.pl', Log),
          network(Dir, ring(2), [log(Log)], _, [Host|Others],
                  ( walkers([Host], 100, [Agent]),
                    wait_until(has_walked(Agent), 10) )),
          network(Dir, ring(2), [], _, [Host|Others],
                  ( has_walked(Agent),
                    all_arrived([Host|Others], 100, [Agent]) )),
          log_events(Log, Events) )),
    findall(End, member(event(_, _, Agent, ended(End)), Events), Ends).

%   Or the agent has arrived already.

has_walked(Agent) :-
    (   agent_property(Agent, hops(Hops))
    ->  Hops > 10
    ;   agent_join(Agent, done, 0)
    ).

%   Where links are only dropped, one that was dropped too late, while the
%   network was stopped, would remain.

test(changing_links_resume,
     [ forall(member(Drop-Add, [0.5-0.9, 0.3-0])), Edges == Expected ]) :-
    with_tmp_dir(Dir,
        ( Options = [ processes(2), seed(3), clock(20),
                      dynamic(links(uniform(6, 12), Drop, Add)) ],
          typhon_plan:network_plan(ring(6), Options, Plan),
          network(Dir, ring(6), Options, _, [Host|_],
                  wait_until(( remote(Host, now(Time)), Time > 12 ), 10)),
          network(Dir, ring(6), [], N, Hosts,
                  wait_until(as_it_would_be(N, Hosts, Plan, Edges, Expected),
                             20)) )).

as_it_would_be(Network, Hosts, Plan, Edges, Expected) :-
    Hosts = [Host|_],
    remote(Host, now(Before)),
    network_property(Network, edges(Edges)),
    remote(Host, now(After)),
    typhon_plan:plan_links_at(Plan, Before, Links),
    typhon_plan:plan_links_at(Plan, After, Links),
    findall(A-B,
            ( member(link(I, J, _), Links),
              nth1(I, Hosts, A), nth1(J, Hosts, B) ),
            Expected0),
    msort(Edges, Sorted),
    msort(Expected0, Sorted),
    Expected = Edges.

                /*******************************
                *            ERRORS            *
                *******************************/

refused(Dir, Topology, Options, Formal) :-
    contents(Dir, Before),
    network_error(Dir, Topology, Options, Formal),
    contents(Dir, Before).

network_error(Dir, Topology, Options, Formal) :-
    catch(no_leaks(network(Dir, Topology, Options, _, _, true)),
          error(Formal, _), true).

contents(Dir, Contents) :-
    findall(File-Codes,
            ( directory_member(Dir, File, [recursive(true)]),
              exists_file(File),
              read_file_to_codes(File, Codes, [type(binary)]) ),
            Contents0),
    msort(Contents0, Contents).

test(journal_of_another_network_is_not_touched,
     Formals =@= [ journal_of_another(D, shape(_, _), shape(_, _)),
                   journal_of_another(D, processes(2), processes(3)),
                   journal_of_another(D, no(clock), clock(2)),
                   domain_error(network_option, colour(red)) ]) :-
    with_tmp_dir(D,
        ( network(D, ring(3), [processes(2)], _, _, true),
          findall(Formal,
                  ( member(Topology-Options,
                           [ ring(4)-[], ring(3)-[processes(3)],
                             ring(3)-[clock(2)], ring(3)-[colour(red)] ]),
                    refused(D, Topology, Options, Formal0),
                    forgotten(Formal0, Formal) ),
                  Formals) )).

forgotten(journal_of_another(D, shape(_, _), shape(_, _)), Formal) =>
    Formal = journal_of_another(D, shape(_, _), shape(_, _)).
forgotten(Formal0, Formal) =>
    Formal = Formal0.

test(damaged_or_locked_journal_is_reported,
     Formals = [ journal_damaged(_, _), journal_damaged(_, _),
                 permission_error(open, journal, _) ]) :-
    with_settings([typhon_children:stop_seconds=1],
                 quiet(with_tmp_dir(no_good(Formals)))).

no_good([F1, F2, F3], Dir) :-
    network(Dir, ring(2), [processes(2)], _, _, true),
    directory_file_path(Dir, 'process2', Second),
    directory_file_path(Second, 'journal.db', File),
    directory_file_path(Dir, 'network.pl', Record),
    maplist(spoilt(Dir), [File, Record], [F1, F2]),
    project_file('prolog/typhon/options/journal/store.pl', Store),
    format(atom(Goal), 'journal_open(~q, normal), writeln(open), \c
                        flush_output, read(_)', [Second]),
    with_swipl(['-g', Goal, '-t', halt, Store], _, _, Out,
               ( read_line_to_string(Out, "open"),
                 network_error(Dir, ring(2), [], F3) )),
    network(Dir, ring(2), [], _, _, true).

%   The journal is restored afterwards.

spoilt(Dir, File, Formal) :-
    atom_concat(File, '.good', Good),
    rename_file(File, Good),
    setup_call_cleanup(open(File, write, Out),
                       forall(between(1, 3000, I), writeln(Out, f(I))),
                       close(Out)),
    read_file_to_codes(File, Before, [type(binary)]),
    network_error(Dir, ring(2), [], Formal),
    read_file_to_codes(File, Before, [type(binary)]),
    rename_file(Good, File).

test(journal_is_refused_in_virtual_time_and_beside_other_hosts,
     Formals-Whys == [ permission_error(open, journal, '/tmp/none'),
                       permission_error(open, journal, '/tmp/none/process1') ]-
                     [ 'not in virtual time',
                       'this process has hosts already' ]) :-
    start_error([journal('/tmp/none'), clock(virtual)], F1, W1),
    with_hosts([other], start_error([journal('/tmp/none')], F2, W2)),
    Formals = [F1, F2],
    Whys = [W1, W2].

start_error(Options, Formal, Why) :-
    catch(network_start(ring(2), _, Options),
          error(Formal, context(_, Why)), true).

test(journal_options_of_single_hosts_are_refused,
     Refused == [ hosts([journal(Dir)])-Whole,
                  hosts([capacity(3), sync(full)])-Whole,
                  sync(full)-'there is no journal(Directory)' ]) :-
    Whole = 'journal and sync are for the whole network, not for its hosts',
    with_tmp_dir(Tmp,
        ( directory_file_path(Tmp, none, Dir),
          findall(Option-Why,
                  ( member(Options,
                           [ [hosts([journal(Dir)])],
                             [ journal(Dir), processes(2),
                               hosts([capacity(3), sync(full)]) ],
                             [sync(full)] ]),
                    start_error(Options,
                                permission_error(set, network_option, Option),
                                Why) ),
                  Refused),
          assertion(\+ exists_directory(Dir)) )).

:- end_tests(network_journal).

:- begin_tests(network_restart).

test(hosts_restart_empty_without_a_journal) :-
    quiet(with_network(ring(4),
                       [processes(2), restart(true), places(leave(food))],
                       Network, Hosts,
        ( Hosts = [A, _, C|_],
          network_property(Network, edges(Edges)),
          forall(member(H, [A, C]), remote(H, leave(mine))),
          kill(Network, 1),
          network_property(Network, hosts(Hosts)),
          network_property(Network, edges(Edges)),
          maplist(facts, [A, C], [[food], [food, mine]]),
          agent_create(clauses([ (:- agent(visits, [])),
                                 (main :- neighbours([H|_]), move(H)) ]),
                       Agent, [host(A)]),
          agent_join(Agent, done, 10) ))).

%   A process that is stopped gets the question, and dies.  It alone knows the
%   link between its two hosts.

test(process_that_dies_with_a_question_is_asked_again) :-
    quiet(with_network(mesh(4), [processes(2), restart(true)], Network,
        ( network_property(Network, edges(Edges)),
          pids(Network, [Pid|_]),
          process_kill(Pid, stop),
          thread_create(network_property(Network, edges(Edges)), Asker),
          wait_until(typhon_nodes:waiting(Network, 1, _), 10),
          process_kill(Pid, kill),
          thread_join(Asker, true) ))).

facts(Host, Facts) :-
    remote(Host, findall(F, sense(F), Facts)).

test(network_is_saved_after_a_process_died) :-
    quiet(with_tmp_dir(Dir,
        ( directory_file_path(Dir, saved, File),
          network(Dir, ring(2), [processes(2), restart(true)], Network, _,
                  ( pids(Network, [_, Pid]),
                    process_kill(Pid, kill),
                    wait_until(printed(node_down(_, Pid, _, _, _)), 10),
                    network_save(Network, File) )),
          exists_file(File) ))).

%   The thread that restarts processes ends after the first restart.

test(deaths_are_counted_across_threads_and_a_process_is_given_up,
     true(Told-Ended = [node_given_up(_, 1, 2, 60)]-[_])) :-
    with_settings([typhon_restarts:restarts=2],
        quiet(with_network(ring(2), [processes(2), restart(true)], Network,
            ( kill(Network, 1),
              wakes([Thread]),
              thread_signal(Thread, throw('$aborted')),
              wait_until(printed(server_ended(_)), 10),
              kill(Network, 1),
              network_property(Network, hosts([_, _])),
              pids(Network, [Pid, Other]),
              process_kill(Pid, kill),
              wait_until(pids(Network, [Other]), 10),
              network_property(Network, hosts([_, _])) )))),
    findall(node_given_up(N, P, M, S),
            printed(node_given_up(N, P, M, S)), Told),
    findall(E, printed(server_ended(E)), Ended).

%   Other processes would wait for a minute for one that is started again.

test(processes_do_not_wait_for_one_that_is_given_up, true(nonvar(Formal))) :-
    with_settings([typhon_restarts:restarts=0],
        quiet(with_network(ring(2), [processes(2), restart(true)], Network, [A,B],
            ( pids(Network, [Pid|_]),
              process_kill(Pid, kill),
              wait_until(printed(node_given_up(_, _, _, _)), 10),
              agent_create(clauses([ (:- agent(visits, [state([to/1])])),
                                     to(A),
                                     (main :- to(H),
                                              catch(( move(H), E = none ),
                                                    error(E, _), true),
                                              result(E)) ]),
                           Agent, [host(B)]),
              agent_result(Agent, Formal, 20) )))).

%   wakes(-Threads): the threads that restart processes of networks.

wakes(Threads) :-
    findall(Thread,
            ( thread_property(Thread, alias(Alias)),
              atom_concat(typhon_restarts_, _, Alias) ),
            Threads).

test(network_is_stopped_during_a_restart) :-
    quiet(with_network(ring(3), [processes(3), restart(true)], Network,
        ( pids(Network, [Pid|_]),
          process_kill(Pid, kill),
          wait_until(printed(node_down(_, _, _, _, _)), 5),
          network_stop(Network) ))).

:- end_tests(network_restart).
