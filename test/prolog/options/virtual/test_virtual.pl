:- module(test_virtual, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/networks').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3, sum_list/2]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(time), [call_with_time_limit/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host), [time_hold/1]).

/** <module> Virtual time: no real waits, and repeatable runs

*Threading*: one test at a time.
*/

:- meta_predicate with_virtual(+, -, 0).

%   with_virtual(+Options, -Network, :Goal): a ring of four hosts.

with_virtual(Options, Network, Goal) :-
    with_network(ring(4), [clock(virtual), seed(7)|Options], Network, Goal).

first_host(Network, Host) :-
    network_property(Network, hosts([Host|_])).

shows(Network, Time) :-
    first_host(Network, Host),
    remote(Host, now(Time)).

%   An agent that keeps a diary in the tuple space of the first host.

sleeper(Network, Main, Agent) :-
    first_host(Network, Host),
    agent_create(clauses([ (:- agent(sleeper)),
                           (main :- Main),
                           days(0),
                           (days(K) :- K > 0, sleep(86400), K1 is K-1,
                                       days(K1)) ]), Agent, [host(Host)]).

saved(Network, Dir) :-
    atom_concat(Dir, '/saved', File),
    network_save(Network, File).

:- begin_tests(virtual_time).

test(virtual_time_begins_at_zero, true(Time =:= 0)) :-
    with_virtual([], N, shows(N, Time)).
test(year_takes_no_time, true(Time =:= 365*86400)) :-
    with_virtual([], N,
                 ( sleeper(N, days(365), _),
                   Year is 365*86400.0,
                   network_advance(N, Year),
                   shows(N, Time0) )),
    Time is round(Time0).
test(time_stands_still_while_a_program_works, true(Times == [0.0,0.0,5.0])) :-
    with_virtual([], N,
                 ( sleeper(N, sleep(5), A),
                   shows(N, T1),
                   numlist(1, 100000, L),
                   sum_list(L, _),
                   shows(N, T2),
                   agent_join(A, done, 60),
                   shows(N, T3) )),
    Times = [T1,T2,T3].
test(agents_run_only_while_a_caller_waits, true(Seen == [no,yes])) :-
    with_virtual([], N,
                 ( first_host(N, Host),
                   sleeper(N, leave(mark), A),
                   marked(Host, Before),
                   agent_join(A, done, 60),
                   marked(Host, After) )),
    Seen = [Before,After].
test(agents_stop_when_the_wait_is_over, true(Marks == [])) :-
    with_virtual([], N,
                 ( first_host(N, Host),
                   sleeper(N, true, A),
                   forall(between(1, 20, _), sleeper(N, leave(mark), _)),
                   agent_join(A, done, 60),
                   with_tmp_dir(test_virtual:saved(N)), % a request to the loop
                   remote(Host, findall(x, sense(mark), Marks)) )).

%   waits(-Main, -Seconds): Main takes so long in virtual time.

waits(sleep(5), 5.0).
waits(( receive(never, 40) -> true ; true ), 40.0).
waits(( thread_self(Me), \+ thread_get_message(Me, '$never', [timeout(0.05)]),
        sleep(1) ), 1.0).

test(waits_take_virtual_time,
     [forall(waits(Main, Seconds)), true(Time-Outcome == Seconds-done)]) :-
    with_virtual([], N,
                 ( sleeper(N, Main, A),
                   agent_join(A, Outcome, 100),
                   shows(N, Time) )).
test(join_times_out_in_virtual_time, true(Outcome-Time == timeout-30.0)) :-
    with_virtual([], N,
                 ( sleeper(N, sleep(100), A),
                   agent_join(A, Outcome, 30.0),
                   shows(N, Time) )).
test(messages_and_orders, true(Got-Ended == [1,2,3]-disposed)) :-
    with_virtual([], N,
                 ( first_host(N, Host),
                   agent_create(clauses([ (:- agent(box)),
                                          (main :- receive(_-A),
                                                   receive(_-B),
                                                   receive(_-C),
                                                   leave(got([A,B,C])),
                                                   receive(never) ) ]),
                                Box, [host(Host)]),
                   forall(member(M, [1,2,3]), agent_send(Box, M)),
                   network_advance(N, 1),
                   remote(Host, take(got(Got))),
                   agent_dispose(Box),
                   agent_join(Box, Ended, 10) )).
test(time_stands_still_while_an_agent_is_ready, true(Time == 0.0)) :-
    with_virtual([], N,
                 ( sleeper(N, sleep(10), _),
                   first_host(N, Host),
                   findall(A, ( member(_, [1,2]), player(Host, A) ), [A,B]),
                   agent_send(A, with(B)),
                   agent_send(B, with(A)),
                   agent_result(A, Time, 20) )).
test(agents_run_in_the_order_in_which_they_became_ready,
     true(Turns == [1,2,3,1,2,3,1,2,3,1,2,3])) :-
    with_virtual([], N,
                 setup_call_cleanup(
                     message_queue_create(Queue, [alias(test_virtual)]),
                     ( first_host(N, Host),
                       findall(A, ( member(I, [1,2,3]), hopper(Host, I, A) ),
                               As),
                       forall(member(A, As), agent_join(A, done, 10)),
                       noted(Queue, Turns) ),
                     message_queue_destroy(Queue))).
test(network_clock_counts_from_its_start, true) :-
    get_time(T0),
    with_network(ring(2), [clock(10)], N,
                 ( get_time(T1),
                   shows(N, Now1),
                   get_time(T2),
                   network_advance(N, 1),
                   get_time(T3),
                   shows(N, Now2),
                   get_time(T4) )),
    between_times(0, 10*(T2-T0), Now1),
    between_times(10*(T3-T2), 10*(T4-T1), Now2-Now1).
test(order_is_executed_while_its_caller_waits) :-
    with_virtual([], N,
                 ( sleeper(N, sleep(10), A),
                   agent_clone(A, B),
                   agent_join(A, done, 100),
                   agent_join(B, done, 100) )).

:- end_tests(virtual_time).

%   Players exchange messages; each hop of a hopper is noted.

player(Host, Agent) :-
    agent_create(clauses([ (:- agent(player)),
                           (main :- receive(_-with(B)), play(B, 50),
                                    now(T), result(T)),
                           (play(_, 0) :- !),
                           (play(B, K) :- send(B, ball(K)), receive(_-ball(K)),
                                          K1 is K-1, play(B, K1)) ]),
                 Agent, [host(Host)]).

hopper(Host, I, Agent) :-
    agent_create(clauses([ (:- agent(hopper)),
                           (main :- hop(4)),
                           (hop(0) :- !),
                           (hop(K) :- thread_send_message(test_virtual, I),
                                      neighbours([H|_]), move(H), K1 is K-1,
                                      hop(K1)) ]),
                 Agent, [host(Host)]).

between_times(Min, Max, X) :-
    X >= Min,
    X =< Max.

:- begin_tests(virtual_appointments).

%   heard(-Network, -Queue, :Goal, -Heard): what Goal puts into the Queue.

:- meta_predicate heard(-, -, 0, -).

heard(N, Queue, Goal, Heard) :-
    with_virtual([], N, with_queue(Queue, ( Goal, noted(Queue, Heard) ))).

test(appointments_run_in_order, true(Heard == [a-1.0,b-2.0,c-2.0,late-3.0])) :-
    heard(N, Queue, ( network_at(N, 2, note_time(Queue, N, b)),
                      network_at(N, 2, note_time(Queue, N, c)),
                      network_at(N, 1, note_time(Queue, N, a)),
                      network_advance(N, 3),
                      network_at(N, 1, note_time(Queue, N, late)),
                      network_advance(N, 10) ), Heard).
test(appointments_of_an_instant_run_in_their_order, true(Heard == Numbers)) :-
    numlist(1, 20, Numbers),
    heard(N, Queue, ( forall(member(I, Numbers),
                             network_at(N, 2, thread_send_message(Queue, I))),
                      network_advance(N, 3) ), Heard).
test(no_appointment_after_the_end, true(Heard == [])) :-
    with_queue(Queue,
               ( with_virtual([], N, network_at(N, 5, note_time(Queue, N, a))),
                 noted(Queue, Heard) )).
test(advance_reaches_its_time, true(Times == [2.5,2.5,4.0])) :-
    with_virtual([], N,
                 ( network_advance(N, 2.5), shows(N, T1),
                   network_advance(N, 0), shows(N, T2),
                   network_advance(N, 1.5), shows(N, T3) )),
    Times = [T1,T2,T3].
test(appointments_in_real_time, true(Heard == [a])) :-
    with_queue(Queue,
               ( with_network(ring(2), [clock(1000)], N,
                     ( network_at(N, 20, thread_send_message(Queue, a)),
                       network_advance(N, 200),
                       wait_until(message_queue_property(Queue, size(1)),
                                  20) )),
                 noted(Queue, Heard) )).
test(called_goal_cannot_wait, true(Heard == [timeout-1.0])) :-
    heard(N, Queue, ( sleeper(N, sleep(5), A),
                      network_at(N, 1, ( agent_join(A, Outcome, 10),
                                         note_time(Queue, N, Outcome) )),
                      network_advance(N, 10) ), Heard).
test(network_end_ends_the_wait) :-
    no_leaks(( network_start(ring(4), N, [clock(virtual)]),
               sleeper(N, days(1000000000), _),
               thread_create(( wait_until(( shows(N, T), T > 0 ), 10),
                               network_stop(N) ), Stops),
               call_with_time_limit(30, network_advance(N, 1.0e15)),
               thread_join(Stops, true) )).
test(bad_appointment,
     [ forall(member(Goal-Formal,
                     [ network_advance(no_network, 1)-
                       existence_error(network, no_network),
                       network_at(no_network, 1, true)-
                       existence_error(network, no_network),
                       network_at(N, 1, _)-instantiation_error,
                       network_at(N, 1, 3)-type_error(callable, 3),
                       network_advance(N, soon)-type_error(number, soon) ])),
       error(Formal) ]) :-
    with_virtual([], N, Goal).

:- end_tests(virtual_appointments).

:- begin_tests(virtual_runs_are_alike).

%   Wanderers with clones, messages, random delays, choices and links.

test(same_seed_same_log, true(A == B)) :-
    with_tmp_dir(two_logs(3, 3, A, B)).
test(other_seed_other_log, true(A \== B)) :-
    with_tmp_dir(two_logs(3, 4, A, B)).
test(random_numbers_of_agents_follow_the_seed, true(( A == B, A =\= C ))) :-
    maplist(drawn, [3,3,4], [A,B,C]).
test(busy_machine_does_not_change_the_log, true(A == B)) :-
    with_tmp_dir(logs_of_processes(A, B)).

:- end_tests(virtual_runs_are_alike).

drawn(Seed, X) :-
    with_network(ring(4), [clock(virtual), seed(Seed)], N, [Host|_],
                 ( agent_create(clauses([ (:- agent(drawer, [])),
                                          (main :- random(X0), result(X0)) ]),
                                Agent, [host(Host)]),
                   network_advance(N, 1),
                   agent_result(Agent, X, 1) )).

two_logs(Seed1, Seed2, A, B, Dir) :-
    maplist(log_of(Dir), [Seed1,Seed2], [A,B]).

log_of(Dir, Seed, Text) :-
    atomic_list_concat([Dir, '/', Seed, '.pl'], File),
    wander(Seed, File),
    read_file_to_string(File, Text, []).

wander(Seed, File) :-
    with_network(grid(3, 3),
                 [ clock(virtual), seed(Seed), log(File),
                   hop_time(uniform(0.1, 0.9)),
                   dynamic(links(uniform(1, 3), 0.3, 0.5)) ], N, wanderers(N)).

wanderers(N) :-
    network_property(N, hosts(Hosts)),
    findall(A,
            ( member(Host, Hosts),
              agent_create(clauses([ (:- agent(wanderer, [state([left/1])])),
                                     left(8),
                                     (main :- parent(P), !, send(P, hello),
                                              stroll),
                                     (main :- stroll),
                                     (stroll :- left(0), !),
                                     (stroll :- retract(left(K)), K1 is K-1,
                                                assertz(left(K1)),
                                                random(X), log(drawn(X)),
                                                next_step, part(K), stroll),
                                     (next_step :- neighbours(Hs),
                                                   random_member(H, Hs),
                                                   move(H), !),
                                     (next_step :- sleep(1)),
                                     (part(5) :- !, clone(_)),
                                     (part(_) :-
                                          (   receive(From-Text, 0.5)
                                          ->  log(received(From, Text))
                                          ;   true
                                          )) ]),
                           A, [host(Host)]) ),
            As),
    forall(member(A, As), agent_join(A, done, 1000)),
    network_advance(N, 30).

logs_of_processes(A, B, Dir) :-
    log_of(Dir, 5, A),
    atomic_list_concat([Dir, '/other.pl'], File),
    module_property(test_virtual, file(Here)),
    format(atom(Goal), "test_virtual:wander(5, '~w')", [File]),
    setup_call_cleanup(
        busy(Busy),
        run_swipl([ '-g', Goal, '-t', halt, Here ], [], exit(0), _, _),
        maplist(thread_end, Busy)),
    read_file_to_string(File, B, []).

busy([T1,T2,T3]) :-
    maplist([T]>>thread_create((repeat, fail), T), [T1,T2,T3]).

thread_end(Thread) :-
    thread_signal(Thread, abort),
    thread_join(Thread, _).

:- begin_tests(virtual_limits).

test(virtual_time_needs_one_process,
     [ forall(member(Option, [processes(2), machines([far])])),
       error(permission_error(carry, virtual_time, Option)) ]) :-
    network_start(ring(4), _, [clock(virtual), Option]).
test(real_host_beside_a_virtual_one_is_refused,
     error(permission_error(change, kind_of_time, real))) :-
    with_virtual([], _, host_start(another)).
test(virtual_host_beside_a_real_one_is_refused,
     error(permission_error(change, kind_of_time, virtual))) :-
    with_hosts([one], host_start(two, [clock(virtual)])).
test(single_virtual_host, true(Time == 9.0)) :-
    result_on([one-[clock(virtual)]],
              [(main :- sleep(9), now(T), result(T))], Time).
test(other_processes_are_unreachable, true(Outcome == done)) :-
    with_peers([a],
               ( peer_host(a, Far),
                 with_hosts([one-[clock(virtual)]],
                            ( agent_create(clauses(
                                  [ (:- agent(a)),
                                    (main :- catch(move(Far), error(E, _),
                                                   true),
                                             E == host_unreachable(Far)) ]),
                                           A),
                              agent_join(A, Outcome, 20) )) )).
test(endless_goal_is_reported) :-
    stuck_warning(( repeat, fail ), virtual_stuck(_, _)).
test(endless_instant_is_reported) :-
    stuck_warning(spin, virtual_busy(_)).
%   A thread that does not end of itself is aborted after a second.

test(time_that_is_held_ends_of_itself,
     [ setup(( flag(test_virtual_aborts, _, 0),
               wrap_predicate(typhon_own_thread:abort_quietly, counted, Abort,
                              ( flag(test_virtual_aborts, N, N+1), Abort )) )),
       cleanup(unwrap_predicate(typhon_own_thread:abort_quietly/0, counted)),
       Aborts == 0 ]) :-
    with_hosts([one-[clock(virtual)]], ( time_hold(10), host_stop(one) )),
    flag(test_virtual_aborts, Aborts, Aborts).
test(no_event_is_due) :-
    capturing(with_virtual([], N, nothing_due(N)), _).

:- end_tests(virtual_limits).

%   A clock that stands still is reported after a tenth of a second.

stuck_warning(Main, Message) :-
    capturing(with_settings([typhon_virtual:patience=0.1],
                            with_virtual([], N, stuck(N, Main, Message))),
              _).

stuck(N, Main, Message) :-
    first_host(N, Host),
    agent_create(clauses([ (:- agent(stuck)),
                           (main :- Main),
                           (spin :- neighbours([H|_]), move(H), spin) ]),
                 A, [host(Host)]),
    warning_while(agent_join(A, _, 10), Message).

nothing_due(N) :-
    sleeper(N, receive(never), A),
    warning_while(agent_join(A, _, inf), virtual_nothing_due).

%   The thread that waits in Goal is interrupted after the warning.

warning_while(Goal, Message) :-
    thread_create(catch(Goal, enough, true), Thread),
    call_cleanup(wait_until(was_printed(warning, typhon(Message)), 20),
                 interrupted(Thread)).

interrupted(Thread) :-
    catch(thread_signal(Thread, throw(enough)),
          error(existence_error(_, _), _),
          true),                        % the agent has ended
    thread_join(Thread).

                /*******************************
                *             HELP             *
                *******************************/

marked(Host, yes) :-
    remote(Host, sense(mark)),
    !.
marked(_, no).

:- meta_predicate with_queue(-, 0).

with_queue(Queue, Goal) :-
    setup_call_cleanup(message_queue_create(Queue), Goal,
                       message_queue_destroy(Queue)).

note_time(Queue, Network, What) :-
    shows(Network, Time),
    thread_send_message(Queue, What-Time).

noted(Queue, List) :-
    findall(M, ( repeat,
                 (   thread_get_message(Queue, M0, [timeout(0)])
                 ->  M = M0
                 ;   !, fail
                 ) ), List).
