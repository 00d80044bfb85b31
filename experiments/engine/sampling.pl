:- module(study_sampling,
          [ is_design/1,                % @Term
            is_range/1,                 % @Term
            sampled_points/3            % +Ranges, +Design, -Points
          ]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [ chance_float/3, chance_hash/2, chance_sample/5, chance_seed/2
              ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [nth0/3, numlist/3]).

/** <module> Sampled parameters

For many or continuous parameters all combinations are too many. A design
samples some instead:

  - random(N), random(N, Seed)
    N points, each parameter independently.  The first of N points are those of
    a design with fewer.
  - latin_hypercube(N), latin_hypercube(N, Seed)
    N points: the range of each parameter is cut into N parts of equal
    probability, and each part has one point (McKay, Beckman and Conover, 1979).

A range is uniform(A, B), loguniform(A, B), integer(A, B), both included, or a
list of values.

*Threading*: pure.
*/

%!  is_design(@Term) is semidet.
%!  is_range(@Term) is semidet.

is_design(Term) :-
    ground(Term),
    design(Term, _, Count, Seed),
    integer(Count),
    Count > 0,
    integer(Seed).

is_range(Range) :-
    ground(Range),
    range(Range).

range([_|_]).
range(uniform(A, B)) :- number(A), number(B), A < B.
range(loguniform(A, B)) :- number(A), number(B), 0 < A, A < B.
range(integer(A, B)) :- integer(A), integer(B), A =< B.

design(random(Count), random, Count, 1).
design(random(Count, Seed), random, Count, Seed).
design(latin_hypercube(Count), latin_hypercube, Count, 1).
design(latin_hypercube(Count, Seed), latin_hypercube, Count, Seed).

%!  sampled_points(+Ranges:list(pair), +Design, -Points:list) is det.
%
%   Ranges are pairs Name-Range.  Points are lists of pairs Name-Value.  Each
%   parameter is drawn by a generator of its own, which follows from its name,
%   so the values of one do not depend on the others.

sampled_points(Ranges, Design, Points) :-
    design(Design, How, Count, Seed),
    maplist(column(How, Count, Seed), Ranges, Columns),
    Last is Count - 1,
    numlist(0, Last, Is),
    maplist(row(Columns), Is, Points).

column(How, Count, Seed, Name-Range, Name-Values) :-
    chance_hash(Name-Seed, Hash),
    chance_seed(Hash, Chance),
    shares(How, Count, Chance, Shares),
    maplist(in_range(Range), Shares, Values).

row(Columns, I, Point) :-
    maplist(nth_value(I), Columns, Point).

nth_value(I, Name-Values, Name-Value) :-
    nth0(I, Values, Value).

%   shares(+How, +Count, +Chance, -Shares): Count numbers from 0 to 1.

shares(random, Count, Chance, Shares) :-
    length(Shares, Count),
    floats_drawn(Shares, Chance, _).
shares(latin_hypercube, Count, Chance0, Shares) :-
    Last is Count - 1,
    numlist(0, Last, Parts),
    chance_sample(Count, Parts, Shuffled, Chance0, Chance),
    length(Inside, Count),
    floats_drawn(Inside, Chance, _),
    maplist(in_part(Count), Shuffled, Inside, Shares).

in_part(Count, Part, Inside, Share) :-
    Share is (Part + Inside)/Count.

floats_drawn([], Chance, Chance).
floats_drawn([F|Fs], Chance0, Chance) :-
    chance_float(F, Chance0, Chance1),
    floats_drawn(Fs, Chance1, Chance).

%   in_range(+Range, +Share, -Value): floats are rounded, because they are part
%   of the names of cases.

in_range(uniform(A, B), Share, Value) :-
    Value0 is A + Share*(B - A),
    rounded(Value0, Value).
in_range(loguniform(A, B), Share, Value) :-
    Value0 is A*(B/A)**Share,
    rounded(Value0, Value).
in_range(integer(A, B), Share, Value) :-
    Value is min(B, A + truncate(Share*(B - A + 1))).
in_range([V|Vs], Share, Value) :-
    length([V|Vs], Count),
    I is min(Count - 1, truncate(Share*Count)),
    nth0(I, [V|Vs], Value).

rounded(Value0, Value) :-
    format(atom(Text), '~6g', [float(Value0)]),
    atom_number(Text, Value1),
    Value is float(Value1).
