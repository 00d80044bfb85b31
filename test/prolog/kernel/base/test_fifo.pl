:- module(test_fifo, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/base/fifo)).

/** <module> Message queues as plain queues

*Threading*: the thread of the test, and one that ends at once.
*/

:- begin_tests(fifo).

test(messages_are_in_the_order_of_sending, Messages == [1, 2, 3]) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( forall(member(N, [1, 2, 3]), fifo_send(Queue, N)),
          fifo_empty(Queue, Messages) ),
        message_queue_destroy(Queue)).
test(message_to_a_destroyed_queue_fails, fail) :-
    message_queue_create(Queue),
    message_queue_destroy(Queue),
    fifo_send(Queue, x).
test(message_to_a_thread_that_has_ended_fails, fail) :-
    no_leaks(( thread_create(true, Thread),
               thread_join(Thread, _) )),
    fifo_send(Thread, x).
test(other_errors_are_raised, error(instantiation_error)) :-
    fifo_send(_, x).

:- end_tests(fifo).
