:- payload(rover,
           [ provides([ cost/3, carry/2, drive_to/2, take_up/0,
                        put_down/0 ]) ]).

/*  The task `carry` of a two-wheeled ROS robot, and its cost.

    Needs a host with ROS and the tuple rover(Name): the robot accepts
    geometry_msgs/Twist on /Name/cmd_vel and publishes its geometry_msgs/Pose
    on /Name/pose; the tuple space has the latest pose; /Name/load and
    /Name/unload are std_srvs/Trigger.
*/

near(0.15).                     % metres

%   The distance to the start of the task, at(p(X, Y)).

cost(need(_, _, Details), _, Cost) :-
    sense(rover(Name)),
    atomic_list_concat(['/', Name, '/pose'], Topic),
    sense(ros-topic(Topic, Pose)),
    member(at(p(X, Y)), Details),
    !,
    place_of(Pose, p(X0, Y0), _),
    Cost is sqrt((X-X0)**2 + (Y-Y0)**2).

%   carry(+From, +To): points, p(X, Y).

carry(From, To) :-
    drive_to(From, 2),
    take_up,
    drive_to(To, 2),
    put_down,
    sense(rover(Name)),
    !,
    log(put_down(Name, To)).

%   drive_to(+To, +Fastest): Fastest in metres a second.  Leaves no pose in the
%   mailbox.

drive_to(To, Fastest) :-
    sense(rover(Name)),
    !,
    atomic_list_concat(['/', Name, '/pose'], Topic),
    ros_subscribe(Topic, 'geometry_msgs/msg/Pose'),
    drive(Name, To, Fastest),
    ros_unsubscribe(Topic),
    forget(Topic).

forget(Topic) :-
    (   receive(ros-topic(Topic, _), 0)
    ->  forget(Topic)
    ;   true
    ).

drive(Name, Goal, Fastest) :-
    receive(ros-topic(_, Pose)),
    place_of(Pose, Here, Heading),
    steer(Here, Heading, Goal, Fastest, Speed, Turn),
    atomic_list_concat(['/', Name, '/cmd_vel'], Topic),
    ros_publish(Topic, 'geometry_msgs/msg/Twist',
                [linear=[x=Speed], angular=[z=Turn]]),
    (   Speed-Turn == 0-0
    ->  true
    ;   drive(Name, Goal, Fastest)
    ).

take_up :-
    sense(rover(Name)),
    !,
    do(Name, load).

put_down :-
    sense(rover(Name)),
    !,
    do(Name, unload).

do(Name, What) :-
    atomic_list_concat(['/', Name, /, What], Service),
    ros_call(Service, 'std_srvs/srv/Trigger', [], Response),
    get_dict(success, Response, Success),
    (   Success == true
    ->  true
    ;   get_dict(message, Response, Why),
        throw(error(rover_error(What, Why), _))
    ).

place_of(Pose, p(X, Y), Heading) :-
    get_dict(position, Pose, Position),
    get_dict(x, Position, X),
    get_dict(y, Position, Y),
    get_dict(orientation, Pose, Orientation),
    get_dict(z, Orientation, Z),
    get_dict(w, Orientation, W),
    Heading is 2*atan2(Z, W).

%   Turn towards the goal, and drive faster the better the heading is.

steer(p(X0, Y0), Heading, p(X, Y), Fastest, Speed, Turn) :-
    Distance is sqrt((X-X0)**2 + (Y-Y0)**2),
    near(Near),
    (   Distance < Near
    ->  Speed = 0,
        Turn = 0
    ;   Off0 is atan2(Y-Y0, X-X0)-Heading,
        Off is atan2(sin(Off0), cos(Off0)),
        Turn is 4*Off,
        Speed is min(Fastest, 2*Distance)*max(0, cos(Off))
    ).
