:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).

/*  Many agents in one process: creation, memory, and their effect on others.
    */

:- initialization(main, main).

main([_]) :-
    host_start(here),
    resident_program(Program),
    created(Program, 2000, _),          % warm up
    idle(Program),
    with_peer([env], costs),
    host_stop(here).

resident_program(clauses([ (:- agent(idle, [state([seen/2])])),
                           (on_message(_, M) :- assertz(seen(M, now)))
                         | Rest ])) :-
    findall(seen(I, value(I)), between(1, 10, I), Facts),
    findall((rule(I, X) :- Y is X+I, Y > 0), between(1, 29, I), Rules),
    append(Facts, Rules, Rest).

created(Program, Count, Seconds) :-
    seconds(forall(between(1, Count, _), agent_create(Program, _)), Seconds).

idle(Program) :-
    garbage_collect,
    resident_bytes(B0),
    threads(T0),
    created(Program, 10000, Seconds),
    Rate is 10000/Seconds,
    figure('agents created per second', Rate, '1/s'),
    created(Program, 88000, _),
    settled(100000),
    resident_bytes(B1),
    threads(T1),
    MB is (B1-B0)/1.0e6,
    figure('100,000 idle agents of 30 clauses and 10 facts', MB, 'MB'),
    Threads is T1-T0,
    figure('threads more for 100,000 idle agents', Threads, threads).

%   All agents are idle: the last one answers a request.

settled(Count) :-
    host_property(here, load(Count)),
    agent_property(Agent, state(resident)),
    !,
    payload_attach(Agent, payload(probe, [], [])).

                /*******************************
                *         COSTS OF HOPS        *
                *******************************/

costs(Peer) :-
    hop_cost(10, 2000, Peer, _),        % warm up
    forall(member(Facts-Hops, [10-4000, 100-4000, 1000-1000, 10000-200]),
           ( hop_cost(Facts, Hops, Peer, Micro),
             atomic_list_concat(['a hop with ', Facts,
                                 ' facts, 100,000 residents'], Name),
             figure(Name, Micro, us)
           )),
    hop_cost(10, 6000, Peer, Full),
    fewer(1000),
    hop_cost(10, 6000, Peer, Some),
    fewer(10),
    hop_cost(10, 6000, Peer, Few),
    ratio('a hop with 100,000 residents against 10', Full, Few, us,
          '10 residents'),
    ratio('a hop with 1,000 residents against 10', Some, Few, us,
          '10 residents').

hop_cost(Count, Hops, Peer, Micro) :-
    Rounds is Hops//2,
    findall(fact(I, value(I)), between(1, Count, I), Facts),
    seconds(( agent_create(clauses(
                  [ (:- agent(carrier, [state([left/1,peer/1,fact/2])])),
                    (main :- left(0), !),
                    (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                             peer(P), move(P), home(H), move(H), main) ]),
                  Agent, [facts([left(Rounds), peer(Peer)|Facts])]),
              agent_join(Agent, done, 600)
            ),
            Seconds),
    Micro is Seconds/Hops*1.0e6.

fewer(Count) :-
    findall(Agent, agent_property(Agent, state(resident)), Agents),
    length(Agents, Now),
    Surplus is Now-Count,
    length(Gone, Surplus),
    append(Gone, _, Agents),
    forall(member(Agent, Gone), agent_dispose(Agent)).
