% Moves until it has visited every host of the network.

:- agent(explorer, [state([strategy/1, unseen/1])]).

main :-
    here(Host),
    retract(unseen(Hosts0)),
    delete(Hosts0, Host, Hosts),
    assertz(unseen(Hosts)),
    length(Hosts, Left),
    log(left(Left)),
    explore(Hosts).

explore([]).
explore([_|_]) :-
    strategy(Strategy),
    next_host(Strategy, Next),
    move(Next),
    main.
