% Keeps the accounts: hops(Who, Count, Sum) of what hoppers tell, and what
% talkers say out of order.

:- agent(sink, [state([heard/2, hops/3, wrong/3])]).

on_message(_, hop(Who, N)) :-
    (   retract(hops(Who, Count0, Sum0))
    ->  true
    ;   Count0 = 0,
        Sum0 = 0
    ),
    Count is Count0+1,
    Sum is Sum0+N,
    assertz(hops(Who, Count, Sum)).
on_message(_, word(Who, N)) :-
    (   retract(heard(Who, N0))
    ->  true
    ;   N0 = 0
    ),
    (   N =:= N0+1
    ->  true
    ;   assertz(wrong(Who, N0, N))
    ),
    assertz(heard(Who, N)).
