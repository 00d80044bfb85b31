%   Figures 4.7, 4.8 and 4.11: the paths of five agents, their executions, and
%   all actions tried.

:- include(ground).
:- include(single).

study('4.7', "Final ways of five agents, and how they came to them").
text("The same networks without sharing, with sharing, and with an obstacle \c
in the maze. Overlap is the share of cells that two ways have in common, of \c
those in one of them. A way is compared with 200 shortest ways through the \c
same maze, drawn at random: most of them are near the diagonal, too.").

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
claim("or highly overlapped ones: 0.8 or more of their cells",
      [line(2405), ours], Test) :-
    five(true, overlap >= 0.8, Test).
claim("paths overlap more with sharing than without", [line(2405)], Test) :-
    five(true, overlap > at([sharing=false], overlap), Test).
claim("195 executions per agent without sharing, within a tenth",
      [line(2424)], Test) :-
    five(false, near(executions, 195, 19.5), Test).
claim("92 with sharing, within a tenth", [line(2425)], Test) :-
    five(true, near(executions, 92, 9.2), Test).
claim("robots achieve their goals in lesser time by sharing", [line(2423)],
      Test) :-
    five(true, duration < at([sharing=false], duration), Test).
claim("around 900 executions of all without sharing, within a tenth",
      [line(2462)], Test) :-
    five(false, near(total, 900, 90), Test).
claim("around 350 with sharing, within a tenth",
      [line(2461), why("5 times 92 are 460: the figure is one run")], Test) :-
    five(true, near(total, 350, 35), Test).
claim("less than half of those without sharing", [line(2461)], Test) :-
    five(true, total < 0.5*at([sharing=false], total), Test).
claim("with sharing lengths of plans differ less, by their mean",
      [line(2454)], Test) :-
    five(true, spread < at([sharing=false], spread), Test).
claim("final paths are nearer to the diagonal with sharing than without",
      [line(2567)], Test) :-
    five(true, aside < at([sharing=false], aside), Test).
claim("and than 19 in 20 of all shortest ways", [line(2556), ours], Test) :-
    five(true, nearer < 5, Test).
claim("with an obstacle, nearer to it than 19 in 20 of all shortest ways",
      [line(2557), ours], at([network=obstacle], nearer < 5)).
claim("final paths are as short as any",
      [line(2562), why("random steps right before the goal are part of it")],
      at([sharing=true], detour =:= 0)).
claim("more executions with an obstacle", [line(2557)],
      at([network=obstacle], executions > at([network=50], executions))).

pair(Cases) :-
    Cases = [ 'without sharing'-[sharing=false, network=50],
              'with sharing'-[sharing=true, network=50] ].

plot('4.7', "Final ways of all agents", Mazes) :-
    pair(Cases),
    mazes('4.7', Cases, none, Mazes).
plot('4.8', "Length of the plan that is executed", Lengths) :-
    pair(Cases),
    lengths('4.8', Cases, Lengths).
plot('4.11', "All moves of robots until all have converged, and final ways",
     Mazes) :-
    mazes('4.11', [ 'no obstacle'-[sharing=true, network=50],
                    'with an obstacle'-[network=obstacle] ], moves, Mazes).
