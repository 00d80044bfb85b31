:- module(typhon_topology,
          [ topology_edges/4,           % +Topology, +Seed, -N, -Edges
            topology_names/2,           % +Topology, -Names
            topology_costs/2,           % +Topology, -Costs
            number_name/2               % +Number, -Name
          ]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2, type_error/2]).
:- use_module(library(lists),
              [ append/2, append/3, list_to_set/2, member/2, nth1/3,
                numlist/3 ]).
:- use_module(library(ordsets), [ord_subtract/3]).
:- autoload(library(ugraphs), [reachable/3, vertices_edges_to_ugraph/3]).
:- use_module('../kernel/agent', [is_printable/1]).
:- use_module('../kernel/base/options', [blaming/2]).
:- use_module('../kernel/base/prng',
              [chance_member/4, chance_seed/2, chance_true/4]).

/** <module> The shapes of networks

A topology is a term. Its hosts are numbered from 1, its edges are pairs
`I-J` with I < J, sorted, each once.

  - star_bus(Arms, Len): a chain of Arms hubs, each with Len-1 leaves, the
    hub first in its star: Arms*Len hosts (thesis, Figure 5.4 a)
  - line(N): a chain
  - ring(N): each host between two others
  - star(N): the first host linked to each of the others
  - tree(N): binary, the parent of host I is I//2
  - grid(Rows, Cols): row after row, each host linked to the next in its
    row and in its column
  - mesh(N): every host to every other
  - random(N, P): Erdos-Renyi G(N,P), and connected: see below
  - edges(List): as listed, pairs A-B of positive integers or atoms, or
    A-B-cost(C) where the link costs C

In random(N, P) every pair of hosts is linked with probability P. If the network
is not connected, each component is linked to the one before it, by one link
between hosts drawn from the two: otherwise an agent could never leave the
component in which it starts. Above P = ln(N)/N this is rarely necessary.

Host I is named `n<I>`. In edges(List) integer I stands for `n<I>`, too, an atom
for the host of that name, and hosts are numbered in the order in which the
list first names them.

*Threading*: pure.
*/

%!  topology_edges(+Topology, +Seed:integer, -N, -Edges) is det.
%
%   Topology has N hosts and the links Edges. Only random(_,_) depends on Seed;
%   the same Seed gives the same Edges.
%
%   @error type_error(Type, X), domain_error(topology, Topology),
%   domain_error(probability, P), domain_error(edge, A-A)

:- multifile typhon_names:known/2.

typhon_names:known(topology, star_bus('Arms', 'Len')).
typhon_names:known(topology, line('N')).
typhon_names:known(topology, ring('N')).
typhon_names:known(topology, star('N')).
typhon_names:known(topology, tree('N')).
typhon_names:known(topology, grid('Rows', 'Cols')).
typhon_names:known(topology, mesh('N')).
typhon_names:known(topology, random('N', 'P')).
typhon_names:known(topology, edges('List')).

topology_edges(Topology, Seed, N, Edges) :-
    must_be(nonvar, Topology),
    must_be(integer, Seed),
    (   blaming(Topology, shape(Topology, Seed, N, Edges0))
    ->  sort(Edges0, Edges)
    ;   domain_error(topology, Topology)
    ).

%!  topology_names(+Topology, -Names:list(atom)) is det.
%
%   Names are the names of the hosts, in the order of their numbers.
%
%   @error as topology_edges/4

topology_names(Topology, Names) :-
    must_be(nonvar, Topology),
    (   Topology = edges(List)
    ->  listed_names(List, Names)
    ;   topology_size(Topology, N)
    ->  numbered_names(N, Names)
    ;   domain_error(topology, Topology)
    ).

topology_size(Topology, N) :-
    dimensions(Topology, Sizes),
    maplist(must_be(positive_integer), Sizes),
    foldl(times, Sizes, 1, N).

times(X, Y0, Y) :-
    Y is X*Y0.

dimensions(star_bus(Arms, Len), [Arms, Len]).
dimensions(line(N), [N]).
dimensions(ring(N), [N]).
dimensions(star(N), [N]).
dimensions(tree(N), [N]).
dimensions(grid(Rows, Cols), [Rows, Cols]).
dimensions(mesh(N), [N]).
dimensions(random(N, P), [N]) :-
    probability(P).

probability(P) :-
    must_be(number, P),
    (   P >= 0, P =< 1
    ->  true
    ;   domain_error(probability, P)
    ).

numbered_names(N, Names) :-
    numlist(1, N, Numbers),
    maplist(number_name, Numbers, Names).

%!  topology_costs(+Topology, -Costs) is det.
%
%   Costs are the costs that Topology lists: pairs (I-J)-Cost with I < J, each
%   edge at most once.
%
%   @error as topology_edges/4

topology_costs(Topology, Costs) :-
    (   Topology = edges(List)
    ->  listed_names(List, Names),
        listed_costs(Names, List, Costs)
    ;   Costs = []
    ).

                /*******************************
                *            SHAPES            *
                *******************************/

shape(edges(List), _, N, Edges) :-
    !,
    listed_names(List, Names),
    length(Names, N),
    maplist(listed_edge(Names), List, Edges).
shape(Topology, Seed, N, Edges) :-
    topology_size(Topology, N),
    (   Topology = random(_, P)
    ->  random_edges(N, P, Seed, Edges)
    ;   findall(I-J, linked(Topology, I, J), Edges)
    ).

%   linked(+Topology, -I, -J): host I is linked to host J, and I < J.

