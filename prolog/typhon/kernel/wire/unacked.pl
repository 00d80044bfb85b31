:- module(typhon_unacked,
          [ unacked_sent/5,             % +Window, +Out, +Bytes, +Token, -Counts
            unacked_waits/3,            % +Session, +Bytes, +Token
            unacked_space/3,            % +Window, +Out, -Space
            unacked_waiting/1,          % +Session
            unacked_owed/2,             % +Session, -Waiting
            unacked_next/3,             % +Session, +Space, -Frame
            unacked_again/2,            % +Session, -Frames
            unacked_resumed/3,          % +Session, +Count, +Bytes
            unacked_close/3,            % +Session, -Waiting, -Handed
            unacked_await/3,            % +Session, +Queue, -Count
            unacked_no_wait/1,          % +Queue
            session_acked/3,            % +Session, +Counts, -Settled
            session_objected/3,         % +Session, +Number, +Answer
            session_answered/3,         % +Session, +Number, +Answer
            session_pending/2           % +Session, -Count
          ]).

/** <module> The window: frames that wait or are not acknowledged

A frame of a session is frame(Bytes, Token, Settled). Frames that were written
to some connection and that the peer has not received are in the queue Sent of
the window, those that never were in Waiting; see session.pl.

A Token that is not `none` is what a caller has handed over with the frame: the
caller learns what became of it. The frame is _settled_ when the peer counts it
among those that it has accepted. If the peer does not accept it, it sends an
objection before it counts the frame. Settled of a frame is how many frames of
the peer were settled when it was put: so a frame that has waited behind an
objection does not settle what the objection is about. How many frames the peer
has received is a count of its own: it opens the window, in whatever order.

*Threading*: the mutex of the session guards its window: a caller of unacked_*
holds it. session_acked/3, session_objected/3 and session_answered/3 are for the
thread of the connection, session_pending/2 is for any thread.
*/

:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module(frame,
              [bundle_all/3, bundle_next/5, count_ahead/3, frame_overhead/1]).
:- use_module(session,
              [ ack_frames/1, session_codec/2, session_held/2, session_key/2,
                session_window/2, session_window/3, session_window_free/1 ]).

:- dynamic
    bundled/2,                          % Key, Count: the last bundle's
    unsettled/3,                        % Key, Number, Token: received
    objection/3,                        % Key, Number, Answer
    flusher/3.                          % Key, Count, Queue

		 /*******************************
		 *            FRAMES            *
		 *******************************/

%   Bytes that may be under way without a chance of blocking in write.

under_way(65536).

%!  unacked_sent(+Window, +Out, +Bytes, +Token, -Counts) is semidet.
%!  unacked_waits(+Session, +Bytes, +Token) is det.
%
%   A frame is about to be written to Out, with Counts in its head: fails where
%   others wait, or it might block; it waits until others are written, and if
%   Token is `loose` it may go with others in one frame then.

unacked_sent(Window, Out, Bytes, Token, counts(Count, Count)) :-
    Window = window(Sent, Waiting, Received, Told, _, _, Settled),
    message_queue_property(Waiting, size(0)),
    unacked_space(Window, Out, Space),
    string_length(Bytes, Length),
    Length < Space,
    get_flag(Received, Count),
    thread_send_message(Sent, frame(Bytes, Token, Count)),
    set_flag(Told, Count),
    set_flag(Settled, Count).

%!  unacked_space(+Window, +Out, -Space) is det.
%
%   So many bytes can be written to Out.

unacked_space(window(_, _, _, _, _, AckedBytes, _), Out, Space) :-
    byte_count(Out, Written),
    get_flag(AckedBytes, Acked),
    under_way(Max),
    Space is Max-(Written-Acked).

unacked_waits(Session, Bytes, Token) :-
    session_window(Session, window(_, Waiting, Received, _, _, _, _)),
    get_flag(Received, Count),
    (   Token == loose
    ->  Frame = loose(Bytes, Count)
    ;   Frame = frame(Bytes, Token, Count)
    ),
    thread_send_message(Waiting, Frame).

%!  unacked_waiting(+Session) is semidet.
%!  unacked_owed(+Session, -Waiting) is semidet.
%
%   Some frame waits; what was written is so much that the peer is sure to
%   acknowledge some of it, and so many wait: it tells every bundle, and all
%   else after ack_frames/1.

unacked_waiting(Session) :-
    session_window(Session, window(_, Waiting, _, _, _, _, _)),
    queue_size(Waiting, Size),
    Size > 0.

unacked_owed(Session, Size) :-
    session_window(Session, Key, window(Sent, Waiting, _, _, _, _, _)),
    (   bundled(Key, _)
    ->  true
    ;   message_queue_property(Sent, size(Written)),
        ack_frames(Frames),
        Written >= Frames
    ),
    message_queue_property(Waiting, size(Size)).

%!  unacked_next(+Session, +Space, -Frame) is semidet.
%
%   The frame that has waited longest is about to be written, if it is not
%   longer than Space.

