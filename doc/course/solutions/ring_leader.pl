% ring_leader.pl: election in a ring; an agent on each host is a candidate

:- agent(ring_leader, []).

main :-
    rank(Mine),
    here(Home),
    run(Mine),
    announce(Home, Mine).

%   run(+Mine): succeeds if the candidate comes back unbeaten.

run(Mine) :-
    next(Next),
    move(Next),
    rank(Rank),
    (   Rank > Mine
    ->  dispose
    ;   Rank < Mine
    ->  run(Mine)
    ;   true                            % its own host again
    ).

announce(Home, Rank) :-
    leave(leader(Rank)),
    next(Next),
    (   Next == Home
    ->  true
    ;   move(Next),
        announce(Home, Rank)
    ).

rank(Rank) :- sense(rank(Rank)), !.

next(Host) :- sense(next(Host)), !.
