:- module(warehouse, []).

/** <module> A warehouse: agents that allocate robots of ROS, and keep them in step

    swipl examples/applications/warehouse.pl [--robots=6] [--pallets=6]
        [--beams=3] [--way=alone] [--delta=2] [--speed=5] [--port=8080]
        [--seed=1]

A pallet is carried by one robot, a beam by two or three at the same time.
warehouse/floor.pl is the world, warehouse/rosbridge.pl what it is reached by,
warehouse/dispatch.pl says what is done for an order, doc/applications.md says more.
*/

:- use_module(warehouse/scene).
:- use_module(stage, [stage/3, stage_story/3]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- public main/1, play/2.

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
