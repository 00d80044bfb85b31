:- module(typhon_connection_manager,
          [ keep/1,                     % +Me
            manager_unhandled/1         % +Messages
          ]).

/** <module> The connection manager: connects and reconnects

One thread of the endpoint keeps its sessions alive. It connects to the
addresses that are wanted, reconnects sessions with frames to send or to
receive, and closes others.

For each wanted address attempts to connect are made, with growing pauses,
until a session is up, whichever side made its connection. Waiting threads are
notified that it is up, or that there can be none. Failures that may pass, as
when a peer breaks off during the handshake, are retried while there is time.
All others are reported at once, a refused connection above all, unless a
process is expected there soon.

*Threading*: keep/1 is the goal of the manager's thread, which owns the tables
below. Other threads send it messages by manager_notify/1. It never waits: work
that may take long is done by a background thread.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(attempts,
              [ attempt/4, attempt_asked/2, attempt_begun/3,
                attempt_due/1, attempt_end/1, attempt_greeted/1,
                attempt_next/2, attempt_over/3, attempt_pause/3,
                attempt_want/1, attempts_due/1 ]).
:- use_module(connection, [outgoing/2]).
:- use_module(peer_cache,
              [peer_gone/1, peer_missed/2]).
:- use_module(request, [requests_lost/2, session_unfinished/1]).
:- use_module(writer, [session_close/2, session_retire/1]).
:- use_module(session,
              [ route/2, route_key/2, route_up/2, session/2,
                session_adopting/2, session_key/2, session_up/1 ]).
:- use_module(threads,
              [ in_background/2, manager_receive/2, wire_thread_create/3,
                wire_thread_end/2, wire_thread_join/1 ]).
:- use_module(waiting,
              [ asked/1, unsent_again/2, waiting/1, waiting_met/2,
                waiting_missed/2 ]).

:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").

:- dynamic
    resting/1,                          % Key
    errand/2.                           % Time, Goal

%!  manager_unhandled(+Messages) is det.
%
%   The endpoint has stopped with these Messages unhandled: answer the callers
%   that still wait, and run the goals that were due later.

manager_unhandled(Messages) :-
    waiting_missed(_, inf),
    forall(member(later(_, Goal), Messages), call(Goal)).

%!  keep(+Me) is det.
%
%   The goal of the thread. Me is the hello of this process. Ends on the message
%   `stop`.

keep(Me) :-
    nb_setval(typhon_connection_manager, true),
    repeat,
    next_deadline(Deadline),
    (   manager_receive(Message, Deadline)
    ->  true
    ;   Message = overdue
    ),
    (   Message == stop
    ->  !,
        give_up,
        retractall(resting(_)),
        run_errands(inf)
    ;   catch(( handle(Message, Me), begin_attempts(Me) ),
              error(Formal, Context),
              print_error(error, error(Formal, Context))),
        fail
    ).

next_deadline(Deadline) :-
    findall(Time, ( attempt_due(Time) ; errand(Time, _) ), Times),
    (   Times == []
    ->  Deadline = infinite
    ;   min_list(Times, Deadline)
    ).

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
    session_is_up(Key).
handle(wanted(Key), _) :-
    (   session(Key, Session),
        \+ session_up(Key)
    ->  down(Session)
    ;   true
    ).
handle(displaced(Key), Me) :-           % another process has an address of Key
    (   route_key(_, Key)               % Key may have other addresses
    ->  handle(wanted(Key), Me)
    ;   gone(Key)
    ).
handle(gone(Key), _) :-                 % the peer has sent `bye`
    forall(route_key(Address, Key), peer_gone(Address)),
    gone(Key).
handle(later(Time, Goal), _) :-         % Goal is quick
    assertz(errand(Time, Goal)).
handle(overdue, Me) :-
    get_time(Now),
    run_errands(Now),
    handle_overdue(Me).

%   Run the goals of later/2 messages that are due.

run_errands(Now) :-
    findall(Time-Goal, ( errand(Time, Goal), Time =< Now ), Due),
    forall(member(Time-Goal, Due),
           ( retractall(errand(Time, Goal)),
             call(Goal) )).

%   A session with nothing pending is kept for its counts: the peer may be cut
%   off only, and return with frames that have arrived before.

down(Session) :-
    session_unfinished(Session),
    !,
    reconnect(Session).
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
		 *       WANTED ADDRESSES       *
		 *******************************/

%!  address_wanted(+Address) is det.
%
%   A caller waits for Address, or did a moment ago.

