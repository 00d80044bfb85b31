%   Agents that clone themselves when they make progress.

:- include(ground).

study(cloning, "Agents that clone themselves when they make progress").

vary(group, [three, three_cloning, eight]).
derive(agents, Case, Count) :-
    ( Case.group == eight -> Count = 8 ; Count = 3 ).
derive(cloning, Case, Cloning) :-
    ( Case.group == three_cloning -> Cloning = true ; Cloning = false ).
fixed(problem, maze, assumed("25 x 25, without obstacles")).
fixed(algorithms, [greedy], assumed("")).
fixed(settings, [size-25, q_th-2, alpha_r-5, c_l-1, lifetime-5],
      tuned("with the defaults agents displace each other")).
fixed(limit, 4000, assumed("host seconds")).

claim("each agent that clones needs fewer executions than without cloning",
      [ours],
      at([group=three_cloning], mean < at([group=three], mean))).
claim("with cloning all agents together need more executions", [ours],
      at([group=three_cloning], executions > at([group=three], executions))).
claim("the cloning controller keeps the number of agents below 20", [ours],
      at([group=three_cloning], most < 20)).

plot(cloning, "Three agents, three agents that clone, eight agents",
     lines([x(group), y([mean, executions, most])])).
