:- module(typhon_attempts,
          [ address_wanted/1,           % +Address
            address_met/1,              % +Address
            session_reconnect/1,        % +Session
            attempts_begin/1,           % +Me
            attempts_due/1,             % +Me
            attempts_end/0,
            attempt_time/1,             % -Time
            attempt_greeted/1,          % +Thread
            attempt_ended/2             % +Thread, +Formal
          ]).

/** <module> Attempts to connect

Each address that is wanted has an attempt, which ends when a session is up,
whichever side made its connection. Its state is

    queued                  it begins when few others are young
    trying(Thread, Start, Asked, Until)
                            Thread has tried since Start, and is late at Until;
                            Asked is the number of waiting.pl then
    pausing(Until)          the next try begins at Until
    idle(Until)             the same, when a session needs it, but no caller

A failed try concerns the callers that came before it began. Failures that may
pass, as when a peer breaks off during the handshake, are retried while these
have time. All others are reported at once, a refused connection above all,
unless a process is expected there soon.

*Threading*: for the thread of the connection manager.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(connection, [outgoing/2]).
:- use_module(peer_cache, [peer_expected/1, peer_missed/2]).
:- use_module(request, [session_unfinished/1]).
:- use_module(session, [route/2, route_up/2, session/2]).
:- use_module(threads,
              [in_background/2, wire_thread_create/3, wire_thread_end/2]).
:- use_module(waiting,
              [ waiting_first/2, waiting_met/2, waiting_missed/2,
                waiting_number/1 ]).

:- setting(typhon_connection_manager:connect_time, number, 5,
           "Seconds until a peer is reported as unreachable").
:- setting(typhon_connection_manager:return_time, number, 30,
           "Seconds until a restarting peer is reported as unreachable").

:- dynamic
    attempt/4.                          % Address, State, Pause: the next one,
                                        % First: time of the first try

		 /*******************************
		 *           ADDRESSES          *
		 *******************************/

%!  address_wanted(+Address) is det.
%
%   A caller waits for Address, or did a moment ago.

address_wanted(Address) :-
    (   route_up(Address, Session)
    ->  waiting_met(Address, Session)
    ;   waiting_first(Address, _)
    ->  attempt_want(Address)
    ;   true
    ).

%!  address_met(+Address) is det.
%
%   Address leads to a session that is up, or was: it may be down again. Its
%   frames are then sent when it is up the next time.

address_met(Address) :-
    debug(typhon(connect), '~w: met', [Address]),
    retractall(attempt(Address, _, _, _)),
    (   route(Address, Session)
    ->  waiting_met(Address, Session)
    ;   address_wanted(Address)
    ).

%!  session_reconnect(+Session) is det.
%
%   Session is unfinished, and down: connect again.

session_reconnect(Session) :-
    (   route(Address, Session),
        \+ attempt(Address, _, _, _)
    ->  pause_end(0.05, inf, Until),
        attempt_set(Address, idle(Until), 0.1, 0)
    ;   true
    ).

%   A caller waits for Address, or a session needs it.

needed(Address) :-
    waiting_first(Address, _),
    !.
needed(Address) :-
    route(Address, Session),
    session_unfinished(Session),
    !.

		 /*******************************
		 *           ATTEMPTS           *
		 *******************************/

first_pause(0.02).
longest_pause(2).
longest_pause_of_expected(0.2).

%   With many processes all may be busy at once, as at their start: then a peer
%   may be silent for longer before it counts as unreachable.

patience(Seconds) :-
    setting(typhon_connection_manager:connect_time, Seconds0),
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

%!  attempts_begin(+Me) is det.
%
%   Begin the attempts that are next.  Me is the hello of this process.

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
    attempt(_, trying(_, Start, _, _), _, _),
    Until is Start+Seconds,
    Until > Now.

%   try(+Address, +First, +Me): First is the time of the first try.

try(Address, First, Me) :-
    attempt(Address, _, Pause, _),
    monotonic_time(Start),
    late_at(Start, Until),
    waiting_number(Asked),
    catch(wire_thread_create(outgoing(Address, Me), out-Address, Thread),
          error(Formal, _),
          Thread = none),
    attempt_set(Address, trying(Thread, Start, Asked, Until), Pause, First),
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

%!  attempt_greeted(+Thread) is det.
%
%   The peer has answered the try of Thread: it exists, and is slow, as all are
%   when many start at once.  The time starts again, unless many tries have
%   failed.

attempt_greeted(Thread) :-
    (   attempt(Address, trying(Thread, Start, Asked, _), Pause, _),
        longest_pause(Longest),
        Pause < Longest
    ->  monotonic_time(Now),
        late_at(Now, Until),
        attempt_set(Address, trying(Thread, Start, Asked, Until), Pause, Now)
    ;   true
    ).

%!  attempt_ended(+Thread, +Formal) is det.
%
%   The try of Thread, if it is one, has ended without a connection.

attempt_ended(Thread, Formal) :-
    (   attempt(Address, trying(Thread, _, _, _), _, _)
    ->  failed(Address, Formal)
    ;   true
    ).

%!  attempt_time(-Time) is nondet.
%
%   At Time the state of some attempt must change.

attempt_time(Time) :-
    attempt(_, State, _, _),
    due_at(State, Time).

%!  attempts_due(+Me) is det.
%
%   End or begin the tries whose time has come.

attempts_due(Me) :-
    monotonic_time(Now),
    findall(Address-State,
            ( attempt(Address, State, _, _),
              State \== queued,
              due_at(State, Time),
              Time =< Now ),
            All),
    forall(member(Address-State, All), due(State, Address, Me)).

%!  attempts_end is det.
%
%   Forget all attempts: the endpoint stops.

attempts_end :-
    retractall(attempt(_, _, _, _)).

due_at(queued, Until) :-
    young(Until).
due_at(trying(_, _, _, Until), Until).
due_at(pausing(Until), Until).
due_at(idle(Until), Until).

due(_, Address, _) :-
    route_up(Address, _),
    !,
    address_met(Address).
due(trying(Thread, _, _, _), Address, _) :-
    !,
    in_background(wire_thread_end(Thread, late), end-Address),
    failed(Address, late).
due(idle(_), Address, _) :-
    waiting_first(Address, _),
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
    attempt(Address, trying(_, _, Asked, _), Pause, First),
    deadline(Address, First, Deadline),
    pause_end(Pause, Deadline, Until),
    (   over(Formal, Address, Deadline)
    ->  print_message(silent,
                      typhon(endpoint, unreachable(Address, Formal))),
        peer_missed(Address, Formal),
        waiting_missed(Address, Asked)
    ;   true
    ),
    again(Address, Asked, Until, Pause, First).

%   deadline(+Address, +First, -Deadline): the time of the callers, which begins
%   with the First try, is over then. First is 0 if there is no caller.

deadline(_, 0, inf) :-
    !.
deadline(Address, First, Deadline) :-
    (   peer_expected(Address)
    ->  setting(typhon_connection_manager:return_time, Seconds)
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

%   again(+Address, +Asked, +Until, +Pause, +First): callers that came after the
%   try had begun, or of which it did not know, get another one at once.

again(Address, Asked, Until, Pause, First) :-
    waiting_first(Address, Number),
    !,
    (   First > 0,
        Number < Asked
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

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
