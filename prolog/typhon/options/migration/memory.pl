:- module(typhon_memory,
          [ next_from_here/2            % +Strategy, -Host
          ]).
:- use_module('../../kernel/base/prng', [chance_hash/2]).
:- use_module('../../kernel/host',
              [ address_parts/3, context/3, host/3, host_neighbours/2,
                host_option/2 ]).
:- use_module('../../kernel/agent', [agent_home/2, agent_name/3]).
:- use_module(pheromone, []).           % a strategy
:- use_module(strategy, [next_host/6, strategy_memory/2]).

/** <module> The visit memory of an agent

The memory of the migration strategies is the fact '$memory'/1 of the
agent's state.

*Threading*: the thread that runs the agent.
*/

%!  next_from_here(+Strategy, -Host) is semidet.
%
%   As next_host/2 of the vocabulary.

next_from_here(Strategy, Host) :-
    context(Here, Id, Module),
    host(Here, Address, _),
    host_neighbours(Here, Neighbours),
    memory(Module, Id, Here, Memory0),
    next_host(Strategy, Neighbours, Address, Memory0, Next, Memory),
    retractall(Module:'$memory'(_)),
    assertz(Module:'$memory'(Memory)),
    Host = Next.

memory(Module, _, _, Memory) :-
    catch(Module:'$memory'(Memory),
          error(existence_error(procedure, _), _), fail),
    !.
memory(_, Id, Here, Memory) :-
    (   host_option(Here, seed(Seed0))
    ->  true
    ;   Seed0 = random
    ),
    agent_seed(Seed0, Id, Seed),
    strategy_memory(Seed, Memory).

%   With a seed, the choices of an agent depend on the seed, the name and number
%   of the agent, and the host where it was created.

agent_seed(random, _, Seed) :-
    !,
    Seed is random(1<<30).
agent_seed(Seed0, Id, Seed) :-
    agent_name(Id, Name, Number),
    agent_home(Id, Home),
    address_parts(Home, HomeName, _),
    chance_hash(s(Seed0, Name, Number, HomeName), Seed).
