% Expects: parameters, keep; the parameter `seed`.
% Gives: seed_chance/1, seed_chance_here/0, chance_turn/1; state chance/1.

:- dynamic chance/1.

%!  seed_chance(+Subject) is det.
%
%   Derives the state of typhon_prng from the parameter `seed`, an integer,
%   and Subject; without a seed the state is random.

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
%   As seed_chance/1 with the name of the host, for agents that do not move.

seed_chance_here :-
    here(Host),
    atomic_list_concat([Name|_], @, Host),
    seed_chance(Name).

%!  chance_turn(-Turn) is det.
%
%   Turn is a random number from 0 to 1.

chance_turn(Turn) :-
    chance(Chance0),
    typhon_prng:chance_float(Turn, Chance0, Chance),
    keep(chance(Chance)).
