:- module(warehouse, []).

/** <module> A warehouse: agents that allocate ROS robots, and keep them in step

    swipl examples/applications/warehouse.pl [--robots=6] [--pallets=6]
        [--beams=3] [--way=alone] [--delta=2] [--breaks=60] [--speed=5]
        [--port=8080] [--seed=1]

A pallet is carried by one robot, a beam by two or three at the same time.
warehouse/floor.pl is the world, warehouse/rosbridge.pl its server,
warehouse/dispatch.pl executes orders; see doc/applications.md.
*/

:- use_module(warehouse/scene).
:- use_module(stage, [stage/3, stage_option/3, stage_story/3]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- public main/1, play/2.

opt_type(robots, robots, natural).
opt_type(pallets, pallets, nonneg).
opt_type(beams, beams, nonneg).
opt_type(way, way, oneof([in_step,alone])).
opt_type(delta, delta, number).
opt_type(breaks, breaks, number).
opt_type(Name, Name, Type) :-
    stage_option(Name, Type, _).

opt_help(robots, "Number of robots [6]").
opt_help(pallets, "Number of loads for one robot [6]").
opt_help(beams, "Number of loads for two or three robots [3]").
opt_help(way, "How robots carry a beam [in_step]").
opt_help(delta, "Penalty bias of agents that keep them in step [2]").
opt_help(breaks, "Seconds after which a robot that carries a beam breaks down").
opt_help(Name, Help) :-
    stage_option(Name, _, Help).

main(Argv) :-
    stage(Argv, warehouse_scene, play).

play(Network, Options) :-
    scene_start(Network, Options),
    stage_story(Network, 40, say).

say(Time, Ends) :-
    scene_orders(Delivered, Waiting, Underway, Falls),
    format('~|~t~d~4| s: ~d orders to come, ~d under way, ~d loads delivered, \c
            ~d have fallen~n', [Time, Waiting, Underway, Delivered, Falls]),
    ( ( Waiting+Underway =:= 0 ; Time >= 1200 ) -> Ends = true ; Ends = false ).
