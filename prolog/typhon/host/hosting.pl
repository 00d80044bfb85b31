:- module(typhon_hosting,
          [ host_start/1,               % +Name
            host_start/2,               % +Name, +Options
            host_stop/1,                % +Name
            host_property/2,            % ?Name, ?Property
            link/2,                     % +HostA, +HostB
            unlink/2                    % +HostA, +HostB
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_call/5, endpoint_reply/2]).
:- use_module(clock, [clock_clear/1, clock_set/3]).
:- use_module(hosts,
              [ address_parts/3, host/3, host_add/4, host_address/2,
                host_close/1, host_hop_stats/3, host_link/2, host_load/2,
                host_neighbours/2, host_option/2, host_remove/1,
                host_resolve/2, host_unlink/2 ]).
:- use_module(place, [place_create/4, place_destroy/1]).
:- use_module(runtime, [runtime_acquire/2, runtime_release/1]).
:- use_module(scheduler, [scheduler_limit/2, scheduler_unlimit/1]).

/** <module> Starting, stopping and linking hosts

A host holds a place, a clock, an entry in the scheduler, and with the
other users of the process its endpoint, see typhon_runtime.

*Threading*: host_start/2 and host_stop/1 exclude each other by a mutex.
*/

:- setting(stop_seconds, number, 2,
           "Agents have so long to come to an effect when their host stops").

:- multifile
    evacuate/2,                 % Name, Deadline: nobody is left on the host
    typhon_endpoint:requested/4.

:- dynamic evacuate/2.

                /*******************************
                *             START            *
                *******************************/

%!  host_start(+Name) is det.
%!  host_start(+Name, +Options) is det.
%
%   Start a host in this process.  Options:
%
%     - port(+Port): of the endpoint of the process, 0 for any; only for
%       the first host
%     - bind(+Interface): default localhost; only for the first host
%     - capacity(+N): that many agents at the most, or `inf`
%     - tokens(+List): an agent must carry one of them to be let in
%     - concurrency(+N): that many agents run at a time, default `inf`
%     - consult(+Files): clause files consulted into its place
%     - services(+Modules): modules whose exports its place offers
%     - place(+Module): a module all of whose predicates it offers
%     - log(+Address): the log server
%     - remote(+Boolean): whether remote/2 is answered, default `true`
%     - clock(+Epoch, +Rate): see typhon_clock
%     - hop_time(uniform(Min, Max)): delay added to hops out of it
%     - seed(+Integer): for the choices of migration strategies
%
%   @error permission_error(start, host, Name) if it runs already
%   @error domain_error(host_option, Option)

host_start(Name) :-
    host_start(Name, []).

host_start(Name, Options) :-
    must_be(atom, Name),
    must_be(list, Options),
    (   sub_atom(Name, _, _, _, @)
    ->  domain_error(host_name, Name)
    ;   true
    ),
    maplist(check_option, Options),
    with_mutex(typhon_hosting, start(Name, Options)).

check_option(Option) :-
    (   host_option_type(Option, Type, Value)
    ->  must_be(Type, Value)
    ;   domain_error(host_option, Option)
    ).

host_option_type(port(X), between(0, 65535), X).
host_option_type(bind(X), atom, X).
host_option_type(capacity(X), oneof([inf]), X) :- X == inf, !.
host_option_type(capacity(X), nonneg, X).
host_option_type(tokens(X), list, X).
host_option_type(concurrency(X), oneof([inf]), X) :- X == inf, !.
host_option_type(concurrency(X), positive_integer, X).
host_option_type(consult(X), ground, X).
host_option_type(services(X), ground, X).
host_option_type(place(X), atom, X).
host_option_type(log(X), atom, X).
host_option_type(remote(X), boolean, X).
host_option_type(clock(X, Y), list(number), [X,Y]).
host_option_type(hop_time(uniform(X, Y)), list(number), [X,Y]).
host_option_type(seed(X), integer, X).

start(Name, _) :-
    host(Name, _, _),
    !,
    permission_error(start, host, Name).
start(Name, Options) :-
    runtime_acquire(host(Name), Options),
    catch(start_host(Name, Options), Ball,
          ( runtime_release(host(Name)), throw(Ball) )).

start_host(Name, Options) :-
    endpoint_address(Endpoint),
    address_parts(Address, Name, Endpoint),
    (   memberchk(clock(Epoch, Rate), Options)
    ->  true
    ;   Epoch = 0, Rate = 1
    ),
    option(concurrency(Concurrency), Options, inf),
    place_parts(Options, Files, Services),
    place_create(Name, Files, Services, Place),
    clock_set(Name, Epoch, Rate),
    scheduler_limit(Name, Concurrency),
    host_add(Name, Address, Place, Options).

