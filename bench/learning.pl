:- use_module(common).
:- use_module(library(typhon)).
:- use_module('../agents/learning/operator', [learning_start/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, nth0/3]).

/*  What a hop of an agent that learns costs: 25 of them on 30 hosts, in a
maze of 13 by 13, until all have reached the light, at 30 times the speed.

    swipl bench/learning.pl -- 1

The argument is the number of processes.  The processor time is that of all
processes, and everything is in it: what trainers execute, what agents ask
and answer, how they make plans.  It is compared with that of agents that
only travel and wait, as often and as long, in the same network. */

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

                /*******************************
                *           MEASURES           *
                *******************************/

:- meta_predicate spent(+, 0, -, -).

%   Cpu is that of all processes, in microseconds for each hop.

spent(Hosts, Goal, Hops, Cpu) :-
    arrived(Hosts, Hops0),
    processor_time(Hosts, Cpu0),
    call(Goal),
    processor_time(Hosts, Cpu1),
    arrived(Hosts, Hops1),
    Hops is Hops1 - Hops0,
    Cpu is (Cpu1 - Cpu0) / Hops * 1.0e6.

arrived(Hosts, Count) :-
    aggregate_all(sum(N),
                  ( member(Host, Hosts),
                    host_property(Host, hop_time(in, stats(N, _, _, _))) ),
                  Count).

%   One host of each process is asked, and this process.

processor_time(Hosts, Seconds) :-
    statistics(process_cputime, Own),
    findall(Endpoint-Host,
            ( member(Host, Hosts),
              atomic_list_concat([_, Endpoint], @, Host) ),
            Pairs0),
    sort(1, @<, Pairs0, Pairs),
    (   Pairs = [_]                     % the hosts are in this process
    ->  Seconds = Own
    ;   aggregate_all(sum(S),
                      ( member(_-Host, Pairs),
                        remote(Host, statistics(process_cputime, S)) ),
                      There),
        Seconds is Own + There
    ).
