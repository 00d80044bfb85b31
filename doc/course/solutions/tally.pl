% tally.pl: adds up numbers in messages

:- agent(tally, [state([sum/1])]).

sum(0).

on_message(_, add(N)) :-
    retract(sum(Old)),
    New is Old+N,
    assertz(sum(New)).
on_message(From, total) :-
    sum(Sum),
    send(From, total(Sum)).
on_message(_, go(Host)) :-
    move(Host).
