:- module(typhon_outbox,
          [ session_send/2,             % +Session, +Term
            session_answer/2,           % +Session, +Term
            session_send_with/2,        % +Session, +Term
            session_hand/3,             % +Session, +Bytes, +Token
            session_hand_bytes/4,       % +Session, +Kind, +Term, -Bytes
            session_mark/2,             % +Session, +Token
            session_object/2,           % +Session, +Answer
            session_acknowledge/1,      % +Session
            session_owes/0,
            session_send_later/2,       % +Session, +Term
            session_later/1,            % -Count
            session_push/1,             % +Session
            session_control/2           % +Session, +Term
          ]).

/** <module> What is sent in a session: every frame once

A frame is kept until it is acknowledged, see unacked.pl, and goes over
another connection if one breaks, see resumption.pl.

Here is what senders call; writer.pl writes.

*Threading*: any thread may send.
*/

:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module('../base/durable_changes',
              [flush_sends/0, output_waits/0, send_after_commit/2]).
:- use_module(frame, [bundle_fits/1, term_bytes/3]).
:- use_module(session,
              [ session_codec/2, session_held/2, session_key/2,
                session_locked/2, session_must_exist/3, debug_frame/4,
                frame_fits/1 ]).
:- use_module(unacked, [session_received/2]).
:- use_module(writer, [flush_out/1, put_control/3, put_frame/4]).

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
%
%   As session_send/2, but Term may be held, see writer.pl.

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

%!  session_mark(+Session, +Token) is det.
%
%   Hand over nothing: Token tells that all that was sent before has arrived.
%
%   @error session_closed

session_mark(Session, Token) :-
    frame_bytes(Session, bundle([]), Bytes),
    session_locked(Session, put_frame(Session, Bytes, Token, flush)).

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

frame_bytes(Session, Term, Bytes) :-
    session_codec(Session, Codec),
    term_bytes(Codec, Term, Bytes),
    string_length(Bytes, Length),
    (   frame_fits(Length)
    ->  debug_frame(to, Session, Term, Bytes)
    ;   resource_error(frame_bytes)
    ).

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
