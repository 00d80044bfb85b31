:- module(typhon_unacked,
          [ unacked_open/1,             % +Key
            unacked_sent/2,             % +Key, +Bytes
            unacked_waits/2,            % +Key, +Frame
            unacked_waiting/1,          % +Key
            unacked_owed/2,             % +Key, -Waiting
            unacked_next/3,             % +Session, +Space, -Bytes
            unacked_again/2,            % +Key, -Frames
            unacked_gone/3,             % +Key, +Count, +Bytes
            unacked_rest/1,             % +Key
            unacked_close/2,            % +Key, -Waiting
            unacked_await/3,            % +Session, +Queue, -Count
            unacked_no_wait/1,          % +Queue
            session_acked/3,            % +Session, +Count, +Bytes
            session_sent/2,             % +Session, -Count
            session_pending/2,          % +Session, -Count
            pusher/2,                   % ?Key, ?Thread
            pusher_start/4,             % +Session, +Thread, +Out, +Again
            pusher_stop/1,              % +Key
            pusher_control/3,           % +Key, +Kind, +Bytes
            pusher_no_control/1         % +Key
          ]).

/** <module> Frames that wait, and the thread that writes them

Frames of a session that were written to some connection and are not
acknowledged are in the queue Sent; those that never were, in the queue
Waiting. A session without connection from which nothing is pending has no
queues.

A session of which more is sent than the buffers of the operating system hold
has a thread that writes, the pusher, until nothing waits. It writes first
what is outside the count, then what the peer lacks of an earlier connection,
then what waits.

*Threading*: the mutex of the session guards its queues: a caller of unacked_*
holds it, as does one that starts a pusher or leaves it a control.
session_acked/3, session_sent/2 and, without the mutex, pusher_stop/1 are for
the thread of the connection, session_pending/2 is for any thread.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module(frame, [bundle_all/3, bundle_next/5, frame_write/2]).
:- use_module(session,
              [ ack_frames/1, acknowledged/3, note_acknowledged/3,
                session_codec/2, session_key/2, session_locked/2,
                transport_broken/2 ]).
:- use_module(threads, [wire_thread_create/3, wire_thread_end/2]).

:- dynamic
    queues/3,                           % Key, Sent, Waiting
    bundled/2,                          % Key, Count: the last bundle's
    flusher/3.                          % Key, Count, Queue

		 /*******************************
		 *            QUEUES            *
		 *******************************/

%!  unacked_open(+Key) is det.
%
%   The session has queues.

unacked_open(Key) :-
    queues_of(Key, _, _).

queues_of(Key, Sent, Waiting) :-
    queues(Key, Sent, Waiting),
    !.
queues_of(Key, Sent, Waiting) :-
    message_queue_create(Sent),
    message_queue_create(Waiting),
    assertz(queues(Key, Sent, Waiting)).

%!  unacked_sent(+Key, +Bytes) is det.
%!  unacked_waits(+Key, +Frame) is det.
%
%   A frame is about to be written, as the session is up; it waits until
%   others are, Frame being its bytes, or loose(Bytes) if it may go with
%   others in one, see typhon_bundle.

unacked_sent(Key, Bytes) :-
    queues(Key, Sent, _),
    !,
    thread_send_message(Sent, Bytes).

unacked_waits(Key, Frame) :-
    queues_of(Key, _, Waiting),
    thread_send_message(Waiting, Frame).

%!  unacked_waiting(+Key) is semidet.
%!  unacked_owed(+Key, -Waiting) is semidet.
%
%   Some frame waits; what was written is so much that the peer is sure to
%   acknowledge some of it, and so many wait: it tells every bundle, and all
%   else after ack_frames/1.

unacked_waiting(Key) :-
    queues(Key, _, Waiting),
    queue_size(Waiting, Size),
    Size > 0,
    !.

unacked_owed(Key, Size) :-
    queues(Key, Sent, Waiting),
    !,
    (   bundled(Key, _)
    ->  true
    ;   message_queue_property(Sent, size(Written)),
        ack_frames(Frames),
        Written >= Frames
    ),
    message_queue_property(Waiting, size(Size)).

%!  unacked_next(+Session, +Space, -Bytes) is semidet.
%
%   The frame that has waited longest is about to be written, if it is not
%   longer than Space.

