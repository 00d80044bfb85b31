% Expects: parameters, keep, clones of lib; fertile/0, die/0 of the program.
% Gives: endowed/0, older/1, gain/2, replicate/3; its state.

/*  The price of clones and their lifetime: the cloning resource of thesis
    section 6.2, applied to an agent.

    The program that includes this file defines

        fertile                 true while the agent may clone
        die                     called when its lifetime is over

    and calls endowed/0 when it begins, and in each step of its life
    older/1, gain/2 and replicate/3.  An agent that was created, not
    cloned, never dies.

    The names of the parameters are those of the thesis.
*/

:- include(resource).
:- dynamic setting/2, resource/1, lifetime/1.

default(q_th, 4, range(1, 20, 1), "slots of a queue").
default(cr_min, 10, range(0, 100, 0.5),
        "cloning resource conferred on a clone").
default(cr_max, 100, range(0, 1000, 1.0), "the maximum").
default(cr_start, 10, range(0, 100, 0.5), "of an agent that was created").
default(alpha_c, 0.1, range(0, 2, 0.01), "inherent charging").
default(alpha_r, 15, range(0, 100, 0.5), "charging by a reward").
default(c_l, 7, range(0, 50, 0.5), "ticks of life added by a reward").
default(lifetime, 10, range(1, 100, 0.5), "ticks that a clone lives").
default(rounding, round, [round, floor], "of the number of clones").
default(replication, rewarded, [rewarded, always],
        "always: also without a reward").

endowed :-
    parameter(cr_start, Resource),
    keep(resource(Resource)),
    keep(lifetime(inf)).

%!  older(+Ticks) is det.
%
%   Reduces the lifetime by Ticks.

older(_) :-
    lifetime(inf),
    !.
older(Ticks) :-
    lifetime(Lifetime0),
    Lifetime is Lifetime0 - Ticks,
    keep(lifetime(Lifetime)),
    (   Lifetime > 0
    ->  true
    ;   die
    ).

%!  gain(+Reward, +Length) is det.
%
%   Accounts for a step with Reward, 1 or 0, in a queue of Length agents:
%   equations 6.4 and 6.5.

gain(Reward, Length) :-
    parameter(q_th, Capacity),
    parameter(alpha_c, Inherent),
    parameter(alpha_r, Bonus),
    parameter(cr_max, Maximum),
    parameter(c_l, Extension),
    pressure(Capacity, Length, Pressure),
    resource(Resource0),
    recharged(Resource0, Pressure, Reward, charge(Inherent, Bonus, Maximum),
              Resource),
    keep(resource(Resource)),
    lifetime(Lifetime0),
    prolonged(Lifetime0, Reward, Extension, Lifetime),
    keep(lifetime(Lifetime)),
    (   Reward =:= 1
    ->  log(resource(Resource))
    ;   true
    ).

%!  replicate(+Reward, +Length, -Role) is det.
%
%   After a reward, the agent makes as many clones as it can afford in the
%   free slots.  Role is `clone` in a clone, and `parent` in an agent that has
%   cloned.

replicate(Reward, Length, Role) :-
    fertile,
    (   Reward =:= 1
    ->  true
    ;   parameter(replication, always)
    ),
    !,
    affordable(Length, Count),
    multiply(Count, Role).
replicate(_, _, parent).

affordable(Length, Count) :-
    parameter(q_th, Capacity),
    parameter(rounding, Rounding),
    parameter(cr_max, Maximum),
    parameter(cr_min, Minimum),
    pressure(Capacity, Length, Pressure),
    resource(Resource),
    clones(Rounding, Pressure, Resource, Maximum, Count0),
    conferred(Resource, Count0, Minimum, _, Count).

%   Each clone takes its share of the resource when it is made: if agents that
%   are about to join the queue have taken a slot, fewer clones are made.

multiply(0, Role) :-
    !,
    Role = parent.
multiply(Count, Role) :-
    log(state(replicate)),
    clone_if_room(Branch),
    multiplied(Branch, Count, Role).

multiplied(refused, _, parent).
multiplied(clone(_), _, clone) :-
    newborn.
multiplied(parent(_), Count0, Role) :-
    parameter(cr_min, Minimum),
    resource(Resource0),
    Resource is Resource0 - Minimum,
    keep(resource(Resource)),
    log(resource(Resource)),
    Count is Count0 - 1,
    multiply(Count, Role).

newborn :-
    log(cloned),
    parameter(cr_min, Resource),
    keep(resource(Resource)),
    parameter(lifetime, Lifetime),
    keep(lifetime(Lifetime)),
    forget_visits.
