:- payload(willing, [provides([agreed/3])]).

/*  The negotiation of an allocator that accepts every robot.

        agreed(+Cost, +Details, +Backoffs)

    succeeds if the allocator, after Backoffs back-offs, reserves a robot that
    executes the task with Details for Cost.
*/

agreed(_, _, _).
