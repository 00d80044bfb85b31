:- module(typhon_pusher,
          [ pusher/2,                   % ?Key, ?Thread
            pusher_start/4,             % +Session, +Thread, +Out, +Again
            pusher_stop/1,              % +Key
            pusher_control/3,           % +Key, +Kind, +Bytes
            pusher_no_control/1         % +Key
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(frame, [frame_overhead/1, frame_write/3]).
:- use_module(session,
              [ session_key/2, session_locked/2, session_window/2,
                transport_broken/2 ]).
:- use_module(threads, [wire_thread_create/3, wire_thread_end/2]).
:- use_module(unacked, [unacked_next/3, unacked_waiting/1]).

/** <module> The pusher of a session: a thread that writes

A session of which more is sent than the buffers of the operating system hold
has a thread that writes, the pusher, until nothing waits. It writes first what
is outside the count, then what the peer lacks of an earlier connection, then
what waits.

*Threading*: a thread that starts a pusher or leaves it a control holds the
mutex of the session; one that calls pusher_stop/1, the thread of the
connection, does not.
*/

:- dynamic
    pusher/2,                           % Key, Thread
    control/3.                          % Key, Kind, Bytes: before what waits

%!  pusher(?Key, ?Thread) is nondet.
%
%   Thread alone may write what is sent in the session.

%!  pusher_start(+Session, +Thread, +Out, +Again) is det.
%
%   Write the frames Again, and what waits, to Out, of Thread.  Where no
%   thread can be made the connection is given up: what waits must not be
%   overtaken, and is sent over the next.

pusher_start(Session, Thread, Out, Again) :-
    session_key(Session, Key),
    catch(( wire_thread_create(push(Session, Thread, Out, Again),
                               pusher-Key, Pusher),
            assertz(pusher(Key, Pusher)),
            debug(typhon(session), '~w: ~w writes', [Key, Pusher])
          ),
          error(Formal, Context),
          ( print_error(error, error(Formal, Context)),
            transport_broken(Key, Thread) )).

push(Session, Thread, Out, Again) :-
    call_cleanup(
        catch(( forall(member(Frame, Again), write_again(Frame, Session, Out)),
                push_waiting(Session, Out) ),
              error(_, _),
              true),
        session_locked(Session, pushed(Session, Thread))).

write_again(Frame, Session, Out) :-
    session_locked(Session, frame_counts(Frame, Session, Counts, Bytes)),
    frame_write(Out, Counts, Bytes).

%   A pusher that has written all has ended already.

pushed(Session, Thread) :-
    session_key(Session, Key),
    thread_self(Me),
    (   retract(pusher(Key, Me))
    ->  transport_broken(Key, Thread)
    ;   true
    ).

push_waiting(Session, Out) :-
    repeat,
    write_waiting(Session, Out),
    session_locked(Session, nothing_waits(Session)),
    !.

%   Many small frames go in one write: the buffer is flushed when it is full
%   and when nothing waits, and that without the mutex.

write_waiting(Session, Out) :-
    repeat,
    (   session_locked(Session, next_frame(Session, Counts, Bytes))
    ->  frame_write(Out, Counts, Bytes),
        fail
    ;   !,
        flush_output(Out)
    ).

%   What is outside the count settles no more than what was written before it.

next_frame(Session, counts(Count, Settled), Bytes) :-
    session_key(Session, Key),
    retract(control(Key, _, Bytes)),
    !,
    session_window(Session,
                   window(_, _, Received, Told, _, AckedBytes, SettledFlag)),
    get_flag(Received, Count),
    set_flag(Told, Count),
    get_flag(SettledFlag, Settled),
    string_length(Bytes, Length),
    frame_overhead(Head),
    get_flag(AckedBytes, Acked0),
    Acked is Acked0+Length+Head,
    set_flag(AckedBytes, Acked).
next_frame(Session, Counts, Bytes) :-
    unacked_next(Session, inf, Frame),
    frame_counts(Frame, Session, Counts, Bytes).

frame_counts(frame(Bytes, _, Settled), Session, counts(Count, Settled),
             Bytes) :-
    session_window(Session, window(_, _, Received, Told, _, _, SettledFlag)),
    get_flag(Received, Count),
    set_flag(Told, Count),
    set_flag(SettledFlag, Settled).

%   The last frame settles all that was received meanwhile.

nothing_waits(Session) :-
    session_key(Session, Key),
    \+ control(Key, _, _),
    \+ unacked_waiting(Session),
    session_window(Session, window(_, _, Received, _, _, _, Settled)),
    get_flag(Received, Count),
    (   get_flag(Settled, Count)
    ->  retractall(pusher(Key, _))
    ;   set_flag(Settled, Count),
        pusher_control(Key, acknowledge, ""),
        fail
    ).

%!  pusher_stop(+Key) is det.
%
%   End the pusher of the session, if any, and wait for that.

pusher_stop(Key) :-
    (   retract(pusher(Key, Pusher))
    ->  wire_thread_end(Pusher, broken)
    ;   true
    ).

%!  pusher_control(+Key, +Kind, +Bytes) is det.
%!  pusher_no_control(+Key) is det.
%
%   Bytes goes before all that waits, in place of an older one of its Kind.
%   What is left was for another connection.

pusher_control(Key, Kind, Bytes) :-
    retractall(control(Key, Kind, _)),
    assertz(control(Key, Kind, Bytes)).

pusher_no_control(Key) :-
    retractall(control(Key, _, _)).
