:- module(typhon_offers,
          [ offer_add/4,                % +Host, +Agent, +Service, +Properties
            offer_remove/2,             % +Agent, +Service
            offers_on/2,                % +Host, -Offers
            search/4                    % +Address, +Radius, +Wanted, -Found
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(ordsets), [ord_subtract/3, ord_union/3]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/base/durable',
              [durable/5, durable_assertz/1, durable_drop/3]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3, life_hops/2]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_ask_all/6, endpoint_reply/2]).
:- use_module('../../kernel/host',
              [address_parts/3, host/3, host_neighbours/2, scheduler_call/1]).

/** <module> The table of offers, and the search for services

An offer records the number of hops that its agent had made at that time, and
lapses when the agent has made more, or is no longer there.  Each search checks
this, so hops and ends of agents without offers cost nothing.  Lapsed offers are
removed by the next offer of their agent, and all of them each time that as many
offers have been added as remained after the last sweep.

A search begins on one host and continues with its neighbours, then with theirs;
at each distance it sends the requests to all processes at once.

*Threading*: any thread; a mutex serialises changes.  The searching thread
waits; a worker answers requests of other processes.
*/

:- multifile
    typhon_endpoint:requested/4,
    typhon_identity:ids_anew/0,
    typhon_host_parts:ends/1.

:- setting(offers, positive_integer, 100, "Offers of an agent").
:- setting(cells, positive_integer, 1000,
           "Cells of an offer, at most; eight characters of a text count as one").

:- dynamic
    offer/6,                    % Agent, N, Host, Hops, Service, Properties
    sweep_at/1.                 % N

:- durable(offer, Agent, N, offer(Host, Hops, Service, Properties),
           offer(Agent, N, Host, Hops, Service, Properties)).

typhon_identity:ids_anew :-
    retractall(offer(_, _, _, _, _, _)).

typhon_host_parts:ends(Host) :-
    retractall(offer(_, _, Host, _, _, _)).

%!  offer_add(+Host, +Agent, +Service, +Properties:list) is det.
%!  offer_remove(+Agent, +Service) is det.
%
%   Add an offer of Agent, which is on Host, in place of an older offer of the
%   same Service; remove its offer.
%
%   @error resource_error(offers) Agent has as many offers as the setting
%   `offers` allows, or the offer is larger than the setting `cells` allows

offer_add(Host, Agent, Service, Properties) :-
    setting(cells, Most),
    ( is_tree(Service-Properties, Most) -> true ; resource_error(offers) ),
    with_mutex(typhon_offers, add(Host, Agent, Service, Properties)).

add(Host, Agent, Service, Properties) :-
    remove(Agent, Service),
    forall(is_lapsed(Agent, N), drop(Agent, N)),
    check_count(Agent),
    agent_hops(Agent, Host, Hops),
    flag(typhon_offer, N, N+1),
    sweep(N),
    durable_assertz(offer(Agent, N, Host, Hops, Service, Properties)).

check_count(Agent) :-
    setting(offers, Most),
    aggregate_all(count, offer(Agent, _, _, _, _, _), Count),
    (   Count < Most
    ->  true
    ;   resource_error(offers)
    ).

sweep(N) :-
    sweep_at(At),
    N < At,
    !.
sweep(N) :-
    forall(is_lapsed(Agent, Old), drop(Agent, Old)),
    aggregate_all(count, offer(_, _, _, _, _, _), Count),
    Next is N+max(100, Count),
    retractall(sweep_at(_)),
    assertz(sweep_at(Next)).

offer_remove(Agent, Service) :-
    with_mutex(typhon_offers, remove(Agent, Service)).

remove(Agent, Service) :-
    forall(offer(Agent, N, _, _, Service, _), drop(Agent, N)).

drop(Agent, N) :-
    retractall(offer(Agent, N, _, _, _, _)),
    durable_drop(offer, Agent, N).

is_lapsed(Agent, N) :-
    offer(Agent, N, Host, Hops, _, _),
    \+ is_valid_for(Agent, Host, Hops).

is_valid_for(Agent, Host, Hops) :-
    agent_hops(Agent, Host, Hops),
    \+ agent_status(Agent, faulty(_), _).

agent_hops(Agent, Host, Hops) :-
    agent(Agent, Host, _, _, Life),
    life_hops(Life, Hops),
    !.

