%   A hierarchy above agents that learn and share, while the problem changes.

:- include(ground).
:- use_module('../../agents/hierarchy/operator', [hierarchy_serve/4]).
:- use_module('../../agents/learning/operator', [learning_start/5]).
:- use_module('../../prolog/typhon', [agent_dispose/1, network_property/2, remote/2]).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).

study(lead_learning, "Leaders and an observer of agents that learn, while the work \c
moves").
text("Each of three leaders has a part of the network, four hosts linked with \c
each other. Agents look for the light in a maze; that of one part is large, \c
in rounds 1 to 4 that of the first, then that of the second. There are twelve \c
agents: four in each part, or as an observer divides them, by how much work \c
each part had in the round before. A leader by itself cannot have agents of \c
others.").

vary(control, [leaders, observer]).
fixed(large, 16, assumed("size of a maze")).
fixed(small, 2, assumed("size of the others")).
fixed(parts, 3, assumed("leaders")).
fixed(hosts, 4, assumed("of each part")).
fixed(workers, 4, assumed("of each leader at first")).
fixed(rounds, 8, assumed("the work moves after half of them")).
fixed(rho_max, 4, assumed("agents make few hops between executions")).
fixed(limit, 2000, assumed("host seconds; rounds end long before")).

label(large, "size of the large maze").
label(time, "Seconds until all agents have converged, all rounds").
label(settled, "Time until all agents have converged, without rounds 1 and 5").
label(executions, "Executions of all agents").
label(by_round, "Seconds until all agents have converged").
label(workers, "Agents in the part with the large maze").

network(Case, edges(Edges),
        [hop_time(uniform(Min, Max)), hosts([capacity(Capacity)])]) :-
    Min-Max = Case.hop_time,
    Capacity is Case.parts*Case.workers + 4,    % trainer, leader, observer, customer
    findall(A-B, ( between(1, Case.parts, Part),
                   between(1, Case.hosts, I), between(1, Case.hosts, J),
                   I < J,
                   named(Part, I, A), named(Part, J, B) ),
            Edges).

named(Part, I, Name) :-
    format(atom(Name), 'p~wn~w', [Part, I]).

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(Part, ( between(1, Case.parts, P), part(Hosts, P, Part) ), Parts),
    findall(Home, member([Home|_], Parts), Homes),
    lead(Case, Homes, crews,
         [ algorithm-greedy, rho_max-(Case.rho_max), seed-(Case.seed) ],
         Leaders),
    forall(between(1, Case.rounds, N), served(Case, N, Parts, Leaders)).

part(Hosts, P, Part) :-
    findall(Host, ( member(Host, Hosts), atomic_list_concat([Name|_], n, Host),
                    atom_concat(p, P, Name) ),
            Part).

served(Case, N, Parts, Leaders) :-
    forall(nth1(P, Parts, Part), posed(Case, N, P, Part)),
    round_name(N, Round),
    Timeout is 2*Case.limit,
    hierarchy_serve(Leaders, Round, Parts, Timeout).

round_name(N, Round) :-
    atom_concat(round, N, Round).

%   posed(+Case, +Round, +PartNumber, +Hosts): gives the trainers of a part the
%   maze of this round.

posed(Case, N, P, Hosts) :-
    forall(member(Host, Hosts), without_trainer(Host)),
    ( large(Case, N, P) -> Size = Case.large ; Size = Case.small ),
    Seed is 100*Case.seed + N,
    learning_start(Hosts, payloads(learning/maze), [],
                   [agents(0), seed(Seed), settings([size-Size])], _).

large(Case, N, P) :-
    P is 1 + (N - 1)*2//Case.rounds.

without_trainer(Host) :-
    (   remote(Host, take(trainer(Trainer)))
    ->  agent_dispose(Trainer)
    ;   true
    ).

                /*******************************
                *           MEASURES           *
                *******************************/

view(Log, view{case:(Log.case), rounds:Rounds, events:(Log.events)}) :-
    findall(N-round(Seconds, Workers),
            ( between(1, Log.case.rounds, N),
              a_round(Log, N, Seconds, Workers) ),
            Rounds).

a_round(Log, N, Seconds, Workers) :-
    round_name(N, Round),
    memberchk(event(Start, _, _, asks(Round)), Log.events),
    memberchk(event(End, _, _, served(Round)), Log.events),
    aggregate_all(max(Time),
                  ( member(event(Time, _, _, converged(_, _, _)), Log.events),
                    Time > Start, Time =< End ),
                  Last),
    Seconds is Last - Start,
    large(Log.case, N, P),
    format(atom(Home), '*@p~wn1@*', [P]),
    member(event(_, _, Leader, leads(Round, Settings)), Log.events),
    wildcard_match(Home, Leader),
    memberchk(workers-Workers, Settings),
    !.

measure(time, View, Sum) :-
    aggregate_all(sum(Seconds), member(_-round(Seconds, _), View.rounds), Sum).
measure(settled, View, Sum) :-
    aggregate_all(sum(Seconds),
                  ( member(N-round(Seconds, _), View.rounds), N =\= 1,
                    N =\= View.case.rounds//2 + 1 ),
                  Sum).
measure(executions, View, Count) :-
    aggregate_all(count, member(event(_, _, _, executed(_, _, _, _)), View.events),
                  Count).
measure(by_round, View, Pairs) :-
    findall(N-Seconds, member(N-round(Seconds, _), View.rounds), Pairs).
measure(workers, View, Pairs) :-
    findall(N-Workers, member(N-round(_, Workers), View.rounds), Pairs).

                /*******************************
                *            CLAIMS            *
                *******************************/

claim("with an observer all agents have converged sooner", [ours],
      at([control=observer], time < at([control=leaders], time))).
claim("with an observer all converge sooner, without rounds 1 and 5", [ours],
      at([control=observer], settled < at([control=leaders], settled))).
claim("an observer saves a fifth of the time, without rounds 1 and 5", [ours],
      at([control=observer], settled < 0.8*at([control=leaders], settled))).
claim("an observer needs no more executions", [ours],
      at([control=observer], executions =< at([control=leaders], executions))).

plot(lead_learning, "Agents that learn, while the work moves",
     lines([x(control), y([time, settled, executions])])).
plot(lead_learning_rounds, "Agents that learn, round by round",
     over_time([ y([by_round, workers]), line(control), xlabel("round") ])).
