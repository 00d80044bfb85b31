:- module(typhon_pool, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/bounds', [memory_short/0]).
:- use_module('../base/own_thread', [stop_thread/1]).
:- use_module(alarms, [alarm_stamp/3]).
:- use_module(blocked,
              [ blocked_forget/0, blocked_full/2, blocked_held/1,
                blocked_kind/1, blocked_release/1, blocked_room/3 ]).
:- use_module(time, [alarm_in/3, time_day_wait/3]).
:- use_module(timer,
              [ alarms_overdue/0, timer_alarm/3, timer_check/0, timer_start/0,
                timer_stop/0 ]).
:- use_module(turns,
              [turn_if_short/2, turn_in/3, turns_go_on/1, turns_pause/0]).
:- use_module(scheduler, [work_do/2]).

/** <module> The runtime `real`: a pool of few threads for many agents

Work waits in the run queue.  A worker takes work, runs the agent until it has
to wait, and takes the next.

The pool grows when the queue is stuck: work waits, and no worker has begun a
turn for `stuck_seconds`.  At most `max_workers` workers are not blocked by
native goals, see module `blocked`.  A worker that has been idle for long ends
if there are enough others.

*Threading*: any thread.  The mutex of the scheduler makes starting and
stopping the pool atomic: no worker is added after the run queue is gone.
*/

:- multifile
    typhon_scheduler:fire/2,    % Agent, Token: an alarm went off
    typhon_time:adopt/2,
    typhon_time:alarm/4,
    typhon_time:alone/1,
    typhon_time:due/4,
    typhon_time:here/3,
    typhon_time:hold/2,
    typhon_time:leave/1,
    typhon_time:let_go/2,
    typhon_time:signal/2,
    typhon_time:starts/1,
    typhon_time:stops/1,
    typhon_time:wait/4,
    typhon_time:work/2.

:- setting(typhon_scheduler:min_workers, positive_integer, 2,
           "Workers kept when idle").
:- setting(typhon_scheduler:max_workers, positive_integer, 256,
           "Maximum number of workers, not counting blocked ones").
:- setting(typhon_scheduler:idle_seconds, number, 10,
           "Idle workers beyond the minimum end").
:- setting(typhon_scheduler:stuck_seconds, number, 0.01,
           "Seconds without a new turn after which the pool grows").

:- dynamic
    run_queue/1,                % Queue
    worker/1.                   % Thread

                /*******************************
                *        START AND STOP        *
                *******************************/

%   Start or stop workers and timer; does nothing if they run, or are stopped.

typhon_time:starts(real) :-
    with_mutex(typhon_scheduler, start).

start :-
    run_queue(_),
    !.
start :-
    message_queue_create(Queue),
    assertz(run_queue(Queue)),
    set_flag(typhon_pool_looks, 0),
    set_flag(typhon_pool_releases, 0),
    setting(typhon_scheduler:min_workers, N),
    catch(( timer_start,
            forall(between(1, N, _), add_worker(Queue)) ),
          error(Formal, Context),
          ( stop,
            throw(error(Formal, Context)) )).

typhon_time:stops(real) :-
    stop.

stop :-
    with_mutex(typhon_scheduler, retract(run_queue(Queue))),
    !,
    timer_stop,
    end_workers(Queue),
    message_queue_destroy(Queue),
    blocked_forget,
    turns_go_on(_).
stop.

%   Workers get the order to stop; then those that are busy are interrupted.

end_workers(Queue) :-
    findall(Worker, worker(Worker), Workers),
    forall(member(_, Workers), thread_send_message(Queue, stop)),
    maplist(stop_thread, Workers),
    retractall(worker(_)).

typhon_time:signal(real, Goal) :-
    forall(worker(Worker),
           catch(thread_signal(Worker, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *         THE RUN QUEUE        *
                *******************************/

typhon_time:work(real, Work) :-
    enqueue(Work).

enqueue(Work) :-
    run_queue(Queue),
    !,
    thread_send_message(Queue, Work),
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   look_soon
    ).
enqueue(_).                             % the pool is stopping

typhon_time:alone(real) :-
    run_queue(Queue),
    message_queue_property(Queue, size(0)).

waits(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   The calling thread is not in the pool, so it gets only short turns.

typhon_time:here(real, Agents, Turn) :-
    turn_if_short(Agents, Turn).

                /*******************************
                *         ALARMS, WAITING      *
                *******************************/

typhon_time:alarm(real, Stamp, Agent, Token) :-
    timer_alarm(Stamp, Agent, Token).

typhon_time:due(real, Agent, Token, Stamp) :-
    alarm_stamp(Stamp, Agent, Token).

typhon_time:wait(real, Queue, Message, Stamp) :-
    time_day_wait(Queue, Message, Stamp).

typhon_time:hold(real, _) :-
    turns_pause.

typhon_time:let_go(real, Agents) :-
    turns_go_on(Agents),
    alarms_overdue.

                /*******************************
                *            WORKERS           *
                *******************************/

workers_count(Count) :-
    predicate_property(worker(_), number_of_clauses(Count)),
    !.
workers_count(0).

%   @error resource_error(What) where no thread can be created

add_worker(Queue) :-
    flag(typhon_worker, N, N+1),
    atom_concat(typhon_worker_, N, Alias),
    thread_create(serve(Queue), Worker,
                  [ alias(Alias), at_exit(typhon_pool:replace_worker) ]),
    assertz(worker(Worker)).

%   Called when a worker was aborted in the middle of a goal.  If no thread can
%   be created now, the pool grows when the queue is stuck.

replace_worker :-
    thread_self(Me),
    with_mutex(typhon_scheduler, replace_worker(Me)).

replace_worker(Me) :-
    run_queue(Queue),
    retract(worker(Me)),
    !,
    debug(typhon(scheduler), '~w has ended', [Me]),
    thread_detach(Me),
    catch(add_worker(Queue), error(_, _), true).
replace_worker(_).

%   The setting is looked up once for each idle period, not for each turn.

serve(Queue) :-
    setting(typhon_scheduler:idle_seconds, Seconds),
    serve(Queue, Seconds).

serve(Queue, Seconds) :-
    (   thread_get_message(Queue, Work, [timeout(Seconds)])
    ->  look_if_last(Queue),
        serve(Work, Queue, Seconds)
    ;   timer_check,
        (   superfluous
        ->  look_if_work_waits(Queue)   % that work may have woken this worker
        ;   serve(Queue)
        )
    ).

serve(stop, _, _) :-
    !.
serve(Work, Queue, Seconds) :-
    (   blocked_kind(_),
        blocked_held(Work)
    ->  true
    ;   work_do(Work, enqueue)
    ),
    serve(Queue, Seconds).

superfluous :-
    thread_self(Me),
    with_mutex(typhon_scheduler, superfluous(Me)).

superfluous(Me) :-
    run_queue(_),
    workers_count(Count),
    setting(typhon_scheduler:min_workers, Min),
    Count > Min,
    retract(worker(Me)),
    thread_detach(Me),
    debug(typhon(scheduler), '~w ends, of ~D workers', [Me, Count]).

%   Thread becomes a worker for a while, and no other thread joins it.

typhon_time:adopt(real, Thread) :-
    with_mutex(typhon_scheduler, adopt(Thread)).

adopt(Thread) :-
    (   run_queue(_)
    ->  assertz(worker(Thread))
    ;   thread_detach(Thread)
    ).

typhon_time:leave(real) :-
    thread_self(Me),
    with_mutex(typhon_scheduler, leave(Me)).

leave(Me) :-
    (   run_queue(_),
        retract(worker(Me))
    ->  prolog_listen(this_thread_exit, thread_detach(Me))
                                        % an abort is not reported then
    ;   true                            % stopping the pool joins it
    ).

                /*******************************
                *            GROWTH            *
                *******************************/

%   Called when a worker has taken work, or ends.  Work that was queued while a
%   worker was idle may find no idle worker when its turn comes.

look_if_last(Queue) :-
    (   message_queue_property(Queue, size(0))
    ->  true
    ;   message_queue_property(Queue, waiting(_))
    ->  true
    ;   look_soon
    ).

look_if_work_waits(Queue) :-
    (   waits(Queue)
    ->  look_soon
    ;   true
    ).

%   Only one such alarm is set at a time. get_flag/2 comes first, because a
%   write to a flag takes a system mutex.

look_soon :-
    (   get_flag(typhon_pool_looks, 1)
    ->  true
    ;   setting(typhon_scheduler:stuck_seconds, Seconds),
        look_in(Seconds)
    ).

look_in(Seconds) :-
    flag(typhon_pool_looks, Looks, 1),
    (   Looks =:= 0
    ->  monotonic_time(Now),
        alarm_in(Seconds, pool, stuck(Now))
    ;   true
    ).

typhon_scheduler:fire(pool, stuck(Since)) :-
    !,
    set_flag(typhon_pool_looks, 0),
    (   run_queue(Queue),
        waits(Queue)
    ->  with_mutex(typhon_scheduler, grow_if_stuck(Queue, Since, Seconds)),
        look_in(Seconds),
        release_later
    ;   true
    ).
typhon_scheduler:fire(pool, release) :-
    !,
    set_flag(typhon_pool_releases, 0),
    (   run_queue(Queue),
        mostly_free(Queue)
    ->  blocked_release(Works),
        maplist(enqueue, Works)
    ;   release_later
    ).

%   grow_if_stuck(+Queue, +Since, -Seconds): check again in Seconds.

grow_if_stuck(Queue, Since, Seconds) :-
    findall(Worker, worker(Worker), Workers),
    \+ turn_since(Workers, Since),
    \+ grow(Queue, Workers),
    !,
    setting(typhon_scheduler:blocked_seconds, Blocked),
    Seconds is Blocked/4.
grow_if_stuck(_, _, Seconds) :-
    setting(typhon_scheduler:stuck_seconds, Seconds).

turn_since(Workers, Since) :-
    member(Worker, Workers),
    turn_in(Worker, _, Began),
    Began > Since,
    !.

%   Fails when the pool is full, no thread can be created, or memory is short.

grow(Queue, Workers) :-
    run_queue(Queue),
    setting(typhon_scheduler:max_workers, Max),
    blocked_room(Workers, Max, Room),
    length(Workers, Count),
    More is min(Room, 1+Count//8),
    More > 0,
    debug(typhon(scheduler), '~D workers, and ~D more', [Count, More]),
    forall(between(1, More, _), add_if_possible(Queue, Workers)).

add_if_possible(Queue, Workers) :-
    (   memory_short
    ->  Why = no_memory
    ;   catch(add_worker(Queue), error(resource_error(Why), _), true)
    ),
    (   var(Why)
    ->  true
    ;   blocked_full(Workers, Why),
        fail
    ).

%   Check again later while kinds of work are held.

release_later :-
    (   blocked_kind(_),
        flag(typhon_pool_releases, 0, 1)
    ->  setting(typhon_scheduler:blocked_seconds, Seconds),
        alarm_in(Seconds, pool, release)
    ;   true
    ).

mostly_free(Queue) :-
    workers_count(Count),
    message_queue_property(Queue, waiting(Idle)),
    setting(typhon_scheduler:max_workers, Max),
    Count-Idle < min(Max, (Count+1)//2).
