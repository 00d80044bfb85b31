:- module(typhon_prng,
          [ chance_seed/2,              % +Seed, -Chance
            chance_hash/2,              % +Term, -Seed
            chance_float/3,             % -Float, +Chance0, -Chance
            chance_below/4,             % +N, -Index, +Chance0, -Chance
            chance_uniform/5,           % +Min, +Max, -X, +Chance0, -Chance
            chance_true/4,              % +P, -Bool, +Chance0, -Chance
            chance_member/4,            % -X, +List, +Chance0, -Chance
            chance_sample/5             % +Count, +List, -Sample, +Chance0,
                                        % -Chance
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [nth0/3, nth0/4]).

/** <module> Random choices that can be repeated

A generator whose state is a small ground term, passed from choice to choice.
The generators of the system keep their state in the thread, so the choices of
an agent would depend on the worker that happens to run it, and on the earlier
work of that worker. A state that is a term travels with the agent, and a run
can be repeated from its seed alone.

The method is that of P. L'Ecuyer, Efficient and portable combined
random number generators, CACM 31(6), 1988: two multiplicative
generators, period about 2^61. All products fit in 53 bits, so the
numbers are the same on every word size, without big integers.

The state is an argument before the last, and the new state the last
argument, so choices thread through a clause like a DCG's list.

*Threading*: pure.
*/

:- set_prolog_flag(optimise, true).      % arithmetic is all there is here

%!  chance_seed(+Seed:integer, -Chance) is det.
%
%   Chance is the state that belongs to Seed. Seeds that differ little
%   give states that differ much.
%
%   @error type_error(integer, Seed)

chance_seed(Seed, chance(A, B)) :-
    must_be(integer, Seed),
    Low is Seed mod 0x100000000,
    High is (Seed >> 32) mod 0x100000000,
    scramble(Low, S1),
    Mixed is S1 xor High,
    scramble(Mixed, S2),
    Other is S2 xor 0x9e3779b9,
    scramble(Other, S3),
    A is 1 + S2 mod 2147483562,
    B is 1 + S3 mod 2147483398.

%!  chance_hash(+Term, -Seed) is det.
%
%   Seed belongs to the ground Term, and is the same in every process: it is
%   made from those bits of term_hash/2 (24 bits, or 32 since SWI-Prolog 9.1)
%   that all versions and word sizes have in common.

chance_hash(Term, Seed) :-
    term_hash(Term, Hash),
    Seed is Hash /\ 0xffffff.

%   A bijection of 32-bit numbers in which each bit of the input changes
%   about half of the bits of the output.

scramble(X0, X) :-
    X1 is ((X0 xor (X0 >> 16)) * 0x45d9f3b) mod 0x100000000,
    X2 is ((X1 xor (X1 >> 16)) * 0x45d9f3b) mod 0x100000000,
    X is X2 xor (X2 >> 16).

%!  chance_float(-Float, +Chance0, -Chance) is det.
%
%   Float is uniform in the open interval from 0 to 1.

chance_float(Float, Chance0, Chance) :-
    draw(N, Chance0, Chance),
    Float is N / 2147483563.0.

%   N is uniform in 1..2147483562.

draw(N, chance(A0, B0), chance(A, B)) :-
    A is (A0 * 40014) mod 2147483563,
    B is (B0 * 40692) mod 2147483399,
    N is (A - B) mod 2147483562 + 1.

%!  chance_below(+N:integer, -Index:integer, +Chance0, -Chance) is det.
%
%   Index is uniform in 0..N-1. N is a positive integer below 2^31.

chance_below(N, Index, Chance0, Chance) :-
    chance_float(Float, Chance0, Chance),
    Index is truncate(Float * N).

%!  chance_uniform(+Min, +Max, -X:float, +Chance0, -Chance) is det.

chance_uniform(Min, Max, X, Chance0, Chance) :-
    chance_float(Float, Chance0, Chance),
    X is Min + (Max - Min) * Float.

%!  chance_true(+P, -Bool, +Chance0, -Chance) is det.
%
%   Bool is `true` with probability P, else `false`. A number is drawn
%   in any case, so later choices do not depend on P.

chance_true(P, Bool, Chance0, Chance) :-
    chance_float(Float, Chance0, Chance),
    (   Float < P
    ->  Bool = true
    ;   Bool = false
    ).

%!  chance_member(-X, +List, +Chance0, -Chance) is semidet.
%
%   X is an element of List, each as likely as any other. Fails, and
%   draws nothing, when List is empty.

chance_member(X, List, Chance0, Chance) :-
    List = [_|_],
    length(List, N),
    chance_below(N, Index, Chance0, Chance),
    nth0(Index, List, X).

%!  chance_sample(+Count, +List, -Sample, +Chance0, -Chance) is semidet.
%
%   Sample are Count elements of List in the order in which they were
%   drawn: different ones as long as there are any, then all of List can be
%   drawn again. Fails when there is none to draw.

chance_sample(Count, List, Sample, Chance0, Chance) :-
    sample(Count, List, List, Sample, Chance0, Chance).

sample(0, _, _, [], Chance, Chance) :-
    !.
sample(Count, [], List, Sample, Chance0, Chance) :-
    !,
    List = [_|_],
    sample(Count, List, List, Sample, Chance0, Chance).
sample(Count, Left0, List, [X|Sample], Chance0, Chance) :-
    length(Left0, N),
    chance_below(N, Index, Chance0, Chance1),
    nth0(Index, Left0, X, Left),
    Count1 is Count - 1,
    sample(Count1, Left, List, Sample, Chance1, Chance).
