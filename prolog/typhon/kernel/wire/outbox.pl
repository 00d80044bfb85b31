:- module(typhon_outbox,
          [ session_send/2,             % +Session, +Term
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
            session_control/2           % +Session, +Term
          ]).

/** <module> Sending in a session: each frame arrives once

A frame is kept until it is acknowledged, see unacked.pl, and is sent over
another connection if one breaks, see writer.pl.

This module has the predicates that senders call; writer.pl writes.

*Threading*: any thread may send.
*/

:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module('../base/durable_changes',
              [durable_on/0, flush_sends/0, send_after_commit/2]).
:- use_module(frame, [bundle_fits/1, bytes_term/3, term_bytes/3]).
:- use_module(session,
              [ session_codec/2, session_held/2, session_key/2,
                session_locked/2, session_must_exist/3, session_peer/3,
                debug_frame/4, frame_fits/1 ]).
:- use_module(unacked, [session_received/2]).
:- use_module(writer, [flush_out/1, put_control/3, put_frame/4]).

:- multifile typhon_durable_changes:committed/1.

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
    send_bytes(Session, Bytes, none).

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

send_bytes(Session, Bytes, Token) :-
    (   durable_on
    ->  send_committed(Session, Bytes, Token, now)
    ;   session_locked(Session, put_frame(Session, Bytes, Token, flush))
    ).

%!  session_send_with(+Session, +Term) is det.
%
%   As session_send/2, but Term may be held, see writer.pl.

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
    send_bytes(Session, Bytes, Token).

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
    session_held(Session, put_frame(Session, Bytes, Token, flush)).

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
    session_locked(Session, put_frame(Session, Bytes, Token, flush)).

%!  session_object(+Session, +Answer) is det.
%
%   For the thread of the connection: reject the frame that it is about to
%   count, with Answer.  An objection never waits for a commit: the count would
%   overtake it.

session_object(Session, Answer) :-
    session_received(Session, Count),
    Number is Count+1,
    frame_bytes(Session, objection(Number, Answer), Bytes),
    unless_closed(session_locked(Session,
                                 put_frame(Session, Bytes, none, flush))),
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
    unless_closed(buffer(Session, Bytes)),
    arg(2, Later, Count0),
    Count is Count0+1,
    nb_setarg(2, Later, Count).
session_send_later(Session, Term) :-
    session_answer(Session, Term).

buffer(Session, Bytes) :-
    (   durable_on
    ->  send_committed(Session, Bytes, none, later)
    ;   session_locked(Session, put_frame(Session, Bytes, none, buffer))
    ).

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

%   send_committed(+Session, +Bytes, +Token, +When): as put_frame/4, after the
%   commit.  When is that of send_after_commit/2.

send_committed(Session, Bytes, Token, When) :-
    session_must_exist(Session, _, _),
    send_after_commit(frame(Session, Bytes, Token), When).

%   All frames are written to buffers before the first buffer is flushed.

typhon_durable_changes:committed(Frames) :-
    forall(member(Frame, Frames), put_committed(Frame)),
    findall(Session, member(frame(Session, _, _), Frames), Sessions0),
    list_to_set(Sessions0, Sessions),
    forall(( member(Session, Sessions), session_key(Session, Key) ),
           session_locked(Session, flush_out(Key))).

put_committed(frame(Session, Bytes, Token)) :-
    catch(session_locked(Session, put_frame(Session, Bytes, Token, buffer)),
          error(session_closed, _),
          true).                        % its requests have their results
