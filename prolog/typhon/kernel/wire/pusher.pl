:- module(typhon_pusher,
          [ pusher/2,                   % ?Key, ?Thread
            pusher_start/4,             % +Session, +Thread, +Out, +Again
            pusher_stop/1,              % +Key
            pusher_control/3,           % +Key, +Kind, +Bytes
            pusher_no_control/1         % +Key
          ]).

/** <module> The pusher: writes what waits

A session of which more is sent than the buffers of the kernel hold has a
thread that writes, the pusher, until nothing waits. It writes first what is
outside the count, then what the peer lacks of an earlier connection, then
what waits.

*Threading*: who starts a pusher, or leaves it a control, holds the mutex of
the session; pusher_stop/1 is for the thread of the connection, without it.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(frame, [frame_write/2]).
:- use_module(session, [session_key/2, session_locked/2, transport_broken/2]).
:- use_module(threads, [wire_thread_create/3, wire_thread_end/2]).
:- use_module(unacked, [unacked_next/3, unacked_waiting/1]).

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
        catch(( forall(member(Bytes, Again), frame_write(Out, Bytes)),
                push_waiting(Session, Out) ),
              error(_, _),
              true),
        session_locked(Session, pushed(Session, Thread))).

%   Who has written all is not pushing any more.

pushed(Session, Thread) :-
    session_key(Session, Key),
    thread_self(Me),
    (   retract(pusher(Key, Me))
    ->  transport_broken(Key, Thread)
    ;   true
    ).

push_waiting(Session, Out) :-
    session_key(Session, Key),
    repeat,
    write_waiting(Session, Key, Out),
    session_locked(Session, nothing_waits(Key)),
    !.

%   Many small frames go in one write: the buffer is flushed when it is full
%   and when nothing waits, and that without the mutex.

write_waiting(Session, Key, Out) :-
    repeat,
    (   session_locked(Session, next_frame(Session, Key, Bytes))
    ->  frame_write(Out, Bytes),
        fail
    ;   !,
        flush_output(Out)
    ).

next_frame(_, Key, Bytes) :-
    retract(control(Key, _, Bytes)),
    !.
next_frame(Session, _, Bytes) :-
    unacked_next(Session, inf, Bytes).

nothing_waits(Key) :-
    \+ control(Key, _, _),
    \+ unacked_waiting(Key),
    retractall(pusher(Key, _)).

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
