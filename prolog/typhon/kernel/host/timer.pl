:- module(typhon_timer,
          [ timer_start/0,
            timer_stop/0,
            timer_check/0,
            timer_alarm/3,              % +Stamp, +Agent, +Token
            alarms_overdue/0
          ]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/server',
              [ server_answer/2, server_cast/2, server_check/1,
                server_start/4, server_stop/1 ]).
:- use_module(alarms,
              [ alarm_add/3, alarms_begin/0, alarms_end/0, alarms_go_off/1,
                alarms_new/1, alarms_renew/1, index_delete/3,
                index_first/2, index_make/1, index_size/2, index_update/2 ]).
:- use_module(turns, [turns_paused/0]).

/** <module> The timer: a server that sets alarms off

The timer has an index of the stamps of all alarms and waits for the first of
them.  A module records the purpose of an alarm before it sets it: the timer
may call over/2 at once.

Most alarms never go off, so setting one seldom wakes the timer: only if it is
earlier than the next one, or if the timer has many new stamps to read.

No alarm is lost if the timer fails: it starts again with a new index.

*Threading*: any thread sets alarms.  The flag typhon_next holds the stamp that
the timer waits for.  The timer writes it before it looks for new alarms for
the last time, and a thread that adds an alarm reads it after that: so one of
the two sees the other.
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    prolog:message//1.

:- dynamic
    timer/1.                            % Server

                /*******************************
                *        START AND STOP        *
                *******************************/

%!  timer_start is det.

timer_start :-
    alarms_begin,
    announce(inf),
    server_start(timer, typhon_timer:timed, none, Timer),
    assertz(timer(Timer)).

%!  timer_stop is det.
%
%   Stop the timer and delete all alarms.

timer_stop :-
    (   retract(timer(Timer))
    ->  server_stop(Timer)
    ;   true
    ),
    alarms_end.

%!  timer_check is det.
%
%   If the timer has been started, and has lost its thread, create another.

timer_check :-
    (   timer(Timer)
    ->  server_check(Timer)
    ;   true
    ).

                /*******************************
                *            ALARMS            *
                *******************************/

%!  timer_alarm(+Stamp, +Agent, +Token) is det.
%
%   Set an alarm that calls fire(Agent, Token) at Stamp, a monotonic_time/1.

timer_alarm(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    (   timer(Timer),
        alarm_add(Stamp, Agent, Token)
    ->  hasten(Stamp, Timer)
    ;   true
    ).

hasten(Stamp, Timer) :-
    (   urgent(Stamp)
    ->  ignore(server_cast(Timer, look))
    ;   server_check(Timer)
    ).

urgent(Stamp) :-
    get_flag(typhon_next, Next),
    Stamp < Next,
    !.
urgent(_) :-
    alarms_new(Count),
    Count > 500.

%!  alarms_overdue is det.
%
%   Set off the alarms that were due while turns were paused.

alarms_overdue :-
    (   timer(Timer)
    ->  monotonic_time(Now),
        alarms_renew(Now),
        ignore(server_cast(Timer, look))
    ;   true
    ).

                /*******************************
                *           THE TIMER          *
                *******************************/

:- public timed/3.

%   Only the wait of the timer is interrupted when Prolog halts: 9.0.4 reports
%   an exception that arrives in the middle of a predicate written in C, and
%   loses it.

timed(Message, Index, Next) :-
    sig_atomic(handled(Message, Index, Next)).

handled(begin, _, Next) :-
    index_make(Index),
    wait_for_next(Index, Next).
handled(timeout, Index0, Next) :-
    index_first(Index0, Stamp),
    alarms_if_due(Stamp, Index0, Index),
    wait_for_next(Index, Next).
handled(look, Index, Next) :-
    wait_for_next(Index, Next).
handled(call(count, Caller), Index, Next) :-
    index_size(Index, Size),
    server_answer(Caller, Size),
    wait_for_next(Index, Next).

wait_for_next(Index0, until(Stamp, Index)) :-
    index_update(Index0, Index1),
    index_first(Index1, First),
    announce(First),
    (   alarms_new(0)
    ->  Stamp = First,
        Index = Index1
    ;   wait_for_next(Index1, until(Stamp, Index))
    ).

announce(Stamp) :-
    Next is min(Stamp, 1.0e300),
    set_flag(typhon_next, Next).

alarms_if_due(Stamp, Index0, Index) :-
    monotonic_time(Now),
    Stamp =< Now,
    !,
    (   turns_paused
    ->  true                            % they go off after the pause
    ;   alarms_go_off(Stamp)
    ),
    index_delete(Index0, Stamp, Index).
alarms_if_due(_, Index, Index).
