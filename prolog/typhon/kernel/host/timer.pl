:- module(typhon_timer,
          [ timer_start/0,
            timer_stop/0,
            timer_check/0,
            timer_alarm/3,              % +Stamp, +Agent, +Token
            alarms_overdue/0,
            alarm_count/2               % -Alarms, -Indexed
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [error_told/3]).
:- use_module(alarms,
              [ alarm_add/3, alarm_anew/1, alarm_new/1, alarm_take/3,
                alarms_at/2, alarms_begin/0, alarms_end/0, alarms_new/1,
                alarms_number/1, alarms_until/2 ]).
:- use_module(pause, [still/0]).
:- use_module(alarm_index,
              [ index_delete/3, index_first/2, index_insert/3, index_make/1,
                index_size/2 ]).

/** <module> The timer: a thread that sets alarms off

It has an index of the stamps of all alarms on its stack and waits for the
first of them.  What sets an alarm first notes what the alarm is for: over/2
may be asked at once.

Most alarms never go off, so setting one seldom wakes the timer: only one
that comes before the next does, and many that it has not heard of yet.

*Threading*: alarms from any thread.  The flag typhon_next says what the
timer waits for; it is written before the timer looks for new alarms for the
last time, and read by a thread that adds one after that: so one of the two sees the
other.

Whatever happens to the timer, no alarm is lost with it: after an error it
makes a new index; when its thread ends nevertheless, another begins.  If no
thread can be made, whoever sets the next alarm tries again, as do idle
workers (timer_check/0).
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    prolog:message//1.

:- dynamic
    timing/0,                           % between start and stop
    timer/1,                            % Thread
    told/0.                             % that there is no timer

                /*******************************
                *        START AND STOP        *
                *******************************/

%!  timer_start is det.

timer_start :-
    with_mutex(typhon_timer,
               ( alarms_begin,
                 announce(inf),
                 assertz(timing),
                 new_timer )).

new_timer :-
    alias(Alias),
    thread_create(tick, Timer,
                  [alias(Alias), at_exit(typhon_timer:timer_ended)]),
    assertz(timer(Timer)),
    retractall(told).

%   One that is about to end may have the name still.

alias(typhon_timer) :-
    \+ thread_property(_, alias(typhon_timer)),
    !.
alias(Alias) :-
    flag(typhon_timer, N, N+1),
    atom_concat(typhon_timer_, N, Alias).

%!  timer_stop is det.
%
%   End the timer, and forget all alarms.

timer_stop :-
    with_mutex(typhon_timer,
               ( retractall(timing),
                 findall(Timer, timer(Timer), Timers),
                 retractall(timer(_)) )),
    maplist(end_timer, Timers),
    alarms_end,
    retractall(told).

%   One that ends just now by itself can be joined as well.

end_timer(Timer) :-
    tell(Timer, stop),
    thread_join(Timer, _).

%   The timer has ended, and was not told to.

timer_ended :-
    thread_self(Me),
    with_mutex(typhon_timer, disowned(Me)),
    !,
    timer_check.
timer_ended.

disowned(Me) :-
    retract(timer(Me)),
    thread_detach(Me).

%!  timer_check is det.
%
%   If there should be a timer, but is none, make one.

timer_check :-
    (   timing,
        \+ timer(_)
    ->  with_mutex(typhon_timer, replace_timer)
    ;   true
    ).

replace_timer :-
    timing,
    \+ timer(_),
    !,
    catch(( new_timer,
            print_message(error, typhon(timer_ended)) ),
          error(Formal, _),
          no_timer(Formal)).
replace_timer.

no_timer(permission_error(create, thread, _)) :-
    !.                                  % Prolog is halting
no_timer(_) :-
    told,
    !.
no_timer(Formal) :-
    assertz(told),
    print_message(error, typhon(no_timer(Formal))).

                /*******************************
                *            ALARMS            *
                *******************************/

%!  timer_alarm(+Stamp, +Agent, +Token) is det.
%
%   Have fire(Agent, Token) called at Stamp, of the time of day.

timer_alarm(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    (   timing,
        alarm_add(Stamp, Agent, Token)
    ->  hasten(Stamp)
    ;   true
    ).

%!  alarms_overdue is det.
%
%   Those that could not go off while the process was still do so.

alarms_overdue :-
    get_time(Now),
    alarms_until(Now, Stamps),
    forall(member(Stamp, Stamps), alarm_anew(Stamp)),
    tell_timer(look).

%!  alarm_count(-Alarms, -Indexed) is det.
%
%   How many alarms, and how many stamps in the index; for tests.

alarm_count(Alarms, Indexed) :-
    setup_call_cleanup(message_queue_create(Queue),
                       ( tell_timer(count(Queue)),
                         thread_get_message(Queue, Indexed) ),
                       message_queue_destroy(Queue)),
    alarms_number(Alarms).

hasten(Stamp) :-
    (   urgent(Stamp)
    ->  tell_timer(look)
    ;   timer_check
    ).

urgent(Stamp) :-
    flag(typhon_next, Next, Next),
    Stamp < Next,
    !.
urgent(_) :-
    alarms_new(Count),
    Count > 500.

tell_timer(Message) :-
    timer(Timer),
    !,
    tell(Timer, Message).
tell_timer(_) :-
    timer_check.

tell(Timer, Message) :-
    catch(thread_send_message(Timer, Message),
          error(existence_error(_, _), _), true).

                /*******************************
                *           THE TIMER          *
                *******************************/

%   tick: one index after another, until the message to stop.  What is
%   thrown at the timer has no meaning for it, but `abort`, which ends it.

tick :-
    repeat,
    catch(ticking, Ball, survive(Ball)),
    !.

survive(Ball) :-
    unwinding(Ball),
    !,
    throw(Ball).
survive(Ball) :-
    print_message(error, typhon(timer(Ball))),
    \+ timing.

unwinding('$aborted').
unwinding(unwind(_)).                   % SWI-Prolog 9.3 and later

ticking :-
    index_make(Index),
    tick(Index).

tick(Index0) :-
    hear_new(Index0, Index1),
    index_first(Index1, Stamp),
    announce(Stamp),
    (   alarms_new(0)
    ->  turn(Stamp, Index1, Index),
        (   Index == stop
        ->  true
        ;   tick(Index)
        )
    ;   tick(Index1)
    ).

hear_new(Index0, Index) :-
    (   alarm_new(Stamp)
    ->  index_insert(Index0, Stamp, Index1),
        hear_new(Index1, Index)
    ;   Index = Index0
    ).

turn(Stamp, Index0, Index) :-
    (   hear(Stamp, Message)
    ->  heard(Message, Index0, Index)
    ;   rung(Stamp, Index0, Index)
    ).

announce(Stamp) :-
    flag(typhon_next, _, min(Stamp, 1.0e300)).

%   No wait is longer than a day: the system may not know so late a time.

hear(inf, Message) :-
    !,
    thread_get_message(Message).
hear(Stamp, Message) :-
    thread_self(Me),
    get_time(Now),
    Deadline is min(Stamp, Now+86400),
    thread_get_message(Me, Message, [deadline(Deadline)]).

heard(stop, _, stop) :-
    \+ timing,
    !.
heard(count(Queue), Index, Index) :-
    !,
    index_size(Index, Size),
    thread_send_message(Queue, Size).
heard(_, Index, Index).

rung(Stamp, Index0, Index) :-
    get_time(Now),
    Stamp =< Now,
    !,
    (   still
    ->  true                            % they go off when that is over
    ;   alarms_at(Stamp, Alarms),
        maplist(go_off, Alarms)
    ),
    index_delete(Index0, Stamp, Index).
rung(_, Index, Index).

%   An alarm goes off once, whatever signals the timer.

go_off(Alarm) :-
    sig_atomic(( alarm_take(Alarm, Agent, Token)
               ->  debug(typhon(scheduler), 'alarm ~p of ~p', [Token, Agent]),
                   catch(ignore(typhon_scheduler:fire(Agent, Token)), Ball,
                         print_message(error, typhon(timer(Ball))))
               ;   true
               )).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(timer(Ball))) -->
    [ 'An alarm met with an error; the timer goes on', nl ],
    error_told(Ball).
prolog:message(typhon(timer_ended)) -->
    [ 'The timer has ended; another goes on with its alarms' ].
prolog:message(typhon(no_timer(Formal))) -->
    [ 'There is no timer, and none can be made (~p): \c
       alarms wait until one can'-[Formal] ].
