:- module(learning_maze,
          [ maze_path/3,                % +Settings, +Actions, -Cells
            maze_walls/2,               % +Settings, -Cells
            maze_size/2,                % +Settings, -Size
            start_cell/2,               % +Settings, -Cell
            goal_cell/2                 % +Settings, -Cell
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> The maze world of the agents, for evaluation

The payload of agents and trainers defines the effects of actions.  Cells are
terms X-Y, Settings pairs Name-Value as agents get them.

*Threading*: any thread; settings are thread-local during a call.
*/

:- thread_local setting/2.      % Name, Value

%   The directive at the start of a payload file.

payload(maze, _).

:- include('../../payloads/learning/maze').

:- meta_predicate with_settings(+, 0).

with_settings(Settings, Goal) :-
    setup_call_cleanup(
        forall(member(Name-Value, Settings),
               assertz(setting(Name, Value))),
        once(Goal),
        retractall(setting(_, _))).

%!  maze_path(+Settings, +Actions, -Cells:list) is det.
%
%   Cells are the cells that a robot visits when it performs Actions from the
%   start: the start, and one cell for each move.

maze_path(Settings, Actions, Cells) :-
    with_settings(Settings,
                  ( start(none, State),
                    cell(State, Cell),
                    moves(Actions, State, Cell, Cells0) )),
    Cells = [Cell|Cells0].

moves([], _, _, []).
moves([Action|Actions], State0, Cell0, Cells) :-
    act(Action, State0, State),
    cell(State, Cell),
    (   Cell == Cell0
    ->  Cells = Cells1
    ;   Cells = [Cell|Cells1]
    ),
    moves(Actions, State, Cell, Cells1).

cell(at(X, Y, _), X-Y).

%!  maze_walls(+Settings, -Cells) is det.
%
%   Cells are the cells of obstacles.

maze_walls(Settings, Cells) :-
    (   memberchk(obstacles-Obstacles, Settings)
    ->  findall(X-Y,
                ( member((X1,Y1)-(X2,Y2), Obstacles),
                  between(X1, X2, X),
                  between(Y1, Y2, Y) ),
                Cells)
    ;   Cells = []
    ).

%!  maze_size(+Settings, -Size:integer) is det.
%!  start_cell(+Settings, -Cell) is det.
%!  goal_cell(+Settings, -Cell) is det.
%
%   Cells are from 0-0 to Size-Size.

maze_size(Settings, Size) :-
    with_settings(Settings, size(Size)).

start_cell(Settings, Cell) :-
    maze_path(Settings, [], [Cell]).

goal_cell(Settings, X-Y) :-
    with_settings(Settings, goal(X, Y)).
