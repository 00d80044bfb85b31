:- module(typhon_lending,
          [ endpoint_afterwards/1,      % :Goal
            lending_anew/0,
            lending_open/4,             % +Session, +In, +Out, -Queue
            lending_close/0,
            lend/3,                     % +Queue, :More, :Tell
            lent/0,
            lent_away/0
          ]).

/** <module> The reader's thread is lent to work that a frame has brought

To wake another thread costs as much as the rest of a hop.  So the thread that
has read and counted a frame may run the agent that it brought, for an unknown
time: a goal of endpoint_afterwards/1.

Meanwhile the connection belongs to a token, a message in a queue of the thread.
When the goal ends the thread takes it back, and reads on.  A goal that lasts is
found by the connection manager, which takes the token instead: then the session
loses this connection and gets another one, with a thread of its own, and the
one that was lent is no longer of the wire.

A request to end a thread that is lent takes effect when it is back: what it
runs must not be interrupted for the sake of a connection.

*Threading*: lending_open/4 to lent_away/0 are for the thread of a connection.
The token goes to the thread that takes it first.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(session, [session_adopting/2]).
:- use_module(threads,
              [ in_background/2, manager_notify/1, wire_thread_leaves/1,
                wire_thread_obey/1 ]).
:- use_module(resumption, [session_lost/2]).
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
    seen/4.                             % Thread, Turn, Since, Processor time

%   While threads are lent the manager checks so often.  One is missed that has
%   worked for so long in one turn, or has been away for so long: it may wait
%   for something, or for a processor.

look_seconds(0.02).
most_work(0.01).
most_time(0.2).

%!  endpoint_afterwards(:Goal) is det.
%
%   In a hook: call(Goal, here) in this thread when the hook has ended and its
%   frame is counted.  If that fails, or more is to be read first, or this is no
%   reader, call(Goal, later) leaves the work to others; that does not fail.
%   Goal does not raise. Where it lasts, the hook lent(Thread) says that Thread
%   is not of the endpoint any more, and returned, there, that Thread is about
%   to end.

endpoint_afterwards(Goal) :-
    (   nb_current(typhon_lending, idle)
    ->  nb_setval(typhon_lending, wants(Goal))
    ;   call(Goal, later)
    ).

%!  lending_anew is det.
%
%   No thread is lent as yet.

lending_anew :-
    flag(typhon_lending, _, 0),
    retractall(seen(_, _, _, _)).

%!  lending_open(+Session, +In, +Out, -Queue) is det.
%!  lending_close is det.
%
%   This thread begins to read, and has done so.  Its token is in Queue.

lending_open(Session, In, Out, Queue) :-
    thread_self(Me),
    message_queue_create(Queue),
    assertz(lendable(Me, Queue, connection(Session, In, Out))),
    nb_setval(typhon_turns_lent, 0),
    nb_setval(typhon_end, none),
    nb_setval(typhon_lending, idle).

lending_close :-
    nb_getval(typhon_lending, State),
    left(State),
    thread_self(Me),
    (   retract(lendable(Me, Queue, _))
    ->  message_queue_destroy(Queue)
    ;   true
    ).

%   left(+State): what is left to do for a thread that stops reading in this
%   State.

left(idle).
left(away).
left(wants(Goal)) :-
    nb_setval(typhon_lending, closed),
    call(Goal, later).
left(lent) :-                           % it was aborted
    thread_self(Me),
    lendable(Me, Queue, _),
    take_back(Queue).

%!  lend(+Queue, :More, :Tell) is semidet.
%
%   Call what a hook has left; fails if there is nothing. More says whether
%   there is more to read first. Tell is called when the thread is back, and
%   before the work is left to others: the peer learns what was accepted before
%   they act.
%
%   Throws wire_thread_end(Why) if it is to end, as when the connection is no
%   longer ours.

lend(Queue, More, Tell) :-
    nb_getval(typhon_lending, wants(Goal)),
    (   call(More)
    ->  nb_setval(typhon_lending, idle),
        leave(Goal, Tell)
    ;   give(Queue),
        (   call(Goal, here)
        ->  take_back(Queue),
            call(Tell)
        ;   take_back(Queue),
            leave(Goal, Tell)
        ),
        end_if_asked
    ).

leave(Goal, Tell) :-
    sig_atomic(( call(Tell), call(Goal, later) )).

%   From the first step on a request to end this thread has to wait.

give(Queue) :-
    nb_linkval(typhon_lending, lent),
    nb_getval(typhon_turns_lent, Turn0),
    Turn is Turn0+1,
    nb_linkval(typhon_turns_lent, Turn), % a number: nothing to copy
    thread_send_message(Queue, token(Turn)),
    look_in_time.

%   A thread that was missed waits until all is done that is done in its stead.

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
%!  lent_away is semidet.
%
%   This thread is lent, or was for so long that it has no connection.

lent :-
    nb_current(typhon_lending, lent).

lent_away :-
    nb_current(typhon_lending, away).

%   That it is to end is kept until it is back.

typhon_threads:not_now(Why) :-
    lent,
    nb_setval(typhon_end, Why).

                 /*******************************
                 *            LOOKING           *
                 *******************************/

