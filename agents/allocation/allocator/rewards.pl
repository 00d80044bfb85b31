% Expects: lib; mobility_resource, held_robots, sojourn.
% Gives: endow/0, replenish/0, reward/1, penalty/0, decay/0, exhausted/0; its
%   state.

/*  The mobility resource of an allocator, chi(Chi).  This file applies the
    equations of mobility_resource.pl to an allocator.
*/

:- dynamic chi/1.

%!  reward(+Reserved) is det.
%
%   The allocator has reserved a robot, and held Reserved robots before:
%   equation 7.1.

reward(Reserved) :-
    note(reward),
    frequency(reward, _, Frequency),
    needed(Required),
    chi(Chi0),
    rewarded(Chi0, Frequency, Required, Reserved, Chi),
    keep(chi(Chi)).

%!  penalty is det.
%
%   A robot that the allocator could use is reserved for another task:
%   equation 7.2.

penalty :-
    note(penalty),
    frequency(penalty, Penalties, Frequency),
    needed(Required),
    reserved(Reserved),
    chi(Chi0),
    penalised(Chi0, Frequency, Penalties, Required, Reserved, Chi),
    keep(chi(Chi)).

%!  decay is det.
%
%   A hop: equation 7.3.

decay :-
    sojourn(Visited, _, _, _),
    discovered(Found),
    parameter(cd, Cd),
    chi(Chi0),
    decayed(Chi0, Found, Visited, Cd, Chi),
    keep(chi(Chi)).

%!  endow is det.
%!  replenish is det.
%
%   The initial resource, and the resource after a back-off: equation 7.4.

endow :-
    parameter(chi, Chi),
    keep(chi(Chi)).

replenish :-
    discovered(Found),
    parameter(cd, Cd),
    parameter(alpha_k, Threshold),
    restarted(Found, Cd, Threshold, Chi),
    keep(chi(Chi)).

%!  exhausted is semidet.
%
%   True when the allocator must back off.

exhausted :-
    chi(Chi),
    parameter(alpha_k, Threshold),
    exhausted(Chi, Threshold).
