:- module(typhon_migration, []).

/** <module> Migration: where agents go next

Strategies by which agents choose among neighbours, what they remember for that,
and pheromones.  This is the interface of the layer.
*/

:- use_module('../kernel/vocabulary', []).
:- use_module(migration/memory, [next_host/2]).
:- use_module(migration/pheromone,
              [emit/1, emit/2, pheromone/3, withdraw/1]).

%   Agents find these on every host.

:- typhon_vocabulary:import(typhon_memory:next_host/2).
:- typhon_vocabulary:import(typhon_pheromone:emit/1).
:- typhon_vocabulary:import(typhon_pheromone:emit/2).
:- typhon_vocabulary:import(typhon_pheromone:pheromone/3).
:- typhon_vocabulary:import(typhon_pheromone:withdraw/1).
