:- module(warehouse_floor,
          [ floor_new/2,                % +Robots, -Floor
            floor_put/5,                % +Id, +Corners, +Centre, +F0, -F
            floor_drive/4,              % +Name, +Command, +F0, -F
            floor_fork/4,               % +What, +Name, +F0, -F
            floor_remove/3,             % +Name, +F0, -F
            floor_step/3,               % +Seconds, +F0, -F
            floor_robot/5,              % +Floor, ?Name, -Point, -Heading, -State
            floor_load/5                % +Floor, ?Id, -Corners, -Centre, -Falls
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists),
              [max_list/2, member/2, memberchk/2, nth1/3, same_length/2,
               select/3, select/4]).

/** <module> The floor of a warehouse: robots with forks, and loads

A floor is floor(Time, Robots, Loads).  A robot(Name, Point, Heading, Command,
Heard) executes Command, Speed-Turn in m/s and rad/s, which it received at
Heard, up to its limits, and stops a second after that.  A load(Id, Corners,
Centre, Forks, Falls) is carried at all its corners, each a p(X,Y) relative to
its centre; a pallet has one.  Forks are pairs Corner-Name.  Units are metres,
seconds, radians.

Assumptions: robots drive 1 m/s and turn 2 rad/s at most; a fork reaches 0.3 m;
a load moves when there is a fork at each corner, and lies between them; it
falls when a robot is more than 0.6 m from its corner, and then no fork holds
it.  Robots pass each other and loads: there are no collisions.

*Threading*: pure.
*/

fastest(1.0, 2.0).              % m/s, rad/s
reach(0.3).
slack(0.6).

%!  floor_new(+Robots:list(pair), -Floor) is det.
%!  floor_put(+Id, +Corners, +Centre, +Floor0, -Floor) is det.
%
%   Robots are pairs Name-Point.  A load is put down at Centre.

floor_new(Robots, floor(0, Standing, [])) :-
    findall(robot(Name, Point, 0.0, 0-0, -2), member(Name-Point, Robots), Standing).

floor_put(Id, Corners, Centre, floor(Time, Robots, Loads),
          floor(Time, Robots, [load(Id, Corners, Centre, [], 0)|Loads])).

%!  floor_robot(+Floor, ?Name, -Point, -Heading, -State) is nondet.
%!  floor_load(+Floor, ?Id, -Corners, -Centre, -Falls) is nondet.
%
%   State is `driven`, or `idle` a second after the last command.

floor_robot(floor(Time, Robots, _), Name, Point, Heading, State) :-
    member(robot(Name, Point, Heading, _, Heard), Robots),
    ( Time-Heard > 1 -> State = idle ; State = driven ).

floor_load(floor(_, _, Loads), Id, Corners, Centre, Falls) :-
    member(load(Id, Corners, Centre, _, Falls), Loads).

%!  floor_drive(+Name, +Command, +Floor0, -Floor) is semidet.
%
%   Fails if there is no such robot.

floor_drive(Name, Command, floor(Time, Robots0, Loads),
            floor(Time, Robots, Loads)) :-
    select(robot(Name, Point, Heading, _, _), Robots0,
           robot(Name, Point, Heading, Command, Time), Robots),
    !.

%!  floor_fork(+What, +Name, +Floor0, -Floor) is semidet.
%
%   `load`: the robot takes the nearest corner in reach, if it has none yet;
%   `unload`: it releases its corner.

floor_fork(load, Name, Floor, floor(Time, Robots, Loads)) :-
    Floor = floor(Time, Robots, Loads0),
    \+ holds(Name, Loads0, _, _),
    floor_robot(Floor, Name, Point, _, _),
    aggregate_all(min(Metres, Id-Number), free(Loads0, Point, Id, Number, Metres),
                  min(_, Id-Number)),
    select(load(Id, Corners, Centre, Forks, Falls), Loads0,
           load(Id, Corners, Centre, [Number-Name|Forks], Falls), Loads),
    !.
