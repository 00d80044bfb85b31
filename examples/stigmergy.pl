% Agents that never meet, and share a host.       swipl examples/stigmergy.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(field),
    host_start(nest),
    forall(between(1, 3, N), remote(field, leave(food(N)))),
    ant(Program),
    findall(Ant,
            ( between(1, 5, _),
              agent_create(Program, Ant, [host(nest)])
            ),
            Ants),
    forall(member(Ant, Ants), agent_join(Ant, done, 10)),
    remote(nest, findall(N, sense(stored(N)), Stored)),
    format("In the nest: ~w~n", [Stored]).

% Every host has a tuple space.  Only one of several agents can take a fact.

ant(clauses(
    [ (:- agent(ant, [])),

      (main :-
           move(field),
           (   take(food(N))
           ->  format("An ant found food ~w~n", [N]),
               move(nest),
               leave(stored(N))
           ;   format("An ant found nothing~n")
           ))
    ])).
