:- module(typhon_session,
          [ session/2,                  % ?Key, -Session
            session_open/4,             % +Key, +Peer, +Codec, -Session
            session_key/2,              % +Session, -Key
            session_to_self/1,          % +Session
            session_codec/2,            % +Session, -Codec
            session_window/2,           % +Session, -Window
            session_peer/3,             % +Session, -Process, -Address
            session_proof/2,            % +Session, -Proof
            session_adopting/2,         % +Session, :Goal
            route/2,                    % ?Address, ?Session
            route_add/2,                % +Address, +Session
            connection_is/2,            % +Session, +State
            frame_fits/1,               % +Length
            debug_frame/4,              % +Way, +Session, +Term, +Bytes
            session_settled/4,          % +Session, +Counts, -Settled, -Waiting
            session_objected/3,         % +Session, +Number, +Answer
            session_pending/2,          % +Session, -Count
            objection_answered/3,       % +Session, +Number, +Answer
            session_send/2,             % +Session, +Term
            session_answer/2,           % +Session, +Term
            session_send_with/2,        % +Session, +Term
            session_hand/4,             % +Session, +Kind, +Term, -Hand
            endpoint_hand_over/2,       % +Hand, +Token
            endpoint_hand_to/2,         % +Hand, -Process
            endpoint_handed/2,          % +Hand, -Term
            session_mark/2,             % +Session, +Token
            session_object/2,           % +Session, +Answer
            session_acknowledge/1,      % +Session
            session_owes/0,
            session_send_later/2,       % +Session, +Term
            session_later_begin/1,      % +Session
            session_later/1,            % -Count
            session_push/1,             % +Session
            session_control/2,          % +Session, +Term
            session_release/1,          % +Session
            session_install/4,          % +Session, +Thread, +Out, +PeerCount
            session_lost/2,             % +Session, +Thread
            session_left/0,
            session_retire/1,           % +Session
            session_close/2,            % +Session, -Unsent
            session_up/1,               % +Key
            session_up_since/2,         % +Session, +Time
            route_up/2                  % ?Address, -Session
          ]).

/** <module> Sessions between processes: each frame arrives once

A session joins this process to another for the life of both, over any number
of connections, one at a time. connection.pl gives it its connections. A frame
is kept in the window until it is acknowledged, see window.pl, and is sent over
another connection if one breaks.

A session is session(Key, Codec, Mutex, Adoption, peer(Process, Address, Proof),
Window). Key names the peer. Mutex guards the sending side; a thread that gives
the session a new connection holds Adoption. Only this module accesses the
arguments of the term.

A received frame is _settled_ when the peer counts it among those that it has
accepted. If the peer does not accept a frame, it sends an objection before it
counts the frame. A hand-over is Number-Token: the number of the frame, and the
term by which the caller identifies its result.

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

*Threading*: any thread may send, and look. A mutex serializes sessions and
routes; the mutex of a session guards its connection, its window, and the order
of its frames. Settlement, session_release/1, session_install/4 and
session_left/0 are for the thread of the connection, or the one that acts in its
place; the hooks run there, too. A thread that gives a session another
connection, or ends it, retires and closes the session, inside
session_adopting/2 or after all threads have ended. While a session is up and
has no pusher, only held posts wait.
*/

