:- module(sync_orderly, []).
:- use_module('../../prolog/typhon/options/migration/strategy', [memory_visited/2]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, reverse/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> Conscientious migration without chance

The strategy `orderly` is `conscientious`, except for hosts never visited: of
these it takes the one with the next higher number, after the highest the
lowest.  So on a ring all agents move in the same direction.  Only processes
that have loaded this file have the strategy: those of a virtual network.

*Threading*: pure.
*/

:- multifile
    typhon_strategy:strategy/1,
    typhon_strategy:choose/6.

typhon_strategy:strategy(orderly).

typhon_strategy:choose(orderly, Hosts, Here, Memory, Host, Memory) :-
    memory_visited(Memory, Visited),
    number_of(Here, Number),
    maplist(numbered, Hosts, Keyed0),
    keysort(Keyed0, Keyed),
    partition(after(Number), Keyed, Higher, Lower),
    append(Higher, Lower, InOrder),
    pairs_values(InOrder, Ordered),
    (   member(Host, Ordered),
        \+ memberchk(Host, Visited)
    ->  true
    ;   reverse(Visited, OldestFirst),
        member(Host, OldestFirst),
        memberchk(Host, Hosts)
    ->  true
    ).

numbered(Host, Number-Host) :-
    number_of(Host, Number).

%   Hosts of a network are n1@..., n2@...

number_of(Host, Number) :-
    atomic_list_concat([Name|_], @, Host),
    atom_concat(n, Digits, Name),
    atom_number(Digits, Number).

after(Number, Other-_) :-
    Other > Number.
