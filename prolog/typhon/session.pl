:- module(typhon_session,
          [ session/2,                  % ?Key, -Session
            session_open/4,             % +Key, +Hello, +Codec, -Session
            session_peer/3,             % ?Key, -Process, -Address
            session_up/1,               % +Key
            session_send/2,             % +Session, +Term
            session_send_later/2,       % +Session, +Term
            session_push/1,             % +Session
            session_control/2,          % +Session, +Term
            session_acked/3,            % +Session, +Count, +Bytes
            session_sent/2,             % +Session, -Count
            session_received/2,         % +Key, -Count
            session_note_received/2,    % +Key, +Count
            session_install/4,          % +Session, +Thread, +Out, +PeerCount
            session_left/0,
            session_down/2,             % +Session, +Thread
            session_retire/1,           % +Session
            session_adopting/2,         % +Session, :Goal
            session_pending/2,          % +Session, -Count
            session_flush/2,            % +Session, +Deadline
            session_close/2,            % +Session, -Unsent
            route/2,                    % ?Address, ?Session
            route_add/2                 % +Address, +Session
          ]).

/** <module> Sessions: every frame once, over connections that break

A session joins this process to another for the life of both. It counts the
frames it has received, and keeps those it has sent until the peer's count
has passed them. After a break the two tell each other their counts over
the next connection and send the rest again.

A session is session(Key, Codec, Mutex, Sent, Waiting): Key names the peer;
Sent is a queue of frames that were written to some connection and are not
acknowledged; Waiting is one of frames that never were.

Writing must never block the thread of a reader, or two readers could wait
for each other, nor hold a thread that is not ours. A frame is therefore
written by whoever sends it only while little is under way, which the
buffers of the kernel hold; else it goes to Waiting, and a thread of the
session, the pusher, writes.

_Threading_: any thread may send. Mutex guards the writing side; the thread
of the connection (see connection.pl) owns the reading side. While a link is
up and nobody is pushing, Waiting is empty.
*/

:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(crew, [crew_retire/2, crew_signal/2, crew_spawn/2,
                     crew_tell/1]).
:- use_module(frame, [bytes_term/3, frame_write/2, term_bytes/3]).

:- setting(frame_bytes, positive_integer, 67108864,
           "The longest frame sent or taken, in bytes").

:- meta_predicate
    session_adopting(+, 0).

:- dynamic
    session/2,                          % Key, Session
    session_peer/3,                     % Key, Process, Address
    route/2,                            % Address, Session
    link/3,                             % Key, Thread, Out
    serving/2,                          % Key, Thread
    pushing/2,                          % Key, Thread
    adoption/2,                         % Key, Mutex
    flusher/3,                          % Key, Count, Queue
    received/2,                         % Key, Count
    acked/3.                            % Key, Count, Bytes

%   Bytes that may be under way without a chance of blocking in write.

under_way(65536).

%!  session(?Key, -Session) is nondet.
%!  session_peer(?Key, -Process, -Address) is nondet.
%!  session_received(+Key, -Count) is semidet.
%!  route(?Address, ?Session) is nondet.
%
%   The sessions there are, whom each one joins us to, how many frames it
%   had received when its last connection ended, and which addresses lead
%   to it.

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
    message_queue_create(Sent),
    message_queue_create(Waiting),
    Session = session(Key, Codec, Mutex, Sent, Waiting),
    mutex_create(Adoption),
    assertz(adoption(Key, Adoption)),
    assertz(received(Key, 0)),
    assertz(acked(Key, 0, 0)),
    assertz(session_peer(Key, Process, Address)),
    assertz(session(Key, Session)).

%!  session_close(+Session, -Unsent) is semidet.
%
%   Forget a session that has no connection; fails when it is forgotten
%   already. Unsent are the terms that were never written to any. The
%   mutexes are left to the garbage collector: somebody may wait for them.

session_close(session(Key, Codec, Mutex, Sent, Waiting), Unsent) :-
    with_mutex(Mutex, close_queues(Key, Codec, Sent, Waiting, Unsent)),
    retractall(route(_, session(Key, _, _, _, _))),
    retractall(session_peer(Key, _, _)),
    retractall(received(Key, _)),
    retractall(acked(Key, _, _)),
    retractall(adoption(Key, _)).

close_queues(Key, Codec, Sent, Waiting, Unsent) :-
    retract(session(Key, _)),
    queue_list(Waiting, List),
    findall(Term,
            ( member(Bytes, List),
              string(Bytes),
              bytes_term(Codec, Bytes, Term) ),
            Unsent),
    message_queue_destroy(Sent),
    message_queue_destroy(Waiting).

%!  route_add(+Address, +Session) is det.
%
%   Address leads to Session from now on. The keeper hears displaced(Key)
%   of the session it led to before.

route_add(Address, Session) :-
    (   route(Address, Session)
    ->  true
    ;   with_mutex(typhon_session,
                   ( forall(retract(route(Address, session(Key, _, _, _, _))),
                            ignore(crew_tell(displaced(Key)))),
                     assertz(route(Address, Session)) ))
    ).

