:- module(typhon_session,
          [ session/2,                  % ?Key, -Session
            session_open/4,             % +Key, +Hello, +Codec, -Session
            session_forget/1,           % +Session
            session_must_exist/2,       % +Session, -Key
            session_key/2,              % +Session, -Key
            session_codec/2,            % +Session, -Codec
            session_peer/3,             % +Session, -Process, -Address
            session_proof/2,            % +Session, -Proof
            session_locked/2,           % +Session, :Goal
            session_adopting/2,         % +Session, :Goal
            route/2,                    % ?Address, ?Session
            route_key/2,                % ?Address, ?Key
            route_add/2                 % +Address, +Session
          ]).

/** <module> Sessions: who we are joined to

A session joins this process to another for the life of both, over however
many connections. What is sent in it is the business of outbox.pl, what
connections it has that of resumption.pl.

A session is session(Key, Codec, Mutex, Adoption, peer(Process, Address,
Proof)). Key names the peer. Mutex guards the sending side; that of Adoption is held
by who gives the session a new connection. Nobody else takes it apart.

*Threading*: any thread; a mutex makes sessions and routes one at a time.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module(counts, [counts_forget/1, counts_open/1]).
:- use_module(hello, [hello_peer/4]).
:- use_module(keeper_queue, [keeper_tell/1]).

:- setting(frame_bytes, positive_integer, 67108864,
           "The longest frame sent or taken, in bytes").

:- meta_predicate
    session_locked(+, 0),
    session_adopting(+, 0).

:- dynamic
    session/2,                          % Key, Session
    route/2.                            % Address, Session

%!  session(?Key, -Session) is nondet.
%!  route(?Address, ?Session) is nondet.
%!  route_key(?Address, ?Key) is nondet.
%
%   The sessions there are, and which addresses lead to each.

route_key(Address, Key) :-
    route(Address, session(Key, _, _, _, _)).

%!  session_key(+Session, -Key) is det.
%!  session_codec(+Session, -Codec) is det.
%!  session_peer(+Session, -Process, -Address) is det.
%
%   Address is where the peer says it listens.

session_key(session(Key, _, _, _, _), Key).

session_codec(session(_, Codec, _, _, _), Codec).

session_peer(session(_, _, _, _, peer(Process, Address, _)), Process, Address).

%!  session_proof(+Session, -Proof) is det.
%
%   How the peer has proved itself: `cookie`, or certificate(Name).

session_proof(session(_, _, _, _, peer(_, _, Proof)), Proof).

%!  session_open(+Key, +Peer, +Codec, -Session) is det.
%
%   The session with the peer Key, a new one on first contact. Peer is
%   Hello-Proof.
%
%   @error permission_error(authenticate, peer, tls(other)) the session is
%   that of another, who knows its key

session_open(Key, Hello-Proof, Codec, Session) :-
    with_mutex(typhon_session,
               open_session(Key, Hello, Proof, Codec, Session)),
    (   session_proof(Session, Proof)
    ->  true
    ;   permission_error(authenticate, peer, tls(other))
    ).

open_session(Key, _, _, _, Session) :-
    session(Key, Session),
    !.
open_session(Key, Hello, Proof, Codec, Session) :-
    hello_peer(Hello, Process, _, Address),
    mutex_create(Mutex),
    mutex_create(Adoption),
    Session = session(Key, Codec, Mutex, Adoption,
                      peer(Process, Address, Proof)),
    counts_open(Key),
    assertz(session(Key, Session)).

%!  session_forget(+Session) is semidet.
%
%   There is no such session any more; fails when there is none already.
%   The mutexes are left to the garbage collector: somebody may wait for
%   them.

session_forget(Session) :-
    session_key(Session, Key),
    with_mutex(typhon_session,
               ( retract(session(Key, Session)),
                 retractall(route(_, Session)),
                 counts_forget(Key) )),
    debug(typhon(session), '~w: forgotten', [Key]).

%!  session_must_exist(+Session, -Key) is det.
%
%   Session has not been closed; another may have its key by now.
%
%   @error session_closed

session_must_exist(Session, Key) :-
    session_key(Session, Key),
    (   session(Key, Session)
    ->  true
    ;   throw(error(session_closed, _))
    ).

%!  session_locked(+Session, :Goal) is semidet.
%
%   Run once(Goal) alone with the sending side of Session: in one step.

session_locked(session(_, _, Mutex, _, _), Goal) :-
    sig_atomic(with_mutex(Mutex, Goal)).

%!  session_adopting(+Session, :Goal) is semidet.
%
%   Run Goal, which gives Session a new connection, one at a time.

session_adopting(session(_, _, _, Adoption, _), Goal) :-
    with_mutex(Adoption, Goal).

%!  route_add(+Address, +Session) is det.
%
%   Address leads to Session from now on, if that has not been forgotten.
%   The keeper hears displaced(Key) of the session it led to before.

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

%   The keeper looks whether another address leads to the displaced one.

reroute(Address, Session) :-
    findall(Old-Key,
            ( clause(route(Address, Other), true, Old),
              session_key(Other, Key) ),
            Displaced),
    assertz(route(Address, Session)),
    forall(member(Old-_, Displaced), erase(Old)),
    forall(member(_-Key, Displaced), ignore(keeper_tell(displaced(Key)))).
