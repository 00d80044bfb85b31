:- module(test_tartarus_pins, []).

/** <module> Pins of a Raspberry Pi, by the names that Tartarus has for them

With the simulated board of gpiozero.
*/

:- use_module('../../lib/common').
:- needs([gpio]).
:- use_module('../../lib/tartarus_nodes').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).

%   typed(+Pairs): a platform on a simulated board prints Line after Goal.

typed(Pairs) :-
    setup_call_cleanup(
        setenv('GPIOZERO_PIN_FACTORY', mock),
        with_nodes([[]], [Node], typed(Node, Pairs)),
        unsetenv('GPIOZERO_PIN_FACTORY')).

typed(Node, Pairs) :-
    ports(1, [Port]),
    format(string(Start), "start_tartarus(localhost, ~d, 1).", [Port]),
    type(Node, Start),
    forall(member(Goal-Line, Pairs),
           ( format(string(Text), "~w.", [Goal]),
             type(Node, Text),
             printed(Node, [Line]) )).

:- begin_tests(tartarus_pins).

test(output) :-
    typed([ "wiringPiSetup, pinMode(0, 1), digitalWrite(0, 1), \c
             digitalRead(0, X), writeln(level:X)"-"level:1",
            "pinMode(0, 1), digitalRead(0, X), writeln(kept:X)"-"kept:1",
            "digitalWrite(0, 0), digitalRead(0, X), writeln(level:X)"
            -"level:0" ]).
test(motion) :-
    typed([ "pinMode(7, 0), digitalRead(7, X), writeln(level:X)"-"level:0",
            "typhon:remote(tartarus_gate, pin_drive('WPI7', 1)), \c
             digitalRead(7, X), writeln(level:X)"-"level:1",
            "pullUpDnControl(7, 1), digitalRead(7, X), writeln(down:X)"
            -"down:0",
            "pullUpDnControl(7, 2), digitalRead(7, X), writeln(up:X)"
            -"up:1" ]).
test(dimmed_light) :-
    typed([ "pinMode(1, 1), pinMode(1, 2), pwmWrite(1, 256), \c
             typhon:remote(tartarus_gate, pin('WPI1', X)), writeln(part:X)"
            -"part:0.25",
            "pwmSetMode(0), pwmSetRange(100), pwmSetClock(32), \c
             pwmWrite(1, 50), \c
             typhon:remote(tartarus_gate, pin('WPI1', X)), writeln(part:X)"
            -"part:0.5" ]).
test(pins_of_the_header) :-
    typed([ "ledOn(11, R), typhon:remote(tartarus_gate, pin('BOARD11', X)), \c
             writeln(R:X)"-"led on:1",
            "ledOff(11, R), typhon:remote(tartarus_gate, pin('BOARD11', X)), \c
             writeln(R:X)"-"led off:0",
            "servo(12, 50, 7.5, R), \c
             typhon:remote(tartarus_gate, pin('BOARD12', X)), writeln(R:X)"
            -"moved:0.075",
            "servo(12, 50, 10, R), \c
             typhon:remote(tartarus_gate, pin('BOARD12', X)), writeln(R:X)"
            -"moved:0.1" ]).
test(errors) :-
    typed([ "catch(digitalWrite(3, 1), error(E, _), true), writeln(E)"
            -"existence_error(pin,WPI3)",
            "catch(pinMode(3, 7), error(E, _), true), writeln(E)"
            -"domain_error(pin_mode,7)",
            "catch(pinMode(99, 0), error(E, _), true), writeln(E)"
            -"existence_error(gpio_pin,WPI99)" ]).
test(platform_can_start_again) :-
    ports(1, [Port]),
    format(string(Again),
           "close_tartarus, start_tartarus(localhost, ~d, 1), \c
            pinMode(0, 1), digitalRead(0, X), writeln(again:X)", [Port]),
    typed([ "pinMode(0, 1), digitalWrite(0, 1), digitalRead(0, X), \c
             writeln(level:X)"-"level:1",
            Again-"again:0" ]).

:- end_tests(tartarus_pins).
