% How long does an explorer need to see every host of a grid?
%
%     swipl experiments/study.pl -- examples/studies/coverage.pl --runs 10

:- use_module(library(typhon)).

study(coverage, "An explorer sees every host of a grid").
text("One chooses the next host by chance, the other prefers hosts that it \c
has not seen, or not for long.").

vary(strategy, [random, conscientious]).
vary(side, [3, 5, 7, 9]).
fixed(hop_time, 0.2-0.4, assumed("as between our robots")).
fixed(limit, 100000, assumed("host seconds; runs end long before")).
derive(hosts, Case, N) :- N is Case.side*Case.side.

network(Case, grid(N, N), [hop_time(uniform(Min, Max))]) :-
    N = Case.side,
    Min-Max = Case.hop_time.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    Hosts = [Corner|_],
    agent_create(agents(explorer), Agent,
                 [ host(Corner),
                   facts([strategy(Case.strategy), unseen(Hosts)]) ]),
    agent_join(Agent, done, Case.limit).

measure(hops, Log, Hops) :-
    findall(x, member(event(_, _, _, left(_)), Log.events), Seen),
    length(Seen, Visits),
    Hops is Visits - 1.
measure(time, Log, Time) :-
    member(event(Time, _, _, left(0)), Log.events).
measure(left, Log, Series) :-
    findall(Time-Left, member(event(Time, _, _, left(Left)), Log.events),
            Changes),
    stepped(Changes, 10, 200, Series).

label(hops, "Hops until every host was seen").
label(time, "Host seconds until then").
label(left, "Hosts that it has not seen").

claim("conscientious is faster", [], least(time, strategy=conscientious)).
claim("larger grids take longer", [], rises(time, along(side))).
claim("chance needs three times as many hops in the largest grid", [],
      at([side=9], at([strategy=random], hops)
                   > 3*at([strategy=conscientious], hops))).

plot(coverage, "An explorer sees every host",
     lines([ x(side), y([hops, time]), line(strategy), log(hops) ])).
plot(progress, "What is left to see in the largest grid",
     over_time([ y(left), line(strategy), where([side=9]) ])).
