% Expects: nothing; pure.
% Gives: pressure/3, clones/5, conferred/5, recharged/5, prolonged/4.

/*  The cloning resource of an agent: thesis section 6.2, equations 6.1 to
    6.5.

    The thesis leaves three points open.  The number of clones is rounded
    (`round`, half away from zero, or `floor`).  An agent makes all clones or
    none, and only if it keeps as much as it gives to each.  The constant y of
    equation 6.4 is 1: with y = CRmin its third case would never apply, since
    a pressure is at most the capacity of a queue; and the second case holds
    wherever neither of the others does.
*/

%!  pressure(+Capacity, +Length, -Pressure) is det.
%
%   Equation 6.1: Pressure is the number of free slots in a queue of Length
%   agents.

pressure(Capacity, Length, Pressure) :-
    Pressure is max(0, Capacity - Length).

%!  clones(+Rounding, +Pressure, +Resource, +Maximum, -Count) is det.
%
%   Equation 6.2: how many clones an agent could make.  Rounding is
%   `round` or `floor`.

clones(round, Pressure, Resource, Maximum, Count) :-
    Count is round(Pressure * Resource/Maximum).
clones(floor, Pressure, Resource, Maximum, Count) :-
    Count is floor(Pressure * Resource/Maximum).

%!  conferred(+Resource0, +Count0, +Minimum, -Resource, -Count) is det.
%
%   Equation 6.3: the resource of an agent after it has given Minimum to each
%   of Count clones.  Count is Count0, or 0 if the resource does not suffice.

conferred(Resource0, Count, Minimum, Resource, Count) :-
    Resource is Resource0 - Count*Minimum,
    Resource >= Minimum,
    !.
conferred(Resource, _, _, Resource, 0).

%!  recharged(+Resource0, +Pressure, +Reward, +Charge, -Resource) is det.
%
%   Equation 6.4: one step of charging.  Reward is 1 where the agent
%   serviced a host, else 0; Charge is charge(Inherent, Bonus, Maximum),
%   the constants alpha_c and alpha_r, and CRmax.

recharged(Resource0, Pressure, Reward, charge(Inherent, Bonus, Maximum),
          Resource) :-
    inherent(Resource0, Pressure, Factor),
    Resource is min(Maximum,
                    Resource0 + Inherent*Factor + Bonus*Reward).

inherent(_, Pressure, Factor) :-
    Pressure > 1,
    !,
    Factor is exp(1 - 1/Pressure).
inherent(Resource, _, Factor) :-
    Resource >= 1,
    !,
    Factor is exp(-1/Resource).
inherent(_, _, 1).

%!  prolonged(+Lifetime0, +Reward, +Extension, -Lifetime) is det.
%
%   Equation 6.5.  A lifetime `inf` never ends.

prolonged(inf, _, _, Lifetime) :-
    !,
    Lifetime = inf.
prolonged(Lifetime0, Reward, Extension, Lifetime) :-
    Lifetime is Lifetime0 + Extension*Reward.
