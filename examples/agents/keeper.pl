% Static; stores notes: remember(Note), recall, go(Host), stop.

:- agent(keeper, [state([note/1])]).

on_message(_, remember(Note)) :-
    assertz(note(Note)).
on_message(_, recall) :-
    forall(note(Note), log(note(Note))).
on_message(_, go(Host)) :-
    move(Host).
on_message(_, stop) :-
    dispose.
