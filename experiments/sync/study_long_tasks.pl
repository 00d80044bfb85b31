%   Tasks so long that all hosts execute one at a time (section 5.6.4).

:- include(ground).

study(long_tasks, "Tasks so long that all hosts execute one at a time").
text("If a task is long, all hosts execute it at the same time, so that no task \c
is required (τ = 0). An agent that visits an executing host is neither rewarded \c
nor penalised, so its potential waits.").

vary(task_time, [3, 60, 55-65, 30-90]).
fixed(topology, grid, printed("section 5.6.4")).
fixed(delta, 0.5, printed("section 5.6.1")).

label(task_time, "time of a task (s)").
label(busy, "Hosts that execute a task at the same time, at most").
label(tau_least, "Distinct tasks required, before the last one (τ), at least").

measure(busy, View, Most) :-
    aggregate_all(max(Count),
                  ( member(execution(_, _, Time, _), View.executions),
                    aggregate_all(count, during(View, Time), Count) ),
                  Most).
measure(tau_least, View, Least) :-
    last(View.rows, task(_, Begun, _, _, _, _)),
    aggregate_all(min(Tau), ( member(Time-Tau, View.steps), Time < Begun ),
                  Least).

during(View, Time) :-
    member(execution(_, _, Start, End), View.executions),
    Start =< Time,
    Time < End.

claim("60 s: all hosts execute a task at the same time", [line(3570)],
      at([task_time=60], busy =:= hosts)).
claim("60 s: no task is required then (τ = 0)", [line(3571)],
      at([task_time=60], tau_least =:= 0)).
claim("60 s: no overlapped executions", [line(3568)],
      at([task_time=60], ( overlaps =:= 0, missing =:= 0 ))).
claim("55 to 65 s, drawn by each host: no overlapped executions", [line(3568)],
      at([task_time=55-65], overlaps =:= 0)).
claim("30 to 90 s, drawn by each host: no overlapped executions",
      [ line(3568), why("agents are penalised at hosts that have finished, while \c
others still execute") ],
      at([task_time=30-90], overlaps =:= 0)).

plot(long_tasks, "Overlaps and idle time for tasks of different durations",
     lines([x(task_time), y([overlaps, idle])])).
