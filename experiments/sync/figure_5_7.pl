%   Figure 5.7: effects of the numbers of agents (a) and hosts (b).

:- include(ground).

study('5.7', "Idle time and overlaps against the numbers of agents and hosts").

vary(topology, [star_bus, ring, tree, grid]).
vary(agents, [5, 10, 15, 20]).
vary(hosts, [60, 50, 40, 30]).
skip(Case) :- Case.agents =\= 10, Case.hosts =\= 60.
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).

label(agents, "agents").
label(hosts, "hosts").

printed(idle, [topology=tree, hosts=60, agents=5],   98).
printed(idle, [topology=tree, hosts=60, agents=10],  48).
printed(idle, [topology=tree, hosts=60, agents=20], 116).
printed(overlaps, [topology=grid, hosts=60, agents=5],  8).
printed(overlaps, [topology=ring, hosts=60, agents=20], 2).

claim(Text, [line(3490)],
      at([topology=Name, hosts=60], overlaps =< 8)) :-
    of(Name, "8 overlapped executions of 360 at most, with 5 to 20 agents",
       Text).
claim(Text, [line(3490)],
      at([topology=Name, hosts=60], overlaps =:= 0)) :-
    member(Name, [star_bus, tree]),
    of(Name, "no overlapped executions with 5 to 20 agents", Text).
claim(Text, [line(3490)], at([topology=Name, hosts=60], Test)) :-
    member(Name-Agents, [grid-5, ring-20]),
    Test = ( at([agents=Agents], overlaps > 0),
             holds(none_but(Agents)) ),
    format(string(Said), "overlapped executions only with ~d agents", [Agents]),
    of(Name, Said, Text).
claim(Text, [line(3495), why("idle time grows with the number of agents, as \c
hosts are visited more often, and so agents penalised")],
      at([topology=Name, hosts=60], least(idle, agents=Best))) :-
    member(Name-Best, [tree-10, star_bus-10, grid-10, ring-5]),
    format(string(Said), "shortest idle time with ~d agents", [Best]),
    of(Name, Said, Text).
claim(Text, [line(3487)],
      at([topology=tree, hosts=60, agents=Agents],
         near(idle, Printed, Fifth))) :-
    printed(idle, [topology=tree, hosts=60, agents=Agents], Printed),
    Fifth is Printed/5,
    format(string(Text), "Tree: idle time ~d s with ~d agents, within a fifth",
           [Printed, Agents]).
claim(Text, [line(3510)],
      at([topology=Name, agents=10], overlaps =:= 0)) :-
    of(Name, "no overlapped executions with 30 to 60 hosts", Text).

of(Name, Said, Text) :-
    best_delta(Name, _),
    label(Name, Title),
    format(string(Text), "~w: ~w", [Title, Said]).

none_but(Agents, Points) :-
    forall(( member(Case-Ms, Points), Case.agents =\= Agents ),
           Ms.overlaps =:= 0).

plot('5.7a', "Idle time and overlaps against the number of agents",
     lines([x(agents), y([idle, overlaps]), line(topology), where([hosts=60]),
            subtitle("60 hosts, best δ of the thesis for each topology")])).
plot('5.7b', "Idle time and overlaps against the number of hosts",
     lines([x(hosts), y([idle, overlaps]), line(topology), where([agents=10]),
            subtitle("10 agents, best δ of the thesis for each topology")])).
