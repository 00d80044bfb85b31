:- module(test_scheduler, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(process)).
:- use_module(library(readutil)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/own_thread)).
:- use_module(library(typhon/kernel/base/server), [server_call/4]).
:- use_module(library(typhon/kernel/host/scheduler)).
:- use_module(library(typhon/kernel/host/turns)).
:- use_module(library(typhon/kernel/host/time),
              [alarm_set/3, time_start/1, time_stop/0]).

/** <module> Tests of the pool of workers, and of alarms

The hooks of the scheduler are given clauses for agents test(X), which no
real agent is called.
*/

:- multifile
    typhon_scheduler:run/1,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.
:- dynamic
    typhon_scheduler:run/1,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    event/1.

:- asserta((typhon_scheduler:run(test(Goal)) :- !, call(Goal))).
:- asserta((typhon_scheduler:fire(test(X), Token) :- !,
                test_scheduler:happens(X-Token))).
:- asserta(typhon_scheduler:over(test(_), over)).

:- meta_predicate scheduling(0), scheduling(+, 0).

scheduling(Goal) :-
    scheduling([], Goal).

scheduling(Settings, Goal) :-
    forget,
    with_settings(Settings,
        no_leaks(setup_call_cleanup(time_start(real), once(Goal),
                                    in_own_thread(stop)))).

stop :-
    concurrency(inf),
    time_stop.

%   concurrency(+N): as host_change(host, concurrency(N)).

concurrency(N) :-
    typhon_on_demand:on_demand_load(host_option, concurrency),
    forall(typhon_host_parts:changes(concurrency(N), host), true).

forget :-
    retractall(event(_)).

happened(X) :-
    event(X),
    !.

count(N) :-
    aggregate_all(count, event(_), N).

happens(y-t(_)) :-
    throw(oops).
happens(X) :-
    assertz(event(X)).

timer(Alias) :-
    thread_property(_, alias(Alias)),
    sub_atom(Alias, 0, _, _, typhon_timer_).

worker(Alias) :-
    thread_property(_, alias(Alias)),
    sub_atom(Alias, 0, _, _, typhon_worker_).

workers_count(Count) :-
    aggregate_all(count, worker(_), Count).

%   does(:Goal, +Count): Goal, and so many events happen.

:- meta_predicate does(0, +), with_gate(0), with_gate(+, 0).

does(Goal, Count) :-
    call(Goal),
    wait_until(count(Count), 10).

happen(Count) :-
    forall(between(1, Count, I),
           scheduler_call(test_scheduler:happens(I))).

%   with_gate(+Settings, :Goal): goals of block/1 wait until open/1.

with_gate(Goal) :-
    setup_call_cleanup(
        message_queue_create(_, [alias(test_gate)]),
        once(Goal),
        message_queue_destroy(test_gate)).

with_gate(Settings, Goal) :-
    with_gate(scheduling(Settings, Goal)).

block(Count) :-
    forall(between(1, Count, I),
           scheduler_call(test_scheduler:blocked(test_gate, I))).

block_on_host(Count) :-
    forall(between(1, Count, I),
           schedule(host, test(test_scheduler:blocked(test_gate, I)))).

open(Count) :-
    forall(between(1, Count, _), thread_send_message(test_gate, go)).

pause :-
    \+ thread_get_message(test_gate, never, [timeout(0.1)]).

:- begin_tests(scheduler).

test(runs_what_is_scheduled) :-
    scheduling(does(( forall(between(1, 999, I),
                             schedule(none, test(test_scheduler:happens(I)))),
                      happen(1) ), 1000)).
test(survives_errors) :-
    scheduling(capturing(does(forall(between(1, 20, I),
                                     ( scheduler_call(throw(I)),
                                       scheduler_call(fail),
                                       schedule(none, test(throw(I))),
                                       schedule(none, test(fail)),
                                       happen(1) )), 20), _)).
test(starts_with_the_minimum, N-Timers == 2-1) :-
    scheduling(( workers_count(N), aggregate_all(count, timer(_), Timers) )).
test(start_twice, N == 2) :-
    scheduling(( time_start(real), workers_count(N) )).
test(stop_twice) :-
    time_stop.
test(grows_when_workers_are_blocked) :-
    with_gate([], ( does(block(40), 40), open(40) )).
