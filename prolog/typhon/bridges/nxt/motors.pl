:- module(typhon_nxt_motors,
          [ nxt_run/3,                  % +Brick, +Motors, +Power
            nxt_run/4,                  % +Brick, +Motors, +Power, +Options
            nxt_turn/4,                 % +Brick, +Motors, +Power, +Degrees
            nxt_turn_to/4,              % +Brick, +Motor, +Power, +Angle
            nxt_turn_to/5,              % +Brick, +Motor, +Power, +Angle,
                                        % +Seconds
            nxt_stop/2,                 % +Brick, +Motors
            nxt_float/2,                % +Brick, +Motors
            nxt_tacho/3,                % +Brick, +Motor, -Degrees
            nxt_tacho_reset/2,          % +Brick, +Motors
            nxt_motor/3,                % +Brick, +Motor, -State
            nxt_moves/2,                % +Brick, +Motor
            nxt_await/3                 % +Brick, +Motors, +Seconds
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module(brick, [nxt_command/4]).

/** <module> Motors

A motor is `a`, `b` or `c` ('A', 'B' and 'C' are also accepted); Motors is a
motor, a list of motors, or `all`.  Power is -100 to 100 per cent.  A motor that
has reached its limit is released, and may roll on for some degrees.

*Threading*: any thread; see typhon_nxt_link.
*/

:- multifile typhon_options:declared/4.

%!  nxt_run(+Brick, +Motors, +Power) is det.
%!  nxt_run(+Brick, +Motors, +Power, +Options) is det.
%
%   Begin to turn Motors.  Options:
%
%     - regulated(Boolean): whether Power is a speed, which the brick maintains
%       under load; default `false`
%     - brake(Boolean): brake between the pulses of the current; default as
%       regulated
%     - degrees(N): turn by N degrees; default 0: without limit
%     - sync(Ratio): synchronise two motors: at 0 both turn alike, at 50 the
%       first one does not turn, at 100 it turns in the opposite direction; -50
%       and -100 do the same to the second one
%     - state(State): `running` (default), `ramp_up` or `ramp_down`
%
%   @error domain_error(nxt_motor_option, Option)

nxt_run(Brick, Motors, Power) :-
    nxt_run(Brick, Motors, Power, []).

nxt_run(Brick, Motors, Power, Options) :-
    must_be(between(-100, 100), Power),
    check_options(nxt_motor_option, Options),
    motor_ports(Motors, Ports),
    option(regulated(Regulated), Options, false),
    option(brake(Brake), Options, Regulated),
    option(degrees(Degrees), Options, 0),
    option(state(State), Options, running),
    regulation(Options, Regulated, Regulation, Ratio),
    mode(Brake, Regulation, Mode),
    run_state(Run, State),
    Output = _{power:Power, mode:Mode, regulation:Regulation,
               turn_ratio:Ratio, run_state:Run, limit:Degrees},
    output(Brick, Ports, Output).

typhon_options:declared(nxt_motor_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(regulated(X), boolean, X).
option_type(brake(X), boolean, X).
option_type(degrees(X), nonneg, X).
option_type(sync(X), between(-100, 100), X).
option_type(state(X), oneof([idle, running, ramp_up, ramp_down]), X).

regulation(Options, _, 2, Ratio) :-
    option(sync(Ratio), Options),
    !.
regulation(_, true, 1, 0) :-
    !.
regulation(_, false, 0, 0).

%   Bits: 1 motor on, 2 brake, 4 regulated.

mode(Brake, Regulation, Mode) :-
    ( Brake == true -> Bit1 = 2 ; Bit1 = 0 ),
    ( Regulation > 0 -> Bit2 = 4 ; Bit2 = 0 ),
    Mode is 1+Bit1+Bit2.

run_state(0x00, idle).
run_state(0x10, ramp_up).
run_state(0x20, running).
run_state(0x40, ramp_down).

output(Brick, Ports, Output) :-
    forall(member(Port, Ports),
           nxt_command(Brick, 'SETOUTPUTSTATE', Output.put(port, Port), _)).

motor_ports(Motors, [0xFF]) :-
    Motors == all,
    !.
motor_ports(Motors, Ports) :-
    is_list(Motors),
    !,
    maplist(motor_port, Motors, Ports).
motor_ports(Motor, [Port]) :-
    motor_port(Motor, Port).

motor_port(Motor, Port) :-
    must_be(atom, Motor),
    downcase_atom(Motor, Name),
    (   nth_motor(Name, Port0)
    ->  Port = Port0
    ;   domain_error(nxt_motor, Motor)
    ).

nth_motor(a, 0).
nth_motor(b, 1).
nth_motor(c, 2).

%!  nxt_turn(+Brick, +Motors, +Power, +Degrees:integer) is det.
%
%   Begin to turn Motors by Degrees, at a speed of Power; backwards if one of
%   the two is negative.  nxt_await/3 waits for the end.

nxt_turn(Brick, Motors, Power0, Degrees0) :-
    must_be(between(-100, 100), Power0),
    must_be(integer, Degrees0),
    (   Degrees0 =:= 0
    ->  motor_ports(Motors, _),
        nxt_stop(Brick, Motors)
    ;   Power is Power0*sign(Degrees0),
        Degrees is abs(Degrees0),
        nxt_run(Brick, Motors, Power, [regulated(true), degrees(Degrees)])
    ).

%!  nxt_turn_to(+Brick, +Motor, +Power, +Angle:integer) is det.
%!  nxt_turn_to(+Brick, +Motor, +Power, +Angle:integer, +Seconds) is det.
%
%   Turn Motor to Angle, as measured by nxt_tacho/3.  Without Seconds the call
%   only begins to turn.  With Seconds, the time limit, Motor slows down near
%   Angle, and when the call succeeds it is held at most two degrees off.
%
%   @error timeout_error(nxt(turn_to), Brick) the time limit was exceeded, and
%   Motor was stopped

nxt_turn_to(Brick, Motor, Power0, Angle) :-
    must_be(between(-100, 100), Power0),
    must_be(integer, Angle),
    nxt_tacho(Brick, Motor, Now),
    Degrees is Angle-Now,
    Power is abs(Power0),
    nxt_turn(Brick, Motor, Power, Degrees).

nxt_turn_to(Brick, Motor, Power, Angle, Seconds) :-
    must_be(between(1, 100), Power),
    must_be(integer, Angle),
    must_be(between(0.0, 36000), Seconds),
    deadline(Seconds, Deadline),
    turn_until_near(Brick, Motor, Power, Angle, Deadline).

turn_until_near(Brick, Motor, Power, Angle, Deadline) :-
    nxt_tacho(Brick, Motor, Now),
    Error is Angle-Now,
    monotonic_time(Time),
    (   abs(Error) =< 2
    ->  nxt_stop(Brick, Motor),
        await(turn_to, Brick, Deadline, Motor),
        nxt_tacho(Brick, Motor, Then),
        (   abs(Angle-Then) =< 2
        ->  true
        ;   turn_until_near(Brick, Motor, Power, Angle, Deadline)
        )
    ;   Time > Deadline
    ->  nxt_stop(Brick, Motor),
        time_out(turn_to, Brick, Motor)
    ;   approach(Error, Power, Speed),
        nxt_run(Brick, Motor, Speed, [regulated(true)]),
        sleep(0.01),
        turn_until_near(Brick, Motor, Power, Angle, Deadline)
    ).

%   Speed is proportional to Error: one per cent is 10 degrees in a second, and
%   the brick may need a tenth of a second to answer and as long again to slow
%   down.  Below 6 per cent a motor may not turn at all.

approach(Error, Power, Speed) :-
    Wanted is max(6, abs(Error)//4),
    Speed is sign(Error)*min(Power, Wanted).

time_out(What, Brick, Motor) :-
    throw(error(timeout_error(nxt(What), Brick),
                context(nxt(Brick, What), Motor))).

%!  nxt_stop(+Brick, +Motors) is det.
%
%   Stop Motors, and hold their positions.

nxt_stop(Brick, Motors) :-
    motor_ports(Motors, Ports),
    output(Brick, Ports, _{power:0, mode:7, regulation:1, turn_ratio:0,
                           run_state:0x20, limit:0}).

%!  nxt_float(+Brick, +Motors) is det.
%
%   Release Motors: no current, no brake.

nxt_float(Brick, Motors) :-
    motor_ports(Motors, Ports),
    output(Brick, Ports, _{power:0, mode:0, regulation:0, turn_ratio:0,
                           run_state:0, limit:0}).

%!  nxt_tacho(+Brick, +Motor, -Degrees:integer) is det.
%
%   Degrees is the angle by which Motor has turned since nxt_tacho_reset/2.

nxt_tacho(Brick, Motor, Degrees) :-
    output_state(Brick, Motor, State),
    Degrees = State.rotation.

output_state(Brick, Motor, State) :-
    motor_port(Motor, Port),
    nxt_command(Brick, 'GETOUTPUTSTATE', _{port:Port}, State).

%!  nxt_tacho_reset(+Brick, +Motors) is det.
%
%   Set the angle of Motors to 0 degrees.

nxt_tacho_reset(Brick, Motors) :-
    ( Motors == all -> Ports = [0,1,2] ; motor_ports(Motors, Ports) ),
    forall(member(Port, Ports),
           nxt_command(Brick, 'RESETMOTORPOSITION',
                       _{port:Port, relative:false}, _)).

%!  nxt_motor(+Brick, +Motor, -State:list) is det.
%
%   State is the report of the brick about Motor: power(P), mode(Bits),
%   regulation(none, speed or sync), turn_ratio(R), state(idle, ramp_up, running
%   or ramp_down), limit(Degrees), tacho(D), block(D) and rotation(D).

nxt_motor(Brick, Motor, State) :-
    output_state(Brick, Motor, Dict),
    regulation_name(Dict.regulation, Regulation),
    ( run_state(Dict.run_state, Run) -> true ; Run = Dict.run_state ),
    State = [ power(Dict.power), mode(Dict.mode), regulation(Regulation),
              turn_ratio(Dict.turn_ratio), state(Run), limit(Dict.limit),
              tacho(Dict.tacho), block(Dict.block), rotation(Dict.rotation)
            ].

regulation_name(0, none) :- !.
regulation_name(1, speed) :- !.
regulation_name(2, sync) :- !.
regulation_name(N, N).

%!  nxt_moves(+Brick, +Motor) is semidet.
%
%   Motor is driven, or rolls.  If it is not driven, the call compares two
%   measurements of its angle.

nxt_moves(Brick, Motor) :-
    output_state(Brick, Motor, State),
    (   State.run_state =\= 0,
        State.power =\= 0
    ->  true
    ;   sleep(0.03),
        output_state(Brick, Motor, Later),
        Later.tacho =\= State.tacho
    ).

%!  nxt_await(+Brick, +Motors, +Seconds:number) is det.
%
%   Wait until no motor of Motors moves.
%
%   @error timeout_error(nxt(await), Brick)

nxt_await(Brick, Motors, Seconds) :-
    must_be(between(0.0, 36000), Seconds),
    deadline(Seconds, Deadline),
    (   Motors == all
    ->  List = [a,b,c]
    ;   is_list(Motors)
    ->  List = Motors
    ;   List = [Motors]
    ),
    maplist(await(await, Brick, Deadline), List).

await(What, Brick, Deadline, Motor) :-
    (   \+ nxt_moves(Brick, Motor)
    ->  true
    ;   monotonic_time(Now),
        Now > Deadline
    ->  time_out(What, Brick, Motor)
    ;   sleep(0.02),
        await(What, Brick, Deadline, Motor)
    ).
