:- module(typhon_outbox,
          [ session_send/2,             % +Session, +Term
            session_answer/2,           % +Session, +Term
            session_send_with/2,        % +Session, +Term
            session_hand/3,             % +Session, +Bytes, +Token
            session_hand_bytes/4,       % +Session, +Kind, +Term, -Bytes
            session_object/2,           % +Session, +Answer
            session_acknowledge/1,      % +Session
            session_owes/0,
            session_release/1,          % +Session
            session_send_later/2,       % +Session, +Term
            session_later/1,            % -Count
            session_push/1,             % +Session
            session_control/2           % +Session, +Term
          ]).

/** <module> What is sent in a session: every frame once

A frame is kept until it is acknowledged, see unacked.pl, and goes over
another connection if one breaks, see resumption.pl.

Writing must never block the thread of a reader, or two readers could wait
for each other, nor hold a thread that is not ours. A frame is therefore
written by its sender only if it and all that is under way fit in
what the buffers of the kernel hold; else it waits, and a thread of the
session, the pusher, writes. So do those outside the count.

To write a small frame costs more than all else that is done for it. So
posts are held while so much is under way that the peer is sure to acknowledge
some of it; when that has come they go in one frame. The peer would not read
them before, anyway. What is sent after them takes them along.

*Threading*: any thread may send. The mutex of the session guards the
order. While a session is up and has no pusher, nothing waits but what
is held.
*/

:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module('../base/durable_changes',
              [flush_sends/0, output_waits/0, send_after_commit/2]).
:- use_module(frame,
              [bundle_fits/1, frame_overhead/1, frame_write/3, term_bytes/3]).
:- use_module(session,
              [ session_codec/2, session_held/2, session_key/2,
                session_locked/2, session_must_exist/3, session_received/2,
                session_up/1, session_window/2, session_window/3, transport/3,
                transport_broken/2, debug_frame/4, frame_fits/1 ]).
:- use_module(threads, [manager_notify/1]).
:- use_module(pusher, [pusher/2, pusher_control/3, pusher_start/4]).
:- use_module(unacked,
              [ unacked_next/3, unacked_owed/2, unacked_sent/5,
                unacked_space/3, unacked_waiting/1, unacked_waits/3 ]).

:- multifile typhon_durable_changes:committed/1.

%!  session_send(+Session, +Term) is det.
%
%   Send Term: it arrives once, and in the order of this thread's sends.
%   Never blocks on the network.
%
%   @error session_closed the peer is gone for good
%   @error resource_error(frame_bytes) Term is too long for a frame

session_send(Session, Term) :-
    send(Session, Term, now).

%!  session_answer(+Session, +Term) is det.
%
%   As session_send/2, of what a caller waits for: while the store is full
%   it waits, too. When the store has been closed it is dropped.

session_answer(Session, Term) :-
    unless_closed(send(Session, Term, anyhow)).

%   When the store has been closed no peer may learn what happens.

:- meta_predicate unless_closed(0).

unless_closed(Goal) :-
    catch(Goal, error(existence_error(_, open), _), true).

send(Session, Term, When) :-
    frame_bytes(Session, Term, Bytes),
    answers_first(Session),
    goes(Session, Bytes, none, When).

goes(Session, Bytes, Token, When) :-
    (   output_waits
    ->  let_out(Session, Bytes, Token, When)
    ;   session_locked(Session, put_frame(Session, Bytes, Token, flush))
    ).

%!  session_send_with(+Session, +Term) is det.
%!  session_release(+Session) is det.
%
%   As session_send/2, but Term may be held; the peer has acknowledged
%   something: what is held goes.

session_send_with(Session, Term) :-
    answers_left(Own),
    !,
    (   Own == Session
    ->  session_send(Session, Term)     % so that they go, too
    ;   session_push(Own),
        session_send_with(Session, Term)
    ).
session_send_with(Session, Term) :-
    frame_bytes(Session, Term, Bytes),
    (   bundle_fits(Bytes)
    ->  Token = loose
    ;   Token = none
    ),
    goes(Session, Bytes, Token, now).

session_release(Session) :-
    (   unacked_waiting(Session)
    ->  session_key(Session, Key),
        session_locked(Session, see_to(Session, Key))
    ;   true
    ).

%!  session_hand_bytes(+Session, +Kind, +Term, -Bytes) is det.
%!  session_hand(+Session, +Bytes, +Token) is det.
%
%   Bytes are the frame that hands over Term; send it, and learn by Token what
%   became of it: see request.pl.  The caller of session_hand/3 holds signals
%   back.
%
%   @error resource_error(frame_bytes), type_error(mobile_term, Culprit)
%   @error session_closed

