:- module(typhon_unacked,
          [ unacked_open/1,             % -Window
            unacked_sent/5,             % +Window, +Out, +Bytes, +Token, -Counts
            unacked_waits/3,            % +Window, +Bytes, +Token
            unacked_waiting/1,          % +Session
            unacked_owed/2,             % +Session, -Waiting
            unacked_next/5,             % +Session, +Out, +Most, -Counts, -Bytes
            unacked_control/5,          % +Window, +Out, +Most, +Bytes, -Counts
            unacked_settled/1,          % +Window
            unacked_counts/4,           % +Session, +Frame, -Counts, -Bytes
            unacked_resumed/5,          % +Session, +Count, +Bytes, -Handed,
                                        % -Frames
            unacked_close/4,            % +Session, -Waiting, -Sent, -Unsent
            ack_frames/1,               % -Count
            session_acked/4,            % +Session, +Received, -Handed,
                                        % -Waiting
            session_under_way/2,        % +Session, +Number
            session_unacked/2,          % +Session, -Count
            session_received/2,         % +Session, -Count
            session_count/2,            % +Session, -AckDue
            session_ack_due/2           % +Session, -Count
          ]).

/** <module> The window: frames that wait or are not acknowledged

Frames are numbered by counting on both sides. The window of a session is

    window(Sent, Waiting, Received, AckSent, Acked, AckedBytes, Settled,
           Bundle)

Only this module accesses its arguments: two queues of frames, and the names of
six flags: how many frames of the peer were received; how many of them were
acknowledged; how many frames of this process the peer has received, and how
many bytes of its connection; the last count of settled frames that was written;
and the number of the last bundle.

A frame is frame(Bytes, Token, Settled). Frames that were written to some
connection and that the peer has not received are in Sent, those that were never
written in Waiting. Settled is the number of frames of the peer that were
settled when the frame was put: so a frame that has waited behind an objection
does not settle the frame of the objection. The number of frames that the peer
has received is a count of its own: it opens the window.

A Token is `none`, `loose`, or the compound term of a hand-over, which becomes
Number-Token, see settlement.pl.

*Threading*: the mutex of the session guards its window: a caller of unacked_*
holds it. session_count/2 and session_acked/4 are for the thread of the
connection, the other session_* are for any thread.
*/

:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/fifo', [fifo_empty/2, fifo_size/2]).
:- use_module(frame, [bundle_next/5, count_ahead/3, frame_overhead/1]).
:- use_module(session,
              [session_codec/2, session_held/2, session_window/2]).

:- dynamic
    free_flags/1.                       % Flags: no window has them

%!  unacked_open(-Window) is det.
%
%   A new window.  Flags are never freed, so those of windows that were closed
%   are used again.

unacked_open(Window) :-
    message_queue_create(Sent),
    message_queue_create(Waiting),
    (   retract(free_flags(Flags))
    ->  true
    ;   flag(typhon_session_flags, N, N+1),
        findall(Flag,
                ( member(Name, [received, told, acked, bytes, settled,
                                bundle]),
                  atomic_list_concat([typhon_session, Name, N], '_', Flag) ),
                Flags)
    ),
    forall(member(Flag, Flags), set_flag(Flag, 0)),
    Window =.. [window, Sent, Waiting|Flags].

		 /*******************************
		 *            FRAMES            *
		 *******************************/

%!  ack_frames(-Count) is det.
%
%   The reader acknowledges after so many frames.

ack_frames(32).

%!  unacked_sent(+Window, +Out, +Bytes, +Token, -Counts) is semidet.
%
%   The frame is about to be written to Out, with Counts in its head.  Fails if
%   other frames wait, or writing might block.

unacked_sent(Window, Out, Bytes, Token, counts(Count, Count)) :-
    Window = window(Sent, Waiting, Received, AckSent, _, _, Settled, _),
    message_queue_property(Waiting, size(0)),
    space(room, Window, Out, Space),
    string_length(Bytes, Length),
    Length < Space,
    get_flag(Received, Count),
    thread_send_message(Sent, frame(Bytes, Token, Count)),
    set_flag(AckSent, Count),
    set_flag(Settled, Count).

%   space(+Most, +Window, +Out, -Space): the bytes that can be written to Out if
%   Most is `room`, or `inf` if it is `all`.  As long as no more than 64 kB are
%   under way, writing does not block.

space(room, window(_, _, _, _, _, AckedBytes, _, _), Out, Space) :-
    byte_count(Out, Written),
    get_flag(AckedBytes, Acked),
    Space is 65536-(Written-Acked).
space(all, _, _, inf).

%!  unacked_waits(+Window, +Bytes, +Token) is det.
%
%   Let the frame wait.  If Token is `loose` it may later be bundled with
%   others.

unacked_waits(window(_, Waiting, Received, _, _, _, _, _), Bytes, Token) :-
    get_flag(Received, Count),
    thread_send_message(Waiting, frame(Bytes, Token, Count)).

