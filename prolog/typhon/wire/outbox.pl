:- module(typhon_outbox,
          [ session_send/2,             % +Session, +Term
            session_send_later/2,       % +Session, +Term
            session_push/1,             % +Session
            session_control/2,          % +Session, +Term
            session_up/1,               % +Key
            session_up_since/2,         % +Session, +Time
            session_install/4,          % +Session, +Thread, +Out, +PeerCount
            session_down/2,             % +Session, +Thread
            session_left/0,
            session_retire/1,           % +Session
            session_close/2,            % +Session, -Unsent
            session_acked/3,            % +Session, +Count, +Bytes
            session_sent/2,             % +Session, -Count
            session_pending/2,          % +Session, -Count
            session_flush/2             % +Session, +Deadline
          ]).

/** <module> What is sent in a session: every frame once

Frames that were written to some connection and are not acknowledged are in
the queue Sent; those that never were, in the queue Waiting. After a break
the two processes tell each other how many frames they have received, over
the next connection, and send the rest again. A session without connection
from which nothing is pending has no queues.

Writing must never block the thread of a reader, or two readers could wait
for each other, nor hold a thread that is not ours. A frame is therefore
written by whoever sends it only if it and all that is under way fit in
what the buffers of the kernel hold; else it goes to Waiting, and a thread
of the session, the pusher, writes. So do those outside the count.

_Threading_: any thread may send. The mutex of the session guards all that
is here; the thread of the connection (see connection.pl) alone hears of
what is acknowledged. While a link is up and nobody is pushing, Waiting is
empty.
*/

:- use_module(library(error), [resource_error/1]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2]).
:- use_module('../base/fifo', [fifo_empty/2, fifo_take/2]).
:- use_module(frame, [bytes_term/3, frame_write/2, term_bytes/3]).
:- use_module(session, [session/2, session_forget/1]).
:- use_module(threads,
              [crew_retire/2, crew_signal/2, crew_spawn/2, crew_tell/1]).

:- dynamic
    queues/3,                           % Key, Sent, Waiting
    link/4,                             % Key, Thread, Out, Sent
    serving/3,                          % Key, Thread, Since
    pushing/2,                          % Key, Thread
    control/3,                          % Key, Kind, Bytes: before Waiting
    acked/3,                            % Key, Count, Bytes
    flusher/3.                          % Key, Count, Queue

%   Bytes that may be under way without a chance of blocking in write.

under_way(65536).

		 /*******************************
		 *            SENDING           *
		 *******************************/

%!  session_send(+Session, +Term) is det.
%
%   Send Term: it arrives once, and in the order of this thread's sends.
%   Never blocks on the network.
%
%   @error session_closed the peer is gone for good
%   @error resource_error(frame_bytes) Term is too long for a frame

session_send(Session, Term) :-
    Session = session(Key, Codec, Mutex, _, _),
    frame_bytes(Codec, Term, Bytes),
    sig_atomic(with_mutex(Mutex,
                          ( still_open(Session), put_frame(Key, Bytes) ))).

%!  session_send_later(+Session, +Term) is det.
%!  session_push(+Session) is det.
%
%   Send Term with whatever is sent next.  The thread of the connection,
%   who alone may ask for this, sees to it that what is left behind is
%   pushed before long.

session_send_later(Session, Term) :-
    Session = session(Key, Codec, Mutex, _, _),
    frame_bytes(Codec, Term, Bytes),
    sig_atomic(with_mutex(Mutex,
                          ( still_open(Session), put_later(Key, Bytes) ))).

session_push(session(Key, _, Mutex, _, _)) :-
    sig_atomic(with_mutex(Mutex, push_link(Key))).

push_link(Key) :-
    (   link(Key, Thread, Out, _),
        \+ pushing(Key, _)
    ->  catch(flush_output(Out), error(_, _), broken(Key, Thread))
    ;   true
    ).

%   The peer would refuse a longer one, again and again.

