:- module(typhon_transport,
          [ transport/3,                % ?Key, ?Thread, -Out
            transport_thread/2,         % ?Key, ?Thread
            transport_attach/3,         % +Key, +Thread, +Out
            transport_stop/2,           % +Key, +Thread
            transport_broken/2,         % +Key, +Thread
            transport_detach/2,         % +Key, +Thread
            session_up/1,               % +Key
            session_up_since/2,         % +Session, +Time
            route_up/2                  % ?Address, -Session
          ]).

/** <module> The connection a session has now

A session has at most one connection at a time. It belongs to a thread, see
connection.pl, and can be written to until it turns out that it cannot.

*Threading*: the mutex of the session guards changes; any thread may ask.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(session, [route/2, session_key/2]).
:- use_module(threads, [wire_thread_signal/2]).

:- dynamic
    transport/3,                        % Key, Thread, Out
    serving/3.                          % Key, Thread, Since

%!  transport(?Key, ?Thread, -Out) is nondet.
%
%   What is sent in the session is written to Out, of Thread.

%!  transport_thread(?Key, ?Thread) is nondet.
%
%   Thread has the connection, be it that nothing can be written to it.

transport_thread(Key, Thread) :-
    serving(Key, Thread, _).

%!  transport_attach(+Key, +Thread, +Out) is det.
%!  transport_stop(+Key, +Thread) is det.
%!  transport_detach(+Key, +Thread) is det.
%
%   Thread has a connection for the session; nothing is written to it any
%   more; the session has lost it.

transport_attach(Key, Thread, Out) :-
    get_time(Now),
    assertz(serving(Key, Thread, Now)),
    assertz(transport(Key, Thread, Out)).

transport_stop(Key, Thread) :-
    retractall(transport(Key, Thread, _)).

transport_detach(Key, Thread) :-
    retractall(serving(Key, Thread, _)).

%!  transport_broken(+Key, +Thread) is det.
%
%   A connection that cannot be written to is none; its thread finds out by
%   itself or is told.

transport_broken(Key, Thread) :-
    debug(typhon(session), '~w: cannot be written to', [Key]),
    transport_stop(Key, Thread),
    wire_thread_signal(Thread, broken).

%!  session_up(+Key) is semidet.
%
%   The session has a connection that can be written to.

session_up(Key) :-
    transport(Key, _, _),
    !.

%!  session_up_since(+Session, +Time) is semidet.
%
%   The session is up, and got its connection after Time.

session_up_since(Session, Time) :-
    session_key(Session, Key),
    serving(Key, Thread, Since),
    Since > Time,
    transport(Key, Thread, _),
    !.

%!  route_up(?Address, -Session) is nondet.
%
%   Address leads to Session, which is up.

route_up(Address, Session) :-
    route(Address, Session),
    session_key(Session, Key),
    session_up(Key).
