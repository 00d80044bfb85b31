:- module(typhon_mailbox,
          [ mail_put/2,                 % +Id, +Messages
            mail_wakes/3,               % +Status, +Id, +Messages
            mail_take/2,                % +Id, ?Message
            mail_all/2,                 % +Id, -Messages
            mail_drop/1,                % +Id
            mail_list/2,                % +Id, -Messages
            mail_waits/1,               % +Id
            mail_count/2,               % +Id, -Count
            mail_full/2,                % +Id, +From
            mail_fitting/4,             % +Id, +Mail, -Fitting, -Rest
            mail_back/2,                % +Id, +Messages
            agent_order/2,              % +Id, +Order
            agent_unorder/2,            % +Id, ?Order
            agent_unorder_all/2,        % +Id, -Orders
            agent_orders/2,             % +Id, -Orders
            agent_ordered/1             % +Id
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(identity, [with_agent/2]).
:- use_module('../base/fifo', [fifo_empty/2, fifo_size/2, fifo_take/2]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/durable',
              [ durable/6, durable_drop/3, durable_drop_all/2,
                durable_number/1, durable_on/0, durable_put/4,
                enqueue_changes/0 ]).

/** <module> The mailbox and the orders of an agent

A mailbox is a message queue, made for the first message and removed with the
agent.  One table of messages for all agents would not do: while other threads
add clauses to it, enumerating those of one agent yields some twice (9.0.4,
retract/1, clause/2 and the bare call alike).  It would be slower, too.

Each message has a number, its key in the journal, if there is one.  A message
is in the journal before it can be taken, so it cannot be taken twice.

*Threading*: inside with_agent/2 of the agent, see typhon_agents; only
mail_put/2 may add to a queue, and no thread waits for one.
*/

%   Named after typhon_creation because users set it by that name.

:- setting(typhon_creation:faulty_mail, nonneg, 1000,
           "Messages kept for an agent that is faulty").
:- setting(messages, between(1000, 1 000 000 000), 100 000,
           "Messages that wait in the mailbox of an agent").

:- dynamic
    box/2,                      % Id, Queue
    order/2.                    % Id, Order: the oldest first

%!  mail_put(+Id, +Messages:list) is det.
%
%   Add Messages, From-Message, to the mailbox of Id.

mail_put(_, []) :-
    !.
mail_put(Id, Messages) :-
    log_mail(Messages, Id),
    box_of(Id, Queue),
    (   durable_on
    ->  noted(Messages, Id, Numbered),
        enqueue_changes,
        put_all(Numbered, Queue)
    ;   put_bare(Messages, Queue)
    ).

log_mail([], _).
log_mail([Message|Messages], Id) :-
    debug(typhon(mail), '~w: gets ~p', [Id, Message]),
    log_mail(Messages, Id).

box_of(Id, Queue) :-
    box(Id, Queue),
    !.
box_of(Id, Queue) :-
    message_queue_create(Queue),
    assertz(box(Id, Queue)).

:- durable(mail, Id, N, Message, mail_item(Id, Message),
           mail_restore(Id, N, Message)).

mail_item(Id, Message) :-
    box(Id, _),
    with_agent(Id, mail_list(Id, Messages)),
    member(Message, Messages).

mail_restore(Id, N, Message) :-
    box_of(Id, Queue),
    thread_send_message(Queue, mail(Message, N)).

noted([], _, []).
noted([Message|Messages], Id, [mail(Message, N)|Numbered]) :-
    durable_number(N),
    durable_put(mail, Id, N, Message),
    noted(Messages, Id, Numbered).

put_bare([], _).
put_bare([Message|Messages], Queue) :-
    thread_send_message(Queue, mail(Message, 0)),
    put_bare(Messages, Queue).

put_all([], _).
put_all([Message|Messages], Queue) :-
    thread_send_message(Queue, Message),
    put_all(Messages, Queue).

%!  mail_wakes(+Status, +Id, +Messages:list) is semidet.
%
%   Add Messages to the mailbox of Id, which rests with that Status.  Succeeds if
%   Id waits for one of them.

mail_wakes(faulty(_), Id, Messages) :-
    !,
    mail_keep(Id, Messages),
    fail.
mail_wakes(Status, Id, Messages) :-
    mail_put(Id, Messages),
    wakes(Status, Messages).

wakes(resident, [_|_]).
wakes(waiting(Pattern, _), Messages) :-
    member(Message, Messages),
    \+ Pattern \= Message,
    !.

%   mail_keep(+Id, +Messages): as mail_put/2, for an agent that is faulty:
%   messages beyond the setting are dropped.  A full mailbox is reported once.

mail_keep(_, []).
mail_keep(Id, [Message|Messages]) :-
    setting(typhon_creation:faulty_mail, Max),
    mail_count(Id, Count),
    (   Count < Max
    ->  mail_put(Id, [Message])
    ;   debug(typhon(mail), '~w: has no space for ~p', [Id, Message])
    ),
    (   Count =:= Max-1
    ->  report(warning, full_mailboxes, Id, typhon(mailbox_full(Id, Max)))
    ;   true
    ),
    mail_keep(Id, Messages).

%!  mail_take(+Id, ?Message) is semidet.
%
%   Take the oldest message that unifies with Message.

mail_take(Id, Message) :-
    box(Id, Queue),
    fifo_take(Queue, mail(Message, N)),
    (   durable_on
    ->  durable_drop(mail, Id, N)
    ;   true
    ).

%!  mail_all(+Id, -Messages:list) is det.
%
%   All messages, the oldest first.  Removes the mailbox.

mail_all(Id, Messages) :-
    (   retract(box(Id, Queue))
    ->  fifo_empty(Queue, Numbered),
        bare(Numbered, Messages),
        durable_drop_all(mail, Id),
        message_queue_destroy(Queue)
    ;   Messages = []
    ).

%!  mail_drop(+Id) is det.
%
%   Remove the mailbox with its messages.

mail_drop(Id) :-
    (   retract(box(Id, Queue))
    ->  durable_drop_all(mail, Id),
        message_queue_destroy(Queue)
    ;   true
    ).

%!  mail_list(+Id, -Messages:list) is det.
%
%   All messages, the oldest first.

mail_list(Id, Messages) :-
    (   box(Id, Queue)
    ->  fifo_empty(Queue, Numbered),
        bare(Numbered, Messages),
        put_all(Numbered, Queue)
    ;   Messages = []
    ).

bare([], []).
bare([mail(Message, _)|Numbered], [Message|Messages]) :-
    bare(Numbered, Messages).

%!  mail_waits(+Id) is semidet.
%
%   Id may have messages: it has a mailbox, because messages have arrived.

mail_waits(Id) :-
    box(Id, _),
    !.

%!  mail_count(+Id, -Count:nonneg) is det.

mail_count(Id, Count) :-
    box(Id, Queue),
    !,
    fifo_size(Queue, Count).
mail_count(_, 0).

%!  mail_full(+Id, +From) is semidet.
%
%   The mailbox of Id has no space for a message of From.  It always has space
%   for those of the platform, which are from `system`, and few.

mail_full(Id, From) :-
    box(Id, Queue),
    message_queue_property(Queue, size(Count)),
    Count >= 1000,                      % a setting costs a tenth of a message
    setting(messages, Max),
    Count >= Max,
    From \== system.

%!  mail_fitting(+Id, +Mail:list, -Fitting:list, -Rest:list) is det.
%
%   The mailbox of Id has space for Fitting, which are those of Mail, terms
%   mail(_, From, _), that fit or are from `system`, but not for Rest.

mail_fitting(Id, Mail, Fitting, Rest) :-
    mail_count(Id, Count),
    length(Mail, More),
    (   Count+More < 1000
    ->  Fitting = Mail,
        Rest = []
    ;   setting(messages, Max),
        Space is max(0, Max-Count),
        fitting(Mail, Space, Fitting, Rest)
    ).

fitting([], _, [], []).
fitting([Mail|Mails], Space, [Mail|Fitting], Rest) :-
    ( Space > 0 ; Mail = mail(_, system, _) ),
    !,
    Space1 is Space-1,
    fitting(Mails, Space1, Fitting, Rest).
fitting([Mail|Mails], Space, Fitting, [Mail|Rest]) :-
    fitting(Mails, Space, Fitting, Rest).

%!  mail_back(+Id, +Messages:list) is det.
%
%   Put Messages before those in the mailbox.  This does not end the unit of
%   work: the caller does, once it has noted the new status of the agent, and no
%   message can be taken before.

mail_back(_, []) :-
    !.
mail_back(Id, Older) :-
    mail_all(Id, Newer),
    append(Older, Newer, Messages),
    box_of(Id, Queue),
    (   durable_on
    ->  noted(Messages, Id, Numbered),
        put_all(Numbered, Queue)
    ;   put_bare(Messages, Queue)
    ).

                /*******************************
                *             ORDERS            *
                *******************************/

%!  agent_order(+Id, +Order) is det.

agent_order(Id, Order) :-
    assertz(order(Id, Order)).

%!  agent_unorder(+Id, ?Order) is semidet.
%
%   Take the oldest order that unifies with Order.

agent_unorder(Id, Order) :-
    retract(order(Id, Order)),
    !.

%!  agent_unorder_all(+Id, -Orders:list) is det.
%
%   Take all orders, each by a call of its own: one enumeration could yield some
%   twice, see above.

agent_unorder_all(Id, Orders) :-
    (   retract(order(Id, Order))
    ->  Orders = [Order|More],
        agent_unorder_all(Id, More)
    ;   Orders = []
    ).

%!  agent_ordered(+Id) is semidet.

agent_ordered(Id) :-
    order(Id, _),
    !.

%!  agent_orders(+Id, -Orders:list) is det.
%
%   Orders are the orders that Id has not taken yet, the oldest first.

agent_orders(Id, Orders) :-
    findall(Order, order(Id, Order), Orders).