frame_bytes(Codec, Term, Bytes) :-
    term_bytes(Codec, Term, Bytes),
    string_length(Bytes, Length),
    (   Length > 65536,
        setting(typhon_session:frame_bytes, Max),
        Length > Max
    ->  resource_error(frame_bytes)
    ;   true
    ).

%   Another session may have its key by now.

still_open(Session) :-
    arg(1, Session, Key),
    (   session(Key, Session)
    ->  true
    ;   throw(error(session_closed, _))
    ).

put_frame(Key, Bytes) :-
    open_link(Key, Bytes, Thread, Out, Sent),
    !,
    thread_send_message(Sent, Bytes),
    write_now(Key, Thread, Out, Bytes).
put_frame(Key, Bytes) :-
    queues_of(Key, _, Waiting),
    thread_send_message(Waiting, Bytes),
    see_to(Key).

put_later(Key, Bytes) :-
    open_link(Key, Bytes, Thread, Out, Sent),
    !,
    thread_send_message(Sent, Bytes),
    catch(frame_write(Out, Bytes), error(_, _), broken(Key, Thread)).
put_later(Key, Bytes) :-
    put_frame(Key, Bytes).

%   open_link(+Key, +Bytes, -Thread, -Out, -Sent): Bytes can be written to
%   Out. Nobody looks at a stream somebody pushes to: that might block, too.

open_link(Key, Bytes, Thread, Out, Sent) :-
    link(Key, Thread, Out, Sent),
    \+ pushing(Key, _),
    byte_count(Out, Written),
    acked(Key, _, Acked),
    string_length(Bytes, Length),
    under_way(Max),
    Written-Acked+Length < Max.

%   Waiting is not empty: it is written, or a connection made.

see_to(Key) :-
    (   pushing(Key, _)
    ->  true
    ;   link(Key, Thread, Out, _)
    ->  start_pusher(Key, Thread, Out, [])
    ;   ignore(crew_tell(wanted(Key)))
    ).

queues_of(Key, Sent, Waiting) :-
    queues(Key, Sent, Waiting),
    !.
queues_of(Key, Sent, Waiting) :-
    message_queue_create(Sent),
    message_queue_create(Waiting),
    assertz(queues(Key, Sent, Waiting)).

%!  session_control(+Session, +Term) is det.
%
%   Send Term outside the count, before all that waits: dropped when the
%   link is down, and where a newer one of its kind follows.

session_control(session(Key, Codec, Mutex, _, _), Term) :-
    term_bytes(Codec, Term, Bytes),
    functor(Term, Kind, _),
    sig_atomic(with_mutex(Mutex, put_control(Key, Kind, Bytes))).

put_control(Key, _, Bytes) :-
    open_link(Key, Bytes, Thread, Out, _),
    !,
    write_now(Key, Thread, Out, Bytes).
put_control(Key, Kind, Bytes) :-
    (   link(Key, _, _, _)
    ->  retractall(control(Key, Kind, _)),
        assertz(control(Key, Kind, Bytes)),
        see_to(Key)
    ;   true
    ).

%   A link that cannot be written to is no link; its thread finds out by
%   itself or is told.

write_now(Key, Thread, Out, Bytes) :-
    catch(( frame_write(Out, Bytes),
            flush_output(Out)
          ),
          error(_, _),
          broken(Key, Thread)).

broken(Key, Thread) :-
    retractall(link(Key, Thread, _, _)),
    crew_signal(Thread, broken).

		 /*******************************
		 *            PUSHING           *
		 *******************************/

%   Where no thread can be made the connection is given up: what waits must
%   not be overtaken, and is sent over the next.

start_pusher(Key, Thread, Out, Again) :-
    session(Key, session(_, _, Mutex, _, _)),
    queues(Key, Sent, Waiting),
    Queues = queues(Mutex, Key, Sent, Waiting),
    catch(( crew_spawn(push(Queues, Thread, Out, Again), Pusher),
            assertz(pushing(Key, Pusher))
          ),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            broken(Key, Thread) )).