:- use_module(library(apply), [include/3]).
:- use_module(library(debug), [debug/3, debugging/1]).
:- use_module(library(error), [permission_error/3, resource_error/1]).
:- use_module(library(lists), [append/3, list_to_set/2, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/durable',
              [durable_on/0, flush_sends/0, send_after_commit/2]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(frame,
              [ bundle_fits/1, bytes_term/3, count_ahead/3, frame_write/3,
                term_bytes/3 ]).
:- use_module(handshake, [hello_peer/4]).
:- use_module(threads,
              [ manager_notify/1, wire_thread_create/3, wire_thread_end/2,
                wire_thread_signal/2 ]).
:- use_module(window,
              [ window_acked/4, window_ahead/3, window_close/4,
                window_control/5, window_counts/4, window_next/6,
                window_open/1, window_owed/2,
                window_received/2, window_resumed/5, window_sent/5,
                window_settled/1, window_unacked/2, window_under_way/2,
                window_wait/3, window_waiting/1 ]).

:- setting(frame_bytes, positive_integer, 67108864,
           "The longest frame sent or taken, in bytes").

:- meta_predicate
    session_locked(+, 0),
    session_held(+, 0),
    session_adopting(+, 0).

:- dynamic
    session/2,                          % Key, Session
    route/2,                            % Address, Session
    started/3,                          % Process, Proof, Start: the latest
    unsettled/3,                        % Key, Number, Token: received
    objection/3,                        % Key, Number, Answer
    transport/3,                        % Key, Thread, Out: can be written to
    serving/3,                          % Key, Thread, Since: its connection
    pusher/2,                           % Key, Thread: it alone may write
    control/3.                          % Key, Kind, Bytes: written first

:- multifile typhon_durable:committed/1.

%!  session(?Key, -Session) is nondet.
%
%   The sessions.

%!  route(?Address, ?Session) is nondet.
%
%   Address leads to Session.

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
%   Window is that of window.pl.  Other modules only read its counts, and count
%   received frames.

session_window(session(_, _, _, _, _, Window), Window).

%!  session_peer(+Session, -Process, -Address) is det.
%
%   Address is where the peer claims to listen.

session_peer(session(_, _, _, _, peer(Process, Address, _), _), Process,
             Address).

%!  session_proof(+Session, -Proof) is det.
%
%   Proof is that of the peer, see typhon_transport.

session_proof(session(_, _, _, _, peer(_, _, Proof), _), Proof).

%!  session_open(+Key, +Peer, +Codec, -Session) is det.
%
%   Session is the session with the peer Key.  On first contact it is created.
%   Peer is Hello-Proof.
%
%   @error permission_error(authenticate, peer, other) if the session is
%   that of another peer, whose key this peer uses
%   @error permission_error(authenticate, peer, superseded) if a later start of
%   that process is known

session_open(Key, Hello-Proof, Codec, Session) :-
    with_mutex(typhon_session,
               ( must_be_latest(Hello, Proof),
                 open_session(Key, Hello, Proof, Codec, Session) )),
    (   session_proof(Session, Proof)
    ->  true
    ;   permission_error(authenticate, peer, other)
    ).

%   A process may have been started again elsewhere while it was suspended.  The
%   starts that a peer claims count for peers of that proof.

must_be_latest(Hello, Proof) :-
    hello_peer(Hello, Process, Start, _),
    (   started(Process, Proof, Latest),
        Start =< Latest
    ->  ( Start =:= Latest -> true
        ; permission_error(authenticate, peer, superseded) )
    ;   retractall(started(Process, Proof, _)),
        bounded(started(_, _, _), typhon_peer_cache:contacts,
                assertz(started(Process, Proof, Start)))
    ).

open_session(Key, _, _, _, Session) :-
    session(Key, Session),
    !.
open_session(Key, Hello, Proof, Codec, Session) :-
    hello_peer(Hello, Process, _, Address),
    mutex_create(Mutex),
    mutex_create(Adoption),
    window_open(Window),
    Session = session(Key, Codec, Mutex, Adoption,
                      peer(Process, Address, Proof), Window),
    assertz(session(Key, Session)).

%   session_must_exist(+Session, -Key, -Window): Session has not been closed;
%   another session may have its key by now.

session_must_exist(Session, Key, Window) :-
    Session = session(Key, _, _, _, _, Window),
    (   session(Key, Session)
    ->  true
    ;   throw(error(session_closed, _))
    ).

%   session_locked(+Session, :Goal): run once(Goal) under the mutex of the
%   sending side of Session, with signals deferred.

session_locked(session(_, _, Mutex, _, _, _), Goal) :-
    sig_atomic(with_mutex(Mutex, Goal)).

%   session_held(+Session, :Goal): as session_locked/2, for threads that have
%   deferred signals already.

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
    ;   report(error, errors_of_hooks, connection,
               typhon(endpoint, hook(connection, Problem)))
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

                /*******************************
                *          SETTLEMENT          *
                *******************************/

%!  session_settled(+Session, +Counts, -Settled:list, -Waiting:integer) is det.
%
%   A frame of the peer has these Counts, see frame.pl. Settled lists the
%   hand-overs that they settle, settled(Token, Number, Result), Result being
%   `accepted` or an objection.  Waiting is 0 if the peer has acknowledged
%   nothing by them, else the number of frames that wait.
%
%   @error domain_error(acknowledged, Count)

session_settled(Session, counts(Received, Count), Settled, Waiting) :-
    session_key(Session, Key),
    (   acked(Session, Received, Handed, Waiting)
    ->  settled_now(Handed, Key, Count, Settled, Late)
    ;   Settled = Late,
        Waiting = 0
    ),
    settled_late(Key, Count, Late).

acked(Session, Received, Handed, Waiting) :-
    session_window(Session, Window),
    window_ahead(Window, Received, Ahead),
    session_held(Session, window_acked(Window, Ahead, Handed, Waiting)).

settled_now([], _, _, Settled, Settled).
settled_now([N-Token|Handed], Key, Count, Settled, Rest) :-
    (   count_ahead(N, Count, _)
    ->  result(Key, N, accepted, Result),
        Settled = [settled(Token, N, Result)|More]
    ;   assertz(unsettled(Key, N, Token)),
        Settled = More
    ),
    settled_now(Handed, Key, Count, More, Rest).

%   As settled_now/5, for frames that the peer had received before.

settled_late(Key, Count, Settled) :-
    unsettled(Key, _, _),
    !,
    findall(settled(Token, N, Result),
            ( unsettled(Key, N, Token),
              count_ahead(N, Count, _),
              retract(unsettled(Key, N, _)),
              result(Key, N, accepted, Result) ),
            Settled).
settled_late(_, _, []).

result(Key, N, Default, Result) :-
    (   retract(objection(Key, N, Answer))
    ->  Result = Answer
    ;   Result = Default
    ).

%   unsettled_add(+Key, +Handed:list): the peer has received the frames of
%   Handed, and none of them is settled.

unsettled_add(Key, Handed) :-
    forall(member(N-Token, Handed), assertz(unsettled(Key, N, Token))).

%   settled_never(+Key, +Sent:list, +Unsent:list, -Handed:list): the session is
%   over; Sent and Unsent are those of window_close/4. Handed lists the results
%   of all hand-overs that were not settled: handed(Token, Result), Result
%   being `lost`, `unsent`, or an objection.

settled_never(Key, Sent, Unsent, Handed) :-
    findall(N-Token, unsettled(Key, N, Token), Received),
    retractall(unsettled(Key, _, _)),
    findall(handed(Token, Result),
            (   ( member(N-Token, Received) ; member(N-Token, Sent) ),
                result(Key, N, lost, Result)
            ;   member(Token, Unsent),
                Result = unsent
            ),
            Handed),
    retractall(objection(Key, _, _)).

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged, or are hand-overs that are not settled.

session_pending(Session, Count) :-
    Session = session(Key, _, _, _, _, Window),
    window_unacked(Window, Count0),
    ( unsettled(Key, _, _) -> Count is Count0+1 ; Count = Count0 ).

%!  session_objected(+Session, +Number, +Answer) is det.
%
%   Record that the peer rejects the frame of that Number with Answer.  Only its
%   first objection counts, and none to a frame that is not under way.

session_objected(Session, Number, Answer) :-
    Session = session(Key, _, _, _, _, Window),
    (   integer(Number),
        \+ objection(Key, Number, _),
        ( unsettled(Key, Number, _) ; window_under_way(Window, Number) )
    ->  assertz(objection(Key, Number, Answer))
    ;   true
    ).

%!  objection_answered(+Session, +Number, +Answer) is semidet.
%
%   The peer has answered a frame that it had deferred, before it has counted
%   it: Answer replaces the objection.

objection_answered(Session, Number, Answer) :-
    session_key(Session, Key),
    retract(objection(Key, Number, deferred)),
    !,
    assertz(objection(Key, Number, Answer)).

                /*******************************
                *           SENDING            *
                *******************************/

%!  session_send(+Session, +Term) is det.
%
%   Send Term: it arrives once, and in the order of this thread's sends.
%   Never blocks on the network.
%
%   @error session_closed if the peer is gone for good
%   @error resource_error(frame_bytes) if Term is too long for a frame

session_send(Session, Term) :-
    frame_bytes(Session, Term, Bytes),
    answers_first(Session),
    send_bytes(Session, Bytes, none, now).

%!  session_answer(+Session, +Term) is det.
%
%   As session_send/2, for answers: if the session or the store has been closed
%   the answer is dropped.

session_answer(Session, Term) :-
    unless_closed(session_send(Session, Term)).

%   A frame for a peer that is gone is of no use; after the store was closed
%   peers must not learn of further events.

:- meta_predicate unless_closed(0).

unless_closed(Goal) :-
    catch(Goal, error(Formal, Context),
          ( is_closed(Formal) -> true ; throw(error(Formal, Context)) )).

is_closed(session_closed).
is_closed(existence_error(_, open)).    % the store

%   send_bytes(+Session, +Bytes, +Token, +When): as put_frame/4, with a journal
%   after the commit.  When is also that of send_after_commit/2.

send_bytes(Session, Bytes, Token, When) :-
    durable_on,
    !,
    session_must_exist(Session, _, _),
    send_after_commit(frame(Session, Bytes, Token), When).
send_bytes(Session, Bytes, Token, When) :-
    session_locked(Session, put_frame(Session, Bytes, Token, When)).

%!  session_send_with(+Session, +Term) is det.
%
%   As session_send/2, but Term may be held.

session_send_with(Session, Term) :-
    answers_left(Own, _),
    !,
    (   Own == Session
    ->  session_send(Session, Term)     % so that the answers go, too
    ;   session_push(Own),
        session_send_with(Session, Term)
    ).
session_send_with(Session, Term) :-
    frame_bytes(Session, Term, Bytes),
    (   bundle_fits(Bytes)
    ->  Token = loose
    ;   Token = none
    ),
    send_bytes(Session, Bytes, Token, now).

%!  session_hand(+Session, +Kind, +Term, -Hand) is det.
%
%   Hand is the frame by which Term is handed over, hand(Session, Bytes).
%
%   @error resource_error(frame_bytes), type_error(mobile_term, Culprit)

session_hand(Session, Kind, Term, hand(Session, Bytes)) :-
    frame_bytes(Session, hand(Kind, Term), Bytes).

%!  endpoint_hand_over(+Hand, +Token) is det.
%
%   Send Hand.  The hook handed_over(Token, Result) gets the result, in a thread
%   of the endpoint.  The caller defers signals.
%
%   @error session_closed

endpoint_hand_over(hand(Session, Bytes), Token) :-
    answers_first(Session),
    session_held(Session, put_frame(Session, Bytes, Token, now)).

%!  endpoint_hand_to(+Hand, -Process) is det.
%
%   Hand goes to Process.

endpoint_hand_to(hand(Session, _), Process) :-
    session_peer(Session, Process, _).

%!  endpoint_handed(+Hand, -Term) is det.
%
%   Hand hands over Term.

endpoint_handed(hand(Session, Bytes), Term) :-
    session_codec(Session, Codec),
    bytes_term(Codec, Bytes, hand(_, Term)).

%!  session_mark(+Session, +Token) is det.
%
%   Hand over an empty frame: its result, under Token, means that all frames
%   sent before have arrived.
%
%   @error session_closed

session_mark(Session, Token) :-
    frame_bytes(Session, bundle([]), Bytes),
    session_locked(Session, put_frame(Session, Bytes, Token, now)).

%!  session_object(+Session, +Answer) is det.
%
%   For the thread of the connection: reject the frame that it is about to
%   count, with Answer.  An objection never waits for a commit: the count would
%   overtake it.

session_object(Session, Answer) :-
    session_window(Session, Window),
    window_received(Window, Count),
    Number is Count+1,
    frame_bytes(Session, objection(Number, Answer), Bytes),
    unless_closed(session_locked(Session,
                                 put_frame(Session, Bytes, none, now))),
    session_owes.

%!  session_owes is det.
%
%   For the thread of the connection: the peer waits for the count of the frame
%   that is about to be counted.  It goes with the next frame, see
%   session_send_later/2.

session_owes :-
    nb_getval(typhon_later, Later),
    nb_setarg(3, Later, true).

%   Answers that a reader has buffered go with this frame, or before a frame to
%   another peer: the process that gets this frame must not report an agent
%   before the peer has the answer that the agent has arrived here.

answers_first(Session) :-
    answers_left(Own, Later),
    !,
    (   Own == Session
    ->  none_later(Later)
    ;   session_push(Own)
    ).
answers_first(_).

answers_left(Session, Later) :-
    nb_current(typhon_later, Later),
    Later = later(Session, Count, Owing),
    ( Owing == true -> true ; Count > 0 ).

none_later(Later) :-
    nb_setarg(2, Later, 0),
    nb_setarg(3, Later, false).

%!  session_send_later(+Session, +Term) is det.
%
%   Send Term with the next frame.  Only the thread of the connection may buffer
%   frames: it calls session_push/1 soon after it has done so.  Other threads
%   send at once.

session_send_later(Session, Term) :-
    nb_current(typhon_later, Later),
    !,
    frame_bytes(Session, Term, Bytes),
    unless_closed(send_bytes(Session, Bytes, none, later)),
    arg(2, Later, Count0),
    Count is Count0+1,
    nb_setarg(2, Later, Count).
session_send_later(Session, Term) :-
    session_answer(Session, Term).

%!  session_later_begin(+Session) is det.
%
%   This thread, which begins to read frames of Session, may buffer frames.  Its
%   state is later(Session, Count, Owing): it has buffered Count frames, and the
%   peer waits for the count of received frames if Owing is `true`; a new
%   connection sends the count of frames that were received before.

session_later_begin(Session) :-
    nb_setval(typhon_later, later(Session, 0, true)).

%!  session_later(-Count) is det.
%
%   The number of frames, one with the count included, that this thread has to
%   send.

session_later(Count) :-
    nb_getval(typhon_later, later(_, Count0, Owing)),
    (   Owing == true
    ->  Count is Count0+1
    ;   Count = Count0
    ).

%!  session_push(+Session) is det.
%
%   Send the frames that this thread has buffered.

session_push(Session) :-
    ( durable_on -> flush_sends ; true ),
    nb_getval(typhon_later, Later),
    (   arg(3, Later, true)
    ->  session_acknowledge(Session)
    ;   durable_on
    ->  true
    ;   session_key(Session, Key),
        session_locked(Session, flush_out(Key))
    ),
    none_later(Later).

frame_bytes(Session, Term, Bytes) :-
    session_codec(Session, Codec),
    term_bytes(Codec, Term, Bytes),
    string_length(Bytes, Length),
    (   frame_fits(Length)
    ->  debug_frame(to, Session, Term, Bytes)
    ;   resource_error(frame_bytes)
    ).

%!  session_control(+Session, +Term) is det.
%
%   Send Term outside the count, before all frames that wait.  It is dropped if
%   the session is down, or if a newer term of its kind follows.

session_control(Session, Term) :-
    session_codec(Session, Codec),
    term_bytes(Codec, Term, Bytes),
    debug_frame(to, Session, Term, Bytes),
    functor(Term, Kind, _),
    session_locked(Session, put_control(Session, Kind, Bytes)).

%!  session_acknowledge(+Session) is det.
%
%   As session_control/2, with nothing but counts.

session_acknowledge(Session) :-
    session_locked(Session, put_control(Session, acknowledge, "")).

                /*******************************
                *           COMMITTED          *
                *******************************/

%   All frames are written to buffers before the first buffer is flushed.

typhon_durable:committed(Frames) :-
    forall(member(Frame, Frames), put_committed(Frame)),
    findall(Session, member(frame(Session, _, _), Frames), Sessions0),
    list_to_set(Sessions0, Sessions),
    forall(( member(Session, Sessions), session_key(Session, Key) ),
           session_locked(Session, flush_out(Key))).

put_committed(frame(Session, Bytes, Token)) :-
    catch(session_locked(Session, put_frame(Session, Bytes, Token, later)),
          error(session_closed, _),
          true).                        % its requests have their results

                /*******************************
                *           WRITING            *
                *******************************/

%   put_frame(+Session, +Bytes, +Token, +When): write Bytes, or let them wait;
%   the buffer is flushed `now` or `later`. If Token is `loose`, Bytes may be
%   held, and be bundled with others.

put_frame(Session, Bytes, Token, When) :-
    session_must_exist(Session, Key, Window),
    (   Token == loose,
        holds(Session, Key)
    ->  window_wait(Window, Bytes, loose)
    ;   writable(Key, Thread, Out),
        window_sent(Window, Out, Bytes, Token, Counts)
    ->  written(When, Key, Thread, Out, Counts, Bytes)
    ;   window_wait(Window, Bytes, Token),
        write_or_connect(Session, Key)
    ).

%   holds(+Session, +Key): the peer will acknowledge some of the frames under
%   way, and not too many wait; or there is a pusher.

most_held(256).

holds(_, Key) :-
    pusher(Key, _),
    !.
holds(Session, Key) :-
    session_up(Key),
    session_window(Session, Window),
    window_owed(Window, Waiting),
    most_held(Most),
    Waiting < Most.

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

written(When, Key, Thread, Out, Counts, Bytes) :-
    catch(write_out(When, Out, Counts, Bytes),
          error(_, _),
          transport_broken(Key, Thread)).

write_out(When, Out, Counts, Bytes) :-
    frame_write(Out, Counts, Bytes),
    ( When == now -> flush_output(Out) ; true ).

%   put_control(+Session, +Kind, +Bytes): write Bytes outside the count, before
%   all frames that wait. They are dropped if the session is down, or if newer
%   ones of their Kind follow. Held posts do not prevent writing them at once,
%   because posts settle nothing.

put_control(Session, Kind, Bytes) :-
    Session = session(Key, _, _, _, _, Window),
    (   writable(Key, Thread, Out),
        window_control(Window, Out, room, Bytes, Counts)
    ->  written(now, Key, Thread, Out, Counts, Bytes)
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
        ( waiting(Session) -> push_what_waits(Session, Key) ; true )
    ;   ignore(manager_notify(wanted(Key)))
    ).

waiting(Session) :-
    session_window(Session, Window),
    window_waiting(Window).

push_what_waits(Session, Key) :-
    (   writable(Key, Thread, Out)
    ->  pusher_start(Session, Key, Thread, Out, [])
    ;   true
    ).

%   flush_out(+Key): flush the frames that were written to the buffer.

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
    Session = session(Key, Codec, _, _, _, Window),
    (   retract(control(Key, _, Bytes))
    ->  window_control(Window, Out, all, Bytes, Counts)
    ;   window_next(Window, Codec, Out, Most, Counts, Bytes)
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
    session_window(Session, Window),
    session_locked(Session, window_counts(Window, Frame, Counts, Bytes)),
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
    \+ waiting(Session),
    Session = session(Key, _, _, _, _, Window),
    (   window_settled(Window)
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
    session_must_exist(Session, Key, Window),
    byte_count(Out, Bytes),
    window_resumed(Window, PeerCount, Bytes, Handed, Again),
    unsettled_add(Key, Handed),
    monotonic_time(Now),
    assertz(serving(Key, Thread, Now)),
    assertz(transport(Key, Thread, Out)),
    (   Again == [],
        \+ waiting(Session)
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

%   The mutexes are left to the garbage collector: another thread may wait for
%   them.

forget(Session, Waiting, Handed) :-
    Session = session(Key, _, _, _, _, Window),
    with_mutex(typhon_session,
               ( retract(session(Key, Session)),
                 retractall(route(_, Session)) )),
    debug(typhon(session), '~w: forgotten', [Key]),
    window_close(Window, Waiting, Sent, NotSent),
    settled_never(Key, Sent, NotSent, Handed).
