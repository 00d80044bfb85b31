:- agent(specialist, [state([sequence/1, task/2, previous/1, mood/1, psi/1,
                             history/1, start/1])]).
:- include('../population/cloning').
:- include('../lib/await_order').
:- include(stimulation).

/*  One kind of agent for each task (thesis chapter 6).  Agents that know
    one task and the name of the task before it, and nothing of each other,
    execute a sequence of tasks on every host, and proceed to the next task
    at the same time.  Their number follows the demand for their task.

    Facts: sequence(Sequence); task(Task, Goal), the task and its code;
    previous(Task), the task before it, previous(none) for the first.
    Facts setting(Name, Value) replace the defaults here and in the cloning
    controller.

    On the hosts: task(Sequence, Task, Status, Time) records an execution, and
    worker(Sequence, Id) is present while the host's worker is free.  A host
    takes no part in the sequence if it has no worker for it, or has the tuple
    left(Sequence).
*/

default(psi, 100, range(1, 1000, 0.5),
        "the action potential at the beginning").
default(kappa, 1, range(0.01, 10, 0.01), "of equation 6.9").
default(omega, 5, range(1, 50, 1), "length of the history").
default(threshold, 0.01, range(0, 1, 0.001),
        "below it an action potential counts as zero").
default(start, now, [now, order], "order: waits for the message begin").

main :-
    await_order,
    parameter(psi, Psi),
    now(Now),
    assertz(psi(Psi)),
    assertz(history([])),
    assertz(start(Now)),
    turn_to(dormant),
    log(begun),
    live.

fertile :-
    mood(active).

%   The statements S1 to S4 of the thesis.  S4 also requires the previous
%   task: otherwise agents would skip missing tasks.

visit(0) :-
    \+ takes_part,
    !.
visit(0) :-                     % S1: migration without execution
    mood(dormant),
    lacks_previous,
    !.
visit(0) :-                     % S3: negative stimulation
    mood(excited),
    lacks_previous,
    !,
    stimulate(negative).
visit(0) :-                     % S2: positive stimulation
    \+ mood(active),
    lacks_mine,
    !,
    excite,
    remember,
    stimulate(positive).
visit(1) :-                     % S4: execution
    mood(active),
    \+ lacks_previous,
    lacks_mine,
    seize(Worker),
    !,
    service(Worker).
visit(0).

%   A busy worker has no tuple, but its task has one.

takes_part :-
    sequence(Sequence),
    \+ sense(left(Sequence)),
    (   sense(worker(Sequence, _))
    ->  true
    ;   sense(task(Sequence, _, _, _))
    ->  true
    ).

lacks_previous :-
    previous(Task),
    Task \== none,
    lacks(Task).

lacks_mine :-
    task(Task, _),
    lacks(Task).

lacks(Task) :-
    sequence(Sequence),
    \+ sense(task(Sequence, Task, completed, _)).

%   The worker may have executed this task just before it became free.

seize(Worker) :-
    sequence(Sequence),
    take(worker(Sequence, Worker)),
    (   lacks_mine
    ->  true
    ;   leave(worker(Sequence, Worker)),
        fail
    ).

service(Worker) :-
    sequence(Sequence),
    task(Task, Goal),
    now(Time),
    ignore(take(task(Sequence, Task, failed(_), _))),
    leave(task(Sequence, Task, executing, Time)),
    send(Worker, execute(Task, Goal)).

                /*******************************
                *          STIMULATION         *
                *******************************/

excite :-
    mood(excited),
    !.
excite :-
    turn_to(excited).

%   The first task has no previous one: its times count from the start.

remember :-
    arrival(Arrival),
    due_since(Since),
    Difference is Arrival - Since,
    retract(history(History0)),
    parameter(omega, Window),
    remembered(Window, History0, Difference, History),
    assertz(history(History)).

due_since(Since) :-
    previous(none),
    !,
    start(Since).
due_since(Since) :-
    previous(Task),
    sequence(Sequence),
    sense(task(Sequence, Task, completed, Since)),
    !.

stimulate(Sign) :-
    history(History),
    parameter(kappa, Kappa),
    dispersion(Kappa, History, Sigma),
    retract(psi(Psi0)),
    parameter(threshold, Threshold),
    stimulated(Sign, Psi0, Sigma, Threshold, Psi),
    assertz(psi(Psi)),
    log(psi(Psi)),
    (   Psi =:= 0
    ->  turn_to(active)
    ;   true
    ).

turn_to(Mood) :-
    keep(mood(Mood)),
    log(state(Mood)).
