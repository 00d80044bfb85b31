:- module(test_world, []).
:- use_module('../../lib/common', [needs/1, project_file/2, with_tmp_dir/1]).
:- needs(['python3-serial']).
:- use_module('../../lib/nxt_bricks').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [load_xml/3]).
:- use_module(library(xpath), [xpath/3]).

/** <module> A world for simulated bricks

The clock stands still and is set forward by the tests, so that results do not
depend on the machine.
*/

with_scene(Name, Args, World, Goal) :-
    format(atom(Relative), 'bridges/nxt/scenes/~w.json', [Name]),
    project_file(Relative, Scene),
    with_world(Scene, ['--tcp', 0, '--clock', 0|Args], World, Goal).

%   Runs a motor of a robot: regulated, braking at power 0.

run(World, Robot, Port, Power, Limit) :-
    brick_place(World, Robot, Place),
    P is Power /\ 255,
    L0 is Limit /\ 255,
    L1 is Limit >> 8,
    hex_list(Request, [0, 4, Port, P, 7, 1, 0, 0x20, L0, L1, 0, 0]),
    with_line(Place, Line, exchange(Line, Request, '020400')).

drive(World, Robot, Left, Right) :-
    run(World, Robot, 1, Left, 0),
    run(World, Robot, 2, Right, 0).

pass(World, Seconds) :-
    tell(World, 'advance ~w', [Seconds]).

robot(World, Name, Robot) :-
    ask(World, state, state(_, Robots, _, _)),
    Robot = robot(Name, _, _, _, _, _, _),
    memberchk(Robot, Robots).

pole(World, pole(X, Y, Height, Pitch, Yaw, Tilt, Most, Strain, Phase)) :-
    ask(World, state,
        state(_, _, pole(X, Y, Height, Pitch, Yaw, Tilt, Most, Strain,
                         Phase), _)).

carriers([r1, r2, r3, r4]).

clasped(World) :-
    carriers(Robots),
    forall(member(Robot, Robots), drive(World, Robot, 50, 50)),
    pass(World, 6),
    forall(member(Robot, Robots),
           ( drive(World, Robot, 0, 0), run(World, Robot, 0, 30, 85) )),
    pass(World, 2).

lifted(World, Robots) :-
    forall(member(Robot, Robots), run(World, Robot, 0, 50, 300)),
    pass(World, 3).

:- begin_tests(world_pole).

test(all_robots_lift_at_once,
     true((Phase == carried, Height > 0.1, Tilt < 0.5))) :-
    with_scene(pole, [], World,
               ( clasped(World),
                 carriers(Robots),
                 lifted(World, Robots),
                 pole(World, pole(_, _, Height, _, _, Tilt, _, _, Phase)) )).
test(lift_at_one_end_only, true((Pitch < -3, Strain > 0.02))) :-
    with_scene(pole, [], World,
               ( clasped(World),
                 lifted(World, [r1]),
                 pole(World, pole(_, _, _, Pitch, _, _, _, Strain, _)) )).
test(drive_on_one_side_only, true((Yaw > 8, Most >= Yaw-0.01, Over == true))) :-
    with_scene(pole, [], World,
               ( clasped(World),
                 carriers(Robots),
                 lifted(World, Robots),
                 ask(World, events, _),
                 drive(World, r3, 40, 40),
                 drive(World, r4, 40, 40),
                 pass(World, 2),
                 pole(World, pole(_, _, _, _, Yaw, _, Most, _, _)),
                 ask(World, events, events(Events)) )),
    ( member(event(_, over_limit(_)), Events) -> Over = true ; Over = false ).
test(obstacle_blocks_and_is_sensed,
     true((T0 == 0, T1 == 1, abs(Y-1.08) < 0.005))) :-
    with_scene(pole, [], World,
               ( robot(World, r1, robot(_, _, _, _, open, _, T0)),
                 drive(World, r1, 50, 50),
                 pass(World, 6),
                 robot(World, r1, robot(_, _, Y, _, open, _, T1)) )).
