% Messages between agents, one of which moves.    swipl examples/messages.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(alpha),
    host_start(beta),
    counter(Counter),
    client(Client),
    agent_create(Counter, Server, [host(alpha)]),
    agent_create(Client, Agent, [host(beta), facts([server(Server)])]),
    agent_join(Agent, done, 10).

% An agent with on_message/2 stays when it has nothing else to do.

counter(clauses(
    [ (:- agent(counter, [state([count/1])])),
      count(0),
      (on_message(From, add(N)) :-
           retract(count(Old)),
           New is Old+N,
           assertz(count(New)),
           send(From, sum(New)),
           move(beta))                  % messages follow it to beta
    ])).

client(clauses(
    [ (:- agent(client, [state([server/1])])),
      (main :-
           server(Server),
           send(Server, add(5)),
           send(Server, add(37)),
           receive(_-sum(First)),
           receive(_-sum(Second), 5),   % fails after five seconds
           format("~w, then ~w~n", [First, Second]))
    ])).
