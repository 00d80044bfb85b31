:- module(typhon_host_questions,
          [ property_of_host/2,         % ?Name, ?Property
            change_host/2,              % +Host, +Option
            link_hosts/2,               % +HostA, +HostB
            link_hosts/3,               % +HostA, +HostB, +Options
            unlink_hosts/2              % +HostA, +HostB
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [domain_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/base/durable', [sync_after/1]).
:- use_module('../../kernel/base/options',
              [check_name/2, check_option/2, check_options/2]).
:- use_module('../../kernel/wire', [endpoint_reply/2]).
:- use_module('../../kernel/host',
              [ host/3, host_address/2, host_hop_times/3, host_link/3,
                host_listed/2, host_load/2, host_neighbours/2, host_option/2,
                host_put/2, host_resolve/2, host_unknown/1, host_unlink/2,
                parts_load/1, peer_may/3, place_offer/2, process_ask/6 ]).
:- use_module('../../options/remote', [run_remote/2]).

/** <module> Properties, links and changes of hosts of any process

Another process gets a request of kind `hosting` about its hosts.

*Threading*: any thread.  Threads of connections answer requests.  A mutex
excludes changes of a host while hosts start or end.
*/

:- multifile
    typhon_names:known/2,
    typhon_options:declared/4,
    typhon_endpoint:requested/4.

%!  property_of_host(?Name, ?Property) is nondet.
%!  change_host(+Host, +Option) is det.
%!  link_hosts(+A, +B) is det.
%!  link_hosts(+A, +B, +Options) is det.
%!  unlink_hosts(+A, +B) is det.
%
%   As host_property/2, host_change/2, link/2, link/3 and unlink/2.

property_of_host(Name, Property) :-
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
        member(Property, Found)         % no choice point for one property
    ).

:- '$clausable'(local_property/2).

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
local_property(hop_time(Direction, Times), Name) :-
    host_hop_times(Name, Direction, Times).
local_property(place(Place), Name) :-
    host(Name, _, Place).

                /*******************************
                *             LINKS            *
                *******************************/

link_hosts(A, B) :-
    make_link(A, B, link).

link_hosts(A, B, Options) :-
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

%   The change that may fail comes first, so that no half of a link remains.

make_link(A, B, Change) :-
    ends(A, B, Near, Far),
    must_be_there(Near),
    one_way(Far, Near, Change),
    one_way(Near, Far, Change).

unlink_hosts(A, B) :-
    ends(A, B, Near, Far),
    one_way(Near, Far, unlink),
    one_way(Far, Near, unlink).

%   ends(+A, +B, -Near, -Far): Near and Far are the addresses of A and B.  Near
%   is a host of this process if one of them is.

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
    catch(ask(Endpoint, Address, hosts, Names),
          error(permission_error(watch, host, _), _),
          Names = [Name]),              % a right is needed to see that
    memberchk(Name, Names).

one_way(From, To, Change) :-
    host_resolve(From, Where),
    change_link(Where, Change, To, Answer),
    (   Answer == ok
    ->  debug(typhon(host), '~w: ~w ~w', [From, Change, To])
    ;   host_unknown(From)
    ).

change_link(local(Name), Change, To, Answer) :-
    hosting_question(Change, Name, To, Question),
    hosting_answer(Question, Answer).
change_link(remote(Host, Name, Endpoint), Change, To, Answer) :-
    hosting_question(Change, Name, To, Question),
    ask(Endpoint, Host, Question, Answer).

hosting_question(link, Name, To, link(Name, To)).
hosting_question(link(Cost), Name, To, link(Name, To, Cost)).
hosting_question(unlink, Name, To, unlink(Name, To)).

                /*******************************
                *           REQUESTS           *
                *******************************/

ask(Endpoint, Host, Question, Answer) :-
    process_ask(Endpoint, Host, hosting, Question, Answer, 10).

typhon_endpoint:requested(hosting, hosts, Peer, ReplyTo) :-
    !,
    findall(Name, ( host(Name, _, _), peer_may(Peer, Name, watch) ), Names),
    endpoint_reply(ReplyTo, Names).
typhon_endpoint:requested(hosting, Question, _, ReplyTo) :-
    hosting_answer(Question, Answer),
    endpoint_reply(ReplyTo, Answer).

hosting_answer(host_properties(Name), Properties) :-
    (   host(Name, _, _)
    ->  findall(P, local_property(P, Name), Properties)
    ;   Properties = none
    ).
hosting_answer(link(Name, Address), Answer) :-
    change_link(Name, host_link(Name, Address, same), Answer).
hosting_answer(link(Name, Address, Cost), Answer) :-
    change_link(Name, host_link(Name, Address, Cost), Answer).
hosting_answer(unlink(Name, Address), Answer) :-
    change_link(Name, host_unlink(Name, Address), Answer).

change_link(Name, Change, Answer) :-
    (   host(Name, _, _)
    ->  call(Change),
        Answer = ok
    ;   Answer = none
    ).

                /*******************************
                *            CHANGES           *
                *******************************/

change_host(Host, Option) :-
    check_option(host_option, Option),
    parts_load([Option]),
    host_resolve(Host, Where),
    change_at(Where, Option).

change_at(local(Name), Option) :-
    sync_after(with_mutex(typhon_hosting, change(Option, Name))).
change_at(remote(Address, Name, _), Option) :-
    run_remote(Address, typhon_administration:host_change(Name, Option)).

change(services(Services0), Name) =>
    host(Name, _, Place),
    host_listed(Services0, Services),
    forall(member(Service, Services), place_offer(Place, Service)).
change(Option, Name), typhon_host_parts:changeable(Option) =>
    forall(typhon_host_parts:changes(Option, Name), true),
    host_put(Name, Option).
change(Option, Name), changes(Option) =>
    host_put(Name, Option).
change(Option, _) =>
    permission_error(change, host_option, Option).

changes(tokens(_)).
changes(capacity(_)).
changes(hop_time(_)).
changes(python(_)).
changes(remote(_)).
changes(seed(_)).
