:- module(typhon_listed,
          [ listed_names/2,             % +List, -Names
            listed_edge/3,              % +Names, +Edge, -Pair
            listed_costs/3,             % +Names, +List, -Costs
            number_name/2               % +Number, -Name
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2, type_error/2]).
:- use_module(library(lists), [append/2, list_to_set/2, member/2, nth1/3]).

/** <module> Networks whose links are listed

An edge is A-B or A-B-cost(C), where A and B are positive integers or atoms
and C is a number that is not negative.  Hosts are numbered in the order in
which the list first names them.

*Threading*: pure.
*/

%!  listed_names(+List, -Names:list(atom)) is det.
%!  listed_edge(+Names, +Edge, -Pair) is det.
%!  listed_costs(+Names, +List, -Costs) is det.
%
%   The names of the hosts; Pair is I-J with I < J, as of the numbers of
%   hosts; Costs are terms Pair-Cost, sorted, one for each edge of which the
%   List tells the cost.
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
    ;   atom(End)
    ->  Name = End
    ;   type_error(host_name, End)
    ).

%   edge_cost(+Edge, -Pair, -Cost): Cost is `none` if Edge does not say.

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
%   The name of the host of that Number, if it was not named.

number_name(I, Name) :-
    atom_concat(n, I, Name).
