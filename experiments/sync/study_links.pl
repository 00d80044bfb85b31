%   Search for dynamic networks that agree with the thesis: no overlaps, and no
%   host without a task.

:- include(ground).
:- include(links).

study(links, "Dynamic networks: frequency of changes, and number of links").
text("If a host can be isolated for a whole task, executions overlap, or are \c
missing: agents do not wait for a host that they cannot reach.").

vary(links, [dynamic_1, dynamic_2]).
vary(drop_1, [0.2, 0.5]).
vary(make_1, [0.9, 0.7]).
vary(interval, [2-4, 5-10, 10-20]).
skip(Case) :- Case.drop_1 =:= 0.2, Case.make_1 =:= 0.7.
skip(Case) :- Case.drop_1 =:= 0.5, Case.make_1 =:= 0.9.
skip(Case) :- Case.links == dynamic_2, Case.drop_1 =:= 0.5.

label(missing, "Executions missing").

claim("Dynamic I, few drops: no overlaps, every host executes every task",
      [ours],
      at([links=dynamic_1, drop_1=0.2], (overlaps =:= 0, missing =:= 0))).
claim("Dynamic I, drops as II: no overlaps, all tasks are executed", [ours],
      at([links=dynamic_1, drop_1=0.5], (overlaps =:= 0, missing =:= 0))).
claim("Dynamic II: no overlaps, every host executes every task", [ours],
      at([links=dynamic_2], (overlaps =:= 0, missing =:= 0))).
