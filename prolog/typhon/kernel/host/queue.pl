:- module(typhon_queue,
          [ run_queue/1,                % ?Queue
            queue_begin/1,              % -Queue
            queue_end/1,                % -Queue
            enqueue/1,                  % +Work
            queue_waits/1,              % +Queue
            queue_empty/0,
            queue_watch_if_last/1,      % +Queue
            queue_watch_if_stuck/1,     % +Queue
            queue_unwatched/0
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(worker_activity, [census/1, turns_begun/1]).
:- use_module(timer, [alarm_in/3]).

/** <module> The run queue, and the watch over it

What is to be done by a worker waits in one queue: agent(Agent),
agent(Host, Agent) for one that has a turn on Host, goal(Goal), or `stop`.

When work waits and no worker is idle, an alarm of `pool` is set, watch(Turns):
if no turn has begun until it goes off, the queue is stuck.

*Threading*: any thread; the queue begins and ends under the mutex of the
scheduler.
*/

:- setting(typhon_scheduler:stuck_seconds, number, 0.01,
           "The pool grows when the run queue has not moved for so long").

:- dynamic
    run_queue/1.                % Queue

%!  run_queue(?Queue) is semidet.
%
%   The queue, if there is one.

%!  queue_begin(-Queue) is det.
%!  queue_end(-Queue) is semidet.
%
%   Make the queue; take it away, for the caller to destroy.

queue_begin(Queue) :-
    message_queue_create(Queue),
    queue_unwatched,
    assertz(run_queue(Queue)).

queue_end(Queue) :-
    retract(run_queue(Queue)),
    !.

%!  enqueue(+Work) is det.

enqueue(Work) :-
    run_queue(Queue),
    !,
    thread_send_message(Queue, Work),
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   watch
    ).
enqueue(_).                             % stopping

%!  queue_waits(+Queue) is semidet.
%
%   Work waits in it.

queue_waits(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%!  queue_empty is semidet.
%
%   There is a queue, and nothing waits in it.  During a census
%   working threads have to come back, and be counted.

queue_empty :-
    run_queue(Queue),
    \+ queue_waits(Queue),
    \+ census(_).

                /*******************************
                *            WATCH             *
                *******************************/

%!  queue_watch_if_last(+Queue) is det.
%!  queue_watch_if_stuck(+Queue) is det.
%
%   A worker has taken something, or ends.  What was queued while a worker
%   was idle may find none when its turn comes.

queue_watch_if_last(Queue) :-
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   queue_watch_if_stuck(Queue)
    ).

queue_watch_if_stuck(Queue) :-
    (   queue_waits(Queue)
    ->  watch
    ;   true
    ).

watch :-
    flag(typhon_watched, Watched, 1),
    (   Watched =:= 0
    ->  setting(typhon_scheduler:stuck_seconds, Seconds),
        turns_begun(Turns),
        alarm_in(Seconds, pool, watch(Turns))
    ;   true
    ).

%!  queue_unwatched is det.
%
%   The alarm has gone off: another may be set.

queue_unwatched :-
    flag(typhon_watched, _, 0).
