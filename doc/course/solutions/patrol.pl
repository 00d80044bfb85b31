% patrol.pl: visits a list of hosts, and skips those that refuse it

:- agent(patrol, [state([todo/1])]).

main :-
    todo(Hosts),
    visit(Hosts, Seen, Skipped),
    result(patrol(Seen, Skipped)).

visit([], [], []).
visit([Host|Hosts], Seen, Skipped) :-
    (   catch(move(Host), error(_, _), fail)
    ->  leave(patrolled),
        Seen = [Host|More],
        visit(Hosts, More, Skipped)
    ;   Skipped = [Host|More],
        visit(Hosts, Seen, More)
    ).
