:- module(typhon_nxt_sensors,
          [ nxt_touch/3,                % +Brick, +Port, -Pressed
            nxt_light/3,                % +Brick, +Port, -PerCent
            nxt_light/4,                % +Brick, +Port, +Lamp, -PerCent
            nxt_sound/3,                % +Brick, +Port, -PerCent
            nxt_sound/4,                % +Brick, +Port, +Scale, -PerCent
            nxt_colour/3,               % +Brick, +Port, -Colour
            nxt_colour_light/4,         % +Brick, +Port, +Lamp, -Level
            nxt_ultrasonic/3,           % +Brick, +Port, -CentiMetres
            nxt_compass/3,              % +Brick, +Port, -Degrees
            nxt_compass_calibrate/3,    % +Brick, +Port, +OnOff
            nxt_gyro/3,                 % +Brick, +Port, -Value
            nxt_accelerometer/5,        % +Brick, +Port, -X, -Y, -Z
            nxt_infrared/3,             % +Brick, +Port, -Direction
            nxt_colour_number/3,        % +Brick, +Port, -Number
            nxt_sensor/5,               % +Brick, +Port, +Type, +Mode, -Values
            nxt_input/3,                % +Brick, +Port, -Values
            nxt_i2c/5                   % +Brick, +Port, +Bytes, +Count,
                                        % -Answer
          ]).
