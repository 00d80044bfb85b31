:- module(test_brick, []).
:- use_module('../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../lib/nxt_bricks').
:- use_module('../../lib/brick_scenarios').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [last/2, member/2]).

/** <module> The simulated brick

Telegrams byte by byte; the expectations are typed in from LEGO's documents
and do not come from our own encoder. Mostly the clock stands still (--clock
0) and is set forward by the tests.
*/

%   All tests share one brick, which is switched off and on between them.

:- dynamic shared/2.

open_shared :-
    start_brick(['--tcp', 0, '--clock', 0], Brick),
    brick_place(Brick, _, Place),
    open_line(Place, Line),
    assertz(shared(Brick, Line)).

close_shared :-
    retract(shared(Brick, Line)),
    close_line(Line),
    stop_brick(Brick).

still(Brick, Line, Goal) :-
    shared(Brick, Line),
    tell(Brick, restart),
    forall(member(Port-Kind, [1-touch, 2-sound, 3-light, 4-ultrasonic]),
           tell(Brick, 'plug ~w ~w', [Port, Kind])),
    once(Goal).

%   Steps of a scenario: Request-Reply, silent(Request), tell(Line) and
%   advance(Seconds).

step(Brick, _, advance(Seconds)) =>
    tell(Brick, 'advance ~w', [Seconds]).
step(Brick, _, tell(Words)) =>
    tell(Brick, Words).
step(_, Line, silent(Request)) =>
    send(Line, Request),
    exchange(Line, '0188', '0288007c011d01').
step(_, Line, Request-Reply) =>
    exchange(Line, Request, Found),
    assertion(Found == Reply).

%   Blanks only make long telegrams readable.

plain(A-B, Step) =>
    Step = C-D,
    no_blanks(A, C),
    no_blanks(B, D).
plain(Step, Same) =>
    Same = Step.

no_blanks(Atom, Plain) :-
    atomic_list_concat(Parts, ' ', Atom),
    atomic_list_concat(Parts, Plain).

%   The brick has read all earlier input.

input_read(Brick) :-
    ask(Brick, time, _),
    ask(Brick, time, _).

:- begin_tests(brick_protocol,
               [setup(open_shared), cleanup(close_shared)]).

test(telegrams, [forall(scenario(_Name, Steps))]) :-
    maplist(plain, Steps, Plain),
    still(Brick, Line, maplist(step(Brick, Line), Plain)).
test(frame, Bytes == [3,0, 0x02,0x0c,0x00, 5,0, 0x02,0x0b,0x00,0x78,0x1e]) :-
    still(_, Line,
          ( send_bytes(Line, [2,0, 0x00,0x0c, 2,0, 0x00]),
            send_bytes(Line, [0x0b]),
            receive_bytes(Line, 12, Bytes) )).
%   After a silence a brick drops a partial telegram.

test(part_of_a_frame_is_dropped,
     [ forall(member(Noise, [[9,0, 0x00], [0xff,0xff,0xff,0xff]])),
       Reply == '0288007c011d01' ]) :-
    still(Brick, Line,
          ( send_bytes(Line, Noise),
            input_read(Brick),
            sleep(0.7),
            exchange(Line, '0188', Reply) )).
test(tones_are_remembered, true((abs(T-T0-1) < 0.01,
                                  Hz-Ms == 440-500))) :-
    still(Brick, Line,
          ( ask(Brick, time, time(T0)),
            tell(Brick, 'advance 1'),
            exchange(Line, '0003b801f401', '020300'),
            ask(Brick, sounds, sounds(Sounds)) )),
    last(Sounds, tone(T, Hz, Ms)).
test(eighteen_handles_are_too_many, Status == '81') :-
    still(_, Line,
          ( forall(between(1, 16, _), exchange(Line, '01862a2e2a', _)),
            exchange(Line, '01862a2e2a', Reply),
            sub_atom(Reply, 4, 2, _, Status) )).

:- end_tests(brick_protocol).

                /*******************************
                *             MOTORS           *
                *******************************/

run(Line, Port, Power, Regulation, Limit) :-
    run(Line, Port, Power, Regulation, 0, Limit).

run(Line, Port, Power, Regulation, Turn, Limit) :-
    P is Power /\ 255,
    T is Turn /\ 255,
    L0 is Limit /\ 255,
    L1 is Limit >> 8,
    ( Regulation =:= 0 -> Mode = 3 ; Mode = 7 ),
    hex_list(Request, [0, 4, Port, P, Mode, Regulation, T, 0x20,
                       L0, L1, 0, 0]),
    exchange(Line, Request, '020400').

motor(Brick, Letter, Speed, Rotation) :-
    format(atom(Ask), 'motor ~w', [Letter]),
    ask(Brick, Ask, motor(_, _, _, Speed, _, _, Rotation)).

turned(Brick, Seconds, Letter, Rotation) :-
    motor(Brick, Letter, _, Before),
    tell(Brick, 'advance ~w', [Seconds]),
    motor(Brick, Letter, _, After),
    Rotation is After-Before.

