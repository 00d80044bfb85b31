:- module(test_solar, []).

% The application with a shared battery: its world, its market, its agents, its
% command.

:- use_module('../../examples/applications/drawn').
:- use_module('../../examples/applications/solar/scene').
:- use_module('../../examples/applications/solar/street').
:- use_module('../lib/common').
:- use_module('../lib/networks').
:- use_module('../lib/fixtures').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(sgml), [load_structure/3]).
:- use_module(library(typhon)).

:- include('../../examples/applications/solar/clearing').

                /*******************************
                *            WORLD             *
                *******************************/

%   A rational number from 0 to Most, in steps of a 999th.

some(Seed, What, Most, X) :-
    drawn(Seed, What, Share),
    X is Most * (truncate(1000*Share) rdiv 999).

random_street(Seed, street(T, battery(Level, 30, 0), Houses)) :-
    some(Seed, time, 200, Time),
    T is truncate(Time),
    some(Seed, level, 30, Level),
    findall(house(N, plant(5, 10, 4), Water, totals(0, 0, 0, 0, 0, 0, 0)),
            ( between(1, 4, N), some(Seed, water(N), 2, Water) ),
            Houses).

random_flows(Seed, Flows) :-
    findall(flow(Produced, Load, grant(Kwh, 10)),
            ( between(1, 4, N),
              some(Seed, produced(N), 3, Produced),
              some(Seed, load(N), 2, Load),
              some(Seed, grant(N), 6, Grant),
              Kwh is Grant-3 ),
            Flows).

total(street(_, _, Houses), N, Sum) :-
    aggregate_all(sum(Kwh),
                  ( member(house(_, _, _, Sums), Houses), arg(N, Sums, Kwh) ),
                  Sum).

conserved(Seed) :-
    random_street(Seed, Street0),
    random_flows(Seed, Flows),
    street_period(Flows, Street0, Street),
    Street0 = street(_, battery(Level0, Capacity, _), _),
    Street = street(_, battery(Level, _, Lost), _),
    findall(Sum, ( between(1, 7, N), total(Street, N, Sum) ),
            [Produced, Used, Bought, Wasted, Taken, Sold, Paid]),
    assertion(forall(member(X, [Used, Bought, Taken, Level, Lost]), rational(X))),
    assertion(Produced+Bought =:= Used+Level-Level0+Wasted+Lost),
    assertion(Sold-Taken =:= Level-Level0+Lost),
    assertion(Paid =:= 10*(Taken-Sold)),
    assertion(( 0 =< Level, Level =< Capacity )),
    assertion(forall(member(X, [Bought, Wasted, Taken, Sold, Lost]), X >= 0)),
    assertion(( Street = street(_, _, Houses),
                forall(member(house(_, _, Water, _), Houses), Water >= 0) )).

one_house(T, Level, Water, Flow, house(1, Plant, Left, Sums), Battery) :-
    Plant = plant(5, 10, 4),
    street_period([Flow],
                  street(T, battery(Level, 8, 0),
                         [house(1, Plant, Water, totals(0, 0, 0, 0, 0, 0, 0))]),
                  street(_, Battery, [house(1, Plant, Left, Sums)])).

near(X, Y) :-
    abs(X-Y) < 1.0e-9.

:- begin_tests(solar_world).

test(energy_is_conserved_exactly,
     [ setup(set_prolog_flag(prefer_rationals, true)),
       cleanup(set_prolog_flag(prefer_rationals, false)) ]) :-
    forall(between(1, 300, Seed), conserved(Seed)).

test(own_production_is_used_first) :-
    one_house(0, 0, 0.2, flow(1, 0.5, grant(-9, 0)),
              house(_, _, Water, totals(_, Used, Bought, Wasted, _, Sold, _)),
              battery(Level, _, _)),
    assertion(near(Used, 0.7)),
    assertion(near(Sold, 0.3)),
    assertion(near(Level, 0.3*0.92)),
    assertion(( Bought =:= 0, near(Wasted, 0), near(Water, 0) )).

test(without_a_grant_surplus_is_wasted_and_demand_is_bought) :-
    one_house(0, 4, 0, flow(1, 0, grant(0, 0)),
              house(_, _, _, totals(_, _, _, Wasted, _, _, _)), _),
    assertion(Wasted =:= 1),
    one_house(0, 4, 0, flow(0, 1, grant(0, 0)),
              house(_, _, _, totals(_, _, Bought, _, _, _, _)), _),
    assertion(Bought =:= 1).

