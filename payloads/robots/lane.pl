:- payload(lane,
           [ provides([ lane_follow/2, lane_find/3, lane_between/4,
                        lane_face/2, lane_check/2, lane_driven/2 ]) ]).

/*  Driving along black lines (thesis section 7.7).  The robot follows a line by
    itself: the program only chooses the turn at junctions.

    The wheels, 56 mm wide and 112 mm apart, are motors b, left, and c; the
    compass is on port 2, colour sensors look at the floor ahead of them on
    ports 3 and 4.  All runs are limited: a robot whose program has ended stops
    by itself.  A robot that loses its way stops, and raises robot_lost(How).

    A way is a list of Metres-Turn: there is a junction after Metres, where the
    robot turns `left` or `right` or drives `straight`; the last element is
    Metres-stop.
*/

%!  lane_follow(+Brick, +Way) is det.

lane_follow(Brick, Way) :-
    nxt_tacho_reset(Brick, [b,c]),
    lane_legs(Way, 0, Legs),
    lane_drive(Legs, Brick).

%   lane_legs(+Way, +Start, -Legs): a leg passes junctions with the same turn,
%   and ends between two junctions, nearer to the first one, because the wheels
%   do not begin to turn at the same moment.

lane_legs([Metres-stop], Start, [leg(straight, End)]) :-
    !,
    End is Start + Metres.
lane_legs([Metres-Turn,Next-stop], Start, [leg(Turn, End)]) :-
    !,
    End is Start + Metres + Next.
lane_legs([Metres-Turn,Next-Turn|Way], Start, Legs) :-
    !,
    Junction is Start + Metres,
    lane_legs([Next-Turn|Way], Junction, Legs).
lane_legs([Metres-Turn,Next-Other|Way], Start, [leg(Turn, End)|Legs]) :-
    Junction is Start + Metres,
    End is Junction + 0.4*Next,
    lane_legs([Next-Other|Way], Junction, Legs).

lane_drive([], _).
lane_drive([leg(Turn, Metres)|Legs], Brick) :-
    lane_driven(Brick, Driven),
    lane_steering(Turn, Wheels, Ratio),
    Degrees is (Metres - Driven) / (pi*0.056) * 360,
    lane_leg(Degrees, Brick, Wheels, Ratio),
    lane_drive(Legs, Brick).

%   lane_steering(?Turn, -Wheels, -Ratio): the outer wheel begins, because its
%   lead of a moment does not turn the robot off the line.

lane_steering(straight, [b,c], 0).
lane_steering(left, [c,b], 10).
lane_steering(right, [b,c], -10).

lane_leg(Degrees, _, _, _) :-
    Degrees < 1,
    !.
lane_leg(Degrees0, Brick, Wheels, Ratio) :-
    Degrees is round(Degrees0 / (1 - abs(Ratio)/100)),  % of the outer wheel
    lane_start(Ratio, Brick, Wheels, Degrees),
    lane_await(Brick).

%   Straight on the robot begins slowly, because the second wheel starts later.
%   Of synchronized wheels c follows b, and c has the limit.

lane_start(0, Brick, Wheels, Degrees) :-
    !,
    nxt_run(Brick, Wheels, 10,
            [sync(0), brake(true), degrees(Degrees)]),
    nxt_run(Brick, b, 75, [sync(0), brake(true)]).
lane_start(Ratio, Brick, Wheels, Degrees) :-
    nxt_run(Brick, Wheels, 60,
            [sync(Ratio), brake(true), degrees(Degrees)]).

%!  lane_driven(+Brick, -Metres) is det.
%
%   Metres driven since the tachometers of the wheels were reset.

lane_driven(Brick, Metres) :-
    nxt_tacho(Brick, b, Left),
    nxt_tacho(Brick, c, Right),
    Metres is (Left + Right)/720 * pi*0.056.

lane_await(Brick) :-
    now(Now),
    Deadline is Now + 120,
    lane_await(Brick, Deadline).

lane_await(Brick, _) :-
    lane_idle(Brick, b),
    lane_idle(Brick, c),
    !.
