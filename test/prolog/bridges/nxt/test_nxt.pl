:- module(test_nxt, []).

/** <module> The bridge to NXT bricks: bytes and lines

The bytes on the wire are compared with bytes that are composed here, from
LEGO's document, by other code than that of the bridge.
*/

:- use_module('../../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../../lib/nxt_fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(typhon/bridges/json), [json_dict/2]).
:- use_module(library(lists), [append/2, append/3, member/2, nth1/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon/nxt)).

                /*******************************
                *             BYTES            *
                *******************************/

%   bytes(+Parts, -Hex): a part is a byte, w(N) two and d(N) four of them,
%   lowest first, n(Text, Size) a name, z(N) zeros, t(Text) its characters.

bytes(Parts, Hex) :-
    maplist(part, Parts, Lists),
    append(Lists, Bytes),
    foldl(hex_digits, Bytes, '', Hex).

hex_digits(Byte, Hex0, Hex) :-
    High is Byte>>4,
    Low is Byte/\15,
    Digits = "0123456789abcdef",
    sub_string(Digits, High, 1, _, A),
    sub_string(Digits, Low, 1, _, B),
    atomic_list_concat([Hex0, A, B], Hex).

part(Byte, [Byte]) :- integer(Byte), Byte >= 0, !.
part(Byte, [B]) :- integer(Byte), B is Byte+256.
part(w(N), [A,B]) :- A is N/\255, B is (N>>8)/\255.
part(d(N), [A,B,C,D]) :-
    part(w(N), [A,B]), N1 is N>>16, part(w(N1), [C,D]).
part(z(N), Zeros) :- findall(0, between(1, N, _), Zeros).
part(t(Text), Codes) :- atom_codes(Text, Codes).
part(n(Text, Size), Bytes) :-
    atom_codes(Text, Codes),
    length(Bytes, Size),
    append(Codes, Rest, Bytes),
    length(Rest, Left),
    part(z(Left), Rest).

%   telegram(Command, Args, Request, Reply, Values): the expected bytes.

telegram('STARTPROGRAM', _{name:'a.rxe'}, [0,0,n('a.rxe',20)], [2,0,0], _{}).
telegram('STOPPROGRAM', _{}, [0,1], [2,1,0], _{}).
telegram('PLAYSOUNDFILE', _{loop:true, name:'b.rso'},
         [0,2,1,n('b.rso',20)], [2,2,0], _{}).
telegram('PLAYTONE', _{frequency:14000, duration:65535},
         [0,3,w(14000),w(65535)], [2,3,0], _{}).
telegram('SETOUTPUTSTATE',
         _{port:2, power: -75, mode:7, regulation:2, turn_ratio: -50,
           run_state:32, limit:100000},
         [0,4,2,-75,7,2,-50,32,d(100000)], [2,4,0], _{}).
telegram('SETINPUTMODE', _{port:3, type:11, mode:128},
         [0,5,3,11,128], [2,5,0], _{}).
telegram('GETOUTPUTSTATE', _{port:1}, [0,6,1],
         [2,6,0,1,-100,3,1,5,16,d(360),d(-70000),d(-1),d(2147483647)],
         _{port:1, power: -100, mode:3, regulation:1, turn_ratio:5,
           run_state:16, limit:360, tacho: -70000, block: -1,
           rotation:2147483647}).
telegram('GETINPUTVALUES', _{port:0}, [0,7,0],
         [2,7,0,0,9,0,1,32,w(1023),w(1000),w(-2),w(300)],
         _{port:0, valid:true, calibrated:false, type:1, mode:32, raw:1023,
           normalized:1000, scaled: -2, calibrated_value:300}).
telegram('RESETINPUTSCALEDVALUE', _{port:1}, [0,8,1], [2,8,0], _{}).
telegram('MESSAGEWRITE', _{inbox:4, message:'686921'},
         [0,9,4,4,t('hi!'),0], [2,9,0], _{}).
telegram('RESETMOTORPOSITION', _{port:2, relative:true},
         [0,10,2,1], [2,10,0], _{}).
telegram('GETBATTERYLEVEL', _{}, [0,11], [2,11,0,w(8123)],
         _{millivolts:8123}).
telegram('STOPSOUNDPLAYBACK', _{}, [0,12], [2,12,0], _{}).
telegram('LSGETSTATUS', _{port:3}, [0,14,3], [2,14,0,9], _{ready:9}).
telegram('LSWRITE', _{port:3, rx:8, data:'0242ff'},
         [0,15,3,3,8,2,0x42,255], [2,15,0], _{}).
telegram('LSREAD', _{port:2}, [0,16,2], [2,16,0,3,7,8,9,z(13)],
         _{data:'070809'}).
telegram('GETCURRENTPROGRAMNAME', _{}, [0,17], [2,17,0,n('a.rxe',20)],
         _{name:'a.rxe'}).
telegram('MESSAGEREAD', _{remote:11, local:1, remove:false},
         [0,19,11,1,0], [2,19,0,1,3,t(ok),0,z(56)],
         _{local:1, message:'6f6b'}).
telegram('OPENREAD', _{name:'123456789012345.txt'},
         [1,0x80,n('123456789012345.txt',20)], [2,0x80,0,5,d(70000)],
         _{handle:5, size:70000}).
telegram('OPENWRITE', _{name:'c.txt', size:300},
         [1,0x81,n('c.txt',20),d(300)], [2,0x81,0,6], _{handle:6}).
telegram('READ', _{handle:5, size:300}, [1,0x82,5,w(300)],
         [2,0x82,0,5,w(3),t(abc)], _{handle:5, data:'616263'}).
telegram('WRITE', _{handle:6, data:'00ff10'}, [1,0x83,6,0,255,16],
         [2,0x83,0,6,w(3)], _{handle:6, size:3}).
telegram('CLOSE', _{handle:6}, [1,0x84,6], [2,0x84,0,6], _{handle:6}).
telegram('DELETE', _{name:'c.txt'}, [1,0x85,n('c.txt',20)],
         [2,0x85,0,n('c.txt',20)], _{name:'c.txt'}).
telegram('FINDFIRST', _{pattern:'*.*'}, [1,0x86,n('*.*',20)],
         [2,0x86,0,1,n('c.txt',20),d(300)],
         _{handle:1, name:'c.txt', size:300}).
telegram('FINDNEXT', _{handle:1}, [1,0x87,1],
         [2,0x87,0,1,n('d.txt',20),d(1)], _{handle:1, name:'d.txt', size:1}).
telegram('GETFIRMWAREVERSION', _{}, [1,0x88], [2,0x88,0,124,1,29,1],
         _{protocol_minor:124, protocol_major:1, firmware_minor:29,
           firmware_major:1}).
telegram('OPENWRITELINEAR', _{name:'e.rxe', size:2},
         [1,0x89,n('e.rxe',20),d(2)], [2,0x89,0,2], _{handle:2}).
telegram('OPENWRITEDATA', _{name:'f.txt', size:3},
         [1,0x8B,n('f.txt',20),d(3)], [2,0x8B,0,3], _{handle:3}).
telegram('OPENAPPENDDATA', _{name:'f.txt'}, [1,0x8C,n('f.txt',20)],
         [2,0x8C,0,3,d(17)], _{handle:3, size:17}).
telegram('REQUESTFIRSTMODULE', _{pattern:'*.*'}, [1,0x90,n('*.*',20)],
         [2,0x90,0,4,n('Display.mod',20),d(0xA0001),d(9),w(1719)],
         _{handle:4, name:'Display.mod', id:0xA0001, size:9,
           iomap_size:1719}).
telegram('REQUESTNEXTMODULE', _{handle:4}, [1,0x91,4],
         [2,0x91,0,4,n('Comm.mod',20),d(0x50001),d(0),w(1896)],
         _{handle:4, name:'Comm.mod', id:0x50001, size:0, iomap_size:1896}).
telegram('CLOSEMODULEHANDLE', _{handle:4}, [1,0x92,4], [2,0x92,0,4],
         _{handle:4}).
telegram('READIOMAP', _{id:0xA0001, offset:119, size:2},
         [1,0x94,d(0xA0001),w(119),w(2)],
         [2,0x94,0,d(0xA0001),w(2),1,2], _{id:0xA0001, data:'0102'}).
telegram('WRITEIOMAP', _{id:0xA0001, offset:219, data:'7f00'},
         [1,0x95,d(0xA0001),w(219),w(2),127,0],
         [2,0x95,0,d(0xA0001),w(2)], _{id:0xA0001, size:2}).
telegram('BOOT', _{}, [1,0x97,t('Let\'s dance: SAMBA'),0],
         [2,0x97,0,t('Yes'),0], _{answer:'Yes'}).
telegram('SETBRICKNAME', _{name:'Lizzy'}, [1,0x98,n('Lizzy',15)],
         [2,0x98,0], _{}).
telegram('SETBRICKNAME', _{name:'FifteenLetters!'},
         [1,0x98,n('FifteenLetters!',16)], [2,0x98,0], _{}).
telegram('GETDEVICEINFO', _{}, [1,0x9B],
         [2,0x9B,0,n('Lizzy',15),0,22,83,1,2,3,0,1,2,3,4,d(60000)],
         _{name:'Lizzy', address:'001653010203', zero:0, signal:'01020304',
           free_flash:60000}).
telegram('DELETEUSERFLASH', _{}, [1,0xA0], [2,0xA0,0], _{}).
telegram('POLLCOMMANDLENGTH', _{buffer:1}, [1,0xA1,1], [2,0xA1,0,1,4],
         _{buffer:1, size:4}).
telegram('POLLCOMMAND', _{buffer:1, size:2}, [1,0xA2,1,2],
         [2,0xA2,0,1,2,5,6], _{buffer:1, data:'0506'}).

:- begin_tests(nxt_bytes).

test(every_command) :-
    with_peer(lizzy, [], Peer,
        forall(telegram(Command, Args, Request, Reply, Vs),
               exchanged(Peer, Command, Args, Request, Reply, Vs))).
test(without_confirmation) :-
    with_peer(lizzy, [confirm(false)], Peer,
        ( nxt_run(lizzy, b, 100),
          nxt_tone(lizzy, 440, 100),
          peer_received(Peer, Run0),
          peer_received(Peer, Tone0) )),
    bytes([0x80,4,1,100,1,0,0,32,d(0)], Run),
    bytes([0x80,3,w(440),w(100)], Tone),
    assertion(Run0-Tone0 == Run-Tone).
test(calls) :-
    with_peer(lizzy, [], Peer,
        forall(sent(Goal, Requests),
               ( maplist(bytes, Requests, Hexes),
                 forall(member(Hex, Hexes), acknowledge(Peer, Hex)), call(Goal),
                 forall(member(Hex, Hexes), receives(Peer, Hex)) ))).
test(i2c, [ forall(member(Left-Read, [ [2,14,0,0]-[], [2,14,0xdd,0]-[],
                                       [2,14,0,5]-[[2,16,0,5,z(16)]] ])),
            Degrees == 275 ]) :-
    append([ [[2,5,0], Left], Read,
             [ [2,15,0], [2,14,0x20,0], [2,14,0,5],
               [2,16,0,5,1,2,3,19,1,z(11)] ] ], Replies),
    findall([0,16,2], member(_, Read), Reads),
    append([ [[0,5,2,11,0], [0,14,2]], Reads,
             [[0,15,2,2,2,2,0x44], [0,14,2], [0,14,2], [0,16,2]] ], Requests),
    with_peer(lizzy, [], Peer,
        ( forall(member(Reply, Replies), answer(Peer, Reply)),
          nxt_compass(lizzy, 3, Degrees),
          forall(member(Request, Requests),
                 ( bytes(Request, Hex), receives(Peer, Hex) )) )).
test(sensor_waits_until_valid, Pressed == true) :-
    Values = [0,1,32,w(183),w(183),w(1),w(183)],
    with_peer(lizzy, [], Peer,
        ( answer(Peer, [2,5,0]),
          answer(Peer, [2,7,0,0,0|Values]),
          answer(Peer, [2,7,0,0,1|Values]),
          nxt_touch(lizzy, 1, Pressed),
          receives(Peer, '0005000120'),
          receives(Peer, '000700'),
          receives(Peer, '000700'),
          answer(Peer, [2,7,0,0,1|Values]),
          nxt_touch(lizzy, 1, _),
          receives(Peer, '000700') )).

%   A telegram that sets up a port makes the helper set up all others anew.

test(sensors) :-
    with_peer(lizzy, [], Peer,
        forall(( read_by(Goal, Value, Sensor, Expected),
                 exchanges(Sensor, Exchanges) ),
               ( exchange(Peer, lizzy, [[0,5,3,0,0]-[2,5,0]],
                          nxt_command(lizzy, 'SETINPUTMODE',
                                      _{port:3, type:0, mode:0}, _)),
                 exchange(Peer, lizzy, Exchanges, Goal),
                 assertion(Goal-Value == Goal-Expected) ))).
test(motors_by_their_state) :-
    with_peer(moved, [], Peer,
        forall(moved(Goal, Exchanges),
               exchange(Peer, moved, Exchanges, Goal))).

test(display) :-
    with_peer(lizzy, [], Peer,
        ( peer_command(Peer, 'answer 02950001000a000600'),
          nxt_write(lizzy, 2, 3, 'D'),
          peer_received(Peer, Telegram) )),
    bytes([1,0x95,d(0xA0001),w(431),w(6),
           127,65,65,34,28,0], Expected),
    assertion(Telegram == Expected).

%   exchange(+Peer, +Brick, +Exchanges, :Goal): Goal sends the requests, and no
%   others, of the pairs Request-Reply.

exchange(Peer, Brick, Exchanges0, Goal) :-
    append(Exchanges0, [[0,11]-[2,11,0,w(8000)]], Exchanges),
    forall(member(_-Reply, Exchanges), answer(Peer, Reply)),
    call(Goal),
    nxt_battery(Brick, 8000),
    forall(member(Request-_, Exchanges),
           ( bytes(Request, Hex), receives(Peer, Hex) )).

exchanged(Peer, Command, Args, Request0, Reply0, Values0) :-
    bytes(Request0, Request),
    answer(Peer, Reply0),
    nxt_command(lizzy, Command, Args, Values),
    receives(Peer, Request),
    assertion(same(Command, Values, Values0)).

same(_, Values, Values0) :-
    dict_pairs(Values, _, Pairs),
    dict_pairs(Values0, _, Pairs).

answer(Peer, Bytes) :-
    bytes(Bytes, Hex),
    format(atom(Line), 'answer ~w', [Hex]),
    peer_command(Peer, Line).

acknowledge(Peer, Request) :-
    sub_atom(Request, 2, 2, _, Opcode),
    format(atom(Line), 'answer 02~w00', [Opcode]),
    peer_command(Peer, Line).

receives(Peer, Hex) :-
    peer_received(Peer, Heard),
    assertion(Heard == Hex).

%   sent(Goal, Telegrams)

sent(nxt_run(lizzy, a, 75), [[0,4,0,75,1,0,0,32,d(0)]]).
sent(nxt_run(lizzy, 'C', -75, [regulated(true)]),
     [[0,4,2,-75,7,1,0,32,d(0)]]).
sent(nxt_run(lizzy, c, 60, [regulated(true), brake(false), degrees(720),
                            state(ramp_up)]),
     [[0,4,2,60,5,1,0,16,d(720)]]).
sent(nxt_run(lizzy, [b,c], 70, [sync(-50)]),
     [[0,4,1,70,5,2,-50,32,d(0)], [0,4,2,70,5,2,-50,32,d(0)]]).
sent(nxt_turn(lizzy, b, 60, -360), [[0,4,1,-60,7,1,0,32,d(360)]]).
sent(nxt_stop(lizzy, all), [[0,4,255,0,7,1,0,32,d(0)]]).
sent(nxt_float(lizzy, [a,b]),
     [[0,4,0,z(5),d(0)], [0,4,1,z(5),d(0)]]).
sent(nxt_tacho_reset(lizzy, b), [[0,10,1,0]]).
sent(nxt_tone(lizzy, 440, 500), [[0,3,w(440),w(500)]]).
sent(nxt_set_name(lizzy, 'Lizzy'), [[1,0x98,n('Lizzy',15)]]).
sent(nxt_sound_file(lizzy, '! Click.rso', false),
     [[0,2,0,n('! Click.rso',20)]]).
sent(move_forward_nxt(lizzy, 'A', 'B', 150),
     [[0,4,0,100,7,1,0,32,d(0)], [0,4,1,100,7,1,0,32,d(0)]]).
sent(flt_nxt(lizzy, 'B'), [[0,4,1,z(5),d(0)]]).
sent(floodlight_nxt(lizzy, 3, off), [[0,5,2,6,128]]).
sent(init_touch_nxt(lizzy, 1, 2), [[0,5,0,1,32], [0,5,1,1,32]]).
sent(beep_nxt(lizzy, Type), Requests) :-
    member(Type-Tones, [ 1-[600-200], 2-[600-150,600-150],
                         3-[523-100,659-100,784-100,1047-150], 4-[220-500] ]),
    findall([0,3,w(Hertz),w(MilliSeconds)],
            member(Hertz-MilliSeconds, Tones),
            Requests).
sent(exec_nxt(lizzy, demo), [[0,0,n('demo.rxe',20)]]).

%   read_by(Goal, Value, Sensor, Expected): Value of Goal is Expected with the
%   Sensor at port 2, analog(Type, Mode, Scaled), or i2c(Written, Read).

read_by(nxt_touch(lizzy, 2, V), V, analog(1, 32, 0), false).
read_by(nxt_touch(lizzy, 2, V), V, analog(1, 32, 1), true).
read_by(read_touch_nxt(lizzy, 2, V), V, analog(1, 32, 0), 0).
read_by(read_touch_nxt(lizzy, 2, V), V, analog(1, 32, 1), 1).
read_by(nxt_light(lizzy, 2, V), V, analog(5, 128, 41), 41).
read_by(nxt_light(lizzy, 2, on, V), V, analog(5, 128, 42), 42).
read_by(nxt_light(lizzy, 2, off, V), V, analog(6, 128, 43), 43).
read_by(read_light_nxt(lizzy, 2, V), V, analog(5, 128, 44), 44).
read_by(nxt_sound(lizzy, 2, V), V, analog(7, 128, 45), 45).
read_by(nxt_sound(lizzy, 2, db, V), V, analog(7, 128, 46), 46).
read_by(nxt_sound(lizzy, 2, dba, V), V, analog(8, 128, 47), 47).
read_by(read_sound_nxt(lizzy, 2, V), V, analog(7, 128, 48), 48).
read_by(nxt_colour(lizzy, 2, V), V, analog(13, 0, Number), Colour) :-
    nth1(Number, [black, blue, green, yellow, red, white, 7], Colour).
read_by(nxt_colour_light(lizzy, 2, Lamp, V), V, analog(Type, 0, 49), 49) :-
    member(Lamp-Type, [red-14, green-15, blue-16, off-17]).
read_by(nxt_gyro(lizzy, 2, V), V, analog(9, 0, 50), 600).  % raw
read_by(set_gyroffset_nxt(lizzy, 2), none, analog(9, 0, 51), none).
read_by(read_gyro_nxt(lizzy, 2, V), V, analog(9, 0, 52), 0).
read_by(nxt_ultrasonic(lizzy, 2, V), V, i2c([2,0x42], [254]), 254).
read_by(nxt_ultrasonic(lizzy, 2, V), V, i2c([2,0x42], [255]), inf).
read_by(read_ultrasonic_nxt(lizzy, 2, V), V, i2c([2,0x42], [254]), 254).
read_by(read_ultrasonic_nxt(lizzy, 2, V), V, i2c([2,0x42], [255]), 255).
read_by(nxt_compass(lizzy, 2, V), V, i2c([2,0x44], [3,1]), 259).
read_by(read_compass_nxt(lizzy, 2, V), V, i2c([2,0x44], [4,1]), 260).
read_by(nxt_compass_calibrate(lizzy, 2, on), none,
        i2c([2,0x41,0x43], []), none).
read_by(nxt_compass_calibrate(lizzy, 2, off), none, i2c([2,0x41,0], []), none).
read_by(start_compasscalibration_nxt(lizzy, 2), none,
        i2c([2,0x41,0x43], []), none).
read_by(stop_compasscalibration_nxt(lizzy, 2), none, i2c([2,0x41,0], []), none).
read_by(nxt_accelerometer(lizzy, 2, X, Y, Z), [X,Y,Z],
        i2c([2,0x42], [127,128,255,3,0,2]), [511,-512,-2]).
read_by(read_accel_nxt(lizzy, 2, X, Y, Z), [X,Y,Z],
        i2c([2,0x42], [0,1,2,1,2,3]), [1,6,11]).
read_by(nxt_infrared(lizzy, 2, V), V, i2c([16,0x49], [9]), 9).
read_by(read_irseeker_nxt(lizzy, 2, V), V, i2c([16,0x49], [8]), 8).
read_by(nxt_colour_number(lizzy, 2, V), V, i2c([2,0x42], [17]), 17).
read_by(read_color_nxt(lizzy, 2, V), V, i2c([2,0x42], [16]), 16).

exchanges(analog(Type, Mode, Scaled),
          [ [0,5,1,Type,Mode]-[2,5,0],
            [0,7,1]-[2,7,0,1,1,0,Type,Mode,w(600),w(8),w(Scaled),w(9)] ]).
exchanges(i2c(Written, Read), Exchanges) :-
    length(Written, Tx),
    length(Read, Rx),
    Left is 16-Rx,
    append(Read, [z(Left)], Data),
    findall([0,16,1]-[2,16,0,Rx|Data], Rx > 0, Last),
    append([ [0,5,1,11,0]-[2,5,0], [0,14,1]-[2,14,0,0],
             [0,15,1,Tx,Rx|Written]-[2,15,0], [0,14,1]-[2,14,0,Rx] ],
           Last, Exchanges).

%   moved(Goal, Exchanges): with a report of the state of motor A.

moved(set_motorspeed_nxt(moved, 'A', 30), [Asked|Set]) :-
    member(Power-Run-Powers,
           [ 50-32-[30], -50-32-[-30], 1-16-[30], 0-32-[], 50-0-[] ]),
    asked(Power, 7, Run, Asked),
    maplist(set_to, Powers, Set).
moved(reverse_nxt(moved, 'A'), [Asked,Set]) :-
    asked(-20, 7, 32, Asked),
    set_to(20, Set).
moved(assertion(getmode_nxt(moved, 'A', Mode)), [Asked]) :-
    member(Power-Bits-Run-Mode, [ 50-7-32-1, -50-7-32-2, 0-7-32-3, 0-6-32-4,
                                  50-7-0-4, 1-7-16-1, -1-1-64-2 ]),
    asked(Power, Bits, Run, Asked).
moved(assertion(ismoving_nxt(moved, 'A', 1)), [Asked]) :-
    asked(1, 7, 32, Asked).
moved(assertion(ismoving_nxt(moved, 'A', 0)), [Asked,Asked]) :-
    member(Power-Run, [0-32, 50-0]),
    asked(Power, 7, Run, Asked).
moved(nxt_turn_to(moved, a, -80, To), [Asked,Set]) :-
    member(To-Power, [103-80, 97- -80]),
    asked(0, 7, 32, Asked),
    Set = [0,4,0,Power,7,1,0,32,d(3)]-[2,4,0].
moved(set_acceleration_nxt(moved, 'A', 200), [Asked]) :-
    asked(0, 7, 0, Asked).
moved(move_forward_nxt(moved, 'A', 20), [Asked|Set]) :-
    asked(-5, 7, 32, Asked),
    maplist(set_to, [5, 15, 20], Set).
moved(move_backward_nxt(moved, 'A', 20), [Asked|Set]) :-
    asked(0, 7, 32, Asked),
    maplist(set_to, [-10, -20], Set).

asked(Power, Mode, Run,
      [0,6,0]-[2,6,0,0,Power,Mode,1,0,Run,d(0),d(100),d(0),d(100)]).

set_to(Power, [0,4,0,Power,7,1,0,32,d(0)]-[2,4,0]).

:- end_tests(nxt_bytes).

                /*******************************
                *            BOUNDS            *
                *******************************/

:- begin_tests(nxt_bounds).

%   A brick is looked for when the arguments have been checked.

test(arguments, [forall(bounded(Goal, Value, Low, High))]) :-
    Below is Low-1,
    Above is High+1,
    forall(member(Value, [Low,High]),
           ( error_of(Goal, Formal),
             assertion(Formal == existence_error(nxt_brick, b)) )),
    forall(member(Value, [Below,Above]),
           ( error_of(Goal, Formal),
             assertion(memberchk(Formal, [ type_error(_, _),
                                           domain_error(_, _) ])) )).

error_of(Goal, Formal) :-
    catch(( Goal, Formal = none ), error(Formal, _), true).

%   bounded(Goal, Value, Low, High)

bounded(nxt_run(b, a, X), X, -100, 100).
bounded(nxt_run(b, a, 1, [sync(X)]), X, -100, 100).
bounded(nxt_turn(b, a, X, 9), X, -100, 100).
bounded(nxt_turn_to(b, a, X, 9), X, -100, 100).
bounded(nxt_turn_to(b, a, X, 9, 1), X, 1, 100).
bounded(nxt_turn_to(b, a, 1, 9, X), X, 0, 36000).
bounded(nxt_await(b, a, X), X, 0, 36000).
bounded(nxt_touch(b, X, _), X, 1, 4).
bounded(nxt_input(b, X, _), X, 1, 4).
bounded(nxt_compass(b, X, _), X, 1, 4).
bounded(init_touch_nxt(b, 1, X), X, 1, 4).
bounded(nxt_sensor(b, 1, X, 0, _), X, 0, 18).
bounded(nxt_sensor(b, 1, 0, X, _), X, 0, 255).
bounded(nxt_i2c(b, 1, [2,8], X, _), X, 0, 15).
bounded(nxt_tone(b, X, 1), X, 200, 14000).
bounded(nxt_tone(b, 200, X), X, 0, 65535).
bounded(nxt_write(b, X, 0, a), X, 0, 15).
bounded(nxt_write(b, 0, X, a), X, 0, 7).
bounded(nxt_message_write(b, X, a), X, 0, 19).
bounded(nxt_message_read(b, X, true, _), X, 0, 19).
bounded(beep_nxt(b, X), X, 1, 4).
bounded(( long(X, Name), Goal ), X, 1, Most) :-
    member(Goal-Most, [ nxt_set_name(b, Name)-15, nxt_files(b, Name, _)-19,
                        nxt_sound_file(b, Name, true)-19,
                        nxt_file_read(b, Name, _)-19,
                        nxt_file_write(b, Name, [])-19,
                        nxt_file_delete(b, Name)-19,
                        nxt_program_start(b, Name)-19 ]).
bounded(( atom_codes(Name, [X]), nxt_set_name(b, Name) ), X, 1, 127).

long(Length, Name) :-
    findall(0'x, between(1, Length, _), Codes),
    atom_codes(Name, Codes).

:- end_tests(nxt_bounds).

                /*******************************
                *      THE LINES OF A HELPER   *
                *******************************/

:- begin_tests(nxt_lines).

test(invalid_requests,
     Kinds == [bad_request, bad_request, bad_request, bad_request,
               bad_request, bad_request, no_such_port]) :-
    length(Codes, 70000),
    maplist(=(0'x), Codes),
    format(string(Long), '"~s"', [Codes]),
    helper_answers([ "hello", Long, "[1]", "{\"id\": \"x\"}",
                     "{\"id\": 1, \"do\": \"dance\"}",
                     "{\"id\": 2, \"do\": \"telegram\", \"timeout\": -1}",
                     "{\"id\": 3, \"do\": \"open\"}"
                   ], Answers, Status),
    assertion(Status == exit(0)),
    findall(Kind,
            ( member(Answer, Answers),
              get_dict(error, Answer, Text),
              atom_string(Kind, Text) ),
            Kinds).
test(commands_are_checked, Ids == [1, 2, 3, 4]) :-
    helper_answers([ "{\"id\":1,\"do\":\"telegram\",\"command\":\"X\"}",
                     "{\"id\":2,\"do\":\"telegram\",\"command\":\"PLAYTONE\",\c
                       \"args\":{\"frequency\":70000}}",
                     "{\"id\":3,\"do\":\"telegram\",\"command\":\"PLAYTONE\",\c
                       \"args\":{\"colour\":1}}",
                     "{\"id\":4,\"do\":\"i2c\",\"port\":3,\"data\":\"0g\",\c
                       \"rx\":1}"
                   ], Answers, _),
    findall(Id,
            ( member(Answer, Answers),
              get_dict(error, Answer, "bad_request"),
              get_dict(id, Answer, Id)
            ),
            Ids).

%   Each line gets one answer, without a device at the port.

helper_answers(Lines, Answers, Status) :-
    project_file('bridges/nxt/bridge.py', File),
    process_create('/usr/bin/python3', [File, '/dev/no_such_nxt'],
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid) ]),
    maplist(ask_helper(In, Out), Lines, Answers),
    format(In, '{"id": 99, "do": "quit"}~n', []),
    close(In),
    read_line_to_string(Out, _),
    close(Out),
    process_wait(Pid, Status).

ask_helper(In, Out, Line, Answer) :-
    format(In, '~s~n', [Line]),
    flush_output(In),
    read_line_to_string(Out, Text),
    json_dict(Text, Answer).

:- end_tests(nxt_lines).
