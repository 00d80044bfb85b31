:- module(robots_pole_metrics,
          [ pole_states/3,              % +Terms, +Moments, -States
            host_time/3,                % +Moments, +ArenaTime, -HostTime
            max_tilt/2,                 % +States, -Tilt
            over_limit/3,               % +States, +Limit, -Seconds
            carried/2,                  % +States, -Metres
            durations/3,                % +Executions, +Task, -Seconds
            starts_apart/3,             % +Executions, +Task, -Seconds
            mingled/2,                  % +Executions, -Mingled
            bar_rows/4,                 % +Hosts, +Segments, +Executions, -Rows
            start_rows/2                % +Executions, -Rows
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [append/3, last/2, max_list/2, member/2, min_list/2, nth1/3]).

/** <module> What the logs say about a pole that was carried

A state is state(Time, Pole), where Pole is the term that the arena gives:

    pole(X, Y, Height, Pitch, Yaw, Tilt, MaxTilt, Strain, Phase)

in metres and degrees.  X and Y are the centre.

*Threading*: pure.
*/

%!  pole_states(+Terms, +Moments, -States) is det.
%
%   States are those from host time 0 on.  Terms are those of arena_log/2;
%   Moments as of host_time/3.

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
%   What the clocks of the hosts show when that of the arena shows ArenaTime.
%   Moments is a list of pairs ArenaTime-HostTime in order, of which there
%   is at least one.  Between two of them time passes evenly, before and
%   after them equally fast at both.

host_time([Arena-Host], Time, HostTime) :-
    !,
    HostTime is Host + Time - Arena.
host_time([Arena-Host|_], Time, HostTime) :-
    Time =< Arena,
    !,
    HostTime is Host + Time - Arena.
host_time([Arena0-Host0, Arena-Host|_], Time, HostTime) :-
    Time =< Arena,
    !,
    HostTime is Host0 + (Host - Host0)*(Time - Arena0)/(Arena - Arena0).
host_time([_|Moments], Time, HostTime) :-
    host_time(Moments, Time, HostTime).

%!  max_tilt(+States, -Tilt) is det.
%
%   The greatest tilt of the pole, in degrees.  The arena has looked more
%   often than the states that it has written.

max_tilt(States, Tilt) :-
    aggregate_all(max(T), a_tilt(States, T), Tilt0),
    !,
    Tilt = Tilt0.
max_tilt(_, 0).

a_tilt(States, Tilt) :-
    member(state(_, Pole), States),
    tilt(Pole, Tilt).

tilt(pole(_, _, _, _, _, Tilt, _, _, _), Tilt).

%!  over_limit(+States, +Limit, -Seconds) is det.
%
%   For how long the pole was tilted by more than Limit degrees.

over_limit(States, Limit, Seconds) :-
    aggregate_all(sum(Step), step_over(States, Limit, Step), Seconds).

step_over([state(T0, Pole), state(T1, _)|_], Limit, Step) :-
    tilt(Pole, Tilt),
    Tilt > Limit,
    Step is T1 - T0.
step_over([_|States], Limit, Step) :-
    step_over(States, Limit, Step).

%!  carried(+States, -Metres) is det.
%
%   How far the centre of the pole is in the end from where it was first.

carried(States, Metres) :-
    States = [state(_, First)|_],
    last(States, state(_, Last)),
    First = pole(X0, Y0, _, _, _, _, _, _, _),
    Last = pole(X1, Y1, _, _, _, _, _, _, _),
    !,
    Metres is sqrt((X1 - X0)**2 + (Y1 - Y0)**2).
carried(_, 0).

%!  durations(+Executions, +Task, -Seconds:list) is det.
%
%   How long the executions of Task took.  Executions are those of
%   executions/2 in sync_metrics.

durations(Executions, Task, Seconds) :-
    findall(S, ( member(execution(Task, _, Start, End), Executions),
                 S is End - Start ),
            Seconds).

%!  starts_apart(+Executions, +Task, -Seconds) is semidet.
%
%   Time from the first to the last start of Task.

starts_apart(Executions, Task, Seconds) :-
    findall(S, member(execution(Task, _, S, _), Executions), Starts),
    min_list(Starts, First),
    max_list(Starts, Last),
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

%!  bar_rows(+Hosts, +Segments, +Executions, -Rows) is det.
%
%   Rows [I, Task, From, To, Executed]: what host I of Hosts required (0), and
%   then what it executed (1), which is drawn over it.  Segments are those of
%   required/5 in sync_metrics.

bar_rows(Hosts, Segments, Executions, Rows) :-
    findall([I, Task, From, To, 0],
            ( member(segment(Host, Task, From, To), Segments),
              nth1(I, Hosts, Host) ),
            Required),
    findall([I, Task, From, To, 1],
            ( member(execution(Task, Host, From, To), Executions),
              nth1(I, Hosts, Host) ),
            Executed),
    append(Required, Executed, Rows).

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
