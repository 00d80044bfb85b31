:- payload(push, [provides([push_box/4])]).

/*  Pushing a box with other robots (thesis section 7.7): from the dock to the
    location of the job, to the robot's place behind the box, and push.  Needs
    the payload `lane`.

    The way to both locations is the same up to a red marker.  Job 1 is on
    the left of the main line, job 2 on the right.  The touch sensor on port
    1 detects the box.  The box moves only while enough robots push; the first
    robots push against it until the others arrive.
*/

%!  push_box(+Job, +Place, +Metres, -Away) is det.
%
%   Pushes the box of Job, 1 or 2, at Place, 1 to 5, by Metres.  Away is the
%   distance of the robot from the main line afterwards, in metres.

push_box(Job, Place, Metres, Away) :-
    sense(brick(Brick)),
    sense(slot(Slot)),
    X is 0.4 + 0.3*(Slot - 1),
    push_to_marker(X, First),
    lane_follow(Brick, First),
    lane_find(Brick, red, 0.24),
    push_to_place(Job, Place, Second),
    lane_follow(Brick, Second),
    push_side(Job, _, Compass),
    lane_check(Brick, Compass),
    nxt_tacho_reset(Brick, [b,c]),
    push_on(Brick, Metres),
    lane_driven(Brick, Driven),
    Away is 0.28 + Driven.

%   The marker is at 2.5, and the sensors are 6 cm ahead of the axle.  The
%   search for it begins well before.

push_to_marker(X, [0.5-left,Metres-stop]) :-
    X > 2.1,
    !,
    Metres is 2.32 - X.
push_to_marker(X, [0.5-left,0.3-straight,Metres-stop]) :-
    Metres is 2.02 - X.

push_to_place(Job, 1, [Metres-Turn,0.28-stop]) :-
    !,
    push_side(Job, Turn, _),
    Metres is 2.8 - 2.425.
push_to_place(Job, Place, [Metres-straight,0.16-Turn,0.28-stop]) :-
    push_side(Job, Turn, _),
    Metres is 2.64 + 0.16*(Place - 1) - 2.425.

push_side(1, left, 0).
push_side(2, right, 180).

push_on(Brick, Metres) :-
    now(Now),
    Deadline is Now + 240,
    Most is round((Metres + 0.3) / (pi*0.056) * 360),
    nxt_run(Brick, [b,c], 50, [regulated(true), degrees(Most)]),
    push_touched(Brick, Deadline),
    Least is Metres + 0.05,
    push_done(Brick, Least, 0, Deadline),
    nxt_stop(Brick, [b,c]),                     % otherwise the robot turns
    nxt_run(Brick, [b,c], -50, [regulated(true)]),
    sleep(0.8),
    nxt_stop(Brick, [b,c]).

push_touched(Brick, _) :-
    nxt_touch(Brick, 1, true),
    !.
push_touched(Brick, Deadline) :-
    push_waits(Brick, Deadline, no_box),
    sleep(0.15),
    push_touched(Brick, Deadline).

%   The box has arrived when it does not move any more after at least Least
%   metres.

push_done(Brick, Least, Before, Deadline) :-
    sleep(0.3),
    lane_driven(Brick, Now),
    push_on(Now, Before, Least, Brick, Deadline).

push_on(Now, Before, Least, _, _) :-
    Now > Least,
    Now - Before < 0.005,
    !.
push_on(Now, _, Least, Brick, Deadline) :-
    push_waits(Brick, Deadline, alone),
    push_done(Brick, Least, Now, Deadline).

push_waits(_, Deadline, _) :-
    now(Now),
    Now < Deadline,
    !.
push_waits(Brick, _, Why) :-
    nxt_float(Brick, [b,c]),
    throw(error(robot_lost(Why), _)).
