:- module(typhon_writer,
          [ put_frame/4,                % +Session, +Bytes, +Token, +Flush
            put_control/3,              % +Session, +Kind, +Bytes
            session_release/1,          % +Session
            flush_out/1,                % +Key
            session_install/4,          % +Session, +Thread, +Out, +PeerCount
            session_lost/2,             % +Session, +Thread
            session_left/0,
            session_retire/1,           % +Session
            session_close/2,            % +Session, -Unsent
            session_up/1,               % +Key
            session_up_since/2,         % +Session, +Time
            route_up/2                  % ?Address, -Session
          ]).

/** <module> The connection of a session: written to, and replaced

Writing must never block the thread of a reader, or two readers could wait
for each other, nor a thread of a caller. A sender therefore writes a frame
itself only if the frame and all that is under way fit in the buffers of the
operating system; else the frame waits, and a thread of the session, the
_pusher_, writes until nothing waits. It writes first frames outside the count,
called _controls_, then frames of an earlier connection that the peer lacks,
then frames that wait.

Writing a small frame costs more than all other work for it. So posts are held
while so much is under way that the peer is sure to acknowledge some of it, and
go in one frame after the acknowledgement. The peer would not read them before,
anyway. A frame that is sent after them takes them along.

*Threading*: a thread that calls put_frame/4, put_control/3 or flush_out/1 holds
the mutex of the session, which guards the order. session_release/1,
session_install/4 and session_left/0 are for the thread of the connection, or
the one that acts in its place. A thread that gives a session another
connection, or ends it, retires and closes the session, inside
session_adopting/2 or after all threads have ended. While a session is up and
has no pusher, only held posts wait.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(frame, [bytes_term/3, frame_write/3]).
:- use_module(session,
              [ connection_is/2, route/2, session/2, session_codec/2,
                session_forget/1, session_key/2, session_locked/2,
                session_must_exist/3, session_window/3 ]).
:- use_module(settlement, [settled_never/4, unsettled_add/2]).
:- use_module(threads,
              [ manager_notify/1, wire_thread_create/3, wire_thread_end/2,
                wire_thread_signal/2 ]).
:- use_module(unacked,
              [ unacked_close/4, unacked_control/5, unacked_counts/4,
                unacked_next/5, unacked_owed/2, unacked_resumed/5,
                unacked_sent/5, unacked_settled/1, unacked_waiting/1,
                unacked_waits/3 ]).

:- dynamic
    transport/3,                        % Key, Thread, Out: can be written to
    serving/3,                          % Key, Thread, Since: its connection
    pusher/2,                           % Key, Thread: it alone may write
    control/3.                          % Key, Kind, Bytes: written first

                /*******************************
                *           SENDERS            *
                *******************************/

%!  put_frame(+Session, +Bytes, +Token, +Flush) is det.
%
%   Write Bytes, or let them wait; Flush is `flush` or `buffer`.  If Token is
%   `loose`, Bytes may be held, and be bundled with others.
%
%   @error session_closed

put_frame(Session, Bytes, Token, Flush) :-
    session_must_exist(Session, Key, Window),
    (   Token == loose,
        holds(Session, Key)
    ->  unacked_waits(Window, Bytes, loose)
    ;   writable(Key, Thread, Out),
        unacked_sent(Window, Out, Bytes, Token, Counts)
    ->  written(Flush, Key, Thread, Out, Counts, Bytes)
    ;   unacked_waits(Window, Bytes, Token),
        write_or_connect(Session, Key)
    ).

%   holds(+Session, +Key): the peer will acknowledge some of the frames under
%   way, and not too many wait; or there is a pusher.

most_held(256).

holds(Session, Key) :-
    (   pusher(Key, _)
    ->  true
    ;   session_up(Key),
        unacked_owed(Session, Waiting),
        most_held(Most),
        Waiting < Most
    ).

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

