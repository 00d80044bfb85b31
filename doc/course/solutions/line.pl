% line.pl: people stand in a line by height; all are asked at the same time

:- agent(line, []).

main :-
    neighbours(Hosts),
    put_questions(Hosts, Questions),
    collect(Questions, Heights),
    keysort(Heights, Sorted),
    pairs_values(Sorted, Line),
    show_places(Line, 1),
    result(Line).

put_questions([], []).
put_questions([Host|Hosts], [Number-Host|Questions]) :-
    move(Host),
    person_ask(number("How tall are you, in cm?"), text, Number),
    put_questions(Hosts, Questions).

collect([], []).
collect([Number-Host|Questions], [Height-Host|Heights]) :-
    receive(people-answer(Number, given(Height))),
    collect(Questions, Heights).

show_places([], _).
show_places([Host|Hosts], N) :-
    move(Host),
    show(place(N)),
    N1 is N+1,
    show_places(Hosts, N1).
