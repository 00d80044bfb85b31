:- module(typhon_scheduler,
          [ scheduler_start/0,
            scheduler_stop/0,
            scheduler_limit/2,          % +Host, +Concurrency
            scheduler_unlimit/1,        % +Host
            schedule/2,                 % +Host, +Agent
            alarm_set/3,                % +Stamp, +Agent, +Token
            alarm_clear/3,              % +Stamp, +Agent, +Token
            scheduler_call/1,           % :Goal
            scheduler_signal/1,         % :Goal
            scheduler_workers/1         % -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(rbtrees),
              [ rb_new/1, rb_insert/4, rb_delete/3, rb_min/3, rb_empty/1 ]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> The scheduler: few threads for many agents

A run queue, a pool of workers and one timer.  A worker takes an agent,
runs it to the point where it has to wait, and takes the next.  An agent
that sleeps, waits or is resident is not here at all.  A native goal that
blocks holds its worker, so the pool grows when the queue is stuck and
shrinks when workers are idle.

What an agent is, the room above says with the hooks run/1 and fire/2.

*Threading*: schedule/2 and alarms from any thread.  The timer thread
owns the tree of alarms and decides when to grow.
*/

:- meta_predicate scheduler_call(0), scheduler_signal(0).

:- multifile
    run/1,                      % Agent: run it until it has to wait
    fire/2.                     % Agent, Token: an alarm went off

:- setting(min_workers, positive_integer, 2, "Workers kept when idle").
:- setting(max_workers, positive_integer, 256, "Workers at the most").
:- setting(idle_seconds, number, 10, "Idle workers beyond the minimum end").
:- setting(stuck_seconds, number, 0.01,
           "The pool grows when the run queue has not moved for so long").

:- dynamic
    run_queue/1,                % Queue
    timer/1,                    % Thread
    worker/1,                   % Thread
    limit/2,                    % Host, Concurrency
    parked/2.                   % Host, Agent: waits for its turn on Host

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
    flag(typhon_idle, _, 0),
    flag(typhon_taken, _, 0),
    flag(typhon_watched, _, 0),
    assertz(run_queue(Queue)),
    thread_create(timer_loop, Timer, [alias(typhon_timer)]),
    assertz(timer(Timer)),
    setting(min_workers, N),
    forall(between(1, N, _), add_worker(Queue)).

%!  scheduler_stop is det.
%
%   End all threads of the scheduler.  Workers are asked, then those that
%   are busy are interrupted.

scheduler_stop :-
    with_mutex(typhon_scheduler, retract(run_queue(Queue))),
    !,
    retract(timer(Timer)),
    thread_send_message(Timer, stop),
    thread_join(Timer, _),
    findall(Worker, retract(worker(Worker)), Workers),
    forall(member(_, Workers), thread_send_message(Queue, stop)),
    maplist(stop_worker, Workers),
    message_queue_destroy(Queue),
    retractall(parked(_, _)),
    retractall(limit(_, _)).
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

scheduler_limit(_, inf) :-
    !.
scheduler_limit(Host, Concurrency) :-
    running_key(Host, Key),
    flag(Key, _, 0),
    assertz(limit(Host, Concurrency)).

%!  scheduler_unlimit(+Host) is det.

scheduler_unlimit(Host) :-
    retractall(limit(Host, _)),
    forall(retract(parked(Host, Agent)), enqueue(agent(Agent))).

%!  schedule(+Host, +Agent) is det.
%
%   Agent, which stands on Host, is ready to run.

schedule(Host, Agent) :-
    limit(Host, Limit),
    !,
    with_mutex(typhon_park, park(Host, Limit, Agent)).
schedule(_, Agent) :-
    enqueue(agent(Agent)).

park(Host, Limit, Agent) :-
    running_key(Host, Key),
    flag(Key, Running, Running),
    (   Running < Limit
    ->  flag(Key, Running, Running+1),
        enqueue(agent(Host, Agent))
    ;   assertz(parked(Host, Agent))
    ).

%   An agent of a host with a limit has run: the next one, please.

unpark(Host) :-
    with_mutex(typhon_park, unpark_(Host)).

unpark_(Host) :-
    retract(parked(Host, Agent)),
    !,
    enqueue(agent(Host, Agent)).
unpark_(Host) :-
    running_key(Host, Key),
    flag(Key, Running, max(0, Running-1)).

running_key(Host, Key) :-
    atom_concat('typhon running ', Host, Key).

%!  scheduler_call(:Goal) is det.
%
%   Run Goal once in a worker, some time soon.

scheduler_call(Goal) :-
    enqueue(goal(Goal)).

enqueue(Work) :-
    run_queue(Queue),
    !,
    thread_send_message(Queue, Work),
    flag(typhon_idle, Idle, Idle),
    (   Idle =< 0
    ->  watch_pool
    ;   true
    ).
enqueue(_).                             % stopping

%   Nobody is idle: have the timer see whether the queue moves.

watch_pool :-
    flag(typhon_watched, Watched, 1),
    (   Watched =:= 0,
        timer(Timer)
    ->  flag(typhon_taken, Taken, Taken),
        catch(thread_send_message(Timer, watch(Taken)), error(_, _), true)
    ;   true
    ).

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
    thread_create(worker_loop(Queue), Worker, [at_exit(replace_worker)]),
    assertz(worker(Worker)).

%   A worker that was aborted in the middle of a goal.

replace_worker :-
    thread_self(Me),
    (   retract(worker(Me))
    ->  thread_detach(Me),
        (   run_queue(Queue)
        ->  catch(add_worker(Queue),
                  error(permission_error(create, thread, _), _),
                  true)                 % Prolog is halting
        ;   true
        )
    ;   true
    ).

worker_loop(Queue) :-
    flag(typhon_idle, Idle, Idle+1),
    setting(idle_seconds, Seconds),
    (   thread_get_message(Queue, Work, [timeout(Seconds)])
    ->  flag(typhon_idle, Idle1, Idle1-1),
        flag(typhon_taken, Taken, Taken+1),
        watch_if_last(Idle1, Queue),
        work(Work, Queue)
    ;   flag(typhon_idle, Idle1, Idle1-1),
        (   superfluous
        ->  watch_if_stuck(Queue)       % it may have been woken for this
        ;   worker_loop(Queue)
        )
    ).

%   What was queued while somebody was idle still may find nobody when its
%   turn comes.

watch_if_last(Idle, Queue) :-
    (   Idle =< 1
    ->  watch_if_stuck(Queue)
    ;   true
    ).

watch_if_stuck(Queue) :-
    (   message_queue_property(Queue, size(Size)),
        Size > 0
    ->  watch_pool
    ;   true
    ).

work(stop, _) :-
    !.
work(Work, Queue) :-
    catch(work(Work), Ball, survive(Ball)),
    worker_loop(Queue).

work(agent(Agent)) :-
    run_one(Agent).
work(agent(Host, Agent)) :-
    call_cleanup(run_one(Agent), unpark(Host)).
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

survive('$aborted') :-
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
                *             TIMER            *
                *******************************/

%!  alarm_set(+Stamp, +Agent, +Token) is det.
%
%   Have fire(Agent, Token) called at the real time Stamp.

alarm_set(Stamp, Agent, Token) :-
    tell_timer(set(Stamp, Agent, Token)).

%!  alarm_clear(+Stamp, +Agent, +Token) is det.

alarm_clear(Stamp, Agent, Token) :-
    tell_timer(clear(Stamp, Agent, Token)).

tell_timer(Message) :-
    (   timer(Timer)
    ->  catch(thread_send_message(Timer, Message), error(_, _), true)
    ;   true
    ).

timer_loop :-
    rb_new(Alarms),
    timer_loop(Alarms).

timer_loop(Alarms0) :-
    thread_self(Me),
    (   rb_empty(Alarms0)
    ->  thread_get_message(Message),
        timer_message(Message, Alarms0, Alarms, Next)
    ;   rb_min(Alarms0, alarm(Stamp, Agent, Token), _),
        (   thread_get_message(Me, Message, [deadline(Stamp)])
        ->  timer_message(Message, Alarms0, Alarms, Next)
        ;   rb_delete(Alarms0, alarm(Stamp, Agent, Token), Alarms),
            go_off(Agent, Token, Next)
        )
    ),
    (   Next == stop
    ->  true
    ;   timer_loop(Alarms)
    ).

timer_message(stop, Alarms, Alarms, stop).
timer_message(set(Stamp, Agent, Token), Alarms0, Alarms, go) :-
    rb_insert(Alarms0, alarm(Stamp, Agent, Token), true, Alarms).
timer_message(clear(Stamp, Agent, Token), Alarms0, Alarms, go) :-
    (   rb_delete(Alarms0, alarm(Stamp, Agent, Token), Alarms)
    ->  true
    ;   Alarms = Alarms0
    ).
timer_message(watch(Taken), Alarms0, Alarms, go) :-
    setting(stuck_seconds, Seconds),
    get_time(Now),
    Stamp is Now+Seconds,
    rb_insert(Alarms0, alarm(Stamp, '', watch(Taken)), true, Alarms).

go_off('', watch(Taken), go) :-
    !,
    flag(typhon_watched, _, 0),
    (   run_queue(Queue),
        message_queue_property(Queue, size(Size)),
        Size > 0
    ->  flag(typhon_taken, Taken1, Taken1),
        (   Taken1 =:= Taken
        ->  grow(Queue)
        ;   true
        ),
        watch_pool
    ;   true
    ).
go_off(Agent, Token, go) :-
    catch(ignore(fire(Agent, Token)), Ball, survive(Ball)).

grow(Queue) :-
    with_mutex(typhon_scheduler,
               ( run_queue(Queue),
                 scheduler_workers(Count),
                 setting(max_workers, Max),
                 Count < Max
               )),
    !,
    add_worker(Queue).
grow(_).
