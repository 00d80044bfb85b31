% leader.pl: election in any network, by candidates that see every host

:- agent(leader, [state([seen/1])]).

main :-
    sense(rank(Mine)),
    explore(compare(Mine)),
    retractall(seen(_)),
    explore(announce(Mine)).

explore(Task) :-
    here(Here),
    assertz(seen(Here)),
    do(Task),
    neighbours(Hosts),
    explore(Hosts, Here, Task).

explore([], _, _).
explore([Host|Hosts], Here, Task) :-
    (   seen(Host)
    ->  true
    ;   move(Host),
        explore(Task),
        move(Here)
    ),
    explore(Hosts, Here, Task).

do(compare(Mine)) :-
    sense(rank(Rank)),
    (   Rank > Mine
    ->  dispose
    ;   true
    ).
do(announce(Mine)) :-
    leave(leader(Mine)).