unacked_next(Session, Space, Frame) :-
    session_codec(Session, Codec),
    session_window(Session, window(Sent, Waiting, _, _, _, _, _)),
    bundle_next(Waiting, Codec, Space, Frame, Many),
    !,
    thread_send_message(Sent, Frame),
    (   Many == true
    ->  session_key(Session, Key),
        session_sent(Session, Count),
        retractall(bundled(Key, _)),
        assertz(bundled(Key, Count))
    ;   true
    ).

%!  unacked_resumed(+Session, +Count, +Bytes) is det.
%!  unacked_again(+Session, -Frames) is det.
%
%   The session has a new connection, to which Bytes were written: the peer
%   has received Count of our frames, of which none is settled by that; Frames
%   are what was written, and has to be once more. A peer that has forgotten
%   the session, and we have not, knows of more than was sent.

unacked_resumed(Session, Count, Bytes) :-
    session_window(Session, Key, Window),
    Window = window(Sent, _, _, Told, Acked, AckedBytes, Settled),
    get_flag(Acked, Count0),
    message_queue_property(Sent, size(Size)),
    Gone is max(0, min(Count-Count0, Size)),
    gone(Gone, Count0, Sent, Key-none, [], [], 0, _),
    Count1 is max(Count0, Count),
    set_flag(Acked, Count1),
    set_flag(AckedBytes, Bytes),
    has_frames(Key, Count1),
    set_flag(Told, -1),                 % the reader begins with telling it
    (   thread_peek_message(Sent, frame(_, _, First))
    ->  set_flag(Settled, First)
    ;   true
    ).

unacked_again(Session, Frames) :-
    session_window(Session, window(Sent, _, _, _, _, _, _)),
    fifo_empty(Sent, Frames),
    forall(member(Frame, Frames), thread_send_message(Sent, Frame)).

%!  unacked_close(+Session, -Waiting, -Handed) is det.
%
%   The session is over; the frames Waiting were never written.  Handed is what
%   became of tokens: handed(Token, Result), where Result is `unsent`, `lost`,
%   or an objection.  Threads that wait for the session go on.

unacked_close(Session, Waiting, Handed) :-
    session_window(Session, Key,
                   window(SentQueue, WaitingQueue, _, _, Acked, _, _)),
    get_flag(Acked, Count),
    findall(N-Token, unsettled(Key, N, Token), Unsettled),
    fifo_empty(SentQueue, Sent),
    fifo_empty(WaitingQueue, Waiting),
    numbered(Sent, Count, Numbered),
    append(Unsettled, Numbered, Lost),
    findall(handed(Token, Result),
            (   member(N-Token, Lost),
                ( objection(Key, N, Answer) -> Result = Answer ; Result = lost )
            ;   member(frame(_, Token, _), Waiting),
                Token \== none,
                Result = unsent
            ),
            Handed),
    retractall(bundled(Key, _)),
    retractall(unsettled(Key, _, _)),
    retractall(objection(Key, _, _)),
    session_window_free(Session),
    forall(flusher(Key, Wanted, Queue), flushed(Key, Wanted, Queue)).

numbered([], _, []).
numbered([frame(_, Token, _)|Frames], N0, Numbered) :-
    N is N0+1,
    (   Token == none
    ->  Numbered = More
    ;   Numbered = [N-Token|More]
    ),
    numbered(Frames, N, More).

		 /*******************************
		 *       ACKNOWLEDGEMENTS       *
		 *******************************/

%!  session_acked(+Session, +Counts, -Settled:list) is det.
%
%   A frame of the peer has these Counts, see frame.pl. Settled are the
%   tokens that are settled by that, settled(Token, Number, Result), Result
%   being `accepted` or an objection. For the thread of the connection.
%
%   @error domain_error(acknowledged, Count) more than was sent

session_acked(Session, counts(Received, Count), Settled) :-
    session_window(Session, Key, Window),
    arg(5, Window, Acked),
    get_flag(Acked, Count0),
    (   count_ahead(Count0, Received, Ahead),
        Ahead > 0
    ->  session_held(Session, acked(Ahead, Key, Window, Count, Tokens, Late))
    ;   Tokens = Late
    ),
    (   unsettled(Key, _, _)
    ->  settled_late(Key, Count, Late)
    ;   Late = []
    ),
    results(Tokens, Key, Settled).

acked(Ahead, Key, Window, Settled, Tokens, Late) :-
    Window = window(Sent, _, _, _, Acked, AckedBytes, _),
    message_queue_property(Sent, size(Size)),
    (   Ahead =< Size
    ->  true
    ;   domain_error(acknowledged, Ahead)
    ),
    get_flag(Acked, Count0),
    gone(Ahead, Count0, Sent, Key-Settled, Tokens, Late, 0, Bytes),
    Count is Count0+Ahead,
    set_flag(Acked, Count),
    get_flag(AckedBytes, Bytes0),
    Bytes1 is Bytes0+Bytes,
    set_flag(AckedBytes, Bytes1),
    has_frames(Key, Count).

