:- module(population_mesh,
          [ mesh/4                      % +Hosts, +Degree, +Seed, -Topology
          ]).
:- use_module('../../prolog/typhon/chance', [chance_below/4, chance_seed/2]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/2, nth0/4, numlist/3]).

/** <module> Mesh overlay networks

*Threading*: pure.
*/

%!  mesh(+Hosts:integer, +Degree:integer, +Seed:integer, -Topology) is det.
%
%   Topology is edges(List), for network_start/3: Degree//2 rings through
%   all hosts, each in an order of its own drawn from Seed.  So the network
%   is connected, and each host has Degree neighbours, or a few less where
%   rings have an edge in common.
%
%   @error type_error(Type, X)

mesh(Hosts, Degree, Seed, edges(Edges)) :-
    must_be(positive_integer, Hosts),
    must_be(positive_integer, Degree),
    chance_seed(Seed, Chance),
    numlist(1, Hosts, Numbers),
    Count is max(1, Degree // 2),
    length(Rings, Count),
    foldl(ring(Numbers), Rings, Chance, _),
    append(Rings, Edges0),
    sort(Edges0, Edges).

ring(Numbers, Edges, Chance0, Chance) :-
    shuffled(Numbers, Order, Chance0, Chance),
    Order = [First|Rest],
    edges([First|Rest], First, Edges).

edges([Last], First, Edges) :-
    !,
    findall(Edge, edge(Last, First, Edge), Edges).
edges([A,B|Rest], First, [Edge|Edges]) :-
    edge(A, B, Edge),
    edges([B|Rest], First, Edges).

edge(A, B, Low-High) :-
    A =\= B,
    Low is min(A, B),
    High is max(A, B).

shuffled([], [], Chance, Chance).
shuffled([X|Xs], [Y|Ys], Chance0, Chance) :-
    length([X|Xs], N),
    chance_below(N, Index, Chance0, Chance1),
    nth0(Index, [X|Xs], Y, Rest),
    shuffled(Rest, Ys, Chance1, Chance).
