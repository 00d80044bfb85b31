:- module(test_saving, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2]).
:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(random), [random/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host), [address_parts/3]).
:- use_module(library(typhon/kernel/wire), [endpoint_address/1]).
:- use_module('../../../agents/allocation/operator',
              [robot_start/3, task_allocate/4]).
:- use_module('../../../agents/learning/operator', [learning_start/5]).
:- use_module('../../../agents/population/operator', [population_start/5]).
:- use_module('../../../agents/sieve/operator',
              [antigen_attack/2, sieve_start/3]).

/** <module> Networks that are saved, loaded and continue

*Threading*: one test at a time.
*/

:- meta_predicate
    with_file(-, 0),
    with_scenario(+, +, -, -, 0).

with_file(File, Goal) :-
    with_tmp_dir(Dir, ( atom_concat(Dir, '/file', File), Goal )).

                /*******************************
                *           SCENARIOS          *
                *******************************/

%   scenario(?Name, -Topology, -Options, -Seconds): a run in virtual time;
%   begun(+Name, +Network, +Hosts) starts it.

scenario(wanderers, grid(3, 3),
         [ hop_time(uniform(0.1, 0.9)), hosts([concurrency(1)]),
           dynamic(links(uniform(1, 3), 0.3, 0.5)), cost(uniform(1, 9)) ],
         20).
scenario(learners, mesh(5),
         [ hop_time(uniform(0.2, 0.4)), dynamic(dynamic_1),
           hosts([capacity(3)]) ],
         40).
scenario(population, ring(5), [hop_time(uniform(0.1, 0.3))], 30).
scenario(sieve, random(6, 0.4), [hop_time(uniform(0.1, 0.2))], 30).
scenario(allocation, ring(5), [hop_time(uniform(0.2, 0.4))], 60).

begun(wanderers, _, Hosts) :-
    forall(member(Host, Hosts), wanderer(Host)).
begun(learners, _, Hosts) :-
    learning_start(Hosts, payloads(learning/maze), [payloads(learning/greedy)],
                   [agents(3), seed(1), settings([size-5])], _).
begun(population, _, Hosts) :-
    population_start(house, Hosts, [floor-sleep(0.5), walls-sleep(0.5)],
                     [seed(1), settings([threshold-5, tick-0.5])], _).
begun(sieve, Network, Hosts) :-
    sieve_start(Hosts, payloads(sieve/bits), [settings([seed-1, omega-200])]),
    forall(member(Time-Antigen, [1-[1,0,1,1,0,1,0,0], 8-[1,1,1,1,0,0,0,0],
                                 15-[1,0,1,1,0,1,0,0]]),
           network_at(Network, Time, antigen_attack(Hosts, Antigen))).
begun(allocation, _, [A,_,B|Rest]) :-
    forall(member(Host, [A,B|Rest]), robot_start(Host, [push], [])),
    forall(member(Name-Host, [a-A, b-B]),
           task_allocate(task(Name, [3-[push]], []), Host,
                         [settings([seed-1, patience-200, monitor-100])], _)).

%   Clones, messages, random numbers, facts, choices, sleep, waiting, faults.

wanderer(Host) :-
    agent_create(clauses([ (:- agent(wanderer, [state([left/1])])),
                           left(8),
                           (main :- parent(P), !, send(P, hello), stroll),
                           (main :- stroll),
                           (stroll :- left(0), !),
                           (stroll :- retract(left(K)), K1 is K-1,
                                      assertz(left(K1)),
                                      random(X), log(drawn(X)),
                                      leave(was(K, X, "text", _)),
                                      next_step, part(K), stroll),
                           (next_step :- next_host(random, H), move(H), !),
                           (next_step :- sleep(1)),
                           (part(5) :- !, clone(_)),
                           (part(3) :- random(X), X < 0.1, !, fail),
                           (part(_) :- (   receive(From-Text, 0.5)
                                       ->  log(heard(From, Text))
                                       ;   true
                                       )) ]),
                 _, [host(Host)]).

%   with_scenario(+Name, +Log, -Network, -Seconds, :Goal)

