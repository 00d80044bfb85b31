:- module(simulation_world,
          [ world_network/5,            % +Options, +Seed, -N, -Links, -Changes
            world_hosts/2,              % +N, -Hosts
            world_agents/6,             % +Options, +N, -Agents, -Queue,
                                        % +Chance0, -Chance
            world_change/4              % +Now, +Links, +Changes0, -Changes
          ]).
:- use_module(reading, [reading_full/1]).
:- use_module('../../prolog/typhon/base/chance',
              [chance_below/4, chance_float/3]).
:- use_module('../../prolog/typhon/network/dynamics',
              [ dynamics_event/4, dynamics_model/2, dynamics_state/5 ]).
:- use_module('../../prolog/typhon/language/strategy',
              [memory_visited/2, strategy_memory/2]).
:- use_module('../../prolog/typhon/network/topology', [topology_edges/4]).
:- use_module(library(apply), [foldl/4, foldl/5, partition/4]).
:- use_module(library(heaps), [list_to_heap/2]).
:- use_module(library(lists), [append/3, member/2, numlist/3, reverse/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(ordsets), [ord_add_element/3, ord_del_element/3]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> The hosts, links and agents of a simulation

What is numbered, as the hosts are, is a term with an argument for each.
These terms are changed by setarg/3.

*Threading*: as simulation_model.
*/

%!  world_network(+Options, +Seed, -N, -Links, -Changes) is det.
%
%   N hosts, of each the neighbours in Links, and the changes of links that
%   are to come.

world_network(Options, Seed, N, Links, Changes) :-
    option(topology(Topology), Options),
    topology_edges(Topology, Seed, N, Edges),
    functor(Links, links, N),
    neighbours(N, Edges, Links),
    option(dynamic(Model), Options, none),
    changes(Model, N, Edges, Seed, Changes).

neighbours(N, Edges, Links) :-
    numlist(1, N, Hosts),
    foldl(host_neighbours(Edges), Hosts, Links, Links).

host_neighbours(Edges, Host, Links, Links) :-
    findall(Other, ( member(Host-Other, Edges)
                   ; member(Other-Host, Edges)
                   ), Others0),
    sort(Others0, Others),
    arg(Host, Links, Others).

changes(none, _, _, _, none) :-
    !.
changes(Name, N, Edges, Seed, Changes) :-
    dynamics_model(Name, Model),
    dynamics_state(Model, N, Edges, Seed, State),
    next_changes(State, Changes).

next_changes(State0, changes(Time, Changes, State)) :-
    dynamics_event(State0, Time, Changes, State).

%!  world_hosts(+N, -Hosts) is det.
%
%   N hosts that have done nothing, see simulation_model.

world_hosts(N, Hosts) :-
    functor(Hosts, hosts, N),
    all_arguments(N, Hosts, host(0, 0, 1, [])).

all_arguments(0, _, _) :-
    !.
all_arguments(I, Term, Value) :-
    arg(I, Term, Value),
    I1 is I - 1,
    all_arguments(I1, Term, Value).

%!  world_agents(+Options, +N, -Agents, -Queue, +Chance0, -Chance) is det.
%
%   The agents start on different hosts while there are any of the N, drawn
%   or at even distances. Queue says that all arrive there at time 0.

world_agents(Options, N, Agents, Queue, Chance0, Chance) :-
    option(agents(Count), Options),
    option(tasks(Tasks), Options),
    functor(Agents, agents, Count),
    numlist(1, Count, Numbers),
    numlist(1, N, Hosts),
    option(starts(Starts), Options, drawn),
    starts(Starts, Count, Hosts, Free, Chance0, Chance1),
    foldl(agent(Tasks, Agents, Free), Numbers, Free-Chance1, _-Chance),
    findall(0-Agent, member(Agent, Numbers), Pairs),
    list_to_heap(Pairs, Queue).

agent(Tasks, Agents, Hosts, Number, []-Chance0, Left) :-
    !,
    agent(Tasks, Agents, Hosts, Number, Hosts-Chance0, Left).
agent(Tasks, Agents, _, Number, [Host|Free]-Chance0, Free-Chance) :-
    chance_below(0x40000000, Seed, Chance0, Chance),
    strategy_memory(Seed, Memory),
    functor(Drives, drives, Tasks),
    reading_full(Full),
    all_arguments(Tasks, Drives, Full),
    arg(Number, Agents, agent(Host, Memory, Drives)).

%   starts(+Starts, +Count, +Hosts, -Free, +Chance0, -Chance): Free are the
%   hosts in the order in which they are given to Count agents.

starts(even, Count, Hosts, Free, Chance, Chance) :-
    length(Hosts, N),
    Step is max(1, N // Count),
    Last is min(Count, N) - 1,
    findall(Host, ( between(0, Last, I), Host is I * Step + 1 ), Free).
starts(drawn, _, Hosts, Free, Chance0, Chance) :-
    foldl(draw, Hosts, Keyed, Chance0, Chance),
    keysort(Keyed, Sorted),
    pairs_values(Sorted, Free).

draw(Host, Key-Host, Chance0, Chance) :-
    chance_float(Key, Chance0, Chance).

                /*******************************
                *            ORDER             *
                *******************************/

%   The strategy `orderly` is `conscientious` without chance: of the hosts
%   never visited it takes the one with the next higher number, after the
%   highest the lowest. On a ring all agents so go the same way.

:- multifile
    typhon_strategy:strategy/1,
    typhon_strategy:choose/6.

typhon_strategy:strategy(orderly).

typhon_strategy:choose(orderly, Hosts, Here, Memory, Host, Memory) :-
    memory_visited(Memory, Visited),
    partition(<(Here), Hosts, Higher, Lower),
    append(Higher, Lower, InOrder),
    (   member(Host, InOrder),
        \+ memberchk(Host, Visited)
    ->  true
    ;   reverse(Visited, OldestFirst),
        member(Host, OldestFirst),
        memberchk(Host, Hosts)
    ->  true
    ).

                /*******************************
                *            LINKS             *
                *******************************/

%!  world_change(+Now, +Links, +Changes0, -Changes) is det.
%
%   Links are changed as Changes0 say until Now; Changes are still to come.

world_change(Now, Links, changes(Time, List, State), Changes) :-
    Time =< Now,
    !,
    foldl(change_link, List, Links, Links),
    next_changes(State, Changes1),
    world_change(Now, Links, Changes1, Changes).
world_change(_, _, Changes, Changes).

change_link(link(A, B), Links, Links) :-
    change_end(ord_add_element, A, B, Links),
    change_end(ord_add_element, B, A, Links).
change_link(unlink(A, B), Links, Links) :-
    change_end(ord_del_element, A, B, Links),
    change_end(ord_del_element, B, A, Links).

change_end(Change, A, B, Links) :-
    arg(A, Links, Others0),
    call(Change, Others0, B, Others),
    setarg(A, Links, Others).
