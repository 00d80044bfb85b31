:- module(population_operator,
          [ population_start/5,         % +Sequence, +Hosts, +Tasks, +Options,
                                        % -Agents
            population_join/2,          % +Sequence, +Host
            population_leave/2          % +Sequence, +Host
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module('../lib/starts', [starts/4]).
:- use_module(library(apply), [maplist/2, maplist/4, maplist/5]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2, nth1/3]).

/** <module> Starting a population of specialists

Hosts are given as addresses, so these predicates work from any process with
the cookie, also if another process started the hosts.

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  population_start(+Sequence, +Hosts, +Tasks:list(pair), +Options,
%!                   -Agents) is det.
%
%   Agents execute Tasks, pairs Task-Goal in order, on all Hosts in step; there
%   is one kind of agent for each task (agents(sync/specialist)).  Puts a queue
%   and a worker on each host that has none.  Agents are the first agents of
%   each kind, in the order of the tasks; they and all their clones are named
%   agent1, agent2 ...; they begin at the same time.  Options:
%
%     - starts(Hosts), seed(Seed)
%       Where they start, see starts/4.
%     - settings(List)
%       Pairs Name-Value for the agents: see the programs specialist.pl and
%       cloning.pl.
%
%   To limit a queue to q_th agents, start the hosts with the capacity
%   q_th + 2: the queue and the worker need one each.
%
%   @error domain_error(population_option, Option), domain_error(setting, X)
%   @error type_error(list, X), type_error(pair, X), domain_error(hosts, []),
%   existence_error(host, Host), host_unreachable(Host)

population_start(Sequence, Hosts, Tasks, Options, Agents) :-
    must_be(atomic, Sequence),
    must_be(list(atom), Hosts),
    must_be(list(pair), Tasks),
    check_options(population_option, Options),
    setting_facts(population_start, Options, Settings),
    maplist(furnish(Sequence), Hosts),
    length(Tasks, Count),
    starts(Count, Hosts, Options, Starts),
    findall(Facts, kind(Sequence, Tasks, Settings, Facts), Kinds),
    findall(Number, between(1, Count, Number), Numbers),
    maplist(create, Numbers, Kinds, Starts, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

typhon_options:declared(population_option, starts(X), list(atom), X).
typhon_options:declared(population_option, seed(X), integer, X).
typhon_options:declared(population_option, settings(X), list, X).

agent_settings:takes(population_start, [agents(sync/specialist)], [start],
                     refused).

%   A busy worker has no tuple, but its task has one.

furnish(Sequence, Host) :-
    furnish(Host, queue, sense(queue(_)), agents(population/queue), []),
    furnish(Host, worker(Sequence),
            ( sense(worker(Sequence, _))
            ; sense(task(Sequence, _, _, _)) ),
            agents(sync/worker), [sequence(Sequence)]).

%!  population_join(+Sequence, +Host) is det.
%!  population_leave(+Sequence, +Host) is det.
%
%   Host takes part in Sequence, or not any more.  Completed tasks stay
%   completed, and a running task is not interrupted. The agents find a host
%   that joins late, and let it execute its missing tasks, in order.
%
%   @error host_unreachable(Host), existence_error(host, Host)

population_join(Sequence, Host) :-
    furnish(Sequence, Host),
    remote(Host, ignore(take(left(Sequence)))).

population_leave(Sequence, Host) :-
    remote(Host, ( sense(left(Sequence)) -> true ; leave(left(Sequence)) )).

%   furnish(+Host, +What, :Present, +Program, +Facts): a new agent leaves its
%   own tuple only when it runs; until then the tuple furnished(What) keeps
%   other callers from creating a second one.

furnish(Host, What, Present, _, _) :-
    remote(Host, ( sense(furnished(What)) ; Present )),
    !.
furnish(Host, What, _, Program, Facts) :-
    remote(Host, leave(furnished(What))),
    catch(agent_create(Program, _,
                       [host(Host), static(true), facts(Facts)]),
          Error,
          ( remote(Host, take(furnished(What))),
            throw(Error) )).

%   kind(+Sequence, +Tasks, +Settings, -Facts): Facts are the initial facts of
%   the agents for each task in turn.

kind(Sequence, Tasks, Settings,
     [ sequence(Sequence), task(Task, Goal), previous(Previous),
       setting(start, order)
     | Settings
     ]) :-
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
