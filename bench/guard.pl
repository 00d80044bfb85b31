:- use_module(common).
:- use_module(hogs).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2, sum_list/2]).

/*  The cost of guarded hosts: hops between two guarded processes, compared
    with unguarded ones, alternately in one run; and the speed of agents on a
    guarded host while hogs arrive there, one after the other; the host ends
    each hog that has exceeded its quota. */

:- initialization(main, main).

main([Placement]) :-
    pinned(Placement, _-Prefix),
    host_start(here, [cell(none)]),
    with_peer(Prefix, [cell(none)], guarded_hops(Placement)),
    host_stop(here).

guarded_hops(Placement, Peer) :-
    travelled(1, 4000, Peer, _),        % warm up
    findall(Plain-Guarded,
            ( between(1, 5, _),
              rate(Peer, trusted, Plain),
              rate(Peer, guarded, Guarded) ),
            Pairs),
    findall(P, member(P-_, Pairs), Ps),
    findall(G, member(_-G, Pairs), Gs),
    sum_list(Ps, Plain0),
    sum_list(Gs, Guarded0),
    Plain is 5.0e6/Plain0,
    Guarded is 5.0e6/Guarded0,
    atomic_list_concat(['a hop between hosts that guard, ', Placement], Name),
    ratio(Name, Guarded, Plain, us, 'a plain hop'),
    set_policy(Peer, guarded),
    host_change(here, quota([seconds(0.3)])),
    forall(hog_clauses(What, Clauses),
           beside_hog(What, Clauses, Peer, Placement)).

rate(Peer, Policy, Rate) :-
    set_policy(Peer, Policy),
    travelled(1, 4000, Peer, rates(Rate, _)).

set_policy(Peer, Policy) :-
    host_change(here, policy(Policy)),
    host_change(Peer, policy(Policy)).

beside_hog(What, Clauses, Peer, Placement) :-
    travelled(10, 8000, Peer, rates(Alone, _)),
    beside_hogs(here, Clauses, travelled(10, 8000, Peer, rates(Beside, _))),
    atomic_list_concat(['hops of ten agents beside a hog of ', What, ', ',
                        Placement], Name),
    ratio(Name, Beside, Alone, '1/s', 'alone').

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(typhon(over_limit(_, _)), _, _).
