:- module(typhon_quest,
          [ quest_wait/2,               % +Address, +Queue
            quest_send/1,               % +Address
            quest_again/1,              % +Session
            quest_begin/1,              % +Me
            quest_up/1,                 % +Key
            quest_greeted/1,            % +Thread
            quest_ended/2,              % +Thread, +Formal
            quest_due/1,                % -Time
            quest_overdue/1,            % +Me
            quest_give_up/0,
            quest_tell/2,               % +Queue, +Result
            unfinished/1                % +Session
          ]).

/** <module> Quests: how peers are reached

For each address that somebody wants to reach there is a quest: attempts to
connect, with growing pauses, until there is a session that is up, whoever
gave it its connection. Those who wait hear that it is up, or that there can
be none. The quest of a session with something to send or to hear goes on.

What may pass, as when a peer breaks off before we have met, is tried again
while there is time. All else, nobody listening first of all, is told at
once.

_Threading_: the thread of the keeper owns all that is here, but quest_tell/2
and unfinished/1, which any thread may call.
*/

:- use_module(library(lists), [member/2, min_member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(connection, [outgoing/2]).
:- use_module(outbox, [session_pending/2, session_up/1]).
:- use_module(request, [requests_open/1]).
:- use_module(session, [route/2, session/2]).
:- use_module(threads, [crew_aside/1, crew_retire/2, crew_spawn/2]).
:- use_module(unsent, [unsent_fail/1, unsent_send/2]).

:- setting(typhon_keeper:connect_time, number, 5,
           "Seconds until it is told that a peer cannot be reached").

:- dynamic
    waiter/2,                           % Address, Queue
    quest/4.                            % Address, State, Pause, Since

%   The State of a quest is `queued`, trying(Thread, Start) or
%   pausing(Until). Somebody has waited Since then, `unset` before the first
%   attempt, `none` if nobody does.

first_pause(0.02).
longest_pause(2).

%   Where there are many processes they may all be busy at once, as they are
%   when they begin: then it takes longer until silence means something.

patience(Seconds) :-
    setting(typhon_keeper:connect_time, Seconds0),
    predicate_property(quest(_, _, _, _), number_of_clauses(Quests)),
    predicate_property(session(_, _), number_of_clauses(Sessions)),
    Seconds is Seconds0*min(4, 1+(Quests+Sessions)//16).

		 /*******************************
		 *          WHO WANTS           *
		 *******************************/

%!  quest_wait(+Address, +Queue) is det.
%
%   Queue hears `met` or `missed`.

quest_wait(Address, Queue) :-
    (   up(Address, _)
    ->  quest_tell(Queue, met)
    ;   assertz(waiter(Address, Queue)),
        want(Address)
    ).

%!  quest_send(+Address) is det.
%
%   Send what is held for Address when there is a session, see unsent.pl.

quest_send(Address) :-
    (   up(Address, Session)
    ->  unsent_send(Address, Session)
    ;   want(Address)
    ).

%   Who comes later waits with the first.

want(Address) :-
    quest(Address, _, _, Since),
    Since \== none,
    !.
want(Address) :-
    first_pause(Pause),
    (   quest(Address, trying(Thread, Start), _, _)
    ->  get_time(Now),
        set(Address, trying(Thread, Start), Pause, Now)
    ;   set(Address, queued, Pause, unset)
    ).

%!  quest_again(+Session) is det.
%
%   Session is unfinished: connect again.

quest_again(Session) :-
    (   route(Address, Session),
        \+ quest(Address, _, _, _)
    ->  pause(Address, 0.05, none)
    ;   true
    ).

up(Address, Session) :-
    route(Address, Session),
    arg(1, Session, Key),
    session_up(Key),
    !.

set(Address, State, Pause, Since) :-
    retractall(quest(Address, _, _, _)),
    assertz(quest(Address, State, Pause, Since)).

		 /*******************************
		 *           ATTEMPTS           *
		 *******************************/

%!  quest_begin(+Me) is det.
%
%   Begin attempts, Me being our hello. Where many processes begin at once
%   all would be late together, and of each pair both would connect. So few
%   attempts are begun at a time, by each process in an order of its own:
%   most peers come by themselves before it is their turn. The time of those
%   who wait begins with the attempt.

quest_begin(Me) :-
    quest(_, queued, _, _),
    \+ crowded,
    !,
    findall(Hash-Address,
            ( quest(Address, queued, _, _),
              term_hash(Address-Me, Hash) ),
            Queued),
    min_member(_-Next, Queued),
    try(Next, Me),
    quest_begin(Me).
quest_begin(_).

crowd(4).
crowd_seconds(2).

crowded :-
    crowd(Many),
    findall(x, young(_), Young),
    length(Young, Count),
    Count >= Many.

%   young(-Until): an attempt that may soon have ended.

young(Until) :-
    crowd_seconds(Seconds),
    get_time(Now),
    quest(_, trying(_, Start), _, _),
    Until is Start+Seconds,
    Until > Now.

try(Address, Me) :-
    quest(Address, _, Pause, Since0),
    get_time(Now),
    (   Since0 == unset
    ->  Since = Now
    ;   Since = Since0
    ),
    catch(crew_spawn(outgoing(Address, Me), Thread),
          error(Formal, _),
          Thread = none),
    set(Address, trying(Thread, Now), Pause, Since),
    (   Thread == none
    ->  verdict(Address, Formal)
    ;   true
    ).

%!  quest_greeted(+Thread) is det.
%
%   The attempt of Thread has been answered: somebody is there, and slow, as
%   all are where many begin at once. The time begins again, unless it has
%   gone wrong often.

quest_greeted(Thread) :-
    (   quest(Address, trying(Thread, _), Pause, Since),
        number(Since),
        longest_pause(Longest),
        Pause < Longest
    ->  get_time(Now),
        set(Address, trying(Thread, Now), Pause, Now)
    ;   true
    ).

%!  quest_ended(+Thread, +Formal) is det.
%
%   The attempt of Thread, if it is one, has ended without connection.

quest_ended(Thread, Formal) :-
    (   quest(Address, trying(Thread, _), _, _)
    ->  verdict(Address, Formal)
    ;   true
    ).

%   The session may be up all the same, by a connection of the peer's.

verdict(Address, _) :-
    up(Address, _),
    !,
    met(Address).
verdict(Address, Formal) :-
    quest(Address, _, Pause, Since),
    (   over(Since, Formal)
    ->  missed(Address, Formal),
        go_on(Address, Pause, none)
    ;   go_on(Address, Pause, Since)
    ).

over(Since, Formal) :-
    number(Since),
    (   \+ may_pass(Formal)
    ->  true
    ;   deadline(Since, Deadline),
        get_time(Now),
        Deadline =< Now
    ).

deadline(Since, Deadline) :-
    patience(Seconds),
    Deadline is Since+Seconds.

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
    (   Since == none,
        \+ needed(Address)
    ->  retractall(quest(Address, _, _, _))
    ;   pause(Address, Pause, Since)
    ).

pause(Address, Pause, Since) :-
    get_time(Now),
    Some is float_fractional_part(Now*1000),    % library(random) is slow
    Until0 is Now+Pause*(0.5+Some),             % to begin
    (   number(Since)
    ->  deadline(Since, Deadline),
        Until is min(Deadline, Until0)
    ;   Until = Until0
    ),
    longest_pause(Longest),
    Longer is min(Longest, 2*Pause),
    set(Address, pausing(Until), Longer, Since).

needed(Address) :-
    route(Address, Session),
    unfinished(Session),
    !.

%!  unfinished(+Session) is semidet.
%
%   There is something to send, or to hear.

unfinished(Session) :-
    session_pending(Session, Pending),
    Pending > 0,
    !.
unfinished(Session) :-
    requests_open(Session).

		 /*******************************
		 *          DEADLINES           *
		 *******************************/

%!  quest_due(-Time) is nondet.
%
%   When something has to be done. A silent attempt is given up in time for
%   another one: it may be the connection that is dead.

quest_due(Time) :-
    quest(_, State, _, Since),
    due(State, Since, Time).

due(pausing(Until), _, Until).
due(queued, _, Until) :-
    young(Until).
due(trying(_, Start), Since, Until) :-
    patience(Seconds),
    Until0 is Start+0.6*Seconds,
    (   number(Since)
    ->  Until is min(Until0, Since+Seconds)
    ;   Until = Until0
    ).

%!  quest_overdue(+Me) is det.
%
%   Do what is due.

quest_overdue(Me) :-
    get_time(Now),
    findall(Address-State,
            ( quest(Address, State, _, Since),
              State \== queued,
              due(State, Since, Until),
              Until =< Now ),
            Due),
    forall(member(Address-State, Due), overdue(Address, State, Me)).

overdue(Address, State, Me) :-
    (   \+ quest(Address, State, _, _)
    ->  true
    ;   up(Address, _)
    ->  met(Address)
    ;   late(State, Address, Me)
    ).

late(trying(Thread, _), Address, _) :-
    crew_aside(crew_retire(Thread, late)),
    verdict(Address, late).
late(pausing(_), Address, Me) :-
    quest(Address, _, _, Since),
    (   over(Since, late)
    ->  verdict(Address, late)
    ;   Since == none,
        \+ needed(Address)
    ->  retractall(quest(Address, _, _, _))
    ;   try(Address, Me)
    ).

		 /*******************************
		 *           OUTCOMES           *
		 *******************************/

%!  quest_up(+Key) is det.
%
%   The session Key has a connection: so have all addresses that lead to it.

quest_up(Key) :-
    findall(Address, route(Address, session(Key, _, _, _, _)), Addresses),
    forall(member(Address, Addresses), met(Address)).

%   It may be down again: what is sent in it comes through when it is up the
%   next time.

met(Address) :-
    retractall(quest(Address, _, _, _)),
    (   route(Address, Session)
    ->  unsent_send(Address, Session)
    ;   true
    ),
    tell_waiters(Address, met).

missed(Address, Formal) :-
    print_message(silent,
                  typhon(endpoint, unreachable(Address, Formal))),
    unsent_fail(Address),
    tell_waiters(Address, missed).

%!  quest_give_up is det.
%
%   The endpoint stops: nobody can be reached any more.

quest_give_up :-
    findall(Address, waiter(Address, _), Addresses),
    forall(member(Address, Addresses), tell_waiters(Address, missed)),
    unsent_fail(_),
    retractall(quest(_, _, _, _)).

tell_waiters(Address, Result) :-
    findall(Queue, waiter(Address, Queue), Queues),
    retractall(waiter(Address, _)),
    forall(member(Queue, Queues), quest_tell(Queue, Result)).

%!  quest_tell(+Queue, +Result) is det.
%
%   Tell who waits, and may have been interrupted.

quest_tell(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreachable(Address, Formal))) -->
    [ 'Endpoint: cannot reach ~w: ~p'-[Address, Formal] ].
