:- module(typhon_virtual, []).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/own_thread', [stop_thread/1]).
:- use_module('../kernel/host', [limit_parked/1]).
:- use_module(virtual/virtual_loop,
              [ virtual_alone/0, virtual_begin/0, virtual_doing/1,
                virtual_end/0, virtual_loop/1, virtual_now/1,
                virtual_standing/1, virtual_steps/1 ]).

/** <module> The runtime `virtual`: nothing waits

One thread does all work, in the order in which it came.  When there is no
more, the clock jumps to the next alarm.  What is done thus follows from the
programs alone: not from how busy the machine is, nor from other threads.

Time runs while a caller waits, in time_wait/3, and stands still from the
moment at which what it waits for is there.  So a program that starts agents,
waits, looks, and waits again finds the same each time.

A native goal takes no time.  One that does not end, and agents that go on
for ever at one instant, are reported.

*Threading*: any thread may call, and what two of them do at the same time
comes in any order; with one there is no chance.
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
    typhon_time:stands/2,
    typhon_time:starts/1,
    typhon_time:stops/1,
    typhon_time:wait/4,
    typhon_time:wanted/2,
    typhon_time:work/2.

:- setting(patience, number, 10,
           "Virtual time that stands still for so long is reported").

:- dynamic
    loop/2.                             % Thread, Queue

typhon_options:declared(host_option, clock(Kind), oneof([virtual]), Kind).

typhon_time:wanted(clock(virtual), virtual).

typhon_time:apart(virtual, 'virtual:0').

typhon_time:repeats(virtual, 'v.').

typhon_time:clock(virtual, typhon_virtual_loop:virtual_now).

                /*******************************
                *         START AND STOP       *
                *******************************/

%   Time begins at 0.0, and stands still.  It ends, also if it is held, and what
%   was to be done is forgotten; a goal that runs is interrupted.

typhon_time:starts(virtual) :-
    message_queue_create(Queue),
    virtual_begin,
    thread_create(virtual_loop(Queue), Thread,
                  [alias(typhon_virtual_time)]),
    assertz(loop(Thread, Queue)).

typhon_time:stops(virtual) :-
    retract(loop(Thread, Queue)),
    !,
    virtual_end,
    thread_send_message(Queue, held(let_go)),
    thread_send_message(Queue, ask(stop)),
    stop_thread(Thread),
    message_queue_destroy(Queue).

                /*******************************
                *        WORK AND ALARMS       *
                *******************************/

%   What is to be done as soon as time runs, and what at Stamp.  Of two
%   alarms at the same Stamp the one that was set first goes off first.

typhon_time:work(virtual, Work) :-
    tell(do(Work)).

typhon_time:alarm(virtual, Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    tell(alarm(Stamp, Agent-Token)).

typhon_time:seed(virtual, Seed) :-
    tell(do(goal(set_random(seed(Seed))))).

typhon_time:alone(virtual) :-
    virtual_alone.

tell(Message) :-
    (   loop(_, Queue)
    ->  catch(thread_send_message(Queue, Message),
              error(existence_error(_, _), _), true)
    ;   true                            % it has ended
    ).

typhon_time:signal(virtual, Goal) :-
    signal(Goal).

signal(Goal) :-
    forall(loop(Thread, _),
           catch(thread_signal(Thread, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *            HOLDING           *
                *******************************/

%   Where time stands is known, see virtual_standing/1.  When it is let go, or
%   goes on from such a term, it stands until a caller waits.  What is called in
%   the thread of virtual time itself holds it anyway.

typhon_time:hold(virtual, Seconds) :-
    (   own_thread
    ->  true
    ;   asked(ask(hold(Reply)), Reply, [timeout(Seconds)], held)
    ).

typhon_time:stands(virtual, Standing) :-
    (   own_thread
    ->  virtual_standing(Standing)
    ;   asked(held(standing(Reply)), Reply, [], Standing)
    ).

typhon_time:let_go(virtual, []) :-
    (   own_thread
    ->  true
    ;   tell(held(let_go))
    ).

own_thread :-
    loop(Thread, _),
    thread_self(Thread).

typhon_time:again(virtual, Standing, Agents) :-
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

%   Time runs until there is a message in Queue, or until Stamp.  A goal of an
%   agent cannot wait: while it runs no time passes.

typhon_time:wait(virtual, Queue, Message, Stamp) :-
    (   there(Queue)
    ->  true
    ;   comes(Queue, Stamp)
    ),
    thread_get_message(Queue, Message).

comes(Queue, Stamp) :-
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
    Answer == there.

there(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   Meanwhile this thread looks whether something goes on.

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
    ->  signal(typhon_virtual:report_work)
    ;   print_message(warning, typhon(virtual_busy(Now)))
    ).
complain(_).

%   In the thread of virtual time, in the middle of what keeps it.

report_work :-
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
