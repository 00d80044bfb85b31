:- module(typhon_keeper,
          [ keep/1,                     % +Me
            keeper_connect/1,           % +Address
            keeper_unheard/1            % +Messages
          ]).

/** <module> The keeper: connects, and connects again

One thread per endpoint keeps its sessions alive. For each address that
somebody wants to reach there is a quest: attempts to connect, with growing
pauses, until the session is up, whoever gave it its connection. Those who
wait are told when it is, or that it cannot be; the quest of a session with
something to send or to hear goes on.

_Threading_: keep/1 is the goal of the keeper's thread, which owns all the
dynamic predicates below. Others talk to it through crew_tell/1. It waits
for nobody: what may take a while is done by a thread of the crew.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, min_list/2, min_member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(connection, [outgoing/2]).
:- use_module(contacts, [contact_gone/1]).
:- use_module(crew, [crew_bury/1, crew_hear/2, crew_retire/2, crew_spawn/2,
                     crew_tell/1]).
:- use_module(held, [held_fail/1, held_send/2]).
:- use_module(outbox, [session_close/2, session_pending/2,
                       session_retire/1, session_up/1]).
:- use_module(request, [requests_lost/2, requests_open/1]).
:- use_module(session, [route/2, session/2, session_adopting/2]).

:- setting(connect_time, number, 5,
           "Seconds until it is told that a peer cannot be reached").
:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").

:- dynamic
    waiter/2,                           % Address, Queue
    quest/4,                            % Address, State, Pause, Deadline
    resting/1.                          % Key

%   The State of a quest is `queued`, trying(Thread, Start, Until) or
%   pausing(Until); its Deadline that of those who wait, `unset` before the
%   first attempt, `none` if nobody waits.

%!  keeper_connect(+Address) is semidet.
%
%   See to it that there is a connection to Address; fails if there can be
%   none. The keeper always answers, so there is no deadline here: a wait
%   with a deadline may never end in a clean-up handler or a hook, where
%   signals are held back (SWI-Prolog 9.0.4). The keeper itself does not
%   wait for the keeper.

keeper_connect(Address) :-
    \+ nb_current(typhon_keeper, true),
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
    forall(member(connect(_, Queue), Messages), tell_waiter(Queue, missed)),
    held_fail(_).

%!  keep(+Me) is det.
%
%   The life of the keeper, Me being our hello. Ends on the message `stop`.

keep(Me) :-
    nb_setval(typhon_keeper, true),
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
        try_queued(Me),
        fail
    ).

rest :-
    findall(Address, waiter(Address, _), Waited),
    maplist(tell_waiters(missed), Waited),
    held_fail(_),
    retractall(quest(_, _, _, _)),
    retractall(resting(_)).

next_deadline(Deadline) :-
    findall(Until,
            ( due(_, _, Until)
            ; quest(_, queued, _, _), young(Until)
            ),
            Times),
    (   Times == []
    ->  Deadline = infinite
    ;   min_list(Times, Deadline)
    ).

due(Address, State, Until) :-
    quest(Address, State, _, _),
    until(State, Until).

until(trying(_, _, Until), Until).
until(pausing(Until), Until).

hear(connect(Address, Queue), _) :-
    (   up(Address, _)
    ->  tell_waiter(Queue, met)
    ;   assertz(waiter(Address, Queue)),
        want(Address)
    ).
hear(requests(Address), _) :-
    (   up(Address, Session)
    ->  held_send(Address, Session)
    ;   want(Address)
    ).
hear(up(Key), _) :-
    retractall(resting(Key)),
    findall(Address, leads_to(Address, Key), Addresses),
    maplist(met, Addresses).
hear(greeted(Address, Thread), _) :-
    (   quest(Address, trying(Thread, Start, _), Pause, Deadline),
        number(Deadline)
    ->  greeted(Address, Thread, Start, Pause)
    ;   true
    ).
hear(missed(Address, Thread, Formal), _) :-
    (   quest(Address, trying(Thread, _, _), _, _)
    ->  verdict(Address, Formal)
    ;   true
    ).
hear(wanted(Key), _) :-
    (   session(Key, Session),
        \+ session_up(Key)
    ->  without_connection(Session)
    ;   true
    ).
hear(ended(Thread), _) :-
    crew_bury(Thread),
    (   quest(Address, trying(Thread, _, _), _, _)
    ->  verdict(Address, ended)         % another connection replaced it
    ;   true
    ).
hear(displaced(Key), _) :-              % another process has its address
    (   leads_to(_, Key)
    ->  true
    ;   gone(Key)
    ).
hear(gone(Key), _) :-                   % it said goodbye
    forall(leads_to(Address, Key), contact_gone(Address)),
    gone(Key).
hear(overdue, Me) :-
    get_time(Now),
    findall(Address-State,
            ( due(Address, State, Until), Until =< Now ),
            Due),
    forall(member(Address-State, Due), overdue(State, Address, Me)).

leads_to(Address, Key) :-
    route(Address, session(Key, _, _, _, _)).

up(Address, Session) :-
    route(Address, Session),
    arg(1, Session, Key),
    session_up(Key),
    !.

		 /*******************************
		 *            QUESTS            *
		 *******************************/

