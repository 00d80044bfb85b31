:- payload(thrifty, [provides([agreed/3])]).

/*  The negotiation of an allocator that begins with low offers: a robot may
    cost up to the task's detail budget(Cost), which doubles with every
    back-off, because a task that is never done is more expensive.
*/

agreed(Cost, Details, Backoffs) :-
    (   member(budget(Budget), Details)
    ->  Cost =< Budget * 2**Backoffs
    ;   true
    ).
