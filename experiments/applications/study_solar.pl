%   Houses that share a battery, by auctions or in the order of their requests.

:- use_module('../../examples/applications/solar/scene',
              [scene_network/3, scene_start/2, scene_stop/0, scene_totals/2]).
:- use_module('../../prolog/typhon', [network_advance/2, remote/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, sum_list/2]).

study(solar, "A battery that ten houses share").
text("Ten houses with solar panels, a boiler each, and one battery, in April. \c
Nothing is shared (none); each house asks the battery for energy once in a \c
quarter of an hour, at a fixed moment of its own (first), or at a random \c
moment (drawn), or at a random moment, but for its boiler only when that \c
would be late (waiting); or an agent moves round for bids, and clears the \c
market (auction). examples/applications/solar/street.pl defines the world, \c
its equations and assumptions.").

vary(strategy, [none, first, drawn, waiting, auction]).
vary(capacity, [15, 30, 60]).
fixed(days, 14, assumed("clear and dull days")).

network(_, Topology, Options) :-
    scene_network([], Topology, Options).

%   Ends at 18:00, when all boilers have the energy they need.

run(Case, Network) :-
    call_cleanup(
        ( scene_start(Network, [ seed(Case.seed), strategy(Case.strategy),
                                 capacity(Case.capacity) ]),
          Seconds is 86400*Case.days - 21600,
          network_advance(Network, Seconds),
          scene_totals(Battery, Totals),
          remote(battery, log(totals(Battery, Totals))) ),
        scene_stop).

label(bought, "Energy bought from the grid (kWh)").
label(wasted, "Energy wasted (kWh)").
label(fairness, "Jain's index of the shares of missing energy from the street").
label(reward, "Correlation of energy given and gain of a house").
label(crossings, "Hops, or links crossed by messages, in an hour").

measure(bought, Log, Kwh) :-
    total(Log, 3, Kwh).
measure(wasted, Log, Kwh) :-
    total(Log, 4, Kwh).
measure(fairness, Log, Index) :-
    findall(Share,
            ( house(Log, totals(_, _, Bought, _, Taken, _, _)),
              Share is Taken/(Taken+Bought) ),
            Shares),
    jain(Shares, Index).
measure(reward, Log, Correlation) :-
    findall(Sold-Gain,
            ( house(Log, totals(_, _, _, _, Taken, Sold, Paid)),
              Gain is 30*Taken-Paid ),
            Pairs),
    correlation(Pairs, Correlation).
measure(crossings, Log, Hourly) :-
    Hours is 24*Log.case.days - 6,
    crossings(Log.case.strategy, Log, Count),
    Hourly is Count/Hours.

house(Log, Sums) :-
    member(event(_, _, _, totals(_, Totals)), Log.events),
    member(_-Sums, Totals).

total(Log, N, Sum) :-
    aggregate_all(sum(Kwh), ( house(Log, Sums), arg(N, Sums, Kwh) ), Sum).

%   Jain, Chiu and Hawe, DEC-TR-301, 1984: 1 for equal shares, 1/N if one of N
%   shares is everything.

jain(Shares, Index) :-
    sum_list(Shares, Sum),
    Sum > 0,
    aggregate_all(r(count, sum(S*S)), member(S, Shares), r(Count, Squares)),
    Index is Sum*Sum/(Count*Squares).

correlation(Pairs, R) :-
    aggregate_all(r(count, sum(X), sum(Y)), member(X-Y, Pairs), r(N, SumX, SumY)),
    aggregate_all(r(sum((X-SumX/N)*(Y-SumY/N)), sum((X-SumX/N)**2),
                    sum((Y-SumY/N)**2)),
                  member(X-Y, Pairs), r(XY, XX, YY)),
    XX*YY > 0,
    R is XY/sqrt(XX*YY).

%   The keeper of the battery answers each request; a request and its answer
%   take the shorter way on the ring.

crossings(none, _, 0) :-
    !.
crossings(auction, Log, Hops) :-
    !,
    aggregate_all(max(Hops), member(event(_, _, _, cleared(_, _, Hops)), Log.events),
                  Hops).
crossings(_, Log, Links) :-
    aggregate_all(sum(2*min(House, 11-House)),
                  member(event(_, _, _, granted(House, _)), Log.events), Links).

claim("by auctions less is bought from the grid than without sharing", [],
      at([strategy=auction], bought) < at([strategy=none], bought)).
claim("by auctions less is bought than in the order of requests", [],
      at([strategy=auction], bought) < at([strategy=drawn], bought)).
claim("by auctions less is bought than if boilers wait", [],
      at([strategy=auction], bought) < at([strategy=waiting], bought)).
claim("by auctions less is wasted than in the order of requests", [],
      at([strategy=auction], wasted) < at([strategy=drawn], wasted)).
claim("the auction is fairer than fixed moments", [],
      at([strategy=auction], fairness) > at([strategy=first], fairness)).
claim("the auction is fairer than random moments and waiting boilers", [],
      at([strategy=auction], fairness) > at([strategy=waiting], fairness)).
claim("by auctions houses that give more gain more", [],
      at([strategy=auction], reward > 0)).
claim("if boilers wait, houses that give more do not gain more", [],
      at([strategy=waiting], reward =< 0)).
claim("the agent makes fewer hops than messages cross links", [],
      at([strategy=auction], crossings) < at([strategy=first], crossings)).
claim("with a larger battery less is bought", [],
      at([strategy=auction], falls(bought, along(capacity)))).

plot(solar,
     "Energy bought and wasted, and fairness, by capacity of the battery",
     lines([x(capacity), y([bought, wasted, fairness, reward]), line(strategy),
            xlabel("Capacity of the battery (kWh)")])).
