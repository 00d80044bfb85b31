:- use_module(common).
:- use_module(traveller).
:- use_module(trip).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire/session), []).
:- use_module(library(lists), [member/2, nth0/3]).

/*  Hops between two processes, and a bare ping-pong of the same bytes.

    swipl bench/hops.pl -- Placement

An agent of 30 static clauses and 10 facts moves back and forth, or many at
once.  Processor time is that of both processes. */

:- initialization(main, main).

main([Placement]) :-
    pinned(Placement, _-Prefix),
    with_pong(Prefix, bare_trip(Placement, OneWay)),
    host_start(here),
    with_peer(Prefix, hops(Placement, OneWay)),
    host_stop(here).

bare_trip(Placement, OneWay, Streams) :-
    trips(1, 4000, Streams, _),         % warm up
    trips(1, 20000, Streams, rates(Rate, _)),
    OneWay is 1.0e6/Rate,
    name(Placement, 'one-way trip of the bare ping-pong', Name),
    figure(Name, OneWay, us).

name(Placement, What, Name) :-
    atomic_list_concat([What, ', ', Placement], Name).

                /*******************************
                *             HOPS             *
                *******************************/

hops(Placement, OneWay, Peer) :-
    bytes(Placement, Peer),
    travelled(1, 6000, Peer, _),        % warm up
    forall(member(Agents-Hops, [1-10000, 10-30000, 100-30000]),
           ( travelled(Agents, Hops, Peer, Rates),
             report(Agents, Placement, Rates),
             versus(Agents, Rates, OneWay, Placement)
           )),
    latency(Peer, Median, P99),
    name(Placement, 'latency of a hop, median', Name1),
    figure(Name1, Median, 'us'),
    name(Placement, 'latency of a hop, 99 %', Name2),
    figure(Name2, P99, 'us').

report(Agents, Placement, rates(PerSecond, PerCpu)) :-
    atomic_list_concat([Agents, ' agents: hops per second, ', Placement],
                       Name1),
    figure(Name1, PerSecond, '1/s'),
    atomic_list_concat([Agents, ' agents: hops per second of processor, ',
                        Placement], Name2),
    figure(Name2, PerCpu, '1/s').

versus(1, rates(Rate, _), OneWay, Placement) :-
    !,
    Hop is 1.0e6/Rate,
    name(Placement, 'a hop against a one-way trip', Name),
    ratio(Name, Hop, OneWay, us, 'bare ping-pong').
versus(_, _, _, _).

latency(Peer, Median, P99) :-
    traveller(clauses(Terms0)),
    Terms0 = [Decl, _, _|Rest],
    agent_create(clauses([Decl,
                          (main :- left(0), !),
                          (main :- retract(left(N)), N1 is N-1,
                                   assertz(left(N1)), peer(P), home(H),
                                   now(T0), move(P), move(H), now(T1),
                                   T is (T1-T0)/2, leave(latency(T)), main)
                         | Rest]),
                 Agent, [facts([left(5000), peer(Peer)])]),
    agent_join(Agent, done, 300),
    remote(here, findall(L, sense(latency(L)), Ls)),
    msort(Ls, Sorted),
    length(Sorted, N),
    I50 is N//2, I99 is N*99//100,
    nth0(I50, Sorted, M), nth0(I99, Sorted, P),
    Median is M*1.0e6, P99 is P*1.0e6.

%   Bytes sent over the connection, as counted by the stream.

bytes(Placement, Peer) :-
    once_round(Peer, First),
    once_round(Peer, Later),
    name(Placement, 'bytes sent per hop, first visit', Name1),
    figure(Name1, First, byte),
    name(Placement, 'bytes sent per hop, later visits', Name2),
    figure(Name2, Later, byte).

once_round(Peer, Bytes) :-
    traveller(Program),
    sent(Peer, B0),
    agent_create(Program, Agent, [facts([left(1), peer(Peer)])]),
    agent_join(Agent, done, 60),
    sent(Peer, B1),
    Bytes is B1-B0.

sent(Peer, Bytes) :-
    atomic_list_concat([_, Endpoint], '@', Peer),
    (   typhon_session:route(Endpoint, Session),
        typhon_session:session_key(Session, Key),
        typhon_session:transport(Key, _, Out)
    ->  byte_count(Out, Bytes)
    ;   Bytes = 0
    ).