lane_await(Brick, Deadline) :-
    now(Now),
    Now < Deadline,
    !,
    sleep(0.15),
    lane_await(Brick, Deadline).
lane_await(Brick, _) :-
    nxt_float(Brick, [b,c]),
    throw(error(robot_lost(stuck), _)).

lane_idle(Brick, Motor) :-
    nxt_motor(Brick, Motor, State),
    memberchk(state(idle), State).

%!  lane_find(+Brick, +Colour, +Metres) is det.
%
%   Drives on in small steps until a sensor detects Colour, at most Metres.

lane_find(Brick, Colour, _) :-
    lane_colour(Brick, Colour),
    !.
lane_find(Brick, Colour, Metres) :-
    Metres > 0,
    !,
    nxt_turn(Brick, [b,c], 25, 41),             % 2 cm
    lane_await(Brick),
    Left is Metres - 0.02,
    lane_find(Brick, Colour, Left).
lane_find(_, Colour, _) :-
    throw(error(robot_lost(no_marker(Colour)), _)).

lane_colour(Brick, Colour) :-
    nxt_colour(Brick, 3, Colour),
    !.
lane_colour(Brick, Colour) :-
    nxt_colour(Brick, 4, Colour).

%!  lane_between(+X0, +X, +Turn, -Way) is det.
%
%   Way leads along the main line from X0, where a line meets it, to X,
%   where the robot turns.  In the arena seven lines of the dock meet the main
%   line, and five lines at places where boxes are pushed.

lane_between(X0, X, Turn, Way) :-
    Low is min(X0, X) - 0.01,
    High is max(X0, X) + 0.01,
    findall(Junction,
            ( lane_junction(Junction), Junction > Low, Junction < High ),
            Junctions0),
    (   X0 > X
    ->  reverse(Junctions0, Junctions)
    ;   Junctions = Junctions0
    ),
    lane_pieces(Junctions, Turn, Way).

lane_junction(X) :-
    between(1, 7, Slot),
    X is 0.4 + 0.3*(Slot - 1).
lane_junction(X) :-
    between(1, 5, Place),
    X is 2.8 + 0.16*(Place - 1).

lane_pieces([X0,X], Turn, [Metres-Turn]) :-
    !,
    Metres is abs(X - X0).
lane_pieces([X0,X|Xs], Turn, [Metres-straight|Way]) :-
    Metres is abs(X - X0),
    lane_pieces([X|Xs], Turn, Way).

%!  lane_face(+Brick, +Compass) is det.
%
%   Turns on the spot until the compass shows about Compass degrees.  This may
%   take several turns, because the wheels may not start at the same moment.

lane_face(Brick, Compass) :-
    lane_face(12, Brick, Compass).

lane_face(_, Brick, Compass) :-
    lane_off(Brick, Compass, Off),
    abs(Off) < 20,
    !.
lane_face(Tries, Brick, Compass) :-
    Tries > 0,
    !,
    lane_off(Brick, Compass, Off),
    Left is 2*Off,
    Right is -2*Off,
    nxt_turn(Brick, b, 25, Left),
    nxt_turn(Brick, c, 25, Right),
    lane_await(Brick),
    Tries1 is Tries - 1,
    lane_face(Tries1, Brick, Compass).
lane_face(_, Brick, Compass) :-
    lane_check(Brick, Compass).

%   lane_off(+Brick, +Compass, -Off): Off is the angle to turn to the right, in
%   degrees.

lane_off(Brick, Compass, Off) :-
    nxt_compass(Brick, 2, Degrees),
    Off is (Compass - Degrees + 180) mod 360 - 180.

%!  lane_check(+Brick, +Compass) is det.
%
%   @error robot_lost(heading(Off)): the heading is not about Compass degrees

lane_check(Brick, Compass) :-
    lane_off(Brick, Compass, Off),
    lane_check_off(Off, Brick).

lane_check_off(Off, _) :-
    abs(Off) < 45,
    !.
lane_check_off(Off, Brick) :-
    nxt_float(Brick, [b,c]),
    throw(error(robot_lost(heading(Off)), _)).