test(pool_never_exceeds_its_maximum, true(Most == 8)) :-
    with_gate([typhon_scheduler:max_workers=8],
              ( does(block(20), 8),
                pause,
                workers_count(Most),
                does(open(20), 20) )).
test(new_thread_has_had_no_turn) :-
    between(1, 100, _),
    thread_create(turn_begins(old), First),
    thread_property(First, id(Number)),
    thread_join(First),
    setup_call_cleanup(
        thread_create(thread_get_message(end), Second),
        (   thread_property(Second, id(Number))
        ->  assertion(\+ turn_in(Second, _, _)),
            Same = true
        ;   Same = false
        ),
        ( thread_send_message(Second, end), thread_join(Second) )),
    Same == true,
    !.
test(grows_and_shrinks_repeatedly) :-
    with_gate([typhon_scheduler:idle_seconds=0.01],
              forall(between(1, 10, _),
                     ( forget,
                       does(block(16), 16),
                       open(16),
                       wait_until(workers_count(2), 10) ))).
test(work_continues_beside_a_blocked_pool) :-
    with_gate([], ( does(( block(4), happen(100) ), 104), open(4) )).
test(an_aborted_worker_is_replaced) :-
    scheduling(( does(( forall(between(1, 10, _), scheduler_call(abort)),
                        happen(50) ), 50),
                 wait_until(( workers_count(W), W >= 2 ), 5) )).
test(limit, true(Most == 2)) :-
    with_gate([], ( concurrency(2),
                    does(block_on_host(30), 2),
                    pause,
                    count(Most),
                    does(open(30), 30) )).
test(limit_is_removed) :-
    with_gate([], ( concurrency(1),
                    block_on_host(30),
                    does(concurrency(inf), 30),
                    open(30) )).
test(stop_ends_stuck_workers) :-
    scheduling(( scheduler_call(test_scheduler:loop),
                 wait_until(test_scheduler:happened(looping), 5) )).

:- end_tests(scheduler).

:- begin_tests(blocked).

%   with_blocked(+Settings, +Count, :Goal, -Messages): while Count agents of one
%   program block.

:- meta_predicate with_blocked(+, +, 0, -).

with_blocked(Settings, Count, Goal, Messages) :-
    forget,
    with_gate(capturing(with_settings(Settings,
                                      with_hosts([alpha],
                                                 while_blocked(Count, Goal))),
                        Messages)).

while_blocked(Count, Goal) :-
    forall(between(1, Count, _),
           create([(main :- test_scheduler:blocked(test_gate, x))], _)),
    once(Goal),
    open(Count),
    wait_until(message_queue_property(test_gate, size(0)), 10).

few([typhon_scheduler:max_workers=8, typhon_scheduler:blocked_seconds=0.05]).

%   Agents of another program run to their end, and one of them sleeps in
%   between.

others_end(Count) :-
    findall(A,
            ( between(1, Count, _),
              create([(main :- sleep(0.01))], A) ),
            Agents),
    forall(member(A, Agents), joined(A, done)).

test(others_run_beside_many_that_block, true(N == 30)) :-
    few(Settings),
    with_blocked(Settings, 30,
                 ( wait_until(test_scheduler:count(30), 10),
                   others_end(30),
                   count(N) ), Messages),
    Messages = [warning-typhon(workers_blocked(8, Names))],
    assertion(( Names = [Name|_], atom(Name) )).
test(similar_agents_wait_in_a_full_pool, true(( Most =< 24, N == 40 ))) :-
    few(Few),
    with_blocked([typhon_scheduler:blocked_workers=16|Few], 40,
                 ( wait_until(was_printed(warning, typhon(pool_full(
                                              _, blocked_workers, _))), 20),
                   others_end(30),
                   workers_count(Most) ), Messages),
    count(N),
    length(Messages, Told),
    assertion(Told =< 4).
test(blocking_goal_is_named, true(Names == [blocked])) :-
    capturing(with_gate([ typhon_scheduler:min_workers=1,
                          typhon_scheduler:max_workers=1,
                          typhon_scheduler:blocked_seconds=0.05 ],
                        ( does(( block(1), happen(1) ), 2), open(1) )),
              Messages),
    Messages = [warning-typhon(workers_blocked(1, Names))].
