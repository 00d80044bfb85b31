:- agent(worker, [state([sequence/1])]).
:- include(execution).

/*  The worker of a host for one sequence of tasks, named by the fact
    sequence(Sequence): executes the tasks that travelling agents hand over,
    one at a time.  The tuple worker(Sequence, Id) marks it as free.  Tasks of
    other sequences may be handed over, too: then Sequence is the name of a
    pool (dependence.pl).

    While Task executes the host has the tuple task(Sequence, Task, executing,
    Time), put there by the agent that handed it over; afterwards it says
    `completed`, or, of a task that fails or raises something, failed(atomic):
    it will be done again.  If the tuple is gone by then, an operator has
    failed the task.

    After a failure the worker is not free for a second, and twice as long
    after each one that follows, up to 32 seconds: agents arrive at any time,
    and would repeat a task that cannot succeed without end.

        failures(Count)         so many in a row
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
