:- module(typhon_connection_manager,
          [ manager_begin/1,            % +Me
            manager_end/0
          ]).

/** <module> The connection manager: connects and reconnects

One server of the endpoint keeps its sessions alive. It connects to the
addresses that are wanted, reconnects sessions with frames to send or to
receive, see attempts.pl, and closes others.

*Threading*: manage/3 runs in the thread of the server, which owns the tables
below and those of attempts.pl. Other threads send it messages by
manager_notify/1. It never waits: work that may take long is done by a
background thread.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(attempts,
              [ address_met/1, address_wanted/1, attempt_ended/2,
                attempt_greeted/1, attempt_time/1, attempts_begin/1,
                attempts_due/1, attempts_end/0, session_reconnect/1 ]).
:- use_module(peer_cache, [peer_gone/1]).
:- use_module(request, [requests_lost/2, session_unfinished/1]).
:- use_module(session,
              [ route_key/2, session/2, session_adopting/2, session_close/2,
                session_key/2, session_retire/1, session_up/1 ]).
:- use_module(threads,
              [ in_background/2, manager_start/2, manager_stop/0,
                wire_thread_join/1 ]).
:- use_module(waiting, [unsent_again/2, waiting_missed/2]).

:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").

:- dynamic
    resting/1,                          % Key
    errand/2.                           % Time, Goal

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

:- public manage/3.

manage(stop, _, _) :-
    !,
    waiting_missed(_, inf),
    attempts_end,
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
    findall(Address, route_key(Address, Key), Addresses),
    forall(member(Address, Addresses), address_met(Address)).
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
handle(timeout, Me) :-
    monotonic_time(Now),
    run_errands(Now),
    attempts_due(Me).

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
