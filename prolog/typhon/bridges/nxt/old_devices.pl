:- module(typhon_nxt_old_devices,
          [ rotate_nxt/4,
            rotateto_nxt/4,
            read_accel_nxt/5,
            read_sensorport_nxt/3,
            floodlight_nxt/3,
            start_compasscalibration_nxt/2,
            stop_compasscalibration_nxt/2,
            set_gyroffset_nxt/2         % and those of family/3
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, same_length/2]).
:- use_module(brick, [nxt_command/4]).
:- use_module(link, [link_set/3, link_unset/2, link_value/4]).
:- use_module(motors).
:- use_module(sensors).

/** <module> Motors and sensors by the names of SWI-PRO-NXT

Motors are 'A', 'B' and 'C'.  Speeds are in per cent, clipped to -100 to 100,
accelerations in per cent per second.  Forward is the direction of positive
power, and anticlockwise.

Ports of sensors are 1 to 4.  Light and sound are in per cent, touch is 1 or 0,
distances are in centimetres, 255 without an obstacle; colour, compass,
gyroscope, infrared seeker and accelerometer are those of HiTechnic.

*Threading*: any thread; see typhon_nxt_link.
*/

%   family(Name, Most, Kind): export predicates Name of a brick and 1 to Most
%   ports.  They call the goal of Kind with two more arguments:
%
%     - all(Goal): the brick and the list of the ports
%     - each(Goal): the brick and one port, for each port
%     - value(Goal): the brick, one port and its value, for each port; the
%       values are arguments of the predicate, after the ports
%     - speed(Sign): a move forward or backward: the speed is the last argument
%
%   So `init_light_nxt(b, 1, 3)` sets up two ports, and
%   `read_touch_nxt(b, 1, 3, R1, R3)` returns their values.

term_expansion(family(Name, Most, Kind), Terms) :-
    findall(Term, family_term(Name, Most, Kind, Term), Terms).

family_term(Name, Most, Kind, Term) :-
    between(1, Most, Count),
    length(Ports, Count),
    family_body(Kind, Brick, Ports, Values, Body),
    append([Name,Brick|Ports], Values, List),
    Head =.. List,
    functor(Head, Name, Arity),
    member(Term, [(:- export(Name/Arity)), (Head :- Body)]).

family_body(all(Goal), Brick, Ports, [], call(Goal, Brick, Ports)).
family_body(each(Goal), Brick, Ports, [], maplist(call(Goal, Brick), Ports)).
family_body(value(Goal), Brick, Ports, Values,
            maplist(call(Goal, Brick), Ports, Values)) :-
    same_length(Ports, Values).
family_body(speed(Sign), Brick, Ports, [Speed],
            move_at(Sign, Brick, Ports, Speed)).

family(move_forward_nxt, 2, speed(1)).
family(move_backward_nxt, 2, speed(-1)).
family(flt_nxt, 2, all(nxt_float)).
family(stop_nxt, 2, all(nxt_stop)).
family(reverse_nxt, 2, each(reverse)).
family(set_motorspeed_nxt, 2, value(set_motorspeed)).
family(set_acceleration_nxt, 2, value(set_acceleration)).
family(ismoving_nxt, 2, value(is_moving)).
family(getmode_nxt, 2, value(motor_mode)).
family(init_light_nxt, 4, all(init(light))).
family(init_sound_nxt, 4, all(init(sound))).
family(init_ultrasonic_nxt, 4, all(init(i2c))).
family(init_touch_nxt, 4, all(init(touch))).
family(init_color_nxt, 4, all(init(i2c))).
family(init_compass_nxt, 2, all(init(i2c))).
family(init_gyro_nxt, 2, all(init(gyro))).
family(init_irseeker_nxt, 2, all(init(i2c))).
family(init_accel_nxt, 1, all(init(i2c))).
family(read_light_nxt, 2, value(light)).
family(read_sound_nxt, 2, value(nxt_sound)).
family(read_ultrasonic_nxt, 2, value(distance)).
family(read_touch_nxt, 2, value(touch)).
family(read_color_nxt, 2, value(nxt_colour_number)).
family(read_compass_nxt, 2, value(nxt_compass)).
family(read_gyro_nxt, 2, value(turning)).
family(read_irseeker_nxt, 2, value(nxt_infrared)).

                /*******************************
                *            MOTORS            *
                *******************************/