way(Brick, Letter, Sign) :-
    motor(Brick, Letter, _, Rotation),
    Sign is truncate(Rotation/300).

:- begin_tests(brick_motors,
               [setup(open_shared), cleanup(close_shared)]).

test(full_power, true((D > 850, D < 950))) :-
    still(Brick, Line, ( run(Line, 0, 100, 0, 0), turned(Brick, 1, a, D) )).
test(backwards, true((D > -475, D < -400))) :-
    still(Brick, Line, ( run(Line, 1, -50, 0, 0), turned(Brick, 1, b, D) )).
test(load_slows_an_unregulated_motor, true(Loaded < 0.5*Free)) :-
    still(Brick, Line,
          ( run(Line, 0, 60, 0, 0), turned(Brick, 1, a, Free),
            tell(Brick, 'load a 0.4'), turned(Brick, 1, a, Loaded) )).
test(regulation_compensates_load, true(abs(Loaded-Free) < 50)) :-
    still(Brick, Line,
          ( run(Line, 0, 50, 1, 0), turned(Brick, 1, a, Free),
            tell(Brick, 'load a 0.4'), turned(Brick, 1, a, Loaded) )).
test(stalls, true(abs(D) < 2)) :-
    still(Brick, Line,
          ( tell(Brick, 'load a 1'), run(Line, 0, 100, 1, 0),
            turned(Brick, 1, a, D) )).
test(weak_battery, true(Weak < 0.8*Full)) :-
    still(Brick, Line,
          ( run(Line, 0, 100, 0, 0), turned(Brick, 1, a, Full),
            tell(Brick, 'fault battery 5500'), turned(Brick, 1, a, Weak) )).
test(overshoot_is_corrected, true((A >= 360, A < 430,
                                   B >= 720, B < 790))) :-
    still(Brick, Line,
          ( run(Line, 0, 80, 1, 360), turned(Brick, 3, a, A),
            ask(Brick, 'motor a', motor(a, 80, 0, _, _, _, _)),
            run(Line, 0, 80, 1, 360), turned(Brick, 3, a, D), B is A+D )).
test(brake_stops_sooner, true(Braked < Coasted)) :-
    still(Brick, Line,
          ( run(Line, 0, 100, 1, 0), tell(Brick, 'advance 1'),
            exchange(Line, '000400000000000000000000', '020400'),
            turned(Brick, 1, a, Coasted),
            run(Line, 0, 100, 1, 0), tell(Brick, 'advance 1'),
            run(Line, 0, 0, 1, 0), turned(Brick, 1, a, Braked) )).
test(counters_are_apart, [Tacho, Block, Rotation] == [T1, 0, T1]) :-
    still(Brick, Line,
          ( run(Line, 0, 50, 1, 90), tell(Brick, 'advance 2'),
            ask(Brick, 'motor a', motor(_, _, _, _, T1, T1, T1)),
            exchange(Line, '000a0001', '020a00'),
            ask(Brick, 'motor a',
                motor(_, _, _, _, Tacho, Block, Rotation)) )).
test(turn_ratio, [forall(member(P-T-[B, C], [ 60-0-[1, 1], 60-50-[0, 1],
                                              60-100-[-1, 1],
                                              60-(-50)-[1, 0],
                                              (-60)-50-[-1, 0] ])),
                  true(Signs == [B, C])]) :-
    still(Brick, Line,
          ( run(Line, 1, P, 2, T, 0), run(Line, 2, P, 2, T, 0),
            tell(Brick, 'advance 1'),
            maplist(way(Brick), [b, c], Signs) )).
test(synchronized_motors_wait_for_each_other, true((abs(B-C) < 3, B > 50))) :-
    still(Brick, Line,
          ( tell(Brick, 'load c 0.8'),
            run(Line, 1, 80, 2, 0, 0), run(Line, 2, 80, 2, 0, 0),
            tell(Brick, 'advance 1'),
            motor(Brick, b, _, B), motor(Brick, c, _, C) )).
test(ramp_up, true((Early > 0, Early < 400, Late == 0))) :-
    still(Brick, Line,
          ( exchange(Line, '000400500100001084030000', '020400'),
            tell(Brick, 'advance 0.3'),
            motor(Brick, a, Early, _),
            tell(Brick, 'advance 4'),
            ask(Brick, 'motor a', motor(a, 80, Late, _, _, _, N)) )),
    assertion((N >= 900, N < 970)).
test(ramp_down, true((Middle < 600, Middle > 0, End == 0.0))) :-
    still(Brick, Line,
          ( run(Line, 0, 80, 1, 0), tell(Brick, 'advance 1'),
            exchange(Line, '000400000100004084030000', '020400'),
            tell(Brick, 'advance 1'), motor(Brick, a, Middle, _),
            tell(Brick, 'advance 9'), motor(Brick, a, End, _) )).

:- end_tests(brick_motors).
