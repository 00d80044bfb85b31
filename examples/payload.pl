% A courier brings code to a host.                swipl examples/payload.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(alpha),
    host_start(beta),
    courier(Program),
    converter(Payload),
    agent_create(Program, Agent, [host(alpha), payloads([Payload])]),
    agent_join(Agent, done, 10),
    remote(beta, fahrenheit(20, F)),    % every program on beta can use it
    format("On beta 20 C are ~w F~n", [F]).

% A payload is code and data that an agent carries: it belongs to the agent
% until it is delivered to a host.

converter(clauses(
    [ (:- payload(converter, [provides([fahrenheit/2])])),
      (fahrenheit(C, F) :- F is C*9/5+32)
    ])).

courier(clauses(
    [ (:- agent(courier, [])),

      (main :-
           fahrenheit(100, F),
           format("The courier knows: 100 C are ~w F~n", [F]),
           move(beta),
           deliver(converter))
    ])).
