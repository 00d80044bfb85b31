:- module(typhon_lending,
          [ endpoint_afterwards/1,      % :Goal
            lending_anew/0,
            lending_open/3,             % +Session, +In, +Out
            lending_close/0,
            lend/2,                     % :More, :Tell
            lent/0,
            lent_away/0
          ]).

/** <module> The reader's thread is lent to work that a frame has brought

To wake another thread costs as much as the rest of a hop.  So the thread that
has read and counted a frame may run the agent that it brought, for an unknown
time: a goal of endpoint_afterwards/1.

Meanwhile the connection belongs to a token, a message in a queue.  When the
goal ends the thread takes it back, and reads on.  A goal that lasts is found
by the connection manager, which takes the token instead: then the session loses this
connection and gets another one, with a thread of its own, and the one that
was lent is no longer of the wire.

A request to end a thread that is lent takes effect when it is back: what it
runs must not be interrupted for the sake of a connection.

*Threading*: lending_open/3 to lent_away/0 are for the thread of a connection.
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
    lend(0, 0).

:- multifile
    typhon_endpoint:lent/2,             % Goal, Thread
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
%   In a hook: call(Goal, here) in this thread when the hook has ended and
%   its frame is counted.  If that fails, or more is to be read first, or this is
%   no reader, call(Goal, later) leaves the work to others; that does not fail.
%   Goal does not raise. Where it lasts, the hook lent(Goal, Thread) tells
%   that Thread is not of the endpoint any more, and returned, there, that
%   Thread is about to end.

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

%!  lending_open(+Session, +In, +Out) is det.
%!  lending_close is det.
%
%   This thread begins to read, and has done so.

lending_open(Session, In, Out) :-
    thread_self(Me),
    message_queue_create(Queue),
    assertz(lendable(Me, Queue, connection(Session, In, Out))),
    nb_setval(typhon_token, token(Queue, 0)),
    nb_setval(typhon_lending, idle).

lending_close :-
    nb_getval(typhon_lending, State),
    left(State),
    thread_self(Me),
    (   retract(lendable(Me, Queue, _))
    ->  message_queue_destroy(Queue)
    ;   true
    ).

%   left(+State): what is left to do for a thread that stops reading in this State.

left(idle).
left(away).
left(wants(Goal)) :-
    nb_setval(typhon_lending, closed),
    call(Goal, later).
left(lent) :-                           % it was aborted
    come_back.
left(told(_)) :-
    come_back.

come_back :-
    nb_getval(typhon_token, token(Queue, _)),
    sig_atomic(take_back(Queue, _)).

%!  lend(:More, :Tell) is semidet.
%
%   Call what a hook has left; fails if there is nothing. More says whether there
%   is more to read first. Tell is called when the thread is back, and before the
%   work is left to others: the peer learns what was accepted before they act.
%
%   Throws wire_thread_end(Why) if it is to end, as when the connection is no
%   longer ours.

lend(More, Tell) :-
    nb_getval(typhon_lending, wants(Goal)),
    (   call(More)
    ->  nb_setval(typhon_lending, idle),
        leave(Goal, Tell)
    ;   sig_atomic(give(Goal, Queue)),
        (   call(Goal, here)
        ->  sig_atomic(take_back(Queue, Told)),
            call(Tell)
        ;   sig_atomic(take_back(Queue, Told)),
            leave(Goal, Tell)
        ),
        heard(Told)
    ).

leave(Goal, Tell) :-
    sig_atomic(( call(Tell), call(Goal, later) )).

give(Goal, Queue) :-
    nb_getval(typhon_token, token(Queue, Turn0)),
    Turn is Turn0+1,
    nb_linkval(typhon_token, token(Queue, Turn)),
    nb_linkval(typhon_lending, lent),
    thread_send_message(Queue, token(Turn, Goal)),
    look_in_time.

take_back(Queue, Told) :-
    (   token_taken(Queue, _)
    ->  nb_getval(typhon_lending, State),
        nb_linkval(typhon_lending, idle),
        told(State, Told)
    ;   thread_get_message(Queue, released),
        nb_setval(typhon_lending, away),
        transport_forget,
        forall(typhon_endpoint:returned, true),
        Told = lent
    ).

%   token_taken(+Queue, -Goal) is semidet: it goes to one. Nothing is
%   waited for: a wait with a deadline has no place where signals are held.

token_taken(Queue, Goal) :-
    with_mutex(typhon_lending,
               ( thread_peek_message(Queue, Message),
                 Message = token(_, Goal),
                 thread_get_message(Queue, _) )).

told(lent, none).
told(told(Why), Why).

heard(none) :-
    !.
heard(Why) :-
    wire_thread_obey(Why).

%!  lent is semidet.
%!  lent_away is semidet.
%
%   This thread is lent, or was for so long that it has no connection.

lent :-
    nb_current(typhon_lending, State),
    memberchk(State, [lent, told(_)]).

lent_away :-
    nb_current(typhon_lending, away).

%   That it is to end is kept until it is back.

typhon_threads:not_now(Why) :-
    lent,
    nb_setval(typhon_lending, told(Why)).

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
    forall(( member(Seen, All), missed(Now, Seen, Thread) ),
           ignore(release(Thread))),
    retractall(seen(_, _, _, _)),
    forall(member(Seen, All), assertz(Seen)),
    (   All == []
    ->  true
    ;   look_in_time
    ).

lent_now(Now, seen(Thread, Turn, Since, Work)) :-
    away(Thread, Turn),
    (   seen(Thread, Turn, Since0, Work0)
    ->  Since = Since0,
        Work = Work0
    ;   Since = Now,
        worked(Thread, Work)
    ).

missed(Now, seen(Thread, _, Since, Work0), Thread) :-
    (   most_time(Time),
        Now-Since > Time
    ->  true
    ;   most_work(Most),
        worked(Thread, Work),
        Work-Work0 > Most
    ).

worked(Thread, Seconds) :-
    catch(thread_statistics(Thread, cputime, Seconds), error(_, _), fail).

away(Thread, Turn) :-
    lendable(Thread, Queue, _),
    catch(thread_peek_message(Queue, Message), error(_, _), fail),
    Message = token(Turn, _).

                 /*******************************
                 *           RELEASE            *
                 *******************************/

%   release(+Thread) is semidet: it is on its own, and the session without
%   connection.  A thread that waits for the end of Thread goes on.  Should Thread come back before the connection
%   is gone, it sees to that itself.

typhon_threads:overdue(Thread) :-
    release(Thread).

release(Thread) :-
    sig_atomic(released(Thread, Connection)),
    debug(typhon(session), '~w does not come back: the connection goes',
          [Thread]),
    in_background(part(Thread, Connection), lender).

released(Thread, Connection) :-
    lendable(Thread, Queue, Connection),
    catch(token_taken(Queue, Goal), error(_, _), fail),
    !,
    call_cleanup(                       % it waits for this, whatever a hook does
        forall(typhon_endpoint:lent(Goal, Thread), true),
        ( wire_thread_leaves(Thread),
          thread_send_message(Queue, released) )).

%   Another thread may have given the session another connection by now.

part(Thread, connection(Session, In, Out)) :-
    session_adopting(Session, session_lost(Session, Thread)),
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