address_wanted(Address) :-
    (   up(Address, Session)
    ->  waiting_met(Address, Session)
    ;   waiting(Address)
    ->  attempt_want(Address)
    ;   true
    ).

%!  reconnect(+Session) is det.
%
%   Session is unfinished: connect again.

reconnect(Session) :-
    (   route(Address, Session),
        \+ attempt(Address, _, _, _)
    ->  attempt_pause(Address, 0.05, none)
    ;   true
    ).

up(Address, Session) :-
    route_up(Address, Session),
    !.

		 /*******************************
		 *           ATTEMPTS           *
		 *******************************/

%!  begin_attempts(+Me) is det.
%
%   Begin the attempts that are next. Me is the hello of this process.

begin_attempts(Me) :-
    (   attempt_next(Me, Address)
    ->  try(Address, Me),
        begin_attempts(Me)
    ;   true
    ).

try(Address, Me) :-
    asked(Asked),
    catch(wire_thread_create(outgoing(Address, Me), out-Address, Thread),
          error(Formal, _),
          Thread = none),
    attempt_begun(Address, Thread, Asked),
    debug(typhon(connect), '~w: trying, in ~w', [Address, Thread]),
    (   Thread == none
    ->  verdict(Address, Formal)
    ;   true
    ).

%!  attempt_ended(+Thread, +Formal) is det.
%
%   The attempt of Thread, if it is one, has ended without a connection.

attempt_ended(Thread, Formal) :-
    (   attempt(Address, trying(Thread, _, _), _, _)
    ->  verdict(Address, Formal)
    ;   true
    ).

%   The session may be up nevertheless, by a connection that the peer has made.

verdict(Address, _) :-
    up(Address, _),
    !,
    met(Address).
verdict(Address, Formal) :-
    attempt(Address, State, Pause, Since),
    debug(typhon(connect), '~w: no connection: ~p', [Address, Formal]),
    (   attempt_over(Address, Since, Formal)
    ->  attempt_asked(State, Asked),
        missed(Address, Asked, Formal),
        next_attempt(Address, Pause)
    ;   go_on(Address, Pause, Since)
    ).

%   Requests made since the attempt began get another attempt.

next_attempt(Address, _) :-
    waiting(Address),
    !,
    attempt_end(Address),
    attempt_want(Address).
next_attempt(Address, Pause) :-
    go_on(Address, Pause, none).

go_on(Address, Pause, Since) :-
    (   pointless(Address, Since)
    ->  attempt_end(Address)
    ;   attempt_pause(Address, Pause, Since)
    ).

%   No caller waits for Address, and no session needs it.

pointless(Address, none) :-
    \+ ( route(Address, Session),
         session_unfinished(Session) ).

%!  handle_overdue(+Me) is det.
%
%   End or begin the attempts that are due.

handle_overdue(Me) :-
    attempts_due(Due),
    forall(member(Address-State, Due), overdue(Address, State, Me)).

overdue(Address, State, Me) :-
    (   \+ attempt(Address, State, _, _)
    ->  true
    ;   up(Address, _)
    ->  met(Address)
    ;   late(State, Address, Me)
    ).

late(trying(Thread, _, _), Address, _) :-
    in_background(wire_thread_end(Thread, late), end-Address),
    verdict(Address, late).
late(pausing(_, _), Address, Me) :-
    attempt(Address, _, _, Since),
    (   attempt_over(Address, Since, late)
    ->  verdict(Address, late)
    ;   pointless(Address, Since)
    ->  attempt_end(Address)
    ;   try(Address, Me)
    ).

		 /*******************************
		 *           OUTCOMES           *
		 *******************************/

%!  session_is_up(+Key) is det.
%
%   The session Key has a connection, which serves all addresses that lead to
%   it.

session_is_up(Key) :-
    findall(Address, route_key(Address, Key), Addresses),
    forall(member(Address, Addresses), met(Address)).

%   The session may be down again: its frames are then sent when it is up the
%   next time.

met(Address) :-
    debug(typhon(connect), '~w: met', [Address]),
    attempt_end(Address),
    (   route(Address, Session)
    ->  waiting_met(Address, Session)
    ;   address_wanted(Address)
    ).

missed(Address, Asked, Formal) :-
    print_message(silent,
                  typhon(endpoint, unreachable(Address, Formal))),
    peer_missed(Address, Formal),
    waiting_missed(Address, Asked).

%!  give_up is det.
%
%   The endpoint stops: report all addresses as unreachable.

give_up :-
    waiting_missed(_, inf),
    attempt_end(_).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
