:- module(typhon_keeper,
          [ keep/1,                     % +Me
            keeper_connect/1,           % +Address
            keeper_unheard/1            % +Messages
          ]).

/** <module> The keeper: connects, and connects again

One thread per endpoint keeps its sessions alive. It starts the attempts to
connect, gives each a deadline, tells those who wait for one how it went,
and repeats those of sessions that have something to send or to hear.

_Threading_: keep/1 is the goal of the keeper's thread, which owns all the
dynamic predicates below. Others talk to it through crew_tell/1.
*/

:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(connection, [outgoing/2]).
:- use_module(contacts, [contact_gone/1]).
:- use_module(crew, [crew_bury/1, crew_hear/2, crew_retire/2, crew_spawn/2,
                     crew_tell/1]).
:- use_module(request, [requests_lost/2, requests_open/1]).
:- use_module(session, [route/2, session/2, session_close/2,
                        session_peer/3, session_pending/2, session_retire/1,
                        session_up/1]).

:- setting(connect_time, number, 5,
           "Seconds an attempt to connect may take").

:- dynamic
    attempt/3,                          % Address, Thread, Deadline
    waiter/2,                           % Address, Queue
    again/3.                            % Key, Time, Wait

%!  keeper_connect(+Address) is semidet.
%
%   See to it that there is a connection to Address; fails if there can be
%   none. The keeper always answers, so there is no deadline here: a wait
%   with a deadline may never end in a clean-up handler or a hook, where
%   signals are held back (SWI-Prolog 9.0.4).

keeper_connect(Address) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( crew_tell(connect(Address, Queue)),
          thread_get_message(Queue, Result),
          Result == met ),
        message_queue_destroy(Queue)).

%!  keeper_unheard(+Messages) is det.
%
%   Answer those who asked too late.

keeper_unheard(Messages) :-
    forall(member(connect(_, Queue), Messages), tell_waiter(Queue, missed)).

%!  keep(+Me) is det.
%
%   The life of the keeper, Me being our hello. Ends on the message `stop`.

keep(Me) :-
    repeat,
    next_deadline(Deadline),
    (   crew_hear(Message, Deadline)
    ->  true
    ;   Message = overdue
    ),
    (   Message == stop
    ->  !,
        rest
    ;   catch(hear(Message, Me),
              error(Formal, Context),
              print_message(error, error(Formal, Context))),
        fail
    ).

rest :-
    forall(retract(waiter(_, Queue)), tell_waiter(Queue, missed)),
    retractall(attempt(_, _, _)),
    retractall(again(_, _, _)).

next_deadline(Deadline) :-
    findall(T, ( attempt(_, _, T) ; again(_, T, _) ), Times),
    (   Times == []
    ->  Deadline = infinite
    ;   min_list(Times, Deadline)
    ).

hear(connect(Address, Queue), Me) :-
    (   route(Address, session(Key, _, _, _, _)),
        session_up(Key)
    ->  tell_waiter(Queue, met)
    ;   assertz(waiter(Address, Queue)),
        start_attempt(Address, Me)
    ).
hear(met(Address, session(Key, _, _, _, _)), _) :-
    retractall(attempt(Address, _, _)),
    retractall(again(Key, _, _)),
    tell_waiters(Address, met).
hear(missed(Address, Formal), _) :-
    missed(Address, Formal).
hear(wanted(Key), _) :-
    plan(Key, 0.05).
hear(ended(Thread), _) :-
    crew_bury(Thread).
hear(displaced(Key), _) :-              % another process has its address
    (   route(_, session(Key, _, _, _, _))
    ->  true
    ;   gone(Key)
    ).
hear(gone(Key), _) :-                   % it said goodbye
    forall(route(Address, session(Key, _, _, _, _)),
           contact_gone(Address)),
    gone(Key).
hear(overdue, Me) :-
    overdue(Me).

gone(Key) :-
    (   session(Key, Session)
    ->  retractall(again(Key, _, _)),
        session_retire(Session),
        session_close(Session, Unsent),
        requests_lost(Session, Unsent)
    ;   true
    ).

start_attempt(Address, Me) :-
    (   attempt(Address, _, _)
    ->  true
    ;   setting(connect_time, Seconds),
        get_time(Now),
        Deadline is Now+Seconds,
        crew_spawn(outgoing(Address, Me), Thread),
        assertz(attempt(Address, Thread, Deadline))
    ).

missed(Address, Formal) :-
    retractall(attempt(Address, _, _)),
    print_message(silent,
                  typhon(endpoint, unreachable(Address, Formal))),
    tell_waiters(Address, missed).

tell_waiters(Address, Result) :-
    forall(retract(waiter(Address, Queue)), tell_waiter(Queue, Result)).

tell_waiter(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

%   Connect again as long as something is unfinished.

plan(Key, Wait) :-
    (   session(Key, Session),
        \+ session_up(Key),
        unfinished(Session),
        \+ again(Key, _, _)
    ->  get_time(Now),
        Time is Now+Wait,
        assertz(again(Key, Time, Wait))
    ;   true
    ).

unfinished(Session) :-
    session_pending(Session, Pending),
    Pending > 0,
    !.
unfinished(Session) :-
    requests_open(Session).

overdue(Me) :-
    get_time(Now),
    forall(( attempt(Address, Thread, Deadline), Deadline =< Now ),
           ( crew_retire(Thread, late),
             missed(Address, late) )),
    forall(( again(Key, Time, Wait), Time =< Now ),
           try_again(Key, Wait, Me)).

try_again(Key, Wait, Me) :-
    retractall(again(Key, _, _)),
    (   session(Key, Session),
        \+ session_up(Key),
        unfinished(Session),
        session_address(Session, Address)
    ->  start_attempt(Address, Me),
        Wait1 is min(2, 2*Wait),
        plan(Key, Wait1)
    ;   true
    ).

session_address(Session, Address) :-
    route(Address, Session),
    !.

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
