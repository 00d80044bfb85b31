%   Ten different printers, and five agents that search for good settings.

:- include(ground).

study(settings, "Ten different printers, five agents").

vary(algorithm, [climb, lottery]).
vary(sharing, [true, false]).
derive(algorithms, Case, [Case.algorithm]).
fixed(problem, settings, assumed("printers, doc/algorithms.md")).
fixed(agents, 5, assumed("")).
fixed(settings, [], assumed("defaults of the payloads")).
fixed(limit, 6000, assumed("host seconds")).

label(climb, "climb").
label(lottery, "random search").

claim("with climb all agents reach the goal", [ours],
      at([algorithm=climb, sharing=true], reached =:= 100)).
claim("climb takes less than half the pages of random search", [ours],
      at([algorithm=climb, sharing=true],
         pages < 0.5*at([algorithm=lottery], pages))).
claim("sharing saves climb a third of the pages", [ours],
      at([algorithm=climb, sharing=true],
         pages < 2/3*at([sharing=false], pages))).
claim("sharing saves pages of random search", [ours],
      at([algorithm=lottery, sharing=true],
         pages < at([sharing=false], pages))).
claim("without noise the settings found are at most 0.05 short of good, on \c
the printer they were found at", [ours],
      at([algorithm=climb, sharing=true], most_short =< 0.05)).

plot(settings, "Ten different printers, five agents",
     lines([ x(sharing), y([pages, mean]), line(algorithm) ])).
