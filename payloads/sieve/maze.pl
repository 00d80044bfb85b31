:- payload(maze, [provides([antigen/1, affinity/3, affinity_threshold/1,
                            feedback/3, random_antibody/3])]).

/*  Programs that steer a robot round an obstacle, as antibodies of the sieve:
    the code itself is what an agent carries.

    The robot moves on a board of squares.  It senses whether the squares
    ahead, left and right of it are free, has a compass that points to the
    goal, and knows its last action.  It can move one square forward, or
    turn left or right on the spot.

    An antigen is an obstacle, Kind(Way): see obstacle/3.  Way, `left` or
    `right`, is the side of the shorter way round; for `right` the board is the
    mirror image of the one in obstacle/3.

    An antibody is a program, a list of ground clauses (Action :- Reading).
    Action is `forward`, `left` or `right`, Reading one or more of

        free(Side), wall(Side)  of ahead, left, right
        goal(Side)              the goal lies (also) to that side: ahead,
                                behind, left, right
        after(Action)           the last action of the robot

    joined by commas.  The first clause whose readings all hold determines the
    action; without one the robot moves forward. At a wall it does not
    move, and loses a step. Programs are interpreted: they have no other
    effects.
*/

%   obstacle(?Kind, ?Steps, ?Rows): the robot stands at ^, heading up, and
%   needs Steps steps to g by the shortest way, on the left.

obstacle(block, 9,
         [ '........',
           '...g....',
           '..####..',
           '...^....',
           '........' ]).
obstacle(wall, 9,
         [ '.......',
           '...g...',
           '..#####',
           '...^...',
           '.......' ]).
obstacle(corner, 12,
         [ '........',
           '.....g..',
           '..######',
           '....^#..',
           '.....#..' ]).
obstacle(corridor, 12,
         [ '###g###',
           '#...###',
           '#.#####',
           '#...###',
           '###^###' ]).
obstacle(box, 17,
         [ '........',
           '....g...',
           '..######',
           '..#.^.#.',
           '..#...#.',
           '........',
           '........' ]).

antigen(Antigen) :-
    obstacle(Kind, _, _),
    member(Way, [left,right]),
    Antigen =.. [Kind,Way].

affinity_threshold(4).

%   affinity(+Antigen, +Program, -Psi): Psi is the number of the five sights of
%   an obstacle for which Program has a right action.  Program does not run.

affinity(Antigen, Program0, Psi) :-
    as_drawn(Antigen, Program0, Kind, Program),
    known_by(Kind, Sights),
    aggregate_all(count,
                  ( member(Sight-Answers, Sights),
                    sight(Sight, Reading),
                    program_answer(Program, Reading, Answer),
                    memberchk(Answer, Answers) ),
                  Psi).

%   known_by(?Kind, ?Sights): Sight-Answers, on the way from start to goal.

known_by(block, [ facing-[left,right], along-[forward],
                  along_right-[forward], end-[right], right_end-[left] ]).
known_by(wall, [ facing-[left], along-[forward], end-[right],
                 round-[forward], abreast-[right] ]).
known_by(corner, [ cornered-[left], away-[forward], end-[right],
                   round-[forward], abreast-[right] ]).
known_by(corridor, [ first_bend-[left], second_bend-[right],
                     narrow-[forward], third_bend-[right],
                     fourth_bend-[left] ]).
known_by(box, [ facing-[left,right], trapped-[left], right_end-[right],
                end-[right], abreast-[right] ]).

%   sight(?Sight, ?Squares, ?Goal, ?Last): the squares ahead, left and right,
%   the directions of the goal, and the last action of the robot.

sight(facing,      [wall,free,free], [ahead],        nothing).
sight(cornered,    [wall,free,wall], [ahead,right],  nothing).
sight(along,       [free,free,wall], [right],        left).
sight(along_right, [free,wall,free], [left],         right).
sight(away,        [free,free,wall], [behind,right], forward).
sight(trapped,     [wall,free,wall], [behind,right], forward).
sight(end,         [free,free,free], [behind,right], forward).
sight(right_end,   [free,free,free], [behind,left],  forward).
sight(round,       [free,free,free], [ahead,right],  right).
sight(abreast,     [free,free,free], [right],        forward).
sight(first_bend,  [wall,free,wall], [ahead],        forward).
sight(second_bend, [wall,wall,free], [behind,right], forward).
sight(narrow,      [free,wall,wall], [ahead,right],  right).
sight(third_bend,  [wall,wall,free], [ahead,right],  forward).
sight(fourth_bend, [wall,free,wall], [left],         forward).

sight(Sight, [after(Last),A,L,R|Compass]) :-
    sight(Sight, [Ahead,Left,Right], Goal, Last),
    A =.. [Ahead,ahead],
    L =.. [Left,left],
    R =.. [Right,right],
    findall(goal(Side), member(Side, Goal), Compass).

%   feedback(+Antigen, +Program, -Xi): 31 for the shortest way, one less
%   for each further step, and 0 if the goal is not reached 30 steps later.

feedback(Antigen, Program0, Xi) :-
    as_drawn(Antigen, Program0, Kind, Program),
    obstacle(Kind, Shortest, Rows),
    Limit is Shortest + 30,
    findall(Left, program_solves(Program, Rows, Limit, Left), Lefts),
    (   Lefts = [Left]
    ->  Xi is Left + 1
    ;   Xi = 0
    ).

%   A program on the mirror image of a board is the mirror image of the
%   program on the board.

as_drawn(Antigen, Program0, Kind, Program) :-
    Antigen =.. [Kind,Way],
    obstacle(Kind, _, _),
    (   Way == left
    ->  Program = Program0
    ;   Way == right,
        mirrored(Program0, Program)
    ).

mirrored(left, right) :-
    !.
