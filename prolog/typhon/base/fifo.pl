:- module(typhon_fifo,
          [ fifo_take/2,                % +Queue, ?Message
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

%!  fifo_take(+Queue, ?Message) is semidet.
%
%   Take the first message of Queue that unifies.  Not in sig_atomic/1: if
%   there is none this is a wait that expires, see typhon_own_thread.

fifo_take(Queue, Message) :-
    thread_get_message(Queue, Message, [timeout(0)]).

%!  fifo_empty(+Queue, -Messages:list) is det.
%
%   Take all messages of Queue.  Never waits.

fifo_empty(Queue, Messages) :-
    (   thread_peek_message(Queue, _)
    ->  Messages = [Message|More],
        thread_get_message(Queue, Message),
        fifo_empty(Queue, More)
    ;   Messages = []
    ).