%!  session_up(+Key) is semidet.
%
%   The session has a connection that can be written to.

session_up(Key) :-
    link(Key, _, _),
    !.

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

session_send(session(Key, Codec, Mutex, Sent, Waiting), Term) :-
    term_bytes(Codec, Term, Bytes),
    check_length(Bytes),
    sig_atomic(with_mutex(Mutex, put(Key, Sent, Waiting, Bytes))).

%!  session_send_later(+Session, +Term) is det.
%!  session_push(+Session) is det.
%
%   Send Term with whatever is sent next.  The thread of the connection,
%   who alone may ask for this, sees to it that what is left behind is
%   pushed before long.

session_send_later(session(Key, Codec, Mutex, Sent, Waiting), Term) :-
    term_bytes(Codec, Term, Bytes),
    sig_atomic(with_mutex(Mutex, put_later(Key, Sent, Waiting, Bytes))).

put_later(Key, Sent, _, Bytes) :-
    link(Key, Thread, Out),
    \+ pushing(Key, _),
    room(Key, Out),
    !,
    thread_send_message(Sent, Bytes),
    catch(frame_write(Out, Bytes), error(_, _), broken(Key, Thread)).
put_later(Key, Sent, Waiting, Bytes) :-
    put(Key, Sent, Waiting, Bytes).

session_push(session(Key, _, Mutex, _, _)) :-
    sig_atomic(with_mutex(Mutex, push_link(Key))).

push_link(Key) :-
    (   link(Key, Thread, Out),
        \+ pushing(Key, _)
    ->  catch(flush_output(Out), error(_, _), broken(Key, Thread))
    ;   true
    ).

%   The peer would refuse a longer one, again and again.

check_length(Bytes) :-
    string_length(Bytes, Length),
    Length > 65536,
    setting(frame_bytes, Max),
    Length > Max,
    !,
    resource_error(frame_bytes).
check_length(_).

put(Key, Sent, _, Bytes) :-
    link(Key, Thread, Out),
    \+ pushing(Key, _),
    room(Key, Out),
    !,
    thread_send_message(Sent, Bytes),
    write_now(Key, Thread, Out, Bytes).
put(Key, Sent, Waiting, Bytes) :-
    (   session(Key, _)
    ->  true
    ;   throw(error(session_closed, _))
    ),
    thread_send_message(Waiting, Bytes),
    (   pushing(Key, _)
    ->  true
    ;   link(Key, Thread, Out)
    ->  start_pusher(Key, Thread, Out, Sent, Waiting, [])
    ;   ignore(crew_tell(wanted(Key)))
    ).

room(Key, Out) :-
    byte_count(Out, Written),
    acked(Key, _, Acked),
    under_way(Max),
    Written-Acked < Max.

%!  session_control(+Session, +Term) is det.
%
%   Send Term outside the count: dropped when the link is down.

session_control(session(Key, Codec, Mutex, _, Waiting), Term) :-
    term_bytes(Codec, Term, Bytes),
    sig_atomic(with_mutex(Mutex, put_control(Key, Waiting, Bytes))).

put_control(Key, Waiting, Bytes) :-
    link(Key, Thread, Out),
    !,
    (   pushing(Key, _)
    ->  thread_send_message(Waiting, control(Bytes))
    ;   write_now(Key, Thread, Out, Bytes)
    ).
put_control(_, _, _).

%   A link that cannot be written to is no link; its thread finds out by
%   itself or is told.

write_now(Key, Thread, Out, Bytes) :-
    catch(( frame_write(Out, Bytes),
            flush_output(Out)
          ),
          error(_, _),
          broken(Key, Thread)).

broken(Key, Thread) :-
    retractall(link(Key, Thread, _)),
    crew_signal(Thread, broken).

		 /*******************************
		 *            PUSHING           *
		 *******************************/

start_pusher(Key, Thread, Out, Sent, Waiting, Again) :-
    crew_spawn(push(Key, Thread, Out, Sent, Waiting, Again), Pusher),
    assertz(pushing(Key, Pusher)).

push(Key, Thread, Out, Sent, Waiting, Again) :-
    session(Key, session(_, _, Mutex, _, _)),
    catch(( write_all(Again, Out),
            push_waiting(Mutex, Key, Out, Sent, Waiting)
          ),
          error(_, _),
          with_mutex(Mutex,
                     ( retractall(pushing(Key, _)),
                       broken(Key, Thread) ))).

write_all([], _).
write_all([Bytes|More], Out) :-
    frame_write(Out, Bytes),
    flush_output(Out),
    write_all(More, Out).

push_waiting(Mutex, Key, Out, Sent, Waiting) :-
    repeat,
    sig_atomic(with_mutex(Mutex, next_waiting(Key, Sent, Waiting, Next))),
    (   Next = frame(Bytes)
    ->  frame_write(Out, Bytes),
        flush_output(Out),
        fail
    ;   !
    ).

