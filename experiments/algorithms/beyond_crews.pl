%   Crews of two algorithms, in mazes that suit one or the other.

:- include(ground).

study(crews, "Crews of two algorithms, each suited to another maze").
text("Greedy agents are fast where light leads to the goal, but never leave a \c
corner.  Scouts leave corners, but are slow in a large maze, and slower the \c
more paths they know: so there are also scouts that do not share.  With a \c
corner near the start scouts are needed first, and greedy agents for the long \c
path after it; with a corner near the light the order is reversed.").

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
fixed(arm, 4,
      tuned("cells of each wall of the corner; with 6 the gain is smaller")).
fixed(agents, 4, assumed("half of each kind in mixed crews")).
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

claim("corner near the start: all agents of a mixed crew reach the light",
      [ours],
      at([maze=near_start, crew=both], reached =:= 100)).
claim("corner near the start: more agents of a mixed crew reach the light",
      [ours],
      at([maze=near_start], most(reached, crew=both))).
claim("corner near the start: a mixed crew needs fewer executions", [ours],
      at([maze=near_start], least(executions, crew=both))).
claim("corner near the light: more agents of a mixed crew reach the light",
      [ours],
      at([maze=near_light], most(reached, crew=both))).
claim("corner near the light: a mixed crew needs fewer executions", [ours],
      at([maze=near_light], least(executions, crew=both))).
claim("no corner: greedy agents alone need fewer executions", [ours],
      at([maze=open],
         at([crew=greedy], executions) < at([crew=both], executions))).
claim("scouts that share need more executions than scouts that do not", [ours],
      at([crew=scout], executions) > at([crew=scout_apart], executions)).

plot(crews, "Four agents in mazes without and with a corner",
     lines([x(maze), y([reached, executions]), line(crew)])).
