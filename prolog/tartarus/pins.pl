:- module(tartarus_pins,
          [ wiringPiSetup/0,
            pinMode/2,                  % +Pin, +Mode
            pullUpDnControl/2,          % +Pin, +Pull
            digitalWrite/2,             % +Pin, +Value
            digitalRead/2,              % +Pin, -Value
            pwmSetMode/1,               % +Mode
            pwmSetRange/1,              % +Range
            pwmSetClock/1,              % +Divisor
            pwmWrite/2,                 % +Pin, +Value
            delay/1,                    % +MilliSeconds
            delayMicroseconds/1,        % +MicroSeconds
            millis/1,                   % -MilliSeconds
            ledOn/2,                    % +Pin, -Result
            ledOff/2,                   % +Pin, -Result
            servo/4                     % +Pin, +Frequency, +Duty, -Result
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [memberchk/2]).
:- use_module('../typhon', [gpio_start/3, remote/2]).
:- use_module('../typhon/kernel/base/monotonic', [monotonic_time/1]).

/** <module> Pins of a Raspberry Pi

The predicates with names of wiringPi have its numbers of pins; ledOn/2,
ledOff/2 and servo/4 those of the header.  The pins belong to the host
`tartarus_gate`, as gpio_start/3 makes them, until the platform is closed.

*Threading*: any thread.
*/

:- dynamic
    pwm_range/1.

pwm_range(1024).

%!  wiringPiSetup is det.
%!  pinMode(+Pin, +Mode) is det.
%!  pullUpDnControl(+Pin, +Pull) is det.
%
%   Use Pin as an input (Mode 0), an output (1), or by PWM (2), unless it is used
%   like that already; let an input have no pull (Pull 0), or a pull down (1) or
%   up (2).
%
%   @error existence_error(host, tartarus_gate) without a platform, and errors of
%   gpio_start/3

wiringPiSetup.

pinMode(Pin, Mode) :-
    wiring(Pin, Name),
    must_be(nonvar, Mode),
    (   mode(Mode, Kind)
    ->  true
    ;   domain_error(pin_mode, Mode)
    ),
    in_pins(pins(Pins)),
    (   memberchk(Name=Kind, Pins)
    ->  true
    ;   Spec =.. [Kind,Name],
        use_as(Pins, Name, Spec)
    ).

mode(0, input).
mode(1, output).
mode(2, pwm).

pullUpDnControl(Pin, Pull0) :-
    wiring(Pin, Name),
    must_be(between(0, 2), Pull0),
    pull(Pull0, Pull),
    in_pins(pins(Pins)),
    use_as(Pins, Name, input(Name, [pull(Pull)])).

pull(0, none).
pull(1, down).
pull(2, up).

%!  digitalWrite(+Pin, +Value) is det.
%!  digitalRead(+Pin, -Value) is det.
%!  pwmWrite(+Pin, +Value) is det.
%!  pwmSetRange(+Range) is det.
%!  pwmSetMode(+Mode) is det.
%!  pwmSetClock(+Divisor) is det.
%
%   Set an output to 0 or 1, read a pin, let an output be high for Value parts of
%   Range, which is 1024 by default.  The frequency of PWM is fixed: mode and
%   clock have no effect.
%
%   @error existence_error(pin, Name) before pinMode/2

digitalWrite(Pin, Value) :-
    wiring(Pin, Name),
    must_be(between(0, 1), Value),
    in_pins(pin(Name, Value)).

digitalRead(Pin, Value) :-
    wiring(Pin, Name),
    in_pins(pin(Name, Value0)),
    Value is truncate(Value0).

pwmWrite(Pin, Value) :-
    wiring(Pin, Name),
    pwm_range(Range),
    must_be(between(0, Range), Value),
    Part is float(Value/Range),
    in_pins(pin(Name, Part)).

pwmSetRange(Range) :-
    must_be(positive_integer, Range),
    transaction(( retractall(pwm_range(_)), assertz(pwm_range(Range)) )).

pwmSetMode(_).
pwmSetClock(_).

%!  delay(+MilliSeconds) is det.
%!  delayMicroseconds(+MicroSeconds) is det.
%!  millis(-MilliSeconds:integer) is det.
%
%   Wait; MilliSeconds are the time of a clock that is never set.

delay(MilliSeconds) :-
    Seconds is MilliSeconds/1000,
    sleep(Seconds).

delayMicroseconds(MicroSeconds) :-
    Seconds is MicroSeconds/1 000 000,
    sleep(Seconds).

millis(MilliSeconds) :-
    monotonic_time(Now),
    MilliSeconds is truncate(Now*1000).

%!  ledOn(+Pin, -Result:atom) is det.
%!  ledOff(+Pin, -Result:atom) is det.
%!  servo(+Pin, +Frequency, +Duty, -Result:atom) is det.
%
%   Set an output, and begin PWM with Duty per cent.  Result is 'led on', 'led
%   off' or `moved`.

ledOn(Pin, 'led on') :-
    led(Pin, 1).

ledOff(Pin, 'led off') :-
    led(Pin, 0).

led(Pin, Value) :-
    header(Pin, Name),
    in_pins(pins(Pins)),
    (   memberchk(Name=output, Pins)
    ->  true
    ;   use_as(Pins, Name, output(Name))
    ),
    in_pins(pin(Name, Value)).

servo(Pin, Frequency, Duty, moved) :-
    header(Pin, Name),
    must_be(between(0.0, 100.0), Duty),
    Part is float(Duty/100),
    in_pins(pins(Pins)),
    use_as(Pins, Name,
           pwm(Name, [frequency(Frequency),initial(Part)])).

                /*******************************
                *           THE HOST           *
                *******************************/

wiring(Pin, Name) :-
    named('WPI', Pin, Name).

header(Pin, Name) :-
    named('BOARD', Pin, Name).

named(Kind, Pin, Name) :-
    must_be(nonneg, Pin),
    atom_concat(Kind, Pin, Name).

use_as(Pins, Name, Spec) :-
    (   memberchk(Name=_, Pins)
    ->  in_pins(pin_close(Name))
    ;   true
    ),
    in_pins(pin_open(Name, Spec)).

in_pins(Goal) :-
    catch(gpio_start(tartarus_gate, [], [open(true)]),
          error(permission_error(start, gpio, _), _),
          true),                        % it has been started before
    remote(tartarus_gate, Goal).
