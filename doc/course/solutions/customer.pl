% customer.pl: orders from the nearest agent that does not end before it answers

:- agent(customer, [state([wants/1])]).

main :-
    wants(Thing),
    find(shop(Thing), Found, [radius(inf)]),
    order(Found, Thing).

order([], _) :-
    result(none).
order([Clerk-_|More], Thing) :-
    monitor(Clerk),
    send(Clerk, order(Thing)),
    receive(_-Message),
    (   Message = sold(What)
    ->  result(bought(What))
    ;   order(More, Thing)              % the clerk is down
    ).
