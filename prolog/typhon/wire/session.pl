:- module(typhon_session,
          [ session/2,                  % ?Key, -Session
            session_open/4,             % +Key, +Hello, +Codec, -Session
            session_forget/1,           % +Session
            session_peer/3,             % ?Key, -Process, -Address
            session_received/2,         % +Key, -Count
            session_note_received/2,    % +Key, +Count
            session_adopting/2,         % +Session, :Goal
            route/2,                    % ?Address, ?Session
            route_add/2                 % +Address, +Session
          ]).

/** <module> Sessions: who we are joined to

A session joins this process to another for the life of both, over however
many connections. What is sent in it is the business of outbox.pl.

A session is session(Key, Codec, Mutex, Adoption, peer(Process, Address)).
Key names the peer. Mutex guards the sending side; that of Adoption is held
by who gives the session a new connection.

_Threading_: any thread; a mutex makes sessions and routes one at a time.
The count of what was received is for the thread of the connection alone.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module(threads, [crew_tell/1]).

:- setting(frame_bytes, positive_integer, 67108864,
           "The longest frame sent or taken, in bytes").

:- meta_predicate
    session_adopting(+, 0).

:- dynamic
    session/2,                          % Key, Session
    route/2,                            % Address, Session
    received/2.                         % Key, Count

%!  session(?Key, -Session) is nondet.
%!  session_peer(?Key, -Process, -Address) is nondet.
%!  route(?Address, ?Session) is nondet.
%
%   The sessions there are, whom each one joins us to, and which addresses
%   lead to it.

session_peer(Key, Process, Address) :-
    session(Key, session(_, _, _, _, peer(Process, Address))).

%!  session_open(+Key, +Hello, +Codec, -Session) is det.
%
%   The session with the peer Key, a new one on first contact.

session_open(Key, Hello, Codec, Session) :-
    with_mutex(typhon_session, open_session(Key, Hello, Codec, Session)).

open_session(Key, _, _, Session) :-
    session(Key, Session),
    !.
open_session(Key, hello(Process, _, Address, _, _, _), Codec, Session) :-
    mutex_create(Mutex),
    mutex_create(Adoption),
    Session = session(Key, Codec, Mutex, Adoption, peer(Process, Address)),
    assertz(received(Key, 0)),
    assertz(session(Key, Session)).

%!  session_forget(+Session) is semidet.
%
%   There is no such session any more; fails when there is none already.
%   The mutexes are left to the garbage collector: somebody may wait for
%   them.

session_forget(Session) :-
    Session = session(Key, _, _, _, _),
    with_mutex(typhon_session,
               ( retract(session(Key, Session)),
                 retractall(route(_, Session)),
                 retractall(received(Key, _)) )).

%!  route_add(+Address, +Session) is det.
%
%   Address leads to Session from now on, if that has not been forgotten.
%   The keeper hears displaced(Key) of the session it led to before.

route_add(Address, Session) :-
    route(Address, Session),
    !.
route_add(Address, Session) :-
    arg(1, Session, Key),
    with_mutex(typhon_session,
               (   session(Key, Session)
               ->  reroute(Address, Session)
               ;   true
               )).

%   The keeper looks whether another address leads to the displaced one.

reroute(Address, Session) :-
    findall(Old-Key,
            clause(route(Address, session(Key, _, _, _, _)), true, Old),
            Displaced),
    assertz(route(Address, Session)),
    forall(member(Old-_, Displaced), erase(Old)),
    forall(member(_-Key, Displaced), ignore(crew_tell(displaced(Key)))).

%!  session_received(+Key, -Count) is semidet.
%!  session_note_received(+Key, +Count) is det.
%
%   How many frames had been received when the last connection ended.

session_received(Key, Count) :-
    received(Key, Count).

session_note_received(Key, Count) :-
    retractall(received(Key, _)),
    assertz(received(Key, Count)).

%!  session_adopting(+Session, :Goal) is semidet.
%
%   Run Goal, which gives Session a new connection, one at a time.

session_adopting(session(_, _, _, Adoption, _), Goal) :-
    with_mutex(Adoption, Goal).
