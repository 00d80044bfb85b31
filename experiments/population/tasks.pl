%   Chapter 6: the times of executions, and the numbers of agents.
%
%   Gives: view/2, measures, labels, and the claims of the thesis on both
%   figures. Views are dicts; `executions` are the first of each task at each
%   host, `again` the others.

:- use_module('../sync/metrics',
              [executions/2, from_start/2, out_of_order/2, overlaps/2,
               premature/2, task_rows/2]).
:- use_module(metrics,
              [again/3, gaps/2, peak/3, populations/3,
               spans/2, until_settled/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [last/2, max_list/2, member/2, min_list/2, nextto/3,
               numlist/3]).

view(Log, view{hosts:Log.case.hosts, tasks:Tasks, executions:Executions,
               again:Again, rows:Rows, steps:Steps, peaks:Peaks,
               failures:Failures, end:End}) :-
    numlist(1, Log.case.tasks, Tasks),
    from_start(Log.events, Events0),
    until_settled(Events0, Tasks, Log.case.hosts, Events),
    last(Events, event(End, _, _, _)),
    executions(Events, All),
    again(All, Executions, Again),
    task_rows(Executions, Rows),
    populations(Events, Tasks, Steps),
    findall(Peak, ( member(Task, Tasks), peak(Task, Steps, Peak) ), Peaks),
    findall(Time-Host, member(event(Time, Host, _, failed(_, 2)), Events),
            Failures).

printed(span_least, [], 30).
printed(span_most, [], 60).
printed(peak_most, [hosts=50], 30).
printed(peak_most, [hosts=100], 60).

label(span_least, "Shortest duration of a task (s)").
label(span_most, "Longest duration of a task (s)").
label(gap_least, "Shortest idle time (s)").
label(gap_most, "Longest idle time (s)").
label(overlapped, "Overlapped executions").
label(premature, "Overlaps before all had begun the previous task").
label(peak_least, "Least peak of a kind of agents").
label(peak_most, "Greatest peak of a kind of agents").
label(peak_total, "Greatest number of agents").
label(end, "End (s)").

measure(missing, View, Count) :-
    length(View.executions, Done),
    length(View.tasks, Tasks),
    Count is View.hosts*Tasks - Done.
measure(out_of_order, View, Count) :-
    out_of_order(View.executions, OutOfOrder),
    length(OutOfOrder, Count).
measure(overlapped, View, Count) :-
    overlaps(View.executions, Overlapping),
    length(Overlapping, Count).
measure(premature, View, Count) :-
    premature(View.executions, Premature),
    length(Premature, Count).
measure(Name, View, Value) :-
    spans(View.rows, Spans),
    extreme(Name, span, Spans, Value).
measure(Name, View, Value) :-
    gaps(View.rows, Gaps),
    extreme(Name, gap, Gaps, Value).
measure(Name, View, Value) :-
    findall(Count, member(_-Count, View.peaks), Counts),
    extreme(Name, peak, Counts, Value).
measure(peak_total, View, Peak) :-
    peak(total, View.steps, _-Peak).
measure(peaks_out_of_order, View, Count) :-
    aggregate_all(count,
                  ( nextto(A-_, B-_, View.peaks), A >= B ), Count).
measure(end, View, View.end).
measure(started, View, Started) :-
    findall(Start-Task,
            ( member(Executions, [View.executions, View.again]),
              member(execution(Task, _, Start, _), Executions) ),
            Started).
measure(steps, View, View.steps).
measure(rows, View, View.rows).

%   extreme(-Name, +Of, +Values, -Value): the least and the greatest value.

extreme(Name, Of, Values, Value) :-
    atom_concat(Of, '_least', Name),
    min_list(Values, Value).
extreme(Name, Of, Values, Value) :-
    atom_concat(Of, '_most', Name),
    max_list(Values, Value).

claim("every host executes all tasks, in their order", [line(4330)],
      ( missing =:= 0, out_of_order =:= 0 )).
claim("with 50 hosts nothing overlaps with an earlier task, \c
with 100 at most one execution", [line(4331)],
      ( at([hosts=50], overlapped =:= 0),
        at([hosts=100], overlapped =< 1) )).
claim("each task takes 30 to 60 s",
      [line(4334), why("now and then the last host is found late, by the \c
first agent of a kind, when its clones have died")],
      ( span_least >= 30, span_most =< 60 )).
claim("the agents are idle between any two tasks", [line(4334)], gap_least > 0).
claim("the populations peak in the order of the tasks", [line(4339)],
      peaks_out_of_order =:= 0).
%   "Around" means within a third.  The total is greater: clones of the previous
%   task are still alive.

claim("each kind rises to around 30 agents with 50 hosts", [line(4344)],
      at([hosts=50], ( peak_least >= 20, peak_most =< 40 ))).
claim("each kind rises to around 60 agents with 100 hosts", [line(4343)],
      at([hosts=100], ( peak_least >= 40, peak_most =< 80 ))).
claim("the rise is greater with 100 hosts, about twice as great",
      [line(4343)],
      at([hosts=100],
         between(peak_most/at([hosts=50], peak_most), 1.5, 2.5))).
claim("idle times are alike with 50 and 100 hosts", [line(4356)],
      at([hosts=100],
         between(gap_most/at([hosts=50], gap_most), 2/3, 3/2))).
