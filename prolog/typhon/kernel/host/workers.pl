:- module(typhon_workers,
          [ worker/1,                   % ?Thread
            workers_count/1,            % -Count
            worker_add/1,               % +Queue
            worker_adopt/1,             % +Thread
            worker_leave/0,
            workers_end/1               % +Queue
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/stop_thread', [stop_thread/1]).
:- use_module(worker_activity,
              [turn_begin/2, turn_end/1, worker_came/0, worker_ended/1]).
:- use_module(held, [held_back/1]).
:- use_module(queue,
              [ enqueue/1, queue_watch_if_last/1, queue_watch_if_stuck/1,
                run_queue/1 ]).
:- use_module(timer, [timer_check/0]).
:- use_module(work, [work_do/2]).

/** <module> Workers: threads that do what is in the run queue

A worker takes an agent, runs it to the point where it has to wait, and
takes the next.  One that is idle for long ends, if there are enough others.

*Threading*: the mutex of the scheduler makes the pool, and its end, whole:
when the run queue is gone no worker is added.
*/

:- setting(typhon_scheduler:min_workers, positive_integer, 2,
           "Workers kept when idle").
:- setting(typhon_scheduler:idle_seconds, number, 10,
           "Idle workers beyond the minimum end").

:- dynamic
    worker/1.                   % Thread

%!  worker(?Thread) is nondet.
%
%   The workers there are.

%!  workers_count(-Count) is det.

workers_count(Count) :-
    predicate_property(worker(_), number_of_clauses(Count)),
    !.
workers_count(0).

                /*******************************
                *       BEGIN AND END          *
                *******************************/

%!  worker_add(+Queue) is det.
%
%   @error resource_error(What) where no thread can be made

worker_add(Queue) :-
    flag(typhon_worker, N, N+1),
    atom_concat(typhon_worker_, N, Alias),
    thread_create(work_from(Queue), Worker,
                  [ alias(Alias), at_exit(typhon_workers:replace_worker) ]),
    assertz(worker(Worker)).

%   A worker that was aborted in the middle of a goal.

replace_worker :-
    thread_self(Me),
    worker_ended(Me),
    with_mutex(typhon_scheduler, replace_worker(Me)).

replace_worker(Me) :-
    run_queue(Queue),
    retract(worker(Me)),
    !,
    debug(typhon(scheduler), '~w has ended', [Me]),
    thread_detach(Me),
    catch(worker_add(Queue), error(_, _), true).    % watching makes one
replace_worker(_).

%!  workers_end(+Queue) is det.
%
%   Workers are asked, then those that are busy are interrupted.  Queue is
%   the run queue no more.

workers_end(Queue) :-
    findall(Worker, worker(Worker), Workers),
    forall(member(_, Workers), thread_send_message(Queue, stop)),
    maplist(stop_thread, Workers),
    retractall(worker(_)).

                /*******************************
                *             GUESTS           *
                *******************************/

%!  worker_adopt(+Thread) is det.
%!  worker_leave is det.
%
%   Thread, which runs an agent, is a worker until it has done so; this one
%   has.  No other thread joins it.

worker_adopt(Thread) :-
    with_mutex(typhon_scheduler, adopt(Thread)).

adopt(Thread) :-
    (   run_queue(_)
    ->  assertz(worker(Thread))
    ;   thread_detach(Thread)
    ).

worker_leave :-
    thread_self(Me),
    with_mutex(typhon_scheduler, leave(Me)).

leave(Me) :-
    (   run_queue(_),
        retract(worker(Me))
    ->  thread_at_exit(thread_detach(Me))   % an abort is not reported then
    ;   true                            % stopping the pool waits for it
    ).

                /*******************************
                *             WORK             *
                *******************************/

work_from(Queue) :-
    worker_came,
    next(Queue).

next(Queue) :-
    setting(typhon_scheduler:idle_seconds, Seconds),
    (   thread_get_message(Queue, Work, [timeout(Seconds)])
    ->  queue_watch_if_last(Queue),
        work(Work, Queue)
    ;   timer_check,
        (   superfluous
        ->  queue_watch_if_stuck(Queue) % it may have been woken for this
        ;   next(Queue)
        )
    ).

work(stop, _) :-
    !.
work(Work, Queue) :-
    (   held_back(Work)
    ->  true
    ;   turn_begin(Work, Turn),
        work_do(Work, enqueue),
        turn_end(Turn)
    ),
    next(Queue).

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