test(ultrasonic_sees_the_pole, Reply == '0210000126000000000000000000000000\c
                                         000000') :-
    with_scene(pole, [], World,
               ( brick_place(World, r1, Place),
                 with_line(Place, Line,
                           ( exchange(Line, '0005030b00', '020500'),
                             pass(World, 0.1),
                             exchange(Line, '000f0302010242', '020f00'),
                             pass(World, 0.01),
                             exchange(Line, '001003', Reply) )) )).

:- end_tests(world_pole).

:- begin_tests(world_boxes).

test(box_moves_only_if_enough_robots_push,
     [forall(member(Needs-State,
                    [2-arrived, 3-waiting])),
      Found == State]) :-
    with_scene(boxes, [], World,
               ( tell(World, 'remove box1'),
                 tell(World, 'box b 3.04 2.2 90 ~d 0.3', [Needs]),
                 forall(member(Robot-Lane, [p1-one2, p2-one3]),
                        ( format(atom(Line), 'robot ~w lane ~w 0.2 pusher',
                                 [Robot, Lane]),
                          ask(World, Line, brick(Robot, _, Tcp)),
                          drive_by(Tcp, 50, 50) )),
                 pass(World, 8),
                 ask(World, state, state(_, _, _, Boxes)),
                 memberchk(box(b, _, _, Needs, _, Found), Boxes) )).
test(steers_at_a_fork, [forall(member(Left-Right-X-Y,
                                      [ 40-60-2.2-2.3, 50-50-3.37-1.7 ])),
                        true((abs(X1-X) < 0.03, abs(Y1-Y) < 0.01))]) :-
    with_scene(boxes, [], World,
               ( ask(World, 'robot t lane main6 0.1 pusher', brick(t, _, P)),
                 drive_by(P, Left, Right),
                 pass(World, 6),
                 robot(World, t, robot(_, X1, Y1, _, _, _, _)) )).
test(compass_and_colour, [Heading, Colour] == ['b400', '03']) :-
    with_scene(boxes, [], World,
               ( brick_place(World, r1, Place),
                 with_line(Place, Line,
                           ( exchange(Line, '0005010b00', '020500'),
                             pass(World, 0.1),
                             exchange(Line, '000f0102020244', '020f00'),
                             pass(World, 0.01),
                             exchange(Line, '001001', Reply) )),
                 sub_atom(Reply, 8, 4, _, Heading),
                 ask(World, 'robot t lane main7 0.54 pusher',
                     brick(t, _, Other)),
                 with_line(Other, Eye,
                           ( exchange(Eye, '0005020d00', '020500'),
                             pass(World, 0.5),
                             exchange(Eye, '000702', Seen) )),
                 sub_atom(Seen, 24, 2, _, Colour) )).
test(names_are_unique, Answers == [error, error, error]) :-
    with_scene(boxes, [], World,
               findall(Kind,
                       ( member(Line, [ 'robot r1 1 1 0 plain',
                                        'box box1 1 1 0 2 1',
                                        'remove none' ]),
                         ask(World, Line, Answer),
                         functor(Answer, Kind, _)
                       ),
                       Answers)).

:- end_tests(world_boxes).

drive_by(Place, Left, Right) :-
    with_line(Place, Line,
              forall(member(Port-Power, [1-Left, 2-Right]),
                     ( hex_list(Request, [0, 4, Port, Power, 7, 1, 0, 0x20,
                                          0, 0, 0, 0]),
                       exchange(Line, Request, '020400') ))).

:- begin_tests(world_record).

test(same_seed_same_run, true((A == B, A \== C))) :-
    with_tmp_dir(three_runs(A, B, C)).
test(pictures, true((Circles > 10, Moving > 0, Still == 0))) :-
    with_tmp_dir(pictures(Circles, Moving, Still)).

:- end_tests(world_record).

three_runs(A, B, C, Dir) :-
    run_log(Dir, 1, A),
    run_log(Dir, 1, B),
    run_log(Dir, 2, C).

%   Unregulated motors differ by the seed.

run_log(Dir, Seed, Text) :-
    directory_file_path(Dir, log, Log),
    with_scene(pole, ['--seed', Seed, '--log', Log], World,
               ( brick_place(World, r1, Place),
                 with_line(Place, Line,
                           exchange(Line, '000401320300002000000000',
                                    '020400')),
                 pass(World, 2) )),
    read_file_to_string(Log, Text, []).

pictures(Circles, Moving, Still, Dir) :-
    directory_file_path(Dir, frame, Frame),
    directory_file_path(Dir, picture, Picture),
    with_scene(boxes, ['--picture', Picture], World,
               ( drive(World, r1, 50, 50),
                 pass(World, 2),
                 tell(World, 'frame ~w', [Frame]) )),
    count(Frame, circle, Circles),
    count(Frame, animateTransform, Still),
    count(Picture, animateTransform, Moving).

count(File, Element, Count) :-
    load_xml(File, Document, []),
    findall(x, ( member(Root, Document), xpath(Root, //(Element), _) ), Found),
    length(Found, Count).
