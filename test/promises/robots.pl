%   What doc/robots.md promises, see ../promises.pl.

promise(motors_a_b_c, nxt,
        'prolog/typhon/bridges/nxt/motors.pl',
        "motor_ports(Motors, [0xFF]) :-"-
        "motor_ports(Motors, [0]) :-").
promise(power_in_per_cent, nxt_calls,
        'prolog/typhon/bridges/nxt/motors.pl',
        "nxt_run(Brick, Motors, Power, Options) :-\n\c
         \s   must_be(between(-100, 100), Power),"-
        "nxt_run(Brick, Motors, Power, Options) :-\n\c
         \s   must_be(integer, Power),").
promise(sensor_ports_from_1, nxt,
        'prolog/typhon/bridges/nxt/sensors.pl',
        "    Input is Port-1."-
        "    Input is Port.").
promise(holds_at_the_angle, nxt_calls,
        'prolog/typhon/bridges/nxt/motors.pl',
        "    (   abs(Error) =< 2\n\c
         \s   ->  nxt_stop(Brick, Motor),"-
        "    (   abs(Error) =< 2\n\c
         \s   ->  nxt_float(Brick, Motor),").
promise(deadline_of_a_call, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "    option(deadline(Seconds), Options, 3),"-
        "    Seconds = 30, Options = Options,").
promise(error_names_brick_and_request, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "            error(Formal, context(nxt(Brick, What), Text))) :-"-
        "            error(Formal, context(nxt(Brick), Text))) :-").
promise(no_such_port, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "formal(no_such_port, _, _, Port, _, existence_error(nxt_port, Port)) :- !.\n"-
        "").
promise(port_may_not_be_opened, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "formal(permission, _, _, Port, _,\n\c
         \s      permission_error(open, nxt_port, Port)) :- !.\n"-
        "").
promise(port_is_used_by_another, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "       permission_error(lock, nxt_port, Port)) :- !."-
        "       permission_error(open, nxt_port, Port)) :- !.").
promise(silent_brick, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "formal(timeout, _, Brick, _, What, timeout_error(nxt(What), Brick)) :- !."-
        "formal(timeout, _, Brick, _, _, timeout_error(nxt, Brick)) :- !.").
promise(brick_that_refuses, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "formal(refused, Dict, Brick, _, _, nxt_error(refused(Status), Brick)) :-\n\c
         \s   !,\n\c
         \s   get_dict(status, Dict, Status).\n"-
        "").
promise(helper_that_ended, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "failure(died(Status), Brick, _, _, nxt_error(helper_died(Status), Brick), _)."-
        "failure(died(_), Brick, _, _, nxt_error(line_lost, Brick), _).").
promise(no_pyserial, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "formal(no_pyserial, _, _, _, _,\n\c
         \s      existence_error(python_module, serial)) :- !.\n"-
        "").
promise(brick_is_not_connected, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "    (   brick(Brick, Port, Options)\n\c
         \s   ->  true\n\c
         \s   ;   existence_error(nxt_brick, Brick)"-
        "    (   brick(Brick, Port, Options)\n\c
         \s   ->  true\n\c
         \s   ;   existence_error(helper, Brick)").
promise(connected_once, nxt_faults,
        'prolog/typhon/bridges/nxt/link.pl',
        "open_link(Brick, _, _, _) :-\n\c
         \s   brick(Brick, _, _),\n\c
         \s   !,\n\c
         \s   permission_error(connect, nxt_brick, Brick).\n"-
        "").
promise(stuck_helper_is_killed, nxt_faults,
        'prolog/typhon/bridges/helper/requests.pl',
        "    ;   process_kill_of(Owner),\n\c
         \s       Answer = stuck"-
        "    ;   Answer = stuck, Owner = Owner").
promise(confirmed_motor_commands, nxt,
        'prolog/typhon/bridges/nxt/brick.pl',
        "    (   unacknowledged(Command),\n\c
         \s       link_option(Brick, confirm(false))\n\c
         \s   ->"-
        "    (   unacknowledged(Command)\n\c
         \s   ->").
promise(old_speeds_are_clipped, nxt_calls,
        'prolog/typhon/bridges/nxt/old_devices.pl',
        "    Power is max(-100, min(100, round(Speed)))."-
        "    Power is round(Speed).").
