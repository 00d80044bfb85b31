:- module(typhon_scheduler,
          [ scheduler_start/0,
            scheduler_stop/0,
            scheduler_limit/2,          % +Host, +Concurrency
            scheduler_unlimit/1,        % +Host
            schedule/2,                 % +Host, +Agent
            scheduler_call/1,           % :Goal
            scheduler_signal/1,         % :Goal
            scheduler_workers/1         % -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(held).
:- use_module(limits).
:- use_module(timer, [timer_start/0, timer_stop/0, timer_check/0]).
:- reexport(timer, [alarm_set/3, alarm_clear/3]).

/** <module> The scheduler: few threads for many agents

A run queue, a pool of workers and one timer.  A worker takes an agent,
runs it to the point where it has to wait, and takes the next.  An agent
that sleeps, waits or is resident is not here at all.  A native goal that
blocks holds its worker, so the pool grows when the queue is stuck and
shrinks when workers are idle.

There are at most `max_workers`, not counting those that were held for
long, see room `held`.

What an agent is, the room above says with the hooks run/1, fire/2, over/2,
kind/2 and running/1.

*Threading*: schedule/2 and alarms from any thread.  The timer thread
decides when to grow.  A mutex makes the pool, and its end, whole: when
the run queue is gone no worker is added.
*/

:- meta_predicate
    scheduler_call(0),
    scheduler_signal(0).

:- multifile
    run/1,                      % Agent: run it until it has to wait
    fire/2,                     % Agent, Token: an alarm went off
    over/2,                     % Agent, Token: nobody waits for this alarm
    kind/2,                     % Agent, Kind: Agents that may block alike
    running/1,                  % Agent: has a worker
    prolog:message//1.

:- setting(min_workers, positive_integer, 2, "Workers kept when idle").
:- setting(max_workers, positive_integer, 256,
           "Workers at the most, but for those that were held for long").
:- setting(idle_seconds, number, 10, "Idle workers beyond the minimum end").
:- setting(stuck_seconds, number, 0.01,
           "The pool grows when the run queue has not moved for so long").

:- dynamic
    run_queue/1,                % Queue
    worker/1.                   % Thread

                /*******************************
                *        START AND STOP        *
                *******************************/

%!  scheduler_start is det.
%
%   Start the pool and the timer; nothing to do where they run.

scheduler_start :-
    with_mutex(typhon_scheduler, start).

start :-
    run_queue(_),
    !.
start :-
    message_queue_create(Queue),
    flag(typhon_watched, _, 0),
    flag(typhon_reviewed, _, 0),
    assertz(run_queue(Queue)),
    setting(min_workers, N),
    catch(( timer_start,
            forall(between(1, N, _), add_worker(Queue)) ),
          error(Formal, Context),
          ( scheduler_stop,
            throw(error(Formal, Context)) )).

%!  scheduler_stop is det.
%
%   End all threads of the scheduler.  Workers are asked, then those that
%   are busy are interrupted.

scheduler_stop :-
    with_mutex(typhon_scheduler, retract(run_queue(Queue))),
    !,
    timer_stop,
    findall(Worker, worker(Worker), Workers),
    forall(member(_, Workers), thread_send_message(Queue, stop)),
    maplist(stop_worker, Workers),
    message_queue_destroy(Queue),
    retractall(worker(_)),
    held_forget,
    limits_forget.
scheduler_stop.

%   A worker that does not come to its end is interrupted.

stop_worker(Worker) :-
    stop_worker(Worker, 1000).

stop_worker(Worker, Tries) :-
    thread_self(Me),
    (   \+ thread_property(Worker, status(running))
    ->  thread_join(Worker, _)
    ;   thread_get_message(Me, '$typhon_never', [timeout(0.002)])
    ->  true
    ;   Tries > 0
    ->  (   Tries =< 500, Tries mod 50 =:= 0
        ->  catch(thread_signal(Worker, abort), error(_, _), true)
        ;   true
        ),
        Tries1 is Tries-1,
        stop_worker(Worker, Tries1)
    ;   print_message(warning, typhon(stuck_worker(Worker))),
        thread_detach(Worker)
    ).

%!  scheduler_workers(-Count) is det.

scheduler_workers(Count) :-
    predicate_property(worker(_), number_of_clauses(Count)),
    !.
scheduler_workers(0).

                /*******************************
                *           THE QUEUE          *
                *******************************/

%!  scheduler_limit(+Host, +Concurrency) is det.
%
%   At most Concurrency agents of Host run at a time.

scheduler_limit(Host, Concurrency) :-
    limit_set(Host, Concurrency).

%!  scheduler_unlimit(+Host) is det.

scheduler_unlimit(Host) :-
    limit_clear(Host, Agents),
    forall(member(Agent, Agents), enqueue(agent(Agent))).

%!  schedule(+Host, +Agent) is det.
%
%   Agent, which stands on Host, is ready to run.

schedule(Host, Agent) :-
    (   limit_enter(Host, Agent, Work)
    ->  enqueue(Work)
    ;   true                            % parked
    ).

%!  scheduler_call(:Goal) is det.
%
%   Run Goal once in a worker, some time soon.

scheduler_call(Goal) :-
    enqueue(goal(Goal)).

enqueue(Work) :-
    run_queue(Queue),
    !,
    thread_send_message(Queue, Work),
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   watch_pool
    ).
enqueue(_).                             % stopping

%   Nobody is idle: have the timer see whether the queue moves.

watch_pool :-
    flag(typhon_watched, Watched, 1),
    (   Watched =:= 0
    ->  setting(stuck_seconds, Seconds),
        held_turns(Turns),
        alarm_in(Seconds, watch(Turns))
    ;   true
    ).

alarm_in(Seconds, Token) :-
    get_time(Now),
    Stamp is Now+Seconds,
    alarm_set(Stamp, pool, Token).

%!  scheduler_signal(:Goal) is det.
%
%   Run Goal in all workers, in the middle of whatever they do.

scheduler_signal(Goal) :-
    forall(worker(Worker),
           catch(thread_signal(Worker, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *            WORKERS           *
                *******************************/

add_worker(Queue) :-
    thread_create(work_from(Queue), Worker, [at_exit(replace_worker)]),
    assertz(worker(Worker)).

%   A worker that was aborted in the middle of a goal.

replace_worker :-
    thread_self(Me),
    held_ended(Me),
    with_mutex(typhon_scheduler, replace_worker(Me)).

replace_worker(Me) :-
    run_queue(Queue),
    retract(worker(Me)),
    !,
    thread_detach(Me),
    catch(add_worker(Queue), error(_, _), true).    % watching makes one
replace_worker(_).

work_from(Queue) :-
    held_worker,
    worker_loop(Queue).

worker_loop(Queue) :-
    setting(idle_seconds, Seconds),
    (   thread_get_message(Queue, Work, [timeout(Seconds)])
    ->  watch_if_last(Queue),
        work(Work, Queue)
    ;   timer_check,
        (   superfluous
        ->  watch_if_stuck(Queue)       % it may have been woken for this
        ;   worker_loop(Queue)
        )
    ).

%   What was queued while somebody was idle still may find nobody when its
%   turn comes.

watch_if_last(Queue) :-
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   watch_if_stuck(Queue)
    ).

watch_if_stuck(Queue) :-
    (   waits(Queue)
    ->  watch_pool
    ;   true
    ).

waits(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

work(stop, _) :-
    !.
work(Work, Queue) :-
    (   held_back(Work)
    ->  true
    ;   held_begin(Work, Turn),
        catch(work(Work), Ball, survive(Ball)),
        held_end(Turn)
    ),
    worker_loop(Queue).

work(agent(Agent)) :-
    run_one(Agent).
work(agent(Host, Agent)) :-
    call_cleanup(run_one(Agent), next_turn(Host)).
work(goal(Goal)) :-
    (   call(Goal)
    ->  true
    ;   print_message(warning, typhon(goal_failed(Goal)))
    ).

run_one(Agent) :-
    (   run(Agent)
    ->  true
    ;   print_message(error, typhon(run_failed(Agent)))
    ).

next_turn(Host) :-
    (   limit_leave(Host, Agent)
    ->  enqueue(agent(Host, Agent))
    ;   true
    ).

survive('$aborted') :-
    !.
survive(unwind(_)) :-                   % SWI-Prolog 9.3 and later
    !.
survive(Ball) :-
    print_message(error, Ball).

superfluous :-
    thread_self(Me),
    with_mutex(typhon_scheduler,
               ( run_queue(_),
                 scheduler_workers(Count),
                 setting(min_workers, Min),
                 Count > Min,
                 retract(worker(Me)),
                 thread_detach(Me)
               )).

                /*******************************
                *          THE POOL GROWS      *
                *******************************/

%   The pool is watched since Turns turns began: work waits, and nobody was
%   idle.  When none began meanwhile there are more workers: one, or some
%   where there are many.

fire(pool, watch(Turns)) :-
    !,
    flag(typhon_watched, _, 0),
    (   run_queue(Queue),
        waits(Queue)
    ->  ignore(with_mutex(typhon_scheduler, grow(Queue, Turns))),
        watch_pool
    ;   true
    ).
fire(pool, review) :-
    !,
    flag(typhon_reviewed, _, 0),
    scheduler_workers(Count),
    setting(max_workers, Max),
    (   run_queue(_),
        held_review(Count, Max, Works)
    ->  maplist(enqueue, Works),
        review_later
    ;   true
    ).

grow(Queue, Turns) :-
    run_queue(Queue),
    held_turns(Turns),
    scheduler_workers(Count),
    setting(max_workers, Max),
    Some is 1+Count//8,
    forall(between(1, Some, _), grow_by_one(Queue, Max)).

%   Fails when there is no room, or no thread.

grow_by_one(Queue, Max) :-
    waits(Queue),
    scheduler_workers(Count),
    (   Count < Max
    ->  true
    ;   review_later
    ),
    held_room(Count, Max),
    catch(add_worker(Queue), error(resource_error(What), _),
          ( held_full(What), review_later, fail )).

%   While workers are held, this is looked at from time to time.

review_later :-
    flag(typhon_reviewed, Reviewed, 1),
    (   Reviewed =:= 0
    ->  setting(typhon_held:held_seconds, Seconds),
        alarm_in(Seconds, review)
    ;   true
    ).
