:- module(typhon_virtual,
          [ virtual_start/0,
            virtual_stop/0,
            virtual_work/1,             % +Work
            virtual_alarm/3,            % +Stamp, +Agent, +Token
            virtual_wait/3,             % +Queue, -Message, +Stamp
            virtual_hold/1,             % +Seconds
            virtual_stands/1,           % -Standing
            virtual_let_go/0,
            virtual_again/2,            % +Standing, -Agents
            virtual_signal/1            % :Goal
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/stop_thread', [stop_thread/1]).
:- use_module(work, [limit_parked/1]).
:- use_module(virtual_loop,
              [ virtual_begin/0, virtual_doing/1, virtual_end/0,
                virtual_loop/1, virtual_now/1, virtual_standing/1,
                virtual_steps/1 ]).

/** <module> Virtual time: nothing waits

One thread does all work, in the order in which it came.  When there is no
more, the clock jumps to the next alarm.  What is done thus follows from the
programs alone: not from how busy the machine is, nor from other threads.

Time runs while a caller waits, in virtual_wait/3, and stands still from the
moment at which what it waits for is there.  So whoever writes a program that
starts agents, waits, looks, and waits again finds the same each time.

A native goal takes no time.  One that does not end, and agents that go on
for ever at one instant, are reported.

*Threading*: any thread may call, and what two of them do at the same time
comes in any order; with one there is no chance.
*/

:- multifile
    prolog:message//1.

:- meta_predicate virtual_signal(0).

:- setting(patience, number, 10,
           "Virtual time that stands still for so long is reported").

:- dynamic
    loop/2.                             % Thread, Queue

                /*******************************
                *         START AND STOP       *
                *******************************/

%!  virtual_start is det.
%!  virtual_stop is det.
%
%   Time begins at 0.0, and stands still.  It ends, and what was to be done
%   is forgotten; a goal that runs is interrupted.

virtual_start :-
    message_queue_create(Queue),
    virtual_begin,
    thread_create(virtual_loop(Queue), Thread,
                  [alias(typhon_virtual_time)]),
    assertz(loop(Thread, Queue)).

virtual_stop :-
    retract(loop(Thread, Queue)),
    !,
    virtual_end,
    thread_send_message(Queue, ask(stop)),
    stop_thread(Thread),
    message_queue_destroy(Queue).
virtual_stop.

%!  virtual_work(+Work) is det.
%!  virtual_alarm(+Stamp, +Agent, +Token) is det.
%
%   What is to be done as soon as time runs, and what at Stamp.  Of two
%   alarms at the same Stamp the one that was set first goes off first.

virtual_work(Work) :-
    tell(do(Work)).

virtual_alarm(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    tell(alarm(Stamp, Agent-Token)).

tell(Message) :-
    (   loop(_, Queue)
    ->  catch(thread_send_message(Queue, Message),
              error(existence_error(_, _), _), true)
    ;   true                            % it has ended
    ).

%!  virtual_signal(:Goal) is det.

virtual_signal(Goal) :-
    forall(loop(Thread, _),
           catch(thread_signal(Thread, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *            HOLDING           *
                *******************************/

%!  virtual_hold(+Seconds) is semidet.
%!  virtual_stands(-Standing) is det.
%!  virtual_let_go is det.
%!  virtual_again(+Standing, -Agents) is det.
%
%   Nothing is done any more: fails if that is not so in Seconds of the time of
%   day.  Time is as Standing says.  It goes on.  It stands as it did
%   then, until a caller waits; Agents have their turns, or wait for them at
%   their hosts.  What is called in the thread of virtual time itself holds it
%   anyway.

virtual_hold(_) :-
    own_thread,
    !.
virtual_hold(Seconds) :-
    asked(ask(hold(Reply)), Reply, [timeout(Seconds)], held).

virtual_stands(Standing) :-
    own_thread,
    !,
    virtual_standing(Standing).
virtual_stands(Standing) :-
    asked(held(standing(Reply)), Reply, [], Standing).

virtual_let_go :-
    (   own_thread
    ->  true
    ;   tell(held(let_go))
    ).

own_thread :-
    loop(Thread, _),
    thread_self(Thread).

virtual_again(Standing, Agents) :-
    asked(ask(again(Standing, Reply)), Reply, [], done),
    findall(Agent, has_turn(Standing, Agent), Agents).

has_turn(virtual(_, _, _, _, Messages), Agent) :-
    member(do(Work), Messages),
    ( Work = agent(Agent) ; Work = agent(_, Agent) ).
has_turn(_, Agent) :-
    limit_parked(Agent).

asked(Question, Reply, Options, Answer) :-
    loop(_, Loop),
    setup_call_cleanup(
        message_queue_create(Reply),
        ( thread_send_message(Loop, Question),
          thread_get_message(Reply, Answer, Options)
        ),
        message_queue_destroy(Reply)).

                /*******************************
                *            WAITING           *
                *******************************/

%!  virtual_wait(+Queue, -Message, +Stamp) is semidet.
%
%   Let time run until there is a Message in Queue, which is taken; fails at
%   Stamp, a number or `inf`.  A goal of an agent cannot wait: while
%   it runs no time passes.

virtual_wait(Queue, Message, _) :-
    there(Queue),
    !,
    thread_get_message(Queue, Message).
virtual_wait(Queue, Message, Stamp) :-
    loop(Thread, Loop),
    \+ thread_self(Thread),
    setup_call_cleanup(
        message_queue_create(Reply),
        ( thread_send_message(Loop, ask(wait(Reply, Queue, Stamp))),
          answer(Reply, Answer)
        ),
        ( tell(ask(no_longer(Reply))),
          message_queue_destroy(Reply)
        )),
    Answer == there,
    thread_get_message(Queue, Message).

there(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   Meanwhile it is watched that something goes on.

answer(Reply, Answer) :-
    setting(patience, Seconds),
    course(Course),
    (   thread_get_message(Reply, Answer0, [timeout(Seconds)])
    ->  Answer = Answer0
    ;   complain(Course),
        answer(Reply, Answer)
    ).

course(course(Now, Steps)) :-
    virtual_now(Now),
    virtual_steps(Steps).

complain(course(Now, Steps0)) :-
    course(course(Now, Steps)),
    !,
    (   Steps-Steps0 =< 1               % it may just have begun
    ->  virtual_signal(typhon_virtual:tell_who)
    ;   print_message(warning, typhon(virtual_busy(Now)))
    ).
complain(_).

%   In the thread of virtual time, in the middle of what keeps it.

tell_who :-
    (   virtual_doing(Work)
    ->  virtual_now(Now),
        print_message(warning, typhon(virtual_stuck(Work, Now)))
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(virtual_stuck(Work, Now))) -->
    [ 'Virtual time stands still at ~3f: this does not end: ~p'-[Now, Work] ].
prolog:message(typhon(virtual_busy(Now))) -->
    [ 'Virtual time stands still at ~3f: there is always more to do at this \c
       instant'-[Now] ].
