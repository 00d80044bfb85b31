:- module(sync_measures,
          [ measures/2                  % +Result, -Measures
          ]).
:- use_module(metrics,
              [burst/4, idle_time/2, out_of_order/2, overlaps/2, tau_max/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2]).

/** <module> The numbers of one run

*Threading*: pure.
*/

%!  measures(+Result, -Measures) is det.
%
%   What is compared between runs, from the Result of sync_run/3, as a list
%   of
%
%     - idle(Seconds), overlaps(Count), tau(Max), total(Seconds),
%       real_time(Seconds): see sync_metrics.  Idle and overlaps are added
%       over the phases of healing
%     - executions(Count), out_of_order(Count)
%     - ended(Count), agents(Count): agents that ended by themselves, of
%       how many
%     - bursts(Counts): for each task, on how many hosts it began within a
%       second of its first
%     - gaps(Seconds): the idle times, one by one
%     - starts(Times), last_starts(Times), ends(Times): of each task
%     - and those of healing/4

measures(Result, Measures) :-
    memberchk(rows(Rows), Result),
    memberchk(executions(Executions), Result),
    memberchk(phases(Phases), Result),
    memberchk(steps(Steps), Result),
    memberchk(end(Total), Result),
    memberchk(wall(Wall), Result),
    memberchk(outcomes(Outcomes), Result),
    memberchk(tasks(Tasks), Result),
    memberchk(healing(Healing), Result),
    idle_time(Rows, Idle),
    maplist(overlaps, Phases, Lists),
    append(Lists, Overlapping),
    length(Overlapping, Overlaps),
    tau_max(Steps, Tau),
    length(Executions, Count),
    out_of_order(Executions, Wrong),
    length(Wrong, WrongCount),
    length(Outcomes, Agents),
    aggregate_all(count, member(done, Outcomes), Ended),
    maplist(first_second(Executions), Tasks, Bursts),
    findall(Gap, ( member(task(_, _, _, _, _, Gap), Rows), number(Gap) ),
            Gaps),
    findall(T, member(task(_, T, _, _, _, _), Rows), Starts),
    findall(T, member(task(_, _, T, _, _, _), Rows), LastStarts),
    findall(T, member(task(_, _, _, T, _, _), Rows), Ends),
    append([ idle(Idle), overlaps(Overlaps), tau(Tau), total(Total),
             real_time(Wall), executions(Count), out_of_order(WrongCount),
             ended(Ended), agents(Agents), bursts(Bursts), gaps(Gaps),
             starts(Starts), last_starts(LastStarts), ends(Ends)
           ],
           Healing, Measures).

first_second(Executions, Task, Count) :-
    burst(Task, 1, Executions, Count).