with_scenario(Name, Log, Network, Seconds, Goal) :-
    scenario(Name, Topology, Options, Seconds),
    with_network(Topology,
                 [ clock(virtual), seed(3),
                   log(Log, [hops, messages, facts, faults, links, hosts])
                 | Options ], Network, Hosts,
                 ( begun(Name, Network, Hosts), Goal )).

%   whole(+Name, +Log, -Text): the log of an uninterrupted run.

whole(Name, Log, Text) :-
    with_scenario(Name, Log, Network, Seconds,
                  network_advance(Network, Seconds)),
    read_file_to_string(Log, Text, []).

%   resumed(+Times, +Now, +End, +Network, +File): a run that is saved at each of
%   Times, continues for a while, is stopped, and loaded.

resumed([], Now, End, Network, _) :-
    Seconds is End-Now,
    network_advance(Network, Seconds),
    network_stop(Network).
resumed([Time|Times], Now, End, Network, File) :-
    Seconds is Time-Now,
    network_advance(Network, Seconds),
    network_save(Network, File),
    network_advance(Network, 2),
    network_stop(Network),
    network_load(File, Next, []),
    resumed(Times, Time, End, Next, File).

                /*******************************
                *           REAL TIME          *
                *******************************/

%   Walkers send a number at each hop to an agent that moves, too, and counts
%   the numbers that it receives: at each moment all sent numbers are counted,
%   in its mailbox, or waiting for it.

walker(Host, Box) :-
    agent_create(clauses([ (:- agent(walker, [state([n/1, box/1])])),
                           n(0),
                           (main :- next_host(random, H), move(H),
                                    retract(n(N)), N1 is N+1, assertz(n(N1)),
                                    box(B), send(B, m(N1)), rest(N1), main),
                           (rest(N) :- N mod 5 =:= 0, !, sleep(0.01)),
                           rest(_) ]),
                 _, [host(Host), facts([box(Box)])]).

box(Host, Box) :-
    agent_create(clauses([ (:- agent(box, [state([got/1])])),
                           got(0),
                           (main :- (   receive(_-m(_), 0.005)
                                    ->  retract(got(N)), N1 is N+1,
                                        assertz(got(N1)),
                                        (   N1 mod 20 =:= 0
                                        ->  hop
                                        ;   true
                                        )
                                    ;   hop
                                    ),
                                    main),
                           (hop :- next_host(random, H), move(H)) ]),
                 Box, [host(Host)]).

traffic(Network) :-
    network_property(Network, hosts([First|Hosts])),
    box(First, Box),
    forall(member(Host, [First|Hosts]), walker(Host, Box)).

%   saved(+Network, +File, -Sent, -Got): the numbers of messages that saved
%   agents have sent and received.

saved(Network, File, Agents, Sent, Got) :-
    network_save(Network, File),
    typhon_saving:saved_read(File, Terms),
    findall(Facts,
            member(_:item(stands, _, _, agent(_, _, _, state(_, Facts), _, _)),
                   Terms),
            All),
    length(All, Agents),
    aggregate_all(sum(N), ( member(Facts, All), member(n(N), Facts) ), Sent),
    aggregate_all(sum(N), ( member(Facts, All), member(got(N), Facts) ), Had),
    aggregate_all(count, member(_:item(mail, _, _, _), Terms), Mail),
    aggregate_all(count,
                  ( member(_:item(backlog, _, _, Letters), Terms),
                    member(letter(Some, _), Letters), member(_, Some) ),
                  Wait),
    Got is Had+Mail+Wait.

all_there(Network, File, Count, Sent) :-
    saved(Network, File, Agents, Sent, Got),
    assertion(Agents-Got == Count-Sent).

consistent(Options, File) :-
    with_network(mesh(5), Options, Network,
                 ( traffic(Network),
                   beside_another(Network, File,
                       forall(between(1, 4, _),
                              ( pause(0.05),
                                all_there(Network, File, 6, _) ))) )),
    with_loaded_network(File, Again,
                        ( pause(0.3),
                          all_there(Again, File, 6, Sent),
                          wait_until(( all_there(Again, File, 6, More),
                                       More > Sent ), 20) )).

%   beside_another(+Network, +File, :Goal): another thread saves meanwhile.

:- meta_predicate beside_another(+, +, 0).

