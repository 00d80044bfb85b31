:- module(typhon_migration, []).

/** <module> Migration: where agents go next

Strategies by which agents choose among neighbours, what they remember for that,
and pheromones.  This is the interface of the layer.
*/

:- use_module(migration/memory, []).
:- use_module(migration/pheromone, []).
