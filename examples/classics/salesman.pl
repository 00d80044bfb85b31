% salesman.pl: the shortest tour through all towns, by clones

:- agent(salesman, []).

main :-
    here(Home),
    sense(at(Place)),
    tour([Home], Place, 0, Tour),
    result(Tour).

%   tour(+Path, +Place, +Km, -Tour): the best tour that begins with Path,
%   the last town first, after Km kilometres; Place is its position.

tour(Path, Place, Km, Tour) :-
    neighbours(Towns),
    subtract(Towns, Path, Rest),
    send_out(Rest, Path, Place, Km, Clones),
    (   Clones == []
    ->  go_home(Path, Place, Km, Tour)
    ;   tours(Clones, Tours),
        min_member(Tour, Tours)
    ).

send_out([], _, _, _, []).
send_out([Town|Towns], Path, Place, Km, Clones) :-
    clone(Town, Who),
    (   Who = clone(Parent)             % in Town, with all bindings
    ->  way(Place, There, Km, Km1),
        tour([Town|Path], There, Km1, Tour),
        send(Parent, Tour),
        dispose
    ;   Who = parent(Clone),
        Clones = [Clone|More],
        send_out(Towns, Path, Place, Km, More)
    ).

tours([], []).
tours([Clone|Clones], [Tour|Tours]) :-
    receive(Clone-Tour),
    tours(Clones, Tours).

go_home(Path, Place, Km, tour(Km1, Towns)) :-
    last(Path, Home),
    move(Home),
    way(Place, _, Km, Km1),
    reverse([Home|Path], Towns).

way(X0/Y0, X/Y, Km0, Km) :-
    sense(at(X/Y)),
    Km is Km0+sqrt((X-X0)**2+(Y-Y0)**2).
