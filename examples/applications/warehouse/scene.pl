:- module(warehouse_scene,
          [ scene_network/3,            % +Options, -Topology, -NetworkOptions
            scene_step/1,               % -Seconds
            scene_start/2,              % +Network, +Options
            scene_orders/4,             % -Delivered, -Waiting, -Underway, -Falls
            scene_picture/1,            % -Svg
            scene_stop/0
          ]).
:- use_module('../../../prolog/typhon',
              [network_at/3, remote/2, ros_start/3, ros_stop/1]).
:- use_module('../../../agents/allocation/operator',
              [robot_fail/1, robot_start/3, robot_status/2]).
:- use_module('../drawn', [drawn/3]).
:- use_module(dispatch).
:- use_module(floor).
:- use_module(rosbridge).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3, partition/4]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth0/3]).
:- use_module(library(option), [option/2, option/3]).

/** <module> A warehouse: robots, orders, and the connection between them

An office and robots, each a host; all are linked.  The robots are simulated
behind a rosbridge server: poses, commands and calls use library(typhon/ros),
as with real robots.  They move five times in a second.  In virtual time each
move waits until all frames have arrived.

Assumptions: a hop takes 0.2 to 0.4 s; an order arrives every ten seconds.

*Threading*: the floor is one fact, replaced in one step under its own mutex,
because commands to robots arrive in other threads.  Another mutex prevents that
the scene ends during a step.
*/

:- dynamic
    floor/1,                    % see floor.pl
    jobs/2,                     % future orders, Time-Order; jobs
    server/1,                   % Port
    setting/1,                  % Options
    broken/1.                   % Name of a robot

robot(Options, Name) :-
    option(robots(Count), Options, 6),
    between(1, Count, Number),
    atom_concat(robot, Number, Name).

scene_step(1).

%!  scene_network(+Options, -Topology, -NetworkOptions) is det.

scene_network(Options, edges(Links), [hop_time(uniform(0.2, 0.4))]) :-
    findall(Name, robot(Options, Name), Robots),
    findall(A-B, ( append(_, [A|Bs], [office|Robots]), member(B, Bs) ), Links).

%!  scene_start(+Network, +Options) is det.
%
%   Options: seed(S); robots(N), default 6, as of the network; pallets(N),
%   loads for one robot, default 6; beams(N), loads for two or three robots,
%   default 3; breaks(T): after T seconds the first robot that carries a beam
%   breaks down and is removed; and the options of dispatch_begin/4.

scene_start(Network, Options) :-
    scene_stop,
    findall(Name-Point, ( robot(Options, Name), begins_at(Options, Name, Point) ),
            Robots),
    floor_new(Robots, Floor),
    assertz(setting(Options)),
    assertz(floor(Floor)),
    findall(Time-Order, order(Options, Time, Order), Orders),
    assertz(jobs(Orders, [])),
    rosbridge_start(heard, served, Port),
    assertz(server(Port)),
    format(atom(URL), 'ws://localhost:~d/', [Port]),
    forall(member(Name-_, Robots), robot_begins(URL, Name)),
    network_at(Network, 0.2, warehouse_scene:pass(Network, 1, [])).

begins_at(Options, Name, p(X, Y)) :-
    option(seed(Seed), Options, 1),
    drawn(Seed, x(Name), U),
    drawn(Seed, y(Name), V),
    rows(Options, Rows),
    X is 1 + 14*U,
    Y is 1 + (Rows-1)*V.

rows(Options, Rows) :-
    option(pallets(Pallets), Options, 6),
    option(beams(Beams), Options, 3),
    Rows is Pallets+Beams.

robot_begins(URL, Name) :-
    ros_start(Name, URL, [deadline(30)]),
    atomic_list_concat(['/', Name, '/pose'], Topic),
    remote(Name, ( ros_subscribe(Topic, 'geometry_msgs/msg/Pose', [as(latest)]),
                   leave(rover(Name)) )),
    robot_start(Name, [carry], [cost(payloads(robots/rover))]).

%   Loads are in the right half, each in a row of its own; their goals are on
%   the left.

