%   Beyond the thesis (section 8.2): potentials with which no executions overlap.

:- include(ground).
:- use_module(guarantee, [potential_required/5]).
:- use_module('../../prolog/typhon/network/topology', [topology_edges/4]).

study(guarantee, "Potentials proved to suffice, and shares of them").
text("A potential P(0) with which no executions overlap, proved for any agents \c
on a connected network, and smaller ones.").

vary(topology, [ring(5), star(5), grid(2,3), mesh(8)]).
vary(share, [1, 0.3, 0.1, 0.03]).
fixed(theta, 15, printed("Figure 5.2")).
fixed(delta, 0.2, printed("section 5.6.1")).
fixed(agents, 3, assumed("the bound does not depend on it")).
fixed(tasks, 3, assumed("enough for two steps from a task to the next")).
fixed(task_time, 0-3, assumed("drawn for each execution")).
derive(hosts, Case, Hosts) :-
    topology_edges(Case.topology, 0, Hosts, _).
derive(maximum, Case, Maximum) :-
    topology_edges(Case.topology, 0, _, Links),
    From-_ = Case.hop_time,
    _-Longest = Case.task_time,
    Hops is ceiling(Longest/From),
    potential_required(Links, Hops, Case.theta, Case.delta, Required),
    Maximum is Case.share*Required.

label(share, "share of the potential that is proved to suffice").

claim("the potential that is proved to suffice: no overlapped executions",
      [ours], at([share=1], overlaps =:= 0)).
claim("executions overlap with a thirtieth of it, on each topology", [ours],
      at([share=0.03], overlaps > 0)).
claim("0.3 of it: all tasks take less than half the time", [ours],
      at([share=0.3], total < 0.5*at([share=1], total))).

plot(guarantee, "Shares of the potential that is proved to suffice",
     lines([x(share), y([overlaps, total]), line(topology)])).
