:- payload(nearest, [provides([cost/3])]).

/*  The cost of a task for a robot: the distance to its place.

    Needs the robot's property position=p(X, Y), and the task's detail at(p(X,
    Y)).  A task without a place costs nothing, nor does any task for a robot
    without a position.
*/

cost(need(_, _, Details), Properties, Cost) :-
    member(at(p(X, Y)), Details),
    member(position=p(X0, Y0), Properties),
    !,
    Cost is sqrt((X - X0)**2 + (Y - Y0)**2).
cost(_, _, 0).
