:- module(robots_boxes_jobs,
          [ job_task/2,                 % +Job, -Task
            job_box/2                   % +Job, -Line
          ]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../../prolog/typhon/language/programs', [payload_load/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).

/** <module> Boxes to push, and the robots they need

A job is job(Name, Location, Needs): Name names box and task, Location is
1 or 2, Needs is the number of robots that can move the box.

*Threading*: no state; any thread.
*/

distance(0.5).                  % metres that each box is pushed

%   row(?Needs, ?X, ?Places): the position of a box along the main line, and
%   the places, of five, from which robots push it.

row(2, 3.04, [2, 3]).
row(3, 3.12, [2, 3, 4]).
row(4, 3.04, [1, 2, 3, 4]).
row(5, 3.12, [1, 2, 3, 4, 5]).

%!  job_box(+Job, -Line) is det.
%
%   Line is the command to the arena, as Format-Arguments, that creates the box.

job_box(job(Name, Location, Needs),
        'box ~w ~w ~w ~w ~d ~w'-[Name, X, Y, Heading, Needs, Metres]) :-
    row(Needs, X, _),
    side(Location, Y, Heading),
    distance(Metres).

side(1, 2.2, 90).
side(2, 1.2, -90).

%!  job_task(+Job, -Task) is det.
%
%   Task is for task_allocate/4.  Each place behind the box is a team of one
%   robot, so the request tells a robot where to push.
%
%   @error those of a payload file, see agent_check/1

job_task(job(Name, Location, Needs), task(Name, Teams, [goal(Goal)])) :-
    row(Needs, _, Places),
    findall(1-[push, place(Place)], member(Place, Places), Teams),
    maplist(payload_load,
            [ payloads(robots/lane), payloads(robots/push),
              payloads(robots/dock) ], Program),
    distance(Metres),
    goal(Program, Location, Metres, Goal).

%   A robot that has lost its way fails, and stays where it is.

goal([Lane, Push, Dock], Location, Metres, Goal) :-
    Goal = ( hold(_, _, need(_, Requirements, _), _, _),
             memberchk(place(Place), Requirements),
             attach(Lane),
             attach(Push),
             attach(Dock),
             catch(( push_box(Location, Place, Metres, Away),
                     dock_robot(Location, Place, Away) ),
                   error(What, Context),
                   ( log(gave_up(What)),
                     parent(Robot),
                     send(Robot, fail),
                     sense(brick(Brick)),
                     nxt_float(Brick, [b,c]),
                     throw(error(What, Context)) )) ).
