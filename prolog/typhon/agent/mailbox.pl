:- module(typhon_mailbox,
          [ mail_put/2,                 % +Id, +Messages
            mail_first/2,               % +Id, ?Message
            mail_take/2,                % +Id, ?Message
            mail_all/2,                 % +Id, -Messages
            mail_list/2,                % +Id, -Messages
            mail_count/2,               % +Id, -Count
            mail_back/2                 % +Id, +Messages
          ]).
:- use_module('../base/fifo', [fifo_empty/2, fifo_first/2, fifo_take/2]).

/** <module> The mailboxes of agents

A mailbox is a message queue, made for the first message and gone with the
agent.  A table of messages that all agents share would not do: while other
threads add clauses to it, listing those of one agent yields some twice
(9.0.4, retract/1, clause/2 and the bare call alike).  It would be slower,
too.

*Threading*: inside with_agent/2 of the agent, see typhon_agents; only
mail_put/2 may add to a queue, and nobody waits at one.  Who runs the agent
may take the first message without: nobody else takes any meanwhile.
*/

:- dynamic box/2.                       % Id, Queue

%!  mail_put(+Id, +Messages:list) is det.

mail_put(_, []) :-
    !.
mail_put(Id, Messages) :-
    box(Id, Queue),
    !,
    put_all(Messages, Queue).
mail_put(Id, Messages) :-
    message_queue_create(Queue),
    assertz(box(Id, Queue)),
    put_all(Messages, Queue).

put_all([], _).
put_all([Message|Messages], Queue) :-
    thread_send_message(Queue, Message),
    put_all(Messages, Queue).

%!  mail_first(+Id, ?Message) is semidet.
%!  mail_take(+Id, ?Message) is semidet.
%
%   The oldest message, if it unifies; the oldest one that does.

mail_first(Id, Message) :-
    box(Id, Queue),
    fifo_first(Queue, Message).

mail_take(Id, Message) :-
    box(Id, Queue),
    fifo_take(Queue, Message).

%!  mail_all(+Id, -Messages:list) is det.
%!  mail_list(+Id, -Messages:list) is det.
%
%   All messages, the oldest first.  mail_all/2 takes the mailbox away.

mail_all(Id, Messages) :-
    (   retract(box(Id, Queue))
    ->  fifo_empty(Queue, Messages),
        message_queue_destroy(Queue)
    ;   Messages = []
    ).

mail_list(Id, Messages) :-
    (   box(Id, Queue)
    ->  fifo_empty(Queue, Messages),
        put_all(Messages, Queue)
    ;   Messages = []
    ).

%!  mail_count(+Id, -Count:nonneg) is det.

mail_count(Id, Count) :-
    box(Id, Queue),
    catch(message_queue_property(Queue, size(Count0)),
          error(existence_error(_, _), _), fail),
    !,
    Count = Count0.
mail_count(_, 0).

%!  mail_back(+Id, +Messages:list) is det.
%
%   Messages were there before those that are there now.

mail_back(_, []) :-
    !.
mail_back(Id, Older) :-
    mail_all(Id, Newer),
    mail_put(Id, Older),
    mail_put(Id, Newer).
