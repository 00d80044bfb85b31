% brigade.pl: follows the call for water, and puts the fire out

:- agent(brigade, []).

main :-
    (   take(fire)
    ->  withdraw(need(water)),
        hops(Hops),
        result(hops(Hops))
    ;   pheromone(need(water), _, _)
    ->  next_host(phercon(need(water)), Next),
        move(Next),
        main
    ;   sleep(0.5),
        main
    ).
