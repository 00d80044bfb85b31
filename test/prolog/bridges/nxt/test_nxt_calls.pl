:- module(test_nxt_calls, []).

/** <module> The bridge to NXT bricks: results of calls

With the simulated brick, with the old names, from the command line, and
with a real robot if there is one.
*/

:- use_module('../../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../../lib/nxt_fixtures').
:- use_module(library(plunit)).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(typhon/nxt)).

:- begin_tests(nxt_calls).

test(calls_of_all_kinds) :-
    with_brick(lizzy, [], Brick,
        ( sensors(Brick), motors, files, names, programs )).
test(old_names) :-
    with_brick(Brick, Port, old_names(Brick, Port)).
test(all_old_names_are_defined, Missing == []) :-
    findall(PI,
            ( old_name(PI),
              \+ ( module_property(typhon_nxt, exports(PIs)),
                   member(PI, PIs) )
            ),
            Missing).
test(diagnose, Status == exit(0)) :-
    project_file('app/typhon.pl', App),
    with_brick(_, Port,
               run_swipl([App, diagnose, nxt, Port], [], Status, Out, _)),
    forall(member(Step, [python, pyserial, brick, battery, sensors]),
           ( format(string(Line), 'ok    ~w', [Step]),
             assertion(sub_string(Out, _, _, _, Line)) )).
test(diagnose_nothing, Status-Found == exit(1)-true) :-
    project_file('app/typhon.pl', App),
    run_swipl([App, diagnose, nxt, '/dev/no_such_nxt'], [], Status, Out, _),
    (   sub_string(Out, _, _, _, "FAIL  port")
    ->  Found = true
    ;   Found = Out
    ).
test(motor_must_be_bound) :-
    with_brick(lizzy, [], _,
        ( catch(nxt_run(lizzy, _, 50), error(E, _), true),
          assertion(E == instantiation_error),
          call_cleanup(nxt_turn(lizzy, a, 50, 0), Stopped = true),
          assertion(Stopped == true),
          call_cleanup(nxt_turn(lizzy, a, 50, 9), Begun = true),
          assertion(Begun == true) )).
test(real_brick, [condition(getenv('TYPHON_NXT', _))]) :-
    getenv('TYPHON_NXT', Port),
    connected(real, Port, [],
              ( nxt_info(real, Info),
                memberchk(protocol(1, _), Info),
                nxt_battery(real, MilliVolts),
                assertion(between(4000, 12000, MilliVolts)),
                nxt_tone(real, 440, 200),
                nxt_motor(real, a, _),
                nxt_files(real, '*.*', _),
                nxt_light(real, 3, _)
              )).

sensors(Brick) :-
    forall(member(Port-Value, [1-1, 2-512, 3-1023, 4-37]),
           ( format(atom(Line), 'set ~w ~w', [Port, Value]),
             brick_ask(Brick, Line, ok) )),
    assertion(nxt_touch(lizzy, 1, true)),
    nxt_sound(lizzy, 2, Sound),
    assertion(between(45, 55, Sound)),
    nxt_light(lizzy, 3, off, Light),
    assertion(Light >= 95),
    assertion(nxt_ultrasonic(lizzy, 4, 37)),
    brick_ask(Brick, 'set 4 255', ok),
    assertion(nxt_ultrasonic(lizzy, 4, inf)),
    nxt_i2c(lizzy, 4, [2,8], 8, Maker),
    assertion(append(`LEGO`, _, Maker)),
    brick_ask(Brick, empty_reads, Reads),
    assertion(Reads == empty_reads(0, 0, 0, 0)).

motors :-
    nxt_tacho_reset(lizzy, all),
    nxt_turn_to(lizzy, a, 80, 400, 30),
    nxt_tacho(lizzy, a, Degrees),
    assertion(abs(Degrees-400) =< 2),
    nxt_motor(lizzy, a, Held),
    assertion(memberchk(state(running), Held)),
    assertion(memberchk(mode(7), Held)),        % on, brake, regulated
    nxt_turn(lizzy, b, 50, -90),
    nxt_await(lizzy, b, 30),
    nxt_tacho(lizzy, b, Back),
    assertion(Back =< -80),
    nxt_run(lizzy, c, 100),
    assertion(nxt_moves(lizzy, c)),
    nxt_float(lizzy, c),
    nxt_await(lizzy, c, 30),
    nxt_motor(lizzy, c, State),
    assertion(memberchk(power(0), State)),
    assertion(memberchk(state(idle), State)).

files :-
    numlist(0, 255, Bytes),
    nxt_file_write(lizzy, 'all.bin', Bytes),
    nxt_files(lizzy, '*.bin', Files),
    assertion(Files == ['all.bin'-256]),
    nxt_file_read(lizzy, 'all.bin', Read),
    assertion(Read == Bytes),
    nxt_file_write(lizzy, 'all.bin', [1]),
    nxt_file_read(lizzy, 'all.bin', Again),
    assertion(Again == [1]),
    nxt_file_write(lizzy, 'nothing', []),
    assertion(nxt_file_read(lizzy, nothing, [])),
    nxt_file_delete(lizzy, 'all.bin'),
    assertion(\+ nxt_file_exists(lizzy, 'all.bin')).

