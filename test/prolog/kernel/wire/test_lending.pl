:- module(test_lending, []).

/** <module> Tests of readers that run the agents that they have read

The endpoint is connected to itself: its own reader threads read its posts.

*Threading*: the main thread; errands run in those of the endpoint.
*/

:- use_module('../../../lib/common').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/wire)).
:- use_module(library(typhon/kernel/wire/connection_manager),
              [manager_connect/1]).
:- use_module(library(typhon/kernel/wire/session), [route/2, session_send/2]).
:- use_module(library(typhon/kernel/wire/threads), [wire_thread_signal/2]).

:- dynamic
    hook/2,                             % Errand, Thread
    run/3,                              % Errand, How, Thread
    lent/1,                             % Thread
    back/1.                             % Thread

:- multifile
    typhon_endpoint:lent/1,
    typhon_endpoint:received/3,
    typhon_endpoint:returned/0,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, errand, _, none, none).
typhon_kinds:accepts(post, word, _, none, none).

typhon_endpoint:received(errand, Errand, _) :-
    thread_self(Me),
    assertz(hook(Errand, Me)),
    endpoint_afterwards(go(Errand)),
    ( Errand = breaks(_) -> wire_thread_signal(Me, broken) ; true ).
typhon_endpoint:received(word, Word, _) :-
    thread_self(Me),
    assertz(run(Word, read, Me)).

typhon_endpoint:lent(Thread) :-
    assertz(lent(Thread)),
    thread_detach(Thread).

typhon_endpoint:returned :-
    thread_self(Me),
    assertz(back(Me)).

go(Errand, How) :-
    thread_self(Me),
    assertz(run(Errand, How, Me)),
    act(Errand).

act(quick(_)).
act(breaks(_)).
act(waits(Queue, _)) :-
    thread_get_message(Queue, go).

                /*******************************
                *           FIXTURES           *
                *******************************/

:- meta_predicate with_queue(-, 0), alone(-, 0).

%   alone(-Me, :Goal): the endpoint runs at address Me.

alone(Me, Goal) :-
    forall(member(T, [hook(_, _), run(_, _, _), lent(_), back(_)]),
           retractall(T)),
    setup_call_cleanup(
        endpoint_start(localhost, 0, [], Me),
        ( manager_connect(Me), once(Goal) ),
        endpoint_stop).

with_queue(Queue, Goal) :-
    setup_call_cleanup(
        ( Queue = test_lending_go,
          message_queue_create(Queue, [alias(Queue)]) ),
        once(Goal),
        message_queue_destroy(Queue)).

post(Me, Errand) :-
    over_the_wire(Me, post(errand, Errand)).

say(Me, Word) :-
    over_the_wire(Me, post(word, Word)).

%   said(+Me, +Word), waits(+Me, +Queue, +N, -Thread), goes_on(+Queue, +Thread):
%   it has been read; Thread waits in its errand; it has ended.

said(Me, Word) :-
    say(Me, Word),
    wait_until(ran(Word), 10).

waits(Me, Queue, N, Thread) :-
    post(Me, waits(Queue, N)),
    wait_until(ran(waits(_, N)), 5),
    run(waits(_, N), here, Thread).

goes_on(Queue, Thread) :-
    thread_send_message(Queue, go),
    wait_until(gone(Thread), 5).

%   Otherwise posts to the own endpoint are handled at once.

over_the_wire(Me, Frame) :-
    once(route(Me, Session)),
    session_send(Session, Frame).

ran(Errand) :-
    run(Errand, _, _),
    !.

words(Words) :-
    findall(Word, run(Word, read, _), Words).

gone(Thread) :-
    catch(\+ thread_property(Thread, status(running)),
          error(existence_error(_, _), _),
          true).

:- begin_tests(lending, [cleanup(no_threads_left)]).

test(frames_are_handled_by_the_reading_thread, T1 == T2) :-
    alone(Me, ( post(Me, quick(1)),
                wait_until(ran(quick(1)), 5) )),
    hook(quick(1), T1),
    run(quick(1), here, T2).

test(frames_are_handled_by_others_without_a_reader, How == later) :-
    alone(_, endpoint_afterwards(go(quick(1)))),
    run(quick(1), How, _).

