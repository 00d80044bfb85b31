% An agent that says hello on two hosts.        swipl examples/hello.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(alpha),
    host_start(beta),
    hello(Program),
    agent_create(Program, Agent, [host(alpha)]),
    agent_join(Agent, Outcome, 10),
    format("~w: ~w~n", [Agent, Outcome]).

% The program of the agent: the same terms as in a file.

hello(clauses(
    [ (:- agent(hello, [])),

      (main :-
           greet,
           move(beta),                  % the next goal runs on beta
           greet),

      (greet :-
           here(Host),
           format("Hello from ~w~n", [Host]))
    ])).