%!  move_forward_nxt(+Name, +P, +Speed) is det.
%!  move_forward_nxt(+Name, +P1, +P2, +Speed) is det.
%!  move_backward_nxt(+Name, +P, +Speed) is det.
%!  move_backward_nxt(+Name, +P1, +P2, +Speed) is det.
%
%   The motors run at Speed, -100 to 100, until they are stopped.

move_at(Sign, Name, Ports, Speed) :-
    clipped(Speed, Power),
    move(Name, Ports, Sign*Power).

clipped(Speed, Power) :-
    must_be(number, Speed),
    Power is max(-100, min(100, round(Speed))).

%   The firmware has no command for accelerations, so move/3 changes the power
%   in steps.

move(Name, Ports, Power0) :-
    Power is Power0,
    Ports = [First|_],
    link_value(Name, acceleration(First), none, Rate),
    (   Rate == none
    ->  true
    ;   nxt_motor(Name, First, State),
        memberchk(power(Now), State),
        ramp(Name, Ports, Now, Power, Rate)
    ),
    run(Name, Ports, Power).

run(Name, Ports, Power) :-
    nxt_run(Name, Ports, Power, [regulated(true)]).

ramp(Name, Ports, Now, Power, Rate) :-
    Step is max(1, round(Rate*0.05)),
    (   abs(Power-Now) =< Step
    ->  true
    ;   Next is Now+sign(Power-Now)*Step,
        run(Name, Ports, Next),
        sleep(0.05),
        ramp(Name, Ports, Next, Power, Rate)
    ).

%!  flt_nxt(+Name, +P) is det.
%!  flt_nxt(+Name, +P1, +P2) is det.
%!  stop_nxt(+Name, +P) is det.
%!  stop_nxt(+Name, +P1, +P2) is det.
%
%   Release the motors: no current, no brake; stop them and hold their
%   positions.

%!  rotate_nxt(+Name, +P, +Angle, +Dir) is det.
%!  rotateto_nxt(+Name, +P, +Angle, +Sign) is det.
%
%   Turn the motor P by Angle degrees, where Dir is 'A', anticlockwise, or 'C',
%   clockwise; or to Angle, with the Sign + or -.  The motor turns at the speed
%   of set_motorspeed_nxt/3, or 50 by default, and has arrived when the call
%   succeeds.

rotate_nxt(Name, P, Angle, Dir) :-
    must_be(number, Angle),
    direction(Dir, Sign),
    nxt_tacho(Name, P, Now),
    To is Now+Sign*round(Angle),
    turn_to(Name, P, To, Now).

rotateto_nxt(Name, P, Angle, Dir) :-
    must_be(number, Angle),
    direction(Dir, Sign),
    nxt_tacho(Name, P, Now),
    To is Sign*round(Angle),
    turn_to(Name, P, To, Now).

direction(Dir, Sign) :-
    (   sign_of(Dir, Sign0)
    ->  Sign = Sign0
    ;   must_be(atom, Dir),
        domain_error(nxt_direction, Dir)
    ).

sign_of('A', 1).
sign_of('C', -1).
sign_of(+, 1).
sign_of(-, -1).

%   The deadline is three times the expected duration.

turn_to(Name, P, To, Now) :-
    link_value(Name, speed(P), 50, Speed),
    Power is max(1, abs(Speed)),
    Seconds is 10+3*abs(To-Now)/(10*Power),
    nxt_turn_to(Name, P, Power, To, Seconds).

%!  reverse_nxt(+Name, +P) is det.
%!  reverse_nxt(+Name, +P1, +P2) is det.
%
%   Turn the motors in the other direction at the same speed.

