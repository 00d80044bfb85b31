%   Chapter 6: one kind of agent for each task executes a sequence on a mesh,
%   and regulates its number.
%
%   Expects of the study that includes this: the parameter `crash`, the number
%   of hosts that lose task 2.  Gives: the parameters, network/3 and run/2.

:- use_module('../../agents/population/operator', [population_start/5]).
:- use_module('../../agents/sync/operator', [task_fail/4]).
:- use_module('../../prolog/typhon',
              [network_advance/2, network_property/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module(mesh, [mesh/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, same_length/2]).

vary(hosts, [50, 100]).
fixed(tasks, 5, printed("section 6.5")).
fixed(psi, 100, printed("section 6.5: Ψ(0)")).
fixed(q_th, 4, printed("section 6.5")).
fixed(task_time, 1, assumed("an agent does not wait for it")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(tick, 1.9, tuned("seconds of a turn in a queue: the scale of time")).
fixed(threshold, 0.5, tuned("below it Ψ is zero: sets how long agents wait")).
fixed(rounding, floor, tuned("of the number of clones; round gives more")).
fixed(replication, rewarded, assumed("clones only after a reward")).
fixed(mesh, rings, tuned("links drawn by chance leave some hosts with few")).
fixed(degree, 20, tuned("with 10 agents find some hosts late more often")).
fixed(crash_share, 0.2, assumed("share of hosts that execute task 4 then")).
fixed(limit, 2000, assumed("host seconds; runs end long before")).

%   The queue and the worker need two places beside the agents of the queue.

network(Case, Topology, [ hop_time(uniform(Min, Max)),
                          hosts([capacity(Capacity)]) ]) :-
    mesh(Case.mesh, Case.hosts, Case.degree, Case.seed, Topology),
    Min-Max = Case.hop_time,
    Capacity is Case.q_th + 2.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(T-sleep(Case.task_time), between(1, Case.tasks, T), Tasks),
    findall(Name-Value,
            ( member(Name, [psi, q_th, tick, threshold, rounding,
                            replication]),
              Value = Case.Name ),
            Settings),
    population_start(main, Hosts, Tasks,
                     [seed(Case.seed), settings(Settings)], _),
    crash(Case, Network, Hosts),
    until(Network, Case.limit, settled(Case, Hosts)).

crash(Case, _, _) :-
    Case.crash =:= 0,
    !.
crash(Case, Network, Hosts) :-
    Enough is Case.crash_share * Case.hosts,
    until(Network, Case.limit, completed_at(4, Hosts, Enough)),
    chance_seed(Case.seed, Chance),
    chance_sample(Case.crash, Hosts, Victims, Chance, _),
    task_fail(main, 2, Victims, Failed),
    same_length(Failed, Victims).

%   until(+Network, +Limit, :Goal): calls Goal once in a host second.

until(_, _, Goal) :-
    call(Goal),
    !.
until(Network, Limit0, Goal) :-
    Limit0 > 0,
    network_advance(Network, 1),
    Limit is Limit0 - 1,
    until(Network, Limit, Goal).

completed_at(Task, Hosts, Enough) :-
    aggregate_all(count, ( member(Host, Hosts), has(Host, Task) ), Count),
    Count >= Enough.

has(Host, Task) :-
    remote(Host, sense(task(main, Task, completed, _))).

%   All tasks are completed, and only the first agents are left.

settled(Case, Hosts) :-
    aggregate_all(sum(Load),
                  ( member(Host, Hosts), remote(Host, host_load(Load)) ),
                  Agents),
    Agents =:= 2*Case.hosts + Case.tasks,
    forall(( member(Host, Hosts), between(1, Case.tasks, Task) ),
           has(Host, Task)).
