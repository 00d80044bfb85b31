:- agent(worker, []).

/*  The worker of a host: executes the tasks that travelling agents hand
    over, one at a time.  The tuple worker(Id) says that it is free.
    While Task executes the host has the tuple task(Task, executing), put
    there by who handed it over; afterwards task(Task, completed).
    A task that raises or fails leaves neither, so it is done again.
*/

main :-
    self(Me),
    leave(worker(Me)).

on_message(_, execute(Task, Goal)) :-
    log(executing(Task)),
    (   catch(Goal, error(Error, _), (log(raised(Task, Error)), fail))
    ->  settle(Task, completed)
    ;   settle(Task, failed)
    ),
    self(Me),
    leave(worker(Me)).

settle(Task, Outcome) :-
    (   take(task(Task, executing)),
        Outcome == completed
    ->  leave(task(Task, completed)),
        log(completed(Task))
    ;   log(failed(Task))
    ).
