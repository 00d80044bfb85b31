% sum.pl: adds the numbers on the neighbours

:- agent(sum, []).

main :-
    neighbours(Hosts),
    sum(Hosts, Sum),
    result(Sum).

sum([], 0) :-
    home(Home),
    move(Home).
sum([Host|Hosts], Sum) :-
    move(Host),
    sense(number(N)),
    sum(Hosts, Rest),
    Sum is N+Rest.