%!  unacked_waiting(+Session) is semidet.
%
%   Some frame waits.

unacked_waiting(Session) :-
    session_window(Session, window(_, Waiting, _, _, _, _, _, _)),
    fifo_size(Waiting, Size),
    Size > 0.

%!  unacked_owed(+Session, -Waiting) is semidet.
%
%   So much was written that the peer is sure to acknowledge some of it: it
%   acknowledges each bundle, and other frames after ack_frames/1.  The number
%   of frames that wait is Waiting.

unacked_owed(Session, Size) :-
    session_window(Session,
                   window(Sent, Waiting, _, _, Acked, _, _, Bundle)),
    get_flag(Acked, Count),
    (   get_flag(Bundle, Last),
        Last > Count
    ->  true
    ;   message_queue_property(Sent, size(Written)),
        ack_frames(Frames),
        Written >= Frames
    ),
    message_queue_property(Waiting, size(Size)).

%!  unacked_next(+Session, +Out, +Most, -Counts, -Bytes) is semidet.
%
%   The frame that has waited longest is about to be written to Out.  Fails if
%   there is no room for it, unless Most is `all`.

unacked_next(Session, Out, Most, Counts, Bytes) :-
    session_codec(Session, Codec),
    session_window(Session, Window),
    Window = window(Sent, Waiting, _, _, _, _, _, Bundle),
    space(Most, Window, Out, Space),
    bundle_next(Waiting, Codec, Space, Frame, Many),
    !,
    thread_send_message(Sent, Frame),
    (   Many == true
    ->  session_sent(Session, Count),
        set_flag(Bundle, Count)
    ;   true
    ),
    unacked_counts(Session, Frame, Counts, Bytes).

%!  unacked_counts(+Session, +Frame, -Counts, -Bytes) is det.
%
%   Frame is about to be written, maybe once more.  It settles only frames that
%   were received when it was put, since an objection may wait behind it.

unacked_counts(Session, frame(Bytes, _, Settled), counts(Count, Settled),
               Bytes) :-
    session_window(Session,
                   window(_, _, Received, AckSent, _, _, SettledFlag, _)),
    get_flag(Received, Count),
    set_flag(AckSent, Count),
    set_flag(SettledFlag, Settled).

%!  unacked_control(+Window, +Out, +Most, +Bytes, -Counts) is semidet.
%
%   Bytes are about to be written outside the count, if there is room, or Most
%   is `all`.  The peer does not acknowledge them, so they are not under way.
%   They precede frames that wait: if these may include an objection, that is,
%   if Most is `all`, they settle no more than was written before.

unacked_control(Window, Out, Most, Bytes, counts(Count, Settled)) :-
    Window = window(_, _, Received, AckSent, _, AckedBytes, SettledFlag, _),
    space(Most, Window, Out, Space),
    string_length(Bytes, Length),
    Length < Space,
    get_flag(Received, Count),
    set_flag(AckSent, Count),
    (   Most == room
    ->  Settled = Count,
        set_flag(SettledFlag, Count)
    ;   get_flag(SettledFlag, Settled)
    ),
    frame_overhead(Head),
    get_flag(AckedBytes, Acked0),
    Acked is Acked0+Length+Head,
    set_flag(AckedBytes, Acked).

%!  unacked_settled(+Window) is semidet.
%
%   To be called if nothing waits. Fails if no frame has settled the last frames
%   received: one outside the count must settle them now.

unacked_settled(window(_, _, Received, _, _, _, Settled, _)) :-
    get_flag(Received, Count),
    (   get_flag(Settled, Count)
    ->  true
    ;   set_flag(Settled, Count),
        fail
    ).

%!  unacked_resumed(+Session, +Count, +Bytes, -Handed, -Frames) is det.
%
%   The session has a new connection, to which Bytes were written.  The peer has
%   received Count frames of this process, Handed among them; that settles none.
%   Frames have to be written once more.  The Count of a peer that has forgotten
%   the session, while this process has not, may exceed what was sent.

unacked_resumed(Session, Count, Bytes, Handed, Frames) :-
    session_window(Session, Window),
    Window = window(Sent, _, _, AckSent, Acked, AckedBytes, Settled, _),
    get_flag(Acked, Count0),
    message_queue_property(Sent, size(Size)),
    Gone is max(0, min(Count-Count0, Size)),
    take_received(Gone, Count0, Sent, Handed, 0, _),
    Count1 is max(Count0, Count),
    set_flag(Acked, Count1),
    set_flag(AckedBytes, Bytes),
    set_flag(AckSent, -1),              % the reader acknowledges at its start
    fifo_empty(Sent, Frames),
    forall(member(Frame, Frames), thread_send_message(Sent, Frame)),
    (   Frames = [frame(_, _, First)|_]
    ->  set_flag(Settled, First)
    ;   true
    ).

%!  unacked_close(+Session, -Waiting, -Sent, -Unsent) is det.
%
%   The session is over: the frames Waiting were never written.  Unsent are the
%   tokens of hand-overs among these, Sent the hand-overs that were written, and
%   that the peer may have received.