:- autoload(library(crypto), [hex_bytes/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(brick, [nxt_command/4]).
:- use_module(link, [link_request/4]).

/** <module> Sensors

Ports are 1 to 4, as printed on the brick.  The first reading of a sensor sets
up its port, which takes time; later readings do not.  Two agents that use one
port for different sensors delay each other.

*Threading*: any thread; see typhon_nxt_link.
*/

per_cent(0x80).                 % mode

%!  nxt_sensor(+Brick, +Port, +Type, +Mode, -Values) is det.
%
%   Values is a dict with the keys `raw`, `normalized` and `scaled`, the values
%   that the firmware measures for a sensor of Type in Mode, numbers of LEGO's
%   document.  Waits until the values are valid.

nxt_sensor(Brick, Port, Type, Mode, Values) :-
    input(Port, Input),
    must_be(between(0, 255), Mode),
    must_be(between(0, 18), Type),
    link_request(Brick, sensor,
                 _{do:sensor, port:Input, type:Type, mode:Mode}, Values).

input(Port, Input) :-
    must_be(between(1, 4), Port),
    Input is Port-1.

%!  nxt_input(+Brick, +Port, -Values) is det.
%
%   Values is a dict with the state of Port, for any kind of sensor.

nxt_input(Brick, Port, Values) :-
    input(Port, Input),
    nxt_command(Brick, 'GETINPUTVALUES', _{port:Input}, Values).

%!  nxt_touch(+Brick, +Port, -Pressed:boolean) is det.
%
%   Pressed is true if the touch sensor is pressed.

nxt_touch(Brick, Port, Pressed) :-
    nxt_sensor(Brick, Port, 1, 0x20, Values),
    ( Values.scaled =:= 0 -> Pressed = false ; Pressed = true ).

%!  nxt_light(+Brick, +Port, -PerCent:integer) is det.
%!  nxt_light(+Brick, +Port, +Lamp, -PerCent:integer) is det.
%
%   PerCent is the brightness; 100 is bright.  Lamp is `on` (default) or `off`.

nxt_light(Brick, Port, PerCent) :-
    nxt_light(Brick, Port, on, PerCent).

nxt_light(Brick, Port, Lamp, PerCent) :-
    code(light_type(Lamp, Type), nxt_lamp),
    scaled(Brick, Port, Type, PerCent).

light_type(on, 5).
light_type(off, 6).

%   code(:Table, +Domain): look up the first argument of Table, which is in
%   Domain.

code(Table, Domain) :-
    (   call(Table)
    ->  true
    ;   arg(1, Table, Name),
        domain_error(Domain, Name)
    ).

scaled(Brick, Port, Type, PerCent) :-
    per_cent(Mode),
    nxt_sensor(Brick, Port, Type, Mode, Values),
    PerCent = Values.scaled.

%!  nxt_sound(+Brick, +Port, -PerCent:integer) is det.
%!  nxt_sound(+Brick, +Port, +Scale, -PerCent:integer) is det.
%
%   PerCent is the loudness; 100 is loud.  Scale is `db` (default), or `dba`,
%   adjusted to human hearing.

nxt_sound(Brick, Port, PerCent) :-
    nxt_sound(Brick, Port, db, PerCent).

nxt_sound(Brick, Port, Scale, PerCent) :-
    code(sound_type(Scale, Type), nxt_sound_scale),
    scaled(Brick, Port, Type, PerCent).

sound_type(db, 7).
sound_type(dba, 8).

%!  nxt_colour(+Brick, +Port, -Colour) is det.
%
%   LEGO's colour sensor.  Colour is `black`, `blue`, `green`, `yellow`,
%   `red` or `white`.

nxt_colour(Brick, Port, Colour) :-
    nxt_sensor(Brick, Port, 0x0D, 0, Values),
    (   colour(Values.scaled, Colour0)
    ->  Colour = Colour0
    ;   Colour = Values.scaled
    ).

colour(1, black).
colour(2, blue).
colour(3, green).
colour(4, yellow).
colour(5, red).
colour(6, white).

%!  nxt_colour_light(+Brick, +Port, +Lamp, -Level:integer) is det.
%
%   LEGO's colour sensor as a light sensor, its lamp `red`, `green`, `blue`
%   or `off`.

nxt_colour_light(Brick, Port, Lamp, Level) :-
    code(lamp_type(Lamp, Type), nxt_lamp),
    nxt_sensor(Brick, Port, Type, 0, Values),
    Level = Values.scaled.

lamp_type(red, 0x0E).
lamp_type(green, 0x0F).
lamp_type(blue, 0x10).
lamp_type(off, 0x11).

%!  nxt_gyro(+Brick, +Port, -Value:integer) is det.
%
%   HiTechnic's gyroscope: about 600 at rest, one more for each degree in a
%   second.

nxt_gyro(Brick, Port, Value) :-
    nxt_sensor(Brick, Port, 9, 0, Values),
    Value = Values.raw.

                /*******************************
                *              I2C             *
                *******************************/

%!  nxt_i2c(+Brick, +Port, +Bytes:list, +Count:integer, -Answer:list) is det.
%
%   Send up to 16 Bytes to a sensor: its address, a register, and the values to
%   write there.  Answer has Count bytes, up to 15.
%
%   @error nxt_error(refused(bus_error), Brick) if no device has the address

nxt_i2c(Brick, Port, Bytes, Count, Answer) :-
    input(Port, Input),
    must_be(between(0, 15), Count),
    hex_bytes(Hex, Bytes),
    link_request(Brick, i2c,
                 _{do:i2c, port:Input, data:Hex, rx:Count}, Reply),
    hex_bytes(Reply.data, Answer).

%!  nxt_ultrasonic(+Brick, +Port, -CentiMetres) is det.
%
%   CentiMetres is the distance to an obstacle ahead, or `inf` without an
%   obstacle, which can be compared with numbers.

nxt_ultrasonic(Brick, Port, CentiMetres) :-
    nxt_i2c(Brick, Port, [0x02,0x42], 1, [Byte]),
    ( Byte =:= 255 -> CentiMetres = inf ; CentiMetres = Byte ).

%!  nxt_compass(+Brick, +Port, -Degrees:integer) is det.
%
%   HiTechnic's compass: 0 is north, 90 is east.

nxt_compass(Brick, Port, Degrees) :-
    nxt_i2c(Brick, Port, [0x02,0x44], 2, [Low,High]),
    Degrees is Low+256*High.

%!  nxt_compass_calibrate(+Brick, +Port, +OnOff) is det.
%
%   Between `on` and `off` the compass must be turned slowly, one and a half
%   times.

nxt_compass_calibrate(Brick, Port, OnOff) :-
    code(calibration(OnOff, Mode), oneof([on,off])),
    nxt_i2c(Brick, Port, [0x02,0x41,Mode], 0, []).

calibration(on, 0x43).
calibration(off, 0x00).

%!  nxt_accelerometer(+Brick, +Port, -X, -Y, -Z) is det.
%
%   HiTechnic's accelerometer; 200 is the acceleration of gravity.

nxt_accelerometer(Brick, Port, X, Y, Z) :-
    nxt_i2c(Brick, Port, [0x02,0x42], 6, [X1,Y1,Z1,X0,Y0,Z0]),
    ten_bits(X1, X0, X),
    ten_bits(Y1, Y0, Y),
    ten_bits(Z1, Z0, Z).

ten_bits(High, Low, Value) :-
    (   High > 127
    ->  Value is (High-256)*4+Low
    ;   Value is High*4+Low
    ).

%!  nxt_infrared(+Brick, +Port, -Direction:integer) is det.
%
%   HiTechnic's infrared seeker (version 2): 1 is far left, 5 is ahead, 9 is far
%   right, 0 is no signal.  It detects modulated light.

nxt_infrared(Brick, Port, Direction) :-
    nxt_i2c(Brick, Port, [0x10,0x49], 1, [Direction]).

%!  nxt_colour_number(+Brick, +Port, -Number:integer) is det.
%
%   HiTechnic's colour sensor (version 2): 0 is black, 17 is white.

nxt_colour_number(Brick, Port, Number) :-
    nxt_i2c(Brick, Port, [0x02,0x42], 1, [Number]).
