% thinker.pl: the agent here searches the game to its end

:- use_module(library(lists)).
:- include(rules).

choose(Board, Mark, N) :-
    findall(Value-M, ( put(Board, M, Mark, Next), value(Next, Mark, Value) ),
            Values),
    max_member(_-N, Values).

%   value(+Board, +Mark, -Value): 1, 0 or -1 for Mark, which has just moved.

value(Board, Mark, 1) :-
    won(Board, Mark),
    !.
value(Board, Mark, Value) :-
    other(Mark, Other),
    findall(V, ( put(Board, _, Other, Next), value(Next, Other, V) ), Values),
    (   max_list(Values, Best)
    ->  Value is -Best
    ;   Value = 0                       % the board is full
    ).
