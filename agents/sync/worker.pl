:- agent(worker, [state([sequence/1])]).
:- include(execution).

/*  The worker of a host for one sequence of tasks, named by the fact
    sequence(Sequence): executes the tasks that travelling agents send to it,
    one at a time.  The tuple worker(Sequence, Id) marks it as free.  If the
    worker also executes tasks of other sequences, Sequence is the name of a
    pool (dependence.pl).

    While Task executes, the host has the tuple task(Sequence, Task, executing,
    Time), left by the agent that sent the task.  Afterwards its status is
    `completed`, or failed(atomic) if the task fails or raises an error: then
    agents will have it executed again.  If the tuple is missing by then, an
    operator has failed the task.

    After a failure the worker is not free for a second, and twice as long
    after each further failure in a row, up to 32 seconds: agents arrive at any
    time, and would repeat without end a task that cannot succeed.

        failures(Count)         failures in a row
*/

:- dynamic failures/1.

main :-
    sequence(Sequence),
    self(Me),
    leave(worker(Sequence, Me)).

on_message(_, execute(Task, Goal)) :-
    sequence(Sequence),
    carry_out(Sequence, Task, Goal).
on_message(_, execute(Sequence, Task, Goal)) :-
    carry_out(Sequence, Task, Goal).

carry_out(Sequence, Task, Goal) :-
    (   executed(Sequence, Task, Goal)
    ->  settle(Sequence, Task, completed),
        retractall(failures(_))
    ;   settle(Sequence, Task, failed(atomic)),
        back_off
    ),
    main.

back_off :-
    (   retract(failures(Count0))
    ->  true
    ;   Count0 = 0
    ),
    Seconds is 2**min(Count0, 5),
    Count is Count0 + 1,
    assertz(failures(Count)),
    sleep(Seconds).

settle(Sequence, Task, Status) :-
    take(task(Sequence, Task, executing, _)),
    !,
    now(Time),
    leave(task(Sequence, Task, Status, Time)),
    functor(Status, Name, _),           % completed, failed
    What =.. [Name, Sequence, Task],
    log(What).
settle(_, _, _).