linked(star_bus(Arms, Len), I, J) :-
    between(1, Arms, Arm),
    I is (Arm - 1) * Len + 1,
    (   Arm < Arms,
        J is I + Len
    ;   Last is I + Len - 1,
        First is I + 1,
        between(First, Last, J)
    ).
linked(line(N), I, J) :-
    between(2, N, J),
    I is J - 1.
linked(ring(N), I, J) :-
    linked(line(N), I, J).
linked(ring(N), 1, N) :-
    N > 2.
linked(star(N), 1, J) :-
    between(2, N, J).
linked(tree(N), I, J) :-
    between(2, N, J),
    I is J // 2.
linked(grid(Rows, Cols), I, J) :-
    between(1, Rows, Row),
    between(1, Cols, Col),
    I is (Row - 1) * Cols + Col,
    (   Col < Cols,
        J is I + 1
    ;   Row < Rows,
        J is I + Cols
    ).
linked(mesh(N), I, J) :-
    pair_below(N, I, J).

pair_below(N, I, J) :-
    between(2, N, J),
    Last is J - 1,
    between(1, Last, I).

                /*******************************
                *            RANDOM            *
                *******************************/

random_edges(N, P, Seed, Edges) :-
    chance_seed(Seed, Chance0),
    findall(I-J, pair_below(N, I, J), Pairs),
    foldl(draw_edge(P), Pairs, []-Chance0, Drawn-Chance),
    numlist(1, N, Hosts),
    pieces(Hosts, Drawn, Pieces),
    tie(Pieces, Chance, Ties),
    append(Ties, Drawn, Edges).

draw_edge(P, Edge, Edges0-Chance0, Edges-Chance) :-
    chance_true(P, Bool, Chance0, Chance),
    (   Bool == true
    ->  Edges = [Edge|Edges0]
    ;   Edges = Edges0
    ).

%   pieces(+Hosts, +Edges, -Pieces): Pieces are the connected components.

pieces(Hosts, Edges, Pieces) :-
    findall(J-I, member(I-J, Edges), Back),
    append(Back, Edges, Both),
    vertices_edges_to_ugraph(Hosts, Both, Graph),
    pieces_of(Hosts, Graph, Pieces).

pieces_of([], _, []).
pieces_of([Host|Hosts], Graph, [Piece|Pieces]) :-
    reachable(Host, Graph, Piece),
    ord_subtract(Hosts, Piece, Rest),
    pieces_of(Rest, Graph, Pieces).

tie([Piece1, Piece2|Pieces], Chance0, [I-J|Ties]) :-
    !,
    chance_member(A, Piece1, Chance0, Chance1),
    chance_member(B, Piece2, Chance1, Chance2),
    I is min(A, B),
    J is max(A, B),
    tie([Piece2|Pieces], Chance2, Ties).
tie(_, _, []).

                /*******************************
                *         LISTED EDGES         *
                *******************************/

%   listed_names(+List, -Names:list(atom)) is det.
%
%   Names are the names of the hosts. The following predicates are likewise for
%   edges(List).
%
%   listed_edge(+Names, +Edge, -Pair) is det: Pair is I-J with I < J, the
%   numbers of the hosts.
%
%   listed_costs(+Names, +List, -Costs) is det: Costs are terms Pair-Cost,
%   sorted, one for each edge of which List has the cost.
%
%   @error type_error(edge, Edge), type_error(host_name, End),
%   domain_error(edge, A-A), domain_error(cost, C)

listed_names(List, Names) :-
    must_be(list, List),
    maplist(edge_names, List, Nested),
    append(Nested, All),
    list_to_set(All, Names),
    (   Names == []
    ->  domain_error(topology, edges(List))
    ;   true
    ).

edge_names(Edge, [A, B]) :-
    must_be(nonvar, Edge),
    (   edge_cost(Edge, X-Y, _)
    ->  maplist(end_name, [X, Y], [A, B])
    ;   type_error(edge, Edge)
    ),
    (   A == B
    ->  domain_error(edge, Edge)
    ;   true
    ).

end_name(End, Name) :-
    must_be(nonvar, End),
    (   integer(End),
        End > 0
    ->  number_name(End, Name)
    ;   atom(End),
        is_printable(End)
    ->  Name = End
    ;   type_error(host_name, End)
    ).

%   edge_cost(+Edge, -Pair, -Cost): Cost is `none` if Edge has none.

edge_cost(Pair-Cost0, Pair1, Cost) :-
    nonvar(Cost0),
    Cost0 = cost(Cost1),
    !,
    must_be(number, Cost1),
    (   Cost1 >= 0
    ->  Cost = Cost1
    ;   domain_error(cost, Cost1)
    ),
    nonvar(Pair),
    Pair = _-_,
    Pair1 = Pair.
edge_cost(A-B, A-B, none).

listed_edge(Names, Edge, I-J) :-
    edge_names(Edge, [A, B]),
    nth1(AtA, Names, A),
    nth1(AtB, Names, B),
    !,
    I is min(AtA, AtB),
    J is max(AtA, AtB).

listed_costs(Names, List, Costs) :-
    findall(Pair-Cost,
            ( member(Edge, List),
              edge_cost(Edge, _, Cost),
              number(Cost),
              listed_edge(Names, Edge, Pair) ),
            Costs0),
    sort(1, @<, Costs0, Costs).

%!  number_name(+Number, -Name) is det.
%
%   Name is the default name of the host of that Number.

number_name(I, Name) :-
    atom_concat(n, I, Name).
