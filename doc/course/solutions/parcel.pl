% parcel.pl: follows the strongest trail

:- agent(parcel, []).

main :-
    here(Nest),
    go([Nest], 0).

go(Path, Cost) :-
    (   sense(food)
    ->  reverse(Path, Way),
        result(way(Cost, Way))
    ;   strongest(Path, Next, Step),
        move(Next),
        Cost1 is Cost+Step,
        go([Next|Path], Cost1)
    ).

strongest(Path, Next, Step) :-
    aggregate_all(max(Strength, To),
                  ( sense(trail(To, Strength)),
                    \+ memberchk(To, Path) ),
                  max(_, Next)),
    once(neighbour(Next, Step)).
