% Expects: nothing; pure.
% Gives: rewarded/5, penalised/6, decayed/5, restarted/4, exhausted/2.

/*  The mobility resource of an allocator: thesis section 7.4.1, equations
    7.1 to 7.4.

    The thesis leaves some points open, or prints them otherwise.  A penalty
    decrements the resource, so equation 7.2 has a minus.  In equation 7.4 the
    power of Cd is UR + 1, as the product has so many factors; with UR an
    agent that knows fewer than some thirty hosts would start below the
    threshold.  UR counts the distinct robots ever found, VR the robots
    visited since the agent last began to search: if both counts began at the
    same time, UR could never be greater than VR.
*/

%!  rewarded(+Chi0, +Frequency, +Required, +Reserved, -Chi) is det.
%
%   Equation 7.1: Frequency is the number of rewards per hop, Reserved the
%   number of robots held before this one, Required the number needed.

rewarded(Chi0, Frequency, Required, Reserved, Chi) :-
    Chi is Chi0 * (1 + Frequency*(Required - Reserved)/Required).

%!  penalised(+Chi0, +Frequency, +Penalties, +Required, +Reserved, -Chi)
%!      is det.
%
%   Equation 7.2: Frequency is the number of penalties per hop, Penalties the
%   number of penalties.

penalised(Chi0, Frequency, Penalties, Required, Reserved, Chi) :-
    Share is Penalties/(Penalties + Required - Reserved),
    Chi is Chi0 * (1 - Frequency*Share).

%!  decayed(+Chi0, +Found, +Visited, +Cd, -Chi) is det.
%
%   Equation 7.3: one hop of an agent that has found Found distinct robots
%   (UR), and visited Visited (VR) since it began to search.

decayed(Chi0, Found, Visited, Cd, Chi) :-
    decay(Found, Visited, Decay),
    Chi is Chi0 * (1 - Decay/Cd).

decay(Found, Visited, Decay) :-
    Found >= Visited,
    !,
    Decay is tan(pi/(4 + Found - Visited)).
decay(_, _, 1).

%!  restarted(+Found, +Cd, +Threshold, -Chi) is det.
%
%   Equation 7.4: the resource of an agent that restarts its search; equation
%   7.3 reduces it to Threshold in Found + 1 hops.

restarted(Found, Cd, Threshold, Chi) :-
    restarted(0, Found, Cd, Threshold, Chi).

restarted(Visited, Found, _, Chi, Chi) :-
    Visited > Found,
    !.
restarted(Visited, Found, Cd, Chi0, Chi) :-
    decay(Found, Visited, Decay),
    Chi1 is Chi0 * Cd/(Cd - Decay),
    Visited1 is Visited + 1,
    restarted(Visited1, Found, Cd, Chi1, Chi).

%!  exhausted(+Chi, +Threshold) is semidet.
%
%   True when the agent must back off.  The tolerance covers rounding: as
%   many divisions as multiplications lead to Threshold, and they round
%   differently.

exhausted(Chi, Threshold) :-
    Chi =< Threshold * (1 + 1.0e-9).
