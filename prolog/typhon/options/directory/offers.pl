:- module(typhon_offers,
          [ offer_add/4,                % +Host, +Agent, +Service, +Properties
            offer_remove/2,             % +Agent, +Service
            offers_on/2                 % +Host, -Offers
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/durable', [durable/5, durable_assertz/1]).
:- use_module('../../kernel/base/durable_changes', [durable_drop/3]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3, life_hops/2]).

/** <module> Offers, on the host on which they were made

An offer notes after how many hops of its agent it was made, and lapses when the
agent has made more, or is no longer there.  This is checked at each search: so
hops and ends cost agents without offers nothing.  Lapsed offers are removed by
the search that finds them, and all of them each time that as many have been made as
were left the last time.

*Threading*: any thread; a mutex serialises changes.
*/

:- multifile
    typhon_identity:ids_anew/0,
    typhon_host_parts:ends/1.

:- setting(offers, positive_integer, 100, "Offers of an agent").

:- dynamic
    offer/6,                    % Agent, N, Host, Hops, Service, Properties
    sweep_at/1.                 % N

:- durable(offer, Agent, N, offer(Host, Hops, Service, Properties),
           offer(Agent, N, Host, Hops, Service, Properties)).

typhon_identity:ids_anew :-
    retractall(offer(_, _, _, _, _, _)).

typhon_host_parts:ends(Host) :-
    retractall(offer(_, _, Host, _, _, _)).

%!  offer_add(+Host, +Agent, +Service, +Properties) is det.
%!  offer_remove(+Agent, +Service) is det.
%
%   Agent, which stands on Host, offers Service; it does no longer.
%
%   @error resource_error(offers)

offer_add(Host, Agent, Service, Properties) :-
    with_mutex(typhon_offers, add(Host, Agent, Service, Properties)).

add(Host, Agent, Service, Properties) :-
    remove(Agent, Service),
    forall(lapsed(Agent, N), drop(Agent, N)),
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
    forall(lapsed(Agent, Old), drop(Agent, Old)),
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

lapsed(Agent, N) :-
    offer(Agent, N, Host, Hops, _, _),
    \+ stands(Agent, Host, Hops).

stands(Agent, Host, Hops) :-
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
              stands(Agent, Host, Hops) ),
            Offers).
