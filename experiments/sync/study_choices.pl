%   Effects of the start hosts of agents, and of random choices.

:- include(ground).

study(choices, "Where agents start, and whether chance leads them").
text("No decision of an agent is probabilistic (section 5.4.1), and agents \c
started at the same places in all experiments (5.6); which these were is not \c
printed. The ring is called symmetric (5.6.2): so there agents start at even \c
distances, and of two hosts never visited take the one that comes next. The \c
grid cannot have been so: agents that choose alike follow each other.").

vary(topology, [star_bus, ring, tree, grid]).
vary(starts, [drawn, even]).
vary(choices, [by_chance, in_order]).
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).

label(serviced, "T1 has begun everywhere (s)").

measure(serviced, View, Time) :-
    memberchk(task(1, _, Time, _, _, _), View.rows).

claim("by chance, from drawn places: no overlaps on any topology", [ours],
      at([starts=drawn, choices=by_chance], overlaps =:= 0)).
claim("in order, from even places: no overlaps on ring, star-bus and tree",
      [ours],
      ( at([topology=ring, starts=even, choices=in_order], overlaps =:= 0),
        at([topology=star_bus, starts=even, choices=in_order],
           overlaps =:= 0),
        at([topology=tree, starts=even, choices=in_order], overlaps =:= 0) )).
claim("in order: no overlaps on the grid",
      [ours, why("agents follow each other")],
      at([topology=grid, choices=in_order], overlaps =:= 0)).
claim("Ring, in order from even places: 32 s idle, within a tenth",
      [line(3393)],
      at([topology=ring, starts=even, choices=in_order],
         near(idle, 32, 3.2))).
claim("Ring, by chance from drawn places: the same",
      [why("some hosts are far ahead of any agent that comes their way")],
      at([topology=ring, starts=drawn, choices=by_chance],
         near(idle, 32, 3.2))).
claim("Star-bus, in order from even places: T1 has begun everywhere by the 9th \c
second", [line(3360)],
      at([topology=star_bus, starts=even, choices=in_order],
         serviced =< 9)).
claim("Star-bus, by chance: the same",
      [why("agents come to the same hosts again, and pass others")],
      at([topology=star_bus, choices=by_chance], serviced =< 9)).
