:- payload(energy, [provides([cost/3])]).

/*  The cost of a task for a robot: its share of the robot's charge.

    Reads the robot's property battery=Charge, and the task's detail
    energy(Joules), in the same unit.  A robot with less charge is unfit.
*/

cost(need(_, _, Details), Properties, Cost) :-
    member(energy(Energy), Details),
    !,
    member(battery=Charge, Properties),
    Charge >= Energy,
    Charge > 0,
    Cost is Energy/Charge.
cost(_, _, 0).
