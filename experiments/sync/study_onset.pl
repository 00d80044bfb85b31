%   The least δ with overlaps, for tasks of different lengths.

:- include(ground).

study(onset, "The least δ with overlapped executions").
text("Only the ratio of task time to hop time can matter for overlaps, so the \c
hop time is constant. In the thesis overlaps begin above 0.2 on star-bus and \c
tree, above 0.5 on the grid, and not at all on the ring.").

vary(task_time, [1, 3]).
vary(topology, [star_bus, ring, tree, grid]).
vary(delta, [0.2, 0.3, 0.4, 0.5, 0.8, 1.0]).

label(overlapped, "Runs with an overlapped execution (1: yes)").

measure(overlapped, View, Yes) :-
    maplist(overlaps, View.phases, Lists),
    ( append(Lists, [_|_]) -> Yes = 1 ; Yes = 0 ).

claim("at every task time no overlaps at the best δ of the thesis", [ours],
      holds(none_at_best)).
claim("at every task time star-bus and tree overlap at 0.5", [ours],
      ( at([topology=star_bus, delta=0.5], overlaps > 0),
        at([topology=tree, delta=0.5], overlaps > 0) )).
claim("at every task time ring and grid do not overlap at 0.4", [ours],
      ( at([topology=ring, delta=0.4], overlaps =:= 0),
        at([topology=grid, delta=0.4], overlaps =:= 0) )).

none_at_best(Points) :-
    forall(( member(Case-Ms, Points), best_delta(Case.topology, Case.delta) ),
           Ms.overlaps =:= 0).

plot(onset, "Overlapped executions against the penalty bias, tasks of 3 s",
     lines([x(delta), y([overlaps, idle]), line(topology),
            where([task_time=3]), subtitle("60 hosts, 10 agents")])).
plot('onset-1', "Overlapped executions against the penalty bias, tasks of 1 s",
     lines([x(delta), y([overlaps, idle]), line(topology),
            where([task_time=1]), subtitle("60 hosts, 10 agents")])).