beside_another(Network, File, Goal) :-
    atom_concat(File, '.other', Other),
    message_queue_create(Ends),
    setup_call_cleanup(
        thread_create(saves(Network, Other, Ends), Thread),
        once(Goal),
        ( thread_send_message(Ends, end), thread_join(Thread, true) )),
    message_queue_destroy(Ends).

saves(Network, File, Ends) :-
    network_save(Network, File),
    (   thread_peek_message(Ends, end)
    ->  true
    ;   saves(Network, File, Ends)
    ).

pause(Seconds) :-
    thread_self(Me),
    \+ thread_get_message(Me, '$never', [timeout(Seconds)]).

raised(Goal, Name) :-
    catch(Goal, error(Formal, _), true),
    functor(Formal, Name, _).

:- meta_predicate raised(0, -).

:- begin_tests(real_networks_are_saved).

test(each_checkpoint_is_consistent, [forall(member(P, [1,3]))]) :-
    capturing(with_file(File, consistent([processes(P)], File)), _).

%   Between saving and loading time stands still, also for agents that sleep.

test(clock_continues) :-
    with_file(File,
        ( with_network(ring(2), [clock(100)], N1,
                       ( agent_create(clauses([ (:- agent(a)),
                                                (main :- sleep(60), now(T),
                                                         result(T)) ]), A),
                         network_save(N1, File),
                         remote(n1, now(T1)) )),
          pause(1),
          get_time(R0),
          with_loaded_network(File, _,
                              ( remote(n1, now(T2)),
                                get_time(R2),
                                agent_join(A, done, 20),
                                get_time(R3),
                                agent_result(A, T, 5) )) )),
    assertion(T2-T1 =< (R2-R0)*100),
    assertion((T >= 60, T-T1 =< (R3-R0)*100)).

%   An appointment is executed once, links are as before, they change as
%   before, and the log continues.

test(appointments_links_and_names_are_restored, true(Said == [early,late])) :-
    with_file(File,
        ( atom_concat(File, '.log', Log),
          with_network(mesh(4), [ clock(10), processes(2), log(Log, [links]),
                                  dynamic(links(uniform(1, 2), 0.5, 0.5)) ],
                       N1, Hosts,
                       ( Hosts = [Host|_],
                         network_at(N1, 1, say(Host, early)),
                         network_at(N1, 9, say(Host, late)),
                         network_advance(N1, 5),
                         log_events(Log, Before),
                         network_save(N1, File) )),
          with_loaded_network(File, N2,
                              ( network_property(N2, hosts(Hosts)),
                                network_advance(N2, 30) )),
          log_events(Log, Events) )),
    append(Before, After, Events),
    assertion(N1 == N2),
    assertion(( member(event(_, _, _, link(_)), After) )),
    findall(What, ( member(event(_, _, _, log(said(What))), Events)
                  ; member(event(_, _, _, said(What)), Events) ), Said).

say(Host, What) :-
    agent_create(clauses([(:- agent(speaker)), (main :- log(said(What)))]), _,
                 [host(Host)]).

test(process_listens_at_the_port_of_its_hosts_alone, Again == Endpoint) :-
    with_file(File,
        ( with_network(ring(2), [], Network, [Host|_],
                       network_save(Network, File)),
          with_loaded_network(File, _, endpoint_address(Again)) )),
    address_parts(Host, _, Endpoint).

%   Another host of this process is not saved, and continues.

test(other_hosts_remain, true(Left-Count == [mark]-1)) :-
    Program = clauses([(:- agent(a)), (main :- receive(_), leave(mark))]),
    with_file(File, with_hosts([own],
        ( agent_create(Program, B, [host(own)]),
          with_network(ring(2), [], N1,
                       ( agent_create(Program, A, [host(n1)]),
                         remote(own, leave(no)),
                         network_save(N1, File) )),
          with_loaded_network(
              File, _,
              ( forall(member(Agent, [B, A]),
                       ( agent_send(Agent, go), agent_join(Agent, done, 10) )),
                findall(X, remote(n1, findall(Y, sense(Y), X)), [Left]),
                remote(own, aggregate_all(count, sense(no), Count)) )) ))).

%   One process is stopped, which prints nothing, then killed.

