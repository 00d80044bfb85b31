:- module(typhon_fifo,
          [ fifo_next/2,                % +Queue, -Message
            fifo_take/2,                % +Queue, ?Message
            fifo_empty/2                % +Queue, -Messages
          ]).

/** <module> Message queues as plain queues

A message queue keeps terms in order at little cost, and its owner may add
and take as from any other store.

What is taken by a pattern is not looked at before: on 9.0.4, also 10.1,
thread_peek_message/2 that has passed over a message leaves a reference to
what is no more, and a garbage collection while it reads the next one damages
the stacks of the thread.

*Threading*: only for queues from which nobody else takes at the same time.
*/

%!  fifo_next(+Queue, -Message) is semidet.
%!  fifo_empty(+Queue, -Messages:list) is det.
%
%   Take the first message of Queue, or all of them.  These never wait.

fifo_next(Queue, Message) :-
    thread_peek_message(Queue, _),
    thread_get_message(Queue, Message).

fifo_empty(Queue, Messages) :-
    (   fifo_next(Queue, Message)
    ->  Messages = [Message|More],
        fifo_empty(Queue, More)
    ;   Messages = []
    ).

%!  fifo_take(+Queue, ?Message) is semidet.
%
%   Take the first message of Queue that unifies.  Not in sig_atomic/1: if
%   there is none this is a wait that expires, see typhon_own_thread.

fifo_take(Queue, Message) :-
    thread_get_message(Queue, Message, [timeout(0)]).