mirrored(right, left) :-
    !.
mirrored(Term, Mirrored) :-
    Term =.. [Name|Arguments],
    maplist(mirrored, Arguments, Images),
    Mirrored =.. [Name|Images].

%   A robot is robot(X, Y, Heading, Last), Heading being DX/DY.

program_solves(Program, Rows, Limit, Left) :-
    board_square(Rows, X, Y, ^),
    board_square(Rows, GX, GY, g),
    !,
    Robot = robot(X, Y, 0/(-1), nothing),
    robot_drives(Limit, Robot, board(Rows, GX, GY), Program, Left).

robot_drives(Left, robot(X, Y, _, _), board(_, X, Y), _, Left) :-
    !.
robot_drives(Left0, Robot0, Board, Program, Left) :-
    Left0 > 0,
    robot_sees(Robot0, Board, Reading),
    program_answer(Program, Reading, Action),
    robot_does(Action, Robot0, Reading, Robot),
    Left1 is Left0 - 1,
    robot_drives(Left1, Robot, Board, Program, Left).

robot_does(forward, robot(X0, Y0, DX/DY, _), Reading,
           robot(X, Y, DX/DY, forward)) :-
    (   memberchk(free(ahead), Reading)
    ->  X is X0 + DX,
        Y is Y0 + DY
    ;   X/Y = X0/Y0
    ).
robot_does(Turn, robot(X, Y, Heading0, _), _, robot(X, Y, Heading, Turn)) :-
    memberchk(Turn, [left,right]),
    robot_turned(Turn, Heading0, Heading).

robot_turned(ahead, Heading, Heading).
robot_turned(left, DX/DY, DY/LY) :-
    LY is -DX.
robot_turned(right, DX/DY, RX/DX) :-
    RX is -DY.

%   robot_sees(+Robot, +Board, -Reading): Reading has all readings that hold.

robot_sees(robot(X, Y, Heading, Last), board(Rows, GX, GY),
           [Ahead,Left,Right,after(Last)|Compass]) :-
    robot_senses(ahead, Heading, X, Y, Rows, Ahead),
    robot_senses(left, Heading, X, Y, Rows, Left),
    robot_senses(right, Heading, X, Y, Rows, Right),
    Heading = DX/DY,
    EX is GX - X,
    EY is GY - Y,
    robot_compass(DX * EX + DY * EY, ahead, behind, Compass, Compass1),
    robot_compass(DY * EX - DX * EY, left, right, Compass1, []).

robot_compass(Distance, Side, _, [goal(Side)|Rest], Rest) :-
    Distance > 0,
    !.
robot_compass(Distance, _, Side, [goal(Side)|Rest], Rest) :-
    Distance < 0,
    !.
robot_compass(_, _, _, Rest, Rest).

robot_senses(Side, Heading, X, Y, Rows, What) :-
    robot_turned(Side, Heading, DX/DY),
    X1 is X + DX,
    Y1 is Y + DY,
    (   board_free(Rows, X1, Y1)
    ->  What = free(Side)
    ;   What = wall(Side)
    ).

%   Squares off the board are walls.

board_free(Rows, X, Y) :-
    X >= 0,
    board_square(Rows, X, Y, Square),
    Square \== # .

board_square(Rows, X, Y, Square) :-
    nth0(Y, Rows, Row),
    sub_atom(Row, X, 1, _, Square).

%   program_answer(+Program, +Reading, -Action)

program_answer([(Action0 :- Body)|_], Reading, Action) :-
    program_asks(Body, Reading),
    !,
    Action = Action0.
program_answer([_|Program], Reading, Action) :-
    program_answer(Program, Reading, Action).
program_answer([], _, forward).

program_asks((A,B), Reading) :-
    !,
    program_asks(A, Reading),
    program_asks(B, Reading).
program_asks(A, Reading) :-
    memberchk(A, Reading).

%   random_antibody(+Chance0, -Program, -Chance): three to five clauses.
%   Chance is a state of library(typhon/kernel/base/prng).

random_antibody(Chance0, Program, Chance) :-
    typhon_prng:chance_below(3, More, Chance0, Chance1),
    Clauses is 3 + More,
    length(Program, Clauses),
    foldl(random_clause, Program, Chance1, Chance).

%   Every clause has one of the sensible readings for its action, and half of
%   them have another reading, too.

random_clause((Action :- Body), Chance0, Chance) :-
    findall(A-R, clause_reason(A, R), Reasons),
    typhon_prng:chance_member(Action-Reading, Reasons, Chance0, Chance1),
    findall(R, other_reading(Action, Reading, R), Others),
    typhon_prng:chance_member(Other, Others, Chance1, Chance2),
    typhon_prng:chance_member(Body, [Reading,(Reading,Other)],
                                Chance2, Chance).

clause_reason(forward, after(left)).
clause_reason(forward, after(right)).
clause_reason(Turn, Reading) :-
    member(Turn, [left,right]),
    member(Reading, [wall(ahead),free(Turn),goal(Turn)]).

other_reading(Action, Reading, Other) :-
    member(Sense-Sides, [ free-[ahead,left,right], wall-[ahead,left,right],
                          goal-[ahead,behind,left,right],
                          after-[forward,left,right] ]),
    member(Side, Sides),
    Other =.. [Sense,Side],
    \+ senseless(Action, Other),
    \+ excludes(Reading, Other).

%   Senseless clauses drive or turn against a wall, or turn back.

senseless(forward, wall(ahead)).
senseless(left, wall(left)).
senseless(right, wall(right)).
senseless(left, after(right)).
senseless(right, after(left)).

excludes(Reading, Reading).
excludes(free(Side), wall(Side)).
excludes(wall(Side), free(Side)).
excludes(after(_), after(_)).
