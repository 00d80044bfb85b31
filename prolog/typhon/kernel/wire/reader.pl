:- module(typhon_reader,
          [ read_frames/3,              % +Session, +In, +Out
            in_reader/0,
            endpoint_afterwards/1,      % :Goal
            lending_anew/0,
            lent_away/0
          ]).

/** <module> Reading the frames of a session, and lending the thread

The reader counts the frames that it has handled, acknowledges them at
intervals, and is also the watchdog of the connection: it pings a silent peer
from which an answer or acknowledgement is due, and closes the connection if the
peer does not respond.

A frame that was damaged in transit ends the connection: it is sent again over
the next one. A frame that arrives damaged in the same way three times was sent
damaged, and is skipped. A frame that cannot be decoded counts as received:
requesting it again would not help.

Waking another thread costs as much as the rest of a hop.  So the thread that
has read and counted a frame may run the agent that came in it, for an unknown
time: as a goal of endpoint_afterwards/1.

Meanwhile a token owns the connection, a fact.  When the goal ends the thread
takes the token back, and reads on.  If the goal takes long, the connection
manager takes the token: then the session loses this connection and gets another
one, with a thread of its own, and the lent thread no longer belongs to the
wire.

A request to end a lent thread takes effect when the thread is back: its goal
must not be interrupted for the sake of a connection.

*Threading*: read_frames/3 runs in the thread of the connection, see
connection.pl. Signals are deferred while a frame is being handled and counted.
lending_open/4 to lent_away/0 are for that thread, too. The token goes to the
thread that takes it first.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../base/reports', [report/4]).
:- use_module(frame,
              [bundle_parts/2, bytes_mark/2, bytes_term/3, frame_read/5]).
:- use_module(request,
              [ dispatch/2, dispatch_all/2, handed_over/2,
                session_unfinished/1 ]).
:- use_module(session,
              [ debug_frame/4, session_acknowledge/1, session_adopting/2,
                session_codec/2, session_control/2, session_key/2,
                session_later/1, session_later_begin/1, session_lost/2,
                session_object/2, session_peer/3, session_push/1,
                session_release/1, session_settled/4, session_window/2 ]).
:- use_module(threads,
              [ in_background/2, manager_notify/1, wire_thread_leaves/1,
                wire_thread_obey/1 ]).
:- use_module(transport, [transport_forget/0, transport_input/2]).
:- use_module(window,
              [ ack_frames/1, window_ack_due/2, window_count/2,
                window_received/2 ]).

:- setting(silence, number, 5,
           "Seconds of silence before a peer is pinged").

:- meta_predicate
    next(+, +, 0, -, -),
    endpoint_afterwards(1),
    lend(+, 0, 0).

:- dynamic
    damaged/4,                          % Key, Count, Which, Times: the last
                                        % damaged frame of a session
    lendable/3,                         % Thread, Queue, connection(...)
    token/2,                            % Thread, Began: it is lent
    seen/3.                             % Thread, Began, Processor time

:- multifile
    prolog:message//1,
    typhon_endpoint:lent/1,             % Thread
    typhon_endpoint:returned/0,
    typhon_threads:overdue/1,
    typhon_threads:not_now/1.

:- public check_lent/0.

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
    (   next(In, Max, session_acknowledge(Session), Counts, Bytes)
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
    session_window(Session, Window),
    window_received(Window, Count),
    times_damaged(Key, Count, Which, Times),
    (   Times < 3
    ->  throw(error(syntax_error(damaged_frame), Which))
    ;   sig_atomic(( session_object(Session, spoilt),
                     window_count(Window, _) )),
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
%   loses no byte.  A long frame may arrive for longer than the peer waits for a
%   sign of life: it gets one after each part.

next(In, Max, Meanwhile, Counts, Bytes) :-
    catch(peek_code(In, _), error(timeout_error(_, _), _), fail),
    frame_read(In, Max, Meanwhile, Counts, Bytes).

%   Three silences in a row are too many while an answer is due.

silent(Session, In, State) :-
    session_window(Session, Window),
    (   window_ack_due(Window, 0)
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
    session_window(Session, Window),
    window_count(Window, _),
    acknowledge(Session, In, State).
handle(Frame, Session, In, State) :-
    dispatch(Session, Frame),
    session_window(Session, Window),
    window_count(Window, AckDue),
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

prolog:message(typhon(endpoint, skipped(Address))) -->
    [ 'Endpoint: skipped a frame that ~w has sent damaged'
      -[Address] ].

                /*******************************
                *           LENDING            *
                *******************************/

