:- module(typhon_runtime,
          [ runtime_acquire/2,          % +User, +Options
            runtime_acquire/3,          % +User, +Options, -Endpoint
            runtime_release/1,          % +User
            process_ask/6,              % +Endpoint, +Host, +Kind, +Term,
                                        % -Answer, +Seconds
            host_unknown/1,             % +Address
            as_guest/1,                 % :Goal
            guests_leave/0
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../base/monotonic',
              [monotonic_start/0, monotonic_stop/0, poll_within/2]).
:- use_module('../base/prolog_faults',
              [collect_clauses_less_often/0, forget_erased/0, functors_room/0]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/process_setup', [descriptors_open/0]).
:- use_module('../base/own_thread',
              [ in_own_thread/1, own_thread_start/0, own_thread_stop/0,
                stop_steps/1 ]).
:- use_module('../base/durable', [durable_end/0, durable_restores/0]).
:- use_module('../program', [code_clear/0]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_listen/2,
                endpoint_listen_end/1, endpoint_missed/2,
                endpoint_option/1, endpoint_start/4,
                endpoint_start_alone/1, endpoint_stop/0,
                transport_disagrees/1 ]).
:- use_module(hosts, [host_resolve/2]).
:- use_module(time,
              [ time_apart/2, time_default/1, time_kind/1, time_start/1,
                time_stop/0 ]).

/** <module> The endpoint and the runtime that the hosts of a process share

The endpoint and the scheduler run as long as the process has users of them:
hosts, log servers.  The first user starts them, the last one stops them.
Higher layers join by the hooks beginning/1 and ending/1.

A process without hosts becomes a guest in the network to ask a question: it
has an endpoint of its own until it has the answer.

*Threading*: a mutex serializes the arrival and departure of users.  Any thread
that may wait can ask questions.  Threads of the platform do not become guests:
stopping the platform waits for them.
*/

:- multifile
    beginning/1,                        % Kind of the runtime that has started
    ending/1.                           % before or after endpoint and time stop

:- '$clausable'(ending/1).

:- dynamic user/2.              % Name of a user, Endpoint

%   This runs when the module is loaded, or a saved state with it starts: once a
%   host runs, the process may have other threads.

:- initialization(functors_room).

%!  runtime_acquire(+User, +Options) is det.
%!  runtime_acquire(+User, +Options, -Endpoint) is det.
%
%   Start endpoint and time for User, any ground term, unless they run already.
%   Endpoint is the address at which User is reached.  The first user decides
%   with port(P), bind(Interface), advertise(Address), see endpoint_start/4, and
%   tls(Directory), which is by default that of the environment variable
%   `TYPHON_TLS`.  Later users cannot change interface, address and keys.  For
%   another port the process listens there, too, as long as a user needs it.  time(Kind), see typhon_time, cannot be changed
%   either; a user without it accepts any kind.  Where the runtime is apart the
%   endpoint reaches no other process, and ports have no meaning.
%
%   @error permission_error(change, endpoint, Option)
%   @error permission_error(change, kind_of_time, Kind)

runtime_acquire(User, Options) :-
    runtime_acquire(User, Options, _).

runtime_acquire(User, Options, Endpoint) :-
    time_default(Default),
    option(time(Kind), Options, Default),
    on_demand_load(time, Kind),
    with_mutex(typhon_runtime, acquire(User, Kind, Options, Endpoint)).

acquire(User, Kind, Options, Endpoint) :-
    (   user(_, _)
    ->  forall(member(Option, Options), must_agree(Option))
    ;   start(Kind, Options)
    ),
    option(port(Port), Options, 0),
    reached_at(Port, Endpoint),
    assertz(user(User, Endpoint)),
    debug(typhon(host), '~p uses the process, at ~w', [User, Endpoint]).

reached_at(Port, Endpoint) :-
    (   ( Port =:= 0 ; time_kind(Kind), time_apart(Kind, _) )
    ->  endpoint_address(Endpoint)
    ;   endpoint_listen(Port, Endpoint)
    ).

start(Kind, Options) :-
    descriptors_open,
    collect_clauses_less_often,
    own_thread_start,
    catch(( monotonic_start,
            time_start(Kind),
            start_endpoint(Kind, Options),
            forall(beginning(Kind), true)
          ),
          Ball,
          ( stop_steps([ endpoint_stop, time_stop, monotonic_stop,
                         own_thread_stop ]),
            throw(Ball) )),
    forget_erased.

start_endpoint(Kind, _) :-
    time_apart(Kind, Address),
    !,
    endpoint_start_alone(Address).
start_endpoint(_, Options) :-
    option(port(Port), Options, 0),
    option(bind(Interface), Options, localhost),
    endpoint_start(Interface, Port, Options, _).

must_agree(time(Kind)) :-
    \+ time_kind(Kind),
    !,
    permission_error(change, kind_of_time, Kind).
must_agree(Option) :-
    (   disagrees(Option)
    ->  permission_error(change, endpoint, Option)
    ;   true
    ).

disagrees(Option) :-
    transport_disagrees(Option).
disagrees(bind(Interface)) :-
    Interface \== localhost,
    \+ endpoint_option(bind(Interface)).
disagrees(advertise(Address)) :-
    \+ endpoint_option(advertise(Address)).

%!  runtime_release(+User) is det.
%
%   End the use of endpoint and time by User.  The last user stops them.

runtime_release(User) :-
    in_own_thread(with_mutex(typhon_runtime, release(User))).

release(User) :-
    debug(typhon(host), '~p has done with the process', [User]),
    (   retract(user(User, Endpoint))
    ->  released(Endpoint)
    ;   true
    ).

released(Endpoint) :-
    user(_, Endpoint),
    !.
released(Endpoint) :-
    user(_, _),
    !,
    endpoint_listen_end(Endpoint).
released(_) :-
    stop_steps([ each(ending(before)), endpoint_stop, time_stop, durable_end,
                 code_clear, each(ending(after)), monotonic_stop,
                 own_thread_stop ]).

                /*******************************
                *            GUESTS            *
                *******************************/

:- meta_predicate as_guest(0).

%!  process_ask(+Endpoint, +Host, +Kind, +Term, -Answer, +Seconds) is det.
%
%   As endpoint_call/5; errors name the process as Host.
%
%   @error host_unreachable(Host)
%   @error permission_error(authenticate, host, Host): that process has
%   another cookie than this one
%   @error permission_error(Right, host, Host): this process lacks a right
%   @error those of endpoint_call/5

process_ask(Endpoint, Host, Kind, Term, Answer, Seconds) :-
    as_guest(catch(endpoint_call(Endpoint, Kind, Term, answer(Answer0),
                                 Seconds),
                   error(unreachable(_), _),
                   unreachable(Endpoint, Host))),
    (   Answer0 = not_permitted(Right)
    ->  permission_error(Right, host, Host)
    ;   Answer = Answer0
    ).

unreachable(Endpoint, Host) :-
    (   endpoint_missed(Endpoint, permission_error(authenticate, peer, cookie))
    ->  Formal = permission_error(authenticate, host, Host)
    ;   Formal = host_unreachable(Host)
    ),
    throw(error(Formal, _)).

%!  host_unknown(+Address) is failure.
%
%   The process of Address has no such host: raise an error that lists its
%   hosts.
%
%   @error existence_error(host, Address)

host_unknown(Address) :-
    host_resolve(Address, remote(_, _, Endpoint)),
    catch(process_ask(Endpoint, Address, hosting, hosts, Names, 10),
          error(_, _), fail),
    Names = [_|_],
    atomic_list_concat(Names, ', ', Listed),
    atom_concat('there are: ', Listed, Text),
    throw(error(existence_error(host, Address), context(_, Text))).
host_unknown(Address) :-
    existence_error(host, Address).

%!  as_guest(:Goal) is semidet.
%
%   As once(Goal).  If this process has no endpoint, or has it only for other
%   guests, it has one while Goal runs.  While hosts start or stop this waits.

as_guest(Goal) :-
    (   no_guest,
        \+ durable_restores
    ;   own_thread
    ),
    !,
    once(Goal).
as_guest(Goal) :-
    with_mutex(typhon_hosting, guest_enters(Guest)),
    setup_call_cleanup(true, once(Goal), runtime_release(Guest)).

no_guest :-
    user(User, _),
    User \= guest(_),
    !.

guest_enters(none) :-
    no_guest,
    !.
guest_enters(guest(N)) :-
    flag(typhon_guest, N, N+1),
    runtime_acquire(guest(N), []).

%!  guests_leave is det.
%
%   For the thread that starts a host: wait until the questions of guests are
%   over, or have taken too long, and the runtime of former users has stopped.

guests_leave :-
    longest_question(Seconds),
    in_own_thread(ignore(poll_within(Seconds, no_guests))).

no_guests :-
    with_mutex(typhon_runtime, \+ user(guest(_), _)).

longest_question(10).

own_thread :-
    thread_self(Me),
    atom(Me),
    sub_atom(Me, 0, _, _, typhon_).
