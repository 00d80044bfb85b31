% pathfinder.pl: A*; each town knows only its own roads

:- agent(pathfinder, [state([start/1, goal/1, closed/1])]).

main :-
    start(Start),
    search([0-way(0, [Start])]).

%   search(+Open): ways, in order of their estimated total cost.

search([_-way(Km, [Town|Path])|Open]) :-
    (   goal(Town)
    ->  reverse([Town|Path], Way),
        result(way(Km, Way))
    ;   closed(Town)
    ->  search(Open)
    ;   assertz(closed(Town)),
        move(Town),
        findall(Next, longer(Km, [Town|Path], Next), Nexts),
        append(Nexts, Open, Unsorted),
        keysort(Unsorted, Sorted),
        search(Sorted)
    ).

longer(Km0, [Town|Path], Least-way(Km, [Next, Town|Path])) :-
    sense(road(Next, Road)),
    \+ closed(Next),
    Km is Km0+Road,
    goal(Goal),
    at(Next, X, Y),                     % from the map that it carries
    at(Goal, X1, Y1),
    Least is Km+sqrt((X1-X)**2+(Y1-Y)**2).
