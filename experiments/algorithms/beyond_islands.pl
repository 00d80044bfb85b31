%   A genetic algorithm for printers, with the agents as islands.

:- include(ground).

study(islands, "A genetic algorithm with agents as islands").

vary(population, [islands, apart, one]).
derive(agents, Case, Count) :-
    ( Case.population == one -> Count = 1 ; Count = 6 ).
derive(sharing, Case, Sharing) :-
    ( Case.population == apart -> Sharing = false ; Sharing = true ).
fixed(problem, settings, assumed("printers, doc/algorithms.md")).
fixed(algorithms, [genetic], assumed("")).
fixed(settings, [], assumed("defaults of the payloads")).
fixed(limit, 6000, assumed("host seconds")).

claim("all agents that share reach the goal", [ours],
      at([population=islands], reached =:= 100)).
claim("sharing saves pages", [ours],
      at([population=islands], pages < at([population=apart], pages))).
claim("an agent of six that share needs fewer executions than one population \c
alone", [ours],
      at([population=islands], mean < at([population=one], mean))).

plot(islands, "Six agents that share, six that do not, one agent",
     lines([x(population), y([pages, mean])])).
