:- module(typhon_connector,
          [ connector_wait/2,           % +Address, +Queue
            connector_send/1,           % +Address
            connector_again/1,          % +Session
            connector_begin/1,          % +Me
            connector_up/1,             % +Key
            connector_ended/2,          % +Thread, +Formal
            connector_overdue/1,        % +Me
            connector_give_up/0
          ]).

/** <module> The connector: how peers are reached

For each address that somebody wants to reach attempts to connect are made,
with growing pauses, until there is a session that is up, whoever gave it
its connection. Those who wait hear that it is up, or that there can be
none. The attempts of a session with something to send or to hear go on.

What may pass, as when a peer breaks off before we have met, is tried again
while there is time. All else is told at once, nobody listening first of all,
unless it is known that somebody soon will be.

*Threading*: for the thread of the keeper alone.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(attempts,
              [ attempt/4, attempt_asked/2, attempt_begun/3, attempt_end/1,
                attempt_expired/2, attempt_next/2, attempt_pause/3,
                attempt_want/1, attempts_due/1 ]).
:- use_module(connection, [outgoing/2]).
:- use_module(contacts, [contact_expected/1, contact_missed/2]).
:- use_module(request, [session_unfinished/1]).
:- use_module(session, [route/2, route_key/2, route_up/2]).
:- use_module(threads,
              [in_background/2, wire_thread_create/3, wire_thread_end/2]).
:- use_module(unsent,
              [unsent/1, unsent_fail/1, unsent_fail/2, unsent_send/2]).
:- use_module(waiters,
              [ asked/1, waiter/1, waiter_add/2, waiter_tell/2,
                waiters_missed/2, waiters_tell/2 ]).

		 /*******************************
		 *          WHO WANTS           *
		 *******************************/

%!  connector_wait(+Address, +Queue) is det.
%
%   Queue hears `met` or `missed`.

connector_wait(Address, Queue) :-
    (   up(Address, _)
    ->  waiter_tell(Queue, met)
    ;   waiter_add(Address, Queue),
        attempt_want(Address)
    ).

%!  connector_send(+Address) is det.
%
%   Send what is held for Address when there is a session, see unsent.pl.

connector_send(Address) :-
    (   up(Address, Session)
    ->  unsent_send(Address, Session)
    ;   attempt_want(Address)
    ).

%!  connector_again(+Session) is det.
%
%   Session is unfinished: connect again.

connector_again(Session) :-
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

%!  connector_begin(+Me) is det.
%
%   Begin the attempts whose turn has come, Me being our hello.

connector_begin(Me) :-
    (   attempt_next(Me, Address)
    ->  try(Address, Me),
        connector_begin(Me)
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

%!  connector_ended(+Thread, +Formal) is det.
%
%   The attempt of Thread, if it is one, has ended without connection.

connector_ended(Thread, Formal) :-
    (   attempt(Address, trying(Thread, _, _), _, _)
    ->  verdict(Address, Formal)
    ;   true
    ).

%   The session may be up all the same, by a connection of the peer's.

verdict(Address, _) :-
    up(Address, _),
    !,
    met(Address).
verdict(Address, Formal) :-
    attempt(Address, State, Pause, Since),
    debug(typhon(connect), '~w: no connection: ~p', [Address, Formal]),
    (   over(Address, Since, Formal)
    ->  attempt_asked(State, Asked),
        missed(Address, Asked, Formal),
        others(Address, Pause)
    ;   go_on(Address, Pause, Since)
    ).

%   Who has asked since the attempt began has another one.

others(Address, _) :-
    ( waiter(Address) ; unsent(Address) ),
    !,
    attempt_end(Address),
    attempt_want(Address).
others(Address, Pause) :-
    go_on(Address, Pause, none).

over(Address, Since, Formal) :-
    number(Since),
    (   \+ may_pass(Formal),
        \+ soon_there(Formal, Address)
    ->  true
    ;   attempt_expired(Address, Since)
    ).

%   It is being started again.

soon_there(socket_error(econnrefused, _), Address) :-
    contact_expected(Address).

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

go_on(Address, Pause, Since) :-
    (   pointless(Address, Since)
    ->  attempt_end(Address)
    ;   attempt_pause(Address, Pause, Since)
    ).

%   Nobody waits, and no session needs it.

pointless(Address, none) :-
    \+ ( route(Address, Session),
         session_unfinished(Session) ).

%!  connector_overdue(+Me) is det.
%
%   Do what is due.

connector_overdue(Me) :-
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
    (   over(Address, Since, late)
    ->  verdict(Address, late)
    ;   pointless(Address, Since)
    ->  attempt_end(Address)
    ;   try(Address, Me)
    ).

		 /*******************************
		 *           OUTCOMES           *
		 *******************************/

%!  connector_up(+Key) is det.
%
%   The session Key has a connection: so have all addresses that lead to it.

connector_up(Key) :-
    findall(Address, route_key(Address, Key), Addresses),
    forall(member(Address, Addresses), met(Address)).

%   It may be down again: what is sent in it comes through when it is up the
%   next time.

met(Address) :-
    debug(typhon(connect), '~w: met', [Address]),
    attempt_end(Address),
    (   route(Address, Session)
    ->  unsent_send(Address, Session)
    ;   true
    ),
    waiters_tell(Address, met).

missed(Address, Asked, Formal) :-
    print_message(silent,
                  typhon(endpoint, unreachable(Address, Formal))),
    contact_missed(Address, Formal),
    unsent_fail(Address, Asked),
    waiters_missed(Address, Asked).

%!  connector_give_up is det.
%
%   The endpoint stops: nobody can be reached any more.

connector_give_up :-
    waiters_tell(_, missed),
    unsent_fail(_),
    attempt_end(_).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
