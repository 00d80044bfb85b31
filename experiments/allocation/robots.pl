%   Chapter 7: a network of robots, and the start hosts of allocators.
%
%   Gives: network/3, places/3, tasks/2, and parameters that a study may
%   redefine.

:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module('../../prolog/typhon', [network_property/2]).
:- use_module('../../agents/allocation/operator', [robot_start/3]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).

fixed(links, dynamic, printed("section 7.6")).
fixed(hosts, 100, printed("section 7.6.1")).
fixed(eligible, 15, printed("section 7.6.1")).
fixed(required, 10, printed("section 7.6.1")).
fixed(allocators, 5, printed("section 7.6.3")).
fixed(probability, 0.06,
      assumed("G(n,p) is printed in section 7.5, not p: six links at a \c
host of 100")).
fixed(change, 2-4,
      assumed("seconds from one change of its links to the next, of each \c
host; with 10-20 few of ANTA's trees break")).
fixed(hop_time, 0.05-0.15,
      assumed("an allocator alone backs off for 5.16 s, by equations 7.3 and \c
7.5 twice 31 hops: not that of chapter 5")).
fixed(duration, 5, assumed("seconds a robot takes for its part")).
fixed(bi_min, 10, printed("section 7.6")).
fixed(bi_max, 500, printed("section 7.6")).
fixed(beta, 1, assumed("exponent of equation 7.5 at the first back-off: so many \c
it has experienced with this one, as in CSMA/CD")).
fixed(sending, at_once, assumed("messages do not wait for each other")).
fixed(sharing, none, printed("section 7.8: allocators tell each other nothing")).
fixed(limit, 50000, assumed("seconds; a run that takes longer fails")).

network(Case, random(Case.hosts, Case.probability),
        [hop_time(uniform(Min, Max))|Changes]) :-
    Min-Max = Case.hop_time,
    findall(dynamic(links(uniform(From, To), 0.5, 0.5)),
            ( Case.links == (dynamic), From-To = Case.change ),
            Changes).

%   places(+Case, +Network, -Starts): starts the robots, and chooses the start
%   hosts of allocators.  The seed determines both, for every mechanism alike;
%   smaller numbers give a prefix of the same choice.

places(Case, Network, Starts) :-
    network_property(Network, hosts(Hosts)),
    length(Hosts, Count),
    chance_seed(Case.seed, Chance0),
    chance_sample(Count, Hosts, Order, Chance0, Chance),
    chance_sample(Case.allocators, Hosts, Starts, Chance, _),
    length(Able, Case.eligible),
    append(Able, Others, Order),
    !,
    forall(member(Host, Able), robot_start(Host, [push], [])),
    forall(member(Host, Others), robot_start(Host, [carry], [])).

tasks(Case, Tasks) :-
    numlist(1, Case.allocators, Names),
    findall(task(Name, [Case.required-[push]], [duration(Case.duration)]),
            member(Name, Names), Tasks).
