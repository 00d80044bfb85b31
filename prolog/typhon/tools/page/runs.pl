:- module(typhon_page_runs,
          [ run_dict/1,                 % -Dict
            run_control/2,              % +Order, +Message
            run_begin/2,                % :Goal, -Run
            run_end/1,                  % +Run
            runs_rest/0,
            runs_stop/0
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module('../../kernel/base/own_thread',
              [abort_quietly/0, in_own_thread/1, stop_thread/1]).
:- use_module('../../kernel/host', [time_kind/1, time_now/1, time_wait/3]).
:- autoload('../../options/virtual', [virtual_pace/1, virtual_paced/1]).
:- use_module(slices, [slices_begin/1, slices_end/0]).

/** <module> Virtual time under the control of the page

A browser lets virtual time run, at a speed, pauses it, and lets it take one
step: to the next instant at which something is due.  None of these changes what
is done, or its order.

Virtual time runs only while a caller waits: from the first order on a thread of
the page waits, unless a model runs, which waits itself.  So time also runs at
the speed of the page when other callers wait, as in agent_join/3.

*Threading*: a mutex serialises orders; any thread queries.
*/

:- multifile prolog:error_message//1.

:- meta_predicate run_begin(0, -), waiting_itself(0).

:- dynamic
    own/1,                      % Thread: of run_begin/2
    waiter/2,                   % Thread, Queue: it waits in virtual time
    speed/1.                    % of the latest order `speed`

%!  run_dict(-Dict) is det.
%
%   Dict is _{virtual, time, state, speed}: whether the process has virtual
%   time; then the time is in seconds, and the state is `none` before the first
%   order, `going` or `paused`.  The speed is in virtual seconds per second;
%   `null` is as fast as possible.

run_dict(_{virtual:Virtual, time:Time, state:State, speed:Speed}) :-
    (   time_kind(virtual)
    ->  Virtual = true,
        time_now(Time),
        ( virtual_paced(Pace) -> pace_state(Pace, State) ; State = none )
    ;   Virtual = false,
        Time = null,
        State = none
    ),
    speed_now(Speed0),
    ( Speed0 == inf -> Speed = null ; Speed = Speed0 ).

pace_state(rate(_), going).
pace_state(paused, paused).
pace_state(step, paused).

speed_now(Speed) :-
    (   speed(Known)
    ->  Speed = Known
    ;   Speed = 1
    ).

%!  run_control(+Order, +Message:dict) is det.
%
%   Order is `go`, `pause`, `step` or `speed`, with the field `speed` as in
%   run_dict/1.
%
%   @error page_real_time there is no virtual time
%   @error page_time_runs_on time does not come to rest

run_control(Order, Message) :-
    (   time_kind(virtual)
    ->  with_mutex(typhon_page_runs, control(Order, Message))
    ;   throw(error(page_real_time, _))
    ).

control(go, _) :-
    wait_there,
    speed_now(Speed),
    paced(rate(Speed)).
control(pause, _) :-
    paced(paused).
control(step, _) :-
    wait_there,
    paced(step).
control(speed, Message) :-
    speed_in(Message, Speed),
    retractall(speed(_)),
    assertz(speed(Speed)),
    (   virtual_paced(rate(_))
    ->  paced(rate(Speed))
    ;   true
    ).

speed_in(Message, Speed) :-
    (   get_dict(speed, Message, null)
    ->  Speed = inf
    ;   get_dict(speed, Message, Speed),
        number(Speed),
        Speed >= 0.001,
        Speed =< 1.0e9
    ->  true
    ;   domain_error(page_speed, Message)
    ).

paced(Pace) :-
    (   virtual_pace(Pace)
    ->  true
    ;   throw(error(page_time_runs_on, _))
    ).

wait_there :-
    (   waiter(_, _)
    ;   own(_)
    ;   current_prolog_flag(threads, false)
    ),
    !.
wait_there :-
    paced(paused),                      % else time would run at once
    message_queue_create(Queue),
    thread_create(wait_for_stop(Queue), Thread),
    assertz(waiter(Thread, Queue)),
    thread_send_message(Queue, begin).

%   The thread also ends with virtual time; then no other thread joins it.

wait_for_stop(Queue) :-
    thread_get_message(Queue, begin),
    ignore(time_wait(Queue, stop, inf)),
    thread_self(Me),
    (   retract(waiter(Me, _))
    ->  thread_detach(Me),
        message_queue_destroy(Queue)
    ;   true
    ).

%!  run_begin(:Goal, -Run) is det.
%!  run_end(+Run) is det.
%
%   Let Goal run beside the page: in a thread, or in slices, where there are no
%   threads; end it, wherever it is.  Meanwhile the page does not wait: else time
%   would run on between two waits of Goal.

run_begin(Goal, slices) :-
    current_prolog_flag(threads, false),
    !,
    slices_begin(Goal).
run_begin(Goal, thread(Thread)) :-
    thread_create(waiting_itself(Goal), Thread).

waiting_itself(Goal) :-
    thread_self(Me),
    setup_call_cleanup(
        assertz(own(Me)),
        ignore(Goal),
        retractall(own(Me))).

run_end(slices) :-
    slices_end.
run_end(thread(Thread)) :-
    catch(thread_signal(Thread, abort_quietly),
          error(existence_error(_, _), _), true),
    stop_thread(Thread).

%!  runs_rest is det.
%!  runs_stop is det.
%
%   Virtual time has no pace any more, and runs only while other callers wait;
%   runs_stop/0 forgets the speed, too.

runs_stop :-
    retractall(speed(_)),
    runs_rest.

runs_rest :-
    (   waiter(_, _)
    ->  in_own_thread(with_mutex(typhon_page_runs, end_waiter))
    ;   true
    ).

%   The change of the pace makes virtual time look at the queue.

end_waiter :-
    (   retract(waiter(Thread, Queue))
    ->  thread_send_message(Queue, stop),
        ignore(virtual_pace(free)),
        thread_join(Thread, _),
        message_queue_destroy(Queue)
    ;   true
    ).

prolog:error_message(page_real_time) -->
    [ 'only virtual time can be controlled: start a network with \c
       clock(virtual)' ].
prolog:error_message(page_time_runs_on) -->
    [ 'virtual time does not come to rest: an agent runs on' ].
prolog:error_message(domain_error(page_speed, _)) -->
    [ 'the speed is a number of virtual seconds per second, or null' ].
