:- module(typhon_diagnose_nxt,
          [ diagnose_nxt/1              % +Port
          ]).

/** <module> Diagnosis of an unreachable robot

Tests the steps from the Python of the helper to the motors and sensors of a
brick, and stops with advice at the step that fails.  Nothing moves.

*Threading*: the calling thread.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [memberchk/2]).
:- use_module('../../../prolog/typhon/kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../../prolog/typhon/nxt').
:- use_module('../../../prolog/typhon/bridges/nxt/link', [nxt_python/2]).
:- use_module('../diagnose', [diagnose_steps/2, python_says/4]).

%!  diagnose_nxt(+Port) is semidet.
%
%   Prints the result of each step to the brick at Port, a device or a URL of
%   pyserial.  Fails at the first step that does not work.

diagnose_nxt(Port) :-
    findall(Step-Advice, step(Step, Advice), Steps),
    (   diagnose_steps(Steps, check(Port))
    ->  Well = true
    ;   Well = fail
    ),
    (   nxt_brick(diagnosed, _)
    ->  nxt_disconnect(diagnosed)
    ;   true
    ),
    Well.

%   step(Name, Advice)

step(python,
     'Install python3, or set typhon_nxt_link:python.').
step(pyserial,
     'apt install python3-serial, or pip install pyserial.').
step(port,
     'For Bluetooth: rfcomm bind 0 ADDRESS makes /dev/rfcomm0.').
step(permission,
     'Join the group of the device: adduser USER dialout, and log in again.').
step(brick,
     'Is the brick on, in reach, paired (PIN 1234), and not in use?').
step(firmware,
     'Direct commands need LEGO\'s own firmware, protocol 1.124.').
step(name, '').
step(battery,
     'Below 6.5 V motors are weak and Bluetooth fails: charge the battery.').
step(motors, '').
step(sensors, '').
step('round trip',
     'More than 0.5 s: come nearer, or switch other Bluetooth off.').

%   check(Port, Step, Found): Found is the result, as text.

check(_, python, Found) :-
    python_says('import sys; print(sys.executable, sys.version.split()[0])',
                python3, Found).
check(_, pyserial, Found) :-
    python_says('import serial; print(serial.__version__)', serial, Found).
check(Port, port, Found) :-
    (   sub_atom(Port, _, _, _, '://')
    ->  atom_concat(Port, ' is a URL', Found)
    ;   access_file(Port, exist)
    ->  atom_concat(Port, ' exists', Found)
    ;   throw(error(existence_error(nxt_port, Port), _))
    ).
check(Port, permission, Found) :-
    (   sub_atom(Port, _, _, _, '://')
    ->  Found = not_asked
    ;   access_file(Port, read),
        access_file(Port, write)
    ->  Found = 'readable and writable'
    ;   throw(error(permission_error(open, nxt_port, Port), _))
    ).
check(Port, brick, 'a device answers') :-
    nxt_connect(diagnosed, Port).
check(_, firmware, Found) :-
    nxt_info(diagnosed, Info),
    memberchk(firmware(Major, Minor), Info),
    memberchk(protocol(First, Second), Info),
    format(atom(Found), 'firmware ~d.~d, protocol ~d.~d',
           [Major, Minor, First, Second]).
check(_, name, Found) :-
    nxt_info(diagnosed, Info),
    memberchk(name(Name), Info),
    memberchk(address(Address), Info),
    format(atom(Found), '~w, address ~w', [Name, Address]).
check(_, battery, Found) :-
    nxt_battery(diagnosed, MilliVolts),
    Volts is MilliVolts/1000,
    format(atom(Found), '~2f V', [Volts]),
    (   MilliVolts >= 6500
    ->  true
    ;   throw(error(nxt_error(low_battery(Found), diagnosed), _))
    ).
check(_, motors, Found) :-
    maplist(motor, [a,b,c], Texts),
    atomic_list_concat(Texts, ', ', Found).
check(_, sensors, Found) :-
    maplist(sensor, [1,2,3,4], Texts),
    atomic_list_concat(Texts, ', ', Found).
check(_, 'round trip', Found) :-
    monotonic_time(Start),
    forall(between(1, 10, _), nxt_battery(diagnosed, _)),
    monotonic_time(End),
    MilliSeconds is (End-Start)*100,
    format(atom(Found), '~1f ms', [MilliSeconds]),
    (   MilliSeconds < 500
    ->  true
    ;   throw(error(nxt_error(slow(Found), diagnosed), _))
    ).

motor(Motor, Text) :-
    nxt_motor(diagnosed, Motor, State),
    memberchk(rotation(Degrees), State),
    format(atom(Text), '~w at ~d degrees', [Motor, Degrees]).

sensor(Port, Text) :-
    nxt_input(diagnosed, Port, Values),
    format(atom(Text), '~d type ~d raw ~d', [Port, Values.type, Values.raw]).

python_says(Code, Module, Text) :-
    nxt_python([], Python),
    python_says(Python, Code, Module, Text).
