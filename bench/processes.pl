:- use_module(common).
:- use_module(spent).
:- use_module(library(typhon)).
:- use_module(library(lists), [append/3, member/2]).

/*  The cost of a hop in a network of many processes compared with two: a ring
    with one host in each process, and eight agents per process that move round
    it. */

:- initialization(main, main).

main(_) :-
    round_ring(64, Many),
    round_ring(2, Two),
    ratio('CPU of a hop, 64 processes against 2', Many, Two, us,
          'eight agents for each').

%   round_ring(+Processes, -Cpu): microseconds for each hop, of all processes.

round_ring(Processes, Cpu) :-
    setup_call_cleanup(
        network_start(ring(Processes), Network, [processes(Processes)]),
        ( network_property(Network, hosts(Hosts)),
          Agents is 8*Processes,
          circle(Hosts, Agents, Processes),       % opens the connections
          Hops is 40 000//Agents,
          spent(Hosts, circle(Hosts, Agents, Hops), _, Cpu)
        ),
        network_stop(Network)).

circle([First|Others], Count, Hops) :-
    append(Others, [First], Nexts),
    findall(next(Here, Next),
            consecutive([First|Others], Nexts, Here, Next),
            Ways),
    Program = clauses([ (:- agent(circler, [state([left/1])])),
                        (main :- left(0), !),
                        (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                                 here(Here), next(Here, Next), move(Next),
                                 main)
                      | Ways ]),
    findall(Agent,
            ( between(1, Count, _),
              agent_create(Program, Agent, [host(First), facts([left(Hops)])])
            ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 300)).

consecutive([A|_], [B|_], A, B).
consecutive([_|As], [_|Bs], A, B) :-
    consecutive(As, Bs, A, B).
