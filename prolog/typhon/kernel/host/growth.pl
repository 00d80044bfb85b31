:- module(typhon_growth,
          [ growth_begin/0
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/headroom', [memory_short/0]).
:- use_module(worker_activity, [turns_begun/1]).
:- use_module(held, [held_full/1, held_review/3, held_room/2]).
:- use_module(queue,
              [ enqueue/1, queue_unwatched/0, queue_waits/1,
                queue_watch_if_stuck/1, run_queue/1 ]).
:- use_module(timer, [alarm_in/3]).
:- use_module(workers, [worker_add/1, workers_count/1]).

/** <module> The pool grows when the run queue is stuck

The run queue is watched since so many turns began: work waits, and no worker
was idle.  When none began meanwhile there are more workers: one, or some
where there are many.  There are at most `max_workers`, not counting those
that were held for long, see module `held`; while there are such, that is
looked at from time to time.

*Threading*: the thread of the timer.
*/

:- multifile
    typhon_scheduler:fire/2.    % Agent, Token: an alarm went off

:- setting(typhon_scheduler:max_workers, positive_integer, 256,
           "Workers at the most, but for those that were held for long").

%!  growth_begin is det.
%
%   Nothing is to be looked at yet.

growth_begin :-
    flag(typhon_reviewed, _, 0).

typhon_scheduler:fire(pool, watch(Turns)) :-
    !,
    queue_unwatched,
    (   run_queue(Queue),
        queue_waits(Queue)
    ->  ignore(with_mutex(typhon_scheduler, grow(Queue, Turns))),
        queue_watch_if_stuck(Queue)
    ;   true
    ).
typhon_scheduler:fire(pool, review) :-
    !,
    flag(typhon_reviewed, _, 0),
    workers_count(Count),
    setting(typhon_scheduler:max_workers, Max),
    (   run_queue(_),
        held_review(Count, Max, Works)
    ->  maplist(enqueue, Works),
        review_later
    ;   true
    ).

grow(Queue, Turns) :-
    run_queue(Queue),
    turns_begun(Turns),
    workers_count(Count),
    setting(typhon_scheduler:max_workers, Max),
    Some is 1+Count//8,
    forall(between(1, Some, _), grow_by_one(Queue, Max)).

%   Fails when the pool is full, or there is no thread, or little memory.

grow_by_one(Queue, Max) :-
    queue_waits(Queue),
    workers_count(Count),
    (   Count < Max
    ->  true
    ;   review_later
    ),
    held_room(Count, Max),
    ( memory_short -> held_full(no_memory), review_later, fail ; true ),
    catch(worker_add(Queue), error(resource_error(What), _),
          ( held_full(What), review_later, fail )),
    debug(typhon(scheduler), 'one more than ~D workers', [Count]).

review_later :-
    flag(typhon_reviewed, Reviewed, 1),
    (   Reviewed =:= 0
    ->  setting(typhon_held:held_seconds, Seconds),
        alarm_in(Seconds, pool, review)
    ;   true
    ).