test(three_hundred_agents_that_block, true(O-S == done-done)) :-
    with_gate(capturing(with_hosts([alpha], beside_blocked(300, O, S)),
                        Messages)),
    assertion(Messages = [warning-typhon(workers_blocked(256, _))]).

beside_blocked(Count, O, S) :-
    forall(between(1, Count, _),
           create([(main :- thread_get_message(test_gate, _))], _)),
    create([(main :- receive(_-x, 10), sleep(0.01))], A),
    agent_send(A, x),
    joined(A, O),
    create([main], B),
    joined(B, S).

:- end_tests(blocked).

%   The numbers of alarms, and of stamps in the index of the timer.

alarm_count(Alarms, Indexed) :-
    typhon_scheduler:timer(Timer),
    server_call(Timer, count, inf, Indexed),
    predicate_property(typhon_scheduler:alarm(_, _, _),
                       number_of_clauses(Alarms)).

%   A signal that comes just before a thread waits does not wake it.

timer_ended :-
    (   timer(_)
    ->  timer_signal(abort),
        fail
    ;   true
    ).

timer_signal(Goal) :-
    forall(timer(Timer),
           catch(thread_signal(Timer, Goal),
                 error(existence_error(_, _), _), true)).

%   space_is_limited is semidet: not by qemu, where threads would be made until
%   the memory of the machine is full.

space_is_limited :-
    exists_file('/usr/bin/prlimit'),
    process_create(path(prlimit), ['--as=4096', true],
                   [ stderr(null), process(Pid) ]),
    process_wait(Pid, Status),
    Status \== exit(0).

:- begin_tests(no_threads, [condition(space_is_limited)]).

%   without_threads(:Goal): no new thread can be made, since there is no space
%   for its stack; existing threads have started, and have their stacks.

:- meta_predicate without_threads(0).

without_threads(Goal) :-
    wait_until(at_rest, 20),
    setup_call_cleanup(
        ( address_space(Bytes),
          limit_space(Bytes),
          threads(Threads) ),
        once(Goal),
        ( limit_space(unlimited),
          forall(member(Thread, Threads),
                 ( thread_send_message(Thread, end),
                   thread_join(Thread, _) )) )).

%   This thread is the only one that runs or is about to run.

at_rest :-
    expand_file_name('/proc/self/task/*/stat', Files),
    findall(File, ( member(File, Files), \+ sleeps(File) ), [_]).

sleeps(File) :-
    catch(read_file_to_string(File, Text, []), error(_, _), fail),
    sub_string(Text, _, _, _, ") S ").

address_space(Bytes) :-
    read_file_to_string('/proc/self/status', Text, []),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    split_string(Line, "\t ", "\t ", ["VmSize:"|Words]),
    member(Word, Words),
    number_string(KB, Word),
    !,
    Bytes is (KB+4000)*1024.

limit_space(Limit) :-
    current_prolog_flag(pid, Pid),
    format(atom(Process), '--pid=~d', [Pid]),
    format(atom(Space), '--as=~w:unlimited', [Limit]),
    process_create(path(prlimit), [Process, Space], []).

threads(Threads) :-
    (   catch(thread_create(thread_get_message(end), Thread),
              error(resource_error(_), _), fail)
    ->  Threads = [Thread|More],
        threads(More)
    ;   Threads = []
    ).

test(stopping_needs_no_thread) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], _),
                 create([(main :- sleep(100))], _),
                 without_threads(( call_cleanup(host_stop(beta), true),
                                   setup_call_cleanup(true, true,
                                                      host_stop(alpha)),
                                   \+ host_property(_, state(_)) )) )).
test(scheduler_start_is_atomic,
     error(resource_error(_))) :-
    no_leaks(without_threads(host_start(alpha))).
test(sleepers_wake_and_the_pool_reports_why_it_does_not_grow,
     true(O-F == done-done)) :-
    with_gate(capturing(with_settings([typhon_scheduler:blocked_seconds=0.1],
                                      with_hosts([alpha], no_room(O, F))),
                        Messages)),
    assertion(\+ member(error-_, Messages)).

