:- module(typhon_connection_manager,
          [ manager_begin/1,            % +Me
            manager_end/0,
            manager_connect/1,          % +Address
            manager_connect/2,          % +Address, +Deadline
            unsent/1,                   % ?Address
            unsent_request/4,           % +Address, +Kind, +Term, :OnAnswer
            unsent_closed/4,            % +Address, +Kind, +Term, :OnAnswer
            unsent_forget/1,            % :OnAnswer
            endpoint_flush/1,           % +Seconds
            endpoint_flush/2,           % +Seconds, +Peers
            peers_flush/1               % +Seconds
          ]).

/** <module> The connection manager: connects and reconnects

One server of the endpoint keeps its sessions alive. It connects to the
addresses that are wanted, reconnects sessions with frames to send or to
receive, and closes others.

Each address that is wanted has an attempt, which ends when a session is up,
whichever side made its connection. Its state is

    queued                  it begins when few others are young
    trying(Thread, Start, Until)
                            Thread has tried since Start, and is late at Until
    pausing(Until)          the next try begins at Until
    idle(Until)             the same, when a session needs it, but no caller

A failed try concerns the callers that came before it began. Failures that may
pass, as when a peer breaks off during the handshake, are retried while these
have time. All others are reported at once, a refused connection above all,
unless a process is expected there soon.

Threads and requests that wait for a connection to an address wait in order. A
thread waits at a queue of its own, and receives `met` or `missed`. A request
holds no thread: it is sent, or answered. The result of a try does not concern
those that came after its start.

*Threading*: manage/3 runs in the thread of the server, which owns the tables
but waiting/3, and makes the attempts. Other threads send it messages by
manager_notify/1. It never waits: work that may take long is done by a
background thread.  Any thread adds to waiting/3. The manager, which receives
wanted_at(Address), sends a request first and removes it then: as long as a
request waits for an address, no later message of the same thread may overtake
it. The thread that removes a request answers it. manager_connect/1,2 and the
flushes are for any thread that may wait.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2, min_list/2, min_member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/fifo', [fifo_send/2]).
:- use_module('../base/durable', [commit_changes/0]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/monotonic',
              [deadline/2, monotonic_time/1, wait_before/2]).
:- use_module(connection, [outgoing/2]).
:- use_module(peer_cache, [peer_expected/1, peer_gone/1, peer_missed/2]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_send/4,
                request_take/3, requests_lost/2, session_unfinished/1 ]).
:- use_module(session,
              [ route/2, route_up/2, session/2, session_adopting/2,
                session_close/2, session_key/2, session_mark/2, session_peer/3,
                session_pending/2, session_retire/1, session_up/1 ]).
:- use_module(threads,
              [ in_background/2, in_manager/0, manager_notify/1,
                manager_start/2, manager_stop/0, wire_thread_create/3,
                wire_thread_end/2, wire_thread_join/1 ]).

:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").
:- setting(connect_time, number, 5,
           "Seconds until a peer is reported as unreachable").
:- setting(return_time, number, 30,
           "Seconds until a restarting peer is reported as unreachable").

:- meta_predicate
    unsent_request(+, +, +, 1),
    unsent_closed(+, +, +, 1),
    unsent_forget(1).

:- dynamic
    resting/1,                          % Key
    errand/2,                           % Time, Goal
    attempt/4,                          % Address, State, Pause: the next one,
                                        % First: time of the first try
    waiting/3.                          % Address, Since, What: thread(Queue),
                                        % request(Kind, Term, OnAnswer)

:- multifile
    prolog:message//1,
    typhon_endpoint:handed_over/2.

:- public manage/3.

%!  manager_begin(+Me) is det.
%
%   Start the manager. Me is the hello of this process.

manager_begin(Me) :-
    manager_start(typhon_connection_manager:manage, Me).

%!  manager_end is det.
%
%   Stop the manager: no address can be reached any more.

manager_end :-
    manager_stop,
    waiting_missed(_, inf).             % their messages may have been dropped

%   manage(+Message, +Me, -Next): handle a message of the server.

manage(stop, _, _) :-
    !,
    waiting_missed(_, inf),
    retractall(attempt(_, _, _, _)),
    retractall(resting(_)),
    run_errands(inf).
manage(Message, Me, until(Time, Me)) :-
    handle(Message, Me),
    attempts_begin(Me),
    next_time(Time).

next_time(Time) :-
    findall(Due, ( attempt_time(Due) ; errand(Due, _) ), Times),
    min_list([inf|Times], Time).

handle(begin, _).
handle(wanted_at(Address), _) :-
    address_wanted(Address).
handle(greeted(Thread), _) :-
    attempt_greeted(Thread).
handle(missed(Thread, Formal), _) :-
    attempt_ended(Thread, Formal).
handle(ended(Thread), _) :-
    wire_thread_join(Thread),
    attempt_ended(Thread, ended).
handle(up(Key), _) :-
    retractall(resting(Key)),
    findall(Address, leads_to(Address, Key), Addresses),
    forall(member(Address, Addresses), address_met(Address)).
handle(wanted(Key), _) :-
    (   session(Key, Session),
        \+ session_up(Key)
    ->  down(Session)
    ;   true
    ).
handle(displaced(Key), Me) :-           % another process has an address of Key
    (   leads_to(_, Key)                % Key may have other addresses
    ->  handle(wanted(Key), Me)
    ;   gone(Key)
    ).
handle(gone(Key), _) :-                 % the peer has sent `bye`
    forall(leads_to(Address, Key), peer_gone(Address)),
    gone(Key).
handle(later(Time, Goal), _) :-         % Goal is quick
    assertz(errand(Time, Goal)).
handle(timeout, Me) :-
    monotonic_time(Now),
    run_errands(Now),
    attempts_due(Me).

leads_to(Address, Key) :-
    session(Key, Session),
    route(Address, Session).

%   Run the goals of later/2 messages that are due.

run_errands(Now) :-
    findall(Time-Goal, ( errand(Time, Goal), Time =< Now ), Due),
    forall(member(Time-Goal, Due),
           ( retractall(errand(Time, Goal)),
             ignore(Goal) )).

		 /*******************************
		 *           SESSIONS           *
		 *******************************/

