% Visits all neighbours and logs the load of each, back at home.

:- agent(census, [state([seen/2])]).

main :-
    neighbours(Hosts),
    tour(Hosts),
    home(Home),
    move(Home),
    forall(seen(Host, Load), log(seen(Host, Load))).

tour([]).
tour([Host|Hosts]) :-
    move(Host),                         % the next goal runs there
    host_load(Load),
    assertz(seen(Host, Load)),
    tour(Hosts).