unacked_close(Session, Waiting, Sent, Unsent) :-
    session_window(Session, Window),
    Window =.. [window, SentQueue, WaitingQueue|Flags],
    arg(5, Window, Acked),
    get_flag(Acked, Count),
    message_queue_property(SentQueue, size(Size)),
    take_received(Size, Count, SentQueue, Sent, 0, _),
    fifo_empty(WaitingQueue, Waiting),
    findall(Token,
            ( member(frame(_, Token, _), Waiting), compound(Token) ),
            Unsent),
    message_queue_destroy(SentQueue),
    message_queue_destroy(WaitingQueue),
    assertz(free_flags(Flags)).

		 /*******************************
		 *       ACKNOWLEDGEMENTS       *
		 *******************************/

%!  session_acked(+Session, +Received, -Handed:list, -Waiting:integer)
%!      is semidet.
%
%   The peer has Received so many frames, as read in a head; fails if that was
%   known. Handed are the hand-overs among the frames that are acknowledged now.
%   Waiting frames were not written yet.
%
%   @error domain_error(acknowledged, Count) if that is more than was sent

session_acked(Session, Received, Handed, Waiting) :-
    session_window(Session, Window),
    arg(5, Window, Acked),
    get_flag(Acked, Count),
    count_ahead(Count, Received, Ahead),
    Ahead > 0,
    session_held(Session, acked(Ahead, Count, Window, Handed, Waiting)).

%   Only the thread of the connection changes Acked.

acked(Ahead, Count0, Window, Handed, Waiting) :-
    Window = window(Sent, Queue, _, _, Acked, AckedBytes, _, _),
    message_queue_property(Sent, size(Size)),
    (   Ahead =< Size
    ->  true
    ;   domain_error(acknowledged, Ahead)
    ),
    take_received(Ahead, Count0, Sent, Handed, 0, Bytes),
    Count is Count0+Ahead,
    set_flag(Acked, Count),
    get_flag(AckedBytes, Bytes0),
    Bytes1 is Bytes0+Bytes,
    set_flag(AckedBytes, Bytes1),
    message_queue_property(Queue, size(Waiting)).

%   take_received(+Ahead, +Count, +Sent, -Handed, +Bytes0, -Bytes): the peer has
%   received Ahead frames more than Count, of so many bytes; Handed are their
%   hand-overs.

take_received(0, _, _, [], Bytes, Bytes) :-
    !.
take_received(Ahead, N0, Sent, Handed, Bytes0, Bytes) :-
    thread_get_message(Sent, frame(Frame, Token, _)),
    string_length(Frame, Length),
    frame_overhead(Head),
    Bytes1 is Bytes0+Length+Head,
    N is N0+1,
    (   compound(Token)
    ->  Handed = [N-Token|Handed1]
    ;   Handed = Handed1
    ),
    Ahead1 is Ahead-1,
    take_received(Ahead1, N, Sent, Handed1, Bytes1, Bytes).

%!  session_under_way(+Session, +Number) is semidet.
%
%   The frame of that Number was written, and is not acknowledged.

session_under_way(Session, Number) :-
    session_window(Session, window(_, _, _, _, Acked, _, _, _)),
    get_flag(Acked, Count),
    Number > Count,
    session_sent(Session, Sent),
    Number =< Sent.

%   session_sent(+Session, -Count): Count frames have been written, or fewer if
%   another thread is about to write some.

session_sent(Session, Count) :-
    session_window(Session, window(Sent, _, _, _, Acked, _, _, _)),
    get_flag(Acked, Gone),
    fifo_size(Sent, Size),
    Count is Gone+Size.

%!  session_unacked(+Session, -Count) is det.
%
%   Count frames wait, or are not acknowledged.

session_unacked(Session, Count) :-
    session_window(Session, window(Sent, Waiting, _, _, _, _, _, _)),
    fifo_size(Sent, S),
    fifo_size(Waiting, W),
    Count is S+W.

%!  session_received(+Session, -Count) is det.
%
%   Count frames of the peer have been received.

session_received(Session, Count) :-
    session_window(Session, window(_, _, Received, _, _, _, _, _)),
    get_flag(Received, Count).

%!  session_ack_due(+Session, -Count) is det.
%
%   Count received frames are not acknowledged yet.

session_ack_due(Session, Count) :-
    session_window(Session, window(_, _, Received, AckSent, _, _, _, _)),
    get_flag(Received, All),
    get_flag(AckSent, Known),
    Count is All-Known.

%!  session_count(+Session, -AckDue) is det.
%
%   Count one more frame as received.  Then AckDue are not acknowledged yet.

session_count(Session, AckDue) :-
    session_window(Session, window(_, _, Received, AckSent, _, _, _, _)),
    get_flag(Received, Count0),
    Count is Count0+1,
    set_flag(Received, Count),
    get_flag(AckSent, Known),
    AckDue is Count-Known.