order(Options, Time, order(Id, Corners, p(X, Number), p(4, Row))) :-
    option(seed(Seed), Options, 1),
    option(beams(Beams), Options, 3),
    rows(Options, Rows),
    between(1, Rows, Number),
    Time is 10*Number,
    (   Number*Beams // Rows > (Number-1)*Beams // Rows
    ->  Kind = beam,
        Which is Number mod 2,
        nth0(Which, [[p(-1, 0), p(1, 0)], [p(-1.5, 0), p(0, 0), p(1.5, 0)]],
             Corners)
    ;   Kind = pallet,
        Corners = [p(0, 0)]
    ),
    atom_concat(Kind, Number, Id),
    drawn(Seed, load(Number), U),
    X is 9 + 5*U,
    Row is Rows+1-Number.

scene_stop :-
    with_mutex(warehouse_scene, forget).

forget :-
    (   retract(server(Port))
    ->  forall(( setting(Options), robot(Options, Name) ),
               catch(ros_stop(Name), error(_, _), true)),
        rosbridge_stop(Port)
    ;   true
    ),
    maplist(retractall, [floor(_), jobs(_, _), setting(_), broken(_)]).

                /*******************************
                *             TIME             *
                *******************************/

:- public pass/3.               % called by network_at/3

pass(Network, Tick, Names) :-
    with_mutex(warehouse_scene, passed(Network, Tick, Names)).

%   Names0 are the robots whose poses were published in the previous step.

passed(_, _, _) :-
    \+ floor(_),
    !.
