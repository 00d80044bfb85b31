:- module(test_scheduler, []).
:- use_module(library(plunit)).
:- use_module(common).
:- use_module(fixtures).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(settings)).
:- use_module(library(typhon)).
:- use_module(library(typhon/aside)).
:- use_module(library(typhon/scheduler)).

/** <module> Tests of the pool of workers, and of alarms

The hooks of the scheduler are given clauses for agents test(X), which no
real agent is called.
*/

:- multifile
    typhon_scheduler:run/1,
    typhon_scheduler:fire/2.
:- dynamic
    typhon_scheduler:run/1,
    typhon_scheduler:fire/2,
    event/1.

:- asserta((typhon_scheduler:run(test(Goal)) :- !, call(Goal))).
:- asserta((typhon_scheduler:fire(test(X), Token) :- !,
                assertz(test_scheduler:event(X-Token)))).

:- meta_predicate scheduling(0), scheduling(+, 0).

scheduling(Goal) :-
    scheduling([], Goal).

scheduling(Settings, Goal) :-
    forget,
    with_settings(Settings,
        no_leaks(setup_call_cleanup(scheduler_start, once(Goal),
                                    aside(scheduler_stop)))).

forget :-
    retractall(event(_)).

happened(X) :-
    event(X),
    !.

count(N) :-
    aggregate_all(count, event(_), N).

happens(X) :-
    assertz(event(X)).

:- begin_tests(scheduler).

test(runs_what_is_scheduled, N == 1000) :-
    scheduling(( forall(between(1, 1000, I),
                        schedule(none, test(test_scheduler:happens(I)))),
                 wait_until(test_scheduler:count(1000), 10) )),
    count(N).
test(runs_goals, N == 1) :-
    scheduling(( scheduler_call(test_scheduler:happens(x)),
                 wait_until(test_scheduler:happened(x), 5) )),
    count(N).
test(survives_errors, true(N == 20)) :-
    scheduling(listening(( forall(between(1, 20, I),
                                  ( scheduler_call(throw(I)),
                                    scheduler_call(fail),
                                    schedule(none, test(throw(I))),
                                    schedule(none, test(fail)),
                                    scheduler_call(test_scheduler:happens(I)) )),
                           wait_until(test_scheduler:count(20), 10) ), _)),
    count(N).
test(starts_with_the_minimum, N == 2) :-
    scheduling(scheduler_workers(N)).
test(start_twice, N == 2) :-
    scheduling(( scheduler_start, scheduler_workers(N) )).
test(stop_twice) :-
    scheduler_stop.
test(grows_when_workers_are_blocked, N == 40) :-
    message_queue_create(Q),
    scheduling(( forall(between(1, 40, I),
                        scheduler_call(test_scheduler:blocked(Q, I))),
                 wait_until(test_scheduler:count(40), 10),
                 scheduler_workers(Many),
                 assertion(Many >= 40),
                 forall(between(1, 40, _), thread_send_message(Q, go)) )),
    count(N),
    message_queue_destroy(Q).
test(never_more_than_the_most, true(Most-N == 8-20)) :-
    message_queue_create(Q),
    scheduling([typhon_scheduler:max_workers=8],
               ( forall(between(1, 20, I),
                        scheduler_call(test_scheduler:blocked(Q, I))),
                 wait_until(test_scheduler:count(8), 10),
                 \+ thread_get_message(Q, never, [timeout(0.1)]),
                 scheduler_workers(Most),
                 forall(between(1, 20, _), thread_send_message(Q, go)),
                 wait_until(test_scheduler:count(20), 10) )),
    count(N),
    message_queue_destroy(Q).
test(shrinks_when_there_is_nothing_to_do, N == 2) :-
    message_queue_create(Q),
    scheduling([typhon_scheduler:idle_seconds=0.05],
               ( forall(between(1, 20, I),
                        scheduler_call(test_scheduler:blocked(Q, I))),
                 wait_until(test_scheduler:count(20), 10),
                 forall(between(1, 20, _), thread_send_message(Q, go)),
                 wait_until(scheduler_workers(2), 10),
                 scheduler_workers(N) )),
    message_queue_destroy(Q).
test(grows_and_shrinks_again_and_again) :-
    message_queue_create(Q),
    scheduling([typhon_scheduler:idle_seconds=0.01],
               forall(between(1, 10, _),
                      ( forget,
                        forall(between(1, 16, I),
                               scheduler_call(test_scheduler:blocked(Q, I))),
                        wait_until(test_scheduler:count(16), 10),
                        forall(between(1, 16, _), thread_send_message(Q, go)),
                        wait_until(scheduler_workers(2), 10) ))),
    message_queue_destroy(Q).
