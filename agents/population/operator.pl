:- module(population_operator,
          [ population_start/5          % +Sequence, +Hosts, +Tasks, +Options,
                                        % -Agents
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/chance', [chance_below/4, chance_seed/2]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/5]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2, nth0/4, nth1/3]).
:- use_module(library(option), [option/2, option/3]).

/** <module> Starting a population of specialists

Hosts are given as addresses, so this works from any process that holds the
cookie, whoever started the hosts.

*Threading*: any thread; no state.
*/

%!  population_start(+Sequence, +Hosts, +Tasks:list(pair), +Options,
%!                   -Agents) is det.
%
%   Have Tasks, pairs Task-Goal in order, executed on all Hosts in step, by
%   one kind of agent for each task (agents(sync/specialist)).  Puts a queue
%   and a worker at each host that has none.  Agents are the first of each
%   kind, in the order of the tasks, named agent1, agent2 ... as all their
%   clones will be; they begin at the same time.  Options:
%
%     - starts(Hosts)
%       Where they start.
%     - seed(Seed)
%       Without starts(_) the hosts are drawn, different ones as long as
%       there are any, by this integer; default 1.
%     - settings(List)
%       Pairs Name-Value for the agents: see the programs specialist.pl and
%       cloning.pl.
%
%   For no more than q_th agents in a queue the hosts must have been started
%   with the capacity q_th + 2, for the queue and the worker.
%
%   @error type_error(list, X), type_error(pair, X), domain_error(hosts, []),
%   existence_error(host, Host), host_unreachable(Host)

population_start(Sequence, Hosts, Tasks, Options, Agents) :-
    must_be(atomic, Sequence),
    must_be(list(atom), Hosts),
    must_be(list(pair), Tasks),
    maplist(furnish(Sequence), Hosts),
    length(Tasks, Count),
    starts(Options, Count, Hosts, Starts),
    findall(Facts, kind(Sequence, Tasks, Options, Facts), Kinds),
    findall(Number, between(1, Count, Number), Numbers),
    maplist(create, Numbers, Kinds, Starts, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

%   A worker that is busy has no tuple, but its task has.

furnish(Sequence, Host) :-
    unless(Host, sense(queue(_)), agents(population/queue), []),
    unless(Host, ( sense(worker(Sequence, _))
                 ; sense(task(Sequence, _, _, _)) ),
           agents(sync/worker), [sequence(Sequence)]).

unless(Host, Goal, _, _) :-
    remote(Host, Goal),
    !.
unless(Host, _, Program, Facts) :-
    agent_create(Program, _, [host(Host), static(true), facts(Facts)]).

%   kind(+Sequence, +Tasks, +Options, -Facts): of each task in turn, what
%   its agents know.

kind(Sequence, Tasks, Options,
     [ sequence(Sequence), task(Task, Goal), previous(Previous),
       setting(start, order)
     | Settings
     ]) :-
    option(settings(Pairs), Options, []),
    findall(setting(Name, Value), member(Name-Value, Pairs), Settings),
    nth1(Number, Tasks, Task-Goal),
    (   nth1(Before, Tasks, Previous-_),
        Before =:= Number - 1
    ->  true
    ;   Previous = none
    ).

create(Number, Facts, Host, Agent) :-
    atom_concat(agent, Number, Name),
    agent_create(agents(sync/specialist), Agent,
                 [name(Name), host(Host), facts(Facts)]).

                /*******************************
                *         WHERE TO START       *
                *******************************/

starts(Options, Count, Hosts, Starts) :-
    (   option(starts(Given), Options)
    ->  Free = Given,
        Draw = first
    ;   option(seed(Seed), Options, 1),
        chance_seed(Seed, Chance),
        Free = Hosts,
        Draw = Chance
    ),
    length(Starts, Count),
    foldl(start(Free), Starts, Free-Draw, _).

%   When no host is free any more all are free again.

start([], _, _, _) :-
    !,
    domain_error(hosts, []).
start(Hosts, Start, []-Draw0, State) :-
    !,
    start(Hosts, Start, Hosts-Draw0, State).
start(_, Start, [Start|Free]-first, Free-first) :-
    !.
start(_, Start, Free0-Chance0, Free-Chance) :-
    length(Free0, N),
    chance_below(N, Index, Chance0, Chance),
    nth0(Index, Free0, Start, Free).
