% Expects: plan/3, after/3, setting/2.
% Gives: seize/1, give_back/1, order/3, held_up/1.

/*  Several sequences on overlapping sets of hosts: beyond the thesis.

    A host may have one worker for all sequences of a pool, so that it never
    executes tasks of two sequences at once.  The setting `pool` of an agent
    names the pool; by default each sequence has its own.  An agent that finds
    the worker busy moves on, as at a host that executes.  A worker waits for
    nothing else while it executes, so sequences of a pool cannot block each
    other.

    A fact after(Task, Other, First) means that a host that takes part in the
    sequence Other executes Task only after it has completed task First of
    Other.
*/

%!  seize(-Worker) is semidet.
%!  give_back(+Worker) is det.
%
%   Take and put back the worker of a host that takes part in the sequence.  A
%   worker of a pool serves several sequences; the plans on the host show
%   which of them.

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
%   Order is the message to the worker.

order(Task, Goal, Order) :-
    pool(Sequence, Pool),
    (   Pool == Sequence
    ->  Order = execute(Task, Goal)
    ;   Order = execute(Sequence, Task, Goal)
    ).

%!  held_up(+Task) is semidet.
%
%   True if this host must complete a task of another sequence before Task.

held_up(Task) :-
    after(Task, Other, First),
    sense(plan(Other, _, _)),
    \+ sense(task(Other, First, completed, _)),
    !.