test(a_battery_is_charged_in_two_hours) :-
    battery_limits(battery(0, 8, 0), In, Out),
    assertion(( In =:= 1, Out =:= 0 )),
    battery_limits(battery(8, 8, 0), In1, Out1),
    assertion(( In1 =:= 0, Out1 =:= 1 )).

test(late_boiler_draws_from_the_grid) :-
    one_house(70, 0, 1.0, flow(0, 0, grant(0, 0)), house(_, _, At1745, Sums), _),
    assertion(Sums = totals(_, 0.5, 0.5, _, _, _, _)),
    assertion(At1745 =:= 0.5),
    one_house(71, 0, 0.5, flow(0, 0, grant(0, 0)), house(_, _, At18, _), _),
    assertion(At18 =:= 4).

test(sun_and_loads_match_the_assumptions) :-
    street_new(1, 30, street(_, _, Houses)),
    House = house(_, plant(Peak, Daily, _), _, _),
    findall(Share-Part,
            ( member(House, Houses),
              findall(P-L, ( between(1, 960, T), street_input(1, T, House, P-L) ),
                      Inputs),
              aggregate_all(r(sum(P), sum(L)), member(P-L, Inputs), r(Ps, Ls)),
              Share is Ps/10/Peak,
              Part is Ls/10/Daily ),
            Sums),
    forall(member(Share-Part, Sums),
           ( assertion(( 2 < Share, Share < 5 )),
             assertion(( 0.9 < Part, Part < 1.1 )) )),
    House1 = house(1, plant(4, 10, 4), 0, none),
    street_input(1, 4, House1, AtOne-_),
    assertion(AtOne =:= 0).

:- end_tests(solar_world).

                /*******************************
                *            MARKET            *
                *******************************/

random_orders(Seed, Orders) :-
    findall(at(Ct, N, Kwh),
            ( between(1, 9, N),
              some(Seed, ct(N), 30, Price),
              Ct is float(5*round(Price/5)),
              some(Seed, kwh(N), 4, Amount),
              Kwh is float(Amount-2),
              Kwh =\= 0 ),
            Orders).

in_order(Seed) :-
    random_orders(Seed, Orders),
    (   cleared(Orders, Ct, Traded, Deals)
    ->  aggregate_all(sum(Kwh), ( member(_-Kwh, Deals), Kwh > 0 ), Bought),
        aggregate_all(sum(-Kwh), ( member(_-Kwh, Deals), Kwh < 0 ), Sold),
        assertion(( near(Bought, Traded), near(Sold, Traded) )),
        forall(member(at(Limit, N, Most), Orders),
               ( memberchk(N-Kwh, Deals),
                 assertion(( abs(Kwh) > abs(Most) - 1.0e-9
                           ; Most > 0, Limit =< Ct
                           ; Most < 0, Limit >= Ct )) )),
        forall(( member(N-Kwh, Deals), abs(Kwh) > 1.0e-9 ),
               ( memberchk(at(Limit, N, Most), Orders),
                 assertion(abs(Kwh) =< abs(Most)),
                 assertion(( Kwh > 0 -> Limit >= Ct ; Limit =< Ct )) ))
    ;   assertion(\+ ( member(at(Bid, _, B), Orders), B > 0,
                       member(at(Offer, _, S), Orders), S < 0, Bid >= Offer ))
    ).

:- begin_tests(solar_market).

test(at_the_price_every_bidder_is_satisfied) :-
    forall(between(1, 300, Seed), in_order(Seed)).

test(equal_bids_get_equal_shares, Ct-Deals == 30.0-[a-0.5, b-1.0, c- -1.5]) :-
    cleared([at(30.0, a, 1), at(30.0, b, 2), at(0.0, c, -1.5)], Ct, _, Deals).

test(better_bid_goes_first, Deals == [b-1, a-0.5, c- -1.5]) :-
    cleared([at(10.0, a, 1), at(30.0, b, 1), at(0.0, c, -1.5)], _, _, Deals).

test(scarce_energy_has_the_price_of_the_bids, Ct =:= 30) :-
    cleared([at(30.0, a, 1), at(0.0, c, -0.5)], Ct, _, _).

test(price_is_midway_between_the_bids, Ct =:= 15) :-
    cleared([at(30.0, a, 1), at(0.0, c, -1)], Ct, _, _).

test(no_trade, fail) :-
    cleared([at(10.0, a, 1), at(20.0, c, -1)], _, _, _).

