:- payload(willing, [provides([agreed/3])]).

/*  The negotiation of an allocator that takes every robot it can get.

        agreed(+Cost, +Details, +Backoffs)

    succeeds if a robot that would do the task with Details for Cost is to
    be reserved, after so many back-offs.
*/

agreed(_, _, _).
