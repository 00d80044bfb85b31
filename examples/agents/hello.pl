% Logs where it is, moves to each neighbour in turn, and comes home.

:- agent(hello, []).

main :-
    here(Here),
    log(hello_from(Here)),
    neighbours(Hosts),
    tour(Hosts).

tour([]) :-
    home(Home),
    move(Home).
tour([Host|Hosts]) :-
    move(Host),
    log(hello_from(Host)),
    tour(Hosts).