%!  offers_on(+Host, -Offers:list) is det.
%
%   Offers are the pairs Agent-offer(Service, Properties) on Host.

offers_on(Host, Offers) :-
    findall(Agent-offer(Service, Properties),
            ( offer(Agent, _, Host, Hops, Service, Properties),
              is_valid_for(Agent, Host, Hops) ),
            Offers).

                /*******************************
                *            SEARCH            *
                *******************************/

%!  search(+Address, +Radius, +Wanted, -Found:list) is det.
%
%   See find/3: Wanted is wanted(Pattern, Properties, Most, Seconds).

search(Address, Radius, Wanted, Found) :-
    level([Address], [Address], Radius, 0, Wanted, Levels),
    append(Levels, Found).

%   level(+Hosts, +Seen, +Radius, +Count, +Wanted, -Levels): Levels are the
%   offers found on Hosts and on farther hosts, one list for each distance.
%   Nearer hosts had Count offers.

level([], _, _, _, _, []) :-
    !.
level(Hosts, Seen, Radius, Count0, Wanted, [Found|Levels]) :-
    Wanted = wanted(Pattern, Properties, Most, Seconds),
    ask(Hosts, look(Pattern, Properties), Seconds, Answers),
    findall(Agent-offer(Service, Own, Host),
            ( member(at(Host, _, Offers), Answers),
              member(Agent-offer(Service, Own), Offers) ),
            Found),
    length(Found, New),
    Count is Count0+New,
    (   ( Radius == 0 ; Count >= Most )
    ->  Levels = []
    ;   next_hosts(Answers, Seen, Next),
        ord_union(Seen, Next, Known),
        less(Radius, Less),
        level(Next, Known, Less, Count, Wanted, Levels)
    ).

less(inf, inf) :-
    !.
less(Radius, Less) :-
    Less is Radius-1.

next_hosts(Answers, Seen, Next) :-
    findall(Host,
            ( member(at(_, Neighbours, _), Answers),
              member(Host, Neighbours),
              atom(Host) ),
            All0),
    sort(All0, All),
    ord_subtract(All, Seen, Next).

ask(Hosts, Look, Seconds, Answers) :-
    partition(is_here, Hosts, Here, There),
    seen_on(Here, Look, Own),
    findall(Endpoint,
            ( member(Host, There), address_parts(Host, _, Endpoint) ),
            Endpoints0),
    sort(Endpoints0, Endpoints),
    ask_others(Endpoints, There, Look, Seconds, Others),
    append(Own, Others, Answers).

is_here(Host) :-
    address_parts(Host, _, Endpoint),
    endpoint_address(Endpoint).

ask_others([], _, _, _, []) :-
    !.
ask_others(Endpoints, Hosts, Look, Seconds, Answers) :-
    endpoint_ask_all(Endpoints, directory, look(Hosts, Look),
                     typhon_offers:none, Seconds, Results),
    findall(At,
            ( member(_-answer(List), Results),
              is_list(List),
              member(At, List),
              is_answer(At) ),
            Answers).

:- public none/2, reply/3.

none(_, []).

is_answer(at(Host, Neighbours, Offers)) :-
    atom(Host),
    is_list(Neighbours),
    is_list(Offers).

typhon_endpoint:requested(directory, look(Hosts, Look), _, ReplyTo) :-
    scheduler_call(typhon_offers:reply(Hosts, Look, ReplyTo)).

reply(Hosts, Look, ReplyTo) :-
    seen_on(Hosts, Look, Answers),
    endpoint_reply(ReplyTo, Answers).

%   seen_on(+Hosts, +Look, -Answers): Answers are at(Host, Neighbours, Offers),
%   for the hosts of this process among Hosts.

seen_on(Hosts, look(Pattern, Properties), Answers) :-
    findall(at(Address, Neighbours, Offers),
            ( member(Address, Hosts),
              address_parts(Address, Name, _),
              host(Name, Address, _),
              host_neighbours(Name, Neighbours),
              offers_on(Name, All),
              findall(Offer,
                      ( member(Offer, All),
                        wanted(Offer, Pattern, Properties) ),
                      Offers) ),
            Answers).

wanted(_-offer(Service, Own), Pattern, Properties) :-
    \+ Service \= Pattern,
    forall(member(Property, Properties),
           ( member(One, Own), \+ One \= Property )).
