:- module(typhon_directory_words,
          [ offer/2,                    % +Service, +Properties
            unoffer/1,                  % +Service
            find/3                      % ?Pattern, -Agents, +Options
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/program', [vocabulary/1]).
:- use_module('../../kernel/wire', [mobile_term/1]).
:- use_module('../../kernel/host',
              [context/3, context_host/1, context_now/2, host/3, parts_call/3]).
:- autoload(offers, [offer_add/4, offer_remove/2, search/4]).

/** <module> Vocabulary of agents that offer and find services

*Threading*: the thread that runs the agent; find/3 waits for other processes.
*/

:- vocabulary(typhon_directory_words).

:- multifile typhon_options:declared/4.

%!  offer(+Service, +Properties:list) is det.
%!  unoffer(+Service) is det.
%
%   This agent offers Service, a ground term, on this host, until it withdraws
%   the offer, leaves the host, ends or becomes faulty.  Properties, ground,
%   describe the service; a second offer of the same Service replaces them.
%   (withdraw/1 removes a pheromone.)
%
%   @error instantiation_error, type_error(mobile_term, Culprit)
%   @error resource_error(offers): an agent has at most 100, the setting
%          `typhon_offers:offers`, of 1000 cells each, `typhon_offers:cells`

offer(Service, Properties) :-
    must_be(ground, Service),
    must_be(callable, Service),
    must_be(list, Properties),
    must_be(ground, Properties),
    mobile_term(Service-Properties),
    context(Host, Id, _),
    parts_call(acts, Host, [Id, leave(offer(Service, Properties))]),
    offer_add(Host, Id, Service, Properties).

unoffer(Service) :-
    context(_, Id, _),
    offer_remove(Id, Service).

%!  find(?Pattern, -Agents:list, +Options) is det.
%
%   Agents offer services that unify with Pattern: pairs
%   Agent-offer(Service, Properties, Host), those on nearer hosts first.
%   Options:
%
%     - radius(Hops): search this host and the hosts that at most Hops links
%       lead to; default 0, this host alone; `inf`, all that links lead to
%     - properties(List): each unifies with a property of the offer
%     - most(Count): farther hosts are not searched when Count are found
%     - seconds(Seconds): hosts at one distance that have not answered by then
%       are left out; default 5
%
%   @error domain_error(find_option, Option)

find(Pattern, Agents, Options) :-
    check_options(find_option, Options),
    option(radius(Radius), Options, 0),
    option(properties(Properties), Options, []),
    option(most(Most), Options, inf),
    option(seconds(Seconds), Options, 5),
    mobile_term(Pattern-Properties),
    context_host(Host),
    context_now(Host, Id),
    parts_call(acts, Host, [Id, say(Pattern-Properties)]),
    host(Host, Address, _),
    search(Address, Radius, wanted(Pattern, Properties, Most, Seconds), Agents).

typhon_options:declared(find_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(radius(X), nonneg, X).
option_type(radius(X), oneof([inf]), X).
option_type(properties(X), list, X).
option_type(most(X), positive_integer, X).
option_type(seconds(X), number, X).
