% An agent visits hosts and collects facts.       swipl examples/tour.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    forall(member(Host, [base, north, east, south]), host_start(Host)),
    forall(member(Host, [north, east, south]), link(base, Host)),
    tourist(Program),
    agent_create(Program, Agent, [host(base)]),
    agent_join(Agent, done, 10).

% Facts of the predicates in state/1 are the memory of the agent: it carries
% them.  The bindings of the loop travel as well.

tourist(clauses(
    [ (:- agent(tourist, [state([seen/2])])),

      (main :-
           neighbours(Hosts),
           tour(Hosts),
           home(Home),
           move(Home),
           forall(seen(Host, Hop), format("hop ~w: ~w~n", [Hop, Host]))),

      tour([]),
      (tour([Host|Hosts]) :-
           move(Host),
           here(Here),
           hops(Hop),
           assertz(seen(Here, Hop)),
           tour(Hosts))
    ])).
