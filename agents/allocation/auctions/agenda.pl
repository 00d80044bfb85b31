% Expects: heard/2 and perform/2, which handle messages and due items.
% Gives: node_loop/0, at/2, after/2; its state.

/*  The agenda of a node.

        agenda(Next, Dues)      Dues are pairs Due-Key in order of time; Next
                                is the next Key
        item(Key, What)         the item, an argument of perform/2
*/

:- dynamic agenda/2, item/2.

%!  node_loop.
%
%   The main loop of a node: handles messages and due items.

node_loop :-
    next_due(Left),
    (   receive(From-Message, Left)
    ->  heard(Message, From)
    ;   true
    ),
    do_due,
    node_loop.

next_due(Left) :-
    (   agenda(_, [Due-_|_])
    ->  now(Now),
        Left is max(0, Due - Now)
    ;   Left = inf
    ).

do_due :-
    agenda(_, [Due-_|_]),
    now(Now),
    Due =< Now,
    !,
    retract(agenda(Next, [_-Key|Rest])),
    assertz(agenda(Next, Rest)),
    retract(item(Key, What)),
    perform(What, Due),
    do_due.
do_due.

%!  at(+Due, +What) is det.
%!  after(+Seconds, +What) is det.
%
%   Schedule the call perform(What, Due) at host time Due, or in Seconds.

at(Due, What) :-
    retract(agenda(Key, Dues0)),
    Next is Key + 1,
    insert_due(Dues0, Due, Key, Dues),
    assertz(agenda(Next, Dues)),
    assertz(item(Key, What)).

insert_due([Due0-Key0|Rest0], Due, Key, [Due0-Key0|Rest]) :-
    Due0 =< Due,
    !,
    insert_due(Rest0, Due, Key, Rest).
insert_due(Rest, Due, Key, [Due-Key|Rest]).

after(Seconds, What) :-
    now(Now),
    Due is Now + Seconds,
    at(Due, What).
