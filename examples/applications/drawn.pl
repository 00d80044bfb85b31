:- module(applications_drawn, [drawn/3]).       % +Seed, +What, -Share
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_float/3, chance_hash/2, chance_seed/2]).

/** <module> Chance in simulated worlds

*Threading*: pure.
*/

%!  drawn(+Seed, +What, -Share:float) is det.
%
%   Share, from 0 to 1, is random, but the same for each call with the same Seed
%   and the same ground term What.  So actions of agents change neither the
%   weather nor the room that burns.

drawn(Seed, What, Share) :-
    chance_hash(Seed-What, Hash),
    chance_seed(Hash, Chance),
    chance_float(Share, Chance, _).
