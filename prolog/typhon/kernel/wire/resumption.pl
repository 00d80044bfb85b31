:- module(typhon_resumption,
          [ session_install/4,          % +Session, +Thread, +Out, +PeerCount
            session_lost/2,             % +Session, +Thread
            session_left/0,
            session_retire/1,           % +Session
            session_close/2             % +Session, -Unsent
          ]).

/** <module> A session goes from connection to connection

After a break the two processes tell each other how many frames they have
received, over the next connection, and send the rest again.

*Threading*: session_install/4 and session_left/0 are for the
thread of the connection. A session is retired and closed by who gives it
another connection or none, inside session_adopting/2 or when all threads
have ended.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(frame, [bytes_term/3]).
:- use_module(keeper_queue, [keeper_tell/1]).
:- use_module(pusher, [pusher_no_control/1, pusher_start/4, pusher_stop/1]).
:- use_module(request, [connection_is/2]).
:- use_module(session,
              [ session/2, session_codec/2, session_forget/1, session_key/2,
                session_locked/2, session_must_exist/2, transport_attach/3,
                transport_detach/2, transport_stop/2, transport_thread/2 ]).
:- use_module(threads, [wire_thread_end/2]).
:- use_module(unacked,
              [ unacked_again/2, unacked_close/2, unacked_gone/3,
                unacked_open/1, unacked_rest/1, unacked_waiting/1 ]).

%!  session_install(+Session, +Thread, +Out, +PeerCount) is det.
%
%   Thread has a new connection for Session, Out; the peer has received
%   PeerCount frames. What it lacks is sent again. The keeper hears up(Key)
%   in the same step: whatever becomes of Thread, who waits is told.
%
%   @error session_closed

session_install(Session, Thread, Out, PeerCount) :-
    session_locked(Session,
                   install(Session, Key, Thread, Out, PeerCount)),
    debug(typhon(session), '~w: up; it has ~D frames', [Key, PeerCount]).

install(Session, Key, Thread, Out, PeerCount) :-
    session_must_exist(Session, Key),
    unacked_open(Key),
    byte_count(Out, Bytes),
    unacked_gone(Key, PeerCount, Bytes),
    pusher_no_control(Key),
    transport_attach(Key, Thread, Out),
    unacked_again(Key, Again),
    (   Again == [],
        \+ unacked_waiting(Key)
    ->  true
    ;   pusher_start(Session, Thread, Out, Again)
    ),
    ignore(keeper_tell(up(Key))).

%   session_down(+Session, +Thread)
%
%   The connection of Thread is no more. For that thread only, or one that
%   sees to it in its place.

session_down(Session, Thread) :-
    session_key(Session, Key),
    session_locked(Session, transport_stop(Key, Thread)),
    pusher_stop(Key),
    session_locked(Session, at_rest(Key, Thread)),
    ignore(keeper_tell(wanted(Key))),
    debug(typhon(session), '~w: down', [Key]).

at_rest(Key, Thread) :-
    transport_detach(Key, Thread),
    pusher_no_control(Key),
    unacked_rest(Key).

%!  session_lost(+Session, +Thread) is det.
%
%   If the session still has the connection of Thread, that is no more, and
%   who wants to know is told.

session_lost(Session, Thread) :-
    session_key(Session, Key),
    (   transport_thread(Key, Thread)
    ->  session_down(Session, Thread),
        connection_is(Session, down)
    ;   true
    ).

%!  session_left is det.
%
%   This thread is about to close its connection.  It may have been told to
%   end after session_install/4 and before it began to serve: then the
%   session must not go on writing to what is closed.

session_left :-
    thread_self(Me),
    forall(( transport_thread(Key, Me), session(Key, Session) ),
           session_lost(Session, Me)).

%!  session_retire(+Session) is det.
%
%   End the connection of Session, if any, and wait for that.

session_retire(Session) :-
    session_key(Session, Key),
    forall(transport_thread(Key, Thread),
           ( wire_thread_end(Thread, replaced),
             session_lost(Session, Thread) )).  % who was lent is elsewhere

%!  session_close(+Session, -Unsent) is semidet.
%
%   Forget a session that has no connection; inside session_adopting/2, so
%   that nobody gives it one. Fails when it is forgotten already. Unsent are
%   the terms that were never written to any.

session_close(Session, Unsent) :-
    session_locked(Session, forget(Session, Waiting)),
    session_codec(Session, Codec),
    maplist(frame_term(Codec), Waiting, Unsent).

frame_term(Codec, loose(Bytes), Term) :-
    !,
    bytes_term(Codec, Bytes, Term).
frame_term(Codec, Bytes, Term) :-
    bytes_term(Codec, Bytes, Term).

forget(Session, Waiting) :-
    session_forget(Session),
    session_key(Session, Key),
    unacked_close(Key, Waiting).
