:- module(typhon_no_queues, []).

/** <module> Message queues where Prolog has none

A Prolog that was built without threads, as that for WebAssembly, has no message
queues and mutexes.  There this module defines those of their predicates that
the kernel uses, and puts them in module `user`, where all modules find them.  A
queue is then what its name says: nothing can come to it while the caller waits.

*Threading*: there is one thread.
*/

:- if(\+ predicate_property(system:message_queue_create(_), defined)).

:- dynamic
    queue/1,                    % Queue
    message/2.                  % Queue, Message

user:message_queue_create(Queue) :-
    typhon_no_queues:create(Queue).
user:message_queue_create(Queue, _Options) :-
    typhon_no_queues:create(Queue).
user:message_queue_destroy(Queue) :-
    typhon_no_queues:must_exist(Queue),
    retractall(typhon_no_queues:queue(Queue)),
    retractall(typhon_no_queues:message(Queue, _)).
user:message_queue_property(Queue, size(Size)) :-
    typhon_no_queues:must_exist(Queue),
    aggregate_all(count, typhon_no_queues:message(Queue, _), Size).
user:thread_send_message(Queue, Message) :-
    typhon_no_queues:must_exist(Queue),
    assertz(typhon_no_queues:message(Queue, Message)).
user:thread_peek_message(Queue, Message) :-
    typhon_no_queues:must_exist(Queue),
    typhon_no_queues:message(Queue, Message),
    !.
user:thread_get_message(Queue, Message) :-
    (   user:thread_get_message(Queue, Message, [])
    ->  true
    ;   throw(error(system_error(deadlock), _))
    ).
user:thread_get_message(Queue, Message, _Options) :-
    typhon_no_queues:must_exist(Queue),
    retract(typhon_no_queues:message(Queue, Message)),
    !.
user:mutex_create(Mutex) :-
    gensym('typhon mutex ', Mutex).
user:mutex_destroy(_).
user:is_thread(main).

create(Queue) :-
    (   var(Queue)
    ->  gensym('typhon queue ', Queue)
    ;   true
    ),
    assertz(queue(Queue)).

must_exist(Queue) :-
    (   queue(Queue)
    ->  true
    ;   throw(error(existence_error(message_queue, Queue), _))
    ).

:- endif.
