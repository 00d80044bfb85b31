% Expects: count/1; lib; default/4 is discontiguous.
% Gives: bred/2, and what population/replication gives.

/*  Cloning of agents that make progress, under the controller of chapter 6
    (thesis section 8.2); enabled by the setting cloning-true.

    A step of life is an execution.  Progress, which is rewarded, is a plan
    longer than any executed before at this host; the host stores that length
    in progress(Length).  So an agent knows whether it is ahead of the others
    without asking them. Where the length of a plan does not measure its
    value, cloning is of no use.

    A clone inherits all knowledge of its parent.  It ends when its lifetime
    is over, unless progress prolongs it.
*/

:- include('../population/replication').

default(cloning, false, [true, false], "true: agents that make progress clone").

fertile.

die :-
    log(state(death)),
    dispose.

%!  bred(+Outcome, +Length) is det.
%
%   Called after an execution of a plan of Length actions.  An agent that has
%   reached the goal needs no clones.  The queue of a host consists of the
%   agents there, except the trainer.

bred(_, _) :-
    parameter(cloning, false),
    !.
bred(reached(_), _).
bred(unreached, Length) :-
    older(1),
    progress(Length, Reward),
    host_load(Load),
    Queue is Load - 1,
    gain(Reward, Queue),
    replicate(Reward, Queue, Role),
    counted_from(Role).

progress(Length, 1) :-
    Length > 0,
    \+ ( sense(progress(Longest)), Longest >= Length ),
    !,
    ignore(take(progress(_))),
    leave(progress(Length)).
progress(_, 0).

counted_from(parent).
counted_from(clone) :-
    keep(count(0)).
