:- module(typhon_waiting,
          [ manager_connect/1,          % +Address
            manager_connect/2,          % +Address, +Deadline
            waiting_first/2,            % ?Address, -Number
            waiting_number/1,           % -Number
            waiting_met/2,              % +Address, +Session
            waiting_missed/2,           % ?Address, +Number
            unsent/1,                   % ?Address
            unsent_request/4,           % +Address, +Kind, +Term, :OnAnswer
            unsent_closed/4,            % +Address, +Kind, +Term, :OnAnswer
            unsent_again/2,             % +Session, +Unsent
            unsent_forget/1,            % :OnAnswer
            endpoint_flush/1,           % +Seconds
            endpoint_flush/2,           % +Seconds, +Peers
            peers_flush/1               % +Seconds
          ]).

/** <module> Waiting for a connection, and for the arrival of frames

Threads and requests that wait for a connection to an address wait in order. A
thread waits at a queue of its own, and receives `met` or `missed`. A request
holds no thread: it is sent, or answered. All are numbered: the result of an
attempt to connect does not concern those that came after it began.

*Threading*: any thread adds to the table. The connection manager, which
receives wanted_at(Address), sends a request first and removes it then: as long
as a request waits for an address, no later message of the same thread may
overtake it. The thread that removes a request answers it. manager_connect/1,2
and the flushes are for any thread that may wait.
*/

:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../base/durable_changes', [commit_changes/0]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(session,
              [ route/2, session/2, session_key/2, session_mark/2,
                session_peer/3, session_pending/2, session_up/1 ]).
:- use_module(peer_cache, [peer_expected/1]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_send/4,
                request_take/3 ]).
:- use_module(threads, [in_manager/0, manager_notify/1]).

:- meta_predicate
    unsent_request(+, +, +, 1),
    unsent_closed(+, +, +, 1),
    unsent_forget(1).

:- multifile typhon_endpoint:handed_over/2.

:- dynamic
    waiting/3.                          % Address, Number, What: thread(Queue),
                                        % request(Kind, Term, OnAnswer)

%!  waiting_first(?Address, -Number) is semidet.
%
%   A thread or request waits for Address; the first has this Number.

waiting_first(Address, Number) :-
    waiting(Address, Number, _),
    !.

%!  waiting_number(-Number) is det.
%
%   All that wait have lower numbers; those that come later will not.

waiting_number(Number) :-
    flag(typhon_waiting, Number, Number).

%!  unsent(?Address) is semidet.
%
%   A request waits for Address.

unsent(Address) :-
    waiting(Address, _, request(_, _, _)),
    !.

%   What, thread(Queue) or a request, waits for Address.

waiting_add(Address, What) :-
    flag(typhon_waiting, Number, Number+1),
    assertz(waiting(Address, Number, What)),
    (   manager_notify(wanted_at(Address))
    ->  true
    ;   missed(Address, Number)
    ).

%!  waiting_met(+Address, +Session) is det.
%
%   Session leads to Address: send all requests and wake all threads that wait
%   for Address.  For the connection manager only.

waiting_met(Address, Session) :-
    waiting(Address, Number, What),
    !,
    (   met(What, Address, Session)
    ->  sent(Address, Number, What),
        waiting_met(Address, Session)
    ;   ignore(manager_notify(wanted_at(Address)))
    ).
waiting_met(_, _).

met(thread(Queue), _, _) :-
    notify(Queue, met).
met(request(Kind, Term, OnAnswer), Address, Session) :-
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(Formal, Context),
          not_sent(Formal, Context, Address, OnAnswer)).

%   The waiting thread may have been interrupted, and its queue destroyed.

