% Agents allocate tasks to free ROS 2 robots, and drive the robots.
%
%     swipl app/demo_ros.pl                       `make demo-ros`

:- module(typhon_demo_ros, []).
:- use_module('../prolog/typhon/kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../prolog/typhon').
:- use_module('../prolog/typhon/bridges/helper', [helper_file/2]).
:- use_module('../prolog/typhon/bridges/json', [json_text/2]).
:- use_module('../prolog/typhon/bridges/ros/connection', [node_python/2]).
:- use_module('../agents/allocation/operator').
:- use_module(library(apply), [maplist/2, maplist/4]).
:- use_module(library(lists), [member/2, nth0/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

/** <module> A demonstration: agents that let ROS 2 robots carry parcels

A node of ROS 2 in a process of its own simulates two robots.  There are three
hosts: one beside each robot, and one at which tasks arrive.  An allocator
(thesis chapter 7) gets each task: an agent that searches for a free
robot, reserves it and has it carry a parcel.  The simulation reports the
final positions of the parcels.

*Threading*: the main thread.
*/

:- initialization(main, main).
:- public main/1.

rover(rover1, p(0, 0)).
rover(rover2, p(4, 0)).

%   parcel(Name, From, To)

parcel(books, p(0, 1.5), p(3, 3)).
parcel(glass, p(4, 1.5), p(1, 3)).
parcel(paint, p(2, 1), p(2, 4)).
parcel(tools, p(1, 0.5), p(3.5, 4)).

seconds(60).                            % for all parcels together
near(0.3).                              % metres

main(_) :-
    domain,
    node_python([], Python),
    setup_call_cleanup(
        world(Python, World),
        demo,
        end_world(World)).

%   A domain of its own does not disturb other uses of ROS on this machine.

domain :-
    (   getenv('ROS_DOMAIN_ID', _)
    ->  true
    ;   current_prolog_flag(pid, Pid),
        Domain is 1 + Pid mod 100,
        setenv('ROS_DOMAIN_ID', Domain)
    ),
    setenv('ROS_LOCALHOST_ONLY', 1).

world(Python, world(Pid, In)) :-
    helper_file('ros/rovers.py', File),
    findall(Name-[X,Y], rover(Name, p(X, Y)), Rovers),
    findall([X,Y], parcel(_, p(X, Y), _), Parcels),
    dict_pairs(Positions, _, Rovers),
    json_text(_{rovers:Positions, parcels:Parcels}, Scene),
    process_create(Python, [File, Scene],
                   [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
    read_line_to_string(Out, "ready"),
    close(Out).

end_world(world(Pid, In)) :-
    close(In),
    process_wait(Pid, _).

demo :-
    host_start(depot),
    forall(rover(Name, _), host_for(Name)),
    findall(Parcel-Agent,
            ( parcel(Parcel, From, To), send_out(Parcel, From, To, Agent) ),
            Agents),
    monotonic_time(Start),
    seconds(Seconds),
    Deadline is Start+Seconds,
    maplist(arrives(Start, Deadline), Agents),
    findall(Parcel, misplaced(Parcel), Misplaced),
    forall(member(Host, [depot, rover1, rover2]), host_stop(Host)),
    verdict(Misplaced).

host_for(Name) :-
    host_start(Name),
    link(depot, Name),
    ros_start(Name, ros2, []),
    atomic_list_concat(['/', Name, '/pose'], Pose),
    remote(Name, ros_subscribe(Pose, 'geometry_msgs/msg/Pose',
                               [as(latest)])),
    remote(Name, ros_subscribe('/parcels', 'geometry_msgs/msg/PoseArray',
                               [as(latest)])),
    remote(Name, leave(rover(Name))),
    robot_start(Name, [carry], [cost(payloads(robots/rover))]),
    format("~w is beside a robot~n", [Name]).

send_out(Parcel, From, To, Agent) :-
    task_allocate(task(Parcel, [1-[carry]], [at(From), goal(carry(From, To))]),
                  depot, [name(Parcel)], Agent),
    format("an agent looks for a robot for the ~w~n", [Parcel]).

arrives(Start, Deadline, Parcel-Agent) :-
    monotonic_time(Now),
    Left is max(0, Deadline-Now),
    agent_join(Agent, Outcome, Left),
    monotonic_time(End),
    Seconds is End-Start,
    format("the agent of the ~w: ~w after ~1f s~n",
           [Parcel, Outcome, Seconds]).

%   Reads the positions of the simulation.

misplaced(Parcel) :-
    remote(rover1, sense(ros-topic('/parcels', Message))),
    findall(Name-To, parcel(Name, _, To), Parcels),
    nth0(Index, Parcels, Parcel-p(X, Y)),
    nth0(Index, Message.poses, Pose),
    Position = Pose.position,
    Distance is sqrt((Position.x-X)**2 + (Position.y-Y)**2),
    format("the ~w is ~2f m from its destination~n", [Parcel, Distance]),
    near(Near),
    Distance > Near.

verdict([]) :-
    !,
    format("all have arrived~n").
verdict(Misplaced) :-
    format("NOT ARRIVED: ~w~n", [Misplaced]),
    halt(1).
