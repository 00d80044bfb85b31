:- module(typhon_search,
          [ search/4                    % +Address, +Radius, +Wanted, -Found
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(ordsets), [ord_subtract/3, ord_union/3]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_ask_all/6, endpoint_reply/2]).
:- use_module('../../kernel/host',
              [address_parts/3, host/3, host_neighbours/2, scheduler_call/1]).
:- use_module(offers, [offers_on/2]).

/** <module> Services are looked for from host to host

First on one host, then on its neighbours, then on theirs: at each distance all
processes are asked at once.

*Threading*: the thread that looks waits; questions are answered by a worker.
*/

:- multifile typhon_endpoint:requested/4.

%!  search(+Address, +Radius, +Wanted, -Found:list) is det.
%
%   See find/3: Wanted is wanted(Pattern, Properties, Most, Seconds).

search(Address, Radius, Wanted, Found) :-
    level([Address], [Address], Radius, 0, Wanted, Levels),
    append(Levels, Found).

%   level(+Hosts, +Seen, +Radius, +Count, +Wanted, -Levels): what is found on
%   Hosts, and farther ones; Count are found on nearer ones.

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
                     typhon_search:none, Seconds, Results),
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
    must_be(list(atom), Hosts),
    scheduler_call(typhon_search:reply(Hosts, Look, ReplyTo)).

reply(Hosts, Look, ReplyTo) :-
    seen_on(Hosts, Look, Answers),
    endpoint_reply(ReplyTo, Answers).

%   seen_on(+Hosts, +Look, -Answers): of those that are in this process.

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
