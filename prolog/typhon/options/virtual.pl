:- module(typhon_virtual,
          [ virtual_pace/1,             % +Pace
            virtual_paced/1,            % -Pace
            virtual_run/4,              % +Queue, +Stamp, +Seconds, -When
            virtual_program/2           % :Goal, -Engine
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/monotonic', [wait_within/2]).
:- use_module('../kernel/base/own_thread', [stop_thread/1]).
:- use_module('../kernel/host', [agent_parked/1]).
:- use_module(virtual/virtual_loop,
              [ virtual_alone/0, virtual_begin/0, virtual_doing/1,
                virtual_end/0, virtual_goes_on/1, virtual_here/1,
                virtual_loop/1, virtual_now/1, virtual_rests/0,
                virtual_seed/1,
                virtual_state/1, virtual_steps/1 ]).
:- use_module(virtual/virtual_pace,
              [pace/1, pace_set/2, pace_slice/1, pace_slice_end/0]).

/** <module> The runtime `virtual`: simulated time

One thread runs all work in the order in which it was queued.  When the queue is
empty the clock jumps to the next alarm.  So a run depends on the programs
alone, not on the load of the machine nor on other threads.

Time runs only while a caller waits, in time_wait/3, and stops as soon as the
message for which it waits is in its queue.  So a program that starts agents,
waits, inspects them, and waits again gets the same results in each run.

A native goal takes no virtual time.  A native goal that does not end, and
agents that never leave one instant, are reported.

In a Prolog without threads the work is done in the thread of the caller, from
the moment when it waits until its message is there.

*Threading*: any thread may call.  Calls of two threads at the same time are
queued in any order; runs are repeatable only if a single thread calls.
*/

:- multifile
    prolog:message//1,
    typhon_options:declared/4,
    typhon_time:again/3,
    typhon_time:alarm/4,
    typhon_time:alone/1,
    typhon_time:apart/2,
    typhon_time:clock/2,
    typhon_time:hold/2,
    typhon_time:let_go/2,
    typhon_time:repeats/2,
    typhon_time:seed/2,
    typhon_time:signal/2,
    typhon_time:state/2,
    typhon_time:starts/1,
    typhon_time:stops/1,
    typhon_time:wait/4,
    typhon_time:wanted/2,
    typhon_time:work/2.

:- setting(patience, number, 10,
           "Virtual time that stands still for so long is reported").

:- dynamic
    loop/2.                             % Thread, or `here` without threads, Queue

typhon_options:declared(host_option, clock(Kind), oneof([virtual]), Kind).

typhon_time:wanted(clock(virtual), virtual).

typhon_time:apart(virtual, 'virtual:0').

typhon_time:repeats(virtual, 'v.').

typhon_time:clock(virtual, typhon_virtual_now).

%   Time begins at 0.0 and stands still.  Stopping also works while time is
%   held: queued work is discarded, and a running goal is interrupted.

typhon_time:starts(virtual) :-
    message_queue_create(Queue),
    virtual_begin,
    loop_begin(Queue, Thread),
    assertz(loop(Thread, Queue)).

typhon_time:stops(virtual) :-
    retract(loop(Thread, Queue)),
    !,
    virtual_end,
    loop_end(Thread, Queue),
    message_queue_destroy(Queue).

loop_begin(Queue, here) :-
    current_prolog_flag(threads, false),
    !,
    virtual_here(Queue).
loop_begin(Queue, Thread) :-
    thread_create(virtual_loop(Queue), Thread,
                  [alias(typhon_virtual_time)]).

loop_end(here, _) :-
    !.
loop_end(Thread, Queue) :-
    thread_send_message(Queue, held(let_go)),
    thread_send_message(Queue, ask(stop)),
    stop_thread(Thread).

loop_goes_on(here, Queue) :-
    !,
    virtual_goes_on(Queue).
loop_goes_on(_, _).

                /*******************************
                *        WORK AND ALARMS       *
                *******************************/

typhon_time:work(virtual, Work) :-
    send_loop(do(Work)).

typhon_time:alarm(virtual, Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    send_loop(alarm(Stamp, Agent-Token)).

typhon_time:seed(virtual, Seed) :-
    send_loop(do(goal(typhon_virtual:virtual_seed(Seed)))).

typhon_time:alone(virtual) :-
    virtual_alone.

send_loop(Message) :-
    (   loop(_, Queue)
    ->  catch(thread_send_message(Queue, Message),
              error(existence_error(_, _), _), true)
    ;   true                            % virtual time has ended
    ).

typhon_time:signal(virtual, Goal) :-
    signal(Goal).

signal(Goal) :-
    forall(( loop(Thread, _), Thread \== here ),
           catch(thread_signal(Thread, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *            HOLDING           *
                *******************************/

%   The state of virtual time is the term of virtual_state/1.  After let_go,
%   or after this state was restored, time stands still until a caller waits.  A
%   goal in the thread of virtual time holds time by running.

typhon_time:hold(virtual, Seconds) :-
    (   own_thread
    ->  true
    ;   loop(here, _)                   % time runs in this thread alone
    ->  true
    ;   ask_loop(ask(hold(Reply)), Reply, Seconds, held)
    ).

typhon_time:state(virtual, State) :-
    (   own_thread
    ->  virtual_state(State)
    ;   loop(here, _)
    ->  ask_loop(ask(state(Reply)), Reply, inf, State)
    ;   ask_loop(held(state(Reply)), Reply, inf, State)
    ).

typhon_time:let_go(virtual, []) :-
    (   own_thread
    ->  true
    ;   send_loop(held(let_go))
    ).

own_thread :-
    loop(Thread, _),
    (   Thread == here
    ->  \+ virtual_rests
    ;   thread_self(Thread)
    ).

typhon_time:again(virtual, State, Agents) :-
    ask_loop(ask(restore(State, Reply)), Reply, inf, done),
    findall(Agent, has_turn(State, Agent), Agents).

has_turn(virtual(_, _, _, _, Messages), Agent) :-
    member(do(Work), Messages),
    ( Work = agent(Agent) ; Work = agent(_, Agent) ).
has_turn(_, Agent) :-
    agent_parked(Agent).

ask_loop(Request, Reply, Seconds, Answer) :-
    loop(Thread, Loop),
    setup_call_cleanup(
        message_queue_create(Reply),
        ( thread_send_message(Loop, Request),
          loop_goes_on(Thread, Loop),
          wait_within(Seconds, thread_get_message(Reply, Answer))
        ),
        message_queue_destroy(Reply)).

                /*******************************
                *             PACE             *
                *******************************/

%!  virtual_pace(+Pace) is semidet.
%!  virtual_paced(-Pace) is semidet.
%
%   Set the pace of virtual time: `paused`, `step`, rate(Speed), in virtual
%   seconds per second, or `free`, the default; get it, except `free`.  After
%   `step` no agent is ready; fails if one still is after ten seconds, if no
%   caller waits, and if there is no virtual time.  Without threads virtual_run/4
%   does the step.

virtual_pace(Pace) :-
    loop(here, _),
    !,
    pace_set(Pace, none).
virtual_pace(Pace) :-
    ask_loop(ask(pace(Pace, Reply)), Reply, 10, set).

virtual_paced(Pace) :-
    pace(Full),
    (   Full = rate(Speed, _, _)
    ->  Pace = rate(Speed)
    ;   Full = rate(_)
    ->  Pace = Full
    ;   functor(Full, Pace, _)
    ).

                /*******************************
                *            WAITING           *
                *******************************/

%   Time runs until Queue holds a message, or until Stamp.  In the thread of
%   virtual time a wait for an empty queue fails at once: no time passes while a
%   goal runs there.

typhon_time:wait(virtual, Queue, Message, Stamp) :-
    (   has_messages(Queue)
    ->  true
    ;   wait_until_message(Queue, Stamp)
    ),
    thread_get_message(Queue, Message).

wait_until_message(Queue, Stamp) :-
    program_waits(Queue, Stamp, Answer),
    !,
    Answer == there.
wait_until_message(Queue, Stamp) :-
    \+ own_thread,
    loop(Thread, Loop),
    setup_call_cleanup(
        message_queue_create(Reply),
        ( thread_send_message(Loop, ask(wait(Reply, Queue, Stamp))),
          loop_goes_on(Thread, Loop),
          answer(Reply, Answer)
        ),
        ( send_loop(ask(cancel(Reply))),
          message_queue_destroy(Reply)
        )),
    Answer == there.

                /*******************************
                *       TIME IN SLICES         *
                *******************************/

:- meta_predicate virtual_program(0, -).

%!  virtual_run(+Queue, +Stamp, +Seconds, -When) is semidet.
%
%   Without threads: let virtual time run at its pace, without one as fast as
%   possible, until Queue holds a message or until Stamp, but only for about
%   Seconds of real time.  An event loop calls this again, and handles other
%   events in between.  When is `there`; `late`; after(More), if there is more to
%   do after More seconds of real time; or `rests`, if not before there is another
%   pace, or more work.  Fails if there is no virtual time, or in it.

virtual_run(Queue, _, _, there) :-
    has_messages(Queue),
    !.
virtual_run(Queue, Stamp, Seconds, When) :-
    loop(here, Loop),
    \+ own_thread,
    ( pace(_) -> true ; pace_set(rate(inf), none) ),
    setup_call_cleanup(
        ( message_queue_create(Reply),
          pace_slice(Seconds) ),
        ( thread_send_message(Loop, ask(wait(Reply, Queue, Stamp))),
          virtual_goes_on(Loop),
          thread_get_message(Reply, When)
        ),
        ( pace_slice_end,
          send_loop(ask(cancel(Reply))),
          message_queue_destroy(Reply)
        )).

%!  virtual_program(:Goal, -Engine) is det.
%
%   Engine runs Goal.  When Goal waits for virtual time, engine_next/2 and
%   engine_post/3 give virtual_wait(Queue, Stamp), for virtual_run/4; then Engine
%   expects `there` or `late` by engine_post/3.

virtual_program(Goal, Engine) :-
    engine_create(ended, typhon_virtual:program(Goal), Engine).

program(Goal) :-
    nb_setval(typhon_virtual_program, true),
    call(Goal).

program_waits(Queue, Stamp, Answer) :-
    nb_current(typhon_virtual_program, true),
    \+ own_thread,
    engine_yield(virtual_wait(Queue, Stamp)),
    engine_fetch(Answer).

has_messages(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   The waiting thread watches the progress of virtual time, as the thread of
%   virtual time cannot do that while a goal runs.

answer(Reply, Answer) :-
    setting(patience, Seconds),
    progress(Progress),
    (   wait_within(Seconds, thread_get_message(Reply, Answer0))
    ->  Answer = Answer0
    ;   report_no_progress(Progress),
        answer(Reply, Answer)
    ).

progress(progress(Now, Steps)) :-
    virtual_now(Now),
    virtual_steps(Steps).

report_no_progress(progress(Now, Steps0)) :-
    progress(progress(Now, Steps)),
    !,
    (   Steps-Steps0 =< 1               % the step may just have begun
    ->  signal(typhon_virtual:report_work)
    ;   print_message(warning, typhon(virtual_busy(Now)))
    ).
report_no_progress(_).

%   Runs as a signal in the thread of virtual time, within the goal that blocks
%   it.

report_work :-
    (   virtual_doing(Work)
    ->  virtual_now(Now),
        print_message(warning, typhon(virtual_stuck(Work, Now)))
    ;   true
    ).

prolog:message(typhon(virtual_stuck(Work, Now))) -->
    [ 'Virtual time stands still at ~3f: this does not end: ~p'-[Now, Work] ].
prolog:message(typhon(virtual_busy(Now))) -->
    [ 'Virtual time stands still at ~3f: there is always more to do at this \c
       instant'-[Now] ].
