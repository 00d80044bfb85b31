:- payload(nearest, [provides([cost/3])]).

/*  The cost of a task for a robot: the distance to the place of the task.

    Reads the robot's property position=p(X, Y), and the task's detail at(p(X,
    Y)).  The cost is 0 if the task has no place, or the robot no position.
*/

cost(need(_, _, Details), Properties, Cost) :-
    member(at(p(X, Y)), Details),
    member(position=p(X0, Y0), Properties),
    !,
    Cost is sqrt((X - X0)**2 + (Y - Y0)**2).
cost(_, _, 0).
