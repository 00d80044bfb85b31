:- module(typhon_process,
          [ process_acquire/2,          % +User, +Options
            process_release/1           % +User
          ]).
:- use_module(library(option), [option/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(aside, [aside/1, aside_start/0, aside_stop/0]).
:- use_module(code, [code_clear/0]).
:- use_module(endpoint,
              [ endpoint_start/3, endpoint_stop/0, endpoint_address/1 ]).
:- use_module(scheduler, [scheduler_start/0, scheduler_stop/0]).

/** <module> What the hosts of a process share

The endpoint and the scheduler run as long as anybody in the process uses
them: hosts, log servers.  The first user starts them, the last one stops
them.  The rooms above that have something to see to then say so with the
hook ending/1.

*Threading*: a mutex makes users come and go one at a time.
*/

:- multifile
    ending/1.                           % before or after both have stopped

:- dynamic
    ending/1,
    user/1.                             % Name of a user

%!  process_acquire(+User, +Options) is det.
%
%   User, any ground term, needs endpoint and scheduler.  Options port(P)
%   and bind(Interface) are for the first user; later ones may only repeat
%   what is so.
%
%   @error permission_error(change, endpoint, Option)

process_acquire(User, Options) :-
    with_mutex(typhon_process, acquire(User, Options)).

acquire(User, Options) :-
    (   user(_)
    ->  forall(member(Option, Options), must_agree(Option))
    ;   start(Options)
    ),
    assertz(user(User)).

start(Options) :-
    option(port(Port), Options, 0),
    option(bind(Interface), Options, localhost),
    aside_start,
    catch(( scheduler_start,
            endpoint_start(Interface, Port, _)
          ),
          Ball,
          ( scheduler_stop, aside_stop, throw(Ball) )).

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

%!  process_release(+User) is det.

process_release(User) :-
    aside(with_mutex(typhon_process, release(User))).

release(User) :-
    (   retract(user(User)),
        \+ user(_)
    ->  forall(ending(before), true),
        endpoint_stop,
        scheduler_stop,
        code_clear,
        forall(ending(after), true),
        aside_stop
    ;   true
    ).
