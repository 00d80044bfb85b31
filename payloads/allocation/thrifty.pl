:- payload(thrifty, [provides([agreed/3])]).

/*  The negotiation of an allocator that begins with low offers: a robot may
    cost as much as the task's detail budget(Cost), and twice as much with
    every back-off, for a task that is never done costs more.
*/

agreed(Cost, Details, Backoffs) :-
    (   member(budget(Budget), Details)
    ->  Cost =< Budget * 2**Backoffs
    ;   true
    ).
