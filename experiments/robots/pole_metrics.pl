:- module(robots_pole_metrics,
          [ pole_states/3,              % +Terms, +Moments, -States
            host_time/3,                % +Moments, +ArenaTime, -HostTime
            over_limit/3,               % +Tilts, +Limit, -Seconds
            starts_apart/3,             % +Executions, +Task, -Seconds
            start_rows/2                % +Executions, -Rows
          ]).
:- use_module(library(aggregate), [aggregate/3, aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2]).

/** <module> Measures of a carried pole, from the logs

A state is state(Time, Pole), where Pole is the term of the arena:

    pole(X, Y, Height, Pitch, Yaw, Tilt, MaxTilt, Strain, Phase)

in metres and degrees.  X and Y are the centre.  Executions are the result of
executions/2 in sync_metrics.

*Threading*: pure.
*/

%!  pole_states(+Terms, +Moments, -States) is det.
%
%   States are the states from host time 0 on.  Terms are the terms of the log
%   of an arena, Moments as in host_time/3.

pole_states(Terms, Moments, States) :-
    findall(state(Time, Pole),
            ( member(state(ArenaTime, _, Pole, _), Terms),
              Pole \== none,
              host_time(Moments, ArenaTime, Time),
              Time >= 0
            ),
            States).

%!  host_time(+Moments, +ArenaTime, -HostTime) is det.
%
%   HostTime is the time of the hosts at ArenaTime. Moments is a non-empty list
%   of pairs ArenaTime-HostTime in order.  Time is interpolated linearly between
%   two moments; before the first and after the last both clocks have the same
%   rate.

host_time([Arena-Host|Moments], Time, HostTime) :-
    ( Moments == [] ; Time =< Arena ),
    !,
    HostTime is Host + Time - Arena.
host_time([Arena0-Host0, Arena-Host|_], Time, HostTime) :-
    Time =< Arena,
    !,
    HostTime is Host0 + (Host - Host0)*(Time - Arena0)/(Arena - Arena0).
host_time([_|Moments], Time, HostTime) :-
    host_time(Moments, Time, HostTime).

%!  over_limit(+Tilts, +Limit, -Seconds) is det.
%
%   Seconds is the time during which the pole was tilted by more than Limit
%   degrees; Tilts are pairs Time-Tilt in order.

over_limit(Tilts, Limit, Seconds) :-
    aggregate_all(sum(To - From),
                  ( append(_, [From-Tilt, To-_|_], Tilts),
                    Tilt > Limit ),
                  Seconds).

%!  starts_apart(+Executions, ?Task, -Seconds) is nondet.
%
%   Seconds is the time from the first to the last start of Task.

starts_apart(Executions, Task, Seconds) :-
    aggregate(r(min(S), max(S)),
              H^E^member(execution(Task, H, S, E), Executions),
              r(First, Last)),
    Seconds is Last - First.

%!  start_rows(+Executions, -Rows) is det.
%
%   Rows [Second, Task, Below]: an execution of Task began in this second, after
%   Below others.

start_rows(Executions, Rows) :-
    findall(Second-Task,
            ( member(execution(Task, _, Start, _), Executions),
              Second is floor(Start) ),
            Starts0),
    msort(Starts0, Starts),
    findall([Second, Task, Below],
            ( append(Before, [Second-Task|_], Starts),
              aggregate_all(count, member(Second-_, Before), Below) ),
            Rows).
