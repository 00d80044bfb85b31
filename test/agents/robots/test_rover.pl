:- module(test_rover, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

/** <module> The rover that carries: costs and steering against numbers

*Threading*: one test at a time.
*/

rover(Tuples) :-
    fake_agent('payloads/robots/rover.pl', [], Tuples).

%   pose(+X, +Y, -Pose): the rover faces along the x axis.

pose(X, Y, _{ position: _{x: X, y: Y, z: 0},
              orientation: _{x: 0, y: 0, z: 0, w: 1} }).

%   costs(X, Y, Details, Cost): of a rover at X, Y.

costs(1, 2, [at(p(4, 6))], 5).
costs(4, 6, [at(p(1, 2))], 5).
costs(1, 2, [duration(3),at(p(1, 9))], 7).
costs(1, 2, [at(p(1, 2))], 0).
costs(1, 2, [duration(3)], none).

%   steers(Heading, Goal, Fastest, Speed, Turn): of a rover at 0, 0.

steers(0, p(0.1, 0.1), 2, 0, 0).        % 0.14 m: it has arrived
steers(0, p(0.15, 0), 2, 0.3, 0).
steers(0, p(0.3, 0.4), 2, Speed, Turn) :-
    Speed is 2*0.5*0.6,
    Turn is 4*atan2(4, 3).
steers(0, p(9, 0), 2, 2, 0).
steers(0, p(9, 0), 3, 3, 0).
steers(0, p(-9, 0), 2, 0, Turn) :-      % behind it: turns only
    Turn is 4*pi.
steers(Heading, p(0, -9), 2, 2, Turn) :- % a whole turn is none
    Heading is 3*pi/2,
    Turn is 4*atan2(sin(-2*pi), cos(-2*pi)).
steers(Heading, p(-9, -9), 2, Speed, Turn) :- % the shorter way
    Heading is pi,
    Speed is 2*cos(pi/4),
    Turn is 4*pi/4.

:- begin_tests(rover).

test(cost_is_the_distance_to_the_start_of_the_task,
     [ forall(costs(X, Y, Details, Expected)),
       true(alike(Expected, Cost)) ]) :-
    pose(X, Y, Pose),
    rover([rover(r), ros-topic('/r/pose', Pose)]),
    (   fake_agent:cost(need(t, [], Details), [], Cost0)
    ->  Cost = Cost0
    ;   Cost = none
    ).
test(steering, [ forall(steers(Heading, Goal, Fastest, Speed, Turn)),
                 true(alike(Speed-Turn, S-T)) ]) :-
    rover([]),
    fake_agent:steer(p(0, 0), Heading, Goal, Fastest, S, T).
test(pose_has_the_heading, [ forall(member(Heading, [0, 1, -2, 3])),
                             true(alike(p(1, 2)-Heading, Place-Found)) ]) :-
    rover([]),
    Z is sin(Heading/2),
    W is cos(Heading/2),
    fake_agent:place_of(_{ position: _{x: 1, y: 2},
                           orientation: _{z: Z, w: W} }, Place, Found).

:- end_tests(rover).
