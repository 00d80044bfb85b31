% Clones that vote: they outvote a host that lies.     swipl examples/voting.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    network_start(star(5), Network, []),
    network_property(Network, hosts([Home, Liar|Honest])),
    forall(member(Host, Honest), remote(Host, leave(price(12)))),
    remote(Liar, leave(price(99))),
    voter(Program),
    agent_create(Program, Agent, [host(Home)]),
    agent_result(Agent, Verdict, 20), format("~w~n", [Verdict]),
    network_stop(Network).

% A host can kill, delay or copy the agents on it, and lie to them.  So clones
% ask several hosts, and the majority decides.

voter(clauses(
    [ (:- agent(voter, [state([vote/2])])),
      (main :- self(Me), neighbours(Hosts), ask(Hosts, Me),
               length(Hosts, Voters), collect(Voters), verdict(Voters)),
      ask([], _),
      (ask([Host|Hosts], Me) :- clone(Who), part(Who, Host, Me), ask(Hosts, Me)),
      part(parent(_), _, _),
      (part(clone(_), Host, Me) :-
           move(Host), sense(price(Price)), send(Me, vote(Host, Price)), dispose),
      (collect(0) :- !),
      (collect(N) :-                    % a silent voter has no vote
           (  receive(_-vote(Host, Price), 5)
           -> assertz(vote(Host, Price)), N1 is N-1, collect(N1)
           ;  true )),
      (verdict(Voters) :-
           aggregate_all(bag(Price), vote(_, Price), Prices),
           aggregate_all(max(N, P), aggregate(count, member(P, Prices), N),
                         max(Most, Price)),
           (  2*Most > Voters -> result(agreed(Price, Most, of(Voters)))
           ;  result(disagreed(Prices)) ))
    ])).
