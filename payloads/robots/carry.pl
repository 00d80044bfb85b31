:- payload(carry, [provides([carry/0])]).

/*  Task T3 of carrying a pole (thesis section 5.7): 1.2 m forward.

    The wheels, 56 mm wide, are motors b and c.  Their tachometers have
    counted since the pole was clasped, so a robot that repeats this task
    drives only the rest of the way.  The brick itself stops the wheels there:
    however busy the host is, no robot drives too far.
*/

carry :-
    sense(brick(Robot)),
    now(Start),
    Deadline is Start + 60,
    carry_way(All),
    nxt_tacho(Robot, b, Before),
    Left is max(1, All - Before),
    nxt_run(Robot, [b,c], 10, [sync(0), brake(true), degrees(Left)]),
    carry_end(Robot, All, Deadline, Done),
    nxt_stop(Robot, [b,c]),
    Done == true.

carry_way(Degrees) :-
    Degrees is round(1.2 / (pi * 0.056) * 360).

carry_end(Robot, All, _, true) :-
    nxt_tacho(Robot, b, Degrees),
    Degrees >= All - 3,
    !.
carry_end(_, _, Deadline, false) :-
    now(Now),
    Now > Deadline,
    !.
carry_end(Robot, All, Deadline, Done) :-
    sleep(0.1),
    carry_end(Robot, All, Deadline, Done).
