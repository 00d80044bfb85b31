% Expects: count/1; lib; default/2 is discontiguous.
% Gives: bred/2, and what population/replication gives.

/*  Cloning of agents that make progress, under the controller of chapter 6
    (thesis section 8.2); with the setting cloning-true.

    A step of life is an execution.  Progress, which is rewarded, is a plan
    that is longer than any that has been executed at this host; each host
    remembers, progress(Length).  So an agent has to be ahead of the others,
    without asking them. Where the length of a plan does not measure its
    value, cloning is of no use.

    A clone goes on with all its parent knows.  When its lifetime is over,
    without progress that prolongs it, it ends.
*/

:- include('../population/replication').

default(cloning, false).

fertile.

die :-
    log(state(death)),
    dispose.

%!  bred(+Outcome, +Length) is det.
%
%   After an execution of a plan of Length actions.  An agent that has
%   reached the goal needs no clones.  The queue of a host are the agents there,
%   without the trainer.

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
