% patient.pl: tries repeatedly to move to a host

:- agent(patient, [state([goal/1])]).

main :-
    goal(Host),
    try(Host, 1).

try(Host, Pause) :-
    now(Time),
    leave(tried(Time)),
    (   catch(move(Host), error(_, _), fail)
    ->  leave(here),
        result(got_in)
    ;   Pause > 64
    ->  result(gave_up)
    ;   sleep(Pause),
        Longer is 2*Pause,
        try(Host, Longer)
    ).
