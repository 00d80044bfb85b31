%   Beyond the thesis: a sequence on selected hosts, scattered or far apart.

:- include(subsets).
:- use_module('../../prolog/typhon', [agent_join/3, network_property/2]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).

study(selected, "Tasks in step on selected hosts").
text("A part of the hosts of a grid execute three tasks in step; agents only \c
pass the others.  The selected hosts are random, or at two opposite ends of \c
the grid.").

vary(place, [scattered, apart]).
vary(share, [0.1, 0.25, 0.5, 1]).
vary(hosts, [60, 200, 500]).
skip(Case) :-
    Case.place == apart,
    Case.share =:= 1.
skip(Case) :-
    Case.hosts > 60,
    Case.share =\= 0.25.
derive(agents, Case, Count) :- Count is Case.hosts // 6.
fixed(sequences, 1, assumed("alone")).

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    selected(Case.place, Case, Hosts, Selected),
    tasks(Case, Tasks),
    sequence_start(sequence1, Selected, Tasks,
                   [ agents(Case.agents), seed(Case.seed),
                     settings([delta-(Case.delta)]) ],
                   Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, Case.limit)).

selected(scattered, Case, Hosts, Selected) :-
    subsets([sequence1], Case, Hosts, [_-Selected]).
selected(apart, Case, Hosts, Selected) :-
    chosen(Case, Count),
    Half is Count // 2,
    Rest is Count - Half,
    length(First, Half),
    length(Last, Rest),
    append(First, _, Hosts),
    append(_, Last, Hosts),
    !,
    append(First, Last, Selected).

claim("each selected host executes each task once, in order", [ours],
      ( missing =:= 0, out_of_order =:= 0, executions =:= wanted )).
claim("no task begins before all selected hosts have the previous one", [ours],
      overlaps =:= 0).
claim("fewer selected hosts take longer: agents are penalised only there",
      [ours],
      at([hosts=60], falls(total, along(share)))).
claim("with as many agents per host, 500 hosts take less than twice as long \c
as 60", [ours],
      at([share=0.25], last(total, along(hosts)) < 2*first(total, along(hosts)))).

plot(selected, "Tasks in step on selected hosts",
     lines([ x(share), y([total, idle, overlaps]), line(place),
             where([hosts=60]) ])).
