:- module(tartarus_threads,
          [ run_handler/4,              % +Name, +Handler, +Start, +When
            run_apart/1,                % :Goal
            when_through/2              % +Name, :Goal
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(records, [record_location/2]).

/** <module> Threads of handlers

Each call of a handler has a thread, which reads, sleeps and loops as it
likes; it is never ended.  What has to wait until an agent's last thread is
through is a thread of its own, which is notified.

*Threading*: any thread; one mutex.
*/

:- meta_predicate
    run_apart(0),
    when_through(+, 0).

:- dynamic
    last/2,                     % Name, Thread: runs its handler, the newest
    waits/2.                    % Thread, Queue: to be told of its end

%!  run_handler(+Name, +Handler, +Start, +When) is det.
%
%   Call Handler(Name, Location, Start) in a new thread, When is `now` or
%   `in_turn`: when the last thread of Name, if it runs, is through.  Failure
%   and errors go unsaid.

run_handler(Name, Handler, Start, When) :-
    record_location(Name, Location),
    Goal =.. [Handler,Name,Location,Start],
    with_mutex(tartarus_threads,
               ( before(When, Name, Before),
                 thread_create(tartarus_threads:handle(Name, Before, Goal),
                               Thread, [detached(true)]),
                 asserta(last(Name, Thread)) )).

before(now, _, none).
before(in_turn, Name, Thread) :-
    (   last(Name, Thread0)
    ->  Thread = Thread0
    ;   Thread = none
    ).

handle(Name, Before, Goal) :-
    call_cleanup(
        ( await(Before),
          catch(ignore(user:Goal), _, true) ),
        through(Name)).

through(Name) :-
    thread_self(Me),
    with_mutex(tartarus_threads,
               ( retractall(last(Name, Me)),
                 findall(Queue, waits(Me, Queue), Queues),
                 forall(member(Queue, Queues),
                        thread_send_message(Queue, through)) )).

%!  run_apart(:Goal) is det.
%
%   Run Goal in a thread that is not joined.

run_apart(Goal) :-
    thread_create(ignore(Goal), _, [detached(true)]).

%!  when_through(+Name, :Goal) is det.
%
%   Call Goal when the last thread of Name has ended, at once if none runs.

when_through(Name, Goal) :-
    with_mutex(tartarus_threads, before(in_turn, Name, Thread)),
    (   Thread == none
    ->  call(Goal)
    ;   run_apart(( tartarus_threads:await(Thread), Goal ))
    ).

await(none) :-
    !.
await(Thread) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        (   with_mutex(tartarus_threads, watched(Thread, Queue))
        ->  thread_get_message(Queue, through)
        ;   true
        ),
        forget(Queue)).

watched(Thread, Queue) :-
    last(_, Thread),
    !,
    assertz(waits(Thread, Queue)).

forget(Queue) :-
    with_mutex(tartarus_threads, retractall(waits(_, Queue))),
    message_queue_destroy(Queue).
