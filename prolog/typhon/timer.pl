:- module(typhon_timer,
          [ timer_start/0,
            timer_stop/0,
            timer_check/0,
            alarm_set/3,                % +Stamp, +Agent, +Token
            alarm_clear/3,              % +Stamp, +Agent, +Token
            alarm_count/2               % -Alarms, -Indexed
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(rbtrees),
              [ ord_list_to_rbtree/2, rb_insert/4, rb_delete/3, rb_min/3,
                rb_size/2 ]).

/** <module> The timer: alarms that go off

An alarm is a fact: at Stamp, fire(Agent, Token) is to be called.  The
timer is a thread that has an index of the stamps on its stack and waits
for the first of them.

An alarm whose purpose is over does no harm, so nobody need clear it: the
rooms that set alarms say with over/2 which are, and the timer forgets
these when as many have been set as there were alarms.  Thus it never
holds more than twice those that count, and some hundreds.

What sets an alarm first notes what the alarm is for: over/2 may be asked
at once.

Most alarms never go off, so setting one seldom wakes the timer: its stamp
is put in a queue, which the timer empties when it wakes; it is woken for
one that comes before the next, and when the queue grows long.

*Threading*: alarms from any thread; they are facts before the timer hears
of them.  The flag typhon_next says what the timer waits for; it is written
before the timer looks at the queue for the last time, and read by who sets
an alarm after it was put there: so one of the two sees the other.

The index is the timer's own, and only says what the facts say.  So whatever
happens to the timer, no alarm is lost with it: after an error it makes a
new index; where that would not fit on its stack it does with the first
stamp; when its thread ends nevertheless, another begins with the same
facts.  If no thread can be made, whoever sets the next alarm tries again,
as do idle workers (timer_check/0).
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    typhon_scheduler:over/2,            % Agent, Token: nobody waits for it
    prolog:message//1.

:- dynamic
    alarm/3,                            % Stamp, Agent, Token
    timing/0,                           % between start and stop
    timer/1,                            % Thread
    new/1,                              % Queue of stamps
    told/0.                             % that there is no timer

                /*******************************
                *        START AND STOP        *
                *******************************/

%!  timer_start is det.

timer_start :-
    with_mutex(typhon_timer,
               ( message_queue_create(New),
                 assertz(new(New)),
                 announce(inf),
                 assertz(timing),
                 new_timer )).

new_timer :-
    (   thread_property(_, alias(typhon_timer))
    ->  Alias = []                      % of one that is about to end
    ;   Alias = [alias(typhon_timer)]
    ),
    thread_create(tick, Timer, [at_exit(typhon_timer:timer_ended)|Alias]),
    assertz(timer(Timer)),
    retractall(told).

%!  timer_stop is det.
%
%   End the timer, and forget all alarms.

timer_stop :-
    with_mutex(typhon_timer,
               ( retractall(timing),
                 findall(Timer, timer(Timer), Timers),
                 retractall(timer(_)) )),
    maplist(end_timer, Timers),
    forall(retract(new(New)), message_queue_destroy(New)),
    retractall(alarm(_, _, _)),
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

%!  alarm_set(+Stamp, +Agent, +Token) is det.
%
%   Have fire(Agent, Token) called at the real time Stamp.

alarm_set(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    (   known(Stamp, Agent, Token)
    ->  true
    ;   assertz(alarm(Stamp, Agent, Token)),
        put(Stamp)
    ).

known(Stamp, Agent, Token) :-
    (   alarm(Stamp, Agent, Token)
    ;   \+ timing
    ),
    !.

%!  alarm_clear(+Stamp, +Agent, +Token) is det.

alarm_clear(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    retractall(alarm(Stamp, Agent, Token)).

%!  alarm_count(-Alarms, -Indexed) is det.
%
%   How many alarms there are, and how many stamps in the timer's index;
%   for tests.

alarm_count(Alarms, Indexed) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( tell_timer(count(Queue)),
          thread_get_message(Queue, Indexed) ),
        message_queue_destroy(Queue)),
    count(Alarms).

put(Stamp) :-
    new(New),
    !,
    catch(thread_send_message(New, Stamp), error(existence_error(_, _), _),
          true),                        % stopping
    (   urgent(Stamp, New)
    ->  tell_timer(look)
    ;   timer(_)
    ->  true
    ;   timer_check
    ).
put(_).

urgent(Stamp, _) :-
    flag(typhon_next, Next, Next),
    Stamp < Next,
    !.
urgent(_, New) :-
    most_new(Most),
    message_queue_property(New, size(Size)),
    Size > Most.

most_new(500).

tell_timer(Message) :-
    (   timer(Timer)
    ->  tell(Timer, Message)
    ;   timer_check
    ).

tell(Timer, Message) :-
    catch(thread_send_message(Timer, Message),
          error(existence_error(_, _), _),
          true).

                /*******************************
                *           THE TIMER          *
                *******************************/

%   tick: one index after another, until it is told to stop.  What is
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
    index(Index),
    tick(Index).

tick(Index0) :-
    new(New),
    empty(New, Index0, Index1),
    first(Index1, Stamp),
    announce(Stamp),
    (   message_queue_property(New, size(Size)),
        Size > 0
    ->  tick(Index1)
    ;   turn(Stamp, Index1, Index),
        (   Index == stop
        ->  true
        ;   tick(Index)
        )
    ).

turn(Stamp, Index0, Index) :-
    (   hear(Stamp, Message)
    ->  heard(Message, Index0, Index)
    ;   rung(Stamp, Index0, Index)
    ).

empty(New, Index0, Index) :-
    (   thread_peek_message(New, _)
    ->  thread_get_message(New, Stamp),
        insert(Index0, Stamp, Index1),
        empty(New, Index1, Index)
    ;   Index = Index0
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

%   What is due may have been cleared.

rung(Stamp, Index0, Index) :-
    get_time(Now),
    Stamp =< Now,
    !,
    findall(Alarm, clause(alarm(Stamp, _, _), true, Alarm), Alarms),
    maplist(go_off, Alarms),
    delete(Index0, Stamp, Index).
rung(_, Index, Index).

%   An alarm goes off once, whatever signals the timer.

go_off(Alarm) :-
    sig_atomic(( take(Alarm, Agent, Token)
               ->  catch(ignore(typhon_scheduler:fire(Agent, Token)), Ball,
                         print_message(error, typhon(timer(Ball))))
               ;   true
               )).

take(Alarm, Agent, Token) :-
    clause(alarm(_, Agent, Token), true, Alarm),
    catch(erase(Alarm), error(existence_error(_, _), _), fail).

                /*******************************
                *            INDEX             *
                *******************************/

%   index(-Index): it holds all the stamps in alarm/3, and some more, and
%   is to be made anew when Left more have been set.  It is
%   index(Stamps, Left), a tree, or least(Stamp, Left), only the first,
%   where a tree would fill the stack.  Then the next is looked for when
%   that has gone off.

index(Index) :-
    forall(clause(alarm(_, Agent, Token), true, Alarm),
           forget_if_over(Alarm, Agent, Token)),
    count(Count),
    More is max(500, Count),
    current_prolog_flag(stack_limit, Bytes),
    Room is Bytes//512-Count,
    (   Room > 0
    ->  tree(Stamps),
        Left is min(Room, More),
        Index = index(Stamps, Left)
    ;   print_message(warning, typhon(no_index(Count))),
        least(Stamp),
        Index = least(Stamp, More)
    ).

tree(Stamps) :-
    findall(Stamp, alarm(Stamp, _, _), List),
    sort(List, Set),
    pairs_keys_values(Pairs, Set, Set),
    ord_list_to_rbtree(Pairs, Stamps).

least(Stamp) :-
    Least = least(inf),
    forall(( alarm(Stamp0, _, _), arg(1, Least, Stamp1), Stamp0 < Stamp1 ),
           nb_setarg(1, Least, Stamp0)),
    arg(1, Least, Stamp).

%   This is slow: clauses are counted.

count(Count) :-
    (   predicate_property(alarm(_, _, _), number_of_clauses(Count0))
    ->  Count = Count0
    ;   Count = 0
    ).

forget_if_over(Alarm, Agent, Token) :-
    (   catch(typhon_scheduler:over(Agent, Token), error(_, _), fail)
    ->  catch(erase(Alarm), error(existence_error(_, _), _), true)
    ;   true
    ).

insert(least(_, 0), _, Index) :-
    !,
    index(Index).
insert(least(Stamp0, Left0), Stamp1, least(Stamp, Left)) :-
    Left is Left0-1,
    Stamp is min(Stamp0, Stamp1).
insert(index(_, 0), _, Index) :-
    !,
    index(Index).
insert(index(Stamps0, Left0), Stamp, index(Stamps, Left)) :-
    Left is Left0-1,
    rb_insert(Stamps0, Stamp, Stamp, Stamps).

delete(least(_, Left), _, least(Stamp, Left)) :-
    least(Stamp).
delete(index(Stamps0, Left), Stamp, index(Stamps, Left)) :-
    (   rb_delete(Stamps0, Stamp, Stamps)
    ->  true
    ;   Stamps = Stamps0
    ).

%   first(+Index, -Stamp): `inf` if there is none.

first(least(Stamp, _), Stamp).
first(index(Stamps, _), Stamp) :-
    (   rb_min(Stamps, First, _)
    ->  Stamp = First
    ;   Stamp = inf
    ).

index_size(least(_, _), 1).
index_size(index(Stamps, _), Size) :-
    rb_size(Stamps, Size).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(timer(Ball))) -->
    [ 'An alarm met with an error; the timer goes on', nl ],
    '$messages':translate_message(Ball).
prolog:message(typhon(timer_ended)) -->
    [ 'The timer has ended; another goes on with its alarms' ].
prolog:message(typhon(no_timer(Formal))) -->
    [ 'There is no timer, and none can be made (~p): \c
       alarms wait until one can'-[Formal] ].
prolog:message(typhon(no_index(Count))) -->
    [ 'The timer has no room for an index of ~D alarms, and is slow'-
      [Count] ].