test(work_goes_on_beside_a_blocked_pool, N == 104) :-
    message_queue_create(Q),
    scheduling(( forall(between(1, 4, I),
                        scheduler_call(test_scheduler:blocked(Q, b(I)))),
                 forall(between(1, 100, I),
                        scheduler_call(test_scheduler:happens(I))),
                 wait_until(test_scheduler:count(104), 10),
                 forall(between(1, 4, _), thread_send_message(Q, go)) )),
    count(N),
    message_queue_destroy(Q).
test(an_aborted_worker_is_replaced, true((W >= 2, N == 50))) :-
    scheduling(( forall(between(1, 10, _), scheduler_call(abort)),
                 forall(between(1, 50, I),
                        scheduler_call(test_scheduler:happens(I))),
                 wait_until(test_scheduler:count(50), 10),
                 wait_until(( scheduler_workers(W0), W0 >= 2 ), 5),
                 scheduler_workers(W) )),
    count(N).
test(limit, true(Most == 2)) :-
    flag(test_running, _, 0),
    flag(test_most, _, 0),
    scheduling(( scheduler_limit(host, 2),
                 forall(between(1, 30, I),
                        schedule(host, test(test_scheduler:busy(I)))),
                 wait_until(test_scheduler:count(30), 10) )),
    flag(test_most, Most, Most).
test(unlimited_again, N == 30) :-
    message_queue_create(Q),
    scheduling(( scheduler_limit(host, 1),
                 forall(between(1, 30, I),
                        schedule(host, test(test_scheduler:blocked(Q, I)))),
                 scheduler_unlimit(host),
                 wait_until(test_scheduler:count(30), 10),
                 forall(between(1, 30, _), thread_send_message(Q, go)) )),
    count(N),
    message_queue_destroy(Q).
test(stop_ends_stuck_workers) :-
    scheduling(( scheduler_call(test_scheduler:loop),
                 wait_until(test_scheduler:happened(looping), 5) )).

:- end_tests(scheduler).

blocked(Queue, I) :-
    happens(I),
    thread_get_message(Queue, go).

busy(I) :-
    flag(test_running, N0, N0+1),
    flag(test_most, M, max(M, N0+1)),
    numlist(1, 1000, L),
    msort(L, _),
    flag(test_running, N1, N1-1),
    happens(I).

loop :-
    happens(looping),
    repeat,
    fail.

:- begin_tests(alarms).

at(Seconds, Stamp) :-
    get_time(Now),
    Stamp is Now+Seconds.

test(goes_off, true(E == [x-t])) :-
    scheduling(( at(0.05, T),
                 alarm_set(T, test(x), t),
                 wait_until(test_scheduler:happened(x-t), 5),
                 get_time(Now),
                 assertion(Now >= T) )),
    findall(X, event(X), E).
test(in_the_order_of_time, true(E == [1-t,2-t,3-t,4-t,5-t])) :-
    scheduling(( at(0.1, T),
                 forall(member(N, [4,1,5,3,2]),
                        ( S is T+N*0.001, alarm_set(S, test(N), t) )),
                 wait_until(test_scheduler:count(5), 5) )),
    findall(X, event(X), E).
test(in_the_past, true(E == [x-t])) :-
    scheduling(( alarm_set(0, test(x), t),
                 wait_until(test_scheduler:happened(x-t), 5) )),
    findall(X, event(X), E).
test(several_at_one_time, true(N == 10)) :-
    scheduling(( at(0.02, T),
                 forall(between(1, 10, I), alarm_set(T, test(I), t)),
                 wait_until(test_scheduler:count(10), 5) )),
    count(N).
test(cleared, true(E == [y-t])) :-
    scheduling(( at(0.05, T), at(0.1, U),
                 alarm_set(T, test(x), t),
                 alarm_set(U, test(y), t),
                 alarm_clear(T, test(x), t),
                 wait_until(test_scheduler:happened(y-t), 5) )),
    findall(X, event(X), E).
test(clear_what_is_not_set) :-
    scheduling(( at(0.05, T), alarm_clear(T, test(x), t) )).
test(an_earlier_one_comes_later, true(E == [early-t,late-t])) :-
    scheduling(( at(0.2, T), at(0.05, U),
                 alarm_set(T, test(late), t),
                 alarm_set(U, test(early), t),
                 wait_until(test_scheduler:count(2), 5) )),
    findall(X, event(X), E).
test(thousands, true(N == 5000)) :-
    scheduling(( at(0.2, T),
                 forall(between(1, 5000, I),
                        ( S is T+(I mod 97)*0.001, alarm_set(S, test(I), t) )),
                 wait_until(test_scheduler:count(5000), 10) )),
    count(N).
test(none_go_off_after_the_stop, true(N == 0)) :-
    scheduling(( at(1000, T), alarm_set(T, test(x), t) )),
    count(N).

:- end_tests(alarms).
