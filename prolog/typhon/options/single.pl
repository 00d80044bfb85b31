:- module(typhon_single, []).
:- use_module(library(apply), [include/3]).
:- use_module(library(lists), [min_list/2]).
:- use_module('../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../kernel/host',
              [ alarm_add/3, alarm_stamp/3, alarms_begin/0, alarms_end/0,
                alarms_go_off/1, index_delete/3, index_first/2, index_make/1,
                index_update/2, turns_go_on/1, turns_pause/0, turns_paused/0,
                work_do/2 ]).

/** <module> The runtime `single`: all work is done in the caller's thread

In a Prolog without threads, such as in a browser, agents have their turns
while the caller waits: for the end of an agent, an answer, or only for time to
pass, see agents_run/1.  Work is done in the order in which it was queued; when
the queue is empty the thread sleeps until the next alarm.  A hop ends a turn,
so that the caller, alarms and other agents get their turns in between.

The hosts of the process have no endpoint that other processes could reach.

*Threading*: there is one thread.
*/

:- multifile
    typhon_time:alarm/4,
    typhon_time:apart/2,
    typhon_time:due/4,
    typhon_time:hold/2,
    typhon_time:let_go/2,
    typhon_time:signal/2,
    typhon_time:starts/1,
    typhon_time:stops/1,
    typhon_time:wait/4,
    typhon_time:work/2.

:- dynamic run_queue/1.         % Queue

typhon_time:apart(single, 'single:0').

typhon_time:starts(single) :-
    message_queue_create(Queue),
    assertz(run_queue(Queue)),
    alarms_begin.

typhon_time:stops(single) :-
    retract(run_queue(Queue)),
    fifo_empty(Queue, _),
    message_queue_destroy(Queue),
    alarms_end,
    turns_go_on(_).

typhon_time:work(single, Work) :-
    run_queue(Queue),
    thread_send_message(Queue, Work).

typhon_time:alarm(single, Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    ignore(alarm_add(Stamp, Agent, Token)).

typhon_time:due(single, Agent, Token, Stamp) :-
    alarm_stamp(Stamp, Agent, Token).

typhon_time:hold(single, _) :-
    turns_pause.

typhon_time:let_go(single, Agents) :-
    turns_go_on(Agents).

typhon_time:signal(single, _).          % running work is not interrupted

                /*******************************
                *            WAITING           *
                *******************************/

%   A goal of an agent cannot wait: while it runs, no other agent runs.

typhon_time:wait(single, Queue, Message, Stamp) :-
    (   nb_current(typhon_single, works)
    ->  has_message(Queue)
    ;   index_make(Index),
        run_until_message(Queue, Stamp, Index)
    ),
    thread_get_message(Queue, Message).

%   run_until_message(+Queue, +Stamp, +Index) is semidet.
%
%   Run agents until there is a message in Queue; fails at Stamp.  Alarms that
%   are due come before work, so that agents that are always ready delay
%   neither agents that sleep nor the caller.
%
%   @error no_agent_can_run if no message can come

run_until_message(Queue, Stamp, Index0) :-
    (   has_message(Queue)
    ->  true
    ;   index_update(Index0, Index1),
        index_first(Index1, First),
        monotonic_time(Now),
        next(Now, First, Stamp, Next),
        proceed(Next, Index1, Index),
        run_until_message(Queue, Stamp, Index)
    ).

%   next(+Now, +First, +Stamp, -Next) is semidet: Next is the next step.  First
%   is the stamp of the first alarm, Stamp the deadline of the caller.

next(Now, First, _, alarm(First)) :-
    due(First, Now),
    !.
next(Now, _, Stamp, _) :-
    due(Stamp, Now),
    !,
    fail.
next(_, _, _, work(Work)) :-
    take_work(Work),
    !.
next(_, inf, inf, _) :-
    throw(error(no_agent_can_run, _)).
next(Now, First, Stamp, sleep(Seconds)) :-
    include(number, [First, Stamp], Stamps),
    min_list(Stamps, Least),
    Seconds is Least-Now.

due(Stamp, Now) :-
    number(Stamp),
    Stamp =< Now.

proceed(alarm(Stamp), Index0, Index) :-
    alarms_go_off(Stamp),
    index_delete(Index0, Stamp, Index).
proceed(work(Work), Index, Index) :-
    setup_call_cleanup(
        nb_setval(typhon_single, works),
        work_do(Work, typhon_single:again),
        nb_setval(typhon_single, waits)).
proceed(sleep(Seconds), Index, Index) :-
    sleep(Seconds).

has_message(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

take_work(Work) :-
    \+ turns_paused,
    run_queue(Queue),
    thread_get_message(Queue, Work, [timeout(0)]).

:- public again/1.

again(Work) :-
    typhon_time:work(single, Work).
