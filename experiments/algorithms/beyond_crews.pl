%   Crews of two algorithms, in mazes that suit one or the other.

:- include(ground).

study(crews, "Crews of two algorithms, each with a strength of its own").
text("Greedy agents are quick where light leads to the goal, and go into a \c
corner for good.  Scouts come round corners, and are slow where the maze is \c
large, the slower the more ways they know: so there are also scouts that do not \c
share.  With a corner near the start scouts are needed first, and greedy agents \c
for the long way after it; with one near the light it is the other way round.").

vary(maze, [open, near_start, near_light]).
vary(crew, [greedy, scout, scout_apart, both]).
fixed(problem, maze, assumed("with a corner, as in study mixed")).
derive(algorithms, Case, Names) :-
    crew(Case.crew, Names, _).
derive(sharing, Case, Sharing) :-
    crew(Case.crew, _, Sharing).
derive(settings, Case, [size-(Case.size), obstacles-Obstacles]) :-
    obstacles(Case.maze, Case.size, Case.arm, Obstacles).
fixed(size, 24, tuned("with 16 four scouts always reach the light")).
fixed(arm, 4, tuned("cells of each wall of the corner; with 6 crews gain less")).
fixed(agents, 4, assumed("half of them of each kind where there are both")).
fixed(limit, 2000, assumed("host seconds")).

label(greedy, "4 greedy").
label(scout, "4 scouts").
label(scout_apart, "4 scouts, no sharing").
label(both, "2 greedy, 2 scouts").

crew(greedy, [greedy], true).
crew(scout, [scout], true).
crew(scout_apart, [scout], false).
crew(both, [greedy, scout], true).

%   The open side of the corner faces the start; the corner is on the diagonal
%   from the start to the light.

obstacles(open, _, _, []).
obstacles(near_start, Size, Arm, Walls) :-
    X is Size - Arm - 2,
    Y is Arm + 2,
    corner(X, Y, Arm, Walls).
obstacles(near_light, Size, Arm, Walls) :-
    Y is Size - 2,
    corner(2, Y, Arm, Walls).

corner(X, Y, Arm, [(X,Y0)-(X,Y), (X,Y)-(X1,Y)]) :-
    Y0 is Y - Arm,
    X1 is X + Arm.

claim("near the start: all agents of a crew of both reach the light", [ours],
      at([maze=near_start, crew=both], reached =:= 100)).
claim("near the start: more agents of both reach it than of any one kind", [ours],
      at([maze=near_start], most(reached, crew=both))).
claim("near the start: after fewer executions than of any one kind", [ours],
      at([maze=near_start], least(executions, crew=both))).
claim("near the light: more agents of both reach it than of any one kind", [ours],
      at([maze=near_light], most(reached, crew=both))).
claim("near the light: after fewer executions than of any one kind", [ours],
      at([maze=near_light], least(executions, crew=both))).
claim("in the open greedy agents alone need fewer executions", [ours],
      at([maze=open],
         at([crew=greedy], executions) < at([crew=both], executions))).
claim("scouts that share need more than those that do not, in each maze", [ours],
      at([crew=scout], executions) > at([crew=scout_apart], executions)).

plot(crews, "Four agents in mazes without and with a corner",
     lines([x(maze), y([reached, executions]), line(crew)])).
