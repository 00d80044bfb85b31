:- module(typhon_session,
          [ session/2,                  % ?Key, -Session
            session_open/5,             % +Key, +Hello, +Codec, :Open, -Session
            session_forget/1,           % +Session
            session_must_exist/3,       % +Session, -Key, -Window
            session_key/2,              % +Session, -Key
            session_to_self/1,          % +Session
            session_codec/2,            % +Session, -Codec
            session_window/2,           % +Session, -Window
            session_window/3,           % +Session, -Key, -Window
            session_peer/3,             % +Session, -Process, -Address
            session_proof/2,            % +Session, -Proof
            session_locked/2,           % +Session, :Goal
            session_held/2,             % +Session, :Goal
            session_adopting/2,         % +Session, :Goal
            route/2,                    % ?Address, ?Session
            route_key/2,                % ?Address, ?Key
            route_add/2,                % +Address, +Session
            connection_is/2,            % +Session, +State
            frame_fits/1,               % +Length
            debug_frame/4               % +Way, +Session, +Term, +Bytes
          ]).

/** <module> Sessions between processes

A session joins this process to another for the life of both, over any number
of connections, one at a time. outbox.pl sends in it; connection.pl gives it its
connections, see writer.pl.

A session is session(Key, Codec, Mutex, Adoption, peer(Process, Address, Proof),
Window). Key names the peer. Mutex guards the sending side; a thread that gives
the session a new connection holds Adoption. Only this module accesses the
arguments of the term. Window is that of unacked.pl.

*Threading*: any thread; a mutex serializes sessions and routes, the mutex of
a session its connection and its window.  The hooks run in the thread of a
connection, or in one that acts for it.
*/