%   has_frames(+Key, +Count): the peer has so many.

has_frames(Key, Count) :-
    (   bundled(Key, Last),
        Last =< Count
    ->  retractall(bundled(Key, _))
    ;   true
    ),
    forall(( flusher(Key, Wanted, Queue), Wanted =< Count ),
           flushed(Key, Wanted, Queue)).

%   gone(+Ahead, +Count, +Sent, +How, -Tokens, ?Rest, +Bytes0, -Bytes): the peer
%   has Ahead frames more than Count, of so many bytes.  How is Key-Settled, its
%   count of those that are settled, or Key-none.

gone(0, _, _, _, Tokens, Tokens, Bytes, Bytes) :-
    !.
gone(Ahead, N0, Sent, How, Tokens, Rest, Bytes0, Bytes) :-
    thread_get_message(Sent, frame(Frame, Token, _)),
    string_length(Frame, Length),
    frame_overhead(Head),
    Bytes1 is Bytes0+Length+Head,
    N is N0+1,
    token_gone(Token, N, How, Tokens, Tokens1),
    Ahead1 is Ahead-1,
    gone(Ahead1, N, Sent, How, Tokens1, Rest, Bytes1, Bytes).

token_gone(none, _, _, Tokens, Tokens) :-
    !.
token_gone(Token, N, _-Settled, [N-Token|Tokens], Tokens) :-
    integer(Settled),
    count_ahead(N, Settled, _),
    !.
token_gone(Token, N, Key-_, Tokens, Tokens) :-
    assertz(unsettled(Key, N, Token)).

settled_late(Key, Count, Late) :-
    findall(N-Token,
            ( unsettled(Key, N, Token), count_ahead(N, Count, _) ), Late),
    forall(member(N-_, Late), retractall(unsettled(Key, N, _))).

results([], _, []).
results([N-Token|Tokens], Key, [settled(Token, N, Result)|Settled]) :-
    (   retract(objection(Key, N, Answer))
    ->  Result = Answer
    ;   Result = accepted
    ),
    results(Tokens, Key, Settled).

%!  session_objected(+Session, +Number, +Answer) is det.
%
%   The peer does not accept the frame of that Number, but says Answer. What is
%   not about a frame under way is ignored.

session_objected(Session, Number, Answer) :-
    session_key(Session, Key),
    (   integer(Number),
        (   unsettled(Key, Number, _)
        ;   session_window(Session, window(_, _, _, _, Acked, _, _)),
            get_flag(Acked, Count),
            Number > Count,
            session_sent(Session, Sent),
            Number =< Sent
        ),
        \+ objection(Key, Number, _)
    ->  assertz(objection(Key, Number, Answer))
    ;   true
    ).

%!  session_answered(+Session, +Number, +Answer) is semidet.
%
%   The peer has answered the frame that it had deferred, before it has counted
%   it: this is what it objects.

session_answered(Session, Number, Answer) :-
    session_key(Session, Key),
    retract(objection(Key, Number, deferred)),
    !,
    assertz(objection(Key, Number, Answer)).

%   session_sent(+Session, -Count): so many frames have been written, or less if
%   another thread is about to write some.

session_sent(Session, Count) :-
    session_window(Session, window(Sent, _, _, _, Acked, _, _)),
    get_flag(Acked, Gone),
    queue_size(Sent, Size),
    Count is Gone+Size.

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged, or are handed over and not settled.

session_pending(Session, Count) :-
    session_window(Session, Key, Window),
    unacked(Window, Frames),
    (   unsettled(Key, _, _)
    ->  Count is Frames+1
    ;   Count = Frames
    ).

unacked(window(Sent, Waiting, _, _, _, _, _), Count) :-
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

%!  unacked_await(+Session, +Queue, -Count) is det.
%!  unacked_no_wait(+Queue) is det.
%
%   Count frames are pending; Queue receives `flushed` when all these have been
%   acknowledged; it receives nothing any more.

unacked_await(Session, Queue, Count) :-
    bundle_waiting(Session),
    session_window(Session, Key, Window),
    unacked(Window, Count),
    arg(5, Window, Acked),
    get_flag(Acked, Gone),
    Wanted is Gone+Count,
    assertz(flusher(Key, Wanted, Queue)).

%   What waits is counted as what it will be.

bundle_waiting(Session) :-
    session_codec(Session, Codec),
    session_window(Session, window(_, Waiting, _, _, _, _, _)),
    catch(( bundle_all(Waiting, Codec, Frames),
            forall(member(Frame, Frames), thread_send_message(Waiting, Frame)) ),
          error(existence_error(_, _), _),
          true).

unacked_no_wait(Queue) :-
    retractall(flusher(_, _, Queue)).

%   The waiting thread may have given up just now.

flushed(Key, Wanted, Queue) :-
    retractall(flusher(Key, Wanted, Queue)),
    catch(thread_send_message(Queue, flushed),
          error(existence_error(_, _), _),
          true).