floor_fork(unload, Name, floor(Time, Robots, Loads0), floor(Time, Robots, Loads)) :-
    holds(Name, Loads0, Id, Number),
    select(load(Id, Corners, Centre, Forks0, Falls), Loads0,
           load(Id, Corners, Centre, Forks, Falls), Loads),
    select(Number-Name, Forks0, Forks),
    !.

%!  floor_remove(+Name, +Floor0, -Floor) is det.
%
%   The robot has broken down, and is removed.

floor_remove(Name, Floor0, floor(Time, Robots, Loads)) :-
    (   floor_fork(unload, Name, Floor0, Floor)
    ->  true
    ;   Floor = Floor0
    ),
    Floor = floor(Time, Robots0, Loads),
    exclude(named(Name), Robots0, Robots).

named(Name, robot(Name, _, _, _, _)).

holds(Name, Loads, Id, Number) :-
    member(load(Id, _, _, Forks, _), Loads),
    memberchk(Number-Name, Forks),
    !.

free(Loads, Point, Id, Number, Metres) :-
    member(load(Id, Corners, Centre, Forks, _), Loads),
    nth1(Number, Corners, Corner),
    \+ memberchk(Number-_, Forks),
    off(Point, Centre, Corner, Metres),
    reach(Reach),
    Metres =< Reach.

off(p(X, Y), p(X0, Y0), p(DX, DY), Metres) :-
    Metres is sqrt((X-X0-DX)**2 + (Y-Y0-DY)**2).

%!  floor_step(+Seconds, +Floor0, -Floor) is det.

floor_step(Seconds, floor(Time0, Robots0, Loads0), floor(Time, Robots, Loads)) :-
    Time is Time0+Seconds,
    maplist(robot_step(Time, Seconds), Robots0, Robots),
    maplist(load_step(Robots), Loads0, Loads).

robot_step(Time, Seconds, robot(Name, p(X0, Y0), Heading0, Command, Heard),
           Robot) :-
    (   Time-Heard > 1
    ->  Robot = robot(Name, p(X0, Y0), Heading0, 0-0, Heard)
    ;   Command = Speed0-Turn0,
        fastest(Fastest, Quickest),
        limited(Speed0, Fastest, Speed),
        limited(Turn0, Quickest, Turn),
        Heading is Heading0 + Turn*Seconds,
        X is X0 + Speed*cos(Heading)*Seconds,
        Y is Y0 + Speed*sin(Heading)*Seconds,
        Robot = robot(Name, p(X, Y), Heading, Command, Heard)
    ).

limited(Value0, Most, Value) :-
    Value is max(-Most, min(Most, Value0)).

load_step(_, Load, Load) :-
    Load = load(_, _, _, [], _),
    !.
load_step(Robots, load(Id, Corners, Centre0, Forks0, Falls0),
          load(Id, Corners, Centre, Forks, Falls)) :-
    findall(Point-Corner,
            ( member(Number-Name, Forks0),
              nth1(Number, Corners, Corner),
              memberchk(robot(Name, Point, _, _, _), Robots) ),
            Held),
    (   same_length(Forks0, Corners)
    ->  between(Held, Centre)
    ;   Centre = Centre0
    ),
    findall(Metres, ( member(Point-Corner, Held),
                      off(Point, Centre, Corner, Metres) ), Offs),
    max_list(Offs, Most),
    slack(Slack),
    (   Most > Slack
    ->  Forks = [],
        Falls is Falls0+1
    ;   Forks = Forks0,
        Falls = Falls0
    ).

between(Held, p(X, Y)) :-
    aggregate_all(r(sum(RX-DX), sum(RY-DY), count),
                  member(p(RX, RY)-p(DX, DY), Held), r(SumX, SumY, Count)),
    X is SumX/Count,
    Y is SumY/Count.
