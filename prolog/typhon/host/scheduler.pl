:- module(typhon_scheduler,
          [ scheduler_start/0,
            scheduler_stop/0,
            scheduler_limit/2,          % +Host, +Concurrency
            scheduler_unlimit/1,        % +Host
            schedule/2,                 % +Host, +Agent
            scheduler_call/1,           % :Goal
            scheduler_signal/1          % :Goal
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2]).
:- use_module(growth, [growth_begin/0]).
:- use_module(held, [held_forget/0]).
:- use_module(limits,
              [limit_clear/2, limit_enter/3, limit_set/2, limits_forget/0]).
:- use_module(queue, [enqueue/1, queue_begin/1, queue_end/1, run_queue/1]).
:- use_module(timer, [timer_start/0, timer_stop/0]).
:- use_module(workers, [worker/1, worker_add/1, workers_end/1]).

/** <module> The scheduler: few threads for many agents

A run queue, a pool of workers and one timer.  An agent that is ready is in
the queue once; an agent that sleeps, waits or is resident is not here at
all.  A native goal that blocks holds its worker, so the pool grows when the
queue is stuck and shrinks when workers are idle.

What an agent is, the room above says with the hooks run/1, fire/2, over/2,
kind/2 and running/1.

*Threading*: schedule/2 from any thread.  A mutex makes the pool, and its
end, whole: when the run queue is gone no worker is added.
*/

:- meta_predicate
    scheduler_call(0),
    scheduler_signal(0).

:- multifile
    run/1,                      % Agent: run it until it has to wait
    fire/2,                     % Agent, Token: an alarm went off
    over/2,                     % Agent, Token: nobody waits for this alarm
    kind/2,                     % Agent, Kind: Agents that may block alike
    running/1.                  % Agent: has a worker

%!  scheduler_start is det.
%
%   Start the pool and the timer; nothing to do where they run.

scheduler_start :-
    with_mutex(typhon_scheduler, start).

start :-
    run_queue(_),
    !.
start :-
    queue_begin(Queue),
    growth_begin,
    setting(min_workers, N),
    catch(( timer_start,
            forall(between(1, N, _), worker_add(Queue)) ),
          error(Formal, Context),
          ( scheduler_stop,
            throw(error(Formal, Context)) )).

%!  scheduler_stop is det.
%
%   End all threads of the scheduler.

scheduler_stop :-
    with_mutex(typhon_scheduler, queue_end(Queue)),
    !,
    timer_stop,
    workers_end(Queue),
    message_queue_destroy(Queue),
    held_forget,
    limits_forget.
scheduler_stop.

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
    ;   debug(typhon(scheduler), '~w waits for its turn on ~w',
              [Agent, Host])
    ).

%!  scheduler_call(:Goal) is det.
%
%   Run Goal once in a worker, some time soon.

scheduler_call(Goal) :-
    enqueue(goal(Goal)).

%!  scheduler_signal(:Goal) is det.
%
%   Run Goal in all workers, in the middle of whatever they do.

scheduler_signal(Goal) :-
    forall(worker(Worker),
           catch(thread_signal(Worker, Goal),
                 error(existence_error(_, _), _), true)).
