:- module(sync_measures,
          [ measures/2                  % +Result, -Measures
          ]).
:- use_module(metrics,
              [burst/4, idle_time/2, out_of_order/2, overlaps/2, tau_max/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3, maplist/3]).
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
    findall(Measure, measure(Result, Measure), Own),
    memberchk(healing(Healing), Result),
    append(Own, Healing, Measures).

measure(Result, idle(Idle)) :-
    memberchk(rows(Rows), Result),
    idle_time(Rows, Idle).
measure(Result, overlaps(Count)) :-
    memberchk(phases(Phases), Result),
    maplist(overlaps, Phases, Lists),
    append(Lists, Overlapping),
    length(Overlapping, Count).
measure(Result, tau(Tau)) :-
    memberchk(steps(Steps), Result),
    tau_max(Steps, Tau).
measure(Result, total(Total)) :-
    memberchk(end(Total), Result).
measure(Result, real_time(Wall)) :-
    memberchk(wall(Wall), Result).
measure(Result, executions(Count)) :-
    memberchk(executions(Executions), Result),
    length(Executions, Count).
measure(Result, out_of_order(Count)) :-
    memberchk(executions(Executions), Result),
    out_of_order(Executions, OutOfOrder),
    length(OutOfOrder, Count).
measure(Result, ended(Count)) :-
    memberchk(outcomes(Outcomes), Result),
    aggregate_all(count, member(done, Outcomes), Count).
measure(Result, agents(Count)) :-
    memberchk(outcomes(Outcomes), Result),
    length(Outcomes, Count).
measure(Result, bursts(Bursts)) :-
    memberchk(executions(Executions), Result),
    memberchk(tasks(Tasks), Result),
    maplist(first_second(Executions), Tasks, Bursts).
measure(Result, gaps(Gaps)) :-
    column(Result, 6, Cells),
    include(number, Cells, Gaps).
measure(Result, starts(Times)) :-
    column(Result, 2, Times).
measure(Result, last_starts(Times)) :-
    column(Result, 3, Times).
measure(Result, ends(Times)) :-
    column(Result, 4, Times).

%   column(+Result, +N, -Cells): argument N of the rows of all tasks.

column(Result, N, Cells) :-
    memberchk(rows(Rows), Result),
    maplist(arg(N), Rows, Cells).

first_second(Executions, Task, Count) :-
    burst(Task, 1, Executions, Count).
