/*  Cloning of agents that make progress, under the controller of chapter 6
    (thesis section 8.2).  To be included; with the setting cloning-true.

    A step of life is an execution.  Progress, which is rewarded, is a plan
    that is longer than any before: by then the agent has taken in what those
    it met knew, so it is ahead of them, too.  Where the length of plans says
    nothing, cloning is of no use.

    A clone goes on with all its parent knows.  When its lifetime is over,
    without progress that prolongs it, it ends.
*/

:- include('../population/replication').
:- dynamic longest/1.

default(cloning, false).

fertile.

die :-
    log(state(death)),
    dispose.

%!  born is det.
%
%   The beginning of an agent that is no clone.

born :-
    endowed,
    keep(longest(0)).

%!  bred(+Outcome, +Length) is det.
%
%   After an execution of a plan of Length actions.  Who has reached the goal
%   needs no clones.  The queue of a host are those who are there, but for
%   the trainer.

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

progress(Length, Reward) :-
    longest(Longest),
    (   Length > Longest
    ->  keep(longest(Length)),
        Reward = 1
    ;   Reward = 0
    ).

counted_from(parent).
counted_from(clone) :-
    keep(count(0)).
