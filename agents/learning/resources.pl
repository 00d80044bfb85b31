% Expects: nothing; pure.
% Gives: bag_weight/2, migration_penalty/4, migration_reward/6,
%   initial_potential/4, action_cost/3, action_reward/3.

/*  Migration resource and execution potential: thesis section 4.2.6,
    equations 4.1 to 4.6.

    Intelligence is a list of pairs Unit-Weight; the problem defines the
    weight, phi_w.

    The thesis leaves three points open.  By equation 4.2 a migration resource
    never reaches 0, so it counts as exhausted below a threshold.  It never
    exceeds its maximum.  Equation 4.3 divides by the previous weight of the
    bag: if that was 0, the gain counts as a doubling.
*/

%!  bag_weight(+Bag, -Pi) is det.
%
%   Equation 4.1.

bag_weight(Bag, Pi) :-
    bag_weight(Bag, 0, Pi).

bag_weight([], Pi, Pi).
bag_weight([_-Weight|Bag], Pi0, Pi) :-
    Pi1 is Pi0 + Weight,
    bag_weight(Bag, Pi1, Pi).

%!  migration_penalty(+Rho0, +Pi, +Maximum, -Rho) is det.
%
%   Equation 4.2: the penalty for a hop of an agent whose bag has weight Pi.

migration_penalty(Rho0, Pi, _, Rho) :-
    Pi > 0,
    !,
    Rho is Rho0 * exp(-Pi).
migration_penalty(Rho0, _, Maximum, Rho) :-
    Rho is Rho0 * (1 - 1/Maximum).

%!  migration_reward(+Rho0, +Before, +After, +C, +Maximum, -Rho) is det.
%
%   Equations 4.3 and 4.4: the weight of the bag was Before and is After.

migration_reward(Rho0, Before, After, C, Maximum, Rho) :-
    gain(Before, After, Gain),
    Rho is min(Maximum, Rho0 + C*Gain*Maximum).

gain(Before, After, Gain) :-
    Before > 0,
    !,
    Gain is (After - Before)/Before.
gain(_, _, 1).

%!  initial_potential(+Length, +Search, +Kd, -Xi) is det.
%
%   The execution potential for a plan of Length actions and Search more
%   (Algorithm 1, line 5).

initial_potential(Length, Search, Kd, Xi) :-
    Xi is Kd * (Length + Search).

%!  action_cost(+Xi0, +Kd, -Xi) is det.
%!  action_reward(+Xi0, +Kr, -Xi) is det.
%
%   Equations 4.5 and 4.6: the cost of an action, and the reward for positive
%   feedback.

action_cost(Xi0, Kd, Xi) :-
    Xi is Xi0 - Kd.

action_reward(Xi0, Kr, Xi) :-
    Xi is Xi0 + Kr.
