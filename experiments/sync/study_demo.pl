%   The demo: claims about a run in virtual time, and the same run on real
%   sockets, which people can watch.
%
%       swipl experiments/study.pl -- demo --runs 1 --real --out out/demo

:- include(ground).
:- include(drawn).

study(demo, "Sixty hosts, ten agents, six tasks in step").

fixed(topology, grid, printed("Figure 5.4 d")).
fixed(delta, 0.3, tuned("below 0.5, with which some runs overlap; at 0.3 \c
all claims held in 199 of 200")).

real([], [clock=10, processes=4]).

claim("every host executes every task exactly once", [],
      ( missing =:= 0, executions =:= hosts*tasks )).
claim("no host executes a task before the earlier ones", [],
      out_of_order =:= 0).
claim("never more than two distinct tasks are required (τ)", [], tau =< 2).
claim("no task begins before all hosts had the previous one", [],
      overlaps =:= 0).
claim("the agents are idle between any two tasks", [], least_gap > 0).
claim("T1 begins with the largest burst", [], burst > later_burst).

progress(Case, completed(main, _), Total) :-
    Total is Case.hosts*Case.tasks.

plot(demo, "Sixty hosts execute six tasks in step", Picture) :-
    one_run("Grid, 10 agents, δ = 0.3, tasks of 3 s, hops of 0.27–0.53 s",
            Picture).

row_title(_, _, "").
