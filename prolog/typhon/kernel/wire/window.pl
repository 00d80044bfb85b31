:- module(typhon_window,
          [ window_open/1,              % -Window
            window_sent/5,              % +Window, +Out, +Bytes, +Token, -Counts
            window_wait/3,              % +Window, +Bytes, +Token
            window_waiting/1,           % +Window
            window_owed/2,              % +Window, -Waiting
            window_next/6,              % +Window, +Codec, +Out, +Most, -Counts,
                                        % -Bytes
            window_control/5,           % +Window, +Out, +Most, +Bytes, -Counts
            window_settled/1,           % +Window
            window_counts/4,            % +Window, +Frame, -Counts, -Bytes
            window_resumed/5,           % +Window, +Count, +Bytes, -Handed,
                                        % -Frames
            window_close/4,             % +Window, -Waiting, -Sent, -Unsent
            window_ahead/3,             % +Window, +Received, -Ahead
            window_acked/4,             % +Window, +Ahead, -Handed, -Waiting
            window_under_way/2,         % +Window, +Number
            window_unacked/2,           % +Window, -Count
            window_received/2,          % +Window, -Count
            window_count/2,             % +Window, -AckDue
            window_ack_due/2,           % +Window, -Count
            ack_frames/1                % -Count
          ]).

/** <module> The window: frames that wait or are not acknowledged

Frames are numbered by counting on both sides. The window of a session, see
session.pl, is

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
Number-Token.

*Threading*: the mutex of the session guards its window: a caller holds it,
except to read: window_ahead/3, window_under_way/2, window_unacked/2,
window_received/2 and window_ack_due/2.  Of the others, window_count/2 is for
the thread of the connection, without the mutex.
*/

:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/fifo', [fifo_empty/2, fifo_size/2]).
:- use_module(frame, [bundle_next/5, count_ahead/3, frame_overhead/1]).

:- dynamic
    free_flags/1.                       % Flags: no window has them

%!  window_open(-Window) is det.
%
%   A new window.  Flags are never freed, so those of windows that were closed
%   are used again.

window_open(Window) :-
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

%!  window_sent(+Window, +Out, +Bytes, +Token, -Counts) is semidet.
%
%   The frame is about to be written to Out, with Counts in its head.  Fails if
%   other frames wait, or writing might block.

window_sent(Window, Out, Bytes, Token, counts(Count, Count)) :-
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
%   Most is `room`, more than any frame has if it is `all`.  As long as no more
%   than 64 kB are under way, writing does not block.

space(room, window(_, _, _, _, _, AckedBytes, _, _), Out, Space) :-
    byte_count(Out, Written),
    get_flag(AckedBytes, Acked),
    Space is 65536-(Written-Acked).
space(all, _, _, 0x100000000).

%!  window_wait(+Window, +Bytes, +Token) is det.
%
%   Let the frame wait.  If Token is `loose` it may later be bundled with
%   others.

window_wait(window(_, Waiting, Received, _, _, _, _, _), Bytes, Token) :-
    get_flag(Received, Count),
    thread_send_message(Waiting, frame(Bytes, Token, Count)).

%!  window_waiting(+Window) is semidet.
%
%   Some frame waits.

window_waiting(window(_, Waiting, _, _, _, _, _, _)) :-
    fifo_size(Waiting, Size),
    Size > 0.

%!  window_owed(+Window, -Waiting) is semidet.
%
%   So much was written that the peer is sure to acknowledge some of it: it
%   acknowledges each bundle, and other frames after ack_frames/1.  The number
%   of frames that wait is Waiting.

window_owed(window(Sent, Waiting, _, _, Acked, _, _, Bundle), Size) :-
    get_flag(Acked, Count),
    (   get_flag(Bundle, Last),
        Last > Count
    ->  true
    ;   message_queue_property(Sent, size(Written)),
        ack_frames(Frames),
        Written >= Frames
    ),
    message_queue_property(Waiting, size(Size)).

%!  window_next(+Window, +Codec, +Out, +Most, -Counts, -Bytes) is semidet.
%
%   The frame that has waited longest is about to be written to Out.  Fails if
%   there is no room for it, unless Most is `all`.

window_next(Window, Codec, Out, Most, Counts, Bytes) :-
    Window = window(Sent, Waiting, _, _, _, _, _, Bundle),
    space(Most, Window, Out, Space),
    bundle_next(Waiting, Codec, Space, Frame, Many),
    !,
    thread_send_message(Sent, Frame),
    (   Many == true
    ->  written(Window, Count),
        set_flag(Bundle, Count)
    ;   true
    ),
    window_counts(Window, Frame, Counts, Bytes).

