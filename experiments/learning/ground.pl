%   Chapter 4: agents learn the path through a maze, and share their units.
%
%   Expects of the study that includes this: the parameters `network`, a
%   number of hosts, or `obstacle` for a maze with an obstacle; and `density`,
%   agents by hosts.  It may have `sharing`, `dynamic` and
%   `trace`.  Gives: network/3, run/2, view/2, and measures of one run.

:- use_module('../../agents/learning/operator', [learning_start/5]).
:- use_module('../../prolog/typhon', [agent_join/3, network_property/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(metrics,
              [ duration/2, executed/2, learners/2, mean/2, shared_times/2 ]).

fixed(obstacle_hosts, 50, printed("section 4.4")).
fixed(size, 50, printed("section 4.4: 50 x 50")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(queue, 5, assumed("agents that a host admits beside its own")).
fixed(light, 100, assumed("brightness at the goal; study light tries ten")).
fixed(settings, [], assumed("of agents/learning/parameters.pl")).
fixed(limit, 50000, assumed("host seconds; runs end long before")).

label(executions, "Executions per agent until all have converged").
label(sharing, "Sharing events per execution").
label(total, "Executions of all agents").
label(duration, "Time until all agents have converged (s)").
label(density, "Agents by hosts, D").

%   Both are averages of ten runs.

printed(executions, [network=10, density=0.1], 195).
printed(executions, [network=10, density=0.2], 110).

                /*******************************
                *              RUNS            *
                *******************************/

hosts(Case, N) :-
    (   integer(Case.network)
    ->  N = Case.network
    ;   N = Case.obstacle_hosts
    ).

agents(Case, Count) :-
    hosts(Case, N),
    Count is max(1, round(N*Case.density)).

network(Case, mesh(N),
        [hop_time(uniform(Min, Max)), hosts([capacity(Capacity)])|More]) :-
    hosts(Case, N),
    Min-Max = Case.hop_time,
    Capacity is Case.queue + 1,         % and the trainer
    findall(dynamic(Model), get_dict(dynamic, Case, Model), More).

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    agents(Case, Count),
    settings(Case, Settings),
    learning_start(Hosts, payloads(learning/maze),
                   [payloads(learning/greedy)],
                   [ agents(Count), seed(Case.seed), settings(Settings) ],
                   Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, Case.limit)).

settings(Case, Settings) :-
    findall(Setting, setting(Case, Setting), More),
    append(More, Case.settings, Settings).

setting(Case, Name-Value) :-
    member(Name, [size, light, sharing, trace]),
    get_dict(Name, Case, Value).
setting(Case, obstacles-[(X,0)-(X,X)]) :-
    Case.network == obstacle,
    X is 4*Case.size // 5.              % (40,0)-(40,40) in the thesis

                /*******************************
                *            MEASURES          *
                *******************************/

view(Log, view{case:Log.case, learners:Learners, events:Log.events}) :-
    learners(Log.events, Learners),
    forall(member(Learner, Learners), arg(3, Learner, converged(_, _, _))).

measure(executions, View, Mean) :-
    executed(View.learners, Count),
    length(View.learners, Agents),
    Mean is Count/Agents.
measure(total, View, Count) :-
    executed(View.learners, Count).
measure(sharing, View, Ratio) :-
    executed(View.learners, Count),
    shared_times(View.learners, Times),
    length(Times, Events),
    Ratio is Events/Count.
measure(duration, View, Time) :-
    duration(View.learners, Time).
measure(hops, View, Mean) :-
    findall(Hops, member(learner(_, _, converged(_, Hops, _)), View.learners),
            All),
    mean(All, Mean).
