% Logs its host, moves to each neighbour in turn, and returns home.

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