test(unresponsive_and_missing_process,
     Errors = [socket_error, timeout_error, existence_error(carrier, _)]) :-
    capturing(with_file(File, with_network(ring(2), [processes(2)], N, Hosts,
        ( network_save(N, File),
          raised(network_load(File, _, []), InUse),
          delete_file(File),
          network_property(N, processes([_,Pid])),
          process_kill(Pid, stop),
          call_cleanup(with_settings([typhon_saving:hold_seconds=0.5],
                                     raised(network_save(N, File), Hanging)),
                       process_kill(Pid, cont)),
          \+ exists_file(File),
          goes_round(Hosts),
          network_save(N, File),
          process_kill(Pid, kill),
          wait_until(network_property(N, processes([_])), 20),
          catch(network_save(N, File), error(Gone, _), true) ))), _),
    Errors = [InUse, Hanging, Gone].

goes_round([A,B]) :-
    agent_create(clauses([(:- agent(a)), (main :- move(B), move(A))]),
                 Agent, [host(A)]),
    agent_join(Agent, done, 20).

%   The agent holds its worker in one goal.

test(agent_that_does_not_stop, error(timeout_error(save, _))) :-
    with_file(File, with_settings([typhon_saving:hold_seconds=0.3],
        with_network(ring(2), [], N,
                     ( holding_on,
                       wait_until(remote(n1, sense(begun)), 20),
                       network_save(N, File) )))).

holding_on :-
    agent_create(clauses([ (:- agent(a)),
                           (main :- leave(begun), thread_self(Me),
                                    (   thread_get_message(Me, '$never',
                                                           [timeout(3)])
                                    ->  true
                                    ;   true
                                    )) ]),
                 _).

:- end_tests(real_networks_are_saved).

%   The test of another process calls it, too.

on_from(File, Seconds) :-
    with_loaded_network(File, Network, network_advance(Network, Seconds)).

:- begin_tests(virtual_networks_are_saved).

test(at_random_instants,
     [forall(scenario(Name, _, _, Seconds)), Times-Text == Times-Whole]) :-
    random(0.0, Seconds, T1),
    random(0.0, Seconds, T2),
    msort([T1,T2], Times),
    capturing(with_file(File,
        ( atom_concat(File, '.log', Log),
          whole(Name, Log, Whole),
          with_scenario(Name, Log, Network, _,
                        resumed(Times, 0, Seconds, Network, File)),
          read_file_to_string(Log, Text, []) )), _).

%   Another process loads the network after it was stopped here.

test(in_another_process, Text == Whole) :-
    capturing(with_file(File,
        ( atom_concat(File, '.log', Log),
          whole(wanderers, Log, Whole),
          with_scenario(wanderers, Log, Network, Seconds,
                        ( network_advance(Network, 5),
                          network_save(Network, File) )),
          module_property(test_saving, file(Here)),
          Rest is Seconds-5,
          format(atom(Goal), "test_saving:on_from('~w', ~w)", [File, Rest]),
          run_swipl(['-g', Goal, '-t', halt, Here], [], exit(0), _, _),
          read_file_to_string(Log, Text, []) )), _).
test(saved_by_an_appointment, Text == Whole) :-
    capturing(with_file(File,
        ( atom_concat(File, '.log', Log),
          with_scenario(wanderers, Log, N1, Seconds,
                        ( network_at(N1, 7.5, network_save(N1, File)),
                          network_advance(N1, Seconds) )),
          read_file_to_string(Log, Whole, []),
          Rest is Seconds-7.5,
          on_from(File, Rest),
          read_file_to_string(Log, Text, []) )), _).

%   The other log has only later events.

test(loaded_with_another_log, Whole =@= Text) :-
    capturing(with_file(File,
        ( maplist(atom_concat(File), ['.log', '.other'], [Log, Other]),
          with_scenario(wanderers, Log, N1, _,
                        ( network_advance(N1, 3),
                          log_events(Log, Before),
                          network_save(N1, File),
                          network_advance(N1, 3) )),
          log_events(Log, All),
          append(Before, After, All),
          without_stops(After, Whole),
          no_leaks(( network_load(File, N2, [log(Other)]),
                     network_advance(N2, 3),
                     network_stop(N2) )),
          log_events(Other, Events),
          without_stops(Events, Text),
          Text \== [] )), _).

