:- agent(carrier, [state([route/1, holds/2, at/1])]).

% Takes one term of every kind from its first host, in facts and in variables,
% and compares both with the terms of each host of its route.

main :-
    findall(Name-Term, term(Name, Term), Pairs),
    forall(member(Name-Term, Pairs), assertz(holds(Name, Term))),
    route(Hosts),
    travel(Hosts, Pairs),
    home(Home),
    move(Home),
    findall(Host, at(Host), Visited),
    leave(travelled(Visited)).

travel([], _).
travel([Host|Hosts], Pairs) :-
    move(Host),
    here(Here),
    assertz(at(Here)),
    compare(Here, Pairs),
    travel(Hosts, Pairs).

compare(Here, Pairs) :-
    findall(Name-Term, holds(Name, Term), Held),
    intact(Here, facts, Held),
    intact(Here, goals, Pairs).

intact(Here, How, Pairs) :-
    forall(term(Name, _), intact(Here, How, Name, Pairs)),
    length(Pairs, Count),
    findall(x, term(_, _), Expected),
    (   length(Expected, Count)
    ->  true
    ;   throw(damaged(Here, How, count(Count)))
    ).

intact(Here, How, Name, Pairs) :-
    (   member(Name-Term, Pairs),
        same(Name, Term)
    ->  true
    ;   throw(damaged(Here, How, Name))
    ).
