% Expects: parameters, keep; default(seed, random).
% Gives: seed_chance/1, seed_chance_here/0, chance_turn/1; state chance/1.

:- dynamic chance/1.

%!  seed_chance(+Subject) is det.
%
%   The state of typhon_prng is that of the parameter `seed`, an integer,
%   and of Subject, or any.

seed_chance(Subject) :-
    parameter(seed, Seed0),
    (   integer(Seed0)
    ->  typhon_prng:chance_hash(Seed0-Subject, Seed)
    ;   Seed is random(1<<30)
    ),
    typhon_prng:chance_seed(Seed, Chance),
    keep(chance(Chance)).

%!  seed_chance_here is det.
%
%   As seed_chance/1, for agents that stay: by the name of the host.

seed_chance_here :-
    here(Host),
    atomic_list_concat([Name|_], @, Host),
    seed_chance(Name).

%!  chance_turn(-Turn) is det.
%
%   A random number from 0 to 1.

chance_turn(Turn) :-
    chance(Chance0),
    typhon_prng:chance_float(Turn, Chance0, Chance),
    keep(chance(Chance)).