no_room(O, F) :-
    create([(main :- sleep(0.5))], A),
    without_threads(( create_blocked(1),
                      joined(A, O),
                      create([main], B),
                      joined(B, F),
                      create_blocked(10),
                      create([main], C),
                      wait_until(was_printed(warning, typhon(pool_full(
                                                 _, no_memory, _))), 10),
                      \+ agent_join(C, done, 0.1) )),
    joined(C, done).

%   Only one agent of a kind: once one blocks, its kind is held back.

create_blocked(Count) :-
    forall(between(1, Count, I),
           create([ (main :- thread_get_message(test_gate, _)),
                    of(Count, I) ], _)).

test(ended_timer_is_restarted, true(O == done)) :-
    capturing(with_hosts([alpha],
                         ( create([(main :- sleep(0.5))], A),
                           without_threads(
                               wait_until(test_scheduler:timer_ended, 5)),
                           create([(main :- sleep(0.01))], B),
                           joined(B, done),
                           joined(A, O),
                           wait_until(was_printed(error,
                                                  typhon(server_ended(timer))),
                                      20)
                         )), _).

:- end_tests(no_threads).

blocked(Queue, I) :-
    happens(blocked(I)),
    thread_get_message(Queue, go).

loop :-
    happens(looping),
    repeat,
    fail.

:- begin_tests(alarms).

at(Seconds, Stamp) :-
    get_time(Now),
    Stamp is Now+Seconds.

%   in_time(:Set, +Count, -Events): Events are those of the alarms that Set(T)
%   sets, for the time T or later, before T.

:- meta_predicate in_time(1, +, -).

in_time(Set, Count, Events) :-
    member(Lead, [0.05,0.5,5]),
    scheduling(( at(Lead, T),
                 call(Set, T),
                 get_time(Now),
                 wait_until(test_scheduler:count(Count), 20),
                 get_time(End),
                 assertion(End >= T) )),
    Now < T,
    !,
    events(Events).

events(Events) :-
    findall(X, event(X), Events).

%   alarms(-Behaviour, -Alarms, -Events): each After-What-Token goes off After
%   seconds after a time.

alarms(one, [0-x-t], [x-t]).
alarms(order_of_time, [0.004-4-t,0.001-1-t,0.005-5-t,0.003-3-t,0.002-2-t],
       [1-t,2-t,3-t,4-t,5-t]).
alarms(earlier_is_set_later, [0.1-late-t,0-early-t], [early-t,late-t]).
alarms(same_twice, [0-x-t,0-x-t,0.05-y-u], [x-t,y-u]).
alarms(one_in_the_far_future, [1.0e300-never-t,0-x-t], [x-t]).

set_all(Alarms, T) :-
    forall(member(After-What-Token, Alarms),
           ( S is T+After, alarm_set(S, test(What), Token) )).

test(alarms, [ forall(alarms(_, Alarms, Expected)), true(E == Expected) ]) :-
    length(Expected, Count),
    in_time(set_all(Alarms), Count, E).
test(alarm_in_the_past, true(E == [x-t])) :-
    scheduling(does(alarm_set(0, test(x), t), 1)),
    events(E).
test(thousands_of_alarms) :-
    scheduling(( at(0.2, T),
                 does(forall(between(1, 5000, I),
                             ( S is T+(I mod 97)*0.001,
                               alarm_set(S, test(I), t) )), 5000) )).
test(expired_alarms_are_forgotten, true(( N =< 1000, I =< 1000 ))) :-
    scheduling(( at(1000, T),
                 forall(between(1, 20000, J),
                        ( S is T+J, alarm_set(S, test(J), over) )),
                 alarm_count(N, I) )).
test(valid_alarms_are_kept) :-      % the timer is notified of the last later
    scheduling(( at(1000, T),
                 forall(between(1, 5000, J),
                        ( S is T+J, alarm_set(S, test(J), t) )),
                 wait_until(( alarm_count(N, I),
                              N-I == 5000-5000 ), 5) )).
test(hook_that_raises, true(E == [x-t])) :-
    scheduling(capturing(( at(0.05, T), at(0.1, U),
                           alarm_set(T, test(y), t(_)),
                           alarm_set(U, test(x), t),
                           wait_until(test_scheduler:happened(x-t), 5) ),
                         Messages)),
    memberchk(error-typhon(alarm(oops)), Messages),
    events(E).
