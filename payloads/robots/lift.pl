:- payload(lift, [provides([lift/0])]).

/*  Task T2 of carrying a pole (thesis section 5.7): lift the pole that is
    in the clasp.  A closed clasp rises when its motor turns on: at 90
    degrees it is on the ground, at 270 at its highest position.  It rises
    slowly, because not all robots begin at the same moment, and the motor holds
    it there.
*/

lift :-
    sense(brick(Robot)),
    now(Start),
    Deadline is Start + 30,
    nxt_run(Robot, a, 3, [regulated(true)]),
    lift_end(Robot, Deadline, Done),
    nxt_stop(Robot, a),
    Done == true.

lift_end(Robot, _, true) :-
    nxt_tacho(Robot, a, Angle),
    Angle >= 265,
    !.
lift_end(_, Deadline, false) :-
    now(Now),
    Now > Deadline,
    !.
lift_end(Robot, Deadline, Done) :-
    sleep(0.1),
    lift_end(Robot, Deadline, Done).
