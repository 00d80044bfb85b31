%   Effects of the start hosts of agents, and of random choices.

:- include(ground).

study(choices, "Start hosts of agents, and random choices").
text("No decision of an agent is probabilistic (section 5.4.1), and agents \c
started at the same places in all experiments (5.6); these are not printed. \c
The thesis calls the ring symmetric (5.6.2): so there agents start at equal \c
distances, and choose the next of two hosts never visited. This cannot hold \c
for the grid: agents with the same choices follow each other.").

vary(topology, [star_bus, ring, tree, grid]).
vary(starts, [drawn, even]).
vary(choices, [by_chance, in_order]).
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).

label(serviced, "T1 has begun everywhere (s)").

measure(serviced, View, Time) :-
    memberchk(task(1, _, Time, _, _, _), View.rows).

claim("random choices and starts: no overlaps on any topology", [ours],
      at([starts=drawn, choices=by_chance], overlaps =:= 0)).
claim("ordered choices, even starts: no overlaps on ring, star-bus, tree",
      [ours],
      ( at([topology=ring, starts=even, choices=in_order], overlaps =:= 0),
        at([topology=star_bus, starts=even, choices=in_order],
           overlaps =:= 0),
        at([topology=tree, starts=even, choices=in_order], overlaps =:= 0) )).
claim("ordered choices: no overlaps on the grid",
      [ours, why("agents follow each other")],
      at([topology=grid, choices=in_order], overlaps =:= 0)).
claim("Ring, ordered choices, even starts: 32 s idle, within a tenth",
      [line(3393)],
      at([topology=ring, starts=even, choices=in_order],
         near(idle, 32, 3.2))).
claim("Ring, random choices and starts: 32 s idle, within a tenth",
      [why("some hosts are far from any agent that moves towards them")],
      at([topology=ring, starts=drawn, choices=by_chance],
         near(idle, 32, 3.2))).
claim("Star-bus, in order from even places: T1 has begun everywhere by the 9th \c
second", [line(3360)],
      at([topology=star_bus, starts=even, choices=in_order],
         serviced =< 9)).
claim("Star-bus, random choices: T1 has begun everywhere by the 9th second",
      [why("agents visit some hosts again, and miss others")],
      at([topology=star_bus, choices=by_chance], serviced =< 9)).