%   While threads are lent the manager checks at this interval.  A lent thread
%   is overdue after so much processor time in one turn, or so much time
%   altogether: it may wait for something, or for a processor.

check_seconds(0.02).
most_work(0.01).
most_time(0.2).

%!  endpoint_afterwards(:Goal) is det.
%
%   In a hook: call(Goal, here) in this thread when the hook has ended and its
%   frame is counted.  If that fails, or more must be read first, or this is no
%   reader, call(Goal, later) leaves the work to other threads; it does not
%   fail.  Goal does not raise.  If Goal takes long, the hook lent(Thread)
%   reports that Thread has left the endpoint, and the hook returned, in Thread,
%   that Thread is about to end.

endpoint_afterwards(Goal) :-
    (   nb_current(typhon_lending, idle)
    ->  nb_setval(typhon_lending, wants(Goal))
    ;   call(Goal, later)
    ).

%!  lending_anew is det.
%
%   Reset: no thread is lent.

lending_anew :-
    flag(typhon_lending, _, 0),
    retractall(seen(_, _, _)).

%   lending_open(+Session, +In, +Out, -Queue): prepare this thread to read. Its
%   release is reported to Queue.

lending_open(Session, In, Out, Queue) :-
    thread_self(Me),
    message_queue_create(Queue),
    assertz(lendable(Me, Queue, connection(Session, In, Out))),
    nb_setval(typhon_end, none),
    nb_setval(typhon_lending, idle).

%   lending_close: end the reading in this thread.

lending_close :-
    nb_getval(typhon_lending, State),
    finish_left(State),
    thread_self(Me),
    (   retract(lendable(Me, Queue, _))
    ->  message_queue_destroy(Queue)
    ;   true
    ).

%   finish_left(+State): finish the work that a thread has left when it stops
%   reading in this State.

finish_left(idle).
finish_left(away).
finish_left(wants(Goal)) :-
    nb_setval(typhon_lending, closed),
    call(Goal, later).
finish_left(lent) :-                    % it was aborted
    thread_self(Me),
    lendable(Me, Queue, _),
    take_back(Queue).

%   lend(+Queue, :More, :Flush): call the goal that a hook has left; fails if
%   there is none. More is true if there is more to read first. Flush sends the
%   answers that this thread has buffered. It is called when the thread is
%   back, and also before the work is left to other threads: the peer must get
%   the answers before it gets what these threads send. Throws
%   wire_thread_end(Why) if the thread is to end, as when the connection no
%   longer belongs to it.

lend(Queue, More, Flush) :-
    nb_getval(typhon_lending, wants(Goal)),
    (   call(More)
    ->  nb_setval(typhon_lending, idle),
        leave(Goal, Flush)
    ;   give,
        (   call(Goal, here)
        ->  take_back(Queue),
            call(Flush)
        ;   take_back(Queue),
            leave(Goal, Flush)
        ),
        end_if_asked
    ).

leave(Goal, Flush) :-
    sig_atomic(( call(Flush), call(Goal, later) )).

%   From the first step on a request to end this thread is deferred.

give :-
    nb_linkval(typhon_lending, lent),
    monotonic_time(Began),
    thread_self(Me),
    assertz(token(Me, Began)),
    check_if_needed.