:- end_tests(solar_market).

                /*******************************
                *            AGENTS            *
                *******************************/

:- meta_predicate street(+, +, 0, -).

%   Totals are those after so many hours; Goal is called at the beginning.

street(Options, Hours, Goal, Battery-Totals) :-
    scene_network([], Topology, _),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log('/dev/null')]),
        ( scene_start(Network, [seed(1)|Options]),
          call(Goal),
          Seconds is 3600*Hours,
          network_advance(Network, Seconds),
          scene_totals(Battery, Totals) ),
        ( scene_stop,
          network_stop(Network) )).

exchanged(Totals, Number, Kwh) :-
    memberchk(Number-totals(_, _, _, _, Taken, Sold, _), Totals),
    Kwh is Taken+Sold.

%   The answers of an agent of that program to messages in sequence; Left is a
%   fact in the tuple space of its host.

answers(Name, Left, Messages, Answers) :-
    format(string(Path), 'examples/applications/solar/~w.pl', [Name]),
    project_file(Path, File),
    with_network(edges([a-b]), [clock(virtual), seed(1), log('/dev/null')], _,
        ( remote(a, leave(Left)),
          agent_create(File, Agent, [host(a)]),
          agent_create(clauses([ (:- agent(probe, [state([asked/2])])),
                                 (main :-
                                     asked(To, Asked),
                                     talk(Asked, To, Got),
                                     result(Got)),
                                 talk([], _, []),
                                 (talk([M|Ms], To, [A|As]) :-
                                     send(To, M),
                                     receive(To-A, 10),
                                     talk(Ms, To, As)) ]),
                       Probe, [host(b), facts([asked(Agent, Messages)])]),
          agent_result(Probe, Answers, 100) )).

:- begin_tests(solar_agents).

test(energy_is_conserved,
     [forall(member(Strategy, [none, first, drawn, waiting, auction]))]) :-
    street([strategy(Strategy)], 60, true, battery(Level, _, Lost)-Totals),
    aggregate_all(sum(P+B-U-W),
                  member(_-totals(P, U, B, W, _, _, _), Totals), Kept),
    assertion(near(Kept, Level+Lost)),
    aggregate_all(sum(T), member(_-totals(_, _, _, _, T, _, _), Totals), Taken),
    assertion(( Strategy == none -> Taken =:= 0 ; Taken > 10 )).

test(one_broken_link_excludes_no_house) :-
    street([], 40, unlink(house5, house6), _-Totals),
    forall(between(1, 10, N),
           ( exchanged(Totals, N, Kwh), assertion(Kwh > 0) )).

test(unreachable_houses_are_excluded) :-
    street([], 40, ( unlink(house3, house4), unlink(house6, house7) ), _-Totals),
    forall(between(1, 10, N),
           ( exchanged(Totals, N, Kwh),
             assertion(( between(4, 6, N) -> Kwh =:= 0 ; Kwh > 0 )) )).

test(evening_house_can_delay_its_boiler, L-H == 0.2-0.5) :-
    answers(house, meter(80, -0.2, 3), [bids], [bids(Bids)]),
    assertion(Bids = [at(30.0, _), at(_, _)]),
    Bids = [at(_, L), at(Ct, H)],
    assertion(( 0 < Ct, Ct < 10 )).

test(evening_house_cannot_delay_its_boiler_before_18, Ct =:= 30) :-
    answers(house, meter(70, -0.2, 1), [bids], [bids([_, at(Ct, 0.5)])]).

test(surplus_after_the_boiler_is_offered, true(Kwh == -0.75)) :-
    answers(house, meter(50, 1.0, 0.25), [bids], [bids([at(0.0, Kwh)])]).

test(keeper_grants_available_energy, Kwh == [2, 1, -1, 1, -5]) :-
    answers(keeper, battery(1, 4, 8, 2, 3),
            [ask(1, 2), ask(2, 2), ask(3, -1), ask(4, 2), ask(5, -9)],
            Answers),
    findall(X, member(granted(X), Answers), Kwh).

test(picture, Root == svg) :-
    scene_network([], Topology, _),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log('/dev/null')]),
        ( scene_start(Network, []),
          network_advance(Network, 123400),
          scene_picture(Svg) ),
        ( scene_stop,
          network_stop(Network) )),
    load_structure(string(Svg), [element(Name, _, _)], [dialect(xmlns)]),
    Name = _:Root.

:- end_tests(solar_agents).
