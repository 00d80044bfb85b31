% sorter.pl: inserts its number into a sorted line of hosts

:- agent(sorter, [state([mine/1])]).

main :-
    mine(N),
    insert(N, none).

insert(N, From) :-
    (   take(number(M))
    ->  Less is min(N, M),
        More is max(N, M),
        leave(number(Less)),
        here(Here),
        neighbours(Hosts),
        subtract(Hosts, [From], [Next]),
        move(Next),
        insert(More, Here)              % continue with the greater number
    ;   leave(number(N))
    ).
