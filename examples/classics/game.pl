% game.pl: a game of tic-tac-toe moves from player to player

:- agent(game, []).
:- include(rules).

main :-
    neighbours([X, O]),
    length(Board, 9),
    maplist(=(-), Board),
    play(Board, x-X, o-O).

play(Board0, Mark-Host, Next) :-
    move(Host),
    choose(Board0, Mark, N),            % the player of this host
    put(Board0, N, Mark, Board),
    (   won(Board, Mark)
    ->  log(won(Mark, Board))
    ;   memberchk(-, Board)
    ->  play(Board, Next, Mark-Host)
    ;   log(drawn(Board))
    ).
