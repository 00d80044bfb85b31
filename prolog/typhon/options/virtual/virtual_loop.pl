:- module(typhon_virtual_loop,
          [ virtual_begin/0,
            virtual_end/0,
            virtual_loop/1,             % +Queue
            virtual_now/1,              % -Stamp
            virtual_steps/1,            % -Count
            virtual_doing/1,            % -Work
            virtual_alone/0,
            virtual_standing/1          % -Standing
          ]).
:- use_module(library(apply), [exclude/3, partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(heaps),
              [ add_to_heap/4, empty_heap/1, get_from_heap/4, heap_to_list/2,
                list_to_heap/2, min_of_heap/3 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../../kernel/host', [work_do/2]).

/** <module> The thread of virtual time

It takes from one queue what is to be done, in order:

  | do(Work)                        | see module `work`                     |
  | alarm(Stamp, Agent-Token)       | of two at one Stamp the first goes    |
  |                                 | off first                             |
  | ask(wait(Reply, Waited, Stamp)) | a caller waits for a message in       |
  |                                 | Waited, until Stamp; Reply gets       |
  |                                 | `there` or `late`                     |
  | ask(no_longer(Reply))           | it does not any more                  |
  | ask(stop)                       |                                       |
  | ask(hold(Reply))                | Reply gets `held`: nothing is done    |
  |                                 | until held(let_go)                    |
  | held(standing(Reply))           | meanwhile: Reply gets where time      |
  |                                 | stands                                |
  | ask(again(Standing, Reply))     | time is as it was; Reply gets `done`  |

Without a waiting caller it only answers questions: time stands still.

*Threading*: the heap of alarms and the list of waiting callers are on the
stack of this thread. The time and the number of steps are flags, which any
thread may ask for. No `server`: it takes messages by their form, not in order.
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    typhon_scheduler:over/2,            % Agent, Token: it is not needed
    prolog:message//1.

%!  virtual_begin is det.
%!  virtual_end is det.
%
%   Time is 0.0; it is about to end, and does so where what runs is aborted.
%   At other times it goes on after that.

virtual_begin :-
    flag(typhon_virtual_now, _, 0.0),
    flag(typhon_virtual_steps, _, 0),
    flag(typhon_virtual_ends, _, 0).

virtual_end :-
    flag(typhon_virtual_ends, _, 1).

%!  virtual_loop(+Queue) is det.
%
%   Until ask(stop) comes. What agents draw by library(random) comes from the
%   generator of this thread: it begins alike each time, or see time_seed/1.

virtual_loop(Queue) :-
    set_random(seed(1)),
    empty_heap(Alarms),
    stand(Queue, alarms(0, Alarms)).

%!  virtual_now(-Stamp:float) is det.
%!  virtual_steps(-Count) is det.

virtual_now(Stamp) :-
    get_flag(typhon_virtual_now, Stamp).

virtual_steps(Count) :-
    get_flag(typhon_virtual_steps, Count).

%   Only this thread counts.

one_step_more :-
    get_flag(typhon_virtual_steps, Steps0),
    Steps is Steps0+1,
    set_flag(typhon_virtual_steps, Steps).

%!  virtual_doing(-Work) is semidet.
%
%   What this thread is about to do, if it is that of virtual time.

virtual_doing(Work) :-
    nb_current(typhon_virtual_work, doing(Work, _, _, _)).

%!  virtual_alone is semidet.
%
%   What this thread does now may go on as if it had come again: nothing else
%   is to be done, and no caller has what it waits for.

virtual_alone :-
    nb_current(typhon_virtual_work, doing(_, 0, Waiting, Queue)),
    \+ there(Queue),
    \+ ( member(Waits, Waiting), has_got(Waits) ),
    one_step_more.

%!  virtual_standing(-Standing) is semidet.
%
%   Where time stands, if this is its thread: a term from which it can go on, as
%   it would have,
%
%       virtual(Now, Random, Count, Alarms, Messages)
%
%   the time, the state of the generator, the number of the next alarm, those
%   alarms that are waited for, and what is still to be heard in the queue,
%   without questions.

virtual_standing(Standing) :-
    nb_current(typhon_virtual_alarms, Queue-Alarms),
    standing(Queue, Alarms, Standing).

standing(Queue, alarms(Count, Heap),
         virtual(Now, Random, Count, Alarms, Messages)) :-
    virtual_now(Now),
    random_property(state(Random)),
    heap_to_list(Heap, All0),
    exclude(is_over, All0, Alarms),
    fifo_empty(Queue, All),
    forall(member(Message, All), thread_send_message(Queue, Message)),
    exclude(is_question, All, Messages).

is_over(_-(Agent-Token)) :-
    catch(typhon_scheduler:over(Agent, Token), error(_, _), fail).

is_question(ask(_)).
is_question(held(_)).

%   What is in the queue comes after what was in it then.

standing_again(virtual(Now, Random, Count, Alarms, Messages), Queue,
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

%   stand(+Queue, +Alarms): no caller waits.  Alarms is alarms(Count, Heap), by
%   the keys at(Stamp, Number).

stand(Queue, Alarms) :-
    thread_get_message(Queue, ask(Ask)),
    asked(Ask, [], Queue, Alarms).

asked(stop, Waiting, _, _) :-
    !,
    late(Waiting).
asked(wait(Reply, Waited, Stamp), Waiting0, Queue, Alarms) :-
    !,
    satisfied([waits(Reply, Waited, Stamp)|Waiting0], Waiting),
    go(Waiting, Queue, Alarms).
asked(hold(Reply), Waiting, Queue, Alarms) :-
    !,
    forget_held(Queue),
    (   send(Reply, held)
    ->  hold(Queue, Alarms)
    ;   true                            % the caller has given up
    ),
    go(Waiting, Queue, Alarms).
asked(again(Standing, Reply), Waiting, Queue, _) :-
    !,
    standing_again(Standing, Queue, Alarms),
    ignore(send(Reply, done)),
    go(Waiting, Queue, Alarms).
asked(no_longer(Reply), Waiting0, Queue, Alarms) :-
    exclude(is_of(Reply), Waiting0, Waiting),
    go(Waiting, Queue, Alarms).

%   What was sent when time was not held.

forget_held(Queue) :-
    thread_peek_message(Queue, held(_)),
    !,
    thread_get_message(Queue, held(_)),
    forget_held(Queue).
forget_held(_).

hold(Queue, Alarms) :-
    thread_get_message(Queue, held(What)),
    (   What = standing(Reply)
    ->  standing(Queue, Alarms, Standing),
        ignore(send(Reply, Standing)),
        hold(Queue, Alarms)
    ;   true
    ).

is_of(Reply, waits(Reply, _, _)).

%   go(+Waiting, +Queue, +Alarms)
%   go(+Count, +Waiting, +Queue, +Alarms)
%
%   The second knows that Count messages at least are in Queue: only this thread
%   takes any, and to ask costs half a microsecond.

go([], Queue, Alarms) :-
    !,
    stand(Queue, Alarms).
go(Waiting, Queue, Alarms) :-
    message_queue_property(Queue, size(Count)),
    (   Count > 0
    ->  go(Count, Waiting, Queue, Alarms)
    ;   jump(Waiting, Queue, Alarms)
    ).

go(_, [], Queue, Alarms) :-
    !,
    stand(Queue, Alarms).
go(0, Waiting, Queue, Alarms) :-
    !,
    go(Waiting, Queue, Alarms).
go(Count, Waiting, Queue, Alarms) :-
    thread_get_message(Queue, Message),
    Left is Count-1,
    step(Message, Left, Waiting, Queue, Alarms).

step(do(Work), Left, Waiting0, Queue, Alarms) :-
    one_step_more,
    nb_linkval(typhon_virtual_work, doing(Work, Left, Waiting0, Queue)),
    nb_linkval(typhon_virtual_alarms, Queue-Alarms),
    catch(( work_do(Work, again(Queue)),
            Done = true ),
          Ball,
          go_on(Ball, Left, Waiting0, Queue, Alarms)),
    (   Done == true
    ->  next(Left, Waiting0, Queue, Alarms)
    ;   true
    ).
step(alarm(Stamp, What), Left, Waiting, Queue, alarms(Count0, Heap0)) :-
    add_to_heap(Heap0, at(Stamp, Count0), What, Heap),
    Count is Count0+1,
    go(Left, Waiting, Queue, alarms(Count, Heap)).
step(ask(Ask), _, Waiting, Queue, Alarms) :-
    asked(Ask, Waiting, Queue, Alarms).
step(held(_), Left, Waiting, Queue, Alarms) :-
    go(Left, Waiting, Queue, Alarms).   % it is not any more

next(Left, Waiting0, Queue, Alarms) :-
    nb_linkval(typhon_virtual_work, none),
    satisfied(Waiting0, Waiting),
    go(Left, Waiting, Queue, Alarms).

%   A goal that catches an abort is to be aborted when it has recovered.  So
%   this is where the loop goes on, to the end of time.

go_on(Ball, Left, Waiting, Queue, Alarms) :-
    aborted(Ball),
    flag(typhon_virtual_ends, 0, 0),
    !,
    next(Left, Waiting, Queue, Alarms).
go_on(Ball, _, Waiting, _, _) :-
    late(Waiting),
    throw(Ball).

aborted('$aborted').
aborted(unwind(abort)).

again(Queue, Work) :-
    thread_send_message(Queue, do(Work)).

%   There is nothing more to do at this instant.

jump(Waiting, Queue, alarms(Count, Heap)) :-
    first_end(Waiting, End),
    (   min_of_heap(Heap, at(Stamp, _), _),
        before(Stamp, End)
    ->  get_from_heap(Heap, _, What, Heap1),
        pass_to(Stamp),
        go_off(What),
        satisfied(Waiting, Waiting1),
        go(Waiting1, Queue, alarms(Count, Heap1))
    ;   number(End)
    ->  pass_to(End),
        partition(ends_at(End), Waiting, Late, Waiting1),
        late(Late),
        go(Waiting1, Queue, alarms(Count, Heap))
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

pass_to(Stamp) :-
    flag(typhon_virtual_now, Now, max(Now, float(Stamp))).

go_off(Agent-Token) :-
    debug(typhon(scheduler), 'alarm ~p of ~p', [Token, Agent]),
    catch(ignore(typhon_scheduler:fire(Agent, Token)), error(Formal, Where),
          print_error(error, error(Formal, Where))).

there(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   satisfied(+Waiting0, -Waiting): callers that have what they wait for are
%   notified.

satisfied(Waiting, Waiting) :-
    \+ ( member(Waits, Waiting), has_got(Waits) ),
    !.
satisfied(Waiting0, Waiting) :-
    partition(has_got, Waiting0, Happy, Waiting),
    forall(member(waits(Reply, _, _), Happy), reply(Reply, there)).

has_got(waits(_, Queue, _)) :-
    catch(there(Queue), error(existence_error(_, _), _), true).

late(Waiting) :-
    forall(member(waits(Reply, _, _), Waiting), reply(Reply, late)).

reply(Reply, Answer) :-
    ignore(send(Reply, Answer)).        % the caller was interrupted

send(Reply, Answer) :-
    catch(thread_send_message(Reply, Answer), error(existence_error(_, _), _),
          fail).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(virtual_nothing_due)) -->
    [ 'Virtual time has come to its end: no agent is ready, and nothing is \c
       due'-[] ].
