%   Figures 4.9, 4.10 and 4.12: effects of the density of agents.

:- include(ground).
:- include(sets).

study('4.9', "Executions and sharing against the density of agents").
text("Each set of points is a network, with one to five agents per ten hosts. \c
A single agent has no other agent to share with.").

vary(network, [10, 20, 30, 40, 50, obstacle]).
vary(density, [0.1, 0.2, 0.3, 0.4, 0.5]).

printed(executions, [network=50, density=0.1], 92).

%   For networks whose maze has no obstacle.

measure(no_obstacle, View, Mean) :-
    integer(View.case.network),
    measure(executions, View, Mean).
measure(times, View, Times) :-
    View.case.network == 50,
    View.case.density =:= 0.5,
    shared_times(View.learners, Times).

claim(Text, [line(2476)], at([network=N], falls(executions, along(density)))) :-
    each_network("executions fall with the density", N, Text).
claim(Text, [line(2490)], at([network=N], Test)) :-
    each_network("the largest drop is from D 0.1 to 0.2", N, Text),
    first_drop(executions, Test).
claim("no significant difference (0.15) between networks at D 0.5",
      [line(2479), ours, why("on 10 hosts these are five agents")],
      at([density=0.5],
         most(no_obstacle) - least(no_obstacle) =< 0.15*mean(no_obstacle))).
claim("more executions with an obstacle, at every density", [line(2486)],
      at([network=obstacle], executions > at([network=50], executions))).
claim("195 executions with 1 agent on 10 hosts, within a tenth",
      [line(2483)],
      at([network=10, density=0.1], near(executions, 195, 19.5))).
claim("110 with 2 agents on 10 hosts, within a tenth", [line(2484)],
      at([network=10, density=0.2], near(executions, 110, 11))).
claim("runs take 300 to 3000 s", [line(2373)], between(duration, 300, 3000)).
claim(Text, [line(2508)], at([network=N], rises(sharing, along(density)))) :-
    each_network("sharing grows with the density", N, Text).
claim("no sharing with 1 agent on 10 hosts", [line(2519)],
      at([network=10, density=0.1], sharing =:= 0)).
claim(Text, [line(2528)],
      at([network=N, density=0.4],
         abs(sharing - at([density=0.5], sharing)) < 0.05)) :-
    each_network("sharing changes less than 0.05 from D 0.4 to 0.5", N, Text).
claim("more sharing with an obstacle, at every density", [line(2526)],
      at([network=obstacle], sharing > at([network=50], sharing))).
claim("sharing decreases over time: 25 agents, 50 hosts", [line(2591)],
      at([network=50, density=0.5], trend < 0)).
claim("sharing decreases over time in all cases", [line(2597)], trend < 0).
claim("sharing decreases also before the first agent has converged",
      [line(2594), why("it hardly changes while all agents are active")],
      at([network=50, density=0.5], early_trend < 0)).

plot('4.9', "Executions that an agent needs until all have converged",
     Sets) :-
    sets('4.9', executions, Sets).
plot('4.10', "Sharing events per execution", Sets) :-
    sets('4.10', sharing, Sets).
plot('4.12', "Sharing events over time: 25 agents, 50 hosts",
     script('sharing.gp', [times-times_rows, trend-trend_rows],
            [seed(first), size(1000, 520), variables(times_drawn)])).
