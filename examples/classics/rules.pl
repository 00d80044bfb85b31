% rules.pl: of tic-tac-toe. A board is a list of x, o and - (free).

put(Board0, N, Mark, Board) :-
    nth1(N, Board0, -, Others),
    nth1(N, Board, Mark, Others).

won(Board, Mark) :-
    line(A, B, C),
    nth1(A, Board, Mark),
    nth1(B, Board, Mark),
    nth1(C, Board, Mark),
    !.

line(1, 2, 3).  line(4, 5, 6).  line(7, 8, 9).
line(1, 4, 7).  line(2, 5, 8).  line(3, 6, 9).
line(1, 5, 9).  line(3, 5, 7).

other(x, o).
other(o, x).
