:- module(test_warehouse, []).

% The application of a warehouse: its world, its robots over rosbridge, its
% agents, its command.

:- use_module('../../agents/allocation/operator', [robot_status/2]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).
:- use_module('../../examples/applications/warehouse/floor').
:- use_module('../../examples/applications/warehouse/scene').
:- use_module('../lib/common').
:- use_module('../lib/fixtures').
:- use_module(library(apply), [foldl/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(sgml), [load_structure/3]).
:- use_module(library(typhon)).

                /*******************************
                *             FLOOR            *
                *******************************/

%   A beam of 2 m with a robot at each end, and a pallet elsewhere.

beam(Floor) :-
    floor_new([r1-p(1, 0), r2-p(3, 0)], Floor0),
    floor_put(beam, [p(-1, 0), p(1, 0)], p(2, 0), Floor0, Floor1),
    floor_put(pallet, [p(0, 0)], p(2, 5), Floor1, Floor).

:- meta_predicate after(:, +, -).

%   after(+Steps, +Floor0, -Floor): of floor_drive/4, floor_fork/4, floor_step/3.

after(_:Steps, Floor0, Floor) :-
    foldl(call, Steps, Floor0, Floor).

driven(Names, Seconds, Steps) :-
    Count is 5*Seconds,
    numlist(1, Count, Numbers),
    findall(Step,
            ( member(_, Numbers),
              ( member(Name, Names), Step = floor_drive(Name, 1-0)
              ; Step = floor_step(0.2) ) ),
            Steps).

driven(Names, Seconds, Floor0, Floor) :-
    driven(Names, Seconds, Steps),
    after(Steps, Floor0, Floor).

near(X, Y) :-
    abs(X-Y) < 1.0e-6.

:- begin_tests(warehouse_floor).

test(robots_respect_their_speed_limit) :-
    beam(Floor0),
    after([floor_drive(r1, 9-0), floor_step(0.5)], Floor0, Floor),
    once(floor_robot(Floor, r1, p(X, Y), _, _)),
    assertion(near(X, 1.5)),
    assertion(near(Y, 0)).

test(robots_stop_without_commands) :-
    beam(Floor0),
    after([ floor_drive(r1, 1-0), floor_step(1), floor_step(1), floor_step(1) ],
          Floor0, Floor),
    once(floor_robot(Floor, r1, p(X, _), _, State)),
    assertion(near(X, 2)),
    assertion(State == idle).

test(beam_is_carried_at_both_ends) :-
    beam(Floor0),
    after([ floor_fork(load, r1), floor_fork(load, r2), driven([r1, r2], 4) ],
          Floor0, Floor),
    floor_load(Floor, beam, _, p(X, _), Falls),
    assertion(near(X, 6)),
    assertion(Falls == 0).

test(beam_falls_when_one_robot_moves_alone) :-
    beam(Floor0),
    after([floor_fork(load, r1), driven([r1], 2)], Floor0, Floor),
    floor_load(Floor, beam, _, Centre, Falls),
    assertion(Centre == p(2, 0)),
    assertion(Falls == 1),
    assertion(\+ floor_fork(unload, r1, Floor, _)).

test(beam_falls_when_robots_are_too_far_apart) :-
    beam(Floor0),
    after([ floor_fork(load, r1), floor_fork(load, r2), driven([r2], 2) ],
          Floor0, Floor),
    floor_load(Floor, beam, _, _, Falls),
    assertion(Falls == 1).

test(fork_does_not_reach_a_distant_load) :-
    beam(Floor0),
    after([driven([r1], 1)], Floor0, Floor),
    assertion(\+ floor_fork(load, r1, Floor, _)).

test(corner_is_held_by_one_fork) :-
    floor_new([r1-p(0, 0), r2-p(0, 0)], Floor0),
    floor_put(pallet, [p(0, 0)], p(0, 0), Floor0, Floor1),
    floor_fork(load, r1, Floor1, Floor),
    assertion(\+ floor_fork(load, r2, Floor, _)),
    assertion(\+ floor_fork(load, r1, Floor, _)).

:- end_tests(warehouse_floor).

                /*******************************
                *        ROBOTS, AGENTS        *
                *******************************/

:- meta_predicate scene(+, +, -, 0).

scene(Options, Log, Network, Goal) :-
    scene_network(Options, Topology, More),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log(Log)|More]),
        ( scene_start(Network, Options),
          once(Goal) ),
        ( scene_stop,
          network_stop(Network) )).

