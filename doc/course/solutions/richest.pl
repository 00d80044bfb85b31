% richest.pl: finds the host with the most gold

:- agent(richest, []).

main :-
    here(Home),
    neighbours(Hosts),
    visit([Home|Hosts], Found),
    max_member(Gold-Host, Found),
    result(richest(Host, Gold)).

visit([], []).
visit([Host|Hosts], [Gold-Host|Found]) :-
    move(Host),
    sense(gold(Gold)),
    visit(Hosts, Found).
