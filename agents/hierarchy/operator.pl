:- module(hierarchy_operator,
          [ hierarchy_start/4,          % +Homes, +Mechanism, +Options, -Leaders
            hierarchy_serve/4           % +Leaders, +Round, +Parts, +Timeout
          ]).
:- use_module('../../prolog/typhon', [agent_create/3, agent_join/3]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Hierarchies of agents, for users and programs

Starts leaders of the parts of a network, and an observer above them (thesis
section 8.2), and asks them for rounds of work.  The workers are those of
another mechanism, which a payload defines; leader.pl describes it.

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  hierarchy_start(+Homes:list(atom), +Mechanism, +Options, -Leaders) is det.
%
%   Creates one leader on each of Homes.  Mechanism is a payload file, such as
%   payloads(hierarchy/steps).  Options:
%
%     - decides(Level)
%       `observer`, the default: an observer is created on the first of Homes;
%       `leaders`: each leader decides for itself; `none`: parameters do not
%       change
%     - limit(Seconds)
%       Host seconds after which workers are disposed of; default 2000.
%     - settings(Pairs)
%       Name-Value, initial parameters of the mechanism and of its workers;
%       `workers` is the number of workers in each part
%
%   @error domain_error(hierarchy_option, Option), domain_error(setting, X),
%   and others of agent_create/3

hierarchy_start(Homes, Mechanism, Options, Leaders) :-
    must_be(list(atom), Homes),
    check_options(hierarchy_option, Options),
    setting_facts(hierarchy_start, Options, Settings),
    option(decides(Level), Options, observer),
    option(limit(Limit), Options, 2000),
    decider(Level, Homes, Mechanism, Decider),
    Facts = [decides(Decider), limit(Limit)|Settings],
    maplist(create_leader(Mechanism, Facts), Homes, Leaders).

typhon_options:declared(hierarchy_option, decides(X),
                        oneof([observer, leaders, none]), X).
typhon_options:declared(hierarchy_option, limit(X), number, X).
typhon_options:declared(hierarchy_option, settings(X), list(pair), X).

agent_settings:takes(hierarchy_start, [agents(hierarchy/leader)], [], taken).

decider(none, _, _, none).
decider(leaders, _, _, self).
decider(observer, Homes, Mechanism, Observer) :-
    Homes = [Home|_],
    length(Homes, Count),
    agent_create(agents(hierarchy/observer), Observer,
                 [ host(Home), payloads([Mechanism]),
                   facts([leaders(Count)]) ]).

create_leader(Mechanism, Facts, Home, Leader) :-
    agent_create(agents(hierarchy/leader), Leader,
                 [host(Home), payloads([Mechanism]), facts(Facts)]).

%!  hierarchy_serve(+Leaders:list, +Round:atom, +Parts:list(list(atom)),
%!                  +Timeout) is semidet.
%
%   Each of Leaders serves a round of work on the hosts of its part.  Parts may
%   change from round to round.  Fails if that takes longer than Timeout host
%   seconds.
%
%   @error existence_error(host, Host), host_unreachable(Host)

hierarchy_serve(Leaders, Round, Parts, Timeout) :-
    pairs_keys_values(Pairs, Leaders, Parts),
    findall(part(Leader, Hosts), member(Leader-Hosts, Pairs), Facts),
    Parts = [[Host|_]|_],
    agent_create(agents(hierarchy/customer), Customer,
                 [host(Host), facts([round(Round)|Facts])]),
    agent_join(Customer, done, Timeout).
