:- module(test_brick, []).
:- use_module(common).
:- use_module(nxt_bricks).
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [last/2, member/2]).

/** <module> The simulated brick

Telegrams byte by byte; the expectations are typed in from LEGO's documents
and do not come from our own encoder. Mostly time stands still (--clock 0)
but for what a test lets pass.
*/

%   One brick serves many tests: it is switched off and on between them.

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

%   scenario(?Name, ?Steps)

scenario(versions, [ '0188'-'0288007c011d01' ]).
scenario(keep_alive, [ '000d'-'020d00c0270900' ]).
scenario(unknown_direct, [ '0014'-'0214be', '007f'-'027fbe' ]).
scenario(no_reply_wanted, [ silent('800d'), silent('8188') ]).
scenario(no_request, [ silent('020d00'), silent('050d'), silent('00') ]).
scenario(battery,
         [ '000b'-'020b00781e',
           tell('fault battery 6000'), '000b'-'020b007017',
           tell('fault none'), '000b'-'020b00781e' ]).
scenario(name,
         [ '01984e3100000000000000000000000000'-'029800',
           '019b'-'029b004e310000000000000000000000000000165301020100000000\c
                   0060ea0000' ]).
scenario(boot_is_refused_over_bluetooth,
         [ '01974c657427732064616e63653a2053414d424100'
           -'02978a00000000' ]).
scenario(motor_state,
         [ '000600'-'02060000000000000000000000000000000000000000000000',
           '0004013205010010b4000000'-'020400',
           '000601'-'020600013205010010b4000000000000000000000000000000',
           '000603'-'0206c000000000000000000000000000000000000000000000',
           '0004033205010010b4000000'-'0204c0',
           '000a0300'-'020ac0' ]).
scenario(all_motors,
         [ '0004ff9c07010020000000000000'-'020400',    % 13 bytes are fine
           '000602'-'020600029c0701002000000000000000000000000000000000',
           '000600'-'020600009c0701002000000000000000000000000000000000' ]).
scenario(touch,
         [ advance(0.1), '0005000120'-'020500',
           '000700'-'02070000000001200000000000000000',
           advance(0.05),
           '000700'-'0207000001000120ff03ff030000ff03',
           tell('set 1 1'),
           '000700'-'0207000001000120b700b7000100b700',
           '000704'-'0207c000000000000000000000000000',
           '0005040120'-'0205c0' ]).
scenario(transitions_are_counted,
         [ '0005000140'-'020500', advance(0.1),
           tell('set 1 1'), advance(0.2), tell('set 1 0'), advance(0.2),
           '000700'-'0207000001000140ff03ff030200ff03',
           '000800'-'020800',
           '000700'-'0207000001000140ff03ff030000ff03',
           '000804'-'0208c0' ]).
scenario(light,
         [ '0005020580'-'020500', advance(0.05), tell('set 3 1023'),
           '000702'-'02070002010005 80c800ff036400ff03',
           tell('set 3 0'),
           '000702'-'0207000201000580 8003000000000000' ]).
scenario(sound_takes_longer_to_settle,
         [ '0005010700'-'020500', advance(0.2), tell('set 2 0'),
           '000701'-'02070001000007000000000000000000', advance(0.2),
           '000701'-'0207000101000700f403000000000000' ]).
scenario(colour,
         [ tell('plug 4 colour 5'), '0005030d00'-'020500', advance(0.5),
           '000703'-'0207000301000d002c012c0105002c01' ]).
scenario(ultrasonic,
         [ '000f0302010242'-'020fe0', '000e03'-'020ee000',
           '0005030b00'-'020500', advance(0.1), tell('set 4 37'),
           '000f0302010242'-'020f00', '000e03'-'020e2000',
           '000f0302010242'-'020fe0', advance(0.01), '000e03'-'020e0001',
           '001003'-'0210000125000000000000000000000000000000',
           '001003'-'0210000000000000000000000000000000000000' ]).
scenario(ultrasonic_is_a_table_of_items,
         [ '0005030b00'-'020500', advance(0.1),
           '000f0302080210'-'020f00', advance(0.01),
           '001003'-'02100008536f6e61720000000000000000000000',
           '000f0302010212'-'020f00', advance(0.01),
           '001003'-'0210000101000000000000000000000000000000',
           '000f0302070214'-'020f00', advance(0.01),
           '001003'-'021000073130452d326d00000000000000000000' ]).
scenario(ultrasonic_echoes_of_one_shot,
         [ '0005030b00'-'020500', advance(0.1), tell('set 4 37 80 120'),
           '000f030300024101'-'020f00', advance(0.01),
           tell('set 4 200'),
           '000f0302080242'-'020f00', advance(0.01),
           '001003'-'02100008255078ffffffffff0000000000000000' ]).
scenario(compass,
         [ tell('plug 2 compass 275'), '0005010b00'-'020500', advance(0.1),
           '000f0102040242'-'020f00', advance(0.01),
           '001001'-'02100004890113010000000000000000 00000000' ]).
scenario(nobody_at_the_address,
         [ '0005030b00'-'020500', advance(0.1),
           '000f0302011042'-'020f00', advance(0.01), '000e03'-'020edd00',
           '001003'-'0210dd0000000000000000000000000000000000',
           '000f0302010242'-'020f00', advance(0.01), '000e03'-'020e0001' ]).
scenario(ring_of_sixteen_bytes,
         [ '0005030b00'-'020500', advance(0.1),
           '000f0302100242'-'020f00', advance(0.01), '000e03'-'020e0000',
           '000f0302010242'-'020f00', advance(0.01),
           '000f0302020242'-'020f00', advance(0.01), '000e03'-'020e0003',
           '000f0302110242'-'020fed', '000e04'-'020ec0' ]).
scenario(file_is_written_and_read,
         [ '0181612e74787400000000000000000000000000000005000000'
           -'02810000',
           '018300616263'-'028300000300', '0183006465666768'-'02838e000200',
           '018400'-'02840000', '018400'-'02848800',
           '0181612e74787400000000000000000000000000000005000000'
           -'02818f00',
           '0180612e747874'-'0280000005000000',    % a short name will do
           '0182000400'-'0282000004006162636 4',
           '0182000400'-'0282850004006500 0000',
           '0185612e747874'-'02858b612e747874 0000000000 0000000000 \c
                             0000000000',
           '018400'-'02840000',
           '0185612e747874'-'028500612e747874 0000000000 0000000000 \c
                             0000000000',
           '0180612e747874'-'0280870000000000' ]).
scenario(no_space_for_a_file,
         [ '0181612e62696e00000000000000000000000000000080969800'
           -'02818200',
           '0189612e62696e00000000000000000000000000000080969800'
           -'02898900' ]).
scenario(files_are_found,
         [ '01862a2e72786500000000000000000000000000000000'
           -'02860000 44656d6f2e727865000000000000000000000000d2040000',
           '018700'-'02878700000000000000000000000000000000000000000000\c
                     000000',
           '018400'-'02840000',
           '01862a2e786f78'-'028687 0000000000 0000000000 0000000000 \c
                           0000000000 0000000000' ]).
scenario(program,
         [ '0001'-'0201ec',
           '0011'-'0211ec0000000000000000000000000000000000000000',
           '00006e6f2e727865000000000000000000000000 0000'-'0200c0',
           '000044656d6f2e727865000000000000000000000000'-'020000',
           '0011'-'02110044656d6f2e727865000000000000000000000000',
           '0001'-'020100' ]).
scenario(mailboxes_live_while_a_program_runs,
         [ '00090003616200'-'0209ec',
           '000044656d6f2e727865000000000000000000000000'-'020000',
           '00090003616200'-'020900', '00091403616200'-'0209ee',
           '00090002616263'-'0209c0', '00090000'-'0209c0',
           '0013000500'-Read, '0013000501'-Read, '0013000501'-Empty ]) :-
    message_reply('00', '0503616200', Read),
    message_reply('40', '0500', Empty).
scenario(display_is_an_io_map,
         [ '01950100 0a0077000200aa55'-'029500 01000a000200',
           '019401000a0077000300'-'029400 01000a000300aa5500',
           '01940100ff0077000300'-'029490 0100ff000000' ]).
scenario(tone, [ '0003b801f401'-'020300', '000c'-'020c00' ]).
scenario(too_short, [ '0004'-'0204bf', '0182'-'0282bf' ]).

message_reply(Status, Begin, Reply) :-
    format(atom(Left), '0213~w~w', [Status, Begin]),
    format(atom(Reply), '~w~`0t~128|', [Left]).

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
test(half_a_frame_is_forgotten, Reply == '0288007c011d01') :-
    still(_, Line,
          ( send_bytes(Line, [9,0, 0x00]),
            sleep(0.7),
            exchange(Line, '0188', Reply) )).
test(noise_is_dropped, Reply == '0288007c011d01') :-
    still(_, Line,
          ( send_bytes(Line, [0xff,0xff,0xff,0xff]),
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
test(load_slows_what_is_not_regulated, true(Loaded < 0.5*Free)) :-
    still(Brick, Line,
          ( run(Line, 0, 60, 0, 0), turned(Brick, 1, a, Free),
            tell(Brick, 'load a 0.4'), turned(Brick, 1, a, Loaded) )).
test(regulation_makes_up_for_load, true(abs(Loaded-Free) < 50)) :-
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
test(limit_overshoots_then_makes_up, true((A >= 360, A < 430,
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
test(two_in_sync_wait_for_each_other, true((abs(B-C) < 3, B > 50))) :-
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
