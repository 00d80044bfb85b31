:- module(typhon_virtual_loop,
          [ virtual_begin/0,
            virtual_end/0,
            virtual_loop/1,             % +Queue
            virtual_here/1,             % +Queue
            virtual_goes_on/1,          % +Queue
            virtual_rests/0,
            virtual_seed/1,             % +Seed
            virtual_now/1,              % -Stamp
            virtual_steps/1,            % -Count
            virtual_doing/1,            % -Work
            virtual_alone/0,
            virtual_state/1             % -State
          ]).
:- use_module(library(apply), [exclude/3, partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(heaps),
              [ add_to_heap/4, empty_heap/1, get_from_heap/4, heap_to_list/2,
                list_to_heap/2, min_of_heap/3 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../../kernel/host', [work_do/2]).
:- use_module(virtual_pace,
              [pace/1, pace_deadline/4, pace_set/2, pace_slice_over/2]).

/** <module> The thread of virtual time

The thread reads these messages from one queue:

  | do(Work)                        | run Work, see module `work`           |
  | alarm(Stamp, Agent-Token)       | set an alarm; alarms at the same      |
  |                                 | Stamp fire in the order in which they |
  |                                 | were set                              |
  | ask(wait(Reply, Waited, Stamp)) | a caller waits for a message in the   |
  |                                 | queue Waited, until Stamp; Reply gets |
  |                                 | `there` or `late`                     |
  | ask(cancel(Reply))              | the caller of wait(Reply, _, _) has   |
  |                                 | stopped waiting                       |
  | ask(pace(Pace, Reply))          | set the pace, see typhon_virtual_pace |
  | ask(stop)                       | end the thread                        |
  | ask(hold(Reply))                | pause until held(let_go); Reply gets  |
  |                                 | `held`                                |
  | held(state(Reply))              | during a pause: Reply gets the state  |
  |                                 | of virtual time                       |
  | ask(state(Reply))               | Reply gets that state                 |
  | ask(restore(State, Reply))      | restore that state; Reply gets `done` |

Virtual time stands still while no caller waits.  The thread then reads ask(_)
alone; work and alarms stay in the queue.

Without threads the loop runs in the thread of the caller, and rests, that is,
returns to it, when no caller waits.  Then the alarms are kept as a fact.

*Threading*: the heap of alarms and the list of waiting callers are on the
stack of this thread. The time and the number of steps are flags, which any
thread may read. The thread is no `server`: it selects messages by their form.
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm fires
    typhon_scheduler:over/2,            % Agent, Token: the alarm is obsolete
    seeds/1,                            % Seed: as virtual_seed/1, where
                                        % set_random/1 gives other numbers
    prolog:message//1.

:- dynamic
    rests/2,                            % Alarms, Random: without threads, when
                                        % the loop last returned to its caller
    runs/0.                             % without threads: the loop runs

:- meta_predicate here(0).

%!  virtual_begin is det.
%
%   Set virtual time and the count of steps to zero; there is no pace.

virtual_begin :-
    flag(typhon_virtual_now, _, 0.0),
    flag(typhon_virtual_steps, _, 0),
    flag(typhon_virtual_ends, _, 0),
    pace_set(free, none).

%!  virtual_end is det.
%
%   From now on an abort of the running work ends the loop.  Before this call
%   the loop survives an abort.

virtual_end :-
    flag(typhon_virtual_ends, _, 1),
    retractall(rests(_, _)).

%!  virtual_loop(+Queue) is det.
%
%   Process Queue until it yields ask(stop).  Agents run in this thread, so
%   library(random) uses its generator.  It starts from a fixed seed to make
%   runs repeatable; time_seed/1 sets another one.

virtual_loop(Queue) :-
    virtual_seed(1),
    empty_heap(Alarms),
    wait_for_request(Queue, alarms(0, Alarms)).

%!  virtual_seed(+Seed:integer) is det.
%
%   Seed the random generator of this thread.

virtual_seed(Seed) :-
    (   seeds(Seed)
    ->  true
    ;   set_random(seed(Seed))
    ).

%!  virtual_here(+Queue) is det.
%
%   As virtual_loop/1 without threads, until the loop rests.

virtual_here(Queue) :-
    here(virtual_loop(Queue)).

%!  virtual_goes_on(+Queue) is det.
%
%   Without threads: process Queue until no caller waits.

virtual_goes_on(Queue) :-
    rests(Alarms, Random),
    !,
    here(( set_random(state(Random)),
           wait_for_request(Queue, Alarms) )).

%!  virtual_rests is semidet.
%
%   Without threads: the loop does not run.

virtual_rests :-
    \+ runs.

%   Agents do not share the random generator of the caller.

here(Goal) :-
    random_property(state(Random)),
    setup_call_cleanup(
        assertz(runs),
        Goal,
        ( retractall(runs),
          set_random(state(Random)) )).

rest(Alarms) :-
    random_property(state(Random)),
    retractall(rests(_, _)),
    assertz(rests(Alarms, Random)).

%!  virtual_now(-Stamp:float) is det.
%
%   Stamp is the virtual time, in seconds since the loop began.

virtual_now(Stamp) :-
    get_flag(typhon_virtual_now, Stamp).

%!  virtual_steps(-Count:integer) is det.
%
%   Count is the number of steps that the loop has run.

virtual_steps(Count) :-
    get_flag(typhon_virtual_steps, Count).

%!  virtual_doing(-Work) is semidet.
%
%   Work is the work that the calling thread runs.  Fails in every thread but
%   that of virtual time.

virtual_doing(Work) :-
    nb_current(typhon_virtual_work, doing(Work, _, _, _)).

%!  virtual_alone is semidet.
%
%   The work that the calling thread runs may run its next step at once, which
%   counts as a step of the loop.  Queueing that step would change nothing, as
%   the queue is empty and no caller's wait is satisfied.

virtual_alone :-
    nb_current(typhon_virtual_work, doing(_, 0, Waiting, Queue)),
    message_queue_property(Queue, size(0)),
    none_satisfied(Waiting),
    get_flag(typhon_virtual_steps, Steps0),     % written by this thread alone
    Steps is Steps0+1,
    set_flag(typhon_virtual_steps, Steps).

%!  virtual_state(-State) is semidet.
%
%   State is the state of virtual time, from which ask(restore(_, _)) continues:
%
%       virtual(Now, Random, Count, Alarms, Messages)
%
%   Now is the time, Random the state of the random generator, Count the number
%   of the next alarm, Alarms the pending alarms that are not obsolete, and
%   Messages the content of the queue without requests.  Fails in every thread
%   but that of virtual time.

virtual_state(State) :-
    nb_current(typhon_virtual_alarms, Queue-Alarms),
    loop_state(Queue, Alarms, State).

loop_state(Queue, alarms(Count, Heap),
           virtual(Now, Random, Count, Alarms, Messages)) :-
    virtual_now(Now),
    random_property(state(Random)),
    heap_to_list(Heap, All0),
    exclude(is_over, All0, Alarms),
    fifo_empty(Queue, All),
    forall(member(Message, All), thread_send_message(Queue, Message)),
    exclude(is_request, All, Messages).

is_over(_-(Agent-Token)) :-
    catch(typhon_scheduler:over(Agent, Token), error(_, _), fail).

is_request(ask(_)).
is_request(held(_)).

%   The restored messages precede those that the queue holds now.

restore_state(virtual(Now, Random, Count, Alarms, Messages), Queue,
              alarms(Count, Heap)) :-
    flag(typhon_virtual_now, _, Now),
    set_random(state(Random)),
    list_to_heap(Alarms, Heap),
    fifo_empty(Queue, Newer),
    append(Messages, Newer, All),
    forall(member(Message, All), thread_send_message(Queue, Message)).

                /*******************************
                *           THE LOOP           *
                *******************************/

%   wait_for_request(+Queue, +Alarms): time stands still until a caller sends a
%   request.  Alarms is alarms(Count, Heap); the keys of Heap are
%   at(Stamp, Number).

wait_for_request(Queue, Alarms) :-
    (   next_request(Queue, Request)
    ->  handle_request(Request, [], Queue, Alarms)
    ;   rest(Alarms)
    ).

next_request(Queue, Request) :-
    (   current_prolog_flag(threads, false)
    ->  thread_get_message(Queue, ask(Request), [timeout(0)])
    ;   thread_get_message(Queue, ask(Request))
    ).

handle_request(stop, Waiting, _, _) :-
    !,
    reply_late(Waiting).
handle_request(wait(Reply, Waited, Stamp), Waiting0, Queue, Alarms) :-
    !,
    notify_satisfied([waits(Reply, Waited, Stamp)|Waiting0], Waiting),
    run(Waiting, Queue, Alarms).
handle_request(hold(Reply), Waiting, Queue, Alarms) :-
    !,
    drop_stale_held(Queue),
    (   send(Reply, held)
    ->  hold(Queue, Alarms)
    ;   true                            % the caller has given up
    ),
    run(Waiting, Queue, Alarms).
handle_request(state(Reply), Waiting, Queue, Alarms) :-
    !,
    loop_state(Queue, Alarms, State),
    ignore(send(Reply, State)),
    run(Waiting, Queue, Alarms).
handle_request(restore(State, Reply), Waiting, Queue, _) :-
    !,
    restore_state(State, Queue, Alarms),
    ignore(send(Reply, done)),
    run(Waiting, Queue, Alarms).
handle_request(pace(Pace, Reply), Waiting0, Queue, Alarms) :-
    !,
    pace_set(Pace, Reply),
    notify_satisfied(Waiting0, Waiting),
    run(Waiting, Queue, Alarms).
handle_request(cancel(Reply), Waiting0, Queue, Alarms) :-
    exclude(is_of(Reply), Waiting0, Waiting),
    run(Waiting, Queue, Alarms).

%   A held(_) that was sent outside a pause would end the pause that begins now.

drop_stale_held(Queue) :-
    thread_peek_message(Queue, held(_)),
    !,
    thread_get_message(Queue, held(_)),
    drop_stale_held(Queue).
drop_stale_held(_).

hold(Queue, Alarms) :-
    thread_get_message(Queue, held(Request)),
    (   Request = state(Reply)
    ->  loop_state(Queue, Alarms, State),
        ignore(send(Reply, State)),
        hold(Queue, Alarms)
    ;   true
    ).

is_of(Reply, waits(Reply, _, _)).

%   run(+Waiting, +Queue, +Alarms)
%   run(+Count, +Waiting, +Queue, +Alarms)
%
%   Queue holds at least Count messages, as only this thread removes any.
%   Passing Count on saves a query of the size, which takes half a microsecond.

run([], Queue, Alarms) :-
    !,
    wait_for_request(Queue, Alarms).
run(Waiting, Queue, Alarms) :-
    message_queue_property(Queue, size(Count)),
    (   Count > 0
    ->  run(Count, Waiting, Queue, Alarms)
    ;   advance(Waiting, Queue, Alarms)
    ).

run(_, [], Queue, Alarms) :-
    !,
    wait_for_request(Queue, Alarms).
run(0, Waiting, Queue, Alarms) :-
    !,
    run(Waiting, Queue, Alarms).
run(Count, Waiting, Queue, Alarms) :-
    thread_get_message(Queue, Message),
    Left is Count-1,
    step(Message, Left, Waiting, Queue, Alarms).

step(do(Work), Left, Waiting0, Queue, Alarms) :-
    get_flag(typhon_virtual_steps, Steps0),
    Steps is Steps0+1,
    set_flag(typhon_virtual_steps, Steps),
    nb_linkval(typhon_virtual_work, doing(Work, Left, Waiting0, Queue)),
    nb_linkval(typhon_virtual_alarms, Queue-Alarms),
    catch(( work_do(Work, requeue(Queue)),
            Done = true ),
          Ball,
          after_exception(Ball, Left, Waiting0, Queue, Alarms)),
    (   Done == true
    ->  after_work(Left, Waiting0, Queue, Alarms)
    ;   true
    ).
step(alarm(Stamp, What), Left, Waiting, Queue, alarms(Count0, Heap0)) :-
    add_to_heap(Heap0, at(Stamp, Count0), What, Heap),
    Count is Count0+1,
    run(Left, Waiting, Queue, alarms(Count, Heap)).
step(ask(Request), _, Waiting, Queue, Alarms) :-
    handle_request(Request, Waiting, Queue, Alarms).
step(held(_), Left, Waiting, Queue, Alarms) :-
    run(Left, Waiting, Queue, Alarms).  % the pause is over

after_work(Left, Waiting0, Queue, Alarms) :-
    nb_linkval(typhon_virtual_work, none),
    notify_satisfied(Waiting0, Waiting),
    run(Left, Waiting, Queue, Alarms).

%   Prolog raises an abort that catch/3 has caught again when the recovery goal
%   ends.  So the loop runs on inside the recovery goal, until virtual time
%   ends.

after_exception(Ball, Left, Waiting, Queue, Alarms) :-
    aborted(Ball),
    flag(typhon_virtual_ends, 0, 0),
    !,
    after_work(Left, Waiting, Queue, Alarms).
after_exception(Ball, _, Waiting, _, Alarms) :-
    reply_late(Waiting),
    fails(Ball, Alarms).

%   Without threads the next caller begins again.

fails(Ball, Alarms) :-
    (   current_prolog_flag(threads, false)
    ->  nb_linkval(typhon_virtual_work, none),
        rest(Alarms)
    ;   true
    ),
    throw(Ball).

aborted('$aborted').
aborted(unwind(abort)).

requeue(Queue, Work) :-
    thread_send_message(Queue, do(Work)).

%   advance(+Waiting, +Queue, +Alarms): the queue is empty, so time jumps to the
%   next alarm or to the first end of a wait, when its pace allows that.

advance(Waiting, Queue, alarms(Count, Heap0)) :-
    pace(_),
    !,
    without_over(Heap0, Heap),
    next_stamp(Waiting, Heap, Next),
    virtual_now(Now),
    (   pace_deadline(Next, Now, Reached, Deadline)
    ->  set_time(Reached),
        wait_for_message(Deadline, Waiting, Queue, alarms(Count, Heap))
    ;   jump(Waiting, Queue, alarms(Count, Heap))
    ).
advance(Waiting, Queue, Alarms) :-
    jump(Waiting, Queue, Alarms).

wait_for_message(Deadline, Waiting, Queue, Alarms) :-
    pace_slice_over(Deadline, When),
    !,
    reply_all(Waiting, When),
    wait_for_request(Queue, Alarms).
wait_for_message(Deadline, Waiting, Queue, Alarms) :-
    current_prolog_flag(threads, false),
    !,
    (   Deadline == inf
    ->  fails(error(no_agent_can_run, _), Alarms)
    ;   monotonic_time(Now),
        Seconds is max(0, Deadline-Now),
        sleep(Seconds),
        advance(Waiting, Queue, Alarms)
    ).
wait_for_message(Deadline, Waiting, Queue, Alarms) :-
    (   wait_before(Deadline, thread_get_message(Queue, Message))
    ->  step(Message, 0, Waiting, Queue, Alarms)
    ;   advance(Waiting, Queue, Alarms)
    ).

%   An obsolete alarm does nothing, so it is no step.

without_over(Heap0, Heap) :-
    min_of_heap(Heap0, Key, Alarm),
    is_over(Key-Alarm),
    !,
    get_from_heap(Heap0, _, _, Heap1),
    without_over(Heap1, Heap).
without_over(Heap, Heap).

next_stamp(Waiting, Heap, Next) :-
    first_end(Waiting, End),
    (   min_of_heap(Heap, at(Stamp, _), _),
        before(Stamp, End)
    ->  Next = Stamp
    ;   Next = End
    ).

jump(Waiting, Queue, alarms(Count, Heap)) :-
    first_end(Waiting, End),
    (   min_of_heap(Heap, at(Stamp, _), _),
        before(Stamp, End)
    ->  get_from_heap(Heap, _, Alarm, Heap1),
        set_time(Stamp),
        fire_alarm(Alarm),
        notify_satisfied(Waiting, Waiting1),
        run(Waiting1, Queue, alarms(Count, Heap1))
    ;   number(End)
    ->  set_time(End),
        partition(ends_at(End), Waiting, Late, Waiting1),
        reply_late(Late),
        run(Waiting1, Queue, alarms(Count, Heap))
    ;   current_prolog_flag(threads, false)
    ->  fails(error(no_agent_can_run, _), alarms(Count, Heap))
    ;   print_message(warning, typhon(virtual_nothing_due)),
        thread_get_message(Queue, Message),
        step(Message, 0, Waiting, Queue, alarms(Count, Heap))
    ).

first_end([], inf).
first_end([waits(_, _, End0)|Waiting], End) :-
    first_end(Waiting, End1),
    (   before(End0, End1)
    ->  End = End0
    ;   End = End1
    ).

before(_, inf) :-
    !.
before(Stamp, End) :-
    number(Stamp),
    Stamp =< End.

ends_at(End, waits(_, _, End0)) :-
    number(End0),
    End0 =< End.

%   Alarms that were set too late go off now: time does not go back.

set_time(Stamp) :-
    virtual_now(Now),
    (   Stamp > Now
    ->  Later is float(Stamp),
        set_flag(typhon_virtual_now, Later)
    ;   true
    ).

fire_alarm(Agent-Token) :-
    debug(typhon(scheduler), 'alarm ~p of ~p', [Token, Agent]),
    catch(ignore(typhon_scheduler:fire(Agent, Token)), error(Formal, Where),
          print_error(error, error(Formal, Where))).

%   notify_satisfied(+Waiting0, -Waiting): notify the callers whose queue holds
%   a message; Waiting are the others.

notify_satisfied(Waiting, Waiting) :-
    none_satisfied(Waiting),
    !.
notify_satisfied(Waiting0, Waiting) :-
    partition(is_satisfied, Waiting0, Satisfied, Waiting),
    reply_all(Satisfied, there).

is_satisfied(Waits) :-
    \+ none_satisfied([Waits]).

none_satisfied([]).
none_satisfied([waits(_, Queue, _)|Waiting]) :-
    catch(message_queue_property(Queue, size(0)),
          error(existence_error(_, _), _), fail),
    none_satisfied(Waiting).

reply_late(Waiting) :-
    reply_all(Waiting, late).

reply_all(Waiting, Answer) :-
    forall(member(waits(Reply, _, _), Waiting), reply(Reply, Answer)).

reply(Reply, Answer) :-
    ignore(send(Reply, Answer)).        % the caller was interrupted

send(Reply, Answer) :-
    catch(thread_send_message(Reply, Answer), error(existence_error(_, _), _),
          fail).

prolog:message(typhon(virtual_nothing_due)) -->
    [ 'Virtual time has come to its end: no agent is ready, and nothing is \c
       due'-[] ].
