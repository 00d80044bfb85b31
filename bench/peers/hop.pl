:- use_module('../common').
:- use_module('../traveller').
:- use_module('../trip').
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).

/*  Our side of bench/peers.pl: the bare trip, and hops. */

:- initialization(main, main).

main :-
    with_pong([env], bare_trips),
    host_start(here),
    with_peer([env], hops),
    host_stop(here).

bare_trips(Streams) :-
    trip_bytes(Bytes),
    format('bytes(~q, ~d).~n', ['bare trip', Bytes]),
    trips(1, 4000, Streams, _),         % warm up
    forall(member(Terms-Trips, [1-20000, 10-40000]),
           ( trips(Terms, Trips, Streams, Rates),
             report('bare trip', Terms, Rates) )).

hops(Peer) :-
    travelled(1, 6000, Peer, _),        % warm up
    forall(member(Agents-Hops, [1-10000, 10-20000]),
           ( travelled(Agents, Hops, Peer, Rates),
             report('our hops', Agents, Rates) )).

report(What, Number, rates(PerSecond, PerCpu)) :-
    many(Number, Many),
    format('rates(~q, ~w, ~1f, ~1f).~n', [What, Many, PerSecond, PerCpu]).

many(1, one).
many(10, ten).