%!  window_counts(+Window, +Frame, -Counts, -Bytes) is det.
%
%   Frame is about to be written, maybe once more.  It settles only frames that
%   were received when it was put, since an objection may wait behind it.

window_counts(window(_, _, Received, AckSent, _, _, SettledFlag, _),
              frame(Bytes, _, Settled), counts(Count, Settled), Bytes) :-
    get_flag(Received, Count),
    set_flag(AckSent, Count),
    set_flag(SettledFlag, Settled).

%!  window_control(+Window, +Out, +Most, +Bytes, -Counts) is semidet.
%
%   Bytes are about to be written outside the count, if there is room, or Most
%   is `all`.  The peer does not acknowledge them, so they are not under way.
%   They precede frames that wait: if these may include an objection, that is,
%   if Most is `all`, they settle no more than was written before.

window_control(Window, Out, Most, Bytes, counts(Count, Settled)) :-
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

%!  window_settled(+Window) is semidet.
%
%   To be called if nothing waits. Fails if no frame has settled the last frames
%   received: one outside the count must settle them now.

window_settled(window(_, _, Received, _, _, _, Settled, _)) :-
    get_flag(Received, Count),
    (   get_flag(Settled, Count)
    ->  true
    ;   set_flag(Settled, Count),
        fail
    ).

%!  window_resumed(+Window, +Count, +Bytes, -Handed, -Frames) is det.
%
%   The session has a new connection, to which Bytes were written.  The peer has
%   received Count frames of this process, Handed among them; that settles none.
%   Frames have to be written once more.  The Count of a peer that has forgotten
%   the session, while this process has not, may exceed what was sent.

window_resumed(Window, Count, Bytes, Handed, Frames) :-
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

%!  window_close(+Window, -Waiting, -Sent, -Unsent) is det.
%
%   The session is over: the frames Waiting were never written.  Unsent are the
%   tokens of hand-overs among these, Sent the hand-overs that were written, and
%   that the peer may have received.

window_close(Window, Waiting, Sent, Unsent) :-
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

%!  window_ahead(+Window, +Received, -Ahead) is semidet.
%
%   The peer has Received so many frames, as read in a head: Ahead more than it
%   was known to have.  Fails if it has no more.

window_ahead(window(_, _, _, _, Acked, _, _, _), Received, Ahead) :-
    get_flag(Acked, Count),
    count_ahead(Count, Received, Ahead),
    Ahead > 0.

%!  window_acked(+Window, +Ahead, -Handed:list, -Waiting:integer) is det.
%
%   Ahead is that of window_ahead/3. Handed are the hand-overs among the frames
%   that are acknowledged now. Waiting frames were not written yet.
%
%   @error domain_error(acknowledged, Count) if that is more than was sent

window_acked(Window, Ahead, Handed, Waiting) :-
    Window = window(Sent, Queue, _, _, Acked, AckedBytes, _, _),
    message_queue_property(Sent, size(Size)),
    (   Ahead =< Size
    ->  true
    ;   domain_error(acknowledged, Ahead)
    ),
    get_flag(Acked, Count0),
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

%!  window_under_way(+Window, +Number) is semidet.
%
%   The frame of that Number was written, and is not acknowledged.

window_under_way(Window, Number) :-
    Window = window(_, _, _, _, Acked, _, _, _),
    get_flag(Acked, Count),
    Number > Count,
    written(Window, Sent),
    Number =< Sent.

%   written(+Window, -Count): Count frames have been written, or fewer if
%   another thread is about to write some.

written(window(Sent, _, _, _, Acked, _, _, _), Count) :-
    get_flag(Acked, Gone),
    fifo_size(Sent, Size),
    Count is Gone+Size.

%!  window_unacked(+Window, -Count) is det.
%
%   Count frames wait, or are not acknowledged.

window_unacked(window(Sent, Waiting, _, _, _, _, _, _), Count) :-
    fifo_size(Sent, S),
    fifo_size(Waiting, W),
    Count is S+W.

%!  window_received(+Window, -Count) is det.
%
%   Count frames of the peer have been received.

window_received(window(_, _, Received, _, _, _, _, _), Count) :-
    get_flag(Received, Count).

%!  window_ack_due(+Window, -Count) is det.
%
%   Count received frames are not acknowledged yet.

window_ack_due(window(_, _, Received, AckSent, _, _, _, _), Count) :-
    get_flag(Received, All),
    get_flag(AckSent, Known),
    Count is All-Known.

%!  window_count(+Window, -AckDue) is det.
%
%   Count one more frame as received.  Then AckDue are not acknowledged yet.

window_count(window(_, _, Received, AckSent, _, _, _, _), AckDue) :-
    get_flag(Received, Count0),
    Count is Count0+1,
    set_flag(Received, Count),
    get_flag(AckSent, Known),
    AckDue is Count-Known.
