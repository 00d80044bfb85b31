:- module(typhon_migration,
          [ next_host/2,                % +Strategy, -Host
            emit/1,                     % +Problem
            emit/2,                     % +Problem, +Options
            withdraw/1,                 % +Problem
            pheromone/3                 % ?Problem, -Source, -Strength
          ]).
:- autoload('migration/memory', [next_from_here/2]).
:- autoload('migration/pheromone',
            [emit_here/2, pheromone_here/3, withdraw_here/1]).
:- use_module('../kernel/program', [vocabulary/1]).

/** <module> Migration: how agents choose the next host

Strategies by which agents choose among neighbours, the memory of these
strategies, and pheromones.  This is the interface of the layer, and its
vocabulary; the other modules are loaded when an agent calls the interface, or a
pheromone arrives.

*Threading*: the thread that runs the agent.
*/

:- vocabulary(typhon_migration).

%!  next_host(+Strategy, -Host) is semidet.
%
%   Choose a neighbour, see typhon_strategy.  The memory of the strategy moves
%   with the agent.  Fails on an isolated host.

next_host(Strategy, Host) :-
    next_from_here(Strategy, Host).

%!  emit(+Problem) is det.
%!  emit(+Problem, +Options) is det.
%
%   The host requests an agent that can solve Problem, a ground term: it emits a
%   pheromone.  Agents follow it by the migration strategy phercon(Problem).
%   Options:
%
%     - span(Hops): distance in hops up to which it spreads; default 3
%     - strength(Number): strength next to the source; default 100
%     - period(Seconds): period of host time, see pheromone_until/5; default 10
%
%   Emitting again renews the pheromones that are left.
%
%   @error type_error(mobile_term, Culprit), instantiation_error
%   @error domain_error(pheromone_option, Option)
%   @error resource_error(pheromone) Problem is too large, see the setting
%   `typhon_pheromone:cells`

emit(Problem) :-
    emit_here(Problem, []).

emit(Problem, Options) :-
    emit_here(Problem, Options).

%!  withdraw(+Problem) is det.
%
%   Remove the pheromone that the host emitted for Problem from the hosts that
%   the present links reach.  Elsewhere it evaporates.

withdraw(Problem) :-
    withdraw_here(Problem).

%!  pheromone(?Problem, -Source, -Strength) is nondet.
%
%   A pheromone for Problem, emitted by Source, is at the host now.  See
%   pheromone_strength/4 for how its strength depends on the distance.

pheromone(Problem, Source, Strength) :-
    pheromone_here(Problem, Source, Strength).