%   A session with nothing pending is kept for its counts: the peer may be cut
%   off only, and return with frames that have arrived before.

down(Session) :-
    session_unfinished(Session),
    !,
    session_reconnect(Session).
down(Session) :-
    session_key(Session, Key),
    retractall(resting(Key)),
    assertz(resting(Key)),
    predicate_property(resting(_), number_of_clauses(Count)),
    setting(resting, Max),
    (   Count > Max,
        retract(resting(Oldest)),
        session(Oldest, OldSession)
    ->  in_background(forget(OldSession), forget-Oldest)
    ;   true
    ).

forget(Session) :-
    session_adopting(Session, forget_at_rest(Session)).

forget_at_rest(Session) :-
    session_key(Session, Key),
    (   ( session_up(Key) ; session_unfinished(Session) )
    ->  true
    ;   session_close(Session, Unsent)
    ->  requests_lost(Session, Unsent)
    ;   true
    ).

gone(Key) :-
    retractall(resting(Key)),
    (   session(Key, Session)
    ->  debug(typhon(session), '~w: gone for good', [Key]),
        in_background(part(Session), part-Key)
    ;   true
    ).

%   Signals are deferred so that every caller that waits for an answer gets a
%   result.

part(Session) :-
    sig_atomic(( session_adopting(Session,
                                  ( session_retire(Session),
                                    session_close(Session, Unsent) )),
                 unsent_again(Session, Unsent),
                 requests_lost(Session, Unsent) )).

                /*******************************
                *           ATTEMPTS           *
                *******************************/

%   address_wanted(+Address): a caller waits for Address, or did a moment ago.

address_wanted(Address) :-
    (   route_up(Address, Session)
    ->  waiting_met(Address, Session)
    ;   waiting(Address, _, _)
    ->  attempt_want(Address)
    ;   true
    ).

%   address_met(+Address): Address leads to a session that is up, or was: it
%   may be down again. Its frames are then sent when it is up the next time.

