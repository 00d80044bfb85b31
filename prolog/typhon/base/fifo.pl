:- module(typhon_fifo,
          [ fifo_take/2,                % +Queue, ?Message
            fifo_empty/2                % +Queue, -Messages
          ]).

/** <module> Message queues as plain queues

A message queue keeps terms in order at little cost, and its owner may add
and take as from any other store: without ever waiting.  In sig_atomic/1 a
wait that expires does not end on 9.0.4, see typhon_own_thread.

*Threading*: only for queues from which nobody else takes at the same time.
*/

%!  fifo_take(+Queue, ?Message) is semidet.
%!  fifo_empty(+Queue, -Messages:list) is det.
%
%   Take the first message of Queue that unifies, or all of them.

fifo_take(Queue, Message) :-
    thread_peek_message(Queue, Message),
    thread_get_message(Queue, Message, [timeout(0)]).

fifo_empty(Queue, Messages) :-
    (   fifo_take(Queue, Message)
    ->  Messages = [Message|More],
        fifo_empty(Queue, More)
    ;   Messages = []
    ).
