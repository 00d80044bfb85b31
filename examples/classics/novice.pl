% novice.pl: the agent here takes the first free square

:- use_module(library(lists)).
:- include(rules).

choose(Board, Mark, N) :-
    once(put(Board, N, Mark, _)).
