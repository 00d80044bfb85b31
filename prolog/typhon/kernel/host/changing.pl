:- module(typhon_changing,
          [ host_change/2,              % +Host, +Option
            host_listed/2               % +ListOrOne, -List
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/options', [check_option/2]).
:- use_module('../base/durable_changes', [sync_changes/0]).
:- use_module(host_names, [host_resolve/2]).
:- use_module(host_parts, [parts_load/1]).
:- use_module(hosts, [host/3, host_option/2, host_put/2]).
:- use_module(place, [place_offer/2]).
:- use_module(remote, [remote/2]).
:- use_module(scheduler, [scheduler_limit/2]).

/** <module> Changing hosts that run

*Threading*: any thread; a change, and the start and the end of a host, exclude
each other by a mutex.
*/

%!  host_change(+Host, +Option) is det.
%
%   Change an option of a host that runs, here or elsewhere: tokens, capacity,
%   authors, concurrency, hop_time, log, audit, peer, policy, python, quota,
%   remote, seed or trail, as of host_start/2, or services, to which those given
%   are added.  Agents on the host stay, also if fewer are admitted from
%   now on.
%
%   @error existence_error(host, Host)
%   @error permission_error(change, host_option, Option)

host_change(Host, Option) :-
    check_option(host_option, Option),
    parts_load([Option]),
    host_resolve(Host, Where),
    change_at(Where, Option).

change_at(local(Name), Option) :-
    with_mutex(typhon_hosting, change(Option, Name)),
    sync_changes.
change_at(remote(Address, Name, _), Option) :-
    remote(Address, typhon_changing:host_change(Name, Option)).

change(concurrency(Concurrency), Name) =>
    host_put(Name, concurrency(Concurrency)),
    scheduler_limit(Name, Concurrency).
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
changes(log(_)).
changes(python(_)).
changes(remote(_)).
changes(seed(_)).

                /*******************************
                *         HOST OPTIONS         *
                *******************************/

%   What may be said of a host that is started.
%
%   What it means is described at host_start/2, which of it may be changed later
%   at host_change/2.

:- multifile typhon_options:declared/4.

typhon_options:declared(host_option, Option, Type, Value) :-
    host_option_type(Option, Type, Value).

host_option_type(port(X), between(0, 65535), X).
host_option_type(bind(X), atom, X).
host_option_type(capacity(X), nonneg, X).
host_option_type(capacity(X), oneof([inf]), X).
host_option_type(tokens(X), list, X).
host_option_type(concurrency(X), positive_integer, X).
host_option_type(concurrency(X), oneof([inf]), X).
host_option_type(consult(X), ground, X).
host_option_type(services(X), ground, X).
host_option_type(place(X), atom, X).
host_option_type(log(X), host_address, X).
host_option_type(log(X, _), host_address, X).
host_option_type(remote(X), boolean, X).
host_option_type(clock(X, Y), list(number), [X,Y]).
host_option_type(hop_time(uniform(X, Y)), list(number), [X,Y]).
host_option_type(seed(X), integer, X).
host_option_type(python(X), boolean, X).

%!  host_listed(+ListOrOne, -List) is det.
%
%   What is not a list is the only one in it.

host_listed(List, List) :-
    is_list(List),
    !.
host_listed(One, [One]).
