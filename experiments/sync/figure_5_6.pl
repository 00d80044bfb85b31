%   Figure 5.6: what the penalty bias does.

:- include(ground).

study('5.6', "Idle time and overlaps against the penalty bias δ").

vary(topology, [star_bus, ring, tree, grid]).
vary(delta, [0.2, 0.3, 0.5, 0.8, 1.0]).
fixed(agents, 10, printed("section 5.6.1")).

claim("the ring has no overlaps up to δ = 1.0", [line(3300)],
      at([topology=ring], overlaps =:= 0)).
claim("idle time falls with δ", [],
      falls(idle, along(delta))).

plot('5.6', "Idle time and overlaps against the penalty bias",
     lines([x(delta), y([idle, overlaps]), line(topology),
            subtitle("60 hosts, 10 agents")])).
