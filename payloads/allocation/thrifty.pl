:- payload(thrifty, [provides([agreed/3])]).

/*  The negotiation of an allocator that begins with low offers: it accepts a
    cost up to the task's detail budget(Cost), which doubles with every
    back-off, because a task that is never executed costs more.
*/

agreed(Cost, Details, Backoffs) :-
    (   member(budget(Budget), Details)
    ->  Cost =< Budget * 2**Backoffs
    ;   true
    ).