test(work_that_a_broken_connection_leaves_is_done_by_others, Hows == [later]) :-
    alone(Me, ( post(Me, breaks(1)),
                wait_until(ran(breaks(1)), 5) )),
    findall(How, run(breaks(1), How, _), Hows).

%   In order; a busy machine may miss one.

test(each_frame_is_handled_once_in_order, Ran == All) :-
    numlist(1, 500, All),
    alone(Me, ( forall(member(N, All), post(Me, quick(N))),
                wait_until(aggregate_all(count, run(_, _, _), 500), 10) )),
    findall(N, run(quick(N), _, _), Ran0),
    (   lent(_)
    ->  msort(Ran0, Ran)
    ;   Ran = Ran0
    ).

test(waiting_handler_does_not_block_others, [Words == All]) :-
    numlist(1, 50, All),
    with_queue(Queue,
               alone(Me, ( waits(Me, Queue, 1, Thread),
                           forall(member(N, All), say(Me, N)),
                           wait_until(ran(50), 10),
                           assertion(lent(Thread)),
                           assertion(\+ back(_)),
                           goes_on(Queue, Thread),
                           post(Me, quick(last)),
                           wait_until(ran(quick(last)), 5) ))),
    words(Words),
    assertion(back(Thread)),
    aggregate_all(count, run(waits(_, 1), _, _), 1).

test(many_waiting_handlers, Lent == 5) :-
    with_queue(Queue,
               alone(Me, ( forall(between(1, 5, N),
                                  post(Me, waits(Queue, N))),
                           wait_until(ran(waits(_, 5)), 30),
                           wait_until(aggregate_all(count, lent(_), 5), 5),
                           forall(between(1, 5, _),
                                  thread_send_message(Queue, go)),
                           wait_until(aggregate_all(count, back(_), 5), 5),
                           wait_until(forall(lent(T), gone(T)), 5) ))),
    aggregate_all(count, lent(_), Lent).

test(handler_is_not_interrupted_by_the_connection) :-
    with_queue(Queue,
               alone(Me, ( waits(Me, Queue, 1, Thread),
                           wire_thread_signal(Thread, broken),
                           said(Me, meanwhile),
                           goes_on(Queue, Thread),
                           said(Me, after) ))).

%   Another signal is pending while this one takes effect.

test(aborted_handler_leaves_no_thread, true(back(Thread))) :-
    with_queue(Queue,
               alone(Me, ( waits(Me, Queue, 1, Thread),
                           wait_until(lent(Thread), 5),
                           thread_signal(Thread,
                                         ( thread_signal(Thread, true),
                                           abort )),
                           wait_until(gone(Thread), 5) ))).

%   The errand goes on only after the stop.

test(endpoint_stops_during_a_waiting_handler, true(lent(Thread))) :-
    with_queue(Queue,
               ( alone(Me, waits(Me, Queue, 1, Thread)),
                 goes_on(Queue, Thread) )).

%   A thread lent by a stopped endpoint does not count in the next one.

test(waiting_handler_is_replaced_after_a_restart) :-
    with_queue(Queue,
               ( alone(Me1, waits(Me1, Queue, 1, First)),
                 alone(Me2, ( waits(Me2, Queue, 2, Second),
                              said(Me2, meanwhile),
                              thread_send_message(Queue, go),
                              goes_on(Queue, Second) )),
                 wait_until(gone(First), 5) )).

test(broken_connections_lose_and_duplicate_nothing, Ran == All) :-
    numlist(1, 3000, All),
    alone(Me, ( forall(member(N, All),
                       ( post(Me, quick(N)),
                         (   N mod 50 =:= 0
                         ->  forall(typhon_session:serving(_, Thread, _),
                                    wire_thread_signal(Thread, broken))
                         ;   true
                         ) )),
                wait_until(aggregate_all(count, run(_, _, _), 3000), 30),
                wait_until(ran(quick(3000)), 30) )),
    findall(N, run(quick(N), _, _), Ran0),
    msort(Ran0, Ran).

%   Lent threads are detached: they may end a moment later.

no_threads_left :-
    wait_until(forall(thread_property(T, alias(Alias)),
                      ( sub_atom(Alias, 0, _, _, typhon_)
                      ->  gone(T)
                      ;   true )), 5).

:- end_tests(lending).
