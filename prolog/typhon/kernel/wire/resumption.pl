:- module(typhon_resumption,
          [ session_lost/2,             % +Session, +Thread
            session_left/0,
            session_retire/1,           % +Session
            session_close/2,            % +Session, -Unsent
            prove/5,                    % +Role, +In, +Out, +Me, -Peer
            meet/7,                     % +Role, +In, +Out, +Me, +Peer,
                                        % -Session, :Known
            own_session/1               % +Session
          ]).

/** <module> Resumption: a session moves from connection to connection

Two endpoints that have completed the handshake look up their session, or open
one, and give it the new connection. On it each reports how many frames it
has received, and sends the rest again.

Both ends may connect at the same time, and a connection may be dead on one
side only. So a new connection replaces an old one, and of two processes the
one with the smaller key, the arbiter, decides in which order that happens: it
sends its count first, and on one connection at a time. Of two connections that
were begun together it refuses the later; the other process accepts the
connection on which the arbiter sends its count.

*Threading*: meet/7, session_install/4 and session_left/0 run in the thread of
the connection. A thread that gives a session another connection, or ends it,
retires and closes the session, inside session_adopting/2 or after all threads
have ended.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(lists), [append/3]).
:- use_module(library(settings), [setting/2]).
:- use_module(frame, [bytes_term/3]).
:- use_module(cookie, [cookie/1]).
:- use_module(handshake,
              [ authenticate/6, hello_codec/3, hello_peer/4,
                line_read/3, line_write/2 ]).
:- use_module(request, [connection_is/2]).
:- use_module(session,
              [ session/2, session_adopting/2, session_codec/2,
                session_forget/1, session_key/2, session_locked/2,
                session_must_exist/3, session_open/5, session_up_since/2,
                transport_attach/3, transport_detach/2, transport_stop/2,
                transport_thread/2 ]).
:- use_module(threads, [manager_notify/1, wire_thread_end/2]).
:- use_module(unacked,
              [ session_received/2, unacked_close/3, unacked_open/1,
                unacked_resumed/4 ]).
:- use_module(writer, [writer_begin/5, writer_end/1]).

%!  session_install(+Session, +Thread, +Out, +PeerCount) is det.
%
%   Thread has a new connection for Session, Out; the peer has received
%   PeerCount frames. The frames that it lacks are sent again. The connection
%   manager receives up(Key) in the same step: so waiting threads are notified
%   even if Thread ends.
%
%   @error session_closed

session_install(Session, Thread, Out, PeerCount) :-
    session_locked(Session,
                   install(Session, Key, Thread, Out, PeerCount)),
    debug(typhon(session), '~w: up; it has ~D frames', [Key, PeerCount]).

install(Session, Key, Thread, Out, PeerCount) :-
    session_must_exist(Session, Key, _),
    byte_count(Out, Bytes),
    unacked_resumed(Session, PeerCount, Bytes, Again),
    transport_attach(Key, Thread, Out),
    writer_begin(Session, Key, Thread, Out, Again),
    ignore(manager_notify(up(Key))).

%   session_down(+Session, +Thread)
%
%   The connection of Thread is lost. For that thread only, or one that acts in
%   its place.

session_down(Session, Thread) :-
    session_key(Session, Key),
    session_locked(Session, transport_stop(Key, Thread)),
    writer_end(Key),
    session_locked(Session, transport_detach(Key, Thread)),
    ignore(manager_notify(wanted(Key))),
    debug(typhon(session), '~w: down', [Key]).

%!  session_lost(+Session, +Thread) is det.
%
%   If the session still has the connection of Thread, detach it, and call the
%   hooks connection/2.

session_lost(Session, Thread) :-
    session_key(Session, Key),
    (   transport_thread(Key, Thread)
    ->  session_down(Session, Thread),
        connection_is(Session, down)
    ;   true
    ).

%!  session_left is det.
%
%   This thread is about to close its connection.  It may have been signalled
%   to end after session_install/4 and before it began to serve: then the
%   session must stop writing to the closed stream.

session_left :-
    thread_self(Me),
    forall(( transport_thread(Key, Me), session(Key, Session) ),
           session_lost(Session, Me)).

%!  session_retire(+Session) is det.
%
%   End the connection of Session, if any, and wait for its end.

session_retire(Session) :-
    session_key(Session, Key),
    forall(transport_thread(Key, Thread),
           ( wire_thread_end(Thread, replaced),
             session_lost(Session, Thread) )).  % a lent thread is elsewhere

%!  session_close(+Session, -Unsent) is semidet.
%
%   Remove a session that has no connection; inside session_adopting/2, so
%   that it gets none. Fails if it was removed already. Unsent are the terms of
%   frames that were never written to any connection, and the results of
%   hand-overs, handed(Token, Result).

session_close(Session, Unsent) :-
    session_locked(Session, forget(Session, Waiting, Handed)),
    session_codec(Session, Codec),
    maplist(frame_term(Codec), Waiting, Terms),
    append(Terms, Handed, Unsent).

frame_term(Codec, Frame, Term) :-
    arg(1, Frame, Bytes),
    bytes_term(Codec, Bytes, Term).

forget(Session, Waiting, Handed) :-
    session_forget(Session),
    unacked_close(Session, Waiting, Handed).

		 /*******************************
		 *     AFTER THE HANDSHAKE      *
		 *******************************/