unacked_next(Session, Space, Bytes) :-
    session_key(Session, Key),
    session_codec(Session, Codec),
    queues(Key, Sent, Waiting),
    bundle_next(Waiting, Codec, Space, Bytes, Many),
    !,
    thread_send_message(Sent, Bytes),
    (   Many == true
    ->  note_bundle(Key, Sent)
    ;   true
    ).

note_bundle(Key, Sent) :-
    acked_frames(Key, Acked),
    message_queue_property(Sent, size(Size)),
    Count is Acked+Size,
    retractall(bundled(Key, _)),
    assertz(bundled(Key, Count)).

%!  unacked_again(+Key, -Frames) is det.
%
%   What was written, and has to be once more.

unacked_again(Key, Frames) :-
    queues_of(Key, Sent, _),
    fifo_empty(Sent, Frames),
    forall(member(Bytes, Frames), thread_send_message(Sent, Bytes)).

%!  unacked_rest(+Key) is det.
%
%   The session has lost its connection: without anything pending it needs
%   no queues.

unacked_rest(Key) :-
    (   queues(Key, Sent, Waiting),
        queue_size(Sent, 0),
        queue_size(Waiting, 0)
    ->  drop_queues(Key)
    ;   true
    ).

%!  unacked_close(+Key, -Waiting) is det.
%
%   The session is over; the frames Waiting were never written.  Threads that
%   wait for it go on.

unacked_close(Key, List) :-
    (   queues(Key, _, Waiting)
    ->  fifo_empty(Waiting, List)
    ;   List = []
    ),
    drop_queues(Key),
    forall(flusher(Key, Wanted, Queue), flushed(Key, Wanted, Queue)).

drop_queues(Key) :-
    retractall(bundled(Key, _)),
    (   retract(queues(Key, Sent, Waiting))
    ->  message_queue_destroy(Sent),
        message_queue_destroy(Waiting)
    ;   true
    ).

		 /*******************************
		 *       ACKNOWLEDGEMENTS       *
		 *******************************/

%!  session_acked(+Session, +Count, +Bytes) is det.
%
%   The peer has received Count frames of this session, and Bytes bytes of
%   this connection. For the reader only.

session_acked(Session, Count, Bytes) :-
    session_key(Session, Key),
    session_locked(Session,
                   (   queues(Key, _, _)
                   ->  unacked_gone(Key, Count, Bytes)
                   ;   true
                   )).

%!  unacked_gone(+Key, +Count, +Bytes) is det.
%
%   As session_acked/3.  A thread that counts what is pending, or under way,
%   sees all of this or nothing.

unacked_gone(Key, Count, Bytes) :-
    acked_frames(Key, Count0),
    queues_of(Key, Sent, _),
    forget(Count0, Count, Sent),
    Count1 is max(Count0, Count),
    note_acknowledged(Key, Count1, Bytes),
    (   bundled(Key, Last),
        Last =< Count1
    ->  retractall(bundled(Key, _))
    ;   true
    ),
    forall(( flusher(Key, Wanted, Queue), Wanted =< Count1 ),
           flushed(Key, Wanted, Queue)).

acked_frames(Key, Count) :-
    acknowledged(Key, Count0, _),
    !,
    Count = Count0.
acked_frames(_, 0).

forget(Count0, Count, Sent) :-
    queue_size(Sent, Size),
    Gone is min(Count-Count0, Size),
    forall(between(1, Gone, _),
           thread_get_message(Sent, _)).

%!  session_sent(+Session, -Count) is det.
%
%   No more than Count frames have been sent. For the reader only.

session_sent(Session, Count) :-
    session_key(Session, Key),
    acked_frames(Key, Acked),
    session_pending(Session, Pending),
    Count is Acked+Pending.

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged.

session_pending(Session, Count) :-
    session_key(Session, Key),
    (   queues(Key, Sent, Waiting)
    ->  queue_size(Sent, S),
        queue_size(Waiting, W),
        Count is S+W
    ;   Count = 0
    ).

%   The queue may be gone: the session was closed.

queue_size(Queue, Size) :-
    catch(message_queue_property(Queue, size(Size0)),
          error(existence_error(_, _), _),
          fail),
    !,
    Size = Size0.
queue_size(_, 0).