push(Queues, Thread, Out, Again) :-
    Queues = queues(Mutex, Key, _, _),
    call_cleanup(
        catch(( write_all(Again, Out), push_waiting(Queues, Out) ),
              error(_, _),
              true),
        with_mutex(Mutex, pushed(Key, Thread))).

%   Who has written all is not pushing any more.

pushed(Key, Thread) :-
    thread_self(Me),
    (   retract(pushing(Key, Me))
    ->  broken(Key, Thread)
    ;   true
    ).

write_all([], _).
write_all([Bytes|More], Out) :-
    frame_write(Out, Bytes),
    flush_output(Out),
    write_all(More, Out).

push_waiting(Queues, Out) :-
    Queues = queues(Mutex, _, _, _),
    repeat,
    sig_atomic(with_mutex(Mutex, next_frame(Queues, Next))),
    (   Next = frame(Bytes)
    ->  frame_write(Out, Bytes),
        flush_output(Out),
        fail
    ;   !
    ).

next_frame(queues(_, Key, _, _), frame(Bytes)) :-
    retract(control(Key, _, Bytes)),
    !.
next_frame(queues(_, _, Sent, Waiting), frame(Bytes)) :-
    fifo_take(Waiting, Bytes),
    !,
    thread_send_message(Sent, Bytes).
next_frame(queues(_, Key, _, _), none) :-
    retractall(pushing(Key, _)).

		 /*******************************
		 *             LINKS            *
		 *******************************/

%!  session_up(+Key) is semidet.
%
%   The session has a connection that can be written to.

session_up(Key) :-
    link(Key, _, _, _),
    !.

%!  session_up_since(+Session, +Time) is semidet.
%
%   The session is up, and got its connection after Time.

session_up_since(session(Key, _, _, _, _), Time) :-
    serving(Key, Thread, Since),
    Since > Time,
    link(Key, Thread, _, _),
    !.

%!  session_install(+Session, +Thread, +Out, +PeerCount) is det.
%
%   Thread has a new connection for Session, Out; the peer has received
%   PeerCount frames. What it lacks is sent again. The keeper hears up(Key)
%   in the same step: whatever becomes of Thread, who waits is told.
%
%   @error session_closed

session_install(Session, Thread, Out, PeerCount) :-
    Session = session(Key, _, Mutex, _, _),
    sig_atomic(with_mutex(Mutex,
                          ( still_open(Session),
                            install(Key, Thread, Out, PeerCount) ))).

install(Key, Thread, Out, PeerCount) :-
    queues_of(Key, Sent, Waiting),
    byte_count(Out, Bytes),
    acknowledged(Key, Sent, PeerCount, Bytes),
    retractall(control(Key, _, _)),     % of another connection
    get_time(Now),
    assertz(serving(Key, Thread, Now)),
    assertz(link(Key, Thread, Out, Sent)),
    queue_list(Sent, Again),
    (   Again == [],
        \+ thread_peek_message(Waiting, _)
    ->  true
    ;   start_pusher(Key, Thread, Out, Again)
    ),
    ignore(crew_tell(up(Key))).

queue_list(Queue, List) :-
    fifo_empty(Queue, List),
    forall(member(Message, List), thread_send_message(Queue, Message)).

%!  session_down(+Session, +Thread) is det.
%
%   The connection of Thread is no more. For that thread only.

session_down(session(Key, _, Mutex, _, _), Thread) :-
    with_mutex(Mutex, retractall(link(Key, Thread, _, _))),
    (   retract(pushing(Key, Pusher))
    ->  crew_retire(Pusher, broken)
    ;   true
    ),
    with_mutex(Mutex, at_rest(Key, Thread)),
    ignore(crew_tell(wanted(Key))).