%   writable(+Key, -Thread, -Out): Out can be written to. The stream of a pusher
%   is not used: even inspecting it might block.

writable(Key, Thread, Out) :-
    transport(Key, Thread, Out),
    \+ pusher(Key, _).

%   Give up a connection that cannot be written to: its thread detects that, or
%   ends on the signal.

transport_broken(Key, Thread) :-
    debug(typhon(session), '~w: cannot be written to', [Key]),
    retractall(transport(Key, Thread, _)),
    wire_thread_signal(Thread, broken).

written(Flush, Key, Thread, Out, Counts, Bytes) :-
    catch(write_out(Flush, Out, Counts, Bytes),
          error(_, _),
          transport_broken(Key, Thread)).

write_out(flush, Out, Counts, Bytes) :-
    frame_write(Out, Counts, Bytes),
    flush_output(Out).
write_out(buffer, Out, Counts, Bytes) :-
    frame_write(Out, Counts, Bytes).

%!  put_control(+Session, +Kind, +Bytes) is det.
%
%   Write Bytes outside the count, before all frames that wait.  They are
%   dropped if the session is down, or if newer ones of their Kind follow.  Held
%   posts do not prevent writing them at once, because posts settle nothing.

put_control(Session, Kind, Bytes) :-
    session_window(Session, Key, Window),
    (   writable(Key, Thread, Out),
        unacked_control(Window, Out, room, Bytes, Counts)
    ->  written(flush, Key, Thread, Out, Counts, Bytes)
    ;   session_up(Key)
    ->  control_add(Key, Kind, Bytes),
        push_what_waits(Session, Key)
    ;   true
    ).

control_add(Key, Kind, Bytes) :-
    retractall(control(Key, Kind, _)),
    assertz(control(Key, Kind, Bytes)).

%!  session_release(+Session) is det.
%
%   The peer has acknowledged something, and frames wait: send the posts that
%   are held.

session_release(Session) :-
    session_key(Session, Key),
    session_locked(Session, write_or_connect(Session, Key)).

%   Some frame waits: write it, or request a connection.

write_or_connect(Session, Key) :-
    (   pusher(Key, _)
    ->  true
    ;   transport(Key, Thread, Out)
    ->  catch(write_waiting(Session, Out, room),
              error(_, _),
              transport_broken(Key, Thread)),
        ignore(( unacked_waiting(Session), push_what_waits(Session, Key) ))
    ;   ignore(manager_notify(wanted(Key)))
    ).

push_what_waits(Session, Key) :-
    (   writable(Key, Thread, Out)
    ->  pusher_start(Session, Key, Thread, Out, [])
    ;   true
    ).

%!  flush_out(+Key) is det.
%
%   Flush the frames that were written to the buffer.

flush_out(Key) :-
    (   writable(Key, Thread, Out)
    ->  catch(flush_output(Out),
              error(_, _),
              transport_broken(Key, Thread))
    ;   true
    ).

%   write_waiting(+Session, +Out, +Most): write frames that wait as far as there
%   is room, or, if Most is `all`, until none waits.  Many small frames go in
%   one write: the buffer is flushed when it is full and at the end.

write_waiting(Session, Out, Most) :-
    repeat,
    (   session_locked(Session, next_frame(Session, Out, Most, Counts, Bytes))
    ->  frame_write(Out, Counts, Bytes),
        fail
    ;   !,
        flush_output(Out)
    ).

next_frame(Session, Out, Most, Counts, Bytes) :-
    session_window(Session, Key, Window),
    (   retract(control(Key, _, Bytes))
    ->  unacked_control(Window, Out, all, Bytes, Counts)
    ;   unacked_next(Session, Out, Most, Counts, Bytes)
    ).

                /*******************************
                *          THE PUSHER          *
                *******************************/

%   The pusher writes the frames Again, and those that wait. If no thread can be
%   created, this gives up the connection: other frames must not overtake these,
%   and the next connection sends them.