session_hand_bytes(Session, Kind, Term, Bytes) :-
    frame_bytes(Session, hand(Kind, Term), Bytes).

session_hand(Session, Bytes, Token) :-
    answers_first(Session),
    session_held(Session, put_frame(Session, Bytes, Token, flush)).

%!  session_object(+Session, +Answer) is det.
%!  session_owes is det.
%
%   For the thread of the connection, of the frame that it is about to count:
%   the peer learns that it is not accepted, but Answer; the peer waits for the
%   count of it, which goes with whatever is sent next, see
%   session_send_later/2. An objection never waits for a commit: the count would
%   overtake it.

session_object(Session, Answer) :-
    session_received(Session, Count),
    Number is Count+1,
    frame_bytes(Session, objection(Number, Answer), Bytes),
    unless_closed(session_locked(Session,
                                 put_frame(Session, Bytes, none, flush))),
    session_owes.

session_owes :-
    nb_getval(typhon_later, Count),
    Count1 is Count+1,
    nb_linkval(typhon_later, Count1),
    nb_linkval(typhon_owing, true).

%   What a reader has left goes along, or before what is sent to other peers:
%   the next process must not report an agent before the answer that it has come
%   to this one has left.

answers_first(Session) :-
    answers_left(Own),
    !,
    (   Own == Session
    ->  nb_linkval(typhon_later, 0),
        nb_linkval(typhon_owing, false)
    ;   session_push(Own)
    ).
answers_first(_).

answers_left(Session) :-
    nb_current(typhon_later, Count),
    Count > 0,
    nb_current(typhon_later_in, Session).

%!  session_send_later(+Session, +Term) is det.
%!  session_later(-Count) is det.
%!  session_push(+Session) is det.
%
%   Send Term with whatever is sent next.  Only the thread of the connection
%   may leave something: it says session_push/1 when it begins, and again
%   before long when Count frames have been left.  Others send at once.

session_send_later(Session, Term) :-
    nb_current(typhon_later, Count),
    !,
    frame_bytes(Session, Term, Bytes),
    (   output_waits
    ->  unless_closed(let_out(Session, Bytes, none, later))
    ;   session_locked(Session, put_frame(Session, Bytes, none, buffer))
    ),
    Count1 is Count+1,
    nb_linkval(typhon_later, Count1).
session_send_later(Session, Term) :-
    session_answer(Session, Term).

session_later(Count) :-
    nb_getval(typhon_later, Count).

session_push(Session) :-
    ( output_waits -> flush_sends ; true ),
    (   nb_current(typhon_owing, true)
    ->  session_acknowledge(Session)
    ;   output_waits
    ->  true
    ;   session_key(Session, Key),
        session_locked(Session, flush_out(Key))
    ),
    nb_linkval(typhon_later, 0),
    nb_linkval(typhon_owing, false),
    (   nb_current(typhon_later_in, Session)
    ->  true
    ;   nb_setval(typhon_later_in, Session)
    ).

flush_out(Key) :-
    (   writable(Key, Thread, Out)
    ->  catch(flush_output(Out),
              error(_, _),
              transport_broken(Key, Thread))
    ;   true
    ).

frame_bytes(Session, Term, Bytes) :-
    session_codec(Session, Codec),
    term_bytes(Codec, Term, Bytes),
    string_length(Bytes, Length),
    (   frame_fits(Length)
    ->  debug_frame(to, Session, Term, Bytes)
    ;   resource_error(frame_bytes)
    ).

%   put_frame(+Session, +Bytes, +Token, +Flush): Token is `loose` if Bytes may
%   be held, and go with others when they have to wait.

put_frame(Session, Bytes, loose, Flush) :-
    !,
    session_must_exist(Session, Key, Window),
    (   holds(Session, Key)
    ->  unacked_waits(Session, Bytes, loose)
    ;   put(Session, Key-Window, Bytes, loose, none, Flush)
    ).
put_frame(Session, Bytes, Token, Flush) :-
    session_must_exist(Session, Key, Window),
    put(Session, Key-Window, Bytes, Token, Token, Flush).

%   holds(+Session, +Key): the peer will acknowledge some of what is under way,
%   and not too much waits; or there is a pusher.

most_held(256).

holds(Session, Key) :-
    (   pusher(Key, _)
    ->  true
    ;   session_up(Key),
        unacked_owed(Session, Waiting),
        most_held(Most),
        Waiting < Most
    ).

