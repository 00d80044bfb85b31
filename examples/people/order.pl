% order.pl: sorts things by the taste of the class; each asked in turn

:- agent(order, [state([things/1, people/1])]).

main :-
    things(Things),
    neighbours(Hosts),
    assertz(people(Hosts)),
    sorted(Things, Sorted),
    result(Sorted).

sorted([X], [X]) :- !.
sorted(Xs, Sorted) :-
    length(Xs, Length),
    Half is Length//2,
    length(Front, Half),
    append(Front, Back, Xs),
    sorted(Front, A),
    sorted(Back, B),
    merged(A, B, Sorted).

merged([], Ys, Ys) :- !.
merged(Xs, [], Xs) :- !.
merged([X|Xs], [Y|Ys], [Better|More]) :-
    next_person(Host),
    move(Host),
    choose("Which is better?", [X,Y], Better),
    (   Better == X
    ->  merged(Xs, [Y|Ys], More)
    ;   merged([X|Xs], Ys, More)
    ).

next_person(Host) :-
    retract(people([Host|Hosts])),
    append(Hosts, [Host], Later),
    assertz(people(Later)).