pusher_start(Session, Key, Thread, Out, Again) :-
    catch(( wire_thread_create(push(Session, Key, Thread, Out, Again),
                               pusher-Key, Pusher),
            assertz(pusher(Key, Pusher)),
            debug(typhon(session), '~w: ~w writes', [Key, Pusher])
          ),
          error(Formal, Context),
          ( print_error(error, error(Formal, Context)),
            transport_broken(Key, Thread) )).

push(Session, Key, Thread, Out, Again) :-
    call_cleanup(
        catch(( forall(member(Frame, Again), write_again(Frame, Session, Out)),
                push_waiting(Session, Key, Out) ),
              error(_, _),
              true),
        session_locked(Session, pusher_ended(Key, Thread))).

write_again(Frame, Session, Out) :-
    session_locked(Session, unacked_counts(Session, Frame, Counts, Bytes)),
    frame_write(Out, Counts, Bytes).

%   A pusher that has written all frames has removed its fact already.

pusher_ended(Key, Thread) :-
    thread_self(Me),
    (   retract(pusher(Key, Me))
    ->  transport_broken(Key, Thread)
    ;   true
    ).

push_waiting(Session, Key, Out) :-
    repeat,
    write_waiting(Session, Out, all),
    session_locked(Session, nothing_waits(Session, Key)),
    !.

%   The last frame settles all frames received meanwhile.

nothing_waits(Session, Key) :-
    \+ control(Key, _, _),
    \+ unacked_waiting(Session),
    session_window(Session, Key, Window),
    (   unacked_settled(Window)
    ->  retractall(pusher(Key, _))
    ;   control_add(Key, acknowledge, ""),
        fail
    ).

%   writer_end(+Key) is det.
%
%   The connection is stopped: end the pusher of the session, if any, and wait
%   for its end; drop the controls, which were for this connection.

writer_end(Key) :-
    (   retract(pusher(Key, Pusher))
    ->  wire_thread_end(Pusher, broken)
    ;   true
    ),
    retractall(control(Key, _, _)).

                /*******************************
                *      ANOTHER CONNECTION      *
                *******************************/

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
    unacked_resumed(Session, PeerCount, Bytes, Handed, Again),
    unsettled_add(Key, Handed),
    monotonic_time(Now),
    assertz(serving(Key, Thread, Now)),
    assertz(transport(Key, Thread, Out)),
    (   Again == [],
        \+ unacked_waiting(Session)
    ->  true
    ;   pusher_start(Session, Key, Thread, Out, Again)
    ),
    ignore(manager_notify(up(Key))).

%!  session_lost(+Session, +Thread) is det.
%
%   If the session still has the connection of Thread, which is lost, detach it,
%   and call the hooks connection/2. For that thread only, or one that acts in
%   its place.

session_lost(Session, Thread) :-
    session_key(Session, Key),
    (   serving(Key, Thread, _)
    ->  session_locked(Session, retractall(transport(Key, Thread, _))),
        writer_end(Key),
        session_locked(Session, retractall(serving(Key, Thread, _))),
        ignore(manager_notify(wanted(Key))),
        debug(typhon(session), '~w: down', [Key]),
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
    forall(( serving(Key, Me, _), session(Key, Session) ),
           session_lost(Session, Me)).

%!  session_retire(+Session) is det.
%
%   End the connection of Session, if any, and wait for its end.

session_retire(Session) :-
    session_key(Session, Key),
    forall(serving(Key, Thread, _),
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
    findall(Term,
            ( member(frame(Bytes, _, _), Waiting),
              bytes_term(Codec, Bytes, Term) ),
            Terms),
    append(Terms, Handed, Unsent).

forget(Session, Waiting, Handed) :-
    session_forget(Session),
    unacked_close(Session, Waiting, Sent, NotSent),
    session_key(Session, Key),
    settled_never(Key, Sent, NotSent, Handed).