without_stops(Events0, Events) :-
    findall(Event,
            ( member(Event, Events0),
              Event = event(Time, _, _, _), Time < 6 ),
            Events).

test(ids_and_names_continue,
     N2-A-B == N1-'a.v.0@n1@virtual:0'-'a.v.1@n1@virtual:0') :-
    with_file(File,
        ( saved_small(File, N1, A),
          with_loaded_network(File, N2,
                              ( agent_property(A, state(waiting)),
                                idler(B) )) )).

saved_small(File, N, A) :-
    with_network(ring(3), [clock(virtual), seed(3)], N,
                 ( idler(A), network_advance(N, 1), network_save(N, File) )).

idler(Agent) :-
    agent_create(clauses([ (:- agent(a)), (main :- receive(_)) ]), Agent).

%   The variable is unified before it is used.

%   Time stands still until a caller waits.

test(agents_that_have_not_run_yet_run_later, Outcomes == [done,done]) :-
    with_file(File,
        ( with_network(ring(3), [clock(virtual), seed(1)], N1,
                       ( findall(A,
                                 ( member(Host, [n1, n2]),
                                   agent_create(clauses([(:- agent(a, [])),
                                                         main]),
                                                A, [host(Host)]) ),
                                 As),
                         network_save(N1, File) )),
          with_loaded_network(File, _,
                              findall(Outcome,
                                      ( member(A, As),
                                        agent_join(A, Outcome, 10) ),
                                      Outcomes)) )).
test(agents_that_have_not_run_yet_get_no_turn_too_many,
     Turns == [1,2,3,1,2,3,1,2,3]) :-
    setup_call_cleanup(
        message_queue_create(Queue, [alias(test_saving_turns)]),
        with_file(File,
            ( with_network(ring(3), [clock(virtual), seed(1)], N1,
                           ( maplist(turns_noted, [1,2], As),
                             network_save(N1, File) )),
              with_loaded_network(File, _,
                                  ( turns_noted(3, A),
                                    forall(member(B, [A|As]),
                                           agent_join(B, done, 10)) )),
              findall(Turn, ( between(1, 9, _),
                              thread_get_message(Queue, Turn,
                                                 [timeout(0)]) ),
                      Turns) )),
        message_queue_destroy(Queue)).
test(rule_in_the_state_of_an_agent, X == at(1)) :-
    Program = clauses([ (:- agent(a, [state([same/2])])),
                        (main :- receive(_-Y), same(Y, Z), leave(got(Z))) ]),
    Rule = ( same(P, Q) :- P = at(_), ( P = at(2) -> Q = two ; Q = P ) ),
    with_file(File,
        ( with_network(ring(3), [clock(virtual), seed(1)], N1,
                       ( agent_create(Program, A, [facts([Rule])]),
                         network_save(N1, File) )),
          with_loaded_network(File, N2, network_save(N2, File)),
          with_loaded_network(File, _,
                              ( agent_send(A, at(1)),
                                agent_join(A, done, 10),
                                remote(n1, sense(got(X))) )) )).

turns_noted(I, Agent) :-
    agent_create(clauses([ (:- agent(a, [])), (main :- hop(3)),
                           (hop(0) :- !),
                           (hop(K) :- thread_send_message(test_saving_turns, I),
                                      neighbours([H|_]), move(H), K1 is K-1,
                                      hop(K1)) ]),
                 Agent, [host(n1)]).

                /*******************************
                *             ERRORS           *
                *******************************/

%   refused(?What, +Network, +File, -Goal, -Formal): Goal raises the error,
%   beside a Network in virtual time that is saved in File.

refused(missing_directory, N, _, network_save(N, '/no/such/directory/file'),
        existence_error(source_sink, '/no/such/directory/file')).
refused(no_such_network, _, _, network_save(none, file),
        existence_error(network, none)).
refused(other_host_in_the_process, N, _,
        setup_call_cleanup(host_start(beside, [clock(virtual)]),
                           network_save(N, file),
                           host_stop(beside)),
        permission_error(save, host, 'beside@virtual:0')).
