:- module(typhon_reader,
          [ read_frames/2               % +Session, +In
          ]).

/** <module> Reading the frames of a session

The reader counts what it has handled, tells the peer now and then, and is
also the watchdog of the connection: a peer that owes us something and is
silent is asked for a sign of life, and given up when it gives none.

_Threading_: runs in the thread of the connection, see connection.pl. The
counts are that thread's own and are stored when it ends. Signals are held
back while a frame is being handled and counted.
*/

:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(crew, [crew_tell/1]).
:- use_module(frame, [bytes_term/3, frame_read/3]).
:- use_module(request, [dispatch/2, requests_open/1]).
:- use_module(outbox, [session_acked/3, session_control/2,
                       session_pending/2, session_push/1]).
:- use_module(session, [session_note_received/2, session_received/2]).

:- setting(silence, number, 5,
           "Seconds of silence before a peer is asked for a sign of life").

%   After so many frames or bytes the peer is told that they have come.

ack_frames(32).
ack_bytes(32768).

%!  read_frames(+Session, +In) is det.
%
%   Handle all frames until In ends.
%
%   @error timeout_error(read, In) the peer is silent for too long
%   @error resource_error(frame_bytes), syntax_error(truncated_frame)

read_frames(Session, In) :-
    Session = session(Key, _, _, _, _),
    setting(silence, Silence),
    setting(typhon_session:frame_bytes, Max),
    set_stream(In, timeout(Silence)),
    session_received(Key, Count),
    byte_count(In, Bytes),
    nb_setval(typhon_reader, true),
    nb_setval(typhon_later, 0),
    State = count(Count, Count, Bytes, 0),
    call_cleanup(
        call_cleanup(
            read_all(Session, In, Max, State),
            note_received(Key, State)),
        note_received(Key, State)).

%   Noted twice, as the one signal that ends this thread may come in the
%   middle of the first: with an old count everything would come again.

note_received(Key, State) :-
    arg(1, State, Count),
    session_note_received(Key, Count).

read_all(Session, In, Max, State) :-
    Session = session(_, Codec, _, _, _),
    repeat,
    push_late(Session, In),
    (   next(In, Max, Bytes)
    ->  (   Bytes == end_of_file
        ->  !
        ;   frame_term(Codec, Bytes, Term),
            sig_atomic(handle(Term, Session, In, State)),
            fail
        )
    ;   silent(Session, In, State),
        fail
    ).

%   Answers that were left in the buffer go with the next frame that
%   somebody sends, or now: when there are many, or nothing comes in for a
%   moment in which the agent that was answered for may well move on. On
%   9.2 an exception in the middle of wait_for_input/3 ruins the stacks: the
%   signal that brings it is held back.

late_answers(16).
late_seconds(0.001).

push_late(Session, In) :-
    nb_getval(typhon_later, Count),
    (   Count =:= 0
    ->  true
    ;   late_answers(Max),
        Count < Max,
        late_seconds(Seconds),
        sig_atomic(wait_for_input([In], [_], Seconds))
    ->  true
    ;   session_push(Session),
        nb_setval(typhon_later, 0)
    ).

%   A frame that cannot be read has come all the same: asking for it again
%   would not help.

frame_term(Codec, Bytes, Term) :-
    catch(bytes_term(Codec, Bytes, Term),
          error(Formal, _),
          Term = unreadable(Formal)).

%   Fails when nothing begins to come. The time out of a peek loses nothing.

next(In, Max, Bytes) :-
    catch(peek_byte(In, _), error(timeout_error(_, _), _), fail),
    frame_read(In, Max, Bytes).

%   Three silences in a row while we wait for something is one too many.

silent(Session, In, State) :-
    State = count(Count, Told, _, Silent),
    (   Count > Told                    % it need not keep them any longer
    ->  acknowledge(Session, In, State)
    ;   true
    ),
    (   \+ owes(Session)
    ->  nb_setarg(4, State, 0)
    ;   Silent < 2
    ->  Silent1 is Silent+1,
        nb_setarg(4, State, Silent1),
        session_control(Session, ping)
    ;   throw(error(timeout_error(read, In), _))
    ).

owes(Session) :-
    session_pending(Session, Pending),
    Pending > 0,
    !.
owes(Session) :-
    requests_open(Session).

handle(ack(Count, Bytes), Session, In, State) :-
    !,
    nb_setarg(4, State, 0),
    session_acked(Session, Count, Bytes),
    acknowledge_now_and_then(Session, In, State).
handle(ping, Session, In, State) :-
    !,
    acknowledge(Session, In, State).
handle(bye, session(Key, _, _, _, _), _, _) :-
    !,
    ignore(crew_tell(gone(Key))).
handle(Frame, Session, In, State) :-
    dispatch(Session, Frame),
    arg(1, State, Count0),
    Count is Count0+1,
    nb_setarg(1, State, Count),
    nb_setarg(4, State, 0),
    acknowledge_now_and_then(Session, In, State).

%   Acks are under way, too: their bytes are told as well.

acknowledge_now_and_then(Session, In, State) :-
    State = count(Count, Told, ToldBytes, _),
    byte_count(In, Bytes),
    ack_frames(MaxFrames),
    ack_bytes(MaxBytes),
    (   Count-Told < MaxFrames,
        Bytes-ToldBytes < MaxBytes
    ->  true
    ;   acknowledge(Session, In, State)
    ).

acknowledge(Session, In, State) :-
    arg(1, State, Count),
    byte_count(In, Bytes),
    nb_setarg(2, State, Count),
    nb_setarg(3, State, Bytes),
    session_control(Session, ack(Count, Bytes)).
