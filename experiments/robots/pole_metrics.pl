:- module(robots_pole_metrics,
          [ pole_states/3,              % +Terms, +Moments, -States
            host_time/3,                % +Moments, +ArenaTime, -HostTime
            over_limit/3,               % +Tilts, +Limit, -Seconds
            starts_apart/3,             % +Executions, +Task, -Seconds
            mingled/2,                  % +Executions, -Mingled
            start_rows/2                % +Executions, -Rows
          ]).
:- use_module(library(aggregate), [aggregate/3, aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2]).

/** <module> Measures of a carried pole, from the logs

A state is state(Time, Pole), where Pole is the term that the arena gives:

    pole(X, Y, Height, Pitch, Yaw, Tilt, MaxTilt, Strain, Phase)

in metres and degrees.  X and Y are the centre.  Executions are those of
executions/2 in sync_metrics.

*Threading*: pure.
*/

%!  pole_states(+Terms, +Moments, -States) is det.
%
%   States are those from host time 0 on.  Terms are those of the log of an
%   arena; Moments as of host_time/3.

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
%   The time of the hosts when the arena has ArenaTime. Moments is a list of
%   pairs ArenaTime-HostTime in order, of which there is at least one.
%   Between two of them time passes evenly, before and after them equally fast
%   at both.

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
%   For how long the pole was tilted by more than Limit degrees, of pairs
%   Time-Tilt in order.

over_limit(Tilts, Limit, Seconds) :-
    aggregate_all(sum(To - From),
                  ( append(_, [From-Tilt, To-_|_], Tilts),
                    Tilt > Limit ),
                  Seconds).

%!  starts_apart(+Executions, ?Task, -Seconds) is nondet.
%
%   Time from the first to the last start of Task.

starts_apart(Executions, Task, Seconds) :-
    aggregate(r(min(S), max(S)),
              H^E^member(execution(Task, H, S, E), Executions),
              r(First, Last)),
    Seconds is Last - First.

%!  mingled(+Executions, -Mingled) is det.
%
%   The executions that began before an earlier task had come to its end at
%   all hosts.  To begin before it had begun at all hosts is an overlap: see
%   overlaps/2 in sync_metrics.

mingled(Executions, Mingled) :-
    findall(E,
            ( member(E, Executions),
              E = execution(Task, _, Start, _),
              \+ \+ ( member(execution(Earlier, _, _, End), Executions),
                      Earlier < Task,
                      End > Start )
            ),
            Mingled).

%!  start_rows(+Executions, -Rows) is det.
%
%   Rows [Second, Task, Below]: Task was switched on in this second, in which
%   Below others had been before.

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