all_delivered(Options, Log) :-
    scene(Options, Log, Network,
          ( network_advance(Network, 180),
            scene_orders(Delivered, 0, 0, 0),
            assertion(Delivered == 2) )).

:- begin_tests(warehouse_agents).

test(robots_are_reached_over_rosbridge) :-
    scene([robots(2)], '/dev/null', Network,
          ( network_advance(Network, 3),
            assertion(ros_property(robot2, connected(true))),
            remote(robot2, sense(ros-topic('/robot2/pose', Pose))),
            assertion(number(Pose.position.x)),
            remote(robot2, ros_call('/robot2/load', 'std_srvs/srv/Trigger', [],
                                    Response)),
            assertion(Response.success == false) )).

test(unknown_service, error(existence_error(ros_service, _))) :-
    scene([robots(1)], '/dev/null', _,
          remote(robot1, ros_call('/robot1/fly', 'std_srvs/srv/Trigger', [], _))).

test(agents_drive_robots) :-
    scene([robots(1), pallets(0), beams(0)], '/dev/null', Network,
          ( network_advance(Network, 2),
            remote(robot1, sense(ros-topic('/robot1/pose', Before))),
            remote(robot1, ros_publish('/robot1/cmd_vel',
                                       'geometry_msgs/msg/Twist',
                                       [linear=[x=1]])),
            network_advance(Network, 3),
            remote(robot1, sense(ros-topic('/robot1/pose', After))),
            Way is After.position.x - Before.position.x,
            assertion(( 0.5 < Way, Way < 1.5 )) )).

test(a_pallet_and_a_beam_are_delivered) :-
    with_tmp_dir(delivered_twice).

%   The log is the same in each run.

delivered_twice(Dir) :-
    directory_file_path(Dir, 'first.pl', First),
    directory_file_path(Dir, 'second.pl', Second),
    Options = [robots(4), pallets(1), beams(1)],
    all_delivered(Options, First),
    all_delivered(Options, Second),
    log_events(First, Events),
    log_events(Second, Events),
    reservation_faults(Events, Faults),
    assertion(Faults == []),
    findall(Task, member(event(_, _, _, completed(beam2, Task)), Events), Tasks),
    assertion(Tasks == [ approach, approach, lift, lift, carry, carry,
                         lower, lower ]).

test(too_few_robots) :-
    scene([robots(1), pallets(0), beams(1), deadline(100)], '/dev/null', Network,
          ( network_advance(Network, 150),
            scene_orders(Delivered, Waiting, Underway, Falls),
            assertion([Delivered, Waiting, Underway, Falls] == [0, 0, 0, 0]) )).

test(beam_moved_too_fast_falls_and_frees_robots) :-
    scene([robots(3), pallets(0), beams(1), fast(1), deadline(60)], '/dev/null',
          Network,
          ( network_advance(Network, 120),
            scene_orders(Delivered, Waiting, Underway, Falls),
            assertion([Delivered, Waiting, Underway, Falls] == [0, 0, 0, 1]),
            forall(member(Robot, [robot1, robot2, robot3]),
                   assertion(robot_status(Robot, free))) )).

%   Both robots of a beam are needed, so another robot has replaced the one
%   that broke down, at the same corner.

test(broken_robot_is_replaced) :-
    with_tmp_dir(replaced).

replaced(Dir) :-
    directory_file_path(Dir, 'log.pl', Log),
    scene([robots(4), pallets(0), beams(1), breaks(20)], Log, Network,
          ( network_advance(Network, 250),
            scene_orders(Delivered, Waiting, Underway, Falls),
            assertion([Delivered, Waiting, Underway] == [1, 0, 0]),
            assertion(Falls =< 1) )),
    log_events(Log, Events),
    reservation_faults(Events, Faults),
    assertion(Faults == []),
    findall(Robot, member(event(_, Robot, _, robot(failed)), Events), Broken),
    assertion(Broken = [_]),
    findall(Robots, member(event(_, _, _, allocated(beam1, Robots)), Events),
            [First, Second]),
    Broken = [Out],
    assertion(memberchk(Out, First)),
    assertion(\+ memberchk(Out, Second)).

test(picture, Root == svg) :-
    scene([], '/dev/null', Network,
          ( network_advance(Network, 60),
            scene_picture(Svg) )),
    load_structure(string(Svg), [element(Name, _, _)], [dialect(xmlns)]),
    Name = _:Root.

:- end_tests(warehouse_agents).
