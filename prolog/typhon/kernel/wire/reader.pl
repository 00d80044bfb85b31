:- module(typhon_reader,
          [ read_frames/3,              % +Session, +In, +Out
            in_reader/0
          ]).

/** <module> Reading the frames of a session

The reader counts the frames that it has handled, acknowledges them at
intervals, and is also the watchdog of the connection: it pings a silent peer
from which an answer or acknowledgement is due, and closes the connection if the
peer does not respond.

A frame that was damaged in transit ends the connection: it is sent again over
the next one. A frame that arrives damaged in the same way three times was sent
damaged, and is skipped. A frame that cannot be decoded counts as received:
requesting it again would not help.

*Threading*: runs in the thread of the connection, see connection.pl. Signals
are deferred while a frame is being handled and counted.
*/

:- use_module('../base/reports', [report/4]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(frame,
              [bundle_parts/2, bytes_mark/2, bytes_term/3, frame_read/4]).
:- use_module(lending,
              [lend/3, lending_close/0, lending_open/4, lent/0]).
:- use_module(session,
              [ debug_frame/4, session_ack_due/2, session_acknowledge/1,
                session_codec/2, session_control/2, session_count/2,
                session_key/2, session_later/1, session_later_begin/1,
                session_object/2, session_peer/3, session_push/1,
                session_received/2, session_release/1, session_settled/4 ]).
:- use_module(request,
              [ dispatch/2, dispatch_all/2, handed_over/2,
                session_unfinished/1 ]).
:- use_module(threads, [manager_notify/1]).
:- use_module(transport, [transport_input/2]).
:- use_module(window, [ack_frames/1]).

:- setting(silence, number, 5,
           "Seconds of silence before a peer is pinged").

:- dynamic
    damaged/4.                          % Key, Count, Which, Times: the last
                                        % damaged frame of a session

%!  read_frames(+Session, +In, +Out) is det.
%
%   Handle all frames until In ends.
%
%   @error timeout_error(read, In) if the peer is silent for too long
%   @error resource_error(frame_bytes), syntax_error(truncated_frame),
%   syntax_error(damaged_frame)
%   @error domain_error(acknowledged, Count) if that is more than was sent

read_frames(Session, In, Out) :-
    setting(silence, Silence),
    setting(typhon_session:frame_bytes, Max),
    set_stream(In, timeout(Silence)),
    byte_count(In, Bytes),
    nb_setval(typhon_reader, true),
    session_later_begin(Session),
    setup_call_cleanup(
        lending_open(Session, In, Out, Queue),
        read_or_skip(Session, In, Max, state(Bytes, silent(0, 0), Queue)),
        lending_close).

%!  in_reader is semidet.
%
%   This thread reads the frames of a session: it must not wait, unless it is
%   lent.

in_reader :-
    nb_current(typhon_reader, true),
    \+ lent.

read_or_skip(Session, In, Max, State) :-
    catch(read_all(Session, In, Max, State),
          error(syntax_error(damaged_frame), Which),
          true),
    (   var(Which)
    ->  true
    ;   skip(Session, Which),
        read_or_skip(Session, In, Max, State)
    ).

read_all(Session, In, Max, State) :-
    session_codec(Session, Codec),
    arg(3, State, Queue),
    more_first(In, More),
    repeat,
    (   lend(Queue, More, flush_answers(Session))
    ->  true                            % and flush_answers/1 was called
    ;   push_late(Session, In)
    ),
    (   next(In, Max, Counts, Bytes)
    ->  (   Bytes == end_of_file
        ->  !
        ;   frame_term(Codec, Bytes, Term),
            debug_frame(from, Session, Term, Bytes),
            sig_atomic(handle(Term, Counts, Session, In, State)),
            fail
        )
    ;   silent(Session, In, State),
        fail
    ).

%   Called after the goal that a hook has left.  The frames that the goal sent
%   to the peer have taken the buffered answers along; else send these now.

flush_answers(Session) :-
    session_later(Late),
    (   Late > 0
    ->  session_push(Session)
    ;   true
    ).

%   more_first(+In, -More): More is true if there is more to read first.  It
%   always fails if there are no processors for worker threads.

more_first(In, More) :-
    (   current_prolog_flag(cpu_count, Processors),
        Processors > 2
    ->  More = sig_atomic(transport_input(In, 0))
    ;   More = fail
    ).

%   Answers that were left in the buffer are sent with the next frame, or
%   now: when there are many, or nothing comes in for a moment in which the
%   agent of an answer may well move on. On 9.2 an exception in the middle of
%   wait_for_input/3 corrupts the stacks: the signal that raises it is deferred.

late_answers(16).
late_seconds(0.001).

push_late(Session, In) :-
    session_later(Count),
    (   Count =:= 0
    ->  true
    ;   late_answers(Max),
        Count < Max,
        late_seconds(Seconds),
        sig_atomic(transport_input(In, Seconds))
    ->  true
    ;   session_push(Session)
    ).

%   skip(+Session, +Which): throws as long as the damage may be an accident.

skip(Session, Which) :-
    session_key(Session, Key),
    session_received(Session, Count),
    times_damaged(Key, Count, Which, Times),
    (   Times < 3
    ->  throw(error(syntax_error(damaged_frame), Which))
    ;   sig_atomic(( session_object(Session, spoilt),
                     session_count(Session, _) )),
        session_peer(Session, _, Address),
        report(error, skipped_frames, Address,
               typhon(endpoint, skipped(Address)))
    ).

times_damaged(Key, Count, Which, Times) :-
    (   damaged(Key, Count, Which, Times0)
    ->  true
    ;   Times0 = 0
    ),
    Times is Times0+1,
    retractall(damaged(Key, _, _, _)),
    assertz(damaged(Key, Count, Which, Times)),
    predicate_property(damaged(_, _, _, _), number_of_clauses(All)),
    (   All > 64                        % of sessions that are over
    ->  once(retract(damaged(_, _, _, _)))
    ;   true
    ).

%   Fails if no frame begins within the time-out.  A time-out of peek_code/2
%   loses no byte.

next(In, Max, Counts, Bytes) :-
    catch(peek_code(In, _), error(timeout_error(_, _), _), fail),
    frame_read(In, Max, Counts, Bytes).

%   Three silences in a row are too many while an answer is due.

silent(Session, In, State) :-
    (   session_ack_due(Session, 0)
    ->  true
    ;   acknowledge(Session, In, State) % the peer need not keep the frames
    ),
    (   session_unfinished(Session)
    ->  silences(In, State, Count),
        (   Count < 3
        ->  session_control(Session, ping)
        ;   throw(error(timeout_error(read, In), _))
        )
    ;   nb_setarg(2, State, silent(0, 0))
    ).

%   silences(+In, +State, -Count): Count time-outs have passed since a byte was
%   read.

silences(In, State, Count) :-
    arg(2, State, silent(Count0, Bytes0)),
    byte_count(In, Bytes),
    (   Bytes =:= Bytes0
    ->  Count is Count0+1
    ;   Count = 1
    ),
    nb_setarg(2, State, silent(Count, Bytes)).

%   The counts of a frame are handled before its body: the body may bring back
%   an agent whose departure the counts settle.

handle(Frame, Counts, Session, In, State) :-
    session_settled(Session, Counts, Settled, Waiting),
    settled(Settled, Session),
    ( Waiting > 0 -> session_release(Session) ; true ),
    handle(Frame, Session, In, State).

settled([], _).
settled([One|Settled], Session) :-
    handed_over(One, Session),
    settled(Settled, Session).

handle(none, _, _, _) :-
    !.
handle(ping, Session, In, State) :-
    !,
    acknowledge(Session, In, State).
handle(bye, Session, _, _) :-
    !,
    session_key(Session, Key),
    ignore(manager_notify(gone(Key))).
handle(Bundle, Session, In, State) :-
    Bundle = bundle(_),
    take_bundle(Bundle, Session),
    !,
    session_count(Session, _),
    acknowledge(Session, In, State).
handle(Frame, Session, In, State) :-
    dispatch(Session, Frame),
    session_count(Session, AckDue),
    acknowledge_now_and_then(AckDue, Session, In, State).

%   The reader acknowledges after ack_frames/1 frames, or after half of the bytes
%   that may be under way.  A bundle is acknowledged at once: its sender holds
%   others until then.

acknowledge_now_and_then(AckDue, Session, In, State) :-
    (   AckDue =:= 0
    ->  true
    ;   ack_frames(MaxFrames),
        AckDue < MaxFrames,
        arg(1, State, AckedBytes),
        byte_count(In, Bytes),
        Bytes-AckedBytes < 32768
    ->  true
    ;   acknowledge(Session, In, State)
    ).

acknowledge(Session, In, State) :-
    byte_count(In, Bytes),
    nb_setarg(1, State, Bytes),
    session_acknowledge(Session).

		 /*******************************
		 *         FRAME INTAKE         *
		 *******************************/

%   frame_term(+Codec, +Bytes, -Frame): Frame is the term of Bytes, `none` if
%   Bytes are empty, or unreadable(Formal, Mark), see request.pl.

frame_term(_, "", none) :-
    !.
frame_term(Codec, Bytes, Term) :-
    catch(bytes_term(Codec, Bytes, Term),
          error(Formal, _),
          unreadable(Formal, Bytes, Term)).

unreadable(Formal, Bytes, unreadable(Formal, Mark)) :-
    (   bytes_mark(Bytes, Mark0)
    ->  Mark = Mark0
    ;   Mark = none
    ).

%   take_bundle(+Frame, +Session): dispatch the frames in Frame; fails if it is
%   not a bundle.

take_bundle(Frame, Session) :-
    bundle_parts(Frame, Parts),
    session_codec(Session, Codec),
    maplist(frame_term(Codec), Parts, Frames),
    dispatch_all(Session, Frames).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, skipped(Address))) -->
    [ 'Endpoint: skipped a frame that ~w has sent damaged'
      -[Address] ].
