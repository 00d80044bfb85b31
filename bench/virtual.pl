:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).

/*  Hops between hosts of one process, by an agent that only hops: in
virtual time and in real time, with and without a delay, and with a large
state.  Another agent moves to random neighbours and replaces a fact, alone,
among others, and with delayed hops.  Results are processor times.

    swipl bench/virtual.pl -- 20000 */

:- initialization(main, main).

main([Argument]) :-
    atom_number(Argument, Hops),
    forall(member(Kind, [virtual, real]), warmed_up(Kind)),
    cost(virtual, 0, Hops, Virtual),
    print_figure('bare hops per second of processor, virtual time', Virtual),
    cost(virtual(uniform(0.1, 0.2)), 0, Hops, Delayed),
    print_figure('the same, each with a delay', Delayed),
    cost(real, 0, Hops, Real),
    ratio('a hop in virtual time against real time', Virtual, Real, us,
          'hosts of one process'),
    cost(virtual, 200, Hops, Laden),
    ratio('a hop with 200 facts against one with none', Laden, Virtual, us,
          'virtual time'),
    forall(walk(Name, Agents, Options),
           ( walked(Agents, Options, Hops, Micros),
             print_figure(Name, Micros) )).

walk('walks on 30 hosts per second of processor', 1, []).
walk('the same, of thirty agents', 30, []).
walk('the same, each with a delay', 30, [hop_time(uniform(0.1, 0.2))]).

print_figure(Name, Micros) :-
    Rate is 1.0e6/Micros,
    figure(Name, Rate, '1/s').

warmed_up(Kind) :-
    cost(Kind, 0, 1000, _).

%   cost(+Kind, +Carried, +Hops, -Micros): microseconds for one hop.

cost(Kind, Carried, Hops, Micros) :-
    options(Kind, Options),
    setup_call_cleanup(
        network_start(ring(60), Network, [seed(1)|Options]),
        ( network_property(Network, hosts(Hosts)),
          travelled(Hosts, Carried, Hops, Seconds) ),
        network_stop(Network)),
    Micros is 1.0e6*Seconds/Hops.

options(real, []).
options(virtual, [clock(virtual)]).
options(virtual(Time), [clock(virtual), hop_time(Time)]).

%   walked(+Agents, +Options, +Hops, -Micros): microseconds for one hop of any
%   agent.

walked(Agents, Options, Hops, Micros) :-
    Each is Hops//Agents,
    setup_call_cleanup(
        network_start(grid(5, 6), Network, [clock(virtual),seed(1)|Options]),
        ( network_property(Network, hosts([Home|_])),
          statistics(process_cputime, T0),
          findall(Agent, ( between(1, Agents, _), walker(Each, Home, Agent) ),
                  All),
          forall(member(Agent, All), agent_join(Agent, done, inf)),
          statistics(process_cputime, T1) ),
        network_stop(Network)),
    Micros is 1.0e6*(T1-T0)/(Each*Agents).

walker(Hops, Home, Agent) :-
    agent_create(clauses([ (:- agent(walker, [state([left/1])])),
                           (main :- left(0), !),
                           (main :- neighbours(Hosts), random_member(H, Hosts),
                                    move(H), retract(left(N)), N1 is N-1,
                                    assertz(left(N1)), main) ]),
                 Agent, [host(Home), facts([left(Hops)])]).

travelled([Home|_], Carried, Hops, Seconds) :-
    findall(carried(N), between(1, Carried, N), Load),
    statistics(process_cputime, T0),
    agent_create(clauses([ (:- agent(traveller, [state([left/1,carried/1])])),
                           (main :- left(0), !),
                           (main :- retract(left(N)), N1 is N-1,
                                    assertz(left(N1)), neighbours([H|_]),
                                    move(H), main) ]),
                 Agent, [host(Home), facts([left(Hops)|Load])]),
    agent_join(Agent, done, inf),
    statistics(process_cputime, T1),
    Seconds is T1-T0.
