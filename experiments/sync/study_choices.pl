:- include(ground).
study(choices, "Where agents start, and whether chance leads them").
vary(topology, [star_bus, ring, tree, grid]).
vary(starts, [drawn, even]).
vary(choices, [by_chance, in_order]).
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).
