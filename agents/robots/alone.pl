:- agent(alone, [state([tasks/2])]).
:- include('../sync/execution').

/*  Executes the tasks of a sequence on its host, one after the other, without
    regard to other agents: the behaviour of robots that are not synchronised.

    The fact tasks(Sequence, Tasks) has the tasks, a list of Task-Goal in
    order.  The agent begins at the message `begin`, and gives up at the first
    task that fails or raises an error.  It logs the same events of a task as
    a worker.
*/

main :-
    receive(_-begin),
    log(begun),
    tasks(Sequence, Tasks),
    execute(Tasks, Sequence).

execute([], _).
execute([Task-Goal|Tasks], Sequence) :-
    (   executed(Sequence, Task, Goal)
    ->  log(completed(Sequence, Task)),
        execute(Tasks, Sequence)
    ;   log(failed(Sequence, Task))
    ).
