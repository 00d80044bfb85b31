:- module(sync_metrics,
          [ from_start/2,               % +Events0, -Events
            executions/2,               % +Events, -Executions
            task_rows/2,                % +Executions, -Rows
            idle_time/2,                % +Rows, -Seconds
            overlaps/2,                 % +Executions, -Overlapping
            premature/2,                % +Executions, -Premature
            out_of_order/2,             % +Executions, -OutOfOrder
            required/5,                 % +Hosts, +Tasks, +Marks, +End,
                                        % -Segments
            marks/3,                    % +Executions, +Failures, -Marks
            tau/2,                      % +Segments, -Steps
            tau_max/2,                  % +Steps, -Tau
            burst/4                     % +Task, +Seconds, +Execs, -Count
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, include/3, maplist/3]).
:- use_module(library(assoc),
              [empty_assoc/1, put_assoc/4, del_assoc/4, get_assoc/3,
               assoc_to_values/2]).
:- use_module(library(lists),
              [ append/2, append/3, max_member/2, member/2, memberchk/2,
                min_list/2
              ]).
:- use_module(library(ordsets), [ord_add_element/3, ord_del_element/3]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> Measures of synchronisation, from an event log

The measures of thesis chapter 5, as pure predicates over lists of
event(Time, Host, Agent, What).  A task's execution begins at the event
executing(Sequence, Task) and ends at the event completed(Sequence, Task) of
the same host.

An execution is a term execution(Task, Host, Start, End).

*Threading*: pure.
*/

%!  from_start(+Events0, -Events) is det.
%
%   Events are in order of time; time 0 is the start of the first agent.

from_start(Events0, Events) :-
    sort(1, @=<, Events0, Sorted),
    (   memberchk(event(Start, _, _, begun), Sorted)
    ->  maplist(shift(Start), Sorted, Events)
    ;   Events = Sorted
    ).

shift(Start, event(T0, Host, Agent, What), event(T, Host, Agent, What)) :-
    T is T0 - Start.

%!  executions(+Events, -Executions) is det.
%
%   The completed executions, in order of their starts.  Events are in order of
%   time.

executions(Events, Executions) :-
    empty_assoc(Running0),
    foldl(follow, Events, Running0-[], _-Executions0),
    sort(3, @=<, Executions0, Executions).

follow(event(Time, Host, _, executing(_, Task)), Running0-Es, Running-Es) :-
    !,
    put_assoc(Host-Task, Running0, Time, Running).
follow(event(End, Host, _, completed(_, Task)), Running0-Es0, Running-Es) :-
    del_assoc(Host-Task, Running0, Start, Running),
    !,
    Es = [execution(Task, Host, Start, End)|Es0].
follow(_, State, State).

%!  task_rows(+Executions, -Rows) is det.
%
%   A row task(Task, FirstStart, LastStart, LastEnd, Count, Idle) for each
%   task, in order.  Idle is the time between the last end of the task and
%   the first start of the next one, 0 if they overlap, `none` for the
%   last task.

task_rows(Executions, Rows) :-
    findall(Task, member(execution(Task, _, _, _), Executions), Tasks0),
    sort(Tasks0, Tasks),
    maplist(task_row(Executions), Tasks, Rows),
    gaps(Rows).

task_row(Executions, Task, task(Task, First, Last, End, Count, _)) :-
    aggregate_all(r(min(S), max(S), max(E), count),
                  member(execution(Task, _, S, E), Executions),
                  r(First, Last, End, Count)).

gaps([]).
gaps([task(_, _, _, _, _, none)]) :-
    !.
gaps([task(_, _, _, End, _, Idle)|Rows]) :-
    Rows = [task(_, Next, _, _, _, _)|_],
    Idle is max(0, Next - End),
    gaps(Rows).

%!  idle_time(+Rows, -Seconds) is det.
%
%   The sum of the idle times between consecutive tasks.

idle_time(Rows, Seconds) :-
    aggregate_all(sum(Idle),
                  ( member(task(_, _, _, _, _, Idle), Rows),
                    Idle \== none
                  ),
                  Seconds).

%!  overlaps(+Executions, -Overlapping) is det.
%
%   The executions that began before an earlier task had ended at all hosts that
%   execute it: a task should not commence until all hosts have finished the one
%   before (thesis section 6.1; section 5.6.1 calls tasks that are executed at
%   the same time overlapped).

overlaps(Executions, Overlapping) :-
    task_rows(Executions, Rows),
    include(before_last(end, Rows), Executions, Overlapping).

%!  premature(+Executions, -Premature) is det.
%
%   The overlaps that began before an earlier task had even begun at all hosts
%   that execute it: agents left it while a host still required it.

premature(Executions, Premature) :-
    task_rows(Executions, Rows),
    include(before_last(start, Rows), Executions, Premature).

%   before_last(+Which, +Rows, +Execution): Execution began before the last
%   start or end of an earlier task.

before_last(Which, Rows, execution(Task, _, Start, _)) :-
    member(Row, Rows),
    last(Which, Row, Earlier, Time),
    Earlier < Task,
    Start < Time,
    !.

last(start, task(Task, _, Start, _, _, _), Task, Start).
last(end,   task(Task, _, _, End, _, _),   Task, End).

%!  out_of_order(+Executions, -OutOfOrder) is det.
%
%   The executions that began on a host before an earlier task was completed
%   there, or although it was never completed.

out_of_order(Executions, OutOfOrder) :-
    findall(Task-Host-End, member(execution(Task, Host, _, End), Executions),
            Ends0),
    sort(Ends0, Ends),
    findall(Task, member(Task-_-_, Ends), Tasks0),
    sort(Tasks0, Tasks),
    findall(E,
            ( member(E, Executions),
              E = execution(Task, Host, Start, _),
              \+ \+ ( member(Earlier, Tasks),
                      Earlier < Task,
                      \+ ( member(Earlier-Host-End, Ends),
                           End =< Start ) )
            ),
            OutOfOrder).

%!  marks(+Executions, +Failures, -Marks) is det.
%
%   Marks is a list, in order of time, of mark(Time, Host, Task, Change):
%   Task is `executing` from then on, `completed` or `lost` there.
%   Failures are terms failure(Time, Host, Task).

marks(Executions, Failures, Marks) :-
    findall(mark(Time, Host, Task, Change),
            ( member(execution(Task, Host, Start, End), Executions),
              member(Time-Change, [Start-executing, End-completed]) ),
            Marks1),
    findall(mark(Time, Host, Task, lost),
            member(failure(Time, Host, Task), Failures), Marks2),
    append(Marks1, Marks2, Marks0),
    sort(Marks0, Marks).

%!  required(+Hosts, +Tasks, +Marks, +End, -Segments) is det.
%
%   Segments is a list of segment(Host, Task, From, To): Host required Task
%   in this time.  A host requires the first task that is not completed there;
%   none while it executes one.  From time 0 to End.

required(Hosts, Tasks, Marks, End, Segments) :-
    maplist(host_segments(Tasks, Marks, End), Hosts, Lists),
    append(Lists, Segments).

host_segments(Tasks, Marks, End, Host, Segments) :-
    findall(M, ( member(M, Marks), arg(2, M, Host) ), HostMarks),
    requires(state(none, []), Tasks, Task),
    segments(HostMarks, Tasks, state(none, []), Task, Host, 0, End, Segments).

%   segments(+Marks, +Tasks, +State, +Required, +Host, +From, +End,
%   -Segments): State is state(Executing, Completed).

segments([], _, _, Task, Host, From, End, Segments) :-
    segment(Task, Host, From, End, Segments, []).
segments([mark(Time, _, Task, Change)|Marks], Tasks, State0, Required, Host,
         From, End, Segments) :-
    changed(Change, Task, State0, State),
    requires(State, Tasks, Next),
    (   Next == Required
    ->  segments(Marks, Tasks, State, Required, Host, From, End, Segments)
    ;   segment(Required, Host, From, Time, Segments, Rest),
        segments(Marks, Tasks, State, Next, Host, Time, End, Rest)
    ).

changed(executing, Task, state(_, Done), state(Task, Done)).
changed(completed, Task, state(_, Done0), state(none, Done)) :-
    ord_add_element(Done0, Task, Done).
changed(lost, Task, state(Executing, Done0), state(Executing, Done)) :-
    ord_del_element(Done0, Task, Done).

requires(state(none, Done), Tasks, Task) :-
    member(Task, Tasks),
    \+ memberchk(Task, Done),
    !.
requires(_, _, none).

segment(none, _, _, _, Segments, Segments) :-
    !.
segment(_, _, From, To, Segments, Segments) :-
    From >= To,
    !.
segment(Task, Host, From, To, [segment(Host, Task, From, To)|Rest], Rest).

%!  tau(+Segments, -Steps) is det.
%
%   Steps is a list of Time-Tau: from Time on, Tau distinct tasks are
%   required in the network.

tau(Segments, Steps) :-
    findall(change(From, Task, 1),
            member(segment(_, Task, From, _), Segments), Begins),
    findall(change(To, Task, -1),
            member(segment(_, Task, _, To), Segments), Ends),
    append([Begins, Ends], Changes0),
    sort(1, @=<, Changes0, Changes),
    empty_assoc(Counts),
    tau_steps(Changes, Counts, none, Steps).

tau_steps([], _, _, []).
tau_steps([change(Time, Task, D)|Changes], Counts0, Tau0, Steps) :-
    recount(Task, D, Counts0, Counts1),
    same_time(Changes, Time, Counts1, Rest, Counts),
    assoc_to_values(Counts, Values),
    aggregate_all(count, ( member(N, Values), N > 0 ), Tau),
    (   Tau == Tau0
    ->  Steps = Steps1
    ;   Steps = [Time-Tau|Steps1]
    ),
    tau_steps(Rest, Counts, Tau, Steps1).

same_time([change(T, Task, D)|Changes], Time, Counts0, Rest, Counts) :-
    T =:= Time,
    !,
    recount(Task, D, Counts0, Counts1),
    same_time(Changes, Time, Counts1, Rest, Counts).
same_time(Changes, _, Counts, Changes, Counts).

recount(Task, D, Counts0, Counts) :-
    (   get_assoc(Task, Counts0, N0)
    ->  true
    ;   N0 = 0
    ),
    N is N0 + D,
    put_assoc(Task, Counts0, N, Counts).

%!  tau_max(+Steps, -Tau) is det.
%
%   The largest number of distinct tasks required at any time.

tau_max(Steps, Tau) :-
    pairs_values(Steps, Taus),
    max_member(Tau, [0|Taus]).

%!  burst(+Task, +Seconds, +Executions, -Count) is det.
%
%   Count executions of Task began within Seconds of its first.

burst(Task, Seconds, Executions, Count) :-
    findall(S, member(execution(Task, _, S, _), Executions), Starts),
    (   min_list(Starts, First)
    ->  aggregate_all(count,
                      ( member(S, Starts), S < First + Seconds ), Count)
    ;   Count = 0
    ).
