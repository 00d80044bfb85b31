:- module(typhon_lending,
          [ endpoint_afterwards/1,      % :Goal
            lending_anew/0,
            lending_open/4,             % +Session, +In, +Out, -Queue
            lending_close/0,
            lend/3,                     % +Queue, :More, :Flush
            lent/0,
            lent_away/0
          ]).

/** <module> Lending the thread of a reader to the work of a frame

Waking another thread costs as much as the rest of a hop.  So the thread that
has read and counted a frame may run the agent that came in it, for an unknown
time: as a goal of endpoint_afterwards/1.

Meanwhile a token owns the connection, a message in a queue of the thread.  When
the goal ends the thread takes the token back, and reads on.  If the goal takes
long, the connection manager takes the token: then the session loses this
connection and gets another one, with a thread of its own, and the lent thread
no longer belongs to the wire.

A request to end a lent thread takes effect when the thread is back: its goal
must not be interrupted for the sake of a connection.

*Threading*: lending_open/4 to lent_away/0 are for the thread of a connection.
The token goes to the thread that takes it first.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(session, [session_adopting/2, session_lost/2]).
:- use_module(threads,
              [ in_background/2, manager_notify/1, wire_thread_leaves/1,
                wire_thread_obey/1 ]).
:- use_module(transport, [transport_forget/0]).

:- meta_predicate
    endpoint_afterwards(1),
    lend(+, 0, 0).

:- multifile
    typhon_endpoint:lent/1,             % Thread
    typhon_endpoint:returned/0,
    typhon_threads:overdue/1,
    typhon_threads:not_now/1.

:- dynamic
    lendable/3,                         % Thread, Queue, connection(...)
    seen/3.                             % Thread, Began, Processor time

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

%!  lending_open(+Session, +In, +Out, -Queue) is det.
%
%   Prepare this thread to read.  Its token goes to Queue.

lending_open(Session, In, Out, Queue) :-
    thread_self(Me),
    message_queue_create(Queue),
    assertz(lendable(Me, Queue, connection(Session, In, Out))),
    nb_setval(typhon_end, none),
    nb_setval(typhon_lending, idle).

%!  lending_close is det.
%
%   End the reading in this thread.

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

%!  lend(+Queue, :More, :Flush) is semidet.
%
%   Call the goal that a hook has left; fails if there is none.  More is true if
%   there is more to read first.  Flush sends the answers that this thread has
%   buffered.  It is called when the thread is back, and also before the work is
%   left to other threads: the peer must get the answers before it gets what
%   these threads send.
%
%   Throws wire_thread_end(Why) if the thread is to end, as when the connection
%   no longer belongs to it.

lend(Queue, More, Flush) :-
    nb_getval(typhon_lending, wants(Goal)),
    (   call(More)
    ->  nb_setval(typhon_lending, idle),
        leave(Goal, Flush)
    ;   give(Queue),
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

give(Queue) :-
    nb_linkval(typhon_lending, lent),
    monotonic_time(Began),
    thread_send_message(Queue, token(Began)),
    check_if_needed.

%   An overdue thread waits until its release is complete.

take_back(Queue) :-
    (   thread_get_message(Queue, token(_), [timeout(0)])
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

%!  lent is semidet.
%
%   This thread is lent.

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
    (   get_flag(typhon_lending, 1)
    ->  true
    ;   flag(typhon_lending, Looks, 1),
        (   Looks =:= 0
        ->  check_later
        ;   true
        )
    ).

check_later :-
    monotonic_time(Now),
    check_seconds(Seconds),
    Time is Now+Seconds,
    ignore(manager_notify(later(Time, typhon_lending:check_lent))).

:- public check_lent/0.

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
    lent_to(Thread, Began),
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

lent_to(Thread, Began) :-
    lendable(Thread, Queue, _),
    catch(thread_peek_message(Queue, token(Began)), error(_, _), fail).

                 /*******************************
                 *           RELEASE            *
                 *******************************/

%   release(+Thread, +Began) is semidet: Thread, lent since Began, no longer
%   belongs to the endpoint, and its session is without connection.  A caller
%   that waits for the end of Thread goes on.  If Thread comes back before its
%   connection is closed, it waits for the release.

typhon_threads:overdue(Thread) :-
    lent_to(Thread, Began),
    release(Thread, Began).

release(Thread, Began) :-
    sig_atomic(released(Thread, Began, Connection)),
    debug(typhon(session), '~w is overdue: its connection is closed',
          [Thread]),
    in_background(part(Thread, Connection), lender).

released(Thread, Began, Connection) :-
    lendable(Thread, Queue, Connection),
    catch(thread_get_message(Queue, token(Began), [timeout(0)]),
          error(_, _), fail),
    !,
    call_cleanup(                       % Thread waits for this in any case
        forall(typhon_endpoint:lent(Thread), true),
        ( wire_thread_leaves(Thread),
          thread_send_message(Queue, released) )).

%   Another thread may have given the session a new connection by now.

part(Thread, connection(Session, In, Out)) :-
    session_adopting(Session, session_lost(Session, Thread)),
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
