:- module(learning_ways,
          [ random_ways/3,              % +Settings, +Count, -Ways
            distance/3,                 % +Line, +Way, -Mean
            nearer/4                    % +Line, +Ways, +Mean, -Share
          ]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_seed/2, chance_true/4]).
:- use_module(maze,
              [goal_cell/2, maze_size/2, maze_walls/2, start_cell/2]).
:- use_module(metrics, [mean/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc), [empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> Shortest paths through a maze, and their distance to lines

Most shortest paths are near the diagonal, so a path is compared with random
shortest paths.

*Threading*: any thread; no state.
*/

%!  random_ways(+Settings, +Count:integer, -Ways:list(list)) is det.
%
%   Ways are Count paths, the same ones in each call: lists of cells X-Y from
%   the start to the goal, left or up in each move.  All shortest paths are
%   equally likely.

random_ways(Settings, Count, Ways) :-
    start_cell(Settings, Start),
    goal_cell(Settings, Goal),
    onward(Settings, Goal, Onward),
    chance_seed(1, Chance),
    draw(Count, Start, Goal, Onward, Ways, Chance).

draw(0, _, _, _, [], _) :-
    !.
draw(Count, Start, Goal, Onward, [Way|Ways], Chance0) :-
    way(Start, Goal, Onward, Way, Chance0, Chance),
    Left is Count - 1,
    draw(Left, Start, Goal, Onward, Ways, Chance).

way(Goal, Goal, _, [Goal], Chance, Chance) :-
    !.
way(Cell, Goal, Onward, [Cell|Way], Chance0, Chance) :-
    next(Cell, Left, Up),
    ways_from(Left, Onward, ByLeft),
    ways_from(Up, Onward, ByUp),
    Share is float(ByLeft rdiv (ByLeft + ByUp)),
    chance_true(Share, GoesLeft, Chance0, Chance1),
    (   GoesLeft == true
    ->  way(Left, Goal, Onward, Way, Chance1, Chance)
    ;   way(Up, Goal, Onward, Way, Chance1, Chance)
    ).

next(X-Y, Left-Y, X-Up) :-
    Left is X - 1,
    Up is Y + 1.

%   onward(+Settings, +Goal, -Onward): the number of shortest paths from each
%   cell to Goal.

onward(Settings, Goal, Onward) :-
    maze_size(Settings, Size),
    maze_walls(Settings, Walls),
    findall(X-Y, ( between(0, Size, Down), Y is Size - Down,
                   between(0, Size, X) ), Cells),
    empty_assoc(Empty),
    foldl(counted(Walls, Goal), Cells, Empty, Onward).

counted(Walls, Goal, Cell, Onward0, Onward) :-
    (   memberchk(Cell, Walls)
    ->  Count = 0
    ;   Cell == Goal
    ->  Count = 1
    ;   next(Cell, Left, Up),
        ways_from(Left, Onward0, ByLeft),
        ways_from(Up, Onward0, ByUp),
        Count is ByLeft + ByUp
    ),
    put_assoc(Cell, Onward0, Count, Onward).

ways_from(Cell, Onward, Count) :-
    (   get_assoc(Cell, Onward, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

%!  distance(+Line, +Way, -Mean) is semidet.
%
%   Mean distance of the cells of Way from Line.  Line is diagonal(Size); or
%   wall(X, Top), for cells on the side of the start and below the end of the
%   wall.  Fails if there are no such cells.

distance(diagonal(Size), Way, Mean) :-
    findall(D, ( member(X-Y, Way), D is abs(X + Y - Size)/sqrt(2) ), Ds),
    mean(Ds, Mean).
distance(wall(Wall, Top), Way, Mean) :-
    findall(D, ( member(X-Y, Way), X > Wall, Y =< Top, D is X - Wall - 1 ),
            Ds),
    mean(Ds, Mean).

%!  nearer(+Line, +Ways, +Mean, -Share) is det.
%
%   Share of Ways whose mean distance from Line is less than Mean.

nearer(Line, Ways, Mean, Share) :-
    aggregate_all(count,
                  ( member(Way, Ways), distance(Line, Way, D), D < Mean ),
                  Nearer),
    aggregate_all(count, member(_, Ways), Count),
    Share is Nearer/Count.
