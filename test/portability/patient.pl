:- agent(patient, [state([route/1])]).

% Waits at each host of its route, with many goals left, for terms that are
% sent to it, and compares them with those of the place.

main :-
    route(Hosts),
    findall(Name-Term, term(Name, Term), Pairs),
    stations(Hosts),
    wait_with(Pairs).

stations([]).
stations([Host|Hosts]) :-
    move(Host),
    receive(_-Pairs),
    compare(Pairs),
    stations(Hosts).

compare(Pairs) :-
    findall(Name, ( member(Name-Term, Pairs), same(Name, Term) ), Intact),
    findall(Name, term(Name, _), Names),
    (   Intact == Names
    ->  leave(intact)
    ;   subtract(Names, Intact, Damaged),
        throw(damaged(Damaged))
    ).

wait_with(_).
