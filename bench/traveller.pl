:- module(bench_traveller,
          [ traveller/1,                % -Program
            travelled/4,                % +Agents, +Hops, +Peer, -Rates
            processor_time/2            % +Peer, -Seconds
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(common).
:- use_module('../prolog/typhon').

/** <module> The agent that the benchmarks of hops send

It has 30 static clauses and 10 facts, and moves back and forth between the
host `here` and one in another process.

*Threading*: any thread; no state.
*/

%!  traveller(-Program) is det.
%
%   The agent is created with the facts left(Rounds) and peer(Address).

traveller(clauses([ (:- agent(traveller, [state([left/1,peer/1,fact/2])])),
                    (main :- left(0), !),
                    (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                             peer(P), move(P), home(H), move(H), main)
                  | Rest ])) :-
    findall(fact(I, value(I)), between(1, 8, I), Facts),
    findall((rule(I, X) :- Y is X+I, Y > 0, other(Y)), between(1, 27, I),
            Rules),
    append(Facts, [other(_)|Rules], Rest).

%!  travelled(+Agents, +Hops, +Peer, -Rates) is det.
%
%   Agents agents make Hops hops together. Rates is rates(PerSecond,
%   PerCpuSecond), hops by the clock and by the processor time of both
%   processes.

travelled(Agents, Hops, Peer, rates(PerSecond, PerCpu)) :-
    Each is Hops//(2*Agents),
    processor_time(Peer, Cpu0),
    seconds(round_trips(Agents, Each, Peer), Seconds),
    processor_time(Peer, Cpu1),
    Made is 2*Each*Agents,
    PerSecond is Made/Seconds,
    PerCpu is Made/(Cpu1-Cpu0).

round_trips(Agents, Each, Peer) :-
    traveller(Program),
    findall(Agent,
            ( between(1, Agents, _),
              agent_create(Program, Agent, [facts([left(Each), peer(Peer)])])
            ),
            List),
    forall(member(Agent, List), agent_join(Agent, done, 300)).

%!  processor_time(+Peer, -Seconds) is det.
%
%   Sum of the processor times of this process and of the process of Peer.

processor_time(Peer, Seconds) :-
    statistics(process_cputime, Here),
    remote(Peer, statistics(process_cputime, There)),
    Seconds is Here+There.
