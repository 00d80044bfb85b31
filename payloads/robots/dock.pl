:- payload(dock, [provides([dock_robot/3])]).

/*  Return to the dock (thesis section 7.7): from behind a pushed box to the
    robot's own slot, where the robot is ready to leave again.  Needs the
    payload `lane`.
*/

%!  dock_robot(+Job, +Place, +Away) is det.
%
%   Job and Place are those of push_box/4, Away is the robot's distance from
%   the main line.

dock_robot(Job, Place, Away) :-
    sense(brick(Brick)),
    sense(slot(Slot)),
    dock_side(Job, Turn, Compass),
    X0 is 2.8 + 0.16*(Place - 1),
    X is 0.4 + 0.3*(Slot - 1),
    lane_face(Brick, Compass),
    lane_between(X0, X, right, Way0),
    append(Way0, [0.5-stop], Way),
    lane_follow(Brick, [Away-Turn|Way]),
    lane_check(Brick, 0),
    lane_face(Brick, 180).

%   Job 1 is north of the main line, the dock is in the west.

dock_side(1, right, 180).
dock_side(2, left, 0).