%   An overdue thread waits until its release is complete.  The token is no
%   message: to look for one that is gone is a wait that expires, see
%   typhon_own_thread, and this runs in a cleanup handler, too.

take_back(Queue) :-
    thread_self(Me),
    (   retract(token(Me, _))
    ->  nb_linkval(typhon_lending, idle)
    ;   sig_atomic(away(Queue))
    ).

away(Queue) :-
    thread_get_message(Queue, released),
    nb_setval(typhon_lending, away),
    transport_forget,
    forall(typhon_endpoint:returned, true),
    nb_setval(typhon_end, lent).

end_if_asked :-
    nb_getval(typhon_end, Why),
    (   Why == none
    ->  true
    ;   nb_setval(typhon_end, none),
        wire_thread_obey(Why)
    ).

%   lent: this thread is lent.

lent :-
    nb_current(typhon_lending, lent).

%!  lent_away is semidet.
%
%   This thread was lent for so long that it has lost its connection.

lent_away :-
    nb_current(typhon_lending, away).

%   A request to end this thread is kept until the thread is back.

typhon_threads:not_now(Why) :-
    lent,
    nb_setval(typhon_end, Why).

                 /*******************************
                 *            LOOKING           *
                 *******************************/

%   While threads are lent the manager looks for those that are overdue.

check_if_needed :-
    get_flag(typhon_lending, 1),
    !.
check_if_needed :-
    flag(typhon_lending, Looks, 1),
    ( Looks =:= 0 -> check_later ; true ).

check_later :-
    check_seconds(Seconds),
    deadline(Seconds, Time),
    ignore(manager_notify(later(Time, typhon_reader:check_lent))).

check_lent :-
    flag(typhon_lending, _, 0),
    monotonic_time(Now),
    findall(Seen, lent_now(Seen), All),
    forall(( member(Seen, All), is_overdue(Now, Seen, Thread, Began) ),
           ignore(release(Thread, Began))),
    retractall(seen(_, _, _)),
    forall(member(Seen, All), assertz(Seen)),
    (   All == []
    ->  true
    ;   check_if_needed
    ).

lent_now(seen(Thread, Began, Work)) :-
    token(Thread, Began),
    (   seen(Thread, Began, Work0)
    ->  Work = Work0
    ;   worked(Thread, Work)
    ).

is_overdue(Now, seen(Thread, Began, Work0), Thread, Began) :-
    (   most_time(Time),
        Now-Began > Time
    ->  true
    ;   most_work(Most),
        worked(Thread, Work),
        Work-Work0 > Most
    ).

worked(Thread, Seconds) :-
    catch(thread_statistics(Thread, cputime, Seconds), error(_, _), fail).

                 /*******************************
                 *           RELEASE            *
                 *******************************/

%   release(+Thread, +Began) is semidet: Thread, lent since Began, no longer
%   belongs to the endpoint, and its session is without connection.  A caller
%   that waits for the end of Thread goes on.  If Thread comes back before its
%   connection is closed, it waits for the release.

typhon_threads:overdue(Thread) :-
    token(Thread, Began),
    release(Thread, Began).

release(Thread, Began) :-
    sig_atomic(released(Thread, Began, Connection)),
    debug(typhon(session), '~w is overdue: its connection is closed',
          [Thread]),
    in_background(part(Thread, Connection), lender).

released(Thread, Began, Connection) :-
    retract(token(Thread, Began)),
    !,
    lendable(Thread, Queue, Connection),
    call_cleanup(                       % Thread waits for this in any case
        forall(typhon_endpoint:lent(Thread), true),
        ( wire_thread_leaves(Thread),
          thread_send_message(Queue, released) )).

%   Another thread may have given the session a new connection by now.

part(Thread, connection(Session, In, Out)) :-
    session_adopting(Session, session_lost(Session, Thread)),
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