test(timer_survives_thrown_exceptions) :-
    scheduling(capturing(( at(0.2, T),
                           does(forall(between(1, 100, I),
                                       ( S is T+I*0.001,
                                         alarm_set(S, test(I), t),
                                         timer_signal(throw(I)) )),
                                100) ), _)).
test(aborted_timer_is_replaced) :-
    scheduling(capturing(( at(0.3, T),
                           does(( forall(between(1, 100, I),
                                         ( S is T+I*0.001,
                                           alarm_set(S, test(I), t) )),
                                  timer_signal(abort) ), 100),
                           wait_until(was_printed(error,
                                                  typhon(server_ended(timer))),
                                      20) ), _)).
test(stack_overflow, true(E == [x-t])) :-
    setup_call_cleanup(
        ( current_prolog_flag(stack_limit, Limit),
          set_prolog_flag(stack_limit, 1 000 000) ),
        scheduling(capturing(( at(1000, T), at(1.5, U),
                               forall(between(1, 20000, J),
                                      ( S is T+J, alarm_set(S, test(J), t) )),
                               alarm_set(U, test(x), t),
                               wait_until(test_scheduler:happened(x-t), 10) ),
                             Messages)),
        set_prolog_flag(stack_limit, Limit)),
    memberchk(warning-typhon(no_index(_)), Messages),
    events(E).
test(answered_agents_leave_no_alarms, true(N =< 1000)) :-
    capturing(answered(N), _).

answered(N) :-
    with_hosts([alpha],
               ( create([(main :- s(Left), rally(Left)),
                         (rally(0) :- !),
                         (rally(Left) :- receive(From-ball, 3600),
                                         send(From, ball),
                                         Left1 is Left-1, rally(Left1)),
                         s(3000)], A),
                 create([(main :- r(Other), send(Other, ball), rally),
                         (rally :- receive(From-ball, 3600),
                                   send(From, ball), rally)], B,
                        [facts([r(A)])]),
                 joined(A, done),
                 agent_dispose(B),
                 alarm_count(N, _) )).
test(no_alarm_goes_off_after_the_stop, true(N == 0)) :-
    scheduling(( at(1000, T), alarm_set(T, test(x), t) )),
    count(N).

:- end_tests(alarms).

                /*******************************
                *          SHORT TURNS         *
                *******************************/

%   Short turns, and the memory of long ones.

short :-
    forall(between(1, 700, _), succ_or_zero(1)).

long :-
    forall(between(1, 30000, _), succ_or_zero(1)).

succ_or_zero(_).

%   A turn in which another thread has run counts as long, too; of several
%   kinds at least one is not disturbed.

:- meta_predicate some_kind(+, 1).

some_kind(Name, Goal) :-
    between(1, 20, I),
    atom_concat(Name, I, Kind),
    call(Goal, Kind),
    !.

always_short(Kind) :-
    forall(between(1, 100, _), turn_if_short(Kind, short)).

long_once(Kind) :-
    turn_if_short(Kind, long),
    \+ turn_if_short(Kind, short),
    atom_concat(another_, Kind, Another),
    turn_if_short(Another, short).

now_and_then(Kind) :-
    turn_if_short(Kind, waits),
    forall(between(1, 10, _), turn_if_short(Kind, short)),
    turn_if_short(Kind, waits),
    turn_if_short(Kind, short).

waits :-
    thread_self(Me),
    \+ thread_get_message(Me, never, [timeout(0.006)]).

:- begin_tests(short_turns).

test(short_turns) :-
    some_kind(a, always_short).
test(one_long_turn) :-
    some_kind(b, long_once).
test(one_waiting_turn) :-
    turn_if_short(d, waits),
    turn_if_short(d, short).
test(two_waiting_turns_in_a_row) :-
    turn_if_short(e, waits),
    turn_if_short(e, waits),
    \+ turn_if_short(e, short).
test(occasional_waiting_turns) :-
    some_kind(f, now_and_then).
test(longer_memory_is_kept) :-
    turns_not_short(g, 60),
    turns_not_short(g, 0),
    \+ turn_if_short(g, short).
test(memory_is_forgotten) :-
    turns_not_short(h, 0),
    turn_if_short(h, short).

:- end_tests(short_turns).
