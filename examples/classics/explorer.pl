% explorer.pl: visits every host of a network, depth first

:- agent(explorer, [state([seen/1])]).

main :-
    explore,
    findall(Host, seen(Host), Hosts),
    result(Hosts).

explore :-
    here(Here),
    assertz(seen(Here)),
    neighbours(Hosts),
    explore(Hosts, Here).

explore([], _).
explore([Host|Hosts], Here) :-
    (   seen(Host)
    ->  true
    ;   move(Host),
        explore,
        move(Here)                      % and continue there
    ),
    explore(Hosts, Here).
