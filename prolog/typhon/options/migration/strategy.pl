:- module(typhon_strategy,
          [ strategy_memory/2,          % +Seed, -Memory
            next_host/6,                % +Strategy, +Neighbours, +Here,
                                        % +Memory0, -Host, -Memory
            memory_mark/3,              % +Host, +Memory0, -Memory
            memory_visited/2,           % +Memory, -Hosts
            memory_chance/4             % +Memory0, -Chance0, ?Chance, -Memory
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2, reverse/2, selectchk/3]).
:- use_module('../../kernel/base/prng',
              [chance_member/4, chance_seed/2, chance_true/4]).

/** <module> Migration strategies

A migration strategy chooses one of the neighbours of the host on which an agent
is.

  - random: any neighbour, all with the same probability
  - conscientious: a neighbour never visited, drawn at random; when there is
    none, the one whose last visit is longest ago (Minar, Kramer and Maes)
  - epsilon_conscientious(E): random with probability E, else conscientious

The agent's memory is a small ground term that moves with it: the visited hosts,
each once, the most recent first, and the state of its own random generator.  So
the choices depend on the agent alone, not on the thread that runs it, and two
runs with the same seed make the same choices.  All strategies keep the memory
in the same way, so an agent may change from one to another on its way.

The chosen host counts as visited from the moment of the choice, before the
agent is there.  So if that host refuses the agent, the agent tries all other
neighbours before it tries this host again.

Further strategies are added by clauses of the two hooks below.

*Threading*: pure.
*/

:- multifile
    strategy/1,                 % +Strategy
    choose/6.                   % +Strategy, +Hosts, +Here, +Memory0,
                                % -Host, -Memory

%!  strategy(+Strategy) is semidet.
%
%   Hook: true when Strategy is a migration strategy.  Clauses raise an error
%   when Strategy has the right shape and impossible arguments.

%!  choose(+Strategy, +Hosts, +Here, +Memory0, -Host, -Memory) is det.
%
%   Hook: Host is one of Hosts, a nonempty ordered set.  Here is already marked
%   in Memory0, and next_host/6 marks Host after the choice.  A clause returns a
%   changed Memory only when it used the agent's random generator, or called
%   choose/6 of another strategy.

%!  strategy_memory(+Seed:integer, -Memory) is det.
%
%   Memory is the memory of an agent that has visited no host.
%
%   @error type_error(integer, Seed)

strategy_memory(Seed, memory(Chance, [])) :-
    chance_seed(Seed, Chance).

%!  next_host(+Strategy, +Neighbours, +Here, +Memory0, -Host, -Memory)
%!      is semidet.
%
%   Host is the neighbour to which the agent goes from Here.  In Memory, Host is
%   the most recently visited host, and Here the one before.  Fails if
%   Neighbours is empty.  The order of Neighbours does not matter.
%
%   @error domain_error(migration_strategy, Strategy),
%   domain_error(probability, E)

next_host(Strategy, Neighbours, Here, Memory0, Host, Memory) :-
    must_be(nonvar, Strategy),
    (   strategy(Strategy)
    ->  true
    ;   domain_error(migration_strategy, Strategy)
    ),
    sort(Neighbours, Hosts),
    Hosts = [_|_],
    memory_mark(Here, Memory0, Memory1),
    choose(Strategy, Hosts, Here, Memory1, Chosen, Memory2),
    !,
    memory_mark(Chosen, Memory2, Memory),
    Host = Chosen.

                /*******************************
                *          STRATEGIES          *
                *******************************/

:- multifile typhon_names:known/2.

typhon_names:known(migration_strategy, random).
typhon_names:known(migration_strategy, conscientious).
typhon_names:known(migration_strategy, epsilon_conscientious('E')).

strategy(random).
strategy(conscientious).
strategy(epsilon_conscientious(E)) :-
    must_be(number, E),
    (   E >= 0, E =< 1
    ->  true
    ;   domain_error(probability, E)
    ).

choose(random, Hosts, _, Memory0, Host, Memory) :-
    draw(Host, Hosts, Memory0, Memory).
choose(conscientious, Hosts, _, Memory0, Host, Memory) :-
    memory_visited(Memory0, Visited),
    exclude(among(Visited), Hosts, Unvisited),
    (   Unvisited = [_|_]
    ->  draw(Host, Unvisited, Memory0, Memory)
    ;   least_recent(Visited, Hosts, Host),
        Memory = Memory0
    ).
choose(epsilon_conscientious(E), Hosts, Here, Memory0, Host, Memory) :-
    memory_chance(Memory0, Chance0, Chance, Memory1),
    chance_true(E, Random, Chance0, Chance),
    (   Random == true
    ->  choose(random, Hosts, Here, Memory1, Host, Memory)
    ;   choose(conscientious, Hosts, Here, Memory1, Host, Memory)
    ).

draw(Host, Hosts, Memory0, Memory) :-
    memory_chance(Memory0, Chance0, Chance, Memory),
    chance_member(Host, Hosts, Chance0, Chance).

among(Hosts, Host) :-
    memberchk(Host, Hosts).

least_recent(Visited, Hosts, Host) :-
    reverse(Visited, OldestFirst),
    member(Host, OldestFirst),
    memberchk(Host, Hosts),
    !.

%!  memory_mark(+Host, +Memory0, -Memory) is det.
%
%   Memory has Host as the most recently visited host.

memory_mark(Host, memory(Chance, Visited0), memory(Chance, Visited)) :-
    (   Visited0 = [Host|_]
    ->  Visited = Visited0
    ;   selectchk(Host, Visited0, Others)
    ->  Visited = [Host|Others]
    ;   Visited = [Host|Visited0]
    ).

%!  memory_visited(+Memory, -Hosts) is det.
%
%   Hosts are the visited hosts, the most recent first.

memory_visited(memory(_, Visited), Visited).

%!  memory_chance(+Memory0, -Chance0, ?Chance, -Memory) is det.
%
%   Chance0 is the agent's random generator in Memory0; Memory has its later
%   state Chance, which may still be unbound.

memory_chance(memory(Chance0, Visited), Chance0,
              Chance, memory(Chance, Visited)).