names :-
    nxt_set_name(lizzy, 'FourteenChars.'),
    nxt_info(lizzy, Info),
    assertion(memberchk(name('FourteenChars.'), Info)),
    nxt_battery(lizzy, MilliVolts),
    assertion(between(6000, 9500, MilliVolts)).

programs :-
    assertion(\+ nxt_program(lizzy, _)),
    nxt_program_start(lizzy, 'Demo.rxe'),
    assertion(nxt_program(lizzy, 'Demo.rxe')),
    nxt_message_write(lizzy, 3, hello),
    assertion(nxt_message_read(lizzy, 3, true, hello)),
    assertion(\+ nxt_message_read(lizzy, 3, true, _)),
    nxt_program_stop(lizzy).

old_names(Brick, Port) :-
    initialize_nxt(lizzy, Port, 0, Response),
    assertion(Response == started),
    old_motors,
    old_sensors(Brick),
    old_files,
    old_telegrams,
    old_sounds(Brick),
    catch(move_forward_nxt(lizzy, 1, 50), error(E, _), true),
    assertion(E == type_error(atom, 1)),
    close_nxt(lizzy).

old_motors :-
    set_motorspeed_nxt(lizzy, 'A', 250),        % clipped to 100
    rotate_nxt(lizzy, 'A', 90, 'C'),
    nxt_tacho(lizzy, a, Degrees),
    assertion(abs(Degrees+90) =< 2),
    move_forward_nxt(lizzy, 'B', -250),
    nxt_motor(lizzy, b, Clipped),
    assertion(memberchk(power(-100), Clipped)),
    move_forward_nxt(lizzy, 'B', 60),
    getmode_nxt(lizzy, 'B', 1),
    reverse_nxt(lizzy, 'B'),
    getmode_nxt(lizzy, 'B', 2),
    ismoving_nxt(lizzy, 'B', 1),
    stop_nxt(lizzy, 'B'),
    getmode_nxt(lizzy, 'B', 3),
    flt_nxt(lizzy, 'B'),
    getmode_nxt(lizzy, 'B', 4).

old_sounds(Brick) :-
    nxt_tone(lizzy, 600, 100),
    get_time(Before),
    wait_nxt(lizzy, 100),
    get_time(After),
    assertion(After-Before >= 0.1),
    brick_ask(Brick, sounds, Sounds),
    assertion(sub_term(600, Sounds)).

old_sensors(Brick) :-
    brick_ask(Brick, 'set 1 1', ok),
    init_touch_nxt(lizzy, 1),
    read_touch_nxt(lizzy, 1, 1).

old_files :-
    exists_nxt(lizzy, 'Demo.rxe', Exists),
    assertion(Exists == '1'),
    with_output_to(string(_), get_files_nxt(lizzy, Files)),
    assertion(sub_atom(Files, _, _, _, 'Demo.rxe')).

old_telegrams :-
    write_nxt(lizzy, 'GETBATTERYLEVEL'),
    read_res_nxt(lizzy, Values),
    assertion(get_dict(millivolts, Values, _)).

old_name(Name/Arity) :-
    member(Name-Arities,
           [ setup_nxt-[1], initialize_nxt-[4], connect2_nxt-[4],
             connect_nxt-[3], close_nxt-[1], write_nxt-[2],
             written_nxt-[2], read_nxt-[2], read_res_nxt-[2],
             check_res_nxt-[2], move_forward_nxt-[3,4],
             move_backward_nxt-[3,4], flt_nxt-[2,3], stop_nxt-[2,3],
             rotate_nxt-[4], rotateto_nxt-[4], reverse_nxt-[2,3],
             set_motorspeed_nxt-[3,5], set_acceleration_nxt-[3,5],
             ismoving_nxt-[3,5], getmode_nxt-[3,5], write_lcd_nxt-[4],
             clear_lcd_nxt-[1], beep_nxt-[2], wait_nxt-[2], exec_nxt-[2],
             del_nxt-[2], exists_nxt-[3], download_nxt-[3],
             get_files_nxt-[2], init_light_nxt-[2,3,4,5],
             init_sound_nxt-[2,3,4,5], init_ultrasonic_nxt-[2,3,4,5],
             init_touch_nxt-[2,3,4,5], init_color_nxt-[2,3,4,5],
             init_compass_nxt-[2,3], init_gyro_nxt-[2,3],
             init_irseeker_nxt-[2,3], init_accel_nxt-[2],
             read_light_nxt-[3,5], read_sound_nxt-[3,5],
             read_ultrasonic_nxt-[3,5], read_touch_nxt-[3,5],
             read_color_nxt-[3,5], read_compass_nxt-[3,5],
             read_gyro_nxt-[3,5], read_irseeker_nxt-[3,5],
             read_accel_nxt-[5], read_sensorport_nxt-[3],
             floodlight_nxt-[3], start_compasscalibration_nxt-[2],
             stop_compasscalibration_nxt-[2], set_gyroffset_nxt-[2]
           ]),
    member(Arity, Arities).

:- end_tests(nxt_calls).
