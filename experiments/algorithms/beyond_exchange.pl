%   Exchange of the learning algorithm while agents run.

:- include(ground).

study(exchange, "Exchange of the learning algorithm while agents run").

vary(exchange, [none, at(500, greedy, scout)]).
fixed(problem, maze, assumed("with a corner, as in study mixed")).
derive(settings, _, Settings) :-
    findall(Setting, trap(Setting), Settings).
fixed(algorithms, [greedy], assumed("")).
fixed(agents, 4, assumed("")).
fixed(limit, 3000, assumed("host seconds")).

label(none, "greedy throughout").
label(at(_, _, _), "one agent gets scout after 500 s").

claim("more agents reach the light if one gets another algorithm",
      [ours], most(reached, exchange=at(500, greedy, scout))).

plot(exchange, "Four agents in a maze with a corner",
     lines([x(exchange), y([reached, executions])])).