address_met(Address) :-
    debug(typhon(connect), '~w: met', [Address]),
    retractall(attempt(Address, _, _, _)),
    (   route(Address, Session)
    ->  waiting_met(Address, Session)
    ;   address_wanted(Address)
    ).

%   session_reconnect(+Session): Session is unfinished, and down: connect
%   again.

session_reconnect(Session) :-
    (   route(Address, Session),
        \+ attempt(Address, _, _, _)
    ->  pause_end(0.05, inf, Until),
        attempt_set(Address, idle(Until), 0.1, 0)
    ;   true
    ).

%   A caller waits for Address, or a session needs it.

needed(Address) :-
    waiting(Address, _, _),
    !.
needed(Address) :-
    route(Address, Session),
    session_unfinished(Session),
    !.

first_pause(0.02).
longest_pause(2).
longest_pause_of_expected(0.2).

%   With many processes all may be busy at once, as at their start: then a peer
%   may be silent for longer before it counts as unreachable.

patience(Seconds) :-
    setting(connect_time, Seconds0),
    predicate_property(attempt(_, _, _, _), number_of_clauses(Attempts)),
    predicate_property(session(_, _), number_of_clauses(Sessions)),
    Seconds is Seconds0*min(4, 1+(Attempts+Sessions)//16).

attempt_set(Address, State, Pause, First) :-
    retractall(attempt(Address, _, _, _)),
    assertz(attempt(Address, State, Pause, First)).

%   A caller waits for Address. Later callers share its attempt.

attempt_want(Address) :-
    attempt(Address, State, _, _),
    State \= idle(_),
    !.
attempt_want(Address) :-
    first_pause(Pause),
    attempt_set(Address, queued, Pause, 0).

%   attempts_begin(+Me): begin the attempts that are next. Me is the hello of
%   this process.

attempts_begin(Me) :-
    (   attempt_next(Me, Address)
    ->  monotonic_time(Now),
        try(Address, Now, Me),
        attempts_begin(Me)
    ;   true
    ).

%   attempt_next(+Me, -Address) is semidet: Address is tried next. If many
%   processes start at once all would be late together, and both processes of
%   each pair would connect. So few attempts are made at a time, by each process
%   in an order of its own: most peers connect by themselves before it is their
%   turn.

attempt_next(Me, Address) :-
    attempt(_, queued, _, _),
    \+ crowded,
    !,
    findall(Hash-Queued,
            ( attempt(Queued, queued, _, _),
              term_hash(Queued-Me, Hash) ),
            Order),
    min_member(_-Address, Order).

crowd(4).
crowd_seconds(2).

crowded :-
    crowd(Many),
    findall(x, young(_), Young),
    length(Young, Count),
    Count >= Many.

%   young(-Until): there is an attempt that has begun recently, and may soon
%   end.

young(Until) :-
    crowd_seconds(Seconds),
    monotonic_time(Now),
    attempt(_, trying(_, Start, _), _, _),
    Until is Start+Seconds,
    Until > Now.

%   try(+Address, +First, +Me): First is the time of the first try.

try(Address, First, Me) :-
    attempt(Address, _, Pause, _),
    monotonic_time(Start),
    late_at(Start, Until),
    catch(wire_thread_create(outgoing(Address, Me), out-Address, Thread),
          error(Formal, _),
          Thread = none),
    attempt_set(Address, trying(Thread, Start, Until), Pause, First),
    debug(typhon(connect), '~w: trying, in ~w', [Address, Thread]),
    (   Thread == none
    ->  failed(Address, Formal)
    ;   true
    ).

%   A silent try ends in time for another one, because its connection may be
%   dead.

late_at(Start, Until) :-
    patience(Seconds),
    Until is Start+Seconds/2.

%   attempt_greeted(+Thread): the peer has answered the try of Thread: it
%   exists, and is slow, as all are when many start at once. The time starts
%   again, unless many tries have failed.

attempt_greeted(Thread) :-
    (   attempt(Address, trying(Thread, Start, _), Pause, _),
        longest_pause(Longest),
        Pause < Longest
    ->  monotonic_time(Now),
        late_at(Now, Until),
        attempt_set(Address, trying(Thread, Start, Until), Pause, Now)
    ;   true
    ).

%   attempt_ended(+Thread, +Formal): the try of Thread, if it is one, has ended
%   without a connection.

attempt_ended(Thread, Formal) :-
    (   attempt(Address, trying(Thread, _, _), _, _)
    ->  failed(Address, Formal)
    ;   true
    ).

%   attempt_time(-Time): at Time the state of some attempt must change.

attempt_time(Time) :-
    attempt(_, State, _, _),
    due_at(State, Time).

%   attempts_due(+Me): end or begin the tries whose time has come.

attempts_due(Me) :-
    monotonic_time(Now),
    findall(Address-State,
            ( attempt(Address, State, _, _),
              State \== queued,
              due_at(State, Time),
              Time =< Now ),
            All),
    forall(member(Address-State, All), due(State, Address, Me)).

due_at(queued, Until) :-
    young(Until).
due_at(trying(_, _, Until), Until).
due_at(pausing(Until), Until).
due_at(idle(Until), Until).

due(_, Address, _) :-
    route_up(Address, _),
    !,
    address_met(Address).
due(trying(Thread, _, _), Address, _) :-
    !,
    in_background(wire_thread_end(Thread, late), end-Address),
    failed(Address, late).
due(idle(_), Address, _) :-
    waiting(Address, _, _),
    !,
    attempt_want(Address).
due(_, Address, Me) :-
    (   needed(Address)
    ->  attempt(Address, _, _, First),
        try(Address, First, Me)
    ;   retractall(attempt(Address, _, _, _))
    ).

		 /*******************************
		 *           FAILURES           *
		 *******************************/

%   failed(+Address, +Formal): the try has failed, Formal is `late` if there was
%   no answer. The session may be up nevertheless, by a connection of the peer.

failed(Address, _) :-
    route_up(Address, _),
    !,
    address_met(Address).
failed(Address, Formal) :-
    debug(typhon(connect), '~w: no connection: ~p', [Address, Formal]),
    attempt(Address, trying(_, Start, _), Pause, First),
    deadline(Address, First, Deadline),
    pause_end(Pause, Deadline, Until),
    (   over(Formal, Address, Deadline)
    ->  print_message(silent,
                      typhon(endpoint, unreachable(Address, Formal))),
        peer_missed(Address, Formal),
        waiting_missed(Address, Start)
    ;   true
    ),
    again(Address, Start, Until, Pause, First).

%   deadline(+Address, +First, -Deadline): the time of the callers, which begins
%   with the First try, is over then. First is 0 if there is no caller.

deadline(_, 0, inf) :-
    !.
deadline(Address, First, Deadline) :-
    (   peer_expected(Address)
    ->  setting(return_time, Seconds)
    ;   patience(Seconds)
    ),
    Deadline is First+Seconds.

%   After about Pause seconds, at the Deadline at the latest.

pause_end(Pause, Deadline, Until) :-
    monotonic_time(Now),
    Some is float_fractional_part(Now*1000),    % library(random) is slow
    Until is min(Deadline, Now+Pause*(0.5+Some)).   % to begin

%   over(+Formal, +Address, +Deadline) is semidet: the callers that the try
%   concerns get a result. There are some, and another try would fail, too, or
%   their time is over.

over(Formal, Address, Deadline) :-
    Deadline \== inf,
    \+ may_pass(Formal),
    \+ soon_there(Formal, Address),
    !.
over(_, _, Deadline) :-
    monotonic_time(Now),
    Deadline =< Now.

%   The process is being restarted.

soon_there(socket_error(econnrefused, _), Address) :-
    peer_expected(Address).

may_pass(late).
may_pass(ended).                        % replaced by another connection
may_pass(session_closed).
may_pass(timeout_error(_, _)).
may_pass(resource_error(_)).
may_pass(io_error(_, _)).
may_pass(syntax_error(end_of_file)).
may_pass(socket_error(Code, _)) :-
    memberchk(Code, [ econnreset, econnaborted, epipe, etimedout, eagain,
                      eai_again, eintr, emfile, enfile, enobufs, enomem,
                      eaddrnotavail ]).

%   again(+Address, +Start, +Until, +Pause, +First): callers that came after the
%   start of the try, or of which it did not know, get another one at once.

again(Address, Start, Until, Pause, First) :-
    waiting(Address, Since, _),
    !,
    (   First > 0,
        Since =< Start
    ->  pause(Address, pausing(Until), Pause, First)
    ;   first_pause(Shortest),
        attempt_set(Address, queued, Shortest, 0)
    ).
again(Address, _, Until, Pause, First) :-
    (   needed(Address)
    ->  pause(Address, idle(Until), Pause, First)
    ;   retractall(attempt(Address, _, _, _))
    ).

pause(Address, State, Pause, First) :-
    (   peer_expected(Address)
    ->  longest_pause_of_expected(Longest)
    ;   longest_pause(Longest)
    ),
    Longer is min(Longest, 2*Pause),
    attempt_set(Address, State, Longer, First).

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].

                /*******************************
                *           WAITING            *
                *******************************/