notify(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

%   The caller may have given up the request meanwhile.

sent(Address, Number, What) :-
    (   retract(waiting(Address, Number, _))
    ->  true
    ;   What = request(_, _, OnAnswer)
    ->  request_forget(OnAnswer)
    ;   true
    ).

%   not_sent(+Formal, +Context, +Address, +OnAnswer): fails if the request is to
%   go to the next process at Address.

not_sent(session_closed, _, Address, OnAnswer) :-
    !,
    \+ peer_expected(Address),
    request_answer(unreachable, OnAnswer).
not_sent(Formal, Context, _, OnAnswer) :-
    print_error(error, error(Formal, Context)),
    request_answer(unreachable, OnAnswer).

%!  waiting_missed(?Address, +Number) is det.
%
%   Address cannot be reached: report that to all that have a number below
%   Number, or to all if that is `inf`.

waiting_missed(Address, Number) :-
    forall(( waiting(Address, N, _), N < Number ), missed(Address, N)).

missed(Address, Number) :-
    (   retract(waiting(Address, Number, What))
    ->  missed(What)
    ;   true
    ).

missed(thread(Queue)) :-
    notify(Queue, missed).
missed(request(_, _, OnAnswer)) :-
    request_answer(unreachable, OnAnswer).

                /*******************************
                *           THREADS            *
                *******************************/

%!  manager_connect(+Address) is semidet.
%!  manager_connect(+Address, +Deadline) is semidet.
%
%   Ensure a connection to Address; fails if there can be none, or not before
%   Deadline. The manager always answers, so the first has no deadline: a wait
%   with a deadline may never end in a clean-up handler or a hook, where
%   signals are held back (SWI-Prolog 9.0.4). In the thread of the manager,
%   which cannot wait for itself, both fail.

manager_connect(Address) :-
    connected(Address, inf).

manager_connect(Address, Deadline) :-
    connected(Address, Deadline).

connected(Address, Deadline) :-
    \+ in_manager,
    setup_call_cleanup(
        message_queue_create(Queue),
        ( waiting_add(Address, thread(Queue)),
          wait_before(Deadline, thread_get_message(Queue, Result)),
          Result == met ),
        ( retractall(waiting(_, _, thread(Queue))),
          message_queue_destroy(Queue) )).

                /*******************************
                *           REQUESTS           *
                *******************************/

%!  unsent_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   As endpoint_request/4, when there is a connection with Address.

unsent_request(Address, Kind, Term, OnAnswer) :-
    waiting_add(Address, request(Kind, Term, OnAnswer)).

%!  unsent_forget(:OnAnswer) is det.
%
%   Forget the requests with this OnAnswer: their callers no longer wait.

unsent_forget(OnAnswer) :-
    retractall(waiting(_, _, request(_, _, OnAnswer))).

%!  unsent_closed(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   The peer is gone permanently, and did not get this request.  If a process is
%   expected at Address soon, the request waits for it.

unsent_closed(Address, Kind, Term, OnAnswer) :-
    (   peer_expected(Address)
    ->  unsent_request(Address, Kind, Term, OnAnswer)
    ;   request_answer(unreachable, OnAnswer)
    ).

%!  unsent_again(+Session, +Unsent) is det.
%
%   As unsent_closed/4, for the requests among the frames Unsent of Session.

unsent_again(Session, Unsent) :-
    session_peer(Session, _, Address),
    peer_expected(Address),
    !,
    forall(( member(request(Id, Kind, Term), Unsent),
             request_take(Session, Id, OnAnswer) ),
           unsent_request(Address, Kind, Term, OnAnswer)).
unsent_again(_, _).

                /*******************************
                *           ARRIVAL            *
                *******************************/

%!  endpoint_flush(+Seconds) is semidet.
%
%   Wait until all frames sent so far have arrived; fails after Seconds.

endpoint_flush(Seconds) :-
    must_be(number, Seconds),
    monotonic_time(Now),
    Deadline is Now+Seconds,
    forall(session(_, Session), session_flush(Session, Deadline)).

%!  endpoint_flush(+Seconds, +Peers:list) is semidet.
%
%   As endpoint_flush/1, for frames to the addresses Peers.

endpoint_flush(Seconds, Peers) :-
    monotonic_time(Now),
    Deadline is Now+Seconds,
    forall(( member(Peer, Peers),
             route(Peer, Session) ),
           session_flush(Session, Deadline)).

%!  peers_flush(+Seconds) is semidet.
%
%   As endpoint_flush/1, for a process that is about to end.  Does not wait for
%   frames to a peer at whose address no process listens now.  Not for hooks and
%   clean-up handlers, see manager_connect/2.

peers_flush(Seconds) :-
    monotonic_time(Now),
    Deadline is Now+Seconds,
    forall(( session(_, Session),
             reachable(Session, Deadline) ),
           session_flush(Session, Deadline)).

%   A session without connection may just be changing from one to another.

reachable(Session, _) :-
    session_key(Session, Key),
    session_up(Key),
    !.
reachable(Session, Deadline) :-
    session_pending(Session, Count),
    Count > 0,
    route(Address, Session),
    manager_connect(Address, Deadline),
    !.

%   session_flush(+Session, +Deadline) is semidet.
%
%   Wait until all frames sent before have arrived, or the session is closed, as
%   when its peer has died; fails at Deadline, a time stamp.  Sends a frame
%   without content, which hands over Queue: it arrives after all others, and
%   the peer settles it at once.

session_flush(Session, Deadline) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        flush(Session, Queue, Deadline),
        message_queue_destroy(Queue)).

flush(Session, Queue, Deadline) :-
    catch(commit_changes, error(_, _), true), % the committer has reported it
    (   session_pending(Session, 0)
    ->  true
    ;   catch(session_mark(Session, flushed(Queue)),
              error(session_closed, _),
              thread_send_message(Queue, flushed)),
        wait_before(Deadline, thread_get_message(Queue, flushed))
    ).

%   The waiting thread may have given up.

typhon_endpoint:handed_over(flushed(Queue), _) :-
    catch(thread_send_message(Queue, flushed),
          error(existence_error(_, _), _),
          true).