%!  unacked_await(+Session, +Queue, -Count) is det.
%!  unacked_no_wait(+Queue) is det.
%
%   Count frames are pending; Queue receives `flushed` when all these have been
%   acknowledged; it receives nothing any more.

unacked_await(Session, Queue, Count) :-
    session_key(Session, Key),
    bundle_waiting(Session, Key),
    session_pending(Session, Count),
    session_sent(Session, Sent),
    assertz(flusher(Key, Sent, Queue)).

%   What waits is counted as what it will be.

bundle_waiting(Session, Key) :-
    session_codec(Session, Codec),
    (   queues(Key, _, Waiting)
    ->  bundle_all(Waiting, Codec, Frames),
        forall(member(Bytes, Frames), thread_send_message(Waiting, Bytes))
    ;   true
    ).

unacked_no_wait(Queue) :-
    retractall(flusher(_, _, Queue)).

%   The waiting thread may have given up just now.

flushed(Key, Wanted, Queue) :-
    retractall(flusher(Key, Wanted, Queue)),
    catch(thread_send_message(Queue, flushed),
          error(existence_error(_, _), _),
          true).

		 /*******************************
		 *            PUSHER            *
		 *******************************/

:- dynamic
    pusher/2,                           % Key, Thread
    control/3.                          % Key, Kind, Bytes: before what waits

%!  pusher(?Key, ?Thread) is nondet.
%
%   Thread alone may write what is sent in the session.

%!  pusher_start(+Session, +Thread, +Out, +Again) is det.
%
%   Write the frames Again, and what waits, to Out, of Thread.  Where no
%   thread can be made the connection is given up: what waits must not be
%   overtaken, and is sent over the next.

pusher_start(Session, Thread, Out, Again) :-
    session_key(Session, Key),
    catch(( wire_thread_create(push(Session, Thread, Out, Again),
                               pusher-Key, Pusher),
            assertz(pusher(Key, Pusher)),
            debug(typhon(session), '~w: ~w writes', [Key, Pusher])
          ),
          error(Formal, Context),
          ( print_error(error, error(Formal, Context)),
            transport_broken(Key, Thread) )).

push(Session, Thread, Out, Again) :-
    call_cleanup(
        catch(( forall(member(Bytes, Again), frame_write(Out, Bytes)),
                push_waiting(Session, Out) ),
              error(_, _),
              true),
        session_locked(Session, pushed(Session, Thread))).

%   A pusher that has written all has ended already.

pushed(Session, Thread) :-
    session_key(Session, Key),
    thread_self(Me),
    (   retract(pusher(Key, Me))
    ->  transport_broken(Key, Thread)
    ;   true
    ).

push_waiting(Session, Out) :-
    session_key(Session, Key),
    repeat,
    write_waiting(Session, Key, Out),
    session_locked(Session, nothing_waits(Key)),
    !.

%   Many small frames go in one write: the buffer is flushed when it is full
%   and when nothing waits, and that without the mutex.

write_waiting(Session, Key, Out) :-
    repeat,
    (   session_locked(Session, next_frame(Session, Key, Bytes))
    ->  frame_write(Out, Bytes),
        fail
    ;   !,
        flush_output(Out)
    ).

next_frame(_, Key, Bytes) :-
    retract(control(Key, _, Bytes)),
    !.
next_frame(Session, _, Bytes) :-
    unacked_next(Session, inf, Bytes).

nothing_waits(Key) :-
    \+ control(Key, _, _),
    \+ unacked_waiting(Key),
    retractall(pusher(Key, _)).

%!  pusher_stop(+Key) is det.
%
%   End the pusher of the session, if any, and wait for that.

pusher_stop(Key) :-
    (   retract(pusher(Key, Pusher))
    ->  wire_thread_end(Pusher, broken)
    ;   true
    ).

%!  pusher_control(+Key, +Kind, +Bytes) is det.
%!  pusher_no_control(+Key) is det.
%
%   Bytes goes before all that waits, in place of an older one of its Kind.
%   What is left was for another connection.

pusher_control(Key, Kind, Bytes) :-
    retractall(control(Key, Kind, _)),
    assertz(control(Key, Kind, Bytes)).

pusher_no_control(Key) :-
    retractall(control(Key, _, _)).