at_rest(Key, Thread) :-
    retractall(serving(Key, Thread, _)),
    retractall(control(Key, _, _)),
    (   queues(Key, Sent, Waiting),
        queue_size(Sent, 0),
        queue_size(Waiting, 0)
    ->  drop_queues(Key)
    ;   true
    ).

drop_queues(Key) :-
    (   retract(queues(Key, Sent, Waiting))
    ->  message_queue_destroy(Sent),
        message_queue_destroy(Waiting)
    ;   true
    ).

%!  session_left is det.
%
%   This thread is about to close its connection.  It may have been told to
%   end after session_install/4 and before it began to serve: then the
%   session must not go on writing to what is closed.

session_left :-
    thread_self(Me),
    forall(( serving(Key, Me, _), session(Key, Session) ),
           session_down(Session, Me)).

%!  session_retire(+Session) is det.
%
%   End the connection of Session, if any, and wait for that.

session_retire(session(Key, _, _, _, _)) :-
    forall(serving(Key, Thread, _), crew_retire(Thread, replaced)).

%!  session_close(+Session, -Unsent) is semidet.
%
%   Forget a session that has no connection; inside session_adopting/2, so
%   that nobody gives it one. Fails when it is forgotten already. Unsent are
%   the terms that were never written to any.

session_close(Session, Unsent) :-
    Session = session(Key, Codec, Mutex, _, _),
    with_mutex(Mutex, close_queues(Session, Key, Waiting)),
    maplist(bytes_term(Codec), Waiting, Unsent).

close_queues(Session, Key, List) :-
    session_forget(Session),
    (   queues(Key, _, Waiting)
    ->  fifo_empty(Waiting, List)
    ;   List = []
    ),
    drop_queues(Key),
    retractall(acked(Key, _, _)).

		 /*******************************
		 *            COUNTS            *
		 *******************************/

%!  session_acked(+Session, +Count, +Bytes) is det.
%
%   The peer has received Count frames of this session, and Bytes bytes of
%   this connection. For the reader only.

session_acked(session(Key, _, Mutex, _, _), Count, Bytes) :-
    with_mutex(Mutex,
               (   queues(Key, Sent, _)
               ->  acknowledged(Key, Sent, Count, Bytes)
               ;   true
               )).

%   Who counts what is pending, or what is under way, sees all of this or
%   nothing.

acknowledged(Key, Sent, Count, Bytes) :-
    acked_frames(Key, Count0),
    forget(Count0, Count, Sent),
    Count1 is max(Count0, Count),
    retractall(acked(Key, _, _)),
    assertz(acked(Key, Count1, Bytes)),
    forall(( flusher(Key, Wanted, Queue), Wanted =< Count1 ),
           flushed(Key, Wanted, Queue)).

acked_frames(Key, Count) :-
    acked(Key, Count0, _),
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
    arg(1, Session, Key),
    acked_frames(Key, Acked),
    session_pending(Session, Pending),
    Count is Acked+Pending.

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged.

session_pending(session(Key, _, _, _, _), Count) :-
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

%!  session_flush(+Session, +Deadline) is semidet.
%
%   Wait until all that was sent before has been acknowledged; fails at
%   Deadline, a time stamp.

session_flush(Session, Deadline) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        flush(Session, Queue, Deadline),
        ( retractall(flusher(_, _, Queue)),
          message_queue_destroy(Queue) )).

flush(Session, Queue, Deadline) :-
    Session = session(Key, _, Mutex, _, _),
    with_mutex(Mutex,
               ( session_pending(Session, Pending),
                 session_sent(Session, Count),
                 assertz(flusher(Key, Count, Queue)) )),
    (   Pending =:= 0
    ->  true
    ;   session_control(Session, ping),
        thread_get_message(Queue, flushed, [deadline(Deadline)])
    ).

%   Who waited may have given up just now.

flushed(Key, Wanted, Queue) :-
    retractall(flusher(Key, Wanted, Queue)),
    catch(thread_send_message(Queue, flushed),
          error(existence_error(_, _), _),
          true).
