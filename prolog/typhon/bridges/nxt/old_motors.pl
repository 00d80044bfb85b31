:- module(typhon_nxt_old_motors,
          [ move_forward_nxt/3,
            move_forward_nxt/4,
            move_backward_nxt/3,
            move_backward_nxt/4,
            flt_nxt/2,
            flt_nxt/3,
            stop_nxt/2,
            stop_nxt/3,
            rotate_nxt/4,
            rotateto_nxt/4,
            reverse_nxt/2,
            reverse_nxt/3,
            set_motorspeed_nxt/3,
            set_motorspeed_nxt/5,
            set_acceleration_nxt/3,
            set_acceleration_nxt/5,
            ismoving_nxt/3,
            ismoving_nxt/5,
            getmode_nxt/3,
            getmode_nxt/5
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(motors).
:- use_module(old_state, [old_set/3, old_value/4]).

/** <module> Motors by the names of SWI-PRO-NXT

Motors are 'A', 'B' and 'C'.  Speeds are per cent, clipped to -100 to 100,
accelerations per cent in a second.  Forward is the direction of positive
power, and anticlockwise.

*Threading*: any thread; see typhon_nxt_link.
*/

%!  move_forward_nxt(+Name, +P, +Speed) is det.
%!  move_forward_nxt(+Name, +P1, +P2, +Speed) is det.
%!  move_backward_nxt(+Name, +P, +Speed) is det.
%!  move_backward_nxt(+Name, +P1, +P2, +Speed) is det.
%
%   The motors run at Speed, -100 to 100, until they are stopped.

move_forward_nxt(Name, P, Speed) :-
    clipped(Speed, Power),
    move(Name, [P], Power).

move_forward_nxt(Name, P1, P2, Speed) :-
    clipped(Speed, Power),
    move(Name, [P1,P2], Power).

move_backward_nxt(Name, P, Speed) :-
    clipped(Speed, Power),
    move(Name, [P], -Power).

move_backward_nxt(Name, P1, P2, Speed) :-
    clipped(Speed, Power),
    move(Name, [P1,P2], -Power).

clipped(Speed, Power) :-
    must_be(number, Speed),
    Power is max(-100, min(100, round(Speed))).

%   The brick cannot be told an acceleration, so it is done in steps here.

move(Name, Ports, Power0) :-
    Power is Power0,
    Ports = [First|_],
    old_value(Name, acceleration(First), none, Rate),
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
%   Let go, and stop and hold.

flt_nxt(Name, P) :-
    nxt_float(Name, P).

flt_nxt(Name, P1, P2) :-
    nxt_float(Name, [P1,P2]).

stop_nxt(Name, P) :-
    nxt_stop(Name, P).

stop_nxt(Name, P1, P2) :-
    nxt_stop(Name, [P1,P2]).

%!  rotate_nxt(+Name, +P, +Angle, +Dir) is det.
%!  rotateto_nxt(+Name, +P, +Angle, +Sign) is det.
%
%   Turn by Angle degrees, Dir being 'A', anticlockwise, or 'C', clockwise;
%   or to an angle, Sign being + or -.  The motor has the speed of
%   set_motorspeed_nxt/3, else 50, and is there when this is true.

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

%   Three times as long as it should take.

turn_to(Name, P, To, Now) :-
    old_value(Name, speed(P), 50, Speed),
    Power is max(1, abs(Speed)),
    Seconds is 10+3*abs(To-Now)/(10*Power),
    nxt_turn_to(Name, P, Power, To, Seconds).

%!  reverse_nxt(+Name, +P) is det.
%!  reverse_nxt(+Name, +P1, +P2) is det.
%
%   Turn the other way at the same speed.

reverse_nxt(Name, P) :-
    nxt_motor(Name, P, State),
    memberchk(power(Power), State),
    move(Name, [P], -Power).

reverse_nxt(Name, P1, P2) :-
    reverse_nxt(Name, P1),
    reverse_nxt(Name, P2).

%!  set_motorspeed_nxt(+Name, +P, +Speed) is det.
%!  set_motorspeed_nxt(+Name, +P1, +P2, +S1, +S2) is det.
%
%   Of a motor that turns, at once; of one that does not, for rotate_nxt/4.

set_motorspeed_nxt(Name, P, Speed) :-
    clipped(Speed, Power),
    nxt_motor(Name, P, State),
    old_set(Name, speed(P), Power),
    memberchk(power(Now), State),
    (   Now =:= 0
    ->  true
    ;   memberchk(state(idle), State)
    ->  true
    ;   move(Name, [P], sign(Now)*Power)
    ).

set_motorspeed_nxt(Name, P1, P2, S1, S2) :-
    set_motorspeed_nxt(Name, P1, S1),
    set_motorspeed_nxt(Name, P2, S2).

%!  set_acceleration_nxt(+Name, +P, +Acceleration) is det.
%!  set_acceleration_nxt(+Name, +P1, +P2, +A1, +A2) is det.
%
%   Per cent in a second.  A move then takes the time to get to its speed.

set_acceleration_nxt(Name, P, Acceleration) :-
    must_be(positive_integer, Acceleration),
    nxt_motor(Name, P, _),
    old_set(Name, acceleration(P), Acceleration).

set_acceleration_nxt(Name, P1, P2, A1, A2) :-
    set_acceleration_nxt(Name, P1, A1),
    set_acceleration_nxt(Name, P2, A2).

%!  ismoving_nxt(+Name, +P, -R) is det.
%!  ismoving_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   1 if it moves, 0 if not.

ismoving_nxt(Name, P, R) :-
    ( nxt_moves(Name, P) -> R = 1 ; R = 0 ).

ismoving_nxt(Name, P1, P2, R1, R2) :-
    ismoving_nxt(Name, P1, R1),
    ismoving_nxt(Name, P2, R2).

%!  getmode_nxt(+Name, +P, -R) is det.
%!  getmode_nxt(+Name, +P1, +P2, -R1, -R2) is det.
%
%   1 forward, 2 backward, 3 stopped, 4 let go.

getmode_nxt(Name, P, R) :-
    nxt_motor(Name, P, State),
    memberchk(power(Power), State),
    memberchk(mode(Bits), State),
    memberchk(state(Run), State),
    mode(Run, Bits, Power, R).

getmode_nxt(Name, P1, P2, R1, R2) :-
    getmode_nxt(Name, P1, R1),
    getmode_nxt(Name, P2, R2).

mode(idle, _, _, 4) :- !.
mode(_, Bits, _, 4) :- Bits /\ 1 =:= 0, !.
mode(_, _, Power, 1) :- Power > 0, !.
mode(_, _, Power, 2) :- Power < 0, !.
mode(_, _, _, 3).
