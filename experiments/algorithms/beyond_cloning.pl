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
      tuned("by the defaults agents crowd each other out")).
fixed(limit, 4000, assumed("host seconds")).

claim("agents that clone need fewer executions each than as many that do not",
      [ours],
      at([group=three_cloning], mean < at([group=three], mean))).
claim("but more in all", [ours],
      at([group=three_cloning], executions > at([group=three], executions))).
claim("the controller keeps their number below 20", [ours],
      at([group=three_cloning], most < 20)).

plot(cloning, "Three agents, three that clone, eight",
     lines([x(group), y([mean, executions, most])])).
