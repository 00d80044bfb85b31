:- payload(release, [provides([release/0])]).

/*  Task T4 of carrying a pole (thesis section 5.7): lower the clasp until
    the pole is on the ground, and open it.
*/

release :-
    sense(brick(Robot)),
    now(Start),
    Deadline is Start + 30,
    nxt_run(Robot, a, -3, [regulated(true)]),
    release_end(Robot, Deadline, Done),
    nxt_float(Robot, a),
    Done == true.

release_end(Robot, _, true) :-
    nxt_tacho(Robot, a, Angle),
    Angle =< 4,
    !.
release_end(_, Deadline, false) :-
    now(Now),
    Now > Deadline,
    !.
release_end(Robot, Deadline, Done) :-
    sleep(0.1),
    release_end(Robot, Deadline, Done).
