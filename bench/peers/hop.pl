:- use_module('../common').
:- use_module('../traveller').
:- use_module('../trip').
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).

/*  Typhon's hops for bench/peers.pl, and the bare trip of the same bytes: a
    term written by fast_term_serialized/2 by one process of one thread, and
    read by another, without agents and answers. */

:- initialization(main, main).

main([_]) :-
    with_pong([env], bare_trips),
    host_start(here),
    with_peer([env], hops),
    host_stop(here).

bare_trips(Streams) :-
    trips(1, 4000, Streams, _),         % warm up
    forall(member(trips(Many, Terms, Trips),
                  [trips(one, 1, 20000), trips(ten, 10, 40000)]),
           measured(trips(Many), Trips, trips(Terms, Trips, Streams, _))).

hops(Peer) :-
    travelled(1, 6000, Peer, _),        % warm up
    forall(member(hops(Many, Agents, Hops),
                  [hops(one, 1, 10000), hops(ten, 10, 20000)]),
           measured(hops(Many), Hops, travelled(Agents, Hops, Peer, _))).
