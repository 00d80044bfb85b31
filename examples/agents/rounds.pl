% Moves to a random neighbour, ten times, and logs each hop.

:- agent(rounds, []).

main :-
    rounds(10).

rounds(0) :-
    !.
rounds(N) :-
    neighbours(Hosts),
    random_member(Host, Hosts),
    move(Host),
    hops(Hop),
    log(hop(Hop, Host)),
    N1 is N-1,
    rounds(N1).
