% forager.pl: carries food to the host where it was created

:- agent(forager, []).

main :-
    search(60, 0).

%   search(+Patience, +Brought): Patience is the number of hosts that the ant
%   visits before it gives up.

search(0, Brought) :-
    !,
    result(Brought).
search(Patience, Brought) :-
    next_host(conscientious, Next),
    move(Next),
    (   take(food(N))
    ->  home(Nest),
        move(Nest),
        leave(stored(N)),
        More is Brought+1,
        search(60, More)
    ;   Left is Patience-1,
        search(Left, Brought)
    ).
