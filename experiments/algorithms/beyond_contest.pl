%   Chapters 4 and 3 together (section 4.5): three sets of agents learn with an
%   algorithm each, and the sieve selects among the solutions that they find.

:- use_module('../../agents/learning/operator', [learning_start/5]).
:- use_module('../../agents/sieve/operator', [antigen_attack/2, sieve_start/3]).
:- use_module('../../prolog/typhon',
              [ agent_join/3, log_events/2, network_advance/2,
                network_property/2 ]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module('../sieve/rounds', [event_rounds/3, population/3]).
:- use_module(printers, [mean_quality/4, settings_used/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [member/2, memberchk/2, nth0/3, nth1/3, sum_list/2]).

study(contest, "Learning algorithms, and the sieve that selects a solution").
text("Three sets of agents learn settings for printers, one set after the other, \c
each with an algorithm of its own. All solutions found are then the antibodies of \c
the sieve: printers ask for settings, and judge those that they are given.").

fixed(algorithms, [climb, genetic, swarm], assumed("one for each set")).
fixed(agents, 3, assumed("of each set")).
fixed(topology, random(30, 0.2), assumed("six links at a host")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(attacked, 10, assumed("printers in a round")).
fixed(rounds, 15, assumed("as in Figure 3.4")).
fixed(round, 16, assumed("as in chapter 3")).
fixed(sieve, [ omega-200, patience-1.2, gather-1.2 ],
      assumed("as in chapter 3")).
fixed(limit, 6000, assumed("host seconds, for each set")).

label(found, "Different solutions found").
label(share, "Agents that carry the leading solution (%)").
label(chosen, "Mean quality of the leading solution, on all printers").
label(mean, "Mean quality of all solutions").
label(best, "Mean quality of the best solution").
label(rank, "Rank of the leading solution by its quality").

network(Case, Case.topology,
        [hop_time(uniform(Min, Max)), hosts([capacity(40)])]) :-
    Min-Max = Case.hop_time.

                /*******************************
                *              RUN             *
                *******************************/

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    forall(member(Algorithm, Case.algorithms), learned(Case, Hosts, Algorithm)),
    network_property(Network, log(Log)),
    log_events(Log, Events),
    candidates(Case, Events, Candidates),
    Settings = [ candidates-Candidates, printers-(Case.seed), seed-(Case.seed)
               | Case.sieve ],
    sieve_start(Hosts, payloads(sieve/solutions), [settings(Settings)]),
    chance_seed(Case.seed, Chance),
    attacks(Case.rounds, Case, Hosts, Network, Chance).

learned(Case, Hosts, Algorithm) :-
    learning_start(Hosts, payloads(learning/settings),
                   [payloads(learning/Algorithm)],
                   [ agents(Case.agents), seed(Case.seed),
                     settings([rho_max-4, printers-(Case.seed)]) ], Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, Case.limit)).

attacks(0, _, _, _, _) :-
    !.
attacks(Rounds, Case, Hosts, Network, Chance0) :-
    chance_sample(Case.attacked, Hosts, Attacked, Chance0, Chance),
    antigen_attack(Attacked, print),
    network_advance(Network, Case.round),
    Left is Rounds - 1,
    attacks(Left, Case, Hosts, Network, Chance).

%   The sets learn one after the other, so the agents are created in the order of
%   the algorithms.

candidates(Case, Events, Candidates) :-
    findall(Agent,
            ( member(event(_, _, Agent, created), Events),
              sub_atom(Agent, 0, _, _, learner) ),
            Agents),
    findall(found(Algorithm, Settings),
            ( nth0(I, Agents, Agent),
              Set is I // Case.agents,
              nth0(Set, Case.algorithms, Algorithm),
              memberchk(event(_, _, Agent, converged(_, _, Actions)), Events),
              settings_used(Actions, Settings) ),
            Found),
    sort(Found, Candidates).

                /*******************************
                *           MEASURES           *
                *******************************/

%   Kinds are Quality-found(Algorithm, Settings), the best first, rank is that of
%   the kind that most agents carry in the end, share their percentage.

view(Log, view{kinds:Kinds, rank:Rank, share:Share}) :-
    candidates(Log.case, Log.events, Candidates),
    findall(Quality-Found,
            ( member(Found, Candidates), Found = found(_, Settings),
              mean_quality(Log.case.seed, Log.hosts, Settings, Quality) ),
            Kinds0),
    sort(1, @>=, Kinds0, Kinds),
    event_rounds(Log.events, [0], Rounds),
    population(Rounds, 1, Population),
    aggregate_all(sum(N), member(N-_, Population), All),
    aggregate_all(max(N, Found), member(N-Found, Population), max(Most, First)),
    Share is 100*Most/All,
    nth1(Rank, Kinds, _-First),
    !.

measure(found, View, Count) :-
    length(View.kinds, Count).
measure(share, View, View.share).
measure(rank, View, View.rank).
measure(chosen, View, Quality) :-
    nth1(View.rank, View.kinds, Quality-_).
measure(best, View, Quality) :-
    View.kinds = [Quality-_|_].
measure(mean, View, Mean) :-
    findall(Quality, member(Quality-_, View.kinds), All),
    sum_list(All, Sum),
    length(All, Count),
    Mean is Sum/Count.

claim("the leading solution is better than the mean of those found", [ours],
      chosen > mean).
claim("the leading solution is at most 0.01 short of the best", [ours],
      chosen >= best - 0.01).
claim("more than half of the agents carry the leading solution", [ours],
      share > 50).
