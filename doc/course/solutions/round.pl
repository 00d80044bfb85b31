% round.pl: goes once round a ring

:- agent(round, []).

main :-
    here(Home),
    neighbours([Next|_]),
    walk(Next, Home, Home, Hosts),
    result(Hosts).

%   walk(+Next, +From, +Home, -Hosts): Hosts are those from Next to Home.

walk(Home, _, Home, [Home]) :-
    !,
    move(Home).
walk(Host, From, Home, [Host|Hosts]) :-
    move(Host),
    neighbours(Around),
    subtract(Around, [From], [Next]),
    walk(Next, Host, Home, Hosts).
