%   Figures 5.9 and 5.10: dynamic networks.

:- include(ground).
:- include(links).

study('5.9', "Dynamic networks: idle time, overlaps, time for all tasks").

vary(links, [dynamic_1, dynamic_2]).
vary(agents, [5, 10, 15, 20]).
label(agents, "agents").
label(missing, "Executions missing").

printed(overlaps, [], 0).

claim(Text, [line(Line)], at([links=Model], Test)) :-
    said(Said, Line, Test),
    member(Model, [dynamic_1, dynamic_2]),
    label(Model, Title),
    format(string(Text), "~w: ~w", [Title, Said]).
claim("Dynamic II takes longer than Dynamic I", [line(3607)],
      least(total, links=dynamic_1)).
claim("Dynamic II takes nearly twice as long (1.5 to 2.5 times)",
      [ line(3607),
        why("nearly all of the time agents are penalised, as often in both") ],
      between(at([links=dynamic_2], total)/at([links=dynamic_1], total),
              1.5, 2.5)).

said("no overlapped executions", 3591, overlaps =:= 0).
said("two distinct tasks at most (τ)", 3591, tau =< 2).
said("every host executes every task", 3601, missing =:= 0).
said("idle time grows with the number of agents", 3593,
     rises(idle, along(agents), ends)).
said("idle time grows with each larger number of agents", 3593,
     rises(idle, along(agents))).

plot('5.9', "Idle time and overlaps in dynamic networks",
     lines([x(agents), y([idle, overlaps]), line(links),
            subtitle("60 hosts, δ = 0.2")])).
plot('5.10', "Time for all tasks in dynamic networks",
     lines([x(agents), y([total]), line(links),
            subtitle("60 hosts, δ = 0.2")])).
