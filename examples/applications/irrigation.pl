:- module(irrigation, []).

/** <module> Irrigation of fields by agents that carry models

    swipl examples/applications/irrigation.pl [--strategy=central] [--down=0.3]
        [--broker=mqtt://localhost] [--days=90] [--speed=5] [--port=8080]
        [--seed=1]

Six fields have a season of ninety days.  A gardener for each moves there,
estimates the need of the crop from moisture sensors, and opens the valve.
Speed is in hours of the world per second.  irrigation/fields.pl is the
world, irrigation/gardener.pl the agent; see doc/applications.md.
*/

:- use_module(irrigation/scene).
:- use_module(stage, [stage/3, stage_option/3, stage_story/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/3]).

:- initialization(main, main).

:- public main/1, play/2.

opt_type(strategy, strategy, oneof([carried,central,timer,timer_less])).
opt_type(down, down, number).
opt_type(broker, broker, atom).
opt_type(days, days, natural).
opt_type(Name, Name, Type) :-
    stage_option(Name, Type, _).

opt_help(strategy, "How the opening of valves is decided [carried]").
opt_help(down, "Share of time in which a link is down [0.3]").
opt_help(broker, "URL of an MQTT broker [none: simulated]").
opt_help(days, "Length of the season [90]").
opt_help(Name, Help) :-
    stage_option(Name, _, Help).

main(Argv) :-
    stage(Argv, irrigation_scene, play).

play(Network, Options) :-
    scene_start(Network, Options),
    option(days(Days), Options, 90),
    stage_story(Network, 864000, say(Days)).

say(Days, Time, Ends) :-
    Day is Time//86400,
    scene_totals(_, Totals),
    mean(Mm, member(_-totals(Mm, _, _), Totals), Given),
    mean(Mm, member(_-totals(_, Mm, _), Totals), Drained),
    mean(Hours, member(_-totals(_, _, Hours), Totals), Stress),
    format('~|~t~d~3| days: ~|~t~0f~4| mm given, ~|~t~0f~4| mm drained, \c
            ~|~t~0f~4| hours of stress~n', [Day, Given, Drained, Stress]),
    ( Day >= Days -> Ends = true ; Ends = false ).

:- meta_predicate mean(+, 0, -).

mean(X, Goal, Mean) :-
    aggregate_all(r(sum(X), count), Goal, r(Sum, Count)),
    Mean is Sum/Count.