put(Session, Key-Window, Bytes, Waiting, Sent, Flush) :-
    (   writable(Key, Thread, Out),
        unacked_sent(Window, Out, Bytes, Sent, Counts)
    ->  written(Flush, Key, Thread, Out, Counts, Bytes)
    ;   unacked_waits(Session, Bytes, Waiting),
        see_to(Session, Key)
    ).

%   writable(+Key, -Thread, -Out): Out can be written to. The stream of a pusher
%   is left alone: even to look at it might block.

writable(Key, Thread, Out) :-
    transport(Key, Thread, Out),
    \+ pusher(Key, _).

%   Something waits: it is written, or a connection made.

see_to(Session, Key) :-
    (   pusher(Key, _)
    ->  true
    ;   transport(Key, Thread, Out)
    ->  write_waiting(Session, Key, Thread, Out)
    ;   ignore(manager_notify(wanted(Key)))
    ).

write_waiting(Session, Key, Thread, Out) :-
    catch(( write_while_room(Session, Key), flush_output(Out) ),
          error(_, _),
          transport_broken(Key, Thread)),
    (   unacked_waiting(Session)
    ->  push(Session, Key)
    ;   true
    ).

%   In order: a frame settles what was received when it was put, and no more,
%   since an objection may wait behind it.

write_while_room(Session, Key) :-
    (   writable(Key, _, Out),
        session_window(Session, Window),
        unacked_space(Window, Out, Space),
        unacked_next(Session, Space, frame(Bytes, _, Settled))
    ->  session_received(Session, Count),
        frame_write(Out, counts(Count, Settled), Bytes),
        write_while_room(Session, Key)
    ;   true
    ).

push(Session, Key) :-
    (   writable(Key, Thread, Out)
    ->  pusher_start(Session, Thread, Out, [])
    ;   true
    ).

written(Flush, Key, Thread, Out, Counts, Bytes) :-
    catch(( frame_write(Out, Counts, Bytes),
            ( Flush == flush -> flush_output(Out) ; true )
          ),
          error(_, _),
          transport_broken(Key, Thread)).

%!  session_control(+Session, +Term) is det.
%!  session_acknowledge(+Session) is det.
%
%   Send Term, or nothing but counts, outside the count, before all that waits:
%   dropped when the session is down, and where a newer one of its kind follows.

session_control(Session, Term) :-
    session_codec(Session, Codec),
    term_bytes(Codec, Term, Bytes),
    debug_frame(to, Session, Term, Bytes),
    functor(Term, Kind, _),
    session_locked(Session, put_control(Session, Kind, Bytes)).

session_acknowledge(Session) :-
    session_locked(Session, put_control(Session, acknowledge, "")).

%   If something waits it is held without a pusher: posts, which settle nothing.

put_control(Session, Kind, Bytes) :-
    session_window(Session, Key, Window),
    (   writable(Key, Thread, Out),
        unacked_space(Window, Out, Space),
        string_length(Bytes, Length),
        Length < Space
    ->  control_counts(Window, Length, Counts),
        written(flush, Key, Thread, Out, Counts, Bytes)
    ;   session_up(Key)
    ->  pusher_control(Key, Kind, Bytes),
        push(Session, Key)
    ;   true
    ).

%   The peer does not acknowledge it: its bytes are not under way.

control_counts(window(_, _, Received, Told, _, AckedBytes, Settled), Length,
               counts(Count, Count)) :-
    get_flag(Received, Count),
    set_flag(Told, Count),
    set_flag(Settled, Count),
    frame_overhead(Head),
    get_flag(AckedBytes, Acked0),
    Acked is Acked0+Length+Head,
    set_flag(AckedBytes, Acked).

                /*******************************
                *       WHAT IS COMMITTED      *
                *******************************/

%   let_out(+Session, +Bytes, +Token, +When): as put_frame/4, When as of
%   send_after_commit/2.

let_out(Session, Bytes, Token, When) :-
    session_must_exist(Session, _, _),
    send_after_commit(frame(Session, Bytes, Token), When).

%   All are written, then all go.

typhon_durable_changes:committed(Frames) :-
    forall(member(Frame, Frames), let_out(Frame)),
    findall(Session, member(frame(Session, _, _), Frames), Sessions0),
    list_to_set(Sessions0, Sessions),
    forall(( member(Session, Sessions), session_key(Session, Key) ),
           session_locked(Session, flush_out(Key))).

let_out(frame(Session, Bytes, Token)) :-
    catch(session_locked(Session, put_frame(Session, Bytes, Token, buffer)),
          error(session_closed, _),
          true).                        % callers have got a result
