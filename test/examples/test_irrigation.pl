:- module(test_irrigation, []).

% The application that irrigates fields: its world, its agents, its command.

:- use_module('../../examples/applications/irrigation/fields').
:- use_module('../../examples/applications/irrigation/scene').
:- use_module('../lib/common').
:- use_module('../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, numlist/3, sum_list/2]).
:- use_module(library(plunit)).
:- use_module(library(sgml), [load_structure/3]).
:- use_module(library(typhon)).

%   Of soil with 100 mm between field capacity and wilting.

field(Depletion, field(1, soil(0.3, 0.1, 0.5, 1.2, 0.8, 0), Depletion,
                       totals(0, 0, 0))).

hour(Weather, Opened, Depletion0, Depletion, Totals) :-
    field(Depletion0, Field),
    field_hour(Weather, Opened, Field, field(_, _, Depletion, Totals)).

near(X, Y) :-
    abs(X-Y) < 1.0e-9.

:- begin_tests(irrigation_world).

test(crop_takes_water) :-
    hour(0.5-0, 0, 20, D, Totals),
    assertion(near(D, 20.6)),
    assertion(Totals = totals(_, _, 0)).

test(stress_reduces_water_uptake) :-
    hour(0.5-0, 0, 75, D, totals(_, _, Hours)),
    assertion(near(D, 75.3)),
    assertion(Hours =:= 1).

test(irrigation_has_losses) :-
    hour(0-0, 5, 20, D, totals(Mm, _, _)),
    assertion(near(D, 16)),
    assertion(Mm =:= 5).

test(too_much_rain_drains) :-
    hour(0-30, 0, 20, D, totals(_, Mm, _)),
    assertion(D =:= 0),
    assertion(near(Mm, 10)).

test(wilting_point, Ks =:= 0) :-
    field(100, Field),
    field_stress(Field, Ks).

test(moisture) :-
    field(50, Field),
    field_moisture(Field, Share),
    assertion(near(Share, 0.2)).

test(weather_matches_the_assumptions) :-
    numlist(0, 23999, Hours),
    findall(E, ( member(H, Hours), weather(1, H, E, _) ), Es),
    findall(R, ( member(H, Hours), weather(1, H, _, R) ), Rs),
    sum_list(Es, E),
    sum_list(Rs, R),
    assertion(( 4.5 < E/1000, E/1000 < 5.5 )),
    assertion(( 0.8 < R/1000, R/1000 < 1.2 )).

:- end_tests(irrigation_world).

                /*******************************
                *            AGENTS            *
                *******************************/

:- meta_predicate season(+, +, -, 0).

season(Options, Days, Network, Goal) :-
    scene_network([], Topology, _),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log('/dev/null')]),
        ( scene_start(Network, [seed(1)|Options]),
          Seconds is 86400*Days,
          network_advance(Network, Seconds),
          once(Goal) ),
        ( scene_stop,
          network_stop(Network) )).

given(Mm) :-
    scene_totals(_, Totals),
    findall(Given, member(_-totals(Given, _, _), Totals), All),
    sum_list(All, Mm).

alone :-
    forall(between(1, 6, N),
           ( atom_concat(field, N, Host), unlink(office, Host) )).

there(Host) :-
    remote(Host, host_load(1)).

:- begin_tests(irrigation_agents).

test(gardeners_go_to_their_fields) :-
    season([down(0)], 1, _,
           ( forall(member(Host, [field1, field6]), assertion(there(Host))),
             assertion(remote(office, host_load(0))) )).

test(gardeners_wait_for_a_link) :-
    scene_network([], Topology, _),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(virtual), seed(1), log('/dev/null')]),
        ( unlink(office, field1),
          scene_start(Network, [down(0)]),
          network_advance(Network, 1800),
          assertion(remote(field1, host_load(0))),
          link(office, field1),
          network_advance(Network, 7200),
          assertion(there(field1)) ),
        ( scene_stop,
          network_stop(Network) )).

test(gardeners_at_the_field_need_no_link) :-
    season([down(0)], 2, Network,
           ( alone,
             given(Before),
             network_advance(Network, 864000),
             given(After),
             assertion(After > Before+100) )).

test(gardeners_at_the_office_need_a_link) :-
    season([down(0), strategy(central)], 2, Network,
           ( alone,
             network_advance(Network, 86400),  % executes earlier orders
             given(Before),
             assertion(Before > 0),
             network_advance(Network, 864000),
             given(After),
             assertion(After =:= Before) )).

test(picture, Root == svg) :-
    season([], 1, _, scene_picture(Svg)),
    load_structure(string(Svg), [element(Name, _, _)], [dialect(xmlns)]),
    Name = _:Root.

:- end_tests(irrigation_agents).
