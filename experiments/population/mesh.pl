:- module(population_mesh,
          [ mesh/5                      % +Kind, +Hosts, +Degree, +Seed,
                                        % -Topology
          ]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_below/4, chance_seed/2]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/2, nth0/4, numlist/3]).

/** <module> Mesh overlay networks

*Threading*: pure.
*/

%!  mesh(+Kind, +Hosts:integer, +Degree:integer, +Seed:integer,
%!       -Topology) is det.
%
%   Topology, for network_start/3, is a network of Hosts hosts, which have
%   Degree neighbours each, or on average.  Kind is
%
%     - rings
%       Degree//2 rings through all hosts, each in a random order drawn
%       from Seed: connected, and of nearly constant degree, less where rings
%       share an edge.
%     - random
%       Any two hosts are linked with the same probability.
%
%   @error type_error(Type, X)

mesh(rings, Hosts, Degree, Seed, edges(Edges)) :-
    must_be(positive_integer, Hosts),
    must_be(positive_integer, Degree),
    chance_seed(Seed, Chance),
    numlist(1, Hosts, Numbers),
    Count is max(1, Degree // 2),
    length(Rings, Count),
    foldl(ring(Numbers), Rings, Chance, _),
    append(Rings, Edges0),
    sort(Edges0, Edges).
mesh(random, Hosts, Degree, _, random(Hosts, Probability)) :-
    must_be(positive_integer, Hosts),
    must_be(positive_integer, Degree),
    Probability is min(1.0, Degree/max(1, Hosts - 1)).

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
