% foreman.pl: restarts a worker until it is done, but not too often

:- agent(foreman, [state([job/1, most/1])]).

main :-
    work(0).

work(Restarts) :-
    job(Clauses),
    create(clauses(Clauses), Worker, [name(worker), follows(true)]),
    monitor(Worker),
    receive(system-down(Worker, Outcome)),
    (   Outcome == done
    ->  result(done(Restarts))
    ;   most(Restarts)
    ->  result(gave_up(Outcome))
    ;   Next is Restarts+1,
        work(Next)
    ).
