%   Figures 5.9 and 5.10: links that come and go.

:- include(ground).

study('5.9', "Dynamic networks: idle time, overlaps, time for all tasks").

vary(links, [dynamic_1, dynamic_2]).
vary(agents, [5, 10, 15, 20]).
fixed(topology, grid, printed("section 5.5")).
fixed(delta, 0.2, printed("section 5.6.5")).
fixed(interval, 10-20, assumed("as in section 4.4.7: each host, every 10 to \c
20 s")).
fixed(drop_1, 0.2, chosen("Dynamic I: a link that stands is dropped; no \c
probability is printed. With 0.5 some hosts are cut off for long")).
fixed(make_1, 0.9, chosen("Dynamic I: a link of the grid is made again")).
fixed(drop_2, 0.5, printed("section 5.5")).
fixed(make_2, 0.7, printed("section 5.5")).

model(Case, toggle(uniform(Min, Max), Case.drop_1, Case.make_1)) :-
    Case.links == dynamic_1,
    Min-Max = Case.interval.
model(Case, links(uniform(Min, Max), Case.drop_2, Case.make_2)) :-
    Case.links == dynamic_2,
    Min-Max = Case.interval.

label(dynamic_1, "Dynamic I").
label(dynamic_2, "Dynamic II").
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
said("and with each step of it", 3593, rises(idle, along(agents))).

plot('5.9', "Idle time and overlaps in dynamic networks",
     lines([x(agents), y([idle, overlaps]), line(links),
            subtitle("60 hosts, δ = 0.2")])).
plot('5.10', "Time for all tasks in dynamic networks",
     lines([x(agents), y([total]), line(links),
            subtitle("60 hosts, δ = 0.2")])).
