% Expects: plan/3, after/3, setting/2.
% Gives: seize/1, give_back/1, order/3, held_up/1.

/*  Several sequences on overlapping sets of hosts: beyond the thesis.

    Hosts may have one worker for all sequences of a pool, so that no host
    executes for two at once.  The setting `pool` of an agent names it; by
    default each sequence has its own.  An agent that finds the worker taken
    goes on, as at a host that executes.  A worker waits for nothing else
    while it executes, so sequences of a pool cannot block each other.

    A fact after(Task, Other, First) says that no host executes Task before it
    has completed task First of the sequence Other, if it has a part in that.
*/

%!  seize(-Worker) is semidet.
%!  give_back(+Worker) is det.
%
%   Of a host that has a part in the sequence.  Where the worker is that of a
%   pool, a plan shows which sequences have.

seize(Worker) :-
    pool(Sequence, Pool),
    (   Pool == Sequence
    ->  true
    ;   sense(plan(Sequence, _, _))
    ),
    take(worker(Pool, Worker)).

give_back(Worker) :-
    pool(_, Pool),
    leave(worker(Pool, Worker)).

pool(Sequence, Pool) :-
    plan(Sequence, _, _),
    (   setting(pool, Pool0)
    ->  Pool = Pool0
    ;   Pool = Sequence
    ).

%!  order(+Task, +Goal, -Order) is det.
%
%   What the worker is sent.

order(Task, Goal, Order) :-
    pool(Sequence, Pool),
    (   Pool == Sequence
    ->  Order = execute(Task, Goal)
    ;   Order = execute(Sequence, Task, Goal)
    ).

%!  held_up(+Task) is semidet.
%
%   This host has to complete a task of another sequence before Task.

held_up(Task) :-
    after(Task, Other, First),
    sense(plan(Other, _, _)),
    \+ sense(task(Other, First, completed, _)),
    !.
