:- module(typhon_fifo,
          [ fifo_send/2,                % +Queue, +Message
            fifo_take/2,                % +Queue, ?Message
            fifo_empty/2,               % +Queue, -Messages
            fifo_size/2                 % +Queue, -Size
          ]).

/** <module> Message queues as plain queues

A message queue keeps terms in order at little cost.  Here its owner adds and
takes terms as in any other store.

Code that takes by a pattern must not peek first: on 9.0.4, also 10.1,
thread_peek_message/2 that has passed over a message leaves a reference to a
freed term, and a garbage collection while it reads the next message damages
the stacks of the thread.

A Prolog that was built without threads, such as that for WebAssembly, has no
message queues and mutexes.  There the end of this module defines those of
their predicates that the kernel uses, in module `user`, where all modules find
them.  Such a queue cannot wait: no message can arrive while the caller waits.

*Threading*: any thread sends; the rest is only for queues with one reader at a
time.
*/

%!  fifo_send(+Queue, +Message) is semidet.
%
%   Add Message to Queue, a message queue or a thread.  Fails if there is none:
%   its reader no longer waits, or has ended.

fifo_send(Queue, Message) :-
    catch(thread_send_message(Queue, Message),
          error(existence_error(_, _), _),
          fail).

%!  fifo_empty(+Queue, -Messages:list) is det.
%
%   Take all messages of Queue.  Never waits.

fifo_empty(Queue, Messages) :-
    (   fifo_first(Queue, Message)
    ->  Messages = [Message|More],
        fifo_empty(Queue, More)
    ;   Messages = []
    ).

fifo_first(Queue, Message) :-
    thread_peek_message(Queue, First),
    First = Message,
    thread_get_message(Queue, _).

%!  fifo_size(+Queue, -Size) is det.
%
%   Queue holds Size messages; 0 if it has just been destroyed.

fifo_size(Queue, Size) :-
    catch(message_queue_property(Queue, size(Size0)),
          error(existence_error(_, _), _),
          fail),
    !,
    Size = Size0.
fifo_size(_, 0).

%!  fifo_take(+Queue, ?Message) is semidet.
%
%   Take the first message of Queue that unifies; no thread may add to it
%   meanwhile.  Not in sig_atomic/1: if none of many messages unifies this is a
%   wait that expires, see typhon_own_thread.
%
%   That wait costs as much as to take out and put back a dozen messages.

fifo_take(Queue, Message) :-
    thread_peek_message(Queue, First),
    (   First = Message                 % nearly always true
    ->  thread_get_message(Queue, _)
    ;   fifo_take_later(Queue, Message)
    ).

fifo_take_later(Queue, Message) :-
    message_queue_property(Queue, size(Size)),
    (   Size > 16
    ->  thread_get_message(Queue, Message, [timeout(0)])
    ;   sig_atomic(rotate(Size, first, Queue, Message))
    ).

%   rotate(+Size, +Seen, +Queue, ?Message): Seen is `first` as long as no
%   message has been put back, then `none`, or `found`.

rotate(0, Seen, _, _) :-
    !,
    Seen == found.
rotate(Size, Seen0, Queue, Message) :-
    thread_get_message(Queue, Next),
    Left is Size-1,
    (   Seen0 \== found,
        Next = Message
    ->  (   Seen0 == first
        ->  true                        % the other messages are in order
        ;   rotate(Left, found, Queue, Message)
        )
    ;   thread_send_message(Queue, Next),
        seen(Seen0, Seen),
        rotate(Left, Seen, Queue, Message)
    ).

seen(first, none).
seen(none, none).
seen(found, found).

                /*******************************
                *       WITHOUT THREADS        *
                *******************************/

:- if(\+ predicate_property(system:message_queue_create(_), defined)).

:- use_module(library(gensym), [gensym/2]).

:- dynamic
    queue/2,                    % Queue, Size
    message/2.                  % Queue, Message

system:message_queue_create(Queue) :-
    typhon_fifo:create(Queue).
system:message_queue_create(Queue, _Options) :-
    typhon_fifo:create(Queue).
system:message_queue_destroy(Queue) :-
    typhon_fifo:size(Queue, _),
    retractall(typhon_fifo:queue(Queue, _)),
    retractall(typhon_fifo:message(Queue, _)).
system:message_queue_property(Queue, size(Size)) :-
    typhon_fifo:size(Queue, Size).
system:thread_send_message(Queue, Message) :-
    typhon_fifo:add(Queue, 1),
    assertz(typhon_fifo:message(Queue, Message)).
system:thread_peek_message(Queue, Message) :-
    typhon_fifo:size(Queue, _),
    typhon_fifo:message(Queue, Message),
    !.
system:thread_get_message(Queue, Message) :-
    (   system:thread_get_message(Queue, Message, [])
    ->  true
    ;   throw(error(system_error(deadlock), _))
    ).
system:thread_get_message(Queue, Message, _Options) :-
    typhon_fifo:size(Queue, _),
    retract(typhon_fifo:message(Queue, Message)),
    !,
    typhon_fifo:add(Queue, -1).
system:mutex_create(Mutex) :-
    gensym('typhon mutex ', Mutex).
system:mutex_destroy(_).
system:is_thread(main).

create(Queue) :-
    (   var(Queue)
    ->  gensym('typhon queue ', Queue)
    ;   true
    ),
    assertz(queue(Queue, 0)).

size(Queue, Size) :-
    (   queue(Queue, Size0)
    ->  Size = Size0
    ;   throw(error(existence_error(message_queue, Queue), _))
    ).

%   Counted here, as a full mailbox is asked for its size with each message.

add(Queue, More) :-
    size(Queue, Size0),
    retractall(queue(Queue, _)),
    Size is Size0+More,
    assertz(queue(Queue, Size)).

:- endif.
