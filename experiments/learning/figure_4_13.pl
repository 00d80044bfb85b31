%   Figure 4.13: a network whose links change.

:- include(ground).
:- include(sets).

:- use_module(degrees, [degrees/5]).

study('4.13', "Executions and sharing in a dynamic network").
text("Each host, every 10 to 20 s, drops each of its links with probability \c
0.3, and makes one with probability 0.5.").

vary(network, [50]).
vary(density, [0.1, 0.2, 0.3, 0.4, 0.5]).
fixed(dynamic, thesis_4_4_7, printed("section 4.4.7: from a mesh, each link \c
dropped by itself; where one at a time is, no host ever has few")).

printed(least_degree, [], 0).
printed(most_degree, [], 27).

label(least_degree, "Links of a host, at least").
label(most_degree, "Links of a host, at most").

measure(least_degree, View, Least) :-
    of_hosts(View, Least-_).
measure(most_degree, View, Most) :-
    of_hosts(View, _-Most).

of_hosts(View, Degrees) :-
    hosts(View.case, N),
    duration(View.learners, End),
    degrees(View.case.dynamic, N, View.case.seed, End, Degrees).

claim("executions fall with the density", [line(2631)],
      falls(executions, along(density))).
claim("sharing grows with the density", [line(2634)],
      rises(sharing, along(density))).
claim("sharing rises more from D 0.1 to 0.2 than from D 0.2 to 0.5",
      [line(2636)],
      at([density=0.2],
         sharing - at([density=0.1], sharing)
         > at([density=0.5], sharing) - sharing)).
claim("some hosts have no links at times", [line(2626)],
      some(least_degree =:= 0)).
claim("hosts have at most 27 links, within a tenth",
      [line(2627), why("the mesh loses links, and 27 remain at 30 s")],
      near(most(most_degree), 27, 2.7)).

plot('4.13', "A dynamic network of 50 hosts",
     lines([x(density), y([executions, sharing])])).
