:- module(learning_mazes,
          [ paths_panel/3,              % +Title, +Result, -Panel
            moves_panel/4               % +Title, +Result, +Tried, -Panel
          ]).
:- use_module('../lib/plot', [colour/2]).
:- use_module(maze,
              [goal_cell/2, maze_path/3, maze_size/2, maze_walls/2,
               start_cell/2]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2,
                               nth0/3]).

/** <module> Mazes with what robots did there: thesis Figures 4.7, 4.11

Lines of different agents are drawn a little beside each other, so that
those can be seen that go the same way.

*Threading*: any thread; no state.
*/

%!  paths_panel(+Title, +Result, -Panel) is det.
%
%   Panel, for draw_sheet/4, is the maze with the final path of each agent.

paths_panel(Title, Result, panel(Title, Settings, Layers)) :-
    memberchk(settings(Pairs), Result),
    maze_settings(Pairs, Settings),
    walls(Pairs, Walls),
    findall(Layer, path_layer(Pairs, Result, 3, Layer), Paths),
    ends(Pairs, Ends),
    append([[Walls], Paths, Ends], Layers).

%!  moves_panel(+Title, +Result, +Tried, -Panel) is det.
%
%   Beside the final paths, all moves; Tried are pairs Index-Actions, the
%   agents being numbered from 0.

moves_panel(Title, Result, Tried, panel(Title, Settings, Layers)) :-
    memberchk(settings(Pairs), Result),
    paths_panel(Title, Result, panel(Title, Settings, [Walls|Paths])),
    memberchk(agents(Count), Result),
    findall(Layer,
            ( agent_index(Count, Index),
              moves_layer(Pairs, Count, Index, Tried, Layer) ),
            Moves),
    append([Walls|Moves], Paths, Layers).

agent_index(Count, Index) :-
    Last is Count - 1,
    between(0, Last, Index).

maze_settings(Pairs,
              [ 'unset key; unset xlabel; unset ylabel', Range, Tics ]) :-
    maze_size(Pairs, Size),
    Step is max(1, Size // 5),
    Most is Size + 1,
    format(atom(Range), 'set xrange [-1:~d]; set yrange [-1:~d]',
           [Most, Most]),
    format(atom(Tics),
           'set xtics ~d; set ytics ~d; set border 15; \c
set grid xtics ytics lc rgb "#eeeeee" lt 1 lw 0.6', [Step, Step]).

walls(Pairs, layer(Rows, Style)) :-
    maze_walls(Pairs, Cells),
    findall([X, Y, L, R, B, T],
            ( member(X-Y, Cells),
              L is X - 0.55, R is X + 0.55, B is Y - 0.55, T is Y + 0.55 ),
            Rows),
    Style = 'using 1:2:3:4:5:6 with boxxyerror fill solid noborder \c
lc rgb "#777777"'.

path_layer(Pairs, Result, Width, layer(Rows, Style)) :-
    memberchk(agents(Count), Result),
    memberchk(learners(Learners), Result),
    nth0(Index, Learners, learner(_, _, converged(_, _, Actions))),
    maze_path(Pairs, Actions, Cells),
    shift(Count, Index, Shift),
    findall([X, Y],
            ( member(X0-Y0, Cells), X is X0 + Shift, Y is Y0 + Shift ),
            Rows),
    agent_colour(Index, Colour),
    format(atom(Style), 'using 1:2 with lines lw ~w \c
lc rgb "#~|~`0t~16r~6+"', [Width, Colour]).

%   Each way between two cells is drawn once.

moves_layer(Pairs, Count, Index, Tried, layer(Rows, Style)) :-
    findall(Move,
            ( member(Index-Actions, Tried),
              maze_path(Pairs, Actions, Cells),
              append(_, [Cell1,Cell2|_], Cells),
              msort([Cell1, Cell2], Move) ),
            Moves0),
    sort(Moves0, Moves),
    shift(Count, Index, Shift),
    findall([X, Y, DX, DY],
            ( member([X1-Y1,X2-Y2], Moves),
              X is X1 + Shift, Y is Y1 + Shift,
              DX is X2 - X1, DY is Y2 - Y1 ),
            Rows),
    agent_colour(Index, Colour),
    format(atom(Style), 'using 1:2:3:4 with vectors nohead lw 1 \c
lc rgb "#~|~`0t~16r~6+"', [Colour]).

shift(Count, Index, Shift) :-
    Shift is (Index - (Count - 1)/2) * 0.7/Count.

agent_colour(Index, Colour) :-
    I is Index mod 6,
    colour(I, Colour).

ends(Pairs, [ layer([[X1, Y1]], 'using 1:2 with points pt 7 ps 1.6 \c
lc rgb "#222222"'),
              layer([[X2, Y2]], 'using 1:2 with points pt 3 ps 2.2 lw 2.5 \c
lc rgb "#222222"') ]) :-
    start_cell(Pairs, X1-Y1),
    goal_cell(Pairs, X2-Y2).