next_waiting(Key, Sent, Waiting, Next) :-
    (   take(Waiting, Message)
    ->  Next = frame(Bytes),
        (   Message = control(Bytes)
        ->  true
        ;   Bytes = Message,
            thread_send_message(Sent, Bytes)
        )
    ;   retractall(pushing(Key, _)),
        Next = none
    ).

		 /*******************************
		 *       COUNTS AND LINKS       *
		 *******************************/

%!  session_acked(+Session, +Count, +Bytes) is det.
%
%   The peer has received Count frames of this session, and Bytes bytes of
%   this connection. For the reader only.

session_acked(session(Key, _, _, Sent, _), Count, Bytes) :-
    retract(acked(Key, Count0, _)),
    !,
    assertz(acked(Key, Count, Bytes)),
    forget(Count0, Count, Sent),
    forall(( flusher(Key, Wanted, Queue), Wanted =< Count ),
           ( retractall(flusher(Key, Wanted, Queue)),
             thread_send_message(Queue, flushed) )).

%!  session_sent(+Session, -Count) is semidet.
%
%   No more than Count frames have been sent. For the reader only.

session_sent(Session, Count) :-
    arg(1, Session, Key),
    acked(Key, Acked, _),
    session_pending(Session, Pending),
    Count is Acked+Pending.

forget(Count0, Count, Sent) :-
    Gone is Count-Count0,
    forall(between(1, Gone, _),
           take(Sent, _)).

%   Never wait for what may not come: in sig_atomic/1 a wait that expires
%   does not end on 9.0.4, see typhon_aside.

take(Queue, Message) :-
    thread_peek_message(Queue, _),
    thread_get_message(Queue, Message, [timeout(0)]).

session_received(Key, Count) :-
    received(Key, Count).

%!  session_note_received(+Key, +Count) is det.

session_note_received(Key, Count) :-
    retractall(received(Key, _)),
    assertz(received(Key, Count)).

%!  session_adopting(+Session, :Goal) is semidet.
%
%   Run Goal, which gives Session a new connection, one at a time.

session_adopting(session(Key, _, _, _, _), Goal) :-
    adoption(Key, Mutex),
    !,
    with_mutex(Mutex, Goal).

%!  session_install(+Session, +Thread, +Out, +PeerCount) is det.
%
%   Thread has a new connection for Session, Out; the peer has received
%   PeerCount frames. What it lacks is sent again.

session_install(Session, Thread, Out, PeerCount) :-
    Session = session(Key, _, Mutex, Sent, Waiting),
    byte_count(Out, Bytes),
    session_acked(Session, PeerCount, Bytes),
    assertz(serving(Key, Thread)),
    sig_atomic(with_mutex(Mutex,
                          install(Key, Thread, Out, Sent, Waiting))).

install(Key, Thread, Out, Sent, Waiting) :-
    assertz(link(Key, Thread, Out)),
    queue_list(Sent, Again),
    (   Again == [],
        \+ thread_peek_message(Waiting, _)
    ->  true
    ;   start_pusher(Key, Thread, Out, Sent, Waiting, Again)
    ).

queue_list(Queue, List) :-
    findall(Message,
            ( repeat,
              (   take(Queue, Message)
              ->  true
              ;   !,
                  fail
              )
            ),
            List),
    forall(member(Message, List), thread_send_message(Queue, Message)).

%!  session_down(+Session, +Thread) is det.
%
%   The connection of Thread is no more. For that thread only.

session_down(session(Key, _, Mutex, _, _), Thread) :-
    with_mutex(Mutex, retractall(link(Key, Thread, _))),
    forall(retract(pushing(Key, Pusher)),
           crew_retire(Pusher, broken)),
    retractall(serving(Key, Thread)),
    ignore(crew_tell(wanted(Key))).

%!  session_left is det.
%
%   This thread is about to close its connection.  It may have been told to
%   end after session_install/4 and before it began to serve: then the
%   session must not go on writing to what is closed.

session_left :-
    thread_self(Me),
    forall(( serving(Key, Me), session(Key, Session) ),
           session_down(Session, Me)).

%!  session_retire(+Session) is det.
%
%   End the connection of Session, if any, and wait for that.

session_retire(session(Key, _, _, _, _)) :-
    forall(serving(Key, Thread), crew_retire(Thread, replaced)).

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged.

session_pending(session(_, _, _, Sent, Waiting), Count) :-
    queue_size(Sent, S),
    queue_size(Waiting, W),
    Count is S+W.

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
                 acked(Key, Acked, _),
                 Count is Acked+Pending,
                 assertz(flusher(Key, Count, Queue)) )),
    session_pending(Session, Left),
    (   Left =:= 0
    ->  true
    ;   session_control(Session, ping),
        thread_get_message(Queue, flushed, [deadline(Deadline)])
    ).
