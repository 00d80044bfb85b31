:- payload(approach, [provides([approach/0])]).

/*  Task T1 of carrying a pole (thesis section 5.7): drive up to the pole,
    which lies across the way, and close the clasp round it.

    The touch sensor in the clasp, on port 1, detects the pole.
    The clasp is motor a: open at 0 degrees, closed at 90.  The wheels are
    motors b and c; carrying counts from their position at the end of this
    task.  A robot that does not find the pole within a minute stops, and fails.
*/

approach :-
    sense(brick(Robot)),
    now(Start),
    Deadline is Start + 60,
    nxt_run(Robot, [b,c], 12, [sync(0), brake(true)]),
    approach_pole(Robot, Deadline, Found),
    nxt_stop(Robot, [b,c]),
    Found == true,
    nxt_tacho(Robot, a, Before),
    Left is max(1, 90 - Before),
    nxt_run(Robot, a, 10, [regulated(true), degrees(Left)]),
    approach_closed(Robot, Deadline, Closed),
    nxt_stop(Robot, a),
    Closed == true,
    nxt_tacho_reset(Robot, [b,c]).

approach_pole(Robot, _, true) :-
    nxt_touch(Robot, 1, true),
    !.
approach_pole(_, Deadline, false) :-
    now(Now),
    Now > Deadline,
    !.
approach_pole(Robot, Deadline, Found) :-
    sleep(0.1),
    approach_pole(Robot, Deadline, Found).

approach_closed(Robot, _, true) :-
    nxt_tacho(Robot, a, Angle),
    Angle >= 85,
    !.
approach_closed(_, Deadline, false) :-
    now(Now),
    Now > Deadline,
    !.
approach_closed(Robot, Deadline, Closed) :-
    sleep(0.1),
    approach_closed(Robot, Deadline, Closed).
