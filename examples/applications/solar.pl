:- module(solar, []).

/** <module> Houses with solar panels that share a battery

    swipl examples/applications/solar.pl [--strategy=first] [--capacity=30]
        [--days=7] [--speed=5] [--port=8080] [--seed=1]

Ten houses exchange the energy of their panels, by auctions of an agent that
moves from house to house.  Speed is in quarters of an hour of the world per
second. solar/street.pl is the world, solar/auctioneer.pl and solar/house.pl
are agents; see doc/applications.md.
*/

:- use_module(solar/scene).
:- use_module(stage, [stage/3, stage_option/3, stage_story/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/3]).

:- initialization(main, main).

:- public main/1, play/2.

opt_type(strategy, strategy, oneof([auction,none,first,drawn,waiting])).
opt_type(capacity, capacity, number).
opt_type(days, days, natural).
opt_type(Name, Name, Type) :-
    stage_option(Name, Type, _).

opt_help(strategy, "How the battery is shared [auction]").
opt_help(capacity, "Capacity of the battery, in kWh [30]").
opt_help(days, "Days until the program ends [7]").
opt_help(Name, Help) :-
    stage_option(Name, _, Help).

main(Argv) :-
    stage(Argv, solar_scene, play).

play(Network, Options) :-
    scene_start(Network, Options),
    option(days(Days), Options, 7),
    stage_story(Network, 86400, say(Days)).

say(Days, Time, Ends) :-
    Day is Time//86400,
    scene_totals(_, Totals),
    findall(Sum,
            ( member(N, [1, 4, 5, 3]),
              aggregate_all(sum(Kwh),
                            ( member(_-Sums, Totals), arg(N, Sums, Kwh) ), Sum) ),
            Row),
    format('~|~t~d~3| days: ~|~t~0f~5| kWh produced, ~|~t~0f~4| wasted, \c
            ~|~t~0f~4| taken from the street, ~|~t~0f~4| bought from the grid~n',
           [Day|Row]),
    ( Day >= Days -> Ends = true ; Ends = false ).