reverse(Name, P) :-
    nxt_motor(Name, P, State),
    memberchk(power(Power), State),
    move(Name, [P], -Power).

%!  set_motorspeed_nxt(+Name, +P, +Speed) is det.
%!  set_motorspeed_nxt(+Name, +P1, +P2, +S1, +S2) is det.
%
%   Set the speed of motors.  A turning motor changes its speed at once; for
%   others the speed is used by rotate_nxt/4.

set_motorspeed(Name, P, Speed) :-
    clipped(Speed, Power),
    nxt_motor(Name, P, State),
    link_set(Name, speed(P), Power),
    memberchk(power(Now), State),
    (   Now =:= 0
    ->  true
    ;   memberchk(state(idle), State)
    ->  true
    ;   move(Name, [P], sign(Now)*Power)
    ).

%!  set_acceleration_nxt(+Name, +P, +Acceleration) is det.
%!  set_acceleration_nxt(+Name, +P1, +P2, +A1, +A2) is det.
%
%   Set the acceleration of motors, in per cent per second.  A move then takes
%   time to reach its speed.

set_acceleration(Name, P, Acceleration) :-
    must_be(positive_integer, Acceleration),
    nxt_motor(Name, P, _),
    link_set(Name, acceleration(P), Acceleration).

%!  ismoving_nxt(+Name, +P, -R) is det.
%!  ismoving_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   R is 1 if the motor moves, 0 if not.

is_moving(Name, P, R) :-
    ( nxt_moves(Name, P) -> R = 1 ; R = 0 ).

%!  getmode_nxt(+Name, +P, -R) is det.
%!  getmode_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   R is 1 for a motor that turns forward, 2 for backward, 3 if it is stopped, 4
%   if it has no current.

motor_mode(Name, P, R) :-
    nxt_motor(Name, P, State),
    memberchk(power(Power), State),
    memberchk(mode(Bits), State),
    memberchk(state(Run), State),
    mode(Run, Bits, Power, R).

mode(idle, _, _, 4) :- !.
mode(_, Bits, _, 4) :- Bits /\ 1 =:= 0, !.
mode(_, _, Power, 1) :- Power > 0, !.
mode(_, _, Power, 2) :- Power < 0, !.
mode(_, _, _, 3).

                /*******************************
                *            SENSORS           *
                *******************************/

%!  init_light_nxt(+Name, +P1) is det.
%!  init_light_nxt(+Name, +P1, +P2) is det.
%!  init_light_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_light_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%!  init_sound_nxt(+Name, +P1) is det.
%!  init_sound_nxt(+Name, +P1, +P2) is det.
%!  init_sound_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_sound_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%!  init_ultrasonic_nxt(+Name, +P1) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%!  init_touch_nxt(+Name, +P1) is det.
%!  init_touch_nxt(+Name, +P1, +P2) is det.
%!  init_touch_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_touch_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%!  init_color_nxt(+Name, +P1) is det.
%!  init_color_nxt(+Name, +P1, +P2) is det.
%!  init_color_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_color_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%!  init_compass_nxt(+Name, +P1) is det.
%!  init_compass_nxt(+Name, +P1, +P2) is det.
%!  init_gyro_nxt(+Name, +P1) is det.
%!  init_gyro_nxt(+Name, +P1, +P2) is det.
%!  init_irseeker_nxt(+Name, +P1) is det.
%!  init_irseeker_nxt(+Name, +P1, +P2) is det.
%!  init_accel_nxt(+Name, +P1) is det.
%
%   Set up the ports for sensors of the kind in the name.  Lamps of light
%   sensors are switched as floodlight_nxt/3 has set them.

init(Kind, Name, Ports) :-
    must_be(atom, Name),
    maplist(must_be(between(1, 4)), Ports),
    maplist(init_port(Kind, Name), Ports).

init_port(Kind, Name, Port) :-
    type(Kind, Name, Port, Type, Mode),
    Input is Port-1,
    nxt_command(Name, 'SETINPUTMODE',
                _{port:Input, type:Type, mode:Mode}, _).

