:- module(typhon_host_questions,
          [ host_property/2,            % ?Name, ?Property
            host_unknown/1,             % +Address
            link/2,                     % +HostA, +HostB
            link/3,                     % +HostA, +HostB, +Options
            unlink/2                    % +HostA, +HostB
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../base/options', [check_name/2, check_options/2]).
:- use_module('../wire', [endpoint_reply/2]).
:- use_module(asking, [process_ask/6]).
:- use_module(host_names, [host_address/2, host_resolve/2]).
:- use_module(hosts,
              [host/3, host_hop_stats/3, host_load/2, host_option/2]).
:- use_module(peer_rights, [peer_may/3]).
:- use_module(links, [host_link/3, host_neighbours/2, host_unlink/2]).

/** <module> Hosts anywhere: what they are, and their links

A host of another process is asked by a request of kind `hosting`.

*Threading*: any thread.  Requests are answered in the threads of
connections.
*/

:- multifile
    typhon_names:known/2,
    typhon_options:declared/4,
    typhon_endpoint:requested/4.

%!  host_property(?Name, ?Property) is nondet.
%
%   Property is address(A), state(running), capacity(N), load(N),
%   neighbours(L), hop_time(Direction, stats(Count,Min,Mean,Max)) (host
%   seconds) or place(M).  Name may be that of a host of another process of a
%   network that this process started, or any address.
%
%   @error existence_error(host, Name), ambiguous_host(Name, Addresses)
%   @error domain_error(host_property, Property)

host_property(Name, Property) :-
    check_name(host_property, Property),
    property_of(Name, Property).

typhon_names:known(host_property, Property) :-
    clause(local_property(Property, _), _).

property_of(Name, Property) :-
    var(Name),
    !,
    host(Name, _, _),
    local_property(Property, Name).
property_of(Host, Property) :-
    host_resolve(Host, Where),
    property(Where, Property).

property(local(Name), Property) :-
    local_property(Property, Name).
property(remote(Host, Name, Endpoint), Property) :-
    ask(Endpoint, Host, host_properties(Name), Properties),
    (   Properties == none
    ->  host_unknown(Host)
    ;   findall(Property, member(Property, Properties), Found),
        member(Property, Found)         % leaves no choice where one is asked
    ).

local_property(address(Address), Name) :-
    host(Name, Address, _).
local_property(state(running), _).
local_property(capacity(Capacity), Name) :-
    (   host_option(Name, capacity(Capacity0))
    ->  Capacity = Capacity0
    ;   Capacity = inf
    ).
local_property(load(Load), Name) :-
    host_load(Name, Load).
local_property(neighbours(Neighbours), Name) :-
    host_neighbours(Name, Neighbours).
local_property(hop_time(Direction, Stats), Name) :-
    host_hop_stats(Name, Direction, Stats).
local_property(place(Place), Name) :-
    host(Name, _, Place).

                /*******************************
                *             LINKS            *
                *******************************/

%!  link(+A, +B) is det.
%!  link(+A, +B, +Options) is det.
%!  unlink(+A, +B) is det.
%
%   Make or break the overlay link between two hosts, both ways; either may
%   be in another process.  What it costs to take it agents learn by
%   neighbour/2: 1, or what the option cost(Number) says, which changes the
%   cost of a link that is there.  Where a link is broken its cost is
%   forgotten.
%
%   @error existence_error(host, Host), ambiguous_host(Name, Addresses)
%   @error domain_error(link_option, Option)

link(A, B) :-
    make_link(A, B, link).

link(A, B, Options) :-
    check_options(link_option, Options),
    (   option(cost(Cost), Options)
    ->  must_be_cost(Cost),
        make_link(A, B, link(Cost))
    ;   make_link(A, B, link)
    ).

typhon_options:declared(link_option, cost(Cost), number, Cost).

must_be_cost(Cost) :-
    (   Cost >= 0
    ->  true
    ;   domain_error(cost, Cost)
    ).

%   First what may fail, so that no half of a link is left.

make_link(A, B, Change) :-
    ends(A, B, Near, Far),
    must_be_there(Near),
    one_way(Far, Near, Change),
    one_way(Near, Far, Change).

unlink(A, B) :-
    ends(A, B, Near, Far),
    one_way(Near, Far, unlink),
    one_way(Far, Near, unlink).

%   ends(+A, +B, -Near, -Far): their addresses, that of a host of this process
%   first.

ends(A, B, Near, Far) :-
    must_be(atom, A),
    must_be(atom, B),
    host_address(A, AddressA),
    host_address(B, AddressB),
    (   AddressA == AddressB
    ->  domain_error(other_host, B)
    ;   host(_, AddressB, _)
    ->  Near-Far = AddressB-AddressA
    ;   Near-Far = AddressA-AddressB
    ).

must_be_there(Address) :-
    host_resolve(Address, Where),
    (   there(Where)
    ->  true
    ;   host_unknown(Address)
    ).

there(local(Name)) :-
    host(Name, _, _).
there(remote(Address, Name, Endpoint)) :-
    ask(Endpoint, Address, hosts, Names),
    memberchk(Name, Names).

one_way(From, To, Change) :-
    host_resolve(From, Where),
    change(Where, Change, To, Answer),
    (   Answer == ok
    ->  debug(typhon(host), '~w: ~w ~w', [From, Change, To])
    ;   host_unknown(From)
    ).

change(local(Name), Change, To, Answer) :-
    hosting_question(Change, Name, To, Question),
    hosting_answer(Question, Answer).
change(remote(Host, Name, Endpoint), Change, To, Answer) :-
    hosting_question(Change, Name, To, Question),
    ask(Endpoint, Host, Question, Answer).

hosting_question(link, Name, To, link(Name, To)).
hosting_question(link(Cost), Name, To, link(Name, To, Cost)).
hosting_question(unlink, Name, To, unlink(Name, To)).

                /*******************************
                *             ASKING           *
                *******************************/

%!  host_unknown(+Address) is failure.
%
%   The process of Address has said that it has no such host: say which
%   ones it has.
%
%   @error existence_error(host, Address)

host_unknown(Address) :-
    host_resolve(Address, remote(_, _, Endpoint)),
    catch(ask(Endpoint, Address, hosts, Names), error(_, _), fail),
    Names = [_|_],
    !,
    atomic_list_concat(Names, ', ', Listed),
    atom_concat('there are: ', Listed, Text),
    throw(error(existence_error(host, Address), context(_, Text))).
host_unknown(Address) :-
    existence_error(host, Address).

ask(Endpoint, Host, Question, Answer) :-
    process_ask(Endpoint, Host, hosting, Question, Answer, 10).

typhon_endpoint:requested(hosting, Question, Peer, ReplyTo) :-
    (   may_ask(Question, Peer)
    ->  hosting_answer(Question, Answer)
    ;   Answer = none
    ),
    endpoint_reply(ReplyTo, Answer).

may_ask(Question, Peer) :-
    (   needs(Question, Name, Right)
    ->  peer_may(Peer, Name, Right)
    ;   true
    ).

needs(host_properties(Name), Name, inspect).
needs(link(Name, _), Name, orders).
needs(link(Name, _, _), Name, orders).
needs(unlink(Name, _), Name, orders).

hosting_answer(host_properties(Name), Properties) :-
    (   host(Name, _, _)
    ->  findall(P, local_property(P, Name), Properties)
    ;   Properties = none
    ).
hosting_answer(hosts, Names) :-
    findall(Name, host(Name, _, _), Names).
hosting_answer(link(Name, Address), Answer) :-
    change_link(Name, host_link(Name, Address, same), Answer).
hosting_answer(link(Name, Address, Cost), Answer) :-
    must_be(number, Cost),
    change_link(Name, host_link(Name, Address, Cost), Answer).
hosting_answer(unlink(Name, Address), Answer) :-
    change_link(Name, host_unlink(Name, Address), Answer).

change_link(Name, Change, Answer) :-
    (   host(Name, _, _)
    ->  call(Change),
        Answer = ok
    ;   Answer = none
    ).
