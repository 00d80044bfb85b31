% A host requests water by a pheromone.         swipl examples/pheromone.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    forall(member(Host, [farm, wood, road, town]), host_start(Host)),
    link(farm, wood), link(wood, road), link(road, town),
    brigade(Program),
    agent_create(Program, Agent, [host(road)]),
    remote(farm, leave(fire)),
    remote(farm, emit(need(water))),    % spreads up to three hops
    agent_join(Agent, done, 10).

% The strategy phercon(P) follows the pheromones for P to where they are
% stronger; without any it moves conscientiously.

brigade(clauses(
    [ (:- agent(brigade, [])),

      (main :-
           take(fire),
           !,
           withdraw(need(water)),       % removed from all hosts around
           here(Here),
           format("~w: the fire is out~n", [Here])),
      (main :-
           pheromone(need(_), Source, Strength),
           !,
           here(Here),
           format("~w: ~0f % from ~w~n", [Here, Strength, Source]),
           next_host(phercon(need(_)), Next),
           move(Next),
           main),
      (main :-
           sleep(0.1),
           main)
    ])).