type(touch, _, _, 1, 0x20).
type(light, Name, Port, Type, 0x80) :-
    link_value(Name, lamp(Port), on, Lamp),
    ( Lamp == on -> Type = 5 ; Type = 6 ).
type(sound, _, _, 7, 0x80).
type(gyro, _, _, 9, 0).
type(i2c, _, _, 0x0B, 0).

%!  read_light_nxt(+Name, +P, -R) is det.
%!  read_light_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_sound_nxt(+Name, +P, -R) is det.
%!  read_sound_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_ultrasonic_nxt(+Name, +P, -R) is det.
%!  read_ultrasonic_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_touch_nxt(+Name, +P, -R) is det.
%!  read_touch_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_color_nxt(+Name, +P, -R) is det.
%!  read_color_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_compass_nxt(+Name, +P, -R) is det.
%!  read_compass_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_gyro_nxt(+Name, +P, -R) is det.
%!  read_gyro_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%!  read_irseeker_nxt(+Name, +P, -R) is det.
%!  read_irseeker_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   R is the measurement of the sensor at P: light as of nxt_light/4 and
%   loudness, in per cent; the distance in centimetres, 255 without an obstacle;
%   1 if the touch sensor is pressed, else 0; the number of the colour, as of
%   nxt_colour_number/3; the direction, as of nxt_compass/3; the rate of
%   turning, as of nxt_gyro/3, less the offset of set_gyroffset_nxt/2; the
%   direction of the infrared light, as of nxt_infrared/3.

light(Name, Port, R) :-
    link_value(Name, lamp(Port), on, Lamp),
    nxt_light(Name, Port, Lamp, R).

distance(Name, Port, R) :-
    nxt_ultrasonic(Name, Port, Distance),
    ( Distance == inf -> R = 255 ; R = Distance ).

touch(Name, Port, R) :-
    nxt_touch(Name, Port, Pressed),
    ( Pressed == true -> R = 1 ; R = 0 ).

turning(Name, Port, R) :-
    nxt_gyro(Name, Port, Value),
    link_value(Name, gyro(Port), 0, Offset),
    R is Value-Offset.

%!  read_accel_nxt(+Name, +P, -X, -Y, -Z) is det.
%
%   X, Y and Z are the acceleration, as of nxt_accelerometer/5.

read_accel_nxt(Name, P, X, Y, Z) :-
    nxt_accelerometer(Name, P, X, Y, Z).

%!  read_sensorport_nxt(+Name, +P, -R) is det.
%
%   R is the raw value, 0 to 1023, of the sensor for which the port is set up.

read_sensorport_nxt(Name, P, R) :-
    nxt_input(Name, P, Values),
    R = Values.raw.

%!  floodlight_nxt(+Name, +P, +OnOff) is det.
%
%   Switch the lamp of the light sensor `on`, which is its initial state, or
%   `off`.

floodlight_nxt(Name, P, OnOff) :-
    (   memberchk(OnOff, [on, off])
    ->  true
    ;   must_be(atom, OnOff),
        domain_error(oneof([on,off]), OnOff)
    ),
    link_set(Name, lamp(P), OnOff),
    init(light, Name, [P]).

%!  start_compasscalibration_nxt(+Name, +P) is det.
%!  stop_compasscalibration_nxt(+Name, +P) is det.
%
%   Start and end the calibration of the compass, see nxt_compass_calibrate/3.

start_compasscalibration_nxt(Name, P) :-
    nxt_compass_calibrate(Name, P, on).

stop_compasscalibration_nxt(Name, P) :-
    nxt_compass_calibrate(Name, P, off).

%!  set_gyroffset_nxt(+Name, +P) is det.
%
%   Take the present value of the gyroscope, which must be at rest, as its zero.

set_gyroffset_nxt(Name, P) :-
    link_unset(Name, gyro(P)),
    nxt_gyro(Name, P, Value),
    link_set(Name, gyro(P), Value).