refused(second_virtual_clock, _, File, network_load(File, _, []),
        permission_error(load, virtual_time, _)).
refused(no_such_file, _, _, network_load('/no/such/file', _, []),
        existence_error(source_sink, _)).
refused(unknown_option, _, _, network_load('/no/such/file', _, [foo]),
        domain_error(network_load_option, foo)).
refused(item_that_no_table_takes, _, _,
        typhon_snapshot:process_restore(real, [item(moves, 'x@y', 0, '')]),
        domain_error(saved_item, item(moves, 'x@y', 0, ''))).

:- begin_tests(networks_that_cannot_be_saved_or_loaded).

test(refused, [forall(refused(What, N, File, Goal, Formal))]) :-
    with_file(File,
        with_network(ring(3), [clock(virtual)], N,
                     ( network_save(N, File),
                       catch(Goal, error(Raised, _), true) ))),
    assertion(What-Raised = What-Formal),
    assertion(nonvar(Raised)).
test(unserializable_state, Error-Old == type_error-"old") :-
    with_file(File,
        ( write_file(File, old),
          with_network(ring(3), [clock(virtual)], N,
                       ( agent_create(clauses([ (:- agent(a, [state([s/1])])),
                                                (main :- current_output(S),
                                                         assertz(s(S)),
                                                         receive(_)) ]), A),
                         network_advance(N, 1),
                         raised(network_save(N, File), Error),
                         agent_send(A, end),
                         agent_join(A, done, 10) )),
          file_directory_name(File, Dir),
          directory_files(Dir, Files),
          msort(Files, ['.', '..', file]),
          read_file_to_string(File, Old, []) )).
test(file_that_is_not_complete_replaces_no_older_one,
     [Formal, Old] == [resource_error(disk), New]) :-
    with_file(File, not_complete(Formal, Old, New, File)).
test(note_of_a_faulty_agent_in_the_form_of_0_1_0_is_read) :-
    typhon_snapshot:process_restore(real, [item(stays, 'x@y', 0, '')]).
test(damaged, [ forall(member(How-Formal,
                              [ another-network_damaged(_, no_network),
                                half-network_damaged(_, cut_short),
                                tail-network_damaged(_, cut_short),
                                bit-network_damaged(_, changed),
                                version-network_version(_, 99) ])),
                error(Formal) ]) :-
    with_file(File, load_damaged(How, File)).

:- end_tests(networks_that_cannot_be_saved_or_loaded).

%   Writing ends with an error when most has been written.

not_complete(Formal, Old, New, File) :-
    saved_small(File, _, _),
    read_file_to_string(File, Old, []),
    setup_call_cleanup(
        wrap_predicate(typhon_text:term_text(Term, _), test_saving, Write,
                       ( Term = end(_)
                       -> throw(error(resource_error(disk), _))
                       ;  Write )),
        catch(saved_small(File, _, _), error(Formal, _), true),
        unwrap_predicate(typhon_text:term_text/2, test_saving)),
    file_directory_name(File, Dir),
    directory_files(Dir, Files),
    msort(Files, ['.', '..', file]),
    read_file_to_string(File, New, []).

load_damaged(How, File) :-
    saved_small(File, _, _),
    read_file_to_string(File, Text0, [encoding(octet)]),
    damaged(How, Text0, Text),
    setup_call_cleanup(open(File, write, Out, [encoding(octet)]),
                       write(Out, Text),
                       close(Out)),
    no_leaks(network_load(File, _, [])).

damaged(another, _, "event(1, a, b, c).\n").
damaged(half, Text0, Text) :-
    string_length(Text0, Length),
    Half is Length//2,
    sub_string(Text0, 0, Half, _, Text).
damaged(tail, Text0, Text) :-
    sub_string(Text0, 0, _, 2, Text).
damaged(bit, Text0, Text) :-
    sub_string(Text0, Before, 6, After, "seed(3"),
    !,
    sub_string(Text0, 0, Before, _, First),
    sub_string(Text0, _, After, 0, Last),
    atomics_to_string([First, "seed(2", Last], Text).
damaged(version, Text0, Text) :-
    string_concat("typhon_saved(1,", Rest, Text0),
    string_concat("typhon_saved(99,", Rest, Text).