:- use_module(library(apply), [include/3]).
:- use_module(library(debug), [debug/3, debugging/1]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(handshake, [hello_peer/4]).
:- use_module(threads, [manager_notify/1]).

:- setting(frame_bytes, positive_integer, 67108864,
           "The longest frame sent or taken, in bytes").

:- meta_predicate
    session_open(+, +, +, 1, -),
    session_locked(+, 0),
    session_held(+, 0),
    session_adopting(+, 0).

:- dynamic
    session/2,                          % Key, Session
    route/2.                            % Address, Session

%!  session(?Key, -Session) is nondet.
%
%   The sessions.

%!  route(?Address, ?Session) is nondet.
%
%   Address leads to Session.

%!  route_key(?Address, ?Key) is nondet.
%
%   Address leads to the session of Key.

route_key(Address, Key) :-
    route(Address, session(Key, _, _, _, _, _)).

%!  session_key(+Session, -Key) is det.
%
%   Key names the peer.

session_key(session(Key, _, _, _, _, _), Key).

%!  session_to_self(+Session) is semidet.
%
%   Session joins this process to itself; it has one session for each end.

session_to_self(session(self_client, _, _, _, _, _)).
session_to_self(session(self_server, _, _, _, _, _)).

%!  session_codec(+Session, -Codec) is det.
%
%   Codec is `fast` or `text`, see typhon_frame.

session_codec(session(_, Codec, _, _, _, _), Codec).

%!  session_window(+Session, -Window) is det.
%
%   Window is that of unacked.pl.

session_window(session(_, _, _, _, _, Window), Window).

%!  session_window(+Session, -Key, -Window) is det.

session_window(session(Key, _, _, _, _, Window), Key, Window).

%!  session_peer(+Session, -Process, -Address) is det.
%
%   Address is where the peer claims to listen.

session_peer(session(_, _, _, _, peer(Process, Address, _), _), Process,
             Address).

%!  session_proof(+Session, -Proof) is det.
%
%   Proof is that of the peer, see typhon_transport.

session_proof(session(_, _, _, _, peer(_, _, Proof), _), Proof).

%!  session_open(+Key, +Peer, +Codec, :Open, -Session) is det.
%
%   Session is the session with the peer Key.  On first contact it is created,
%   with the window that call(Open, Window) returns.  Peer is Hello-Proof.
%
%   @error permission_error(authenticate, peer, other) if the session is
%   that of another peer, whose key this peer uses

session_open(Key, Hello-Proof, Codec, Open, Session) :-
    with_mutex(typhon_session,
               open_session(Key, Hello, Proof, Codec, Open, Session)),
    (   session_proof(Session, Proof)
    ->  true
    ;   permission_error(authenticate, peer, other)
    ).

open_session(Key, _, _, _, _, Session) :-
    session(Key, Session),
    !.
open_session(Key, Hello, Proof, Codec, Open, Session) :-
    hello_peer(Hello, Process, _, Address),
    mutex_create(Mutex),
    mutex_create(Adoption),
    call(Open, Window),
    Session = session(Key, Codec, Mutex, Adoption,
                      peer(Process, Address, Proof), Window),
    assertz(session(Key, Session)).

%!  session_forget(+Session) is semidet.
%
%   Remove Session; fails if it was removed already. The mutexes are left to the
%   garbage collector: another thread may wait for them.

session_forget(Session) :-
    session_key(Session, Key),
    with_mutex(typhon_session,
               ( retract(session(Key, Session)),
                 retractall(route(_, Session)) )),
    debug(typhon(session), '~w: forgotten', [Key]).

%!  session_must_exist(+Session, -Key, -Window) is det.
%
%   Session has not been closed; another session may have its key by now.
%
%   @error session_closed

session_must_exist(Session, Key, Window) :-
    Session = session(Key, _, _, _, _, Window),
    (   session(Key, Session)
    ->  true
    ;   throw(error(session_closed, _))
    ).

%!  session_locked(+Session, :Goal) is semidet.
%
%   Run once(Goal) under the mutex of the sending side of Session, with signals
%   deferred.

session_locked(session(_, _, Mutex, _, _, _), Goal) :-
    sig_atomic(with_mutex(Mutex, Goal)).

%!  session_held(+Session, :Goal) is semidet.
%
%   As session_locked/2, for threads that have deferred signals already.

session_held(session(_, _, Mutex, _, _, _), Goal) :-
    with_mutex(Mutex, Goal).

%!  session_adopting(+Session, :Goal) is semidet.
%
%   Run Goal, which gives Session a new connection.  One thread at a time.

session_adopting(session(_, _, _, Adoption, _, _), Goal) :-
    with_mutex(Adoption, Goal).

%!  route_add(+Address, +Session) is det.
%
%   Let Address lead to Session, unless Session was removed.  The connection
%   manager receives displaced(Key) of the session to which Address led before.

route_add(Address, Session) :-
    route(Address, Session),
    !.
route_add(Address, Session) :-
    session_key(Session, Key),
    with_mutex(typhon_session,
               (   session(Key, Session)
               ->  reroute(Address, Session)
               ;   true
               )).

%   The manager tests whether another address leads to the displaced session.

reroute(Address, Session) :-
    findall(Old-Key,
            ( clause(route(Address, Other), true, Old),
              session_key(Other, Key) ),
            Displaced),
    assertz(route(Address, Session)),
    forall(member(Old-_, Displaced), erase(Old)),
    forall(member(_-Key, Displaced), ignore(manager_notify(displaced(Key)))).

%!  connection_is(+Session, +State) is det.
%
%   Call the hooks connection/2: the connection is `up` or `down`, for each
%   address that leads to the peer.

connection_is(Session, State) :-
    session_peer(Session, _, Claimed),
    findall(Address, ( Address = Claimed ; route(Address, Session) ),
            Addresses0),
    sort(Addresses0, Addresses),
    forall(( member(Peer, Addresses),
             clause(typhon_endpoint:connection(Peer, State), Body) ),
           call_hook(typhon_endpoint:Body)).

%   A hook that fails or raises an error is reported, and the others are called.

call_hook(Hook) :-
    catch(( Hook -> Problem = none ; Problem = failed ),
          error(Formal, Context),
          Problem = error(Formal, Context)),
    (   Problem == none
    ->  true
    ;   print_message(error, typhon(endpoint, hook(connection, Problem)))
    ).

		 /*******************************
		 *            FRAMES            *
		 *******************************/

%!  frame_fits(+Length) is semidet.
%
%   A frame may have Length bytes. The peer would refuse a longer one, and again
%   each time that it is sent.

frame_fits(Length) :-
    Length =< 65536,
    !.
frame_fits(Length) :-
    setting(frame_bytes, Most),
    Length =< Most.

%!  debug_frame(+Way, +Session, +Term, +Bytes) is det.
%
%   With the debug topic typhon(frame) print a frame when it is sent or taken.
%   Way is `to` or `from` the peer. Costs next to nothing if the topic is off.

debug_frame(Way, Session, Term, Bytes) :-
    (   debugging(typhon(frame))
    ->  session_key(Session, Key),
        frame_words(Term, Words),
        string_length(Bytes, Length),
        debug(typhon(frame), '~w ~w: ~w, ~D bytes',
              [Way, Key, Words, Length])
    ;   true
    ).

%   The name of a frame and its atomic arguments.

frame_words(Term, Words) :-
    compound(Term),
    !,
    compound_name_arguments(Term, Name, Args),
    include(atomic, Args, Shown),
    compound_name_arguments(Words, Name, Shown).
frame_words(Name, Name).