%   While threads are lent the manager checks which do not come back.

look_in_time :-
    (   get_flag(typhon_lending, 1)
    ->  true
    ;   flag(typhon_lending, Looks, 1),
        (   Looks =:= 0
        ->  look_later
        ;   true
        )
    ).

look_later :-
    get_time(Now),
    look_seconds(Seconds),
    Time is Now+Seconds,
    ignore(manager_notify(later(Time, typhon_lending:look))).

:- public look/0.

look :-
    flag(typhon_lending, _, 0),
    get_time(Now),
    findall(Seen, lent_now(Now, Seen), All),
    forall(( member(Seen, All), missed(Now, Seen, Thread, Turn) ),
           ignore(release(Thread, Turn))),
    retractall(seen(_, _, _, _)),
    forall(member(Seen, All), assertz(Seen)),
    (   All == []
    ->  true
    ;   look_in_time
    ).

lent_now(Now, seen(Thread, Turn, Since, Work)) :-
    lent_to(Thread, Turn),
    (   seen(Thread, Turn, Since0, Work0)
    ->  Since = Since0,
        Work = Work0
    ;   Since = Now,
        worked(Thread, Work)
    ).

missed(Now, seen(Thread, Turn, Since, Work0), Thread, Turn) :-
    (   most_time(Time),
        Now-Since > Time
    ->  true
    ;   most_work(Most),
        worked(Thread, Work),
        Work-Work0 > Most
    ).

worked(Thread, Seconds) :-
    catch(thread_statistics(Thread, cputime, Seconds), error(_, _), fail).

lent_to(Thread, Turn) :-
    lendable(Thread, Queue, _),
    catch(thread_peek_message(Queue, token(Turn)), error(_, _), fail).

                 /*******************************
                 *           RELEASE            *
                 *******************************/

%   release(+Thread, +Turn) is semidet: it is on its own, and the session
%   without connection.  A thread that waits for the end of Thread goes on.
%   Should Thread come back before the connection is gone, it sees to that
%   itself.

typhon_threads:overdue(Thread) :-
    lent_to(Thread, Turn),
    release(Thread, Turn).

release(Thread, Turn) :-
    sig_atomic(released(Thread, Turn, Connection)),
    debug(typhon(session), '~w does not come back: the connection goes',
          [Thread]),
    in_background(part(Thread, Connection), lender).

released(Thread, Turn, Connection) :-
    lendable(Thread, Queue, Connection),
    catch(thread_get_message(Queue, token(Turn), [timeout(0)]),
          error(_, _), fail),
    !,
    call_cleanup(                       % it waits for this, whatever a hook does
        forall(typhon_endpoint:lent(Thread), true),
        ( wire_thread_leaves(Thread),
          thread_send_message(Queue, released) )).

%   Another thread may have given the session another connection by now.

part(Thread, connection(Session, In, Out)) :-
    session_adopting(Session, session_lost(Session, Thread)),
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
