:- use_module(common).
:- use_module(spent, [spent/4]).
:- use_module(library(typhon)).
:- use_module('../agents/learning/operator', [learning_start/5]).
:- use_module(library(lists), [member/2, nth0/3]).

/*  The cost of a hop of an agent that learns: 25 agents on 30 hosts, in a
maze of 13 by 13, until all have reached the light, at 30 times the speed.

    swipl bench/learning.pl -- 1

The argument is the number of processes.  The processor time is that of all
processes, including the executions of trainers, the messages of agents, and
the making of plans.  It is compared with the processor time of agents that only
travel and wait, as often and as long, in the same network. */

:- initialization(main, main).

main([Argument]) :-
    atom_number(Argument, Processes),
    tmp_file(learning, Log),
    setup_call_cleanup(
        network_start(random(30, 0.2), Network,
                      [ processes(Processes), seed(1), clock(30),
                        hosts([capacity(7)]), log(Log) ]),
        ( network_property(Network, hosts(Hosts)),
          measure(Processes, Hosts) ),
        ( network_stop(Network), delete_file(Log) )).

measure(Processes, Hosts) :-
    spent(Hosts, travel(Hosts), _, Bare),
    spent(Hosts, learn(Hosts), Hops, Cpu),
    name(Processes, 'hops of 25 agents', Name1),
    figure(Name1, Hops, hops),
    name(Processes, 'processor time of a hop', Name2),
    figure(Name2, Cpu, us),
    name(Processes, 'against one of bare travellers', Name3),
    ratio(Name3, Cpu, Bare, us, 'bare travellers').

name(Processes, What, Name) :-
    format(atom(Name), 'learning, ~d processes: ~w', [Processes, What]).

learn(Hosts) :-
    learning_start(Hosts, payloads(learning/maze),
                   [payloads(learning/greedy)],
                   [agents(25), seed(1), settings([size-12])], Agents),
    all_end(Agents).

travel(Hosts) :-
    findall(Agent,
            ( between(1, 25, I),
              Index is I mod 30,
              nth0(Index, Hosts, Host),
              traveller(Program),
              agent_create(Program, Agent,
                           [host(Host), facts([left(60)])])
            ),
            Agents),
    all_end(Agents).

traveller(clauses([ (:- agent(traveller, [state([left/1])])),
                    (main :- left(0), !),
                    (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                             next_host(epsilon_conscientious(0.2), Host),
                             catch(move(Host), error(_, _), true),
                             ignore(receive(_, 1)),
                             main) ])).

all_end(Agents) :-
    forall(member(Agent, Agents), agent_join(Agent, done, 300)).