place_parts(Options, Files, Services) :-
    option(consult(Files0), Options, []),
    option(services(Services0), Options, []),
    listed(Files0, Files),
    listed(Services0, Services1),
    (   option(place(Module), Options)
    ->  Services = [module(Module)|Services1]
    ;   Services = Services1
    ).

listed(List, List) :-
    is_list(List),
    !.
listed(One, [One]).

                /*******************************
                *             STOP             *
                *******************************/

%!  host_stop(+Name) is det.
%
%   Dispose of the agents on Name and release all it holds.
%
%   @error existence_error(host, Name)

host_stop(Name) :-
    must_be(atom, Name),
    in_own_thread(with_mutex(typhon_hosting, stop(Name))).

stop(Name0) :-
    local_name(Name0, Name),
    host(Name, Address, Place),
    host_close(Name),
    scheduler_unlimit(Name),
    get_time(Now),
    setting(stop_seconds, Seconds),
    Deadline is Now+Seconds,
    forall(evacuate(Name, Deadline), true),
    host_unlink(_, Address),
    host_remove(Name),
    clock_clear(Name),
    place_destroy(Place),
    runtime_release(host(Name)).

local_name(Host, Name) :-
    host_resolve(Host, Where),
    (   Where = local(Name)
    ->  true
    ;   existence_error(host, Host)
    ).

                /*******************************
                *          PROPERTIES          *
                *******************************/

%!  host_property(?Name, ?Property) is nondet.
%
%   Property is address(A), state(running), capacity(N), load(N),
%   neighbours(L), hop_time(Direction, stats(Count,Min,Mean,Max)) (host
%   seconds) or place(M).  Name may be the address of a host of another
%   process, too.
%
%   @error existence_error(host, Name)

host_property(Name, Property) :-
    var(Name),
    !,
    host(Name, _, _),
    local_property(Property, Name).
host_property(Host, Property) :-
    host_resolve(Host, Where),
    property(Where, Host, Property).

property(local(Name), _, Property) :-
    local_property(Property, Name).
property(remote(_, Name, Endpoint), Host, Property) :-
    ask(Endpoint, host_properties(Name), Properties),
    (   Properties == none
    ->  existence_error(host, Host)
    ;   member(Property, Properties)
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

ask(Endpoint, Question, Answer) :-
    catch(endpoint_call(Endpoint, hosting, Question, answer(Answer), 10),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

typhon_endpoint:requested(hosting, Question, _Peer, ReplyTo) :-
    hosting_answer(Question, Answer),
    endpoint_reply(ReplyTo, Answer).

hosting_answer(host_properties(Name), Properties) :-
    (   host(Name, _, _)
    ->  findall(P, local_property(P, Name), Properties)
    ;   Properties = none
    ).
hosting_answer(link(Name, Address), Answer) :-
    change_link(Name, Address, host_link, Answer).
hosting_answer(unlink(Name, Address), Answer) :-
    change_link(Name, Address, host_unlink, Answer).

change_link(Name, Address, Change, Answer) :-
    (   host(Name, _, _)
    ->  call(Change, Name, Address),
        Answer = ok
    ;   Answer = none
    ).

                /*******************************
                *             LINKS            *
                *******************************/

%!  link(+A, +B) is det.
%!  unlink(+A, +B) is det.
%
%   Make or break the overlay link between two hosts, both ways; either may
%   be in another process.
%
%   @error existence_error(host, Host)

link(A, B) :-
    both(A, B, link).

unlink(A, B) :-
    both(A, B, unlink).

both(A, B, Change) :-
    must_be(atom, A),
    must_be(atom, B),
    host_address(A, AddressA),
    host_address(B, AddressB),
    (   AddressA == AddressB
    ->  domain_error(other_host, B)
    ;   one_way(AddressA, AddressB, Change),
        one_way(AddressB, AddressA, Change)
    ).

one_way(From, To, Change) :-
    host_resolve(From, Where),
    (   Where = local(Name)
    ->  hosting_answer_for(Change, Name, To, Answer)
    ;   Where = remote(_, Name, Endpoint),
        hosting_question(Change, Name, To, Question),
        ask(Endpoint, Question, Answer)
    ),
    (   Answer == ok
    ->  true
    ;   existence_error(host, From)
    ).

hosting_answer_for(Change, Name, To, Answer) :-
    hosting_question(Change, Name, To, Question),
    hosting_answer(Question, Answer).

hosting_question(link, Name, To, link(Name, To)).
hosting_question(unlink, Name, To, unlink(Name, To)).
