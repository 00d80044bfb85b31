% shopper.pl: reads the price on each host, and buys at the lowest price

:- agent(shopper, [state([task/2])]).

main :-
    task(Task, Kind),
    neighbours(Hosts),
    ask(Hosts, Kind, Offers),
    min_member(Cost-Best, Offers),
    move(Best),
    leave(done(Task)),
    result(bought(Task, Best, Cost)).

ask([], _, []).
ask([Host|Hosts], Kind, Offers) :-
    move(Host),
    (   sense(cost(Kind, Cost))
    ->  Offers = [Cost-Host|More]
    ;   Offers = More
    ),
    ask(Hosts, Kind, More).
