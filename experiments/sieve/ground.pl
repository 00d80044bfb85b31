:- module(sieve_ground,
          [ ground_start/4,             % +Topology, +Model, +Seed, -Ground
            ground_links/4,             % +Now, +Ground0, -Ground, -Links
            ground_map/4,               % +Links, +Host, +Span, -Map
            ground_step/6               % +Links, +Maps, +From, -To,
                                        % +Chance0, -Chance
          ]).
:- use_module('../../prolog/typhon/base/chance', [chance_member/4]).
:- use_module('../../prolog/typhon/network/dynamics',
              [dynamics_event/4, dynamics_model/2, dynamics_state/5]).
:- use_module('../../prolog/typhon/language/strategy', [memory_mark/3, next_host/6]).
:- use_module('../../prolog/typhon/network/topology', [topology_edges/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(ordsets),
              [ord_add_element/3, ord_del_element/3, ord_subtract/3]).

/** <module> The network of a simulation, and ways through it

A ground is ground(N, Links, Due): N hosts, numbered from 1, the neighbours
of each, and the changes of links that come next.

*Threading*: pure.
*/

%!  ground_start(+Topology, +Model, +Seed:integer, -Ground) is det.
%
%   As a network of that topology, with links that change by Model, or
%   `none`.

ground_start(Topology, Model, Seed, ground(N, Links, Due)) :-
    topology_edges(Topology, Seed, N, Edges),
    numlist(1, N, Hosts),
    findall(Ns,
            ( member(Host, Hosts),
              findall(J, ( member(Host-J, Edges)
                         ; member(J-Host, Edges) ), Ns0),
              sort(Ns0, Ns) ),
            All),
    Links =.. [links|All],
    (   Model == none
    ->  Due = none
    ;   dynamics_model(Model, General),
        dynamics_state(General, N, Edges, Seed, State),
        next_changes(State, Due)
    ).

next_changes(State0, Due) :-
    (   dynamics_event(State0, Time, Changes, State)
    ->  Due = due(Time, Changes, State)
    ;   Due = none
    ).

%!  ground_links(+Now, +Ground0, -Ground, -Links) is det.
%
%   Links, a term whose argument I is the list of neighbours of host I, as
%   they are at Now.

ground_links(Now, ground(N, Links0, due(Time, Changes, State)), Ground,
             Links) :-
    Time =< Now,
    !,
    foldl(change, Changes, Links0, Links1),
    next_changes(State, Due),
    ground_links(Now, ground(N, Links1, Due), Ground, Links).
ground_links(_, Ground, Ground, Links) :-
    arg(2, Ground, Links).

change(link(I, J), Links0, Links) :-
    changed(ord_add_element, I, J, Links0, Links1),
    changed(ord_add_element, J, I, Links1, Links).
change(unlink(I, J), Links0, Links) :-
    changed(ord_del_element, I, J, Links0, Links1),
    changed(ord_del_element, J, I, Links1, Links).

changed(Change, I, J, Links0, Links) :-
    duplicate_term(Links0, Links),
    arg(I, Links, Ns0),
    call(Change, Ns0, J, Ns),
    setarg(I, Links, Ns).

%!  ground_map(+Links, +Host, +Span, -Map) is det.
%
%   Map has the distance from Host of hosts that are at most Span away.

ground_map(Links, Host, Span, Map) :-
    spread([Host], 0, Span, Links, [Host], [Host-0], Pairs),
    list_to_assoc(Pairs, Map).

spread([], _, _, _, _, Pairs, Pairs) :-
    !.
spread(_, Span, Span, _, _, Pairs, Pairs) :-
    !.
spread(Edge, Distance, Span, Links, Seen, Pairs0, Pairs) :-
    findall(J, ( member(I, Edge), arg(I, Links, Ns), member(J, Ns) ), Js0),
    sort(Js0, Js),
    ord_subtract(Js, Seen, New),
    Distance1 is Distance + 1,
    findall(J-Distance1, member(J, New), NewPairs, Pairs0),
    foldl(see, New, Seen, Seen1),
    spread(New, Distance1, Span, Links, Seen1, NewPairs, Pairs).

see(Host, Seen0, Seen) :-
    ord_add_element(Seen0, Host, Seen).

%!  ground_step(+Links, +Maps, +From, -To, +Chance0, -Chance) is det.
%
%   A hop nearer to the source of the nearest of Maps, or on conscientiously
%   where none is near.  From and To are pairs Host-Trip, Trip being the
%   memory of the strategy.

ground_step(Links, Maps, Host-Trip0, Next-Trip, Chance0, Chance) :-
    arg(Host, Links, Neighbours),
    findall(Distance-J,
            ( member(Map, Maps), get_assoc(Host, Map, Here),
              Distance is Here - 1, member(J, Neighbours),
              get_assoc(J, Map, Distance) ),
            Steps),
    aggregate_all(min(D), member(D-_, Steps), Least),
    !,
    findall(J, member(Least-J, Steps), Nearer),
    chance_member(Next, Nearer, Chance0, Chance),
    memory_mark(Host, Trip0, Trip1),
    memory_mark(Next, Trip1, Trip).
ground_step(Links, _, Host-Trip0, Next-Trip, Chance, Chance) :-
    arg(Host, Links, Neighbours),
    (   next_host(conscientious, Neighbours, Host, Trip0, Next0, Trip1)
    ->  Next = Next0,
        Trip = Trip1
    ;   Next = Host,
        Trip = Trip0
    ).
