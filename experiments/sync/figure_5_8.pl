%   Figure 5.8: tasks that take different times at different hosts.

:- include(ground).
:- include(drawn).

study('5.8', "Tasks of different durations on different hosts").

fixed(topology, grid, printed("section 5.6.4")).
fixed(delta, 0.5, printed("section 5.6.1")).
fixed(task_time, [0.5-1.4, 1.5-2.3, 2.0-3.0, 3.15-4.1, 4.5-5.2, 6.0-8.0],
      printed("Table 5.2")).

printed(overlaps, [], 0).
printed(tau, [], 2).

claim("two distinct tasks are required at most (τ)", [line(3566)], tau =< 2).
claim("no overlapped executions", [line(3566)], overlaps =:= 0).
claim("every host executes every task once, in order", [line(3566)],
      ( missing =:= 0, executions =:= hosts*tasks, out_of_order =:= 0 )).
claim("all hosts are idle between any two tasks", [line(3566)], least_gap > 0).

plot('5.8', "Tasks of different durations on different hosts", Picture) :-
    one_run("Grid of 60 hosts, 10 agents, δ = 0.5, tasks as in Table 5.2 \c
(T1 0.5–1.4 s ... T6 6–8 s)", Picture).

row_title(_, _, "").
