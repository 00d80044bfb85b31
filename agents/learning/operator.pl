:- module(learning_operator,
          [ learning_start/5,           % +Hosts, +Problem, +Algorithms,
                                        % +Options, -Agents
            learning_exchange/3         % +Agents, +Name, +Algorithm
          ]).
:- use_module('../../prolog/typhon',
              [ agent_create/3, agent_send/2, payload_attach/2,
                payload_detach/2, remote/2
              ]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module('../lib/starts', [starts/4]).
:- use_module(library(apply), [maplist/2, maplist/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [nth0/3]).
:- use_module(library(option), [option/3]).

/** <module> Agents that learn, for users and programs

Creates trainers on hosts, and learning agents (thesis chapter 4).
Hosts are addresses, so these predicates work from any process with the
cookie, also if another process started the hosts.

A problem and a learning algorithm are payload files; trainer.pl and
learner.pl describe what they provide.

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  learning_start(+Hosts, +Problem, +Algorithms, +Options, -Agents) is det.
%
%   Each of Hosts gets a trainer for Problem, if it has none.  Agents,
%   with Algorithms in turn, all begin together.  Options:
%
%     - agents(Count)
%       Default 5.
%     - starts(Hosts), seed(Seed)
%       Where they start, see starts/4.  The seed is also that of the
%       trainers.
%     - settings(Pairs)
%       Name-Value, to replace the defaults in parameters.pl, or of payloads.
%
%   To limit the queue of a host to N agents, start the host with the capacity
%   N + 1: the trainer needs one.
%
%   @error domain_error(learning_option, Option), domain_error(setting, X)
%   @error type_error(list, X), domain_error(hosts, []),
%   existence_error(host, Host), host_unreachable(Host)

learning_start(Hosts, Problem, Algorithms, Options, Agents) :-
    must_be(list(atom), Hosts),
    must_be(list, Algorithms),
    check_options(learning_option, Options),
    settings(Options, Settings),
    maplist(furnish(Problem, Settings), Hosts),
    option(agents(Count), Options, 5),
    starts(Count, Hosts, Options, Starts),
    findall(Algorithm, in_turn(Count, Algorithms, Algorithm), Chosen),
    maplist(create(Settings), Chosen, Starts, Agents),
    maplist(begin, Agents).

typhon_options:declared(learning_option, agents(X), nonneg, X).
typhon_options:declared(learning_option, starts(X), list(atom), X).
typhon_options:declared(learning_option, seed(X), integer, X).
typhon_options:declared(learning_option, settings(X), list, X).

agent_settings:takes(learning_start,
                     [agents(learning/learner), agents(learning/trainer)],
                     [seed, start], taken).

in_turn(Count, Algorithms, Algorithm) :-
    length(Algorithms, Kinds),
    Last is Count - 1,
    between(0, Last, Number),
    Index is Number mod Kinds,
    nth0(Index, Algorithms, Algorithm).

settings(Options, [setting(seed, Seed)|Settings]) :-
    setting_facts(learning_start, Options, Settings),
    option(seed(Seed), Options, random).

furnish(_, _, Host) :-
    remote(Host, sense(trainer(_))),
    !.
furnish(Problem, Settings, Host) :-
    agent_create(agents(learning/trainer), Trainer,
                 [ host(Host), static(true), payloads([Problem]),
                   facts(Settings)
                 ]),
    remote(Host, leave(trainer(Trainer))).

create(Settings, Algorithm, Host, Agent) :-
    agent_create(agents(learning/learner), Agent,
                 [ host(Host), payloads([Algorithm]),
                   facts([setting(start, order)|Settings])
                 ]).

begin(Agent) :-
    agent_send(Agent, begin).

%!  learning_exchange(+Agents, +Name, +Algorithm) is det.
%
%   Agents replace the learning algorithm called Name by Algorithm, a payload
%   file, at their current hosts.
%
%   @error existence_error(agent, Agent), and others of payload_attach/2

learning_exchange(Agents, Name, Algorithm) :-
    must_be(list(atom), Agents),
    maplist(exchange(Name, Algorithm), Agents).

exchange(Name, Algorithm, Agent) :-
    payload_detach(Agent, Name),
    payload_attach(Agent, Algorithm).
