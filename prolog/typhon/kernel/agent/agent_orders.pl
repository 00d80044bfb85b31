:- module(typhon_agent_orders,
          [ agent_order/2,              % +Id, +Order
            agent_unorder/2,            % +Id, ?Order
            agent_unorder_all/2,        % +Id, -Orders
            agent_orders/2,             % +Id, -Orders
            agent_ordered/1             % +Id
          ]).

/** <module> Orders for agents

*Threading*: inside with_agent/2 of the agent.
*/

:- dynamic order/2.             % Id, Order: the oldest first

%!  agent_order(+Id, +Order) is det.
%!  agent_unorder(+Id, ?Order) is semidet.
%!  agent_unorder_all(+Id, -Orders:list) is det.
%!  agent_ordered(+Id) is semidet.
%!  agent_orders(+Id, -Orders:list) is det.
%
%   Note an order; take the oldest that unifies; take all; whether there is one;
%   all there are.

agent_order(Id, Order) :-
    assertz(order(Id, Order)).

agent_unorder(Id, Order) :-
    retract(order(Id, Order)),
    !.

%   One by one: see typhon_mailbox.

agent_unorder_all(Id, Orders) :-
    (   retract(order(Id, Order))
    ->  Orders = [Order|More],
        agent_unorder_all(Id, More)
    ;   Orders = []
    ).

agent_ordered(Id) :-
    order(Id, _),
    !.

agent_orders(Id, Orders) :-
    findall(Order, order(Id, Order), Orders).
