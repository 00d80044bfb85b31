:- module(typhon_runtime,
          [ runtime_acquire/2,          % +User, +Options
            runtime_release/1           % +User
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../base/erased', [forget_erased/0]).
:- use_module('../base/own_thread',
              [in_own_thread/1, own_thread_start/0, own_thread_stop/0]).
:- use_module('../program', [code_clear/0]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_start/3, endpoint_start_alone/1,
                endpoint_stop/0 ]).
:- use_module(scheduler, [scheduler_forget/0]).
:- use_module(time, [time_kind/1, time_start/1, time_stop/0]).

/** <module> What the hosts of a process share

The endpoint and the scheduler run as long as anybody in the process uses
them: hosts, log servers.  The first user starts them, the last one stops
them.  The rooms above that have something to see to then say so with the
hooks beginning/1 and ending/1.

*Threading*: a mutex makes users come and go one at a time.
*/

:- multifile
    beginning/1,                        % real or virtual: time has started
    ending/1.                           % before or after both have stopped

:- dynamic
    beginning/1,
    ending/1,
    user/1.                             % Name of a user

%!  runtime_acquire(+User, +Options) is det.
%
%   User, any ground term, needs endpoint and time.  Options port(P) and
%   bind(Interface) are for the first user; later ones may only repeat what
%   is so.  The same goes for time(Kind), `real` or `virtual`: who does not
%   say is content with either.  In virtual time the endpoint reaches nobody
%   else.
%
%   @error permission_error(change, endpoint, Option)
%   @error permission_error(change, kind_of_time, Kind)

runtime_acquire(User, Options) :-
    with_mutex(typhon_runtime, acquire(User, Options)).

acquire(User, Options) :-
    (   user(_)
    ->  forall(member(Option, Options), must_agree(Option))
    ;   start(Options)
    ),
    assertz(user(User)),
    debug(typhon(host), '~p uses the process', [User]).

start(Options) :-
    option(time(Kind), Options, real),
    own_thread_start,
    catch(( time_start(Kind),
            start_endpoint(Kind, Options),
            forall(beginning(Kind), true)
          ),
          Ball,
          ( time_stop, own_thread_stop, throw(Ball) )),
    forget_erased.

start_endpoint(real, Options) :-
    option(port(Port), Options, 0),
    option(bind(Interface), Options, localhost),
    endpoint_start(Interface, Port, _).
start_endpoint(virtual, _) :-
    endpoint_start_alone('virtual:0').

must_agree(time(Kind)) :-
    \+ time_kind(Kind),
    !,
    permission_error(change, kind_of_time, Kind).
must_agree(Option) :-
    (   disagrees(Option)
    ->  permission_error(change, endpoint, Option)
    ;   true
    ).

disagrees(port(Port)) :-
    Port \== 0,
    endpoint_address(Endpoint),
    atomic_list_concat([_,Port0], ':', Endpoint),
    \+ atom_number(Port0, Port).
disagrees(bind(Interface)) :-
    Interface \== localhost,
    endpoint_address(Endpoint),
    \+ atomic_list_concat([Interface,_], ':', Endpoint).

%!  runtime_release(+User) is det.

runtime_release(User) :-
    in_own_thread(with_mutex(typhon_runtime, release(User))).

release(User) :-
    debug(typhon(host), '~p has done with the process', [User]),
    (   retract(user(User)),
        \+ user(_)
    ->  forall(ending(before), true),
        endpoint_stop,
        time_stop,
        scheduler_forget,
        code_clear,
        forall(ending(after), true),
        own_thread_stop
    ;   true
    ).
