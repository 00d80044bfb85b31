%   Figures 4.7, 4.8 and 4.11: the paths of five agents, their executions, and
%   all actions tried.

:- include(ground).
:- include(single).

study('4.7', "Final paths of five agents, and their executions").
text("The same networks without sharing, with sharing, and with an obstacle \c
in the maze. The overlap of two paths is the number of common cells divided \c
by the number of cells in at least one. A path is compared with 200 random \c
shortest paths through the same maze: most of them are near the diagonal, \c
too.").

vary(network, [50, obstacle]).
vary(sharing, [false, true]).
skip(Case) :- Case.network == obstacle, Case.sharing == false.
fixed(density, 0.1, printed("section 4.4.1")).
fixed(trace, true, assumed("trainers log the actions tried")).
real([network=50, sharing=true], [clock=40, processes=2]).

printed(executions, [network=50, sharing=false], 195).
printed(executions, [network=50, sharing=true], 92).
printed(total, [network=50, sharing=false], 900).
printed(total, [network=50, sharing=true], 350).

five(Sharing, Test, at([network=50, sharing=Sharing], Test)).

claim("without sharing all paths are distinct", [line(2416)], Test) :-
    five(false, distinct =:= agents, Test).
claim("with sharing all agents take the same path", [line(2418)], Test) :-
    five(true, distinct =:= 1, Test).
claim("with sharing paths are highly overlapped: at least 0.8 of cells",
      [line(2405), ours], Test) :-
    five(true, overlap >= 0.8, Test).
claim("paths overlap more with sharing than without", [line(2405)], Test) :-
    five(true, overlap > at([sharing=false], overlap), Test).
claim("195 executions per agent without sharing, within a tenth",
      [line(2424)], Test) :-
    five(false, near(executions, 195, 19.5), Test).
claim("92 executions per agent with sharing, within a tenth",
      [line(2425)], Test) :-
    five(true, near(executions, 92, 9.2), Test).
claim("robots achieve their goals in lesser time by sharing", [line(2423)],
      Test) :-
    five(true, duration < at([sharing=false], duration), Test).
claim("around 900 executions of all without sharing, within a tenth",
      [line(2462)], Test) :-
    five(false, near(total, 900, 90), Test).
claim("around 350 executions of all with sharing, within a tenth",
      [line(2461), why("5 times 92 are 460: the figure is one run")], Test) :-
    five(true, near(total, 350, 35), Test).
claim("with sharing less than half of the executions", [line(2461)], Test) :-
    five(true, total < 0.5*at([sharing=false], total), Test).
claim("with sharing lengths of plans differ less, relative to their mean",
      [line(2454)], Test) :-
    five(true, spread < at([sharing=false], spread), Test).
claim("final paths are nearer to the diagonal with sharing than without",
      [line(2567)], Test) :-
    five(true, aside < at([sharing=false], aside), Test).
claim("final paths are nearer to it than 95 % of shortest paths",
      [line(2556), ours], Test) :-
    five(true, nearer < 5, Test).
claim("final paths are nearer to an obstacle than 95 % of shortest paths",
      [line(2557), ours], at([network=obstacle], nearer < 5)).
claim("final paths are shortest paths",
      [line(2562), why("random steps right before the goal are part of it")],
      at([sharing=true], detour =:= 0)).
claim("more executions with an obstacle", [line(2557)],
      at([network=obstacle], executions > at([network=50], executions))).

pair(Cases) :-
    Cases = [ 'without sharing'-[sharing=false, network=50],
              'with sharing'-[sharing=true, network=50] ].

plot('4.7', "Final paths of all agents", Mazes) :-
    pair(Cases),
    mazes('4.7', Cases, none, Mazes).
plot('4.8', "Length of the plan that is executed", Lengths) :-
    pair(Cases),
    lengths('4.8', Cases, Lengths).
plot('4.11', "All moves of robots until all have converged, and final paths",
     Mazes) :-
    mazes('4.11', [ 'no obstacle'-[sharing=true, network=50],
                    'with an obstacle'-[network=obstacle] ], moves, Mazes).
