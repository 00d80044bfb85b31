:- module(allocation_ground,
          [ ground/4,                   % +Case, +Seed, +Hosts, -Ground
            case_topology/3,            % +Case, +Degree, -Topology
            options_case/2              % +Options, -Case
          ]).
:- use_module('../../prolog/typhon/base/chance', [chance_sample/5, chance_seed/2]).
:- use_module(library(lists), [append/3]).
:- use_module(library(option), [option/2]).

/** <module> Who has which robot, and where allocators begin

A case is case(Mechanism, Links, Hosts, Eligible, Required, Allocators):
so many allocators, each of which requires so many robots of those that are
eligible; see cases.pl.

*Threading*: pure.
*/

%!  ground(+Case, +Seed:integer, +Hosts:list(atom), -Ground) is det.
%
%   Ground is ground(Able, Others, Starts): the Hosts whose robots are
%   eligible, the other ones, and the hosts where allocators begin.  All of
%   it follows from Seed, and is the same for every mechanism.  Fewer
%   eligible robots are among the more ones, fewer starts among the more.

ground(case(_, _, _, Eligible, _, Allocators), Seed, Hosts,
       ground(Able, Others, Starts)) :-
    length(Hosts, Count),
    chance_seed(Seed, Chance0),
    chance_sample(Count, Hosts, Order, Chance0, Chance),
    length(Able, Eligible),
    append(Able, Others, Order),
    !,
    chance_sample(Count, Hosts, All, Chance, _),
    length(Starts, Allocators),
    append(Starts, _, All),
    !.

%!  case_topology(+Case, +Degree, -Topology) is det.
%
%   Topology, for network_start/3, has Degree links at a host on average,
%   whatever the number of hosts.

case_topology(case(_, _, Hosts, _, _, _), Degree, random(Hosts, P)) :-
    P is min(1.0, Degree/max(1, Hosts - 1)).

%!  options_case(+Options, -Case) is det.
%
%   The case that mechanism(M), links(L), hosts(N), eligible(N), required(N)
%   and allocators(N) of Options make.

options_case(Options, case(Mechanism, Links, Hosts, Eligible, Required,
                           Allocators)) :-
    option(mechanism(Mechanism), Options),
    option(links(Links), Options),
    option(hosts(Hosts), Options),
    option(eligible(Eligible), Options),
    option(required(Required), Options),
    option(allocators(Allocators), Options).
