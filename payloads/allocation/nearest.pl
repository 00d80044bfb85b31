:- payload(nearest, [provides([cost/3])]).

/*  What a task costs a robot: the way to where it is to be done.

    Needs the robot's property position=p(X, Y), and the task's detail
    at(p(X, Y)).  A task that is nowhere costs nothing, and so does one for
    a robot that does not know where it is.
*/

cost(need(_, _, Details), Properties, Cost) :-
    member(at(p(X, Y)), Details),
    member(position=p(X0, Y0), Properties),
    !,
    Cost is sqrt((X - X0)**2 + (Y - Y0)**2).
cost(_, _, 0).
