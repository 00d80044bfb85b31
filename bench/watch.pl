:- use_module(common).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host), [event/4]).
:- use_module(library(typhon/options/watch), [metrics/2, overview/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).

/*  The cost of a watch.

    swipl bench/watch.pl -- Pairs

Rounds with and without a watch alternate, so that other load affects both;
the result is the median of the ratios of successive rounds. */

:- initialization(main, main).

:- dynamic heard/1.

main([Text]) :-
    atom_number(Text, Pairs),
    host_start(here),
    host_start(there),
    host_property(there, address(There)),
    without_listeners(There),
    slower(Pairs, 1, 20000, There, 'within a process'),
    with_peer([env], between_processes(Pairs)),
    host_stop(there),
    host_stop(here),
    many_hosts.

between_processes(Pairs, Peer) :-
    slower(Pairs, 1, 5000, Peer, 'between processes'),
    slower(Pairs, 10, 10000, Peer, 'between processes').

                /*******************************
                *        WITHOUT A WATCH       *
                *******************************/

%   A hop within a process is the cheapest; it checks three times for
%   listeners.

without_listeners(There) :-
    travelled(1, 10000, There, _),      % warm up
    travelled(1, 40000, There, rates(_, PerCpu)),
    median_cpu(forall(between(1, 1 000 000, _), true), Empty),
    median_cpu(forall(between(1, 1 000 000, _),
                      event(hops, here, none, left(there))), Full),
    Event is (Full-Empty)*1.0e3,
    figure('an event without listeners', Event, ns),
    Hop is 1.0e9/PerCpu,
    Part is 3*Event/Hop*100,
    format(atom(Note), '3 events of a hop of ~0f ns of processor', [Hop]),
    figure('of a hop within a process, without watches', Part, '%', Note).

:- meta_predicate median_cpu(0, -).

median_cpu(Goal, Seconds) :-
    findall(Cpu, ( between(1, 9, _), cpu(Goal, Cpu) ), All),
    median(All, Seconds).

:- meta_predicate cpu(0, -).

cpu(Goal, Seconds) :-
    statistics(cputime, Cpu0),
    call(Goal),
    statistics(cputime, Cpu1),
    Seconds is Cpu1-Cpu0.

                /*******************************
                *         WITH A WATCH         *
                *******************************/

slower(Pairs, Agents, Hops, Peer, Where) :-
    travelled(Agents, Hops, Peer, _),
    findall(Ratio-Rate,
            ( between(1, Pairs, _), pair(Agents, Hops, Peer, Ratio, Rate) ),
            Results),
    maplist(arg(1), Results, Ratios),
    maplist(arg(2), Results, Rates),
    median(Ratios, Ratio),
    median(Rates, Rate),
    Slower is (1-Ratio)*100,
    flag(told, Told, Told),
    flag(skipped, Skipped, Skipped),
    format(atom(Note), '~0f hops/s unwatched; ~D events told, ~D skipped',
           [Rate, Told, Skipped]),
    format(atom(Name), '~w agents ~w: slower when watched',
           [Agents, Where]),
    figure(Name, Slower, '%', Note).

pair(Agents, Hops, Peer, Ratio, Rate0) :-
    travelled(Agents, Hops, Peer, rates(Rate0, _)),
    flag(told, _, 0),
    flag(skipped, _, 0),
    watch([here, Peer], count, Watch),
    travelled(Agents, Hops, Peer, rates(Rate, _)),
    unwatch(Watch),
    Ratio is Rate/Rate0.

count(event(_, _, _, skipped(Count))) :-
    !,
    flag(skipped, N, N+Count).
count(_) :-
    flag(told, N, N+1).

                /*******************************
                *          WHAT IS THERE       *
                *******************************/

many_hosts :-
    network_start(ring(1000), Network, [processes(4)]),
    network_property(Network, hosts(Hosts)),
    forall(( member(Host, Hosts), between(1, 10, _) ),
           agent_create(clauses([(:- agent(resident, [])),
                                 on_message(_, _)]),
                        _, [host(Host)])),
    median_of(overview(Network, _, []), Overview),
    figure('overview of 1,000 hosts, 10,000 agents in 4 processes',
           Overview, ms),
    median_of(metrics(Network, _), Metrics),
    figure('their numbers for Prometheus', Metrics, ms),
    network_stop(Network).

:- meta_predicate median_of(0, -).

median_of(Goal, Ms) :-
    findall(Seconds, ( between(1, 9, _), seconds(Goal, Seconds) ), All),
    median(All, Median),
    Ms is Median*1000.
