:- module(typhon_threads,
          [ crew_start/0,
            crew_stop/1,                % -Unheard
            crew_spawn/2,               % :Goal, -Thread
            crew_spawn/3,               % :Goal, -Thread, :Before
            crew_aside/1,               % :Goal
            crew_retire/2,              % +Thread, +Why
            crew_signal/2,              % +Thread, +Why
            crew_bury/1,                % +Thread
            crew_tell/1,                % +Message
            crew_hear/2                 % -Message, +Deadline
          ]).

/** <module> The threads of an endpoint

Every thread of an endpoint is made here and is joined when it ends, so
that none outlives the endpoint. A thread that ends says so in the queue
of the endpoint, which one thread, the keeper, listens to.

_Threading_: crew_hear/2 and crew_bury/1 are for the keeper, the rest may
be called from any thread. crew_start/0 and crew_stop/1 are serialised by
the caller.
*/

:- meta_predicate
    crew_spawn(0, -),
    crew_spawn(0, -, 0),
    crew_aside(0).

:- dynamic
    crew_queue/1,                       % Queue
    member_thread/1.                    % Thread

%!  crew_start is det.

crew_start :-
    message_queue_create(Queue),
    assertz(crew_queue(Queue)).

%!  crew_stop(-Unheard) is det.
%
%   Stop and join all threads, whatever they do. Unheard are the messages
%   that nobody will hear any more.

crew_stop(Unheard) :-
    forall(member_thread(Thread), crew_retire(Thread, stopped)),
    (   member_thread(_)
    ->  crew_stop(Unheard)
    ;   with_mutex(typhon_threads, close_queue(Unheard))
    ).

close_queue(Unheard) :-
    retract(crew_queue(Queue)),
    findall(Message, unheard(Queue, Message), Unheard),
    message_queue_destroy(Queue).

unheard(Queue, Message) :-
    repeat,
    (   thread_peek_message(Queue, _)
    ->  thread_get_message(Queue, Message)
    ;   !,
        fail
    ).

%!  crew_spawn(:Goal, -Thread) is det.
%!  crew_spawn(:Goal, -Thread, :Before) is det.
%
%   Run Goal in a new thread. Goal reports its own errors; the exception
%   crew(Why) ends it quietly. Before is called here, in between: Thread is
%   known, and has not begun.

crew_spawn(Goal, Thread) :-
    crew_spawn(Goal, Thread, true).

crew_spawn(Goal, Thread, Before) :-
    sig_atomic(spawn(Goal, Thread, Before)).

spawn(Goal, Thread, Before) :-
    thread_create(typhon_threads:work(Goal), Thread, []),
    assertz(member_thread(Thread)),
    call(Before),
    thread_send_message(Thread, crew_registered).

work(Goal) :-
    setup_call_cleanup(
        true,
        catch(( thread_get_message(crew_registered), ignore(Goal) ),
              crew(_),
              true),
        ended).

ended :-
    thread_self(Me),
    ignore(crew_tell(ended(Me))).

%!  crew_aside(:Goal) is det.
%
%   Run Goal in a new thread or, where none can be made, here.

crew_aside(Goal) :-
    catch(crew_spawn(Goal, _), error(_, _), ignore(Goal)).

%!  crew_retire(+Thread, +Why) is det.
%
%   Throw crew(Why) in Thread, unless it has ended, and wait for its end.

crew_retire(Thread, Why) :-
    insist(Thread, Why, 0.001),
    crew_bury(Thread).

%   A signal that comes just before the thread blocks in a system call does
%   not wake it: insist.

insist(Thread, Why, Wait) :-
    (   running(Thread)
    ->  crew_signal(Thread, Why),
        sleep(Wait),
        Wait1 is min(0.1, 2*Wait),
        insist(Thread, Why, Wait1)
    ;   true
    ).

%!  crew_signal(+Thread, +Why) is det.
%
%   Throw crew(Why) in Thread, unless it has ended or was told before: a
%   second exception would break off the clean-up after the first.

crew_signal(Thread, Why) :-
    catch(thread_signal(Thread, typhon_threads:end_once(Why)),
          error(existence_error(_, _), _),
          true).

end_once(Why) :-
    (   nb_current(typhon_ending, true)
    ->  true
    ;   nb_setval(typhon_ending, true),
        throw(crew(Why))
    ).

running(Thread) :-
    catch(thread_property(Thread, status(running)),
          error(existence_error(_, _), _),
          fail).

%!  crew_bury(+Thread) is det.
%
%   Wait for the end of Thread.

crew_bury(Thread) :-
    (   retract(member_thread(Thread))
    ->  thread_join(Thread, Status),
        report(Status)
    ;   true
    ).

report(true) :-
    !.
report(exception(crew(_))) :-
    !.
report(exception(Error)) :-
    !,
    print_message(error, typhon(endpoint, thread_died(Error))).
report(_).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, thread_died(Error))) -->
    [ 'Endpoint: a thread died: ' ],
    '$messages':translate_message(Error).

%!  crew_tell(+Message) is semidet.
%
%   Tell the keeper; fails when there is none any more.

crew_tell(Message) :-
    with_mutex(typhon_threads,
               ( crew_queue(Queue),
                 thread_send_message(Queue, Message) )).

%!  crew_hear(-Message, +Deadline) is semidet.
%
%   The next message; fails at Deadline, a time stamp or `infinite`, if
%   there is none.

crew_hear(Message, Deadline) :-
    crew_queue(Queue),
    (   ( Deadline == infinite
        ; thread_peek_message(Queue, _) )
    ->  thread_get_message(Queue, Message)
    ;   thread_get_message(Queue, Message, [deadline(Deadline)])
    ).
