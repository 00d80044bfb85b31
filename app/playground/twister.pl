:- module(typhon_twister, []).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2, nth0/3, nth0/4]).
:- use_module(library(random), []).

/** <module> The random numbers of other builds of SWI-Prolog

SWI-Prolog for WebAssembly is built without GMP.  Its random generator is also
the Mersenne Twister, but gets another state from a seed, and makes floats in
another way.  With this module, which is loaded before the platform, set_random/1
and the predicates of library(random) draw the same as elsewhere.  The functions
random_float, random/1 of a power of 2, and integers of more than 32 bits stay
different.

*Threading*: one thread.
*/

:- redefine_system_predicate(user:set_random(_)).

user:set_random(Option) :-
    typhon_twister:seeded(Option).

%   seeded(+Option) is det.
%
%   GMP raises the seed plus 2 to a power, takes the result as the words 1 to 623
%   of the state, its highest bit as word 0, and drops 1,376 numbers of the state
%   that follows.

seeded(seed(Seed)) :-
    integer(Seed),
    Seed >= 0,
    !,
    Base is Seed mod (2**19937-20027) + 2,
    power(1074888996, Base, Power0),
    Power is Power0 mod (2**19937-20023),
    Words is Power mod 2**19936,
    First is (Power >> 19936) << 31,
    Fields is (((Words << 32 \/ First) << 32 \/ 624) << 32) \/ 0xffffffff,
    reversed_bytes(2504, Fields, State),
    system:set_random(state(State)),
    forall(between(1, 1376, _), _ is random(0x100000000)).
seeded(Option) :-
    system:set_random(Option).

%   power(+Exponent, +Base, -Power): modulo 2**19937-20023, plus a multiple of it.
%   powm/3 takes ten times as long without GMP.

power(1, Base, Base) :-
    !.
power(Exponent, Base, Power) :-
    Half is Exponent >> 1,
    power(Half, Base, Root),
    Power0 is Root*Root*Base**(Exponent /\ 1),
    reduced(Power0, Power).

reduced(Number, Number) :-
    Number < 1<<19937,
    !.
reduced(Number0, Number) :-
    Number1 is (Number0 >> 19937)*20023 + (Number0 /\ ((1<<19937)-1)),
    reduced(Number1, Number).

%   The state is the content of a structure, read from its end.

reversed_bytes(1, Byte, Byte) :-
    !.
reversed_bytes(Bytes, Number, Reversed) :-
    Low is Bytes >> 1,
    High is Bytes-Low,
    Number1 is Number /\ ((1 << (8*Low))-1),
    Number2 is Number >> (8*Low),
    reversed_bytes(Low, Number1, Reversed1),
    reversed_bytes(High, Number2, Reversed2),
    Reversed is Reversed1 << (8*High) \/ Reversed2.

                /*******************************
                *        LIBRARY(RANDOM)       *
                *******************************/

%   The highest 53 bits of two numbers, never 0.

random(Float) :-
    Low is random(0x100000000),
    High is random(0x100000000),
    Bits is High << 32 \/ Low,
    (   Bits =:= 0
    ->  random(Float)
    ;   Spare is max(0, msb(Bits)-52),
        Float is (Bits >> Spare << Spare)/18446744073709551616.0
    ).

%   below(+N, -Number): elsewhere the lowest bits are taken if N is a power of 2.

below(1, Number) :-
    !,
    Number = 0.
below(N, Number) :-
    N =< 0x100000000,
    N /\ (N-1) =:= 0,
    !,
    Number is random(0x100000000) /\ (N-1).
below(N, Number) :-
    Number is random(N).

random(Low, High, Number) :-
    must_be(number, Low),
    must_be(number, High),
    (   integer(Low),
        integer(High)
    ->  High > Low,
        Size is High-Low,
        below(Size, Rest),
        Number is Low+Rest
    ;   random(Float),
        Number is Low+(High-Low)*Float
    ).

random_between(Low, High, Number) :-
    must_be(integer, Low),
    must_be(integer, High),
    High >= Low,
    Size is High+1-Low,
    below(Size, Rest),
    Number is Low+Rest.

maybe :-
    below(2, 0).

maybe(P) :-
    must_be(between(0.0, 1.0), P),
    random(Float),
    Float < P.

maybe(K, N) :-
    must_be(nonneg, K),
    must_be(nonneg, N),
    below(N, Number),
    Number < K.

random_member(X, List) :-
    must_be(list, List),
    length(List, Length),
    Length > 0,
    below(Length, N),
    nth0(N, List, X).

random_select(X, List, Rest) :-
    (   is_list(List)
    ->  length(List, Length)
    ;   must_be(list, Rest),
        length([_|Rest], Length)
    ),
    Length > 0,
    below(Length, N),
    nth0(N, List, X, Rest).

%   Of randset/3 and randseq/3.

randset(0, _, Set, Set) :-
    !.
randset(K0, N0, Set0, Set) :-
    below(N0, Number),
    N is N0-1,
    (   Number < K0
    ->  K is K0-1,
        randset(K, N, [N0|Set0], Set)
    ;   randset(K0, N, Set0, Set)
    ).

srand(N, Number) :-
    below(N, Below),
    Number is Below+1.

%   replace(+Name, +Arity): the definition here is also that of the library.

replace(Name, Arity) :-
    functor(Head, Name, Arity),
    abolish(random:Name/Arity),
    assertz((random:Head :- typhon_twister:Head)).

:- forall(member(Name/Arity,
                 [ random/1, random/3, random_between/3, maybe/0, maybe/1,
                   maybe/2, random_member/2, random_select/3, randset/4,
                   srand/2 ]),
          replace(Name, Arity)).

%   Agents in virtual time draw from this.

:- multifile typhon_virtual_loop:seeds/1.

typhon_virtual_loop:seeds(Seed) :-
    typhon_twister:seeded(seed(Seed)).
