:- module(typhon_nxt_old_sensors,
          [ init_light_nxt/2,
            init_light_nxt/3,
            init_light_nxt/4,
            init_light_nxt/5,
            init_sound_nxt/2,
            init_sound_nxt/3,
            init_sound_nxt/4,
            init_sound_nxt/5,
            init_ultrasonic_nxt/2,
            init_ultrasonic_nxt/3,
            init_ultrasonic_nxt/4,
            init_ultrasonic_nxt/5,
            init_touch_nxt/2,
            init_touch_nxt/3,
            init_touch_nxt/4,
            init_touch_nxt/5,
            init_color_nxt/2,
            init_color_nxt/3,
            init_color_nxt/4,
            init_color_nxt/5,
            init_compass_nxt/2,
            init_compass_nxt/3,
            init_gyro_nxt/2,
            init_gyro_nxt/3,
            init_irseeker_nxt/2,
            init_irseeker_nxt/3,
            init_accel_nxt/2,
            read_light_nxt/3,
            read_light_nxt/5,
            read_sound_nxt/3,
            read_sound_nxt/5,
            read_ultrasonic_nxt/3,
            read_ultrasonic_nxt/5,
            read_touch_nxt/3,
            read_touch_nxt/5,
            read_color_nxt/3,
            read_color_nxt/5,
            read_compass_nxt/3,
            read_compass_nxt/5,
            read_gyro_nxt/3,
            read_gyro_nxt/5,
            read_irseeker_nxt/3,
            read_irseeker_nxt/5,
            read_accel_nxt/5,
            read_sensorport_nxt/3,
            floodlight_nxt/3,
            start_compasscalibration_nxt/2,
            stop_compasscalibration_nxt/2,
            set_gyroffset_nxt/2
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(brick, [nxt_command/4]).
:- use_module(old_state, [old_clear/2, old_set/3, old_value/4]).
:- use_module(sensors).

/** <module> Sensors by the names of SWI-PRO-NXT

Ports are 1 to 4.  Light and sound are per cent, touch is 1 or 0, distances
are centimetres, 255 if there is nothing; colour, compass, gyroscope,
infrared seeker and accelerometer are those of HiTechnic.

*Threading*: any thread; see typhon_nxt_link.
*/

%!  init_light_nxt(+Name, +P1) is det.
%!  init_light_nxt(+Name, +P1, +P2) is det.
%!  init_light_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_light_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%
%   There are light sensors at these ports, their lamps as
%   floodlight_nxt/3 has it.

init_light_nxt(N, P1) :- init(light, N, [P1]).
init_light_nxt(N, P1, P2) :- init(light, N, [P1, P2]).
init_light_nxt(N, P1, P2, P3) :- init(light, N, [P1, P2, P3]).
init_light_nxt(N, P1, P2, P3, P4) :- init(light, N, [P1, P2, P3, P4]).

%!  init_sound_nxt(+Name, +P1) is det.
%!  init_sound_nxt(+Name, +P1, +P2) is det.
%!  init_sound_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_sound_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%
%   There are sound sensors at these ports.

init_sound_nxt(N, P1) :- init(sound, N, [P1]).
init_sound_nxt(N, P1, P2) :- init(sound, N, [P1, P2]).
init_sound_nxt(N, P1, P2, P3) :- init(sound, N, [P1, P2, P3]).
init_sound_nxt(N, P1, P2, P3, P4) :- init(sound, N, [P1, P2, P3, P4]).

%!  init_ultrasonic_nxt(+Name, +P1) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_ultrasonic_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%
%   There are ultrasonic sensors at these ports.

init_ultrasonic_nxt(N, P1) :- init(i2c, N, [P1]).
init_ultrasonic_nxt(N, P1, P2) :- init(i2c, N, [P1, P2]).
init_ultrasonic_nxt(N, P1, P2, P3) :- init(i2c, N, [P1, P2, P3]).
init_ultrasonic_nxt(N, P1, P2, P3, P4) :- init(i2c, N, [P1, P2, P3, P4]).

%!  init_touch_nxt(+Name, +P1) is det.
%!  init_touch_nxt(+Name, +P1, +P2) is det.
%!  init_touch_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_touch_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%
%   There are touch sensors at these ports.

init_touch_nxt(N, P1) :- init(touch, N, [P1]).
init_touch_nxt(N, P1, P2) :- init(touch, N, [P1, P2]).
init_touch_nxt(N, P1, P2, P3) :- init(touch, N, [P1, P2, P3]).
init_touch_nxt(N, P1, P2, P3, P4) :- init(touch, N, [P1, P2, P3, P4]).

%!  init_color_nxt(+Name, +P1) is det.
%!  init_color_nxt(+Name, +P1, +P2) is det.
%!  init_color_nxt(+Name, +P1, +P2, +P3) is det.
%!  init_color_nxt(+Name, +P1, +P2, +P3, +P4) is det.
%
%   There are colour sensors at these ports.

init_color_nxt(N, P1) :- init(i2c, N, [P1]).
init_color_nxt(N, P1, P2) :- init(i2c, N, [P1, P2]).
init_color_nxt(N, P1, P2, P3) :- init(i2c, N, [P1, P2, P3]).
init_color_nxt(N, P1, P2, P3, P4) :- init(i2c, N, [P1, P2, P3, P4]).

%!  init_compass_nxt(+Name, +P1) is det.
%!  init_compass_nxt(+Name, +P1, +P2) is det.
%
%   There are compasses at these ports.

init_compass_nxt(N, P1) :- init(i2c, N, [P1]).
init_compass_nxt(N, P1, P2) :- init(i2c, N, [P1, P2]).

%!  init_gyro_nxt(+Name, +P1) is det.
%!  init_gyro_nxt(+Name, +P1, +P2) is det.
%
%   There are gyroscopes at these ports.

init_gyro_nxt(N, P1) :- init(gyro, N, [P1]).
init_gyro_nxt(N, P1, P2) :- init(gyro, N, [P1, P2]).

%!  init_irseeker_nxt(+Name, +P1) is det.
%!  init_irseeker_nxt(+Name, +P1, +P2) is det.
%
%   There are infrared seekers at these ports.

init_irseeker_nxt(N, P1) :- init(i2c, N, [P1]).
init_irseeker_nxt(N, P1, P2) :- init(i2c, N, [P1, P2]).

%!  init_accel_nxt(+Name, +P1) is det.
%
%   There is an accelerometer at this port.

init_accel_nxt(N, P1) :- init(i2c, N, [P1]).

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
    old_value(Name, lamp(Port), on, Lamp),
    ( Lamp == on -> Type = 5 ; Type = 6 ).
type(sound, _, _, 7, 0x80).
type(gyro, _, _, 9, 0).
type(i2c, _, _, 0x0B, 0).

%!  read_light_nxt(+Name, +P, -R) is det.
%!  read_light_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The light at these ports, per cent, as of nxt_light/4.

read_light_nxt(N, P, R) :- read_one(light, N, P, R).
read_light_nxt(N, P1, P2, R1, R2) :- read_two(light, N, P1, P2, R1, R2).

%!  read_sound_nxt(+Name, +P, -R) is det.
%!  read_sound_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The loudness at these ports, per cent.

read_sound_nxt(N, P, R) :- read_one(sound, N, P, R).
read_sound_nxt(N, P1, P2, R1, R2) :- read_two(sound, N, P1, P2, R1, R2).

%!  read_ultrasonic_nxt(+Name, +P, -R) is det.
%!  read_ultrasonic_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The distance at these ports, in centimetres; 255 if there is nothing.

read_ultrasonic_nxt(N, P, R) :- read_one(ultrasonic, N, P, R).
read_ultrasonic_nxt(N, P1, P2, R1, R2) :-
    read_two(ultrasonic, N, P1, P2, R1, R2).

%!  read_touch_nxt(+Name, +P, -R) is det.
%!  read_touch_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   1 if the sensor is pressed, 0 if not.

read_touch_nxt(N, P, R) :- read_one(touch, N, P, R).
read_touch_nxt(N, P1, P2, R1, R2) :- read_two(touch, N, P1, P2, R1, R2).

%!  read_color_nxt(+Name, +P, -R) is det.
%!  read_color_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The number of the colour, as of nxt_colour_number/3.

read_color_nxt(N, P, R) :- read_one(color, N, P, R).
read_color_nxt(N, P1, P2, R1, R2) :- read_two(color, N, P1, P2, R1, R2).

%!  read_compass_nxt(+Name, +P, -R) is det.
%!  read_compass_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The direction, as of nxt_compass/3.

read_compass_nxt(N, P, R) :- read_one(compass, N, P, R).
read_compass_nxt(N, P1, P2, R1, R2) :- read_two(compass, N, P1, P2, R1, R2).

%!  read_gyro_nxt(+Name, +P, -R) is det.
%!  read_gyro_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   The rate of turning, as of nxt_gyro/3, less what
%   set_gyroffset_nxt/2 found.

read_gyro_nxt(N, P, R) :- read_one(gyro, N, P, R).
read_gyro_nxt(N, P1, P2, R1, R2) :- read_two(gyro, N, P1, P2, R1, R2).

%!  read_irseeker_nxt(+Name, +P, -R) is det.
%!  read_irseeker_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   Where the infrared light is, as of nxt_infrared/3.

read_irseeker_nxt(N, P, R) :- read_one(irseeker, N, P, R).
read_irseeker_nxt(N, P1, P2, R1, R2) :- read_two(irseeker, N, P1, P2, R1, R2).

read_two(Kind, Name, P1, P2, R1, R2) :-
    read_one(Kind, Name, P1, R1),
    read_one(Kind, Name, P2, R2).

read_one(light, Name, Port, R) :-
    old_value(Name, lamp(Port), on, Lamp),
    nxt_light(Name, Port, Lamp, R).
read_one(sound, Name, Port, R) :-
    nxt_sound(Name, Port, R).
read_one(ultrasonic, Name, Port, R) :-
    nxt_ultrasonic(Name, Port, Distance),
    ( Distance == inf -> R = 255 ; R = Distance ).
read_one(touch, Name, Port, R) :-
    nxt_touch(Name, Port, Pressed),
    ( Pressed == true -> R = 1 ; R = 0 ).
read_one(color, Name, Port, R) :-
    nxt_colour_number(Name, Port, R).
read_one(compass, Name, Port, R) :-
    nxt_compass(Name, Port, R).
read_one(gyro, Name, Port, R) :-
    nxt_gyro(Name, Port, Value),
    old_value(Name, gyro(Port), 0, Offset),
    R is Value-Offset.
read_one(irseeker, Name, Port, R) :-
    nxt_infrared(Name, Port, R).

%!  read_accel_nxt(+Name, +P, -X, -Y, -Z) is det.
%
%   The acceleration, as of nxt_accelerometer/5.

read_accel_nxt(Name, P, X, Y, Z) :-
    nxt_accelerometer(Name, P, X, Y, Z).

%!  read_sensorport_nxt(+Name, +P, -R) is det.
%
%   The raw value, 0 to 1023, whatever the port is set up for.

read_sensorport_nxt(Name, P, R) :-
    nxt_input(Name, P, Values),
    R = Values.raw.

%!  floodlight_nxt(+Name, +P, +OnOff) is det.
%
%   The lamp of the light sensor, `on` at first.

floodlight_nxt(Name, P, OnOff) :-
    (   memberchk(OnOff, [on, off])
    ->  true
    ;   must_be(atom, OnOff),
        domain_error(oneof([on,off]), OnOff)
    ),
    old_set(Name, lamp(P), OnOff),
    init(light, Name, [P]).

%!  start_compasscalibration_nxt(+Name, +P) is det.
%!  stop_compasscalibration_nxt(+Name, +P) is det.
%
%   Begin and end to calibrate the compass, as of nxt_compass_calibrate/3.

start_compasscalibration_nxt(Name, P) :-
    nxt_compass_calibrate(Name, P, on).

stop_compasscalibration_nxt(Name, P) :-
    nxt_compass_calibrate(Name, P, off).

%!  set_gyroffset_nxt(+Name, +P) is det.
%
%   What the gyroscope says now, at rest, is 0 from now on.

set_gyroffset_nxt(Name, P) :-
    old_clear(Name, gyro(P)),
    nxt_gyro(Name, P, Value),
    old_set(Name, gyro(P), Value).
