:- module(typhon_pool,
          [ pool_start/0,
            pool_stop/0,
            pool_signal/1,              % :Goal
            pool_here/1                 % +Agent
          ]).
:- use_module(library(settings), [setting/2]).
:- use_module(worker_activity, [census/1]).
:- use_module(growth, [growth_begin/0]).
:- use_module(held, [held_forget/0]).
:- use_module(queue, [enqueue/1, queue_begin/1, queue_end/1, run_queue/1]).
:- use_module(short_turns, [quick_turn/2]).
:- use_module(timer, [timer_start/0, timer_stop/0]).
:- use_module(work, [work_do/2]).
:- use_module(workers, [worker/1, worker_add/1, workers_end/1]).

/** <module> Work in real time: few threads for many agents

A run queue, a pool of workers and one timer.  A native goal that blocks
holds its worker, so the pool grows when the queue is stuck and shrinks when
workers are idle.

*Threading*: any thread.  A mutex makes the pool, and its end, whole: when
the run queue is gone no worker is added.
*/

:- meta_predicate pool_signal(0).

%!  pool_start is det.
%
%   Start the pool and the timer; nothing to do where they run.

pool_start :-
    with_mutex(typhon_scheduler, start).

start :-
    run_queue(_),
    !.
start :-
    queue_begin(Queue),
    growth_begin,
    setting(typhon_scheduler:min_workers, N),
    catch(( timer_start,
            forall(between(1, N, _), worker_add(Queue)) ),
          error(Formal, Context),
          ( pool_stop,
            throw(error(Formal, Context)) )).

%!  pool_stop is det.
%
%   End all threads of the pool.

pool_stop :-
    with_mutex(typhon_scheduler, queue_end(Queue)),
    !,
    timer_stop,
    workers_end(Queue),
    message_queue_destroy(Queue),
    held_forget.
pool_stop.

%!  pool_signal(:Goal) is det.
%
%   Run Goal in all workers, in the middle of whatever they do.

pool_signal(Goal) :-
    forall(worker(Worker),
           catch(thread_signal(Worker, Goal),
                 error(existence_error(_, _), _), true)).

%!  pool_here(+Agent) is semidet.
%
%   Run Agent in this thread, which is of no pool; fails if it is apt to take
%   long, or everybody's turns are noted.

pool_here(Agent) :-
    run_queue(_),
    \+ census(_),
    quick_turn(Agent, work_do(agent(Agent), enqueue)).