:- meta_predicate
    meet(+, +, +, +, +, -, 1).

%!  prove(+Role, +In, +Out, +Me, -Peer) is det.
%
%   Me is the hello of this process, Peer that of the peer, which has proved
%   itself. Role is server(Start), for a connection accepted at the time Start,
%   or client(Start), for one begun then.
%
%   A server reports to a client that its proof is wrong, so that the client
%   does not try again.

prove(client(_), In, Out, Me, Peer) :-
    authenticate(client, In, Out, Me, cookie, Peer).
prove(server(_), In, Out, Me, Peer) :-
    catch(authenticate(server, In, Out, Me, cookie, Peer),
          error(permission_error(authenticate, peer, cookie), Context),
          ( line_write(Out, refused),
            throw(error(permission_error(authenticate, peer, cookie),
                        Context)) )).

%!  meet(+Role, +In, +Out, +Me, +Peer, -Session, :Known) is semidet.
%
%   Give the connection to the session with the peer; Peer is Hello-Proof.
%   Before, call(Known, Session) notes the addresses that lead to the session:
%   it has one connection for all of them.

meet(Role, In, Out, Me, Peer-Proof, Session, Known) :-
    hello_codec(Me, Peer, Codec),
    session_keys(Role, Me, Peer, MyKey, Key),
    session_open(Key, Peer-Proof, Codec, unacked_open, Session),
    call(Known, Session),
    hello_peer(Peer, _, _, Address),
    debug(typhon(session), '~w: a connection, with ~w, ~w',
          [Key, Address, Codec]),
    adopt(MyKey, Key, Role, Session, In, Out).

%   A process that connects to itself has one session for each end.

session_keys(Role, Me, Peer, MyKey, Key) :-
    hello_peer(Me, P1, S1, _),
    hello_peer(Peer, P2, S2, _),
    (   P1-S1 == P2-S2
    ->  own_keys(Role, MyKey, Key)
    ;   atomic_list_concat([P1, S1], '.', MyKey),
        atomic_list_concat([P2, S2], '.', Key)
    ).

own_keys(client(_), self_client, self_server).
own_keys(server(_), self_server, self_client).

%!  own_session(+Session) is semidet.
%
%   Session joins this process to itself.

own_session(Session) :-
    session_key(Session, Key),
    own_keys(_, Key, _),
    !.

adopt(MyKey, Key, Role, Session, In, Out) :-
    MyKey @< Key,
    !,
    session_adopting(Session,
                     ( needed(Role, Session),
                       session_retire(Session),
                       say_count(Session, Out),
                       hear_count(In, Count),
                       install(Session, Out, Count) )).
adopt(_, _, _, Session, In, Out) :-
    hear_count(In, Count),
    session_adopting(Session,
                     ( session_retire(Session),
                       say_count(Session, Out),
                       install(Session, Out, Count) )).

%   If another connection has been made since this one was begun, this one is
%   not needed.  The peer got the count on the other one, and has it when it
%   detects that this one is closed.

needed(Role, Session) :-
    arg(1, Role, Start),
    session_up_since(Session, Start),
    !,
    throw(wire_thread_end(met)).
needed(_, _).

%   The hooks run in the same step: when a process has died, the layer that sent
%   to it sends again when it is notified of its successor.

install(Session, Out, Count) :-
    thread_self(Me),
    sig_atomic(( session_install(Session, Me, Out, Count),
                 connection_is(Session, up) )).

say_count(Session, Out) :-
    session_received(Session, Count),
    format(string(Line), "resume ~d", [Count]),
    line_write(Out, Line).

hear_count(In, Count) :-
    setting(typhon_handshake:handshake_time, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    line_read(In, Deadline, Line),
    (   string_concat("resume ", Digits, Line),
        number_string(Count, Digits),
        integer(Count),
        Count >= 0
    ->  true
    ;   syntax_error(resume)
    ).
