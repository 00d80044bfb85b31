:- module(typhon_keeper_queue,
          [ keeper_queue_open/0,
            keeper_queue_close/1,       % -Unheard
            keeper_tell/1,              % +Message
            keeper_hear/2               % -Message, +Deadline
          ]).

/** <module> What the keeper is told

All threads of the wire tell the keeper what has happened, and what is
wanted, through one queue. It is there as long as the endpoint runs.

*Threading*: keeper_hear/2 is for the keeper, keeper_tell/1 for any thread.
Who opens and closes is one at a time.
*/

:- dynamic
    keeper_queue/1.                     % Queue

%!  keeper_queue_open is det.
%!  keeper_queue_close(-Unheard) is det.
%
%   Unheard are the messages that nobody will hear any more.

keeper_queue_open :-
    message_queue_create(Queue),
    assertz(keeper_queue(Queue)).

keeper_queue_close(Unheard) :-
    with_mutex(typhon_keeper_queue, close_queue(Unheard)).

close_queue(Unheard) :-
    retract(keeper_queue(Queue)),
    findall(Message, unheard(Queue, Message), Unheard),
    message_queue_destroy(Queue).

unheard(Queue, Message) :-
    repeat,
    (   thread_peek_message(Queue, _)
    ->  thread_get_message(Queue, Message)
    ;   !,
        fail
    ).

%!  keeper_tell(+Message) is semidet.
%
%   Tell the keeper; fails when there is none any more.

keeper_tell(Message) :-
    with_mutex(typhon_keeper_queue,
               ( keeper_queue(Queue),
                 thread_send_message(Queue, Message) )).

%!  keeper_hear(-Message, +Deadline) is semidet.
%
%   The next message; fails at Deadline, a time stamp or `infinite`, if
%   there is none.

keeper_hear(Message, Deadline) :-
    keeper_queue(Queue),
    (   ( Deadline == infinite
        ; thread_peek_message(Queue, _) )
    ->  thread_get_message(Queue, Message)
    ;   thread_get_message(Queue, Message, [deadline(Deadline)])
    ).