passed(Network, Tick, Names0) :-
    settle(Names0),
    change(floor_step(0.2)),
    publish_poses(Tick, Names),
    ( Tick mod 5 =:= 0 -> Time is Tick//5, dispatch(Time) ; true ),
    Next is Tick+1,
    Then is Next/5,
    network_at(Network, Then, warehouse_scene:pass(Network, Next, Names)).

%   Afterwards no frame is under way between these hosts and the server in
%   virtual time: a call arrives after all earlier frames.  One host after the
%   other, so that agents become ready in the same order in every run.

settle(Names) :-
    remote(office, here(Office)),
    sub_atom(Office, _, _, 0, '@virtual:0'),
    !,
    forall(member(Name, Names),
           remote(Name, ros_call('/settled', 'std_srvs/srv/Trigger', [], _))).
settle(_).

:- meta_predicate change(2).

change(Goal) :-
    with_mutex(warehouse_floor,
               ( floor(Floor0),
                 call(Goal, Floor0, Floor),
                 transaction(( retractall(floor(_)), assertz(floor(Floor)) )) )).

dispatch(Time) :-
    jobs(Orders0, Jobs0),
    setting(Options),
    partition(due(Time), Orders0, Due, Orders),
    maplist(begin(Options), Due, New),
    maplist(dispatch_proceed, Jobs0, Jobs1),
    append(Jobs1, New, Jobs),
    break_one(Time, Options, Jobs),
    transaction(( retractall(jobs(_, _)), assertz(jobs(Orders, Jobs)) )).

break_one(Time, Options, Jobs) :-
    option(breaks(From), Options),
    Time >= From,
    \+ broken(_),
    member(Job, Jobs),
    dispatch_carries(Job, Robot),
    !,
    assertz(broken(Robot)),
    change(floor_remove(Robot)),
    robot_fail(Robot).
break_one(_, _, _).

due(Time, Then-_) :-
    Then =< Time.

begin(Options, _-Order, Job) :-
    Order = order(Id, Corners, From, _),
    change(floor_put(Id, Corners, From)),
    dispatch_begin(Order, office, [place(warehouse_scene:lies_at)|Options], Job).

:- public lies_at/2.            % called by dispatch_proceed/2

lies_at(Id, Place) :-
    floor(Floor),
    floor_load(Floor, Id, _, Place, _),
    !.

                /*******************************
                *       ROBOTS OVER ROS        *
                *******************************/

%   Robots that do not move publish their pose once in a second.

publish_poses(Tick, Names) :-
    floor(Floor),
    findall(Name, ( floor_robot(Floor, Name, _, _, State),
                    once(( State == driven ; Tick mod 5 =:= 0 )) ), Names),
    forall(member(Name, Names),
           ( publish_pose(Floor, Name),
             settle([Name]) )).

publish_pose(Floor, Name) :-
    floor_robot(Floor, Name, p(X, Y), Heading, _),
    atomic_list_concat(['/', Name, '/pose'], Topic),
    Z is sin(Heading/2),
    W is cos(Heading/2),
    rosbridge_publish(Topic, _{ position:_{x:X, y:Y, z:0.0},
                                orientation:_{x:0.0, y:0.0, z:Z, w:W} }).

heard(Topic, Message) :-
    atomic_list_concat(['', Name, cmd_vel], /, Topic),
    field(Message, linear, x, Speed),
    field(Message, angular, z, Turn),
    change(floor_drive(Name, Speed-Turn)).

%   Omitted fields are 0 in ROS.

field(Message, Vector, Axis, Value) :-
    (   get_dict(Vector, Message, Dict),
        get_dict(Axis, Dict, Value0)
    ->  Value = Value0
    ;   Value = 0
    ).

served('/settled', _, _{success:true, message:""}) :-
    !.
served(Service, _, _{success:Success, message:Message}) :-
    atomic_list_concat(['', Name, What], /, Service),
    memberchk(What, [load, unload]),
    (   change(floor_fork(What, Name))
    ->  Success = true,
        Message = ""
    ;   Success = false,
        Message = "there is no load"
    ).

                /*******************************
                *            PICTURE           *
                *******************************/

%!  scene_orders(-Delivered, -Waiting, -Underway, -Falls) is semidet.
%
%   Numbers of orders that are delivered, that wait or are in the future, and
%   that are in progress; and the number of falls of loads.

scene_orders(Delivered, Waiting, Underway, Falls) :-
    floor(Floor),
    jobs(Orders, Jobs),
    length(Orders, Waiting),
    aggregate_all(count, ( member(job(Order, _, _, _), Jobs),
                           delivered(Floor, Order) ), Delivered),
    aggregate_all(count, ( member(Job, Jobs), \+ dispatch_over(Job) ), Underway),
    aggregate_all(sum(F), floor_load(Floor, _, _, _, F), Falls).

delivered(Floor, order(Id, _, _, p(X, Y))) :-
    floor_load(Floor, Id, _, p(X1, Y1), _),
    sqrt((X-X1)**2 + (Y-Y1)**2) < 0.5.

%!  scene_picture(-Svg) is det.
%
%   Svg shows robots, with a line ahead, red if an order holds them; loads, and
%   the goal of each on the left.

scene_picture(Svg) :-
    floor(Floor),
    jobs(_, Jobs),
    with_output_to(string(Svg), draw(Floor, Jobs)).

%   A metre is 40 points.

draw(Floor, Jobs) :-
    Floor = floor(Time, _, _),
    setting(Options),
    rows(Options, Rows),
    Height is 40*(Rows+1),
    format('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 680 ~d" \c
            font-family="sans-serif" font-size="13"><rect width="680" \c
            height="~d" fill="#f4f1ea"/><text x="10" y="20">~0f s</text>',
           [Height, Height, Time]),
    forall(member(job(order(_, Corners, _, To), _, _, _), Jobs),
           draw_bar(Corners, To, 'fill="none" stroke="#aaa" stroke-dasharray="4"')),
    forall(floor_load(Floor, Id, Corners, Centre, _),
           draw_load(Id, Corners, Centre)),
    forall(floor_robot(Floor, Name, Point, Heading, _),
           draw_robot(Name, Point, Heading)),
    format('</svg>').

draw_load(Id, Corners, Centre) :-
    draw_bar(Corners, Centre, 'fill="#d8b070" stroke="#864"'),
    Centre = p(X0, Y0),
    X is 40*X0 - 24,
    Y is 40*Y0 - 13,
    format('<text x="~1f" y="~1f" fill="#642">~w</text>', [X, Y, Id]).

draw_bar(Corners, p(X0, Y0), Style) :-
    aggregate_all(max(DX), member(p(DX, _), Corners), Half),
    X is 40*(X0-Half) - 10,
    Y is 40*Y0 - 10,
    Width is 80*Half + 20,
    format('<rect x="~1f" y="~1f" width="~1f" height="20" ~w/>',
           [X, Y, Width, Style]).

draw_robot(Name, p(X0, Y0), Heading) :-
    X is 40*X0,
    Y is 40*Y0,
    X1 is X + 18*cos(Heading),
    Y1 is Y + 18*sin(Heading),
    TextX is X - 4,
    TextY is Y + 5,
    ( robot_status(Name, free) -> Colour = '#69b' ; Colour = '#c54' ),
    atom_concat(robot, Number, Name),
    format('<circle cx="~1f" cy="~1f" r="11" fill="~w" stroke="#333"/><path \c
            d="M~1f,~1f L~1f,~1f" stroke="#333" stroke-width="3"/><text x="~1f" \c
            y="~1f" fill="#fff">~w</text>',
           [X, Y, Colour, X, Y, X1, Y1, TextX, TextY, Number]).