%!  unsent(?Address) is semidet.
%
%   A request waits for Address.

unsent(Address) :-
    waiting(Address, _, request(_, _, _)),
    !.

%   What, thread(Queue) or a request, waits for Address.

waiting_add(Address, What) :-
    monotonic_time(Now),
    assertz(waiting(Address, Now, What)),
    (   manager_notify(wanted_at(Address))
    ->  true
    ;   waiting_missed(Address, inf)
    ).

%   waiting_met(+Address, +Session): Session leads to Address: send all
%   requests and wake all threads that wait for Address. For the connection
%   manager only.

waiting_met(Address, Session) :-
    waiting(Address, Since, What),
    !,
    (   met(What, Address, Session)
    ->  sent(Address, Since, What),
        waiting_met(Address, Session)
    ;   ignore(manager_notify(wanted_at(Address)))
    ).
waiting_met(_, _).

%   A waiting thread may have been interrupted, and its queue destroyed.

met(thread(Queue), _, _) :-
    ignore(fifo_send(Queue, met)).
met(request(Kind, Term, OnAnswer), Address, Session) :-
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(Formal, Context),
          not_sent(Formal, Context, Address, OnAnswer)).

%   The caller may have given up the request meanwhile.

sent(Address, Since, What) :-
    (   retract(waiting(Address, Since, What))
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
not_sent(Formal, Context, Address, OnAnswer) :-
    report(error, unsent_requests, Address,
           typhon(raised(error(Formal, Context)))),
    request_answer(unreachable, OnAnswer).

%   waiting_missed(?Address, +Start): Address cannot be reached: report that to
%   all that wait since Start, or longer.

waiting_missed(Address, Start) :-
    forall(( waiting(Address, Since, What),
             Since =< Start,
             once(retract(waiting(Address, Since, What))) ),
           missed(What)).

missed(thread(Queue)) :-
    ignore(fifo_send(Queue, missed)).
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
    manager_connect(Address, inf).

manager_connect(Address, Deadline) :-
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

%   unsent_again(+Session, +Unsent): as unsent_closed/4, for the requests among
%   the frames Unsent of Session.

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
    deadline(Seconds, Deadline),
    forall(session(_, Session), session_flush(Session, Deadline)).

%!  endpoint_flush(+Seconds, +Peers:list) is semidet.
%
%   As endpoint_flush/1, for frames to the addresses Peers.

endpoint_flush(Seconds, Peers) :-
    deadline(Seconds, Deadline),
    forall(( member(Peer, Peers),
             route(Peer, Session) ),
           session_flush(Session, Deadline)).

%!  peers_flush(+Seconds) is semidet.
%
%   As endpoint_flush/1, for a process that is about to end.  Does not wait for
%   frames to a peer at whose address no process listens now.  Not for hooks and
%   clean-up handlers, see manager_connect/2.

peers_flush(Seconds) :-
    deadline(Seconds, Deadline),
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
    ignore(fifo_send(Queue, flushed)).
