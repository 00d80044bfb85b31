% Clones that vote: a host that lies is outvoted.      swipl examples/voting.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- use_module(library(lists), [member/2]).
:- initialization(main, main).

main :-
    network_start(star(5), Network, []),
    network_property(Network, hosts([Home|Others])),
    forall(member(Host, Others), remote(Host, leave(price(flour, 12)))),
    Others = [Liar|_],
    remote(Liar, ( take(price(flour, 12)), leave(price(flour, 99)) )),
    voter(Program),
    agent_create(Program, Agent, [host(Home), facts([question(flour)])]),
    agent_result(Agent, Verdict, 20),
    format("~w~n", [Verdict]),
    network_stop(Network).

% No platform can keep a host from killing, delaying or copying what stands on
% it, or from lying to it.  So the question is put on several, by a clone on
% each, and what most say counts.  Who says nothing in time has no vote.

voter(clauses(
    [ (:- agent(voter, [state([question/1, vote/2])])),

      (main :-
           self(Me), neighbours(Hosts),
           ask(Hosts, Me),
           length(Hosts, Voters),
           collect(Voters),
           verdict(Voters, Verdict),
           result(Verdict)),

      ask([], _),
      (ask([Host|Hosts], Me) :-
           clone(Who), part(Who, Host, Me), ask(Hosts, Me)),

      part(parent(_), _, _),
      (part(clone(_), Host, Me) :-
           move(Host),
           question(What),
           sense(price(What, Price)),
           here(Here),
           send(Me, vote(Here, Price)),
           dispose),

      (collect(0) :- !),
      (collect(N) :-
           receive(_-vote(Host, Price), 5), !,
           (   vote(Host, _)            % who votes twice is not heard twice
           ->  true
           ;   assertz(vote(Host, Price))
           ),
           N1 is N-1,
           collect(N1)),
      collect(_),

      (verdict(Voters, Verdict) :-
           findall(Count-Price,
                   aggregate(count, Host, vote(Host, Price), Count), Counts),
           (   max_member(Most-Price, Counts),
               2*Most > Voters
           ->  Verdict = agreed(Price, Most, of(Voters))
           ;   Verdict = disagreed(Counts)
           ))
    ])).
