:- module(typhon_links,
          [ host_neighbours/2,          % +Name, -Addresses
            host_linked/1,              % ?Address
            host_link/3,                % +Name, +Address, +Cost
            host_unlink/2,              % ?Name, ?Address
            host_link_cost/3            % +Name, +Address, -Cost
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(events, [event/4]).

/** <module> The links of hosts of this process, and their costs

A link is recorded in one direction; the other host records the other.

*Threading*: any thread; one mutex for changes.
*/

:- use_module('../base/durable', [durable/6, durable_drop/3, durable_put/4]).

:- dynamic
    neighbour/2,                % Name, Address
    cost/3.                     % Name, Address, Cost: of a link, if not 1

%!  host_link(+Name, +Address, +Cost) is det.
%
%   Make one direction of a link; does nothing if it exists.  Cost is a number,
%   or `same`: the present cost, 1 for a new link.  Listeners get changes in
%   the order in which they were made.

host_link(Name, Address, Cost) :-
    with_mutex(typhon_links,
               ( link(Name, Address, Cost, Was),
                 (   Was == new
                 ->  event(links, Name, none, link(Address))
                 ;   true
                 ) )).

link(Name, Address, Cost, Was) :-
    (   neighbour(Name, Address)
    ->  Was = known
    ;   Was = new,
        assertz(neighbour(Name, Address))
    ),
    set_cost(Cost, Name, Address),
    link_item(Key, Name, Address, Now),
    durable_put(link, Key, 0, link(Name, Address, Now)).

:- durable(link, Key, 0, link(Name, Address, Cost),
           link_item(Key, Name, Address, Cost),
           link_restore(Name, Address, Cost)).

link_item(Key, Name, Address, Cost) :-
    neighbour(Name, Address),
    host_link_cost(Name, Address, Cost),
    link_key(Name, Address, Key).

link_key(Name, Address, Key) :-
    atomic_list_concat([Name, Address], ' ', Key).

%   This reports no event, because the link existed before.

link_restore(Name, Address, Cost) :-
    with_mutex(typhon_links, link(Name, Address, Cost, _)).

%   A concurrent caller finds the old cost or the new one.

set_cost(same, _, _) :-
    !.
set_cost(Cost, Name, Address) :-
    cost(Name, Address, _),
    !,
    assertz(cost(Name, Address, Cost)),
    once(retract(cost(Name, Address, _))).
set_cost(Cost, Name, Address) :-
    assertz(cost(Name, Address, Cost)).

%!  host_unlink(?Name, ?Address) is det.
%
%   Remove one direction of links; does nothing if there is none.

host_unlink(Name, Address) :-
    with_mutex(typhon_links, unlink(Name, Address)).

unlink(Name, Address) :-
    findall(Name-Address, neighbour(Name, Address), Links),
    forall(( member(From-To, Links), link_key(From, To, Key) ),
           durable_drop(link, Key, 0)),
    retractall(neighbour(Name, Address)),
    retractall(cost(Name, Address, _)),
    forall(member(From-To, Links), event(links, From, none, unlink(To))).

%!  host_link_cost(+Name, +Address, -Cost) is semidet.
%
%   Fails if there is no such link.

host_link_cost(Name, Address, Cost) :-
    neighbour(Name, Address),
    !,
    (   cost(Name, Address, Cost0)
    ->  Cost = Cost0
    ;   Cost = 1
    ).

%!  host_linked(?Address) is nondet.
%
%   A host of this process is linked with Address.

host_linked(Address) :-
    neighbour(_, Address).

%!  host_neighbours(+Name, -Addresses:list(atom)) is det.

host_neighbours(Name, Addresses) :-
    findall(Address, neighbour(Name, Address), Addresses0),
    once_each(Addresses0, Addresses).

%   While other threads make links, 9.0.4 may return one twice in a row.

once_each([A,B|Rest], Set) :-
    A == B,
    !,
    once_each([B|Rest], Set).
once_each([A|Rest], [A|Set]) :-
    once_each(Rest, Set).
once_each([], []).
