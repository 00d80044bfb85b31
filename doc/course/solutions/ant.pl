% ant.pl: looks for food, and marks the way back, a cheap one more strongly

:- agent(ant, []).

main :-
    here(Nest),
    search([Nest], 0, Way, Cost),
    Mark is 10/Cost**2,
    go_back(Way, Mark),
    result(way(Cost)).

%   search(+Path, +Cost0, -Way, -Cost): Path and Way, from here to the nest.

search(Path, Cost, Path, Cost) :-
    sense(food),
    !.
search(Path, Cost0, Way, Cost) :-
    findall(Weight-Next,
            ( neighbour(Next, _),
              \+ memberchk(Next, Path),
              weight(Next, Weight) ),
            Choices),
    (   Choices == []
    ->  give_up(Path, Way, Cost)
    ;   draw(Choices, Next),
        neighbour_cost(Next, Step),
        sleep(Step),
        move(Next),
        Cost1 is Cost0+Step,
        search([Next|Path], Cost1, Way, Cost)
    ).

%   A dead end: begin again.

give_up(Path, Way, Cost) :-
    last(Path, Nest),
    move(Nest),
    search([Nest], 0, Way, Cost).

weight(Next, Weight) :-
    (   sense(trail(Next, Strength))
    ->  Weight is 0.3+Strength
    ;   Weight = 0.3
    ).

neighbour_cost(Next, Cost) :- neighbour(Next, Cost), !.

%   draw(+Choices, -Next): the greater the weight the more likely.

draw(Choices, Next) :-
    pairs_keys(Choices, Weights),
    sum_list(Weights, Sum),
    random(R),
    Point is R*Sum,
    draw(Choices, Point, Next).

draw([_-Next], _, Next) :-
    !.
draw([Weight-Next|Choices], Point, Found) :-
    (   Point < Weight
    ->  Found = Next
    ;   Rest is Point-Weight,
        draw(Choices, Rest, Found)
    ).

go_back([_], _).
go_back([To, Host|Path], Mark) :-
    move(Host),
    mark(To, Mark),
    go_back([Host|Path], Mark).

mark(To, Mark) :-
    (   take(trail(To, Old))
    ->  true
    ;   Old = 0
    ),
    New is Old+Mark,
    leave(trail(To, New)).