first_pause(0.02).
longest_pause(2).

%   Somebody wants to reach Address; who comes later waits with the first.

want(Address) :-
    quest(Address, _, _, Deadline),
    Deadline \== none,
    !.
want(Address) :-
    first_pause(Pause),
    (   quest(Address, trying(Thread, Start, Until), _, _)
    ->  in_time(Deadline),
        set_quest(Address, trying(Thread, Start, Until), Pause, Deadline)
    ;   set_quest(Address, queued, Pause, unset)
    ).

%   Where there are many processes they may all be busy at once, as they are
%   when they begin: then it takes longer until silence means something.

in_time(Deadline) :-
    setting(connect_time, Seconds),
    get_time(Now),
    predicate_property(quest(_, _, _, _), number_of_clauses(Quests)),
    predicate_property(session(_, _), number_of_clauses(Sessions)),
    Deadline is Now+Seconds*min(4, 1+(Quests+Sessions)//16).

set_quest(Address, State, Pause, Deadline) :-
    retractall(quest(Address, _, _, _)),
    assertz(quest(Address, State, Pause, Deadline)).

%   Where many processes begin at once all would be late together, and of
%   each pair both would connect. So few attempts are begun at a time, by
%   each process in an order of its own: most peers come by themselves before
%   it is their turn. The time of those who wait begins with the attempt.

crowd(4).
crowd_seconds(2).

try_queued(Me) :-
    quest(_, queued, _, _),
    \+ crowded,
    !,
    findall(Hash-Address,
            ( quest(Address, queued, _, _),
              term_hash(Address-Me, Hash) ),
            Queued),
    min_member(_-Next, Queued),
    quest(Next, queued, Pause, Deadline),
    try(Next, Pause, Deadline, Me),
    try_queued(Me).
try_queued(_).

crowded :-
    crowd(Many),
    findall(x, young(_), Young),
    length(Young, Count),
    Count >= Many.

%   young(-Until): an attempt that may soon have ended.

young(Until) :-
    crowd_seconds(Seconds),
    get_time(Now),
    quest(_, trying(_, Start, _), _, _),
    Until is Start+Seconds,
    Until > Now.

try(Address, Pause, Deadline0, Me) :-
    in_time(Until0),
    get_time(Start),
    (   Deadline0 == unset
    ->  Deadline = Until0
    ;   Deadline = Deadline0
    ),
    earlier(Deadline, Until0, Until),
    catch(crew_spawn(outgoing(Address, Me), Thread),
          error(Formal, _),
          Thread = none),
    set_quest(Address, trying(Thread, Start, Until), Pause, Deadline),
    (   Thread == none
    ->  verdict(Address, Formal)
    ;   true
    ).

%   Somebody is there, and slow, as all are where many begin at once: there
%   is time again, unless it has gone wrong often.

greeted(Address, Thread, Start, Pause) :-
    longest_pause(Longest),
    (   Pause < Longest
    ->  in_time(Until),
        set_quest(Address, trying(Thread, Start, Until), Pause, Until)
    ;   true
    ).

%   verdict(+Address, +Formal): an attempt has ended without connection.

verdict(Address, _) :-
    up(Address, _),
    !,
    met(Address).
verdict(Address, Formal) :-
    quest(Address, _, Pause, Deadline),
    get_time(Now),
    (   told(Deadline, Formal, Now)
    ->  missed(Address, Formal),
        go_on(Address, Now, Pause, none)
    ;   go_on(Address, Now, Pause, Deadline)
    ).

told(Deadline, _, Now) :-
    number(Deadline),
    Deadline =< Now,
    !.
told(Deadline, Formal, _) :-
    number(Deadline),
    \+ may_pass(Formal).

%   Somebody listens there, it seems, or may do so in a moment. What else
%   there is, nobody listening first of all, is told at once.

may_pass(ended).
may_pass(session_closed).
may_pass(timeout_error(_, _)).
may_pass(resource_error(_)).
may_pass(io_error(_, _)).
may_pass(syntax_error(end_of_file)).
may_pass(socket_error(Code, _)) :-
    memberchk(Code, [ econnreset, econnaborted, epipe, etimedout, eagain,
                      eai_again, eintr, emfile, enfile, enobufs, enomem,
                      eaddrnotavail ]).

go_on(Address, _, _, none) :-
    \+ needed(Address),
    !,
    retractall(quest(Address, _, _, _)).
go_on(Address, Now, Pause, Deadline) :-
    some(Now, Some),
    Until0 is Now+Pause*(0.5+Some),
    earlier(Deadline, Until0, Until),
    longest_pause(Longest),
    Pause1 is min(Longest, 2*Pause),
    set_quest(Address, pausing(Until), Pause1, Deadline).

%   A number from 0 to 1: library(random) takes milliseconds to begin.

some(Now, Some) :-
    Some is float_fractional_part(Now*1000).

earlier(none, Time, Time) :-
    !.
earlier(Deadline, Time0, Time) :-
    Time is min(Deadline, Time0).

needed(Address) :-
    route(Address, Session),
    unfinished(Session),
    !.

unfinished(Session) :-
    session_pending(Session, Pending),
    Pending > 0,
    !.
unfinished(Session) :-
    requests_open(Session).

overdue(State, Address, _) :-
    \+ quest(Address, State, _, _),
    !.
overdue(_, Address, _) :-
    up(Address, _),
    !,
    met(Address).
overdue(trying(Thread, _, _), Address, _) :-
    aside(crew_retire(Thread, late)),
    verdict(Address, late).
overdue(pausing(_), Address, Me) :-
    quest(Address, _, Pause, Deadline),
    get_time(Now),
    (   ( told(Deadline, ended, Now)
        ; Deadline == none, \+ needed(Address) )
    ->  verdict(Address, late)
    ;   try(Address, Pause, Deadline, Me)
    ).

%   The session may be down again: what is sent in it comes through when it
%   is up the next time.

met(Address) :-
    retractall(quest(Address, _, _, _)),
    (   route(Address, Session)
    ->  held_send(Address, Session)
    ;   true
    ),
    tell_waiters(met, Address).

missed(Address, Formal) :-
    print_message(silent,
                  typhon(endpoint, unreachable(Address, Formal))),
    held_fail(Address),
    tell_waiters(missed, Address).

tell_waiters(Result, Address) :-
    findall(Queue, waiter(Address, Queue), Queues),
    retractall(waiter(Address, _)),
    forall(member(Queue, Queues), tell_waiter(Queue, Result)).

tell_waiter(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

		 /*******************************
		 *           SESSIONS           *
		 *******************************/

%   One with something unfinished is connected again. The others are kept
%   for the sake of their counts: the peer may be cut off only, and come
%   back with frames that have arrived before.

without_connection(Session) :-
    unfinished(Session),
    !,
    (   route(Address, Session),
        \+ quest(Address, _, _, _)
    ->  get_time(Now),
        go_on(Address, Now, 0.05, none)
    ;   true
    ).
without_connection(session(Key, _, _, _, _)) :-
    retractall(resting(Key)),
    assertz(resting(Key)),
    predicate_property(resting(_), number_of_clauses(Count)),
    setting(resting, Max),
    (   Count > Max,
        retract(resting(Oldest)),
        session(Oldest, Session)
    ->  aside(forget(Session))
    ;   true
    ).

forget(Session) :-
    arg(1, Session, Key),
    session_adopting(Session,
                     (   ( session_up(Key) ; unfinished(Session) )
                     ->  true
                     ;   ignore(session_close(Session, _))
                     )).

gone(Key) :-
    retractall(resting(Key)),
    (   session(Key, Session)
    ->  aside(part(Session))
    ;   true
    ).

%   Whoever waits for an answer is told, whatever happens.

part(Session) :-
    sig_atomic(( session_adopting(Session,
                                  ( session_retire(Session),
                                    session_close(Session, Unsent) )),
                 requests_lost(Session, Unsent) )).

:- meta_predicate aside(0).

aside(Goal) :-
    catch(crew_spawn(Goal, _), error(_, _), ignore(Goal)).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
