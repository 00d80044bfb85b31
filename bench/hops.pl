:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(typhon/wire/transport), []).
:- use_module(library(typhon/wire/session), []).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, nth0/3, append/3]).
:- use_module(library(socket)).
:- use_module(library(process), [process_create/3, process_wait/2]).

/*  Hops between two processes, against a bare ping-pong of the same bytes.

    swipl bench/hops.pl -- Placement

An agent of 30 static clauses and 10 facts goes back and forth.  The
baseline sends the same bytes over one connection by
fast_term_serialized/2, without threads, agents or answers. */

:- initialization(main, main).

main([Placement]) :-
    pinned(Placement, _-Prefix),
    baseline(Prefix, OneWay),
    name(Placement, 'one-way trip of the bare ping-pong', Name),
    Micro is OneWay*1.0e6,
    figure(Name, Micro, 'us'),
    host_start(here),
    with_peer(Prefix, hops(Placement, OneWay)),
    host_stop(here).

name(Placement, What, Name) :-
    atomic_list_concat([What, ', ', Placement], Name).

                /*******************************
                *             HOPS             *
                *******************************/

hops(Placement, OneWay, Peer) :-
    bytes(Placement, Peer),
    rate(1, 6000, Peer, _),             % warm up
    forall(member(Agents-Hops, [1-10000, 10-30000, 100-30000]),
           ( rate(Agents, Hops, Peer, Rate),
             atomic_list_concat([Agents, ' agents: hops per second, ',
                                 Placement], Name),
             figure(Name, Rate, '1/s'),
             versus(Agents, Rate, OneWay, Placement)
           )),
    latency(Peer, Median, P99),
    name(Placement, 'latency of a hop, median', Name1),
    figure(Name1, Median, 'us'),
    name(Placement, 'latency of a hop, 99 %', Name2),
    figure(Name2, P99, 'us').

versus(1, Rate, OneWay, Placement) :-
    !,
    Hop is 1.0e6/Rate,
    Trip is OneWay*1.0e6,
    name(Placement, 'a hop against a one-way trip', Name),
    ratio(Name, Hop, Trip, us, 'bare ping-pong').
versus(_, _, _, _).

rate(Agents, Hops, Peer, Rate) :-
    Each is Hops//(2*Agents),
    program(Program),
    seconds(( findall(Agent,
                      ( between(1, Agents, _),
                        agent_create(Program, Agent,
                                     [facts([left(Each), peer(Peer)])])
                      ),
                      List),
              forall(member(Agent, List), agent_join(Agent, done, 300))
            ),
            Seconds),
    Rate is 2*Each*Agents/Seconds.

%   30 static clauses and, with left/1 and peer/1, 10 facts.

program(clauses([ (:- agent(traveller, [state([left/1,peer/1,fact/2])])),
                  (main :- left(0), !),
                  (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                           peer(P), move(P), home(H), move(H), main)
                | Rest ])) :-
    findall(fact(I, value(I)), between(1, 8, I), Facts),
    findall((rule(I, X) :- Y is X+I, Y > 0, other(Y)), between(1, 27, I),
            Rules),
    append(Facts, [other(_)|Rules], Rest).

latency(Peer, Median, P99) :-
    program(clauses(Terms0)),
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

%   What goes over the wire, by the stream's own count.

bytes(Placement, Peer) :-
    once_round(Peer, First),
    once_round(Peer, Later),
    name(Placement, 'bytes sent per hop, first visit', Name1),
    figure(Name1, First, byte),
    name(Placement, 'bytes sent per hop, later visits', Name2),
    figure(Name2, Later, byte).

once_round(Peer, Bytes) :-
    program(Program),
    sent(Peer, B0),
    agent_create(Program, Agent, [facts([left(1), peer(Peer)])]),
    agent_join(Agent, done, 60),
    sent(Peer, B1),
    Bytes is B1-B0.

sent(Peer, Bytes) :-
    atomic_list_concat([_, Endpoint], '@', Peer),
    (   typhon_session:route(Endpoint, Session),
        typhon_session:session_key(Session, Key),
        typhon_transport:transport(Key, _, Out)
    ->  byte_count(Out, Bytes)
    ;   Bytes = 0
    ).

                /*******************************
                *           BASELINE           *
                *******************************/

baseline(Prefix, OneWay) :-
    tcp_socket(Server),
    tcp_setopt(Server, reuseaddr),
    tcp_bind(Server, '127.0.0.1':Port),
    tcp_listen(Server, 1),
    current_prolog_flag(executable, Swipl),
    source_file(main(_), File),
    format(atom(Goal), 'pong(~d)', [Port]),
    append(Prefix, [Swipl, '-q', '-g', Goal, '-t', halt, File],
           [Program|Args]),
    process_create(path(Program), Args, [process(Pid)]),
    tcp_accept(Server, Socket, _),
    streams(Socket, In, Out),
    image(Image),
    forall(between(1, 2000, _), ping(In, Out, Image)),
    seconds(forall(between(1, 10000, _), ping(In, Out, Image)), Seconds),
    OneWay is Seconds/20000,
    close(Out), close(In),
    tcp_close_socket(Server),
    process_wait(Pid, _).

ping(In, Out, Image) :-
    say(Out, Image),
    hear(In, _).

pong(Port) :-
    tcp_socket(Socket),
    tcp_connect(Socket, '127.0.0.1':Port),
    streams(Socket, In, Out),
    repeat,
    hear(In, Term),
    (   Term == end_of_file
    ->  !
    ;   say(Out, Term),
        fail
    ).

streams(Socket, In, Out) :-
    tcp_setopt(Socket, nodelay),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, buffer_size(65536)),
    set_stream(Out, buffer_size(65536)).

say(Out, Term) :-
    fast_term_serialized(Term, Bytes),
    string_length(Bytes, Length),
    B3 is Length>>16 /\ 255, B2 is Length>>8 /\ 255, B1 is Length /\ 255,
    put_byte(Out, B3), put_byte(Out, B2), put_byte(Out, B1),
    format(Out, '~s', [Bytes]),
    flush_output(Out).

hear(In, Term) :-
    get_byte(In, B3),
    (   B3 == -1
    ->  Term = end_of_file
    ;   get_byte(In, B2), get_byte(In, B1),
        Length is B3<<16 \/ B2<<8 \/ B1,
        read_string(In, Length, Bytes),
        fast_term_serialized(Term, Bytes)
    ).

%   The term that a hop of the agent sends.

image(hop(peer, image('traveller.abcdefgh.1@here@127.0.0.1:12345', Hash,
                      life(none, 1, inf, [], [], false),
                      state([], Facts), [true,main], [], 123.456), known)) :-
    length(Codes, 64),
    maplist([C]>>(C = 0'a), Codes),
    atom_codes(Hash, Codes),
    findall(fact(I, value(I)), between(1, 8, I), Facts0),
    append(Facts0, [left(1000), peer('peer@127.0.0.1:12345')], Facts).
