% An agent that rewrites itself as it travels.    swipl examples/rewrite.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(alpha),
    host_start(beta),
    learner(Program),
    agent_create(Program, Agent, [host(alpha)]),
    agent_join(Agent, done, 10).

% Predicates in state/1 may have rules, and the agent may change them while
% it runs.  It carries its own versions.

learner(clauses(
    [ (:- agent(learner, [state([greet/1])])),

      (greet(Host) :-
           format("~w is new to me~n", [Host]),
           asserta((greet(Host) :-
                        !,
                        format("I know ~w~n", [Host])))),

      (main :- tour([alpha, beta, alpha, beta])),

      tour([]),
      (tour([Host|Hosts]) :-
           move(Host),
           greet(Host),
           tour(Hosts))
    ])).
