:- module(study_statistics,
          [ mean/2,                     % +Numbers, -Mean
            deviation/2,                % +Numbers, -Deviation
            mean_interval/4,            % +Numbers, +Level, -Low, -High
            interval/6,                 % +Mean, +Deviation, +Count, +Level,
                                        % -Low, -High
            t_quantile/3,               % +P, +Freedom, -T
            ranks/2,                    % +Numbers, -Ranks
            rank_test/5,                % +Xs, +Ys, +Alternative, -U, -P
            rank_correlation/3,         % +Xs, +Ys, -Rho
            holm/2                      % +Ps, -Adjusted
          ]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/3, member/2, sum_list/2]).
:- use_module(library(pairs), [pairs_keys_values/3, pairs_values/2]).
:- use_module(library(sort), [predsort/3]).

/** <module> Statistics of several runs

The mean and its confidence interval (Student, 1908), the rank test of Wilcoxon
(1945) and of Mann and Whitney (1947), the rank correlation of Spearman (1904),
and the correction of Holm (1979) for several tests.

*Threading*: pure.
*/

                /*******************************
                *           THE MEAN           *
                *******************************/

%!  mean(+Numbers:list(number), -Mean:number) is semidet.
%
%   Fails for an empty list.

mean(Numbers, Mean) :-
    Numbers = [_|_],
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

%!  deviation(+Numbers:list(number), -Deviation:float) is semidet.
%
%   The standard deviation of a sample, with n-1 in the denominator.  Fails for
%   fewer than two numbers.  The second sum, which is 0 except for rounding,
%   corrects the result if the mean is much larger than the deviation.

deviation(Numbers, Deviation) :-
    Numbers = [_, _|_],
    mean(Numbers, Mean),
    length(Numbers, Count),
    foldl(squared(Mean), Numbers, 0-0, Squares-Rest),
    Variance is (Squares - Rest*Rest/Count)/(Count - 1),
    Deviation is sqrt(max(0, Variance)).

squared(Mean, X, S0-R0, S-R) :-
    D is X - Mean,
    S is S0 + D*D,
    R is R0 + D.

%!  mean_interval(+Numbers, +Level, -Low:float, -High:float) is semidet.
%!  interval(+Mean, +Deviation, +Count, +Level, -Low:float, -High:float) is det.
%
%   The confidence interval of the mean, at the level 0.95 for instance:
%   mean +- t(1-(1-Level)/2, n-1) * s/sqrt(n).  The former fails for fewer
%   than two numbers.

mean_interval(Numbers, Level, Low, High) :-
    deviation(Numbers, Deviation),
    mean(Numbers, Mean),
    length(Numbers, Count),
    interval(Mean, Deviation, Count, Level, Low, High).

interval(Mean, Deviation, Count, Level, Low, High) :-
    Freedom is Count - 1,
    P is 1 - (1 - Level)/2,
    t_quantile(P, Freedom, T),
    Half is T*Deviation/sqrt(Count),
    Low is Mean - Half,
    High is Mean + Half.

%!  t_quantile(+P:float, +Freedom:positive_integer, -T:float) is det.
%
%   Student's distribution with Freedom degrees of freedom is below T with the
%   probability P, 0.5 =< P < 1.

t_quantile(P, Freedom, T) :-
    must_be(positive_integer, Freedom),
    above(1, P, Freedom, High),
    bisect(0.0, High, P, Freedom, T).

above(T, P, Freedom, T) :-
    t_below(T, Freedom, Below),
    Below >= P,
    !.
above(T0, P, Freedom, T) :-
    T1 is 2*T0,
    above(T1, P, Freedom, T).

bisect(Low, High, P, Freedom, T) :-
    Middle is (Low + High)/2,
    (   High - Low =< 1.0e-12*High
    ->  T = Middle
    ;   t_below(Middle, Freedom, Below),
        Below < P
    ->  bisect(Middle, High, P, Freedom, T)
    ;   bisect(Low, Middle, P, Freedom, T)
    ).

%   For T >= 0: 1 - I(n/(n+T^2); n/2, 1/2)/2, I the incomplete beta function.

t_below(T, Freedom, P) :-
    X is Freedom/(Freedom + T*T),
    A is Freedom/2,
    beta_share(X, A, 0.5, Share),
    P is 1 - Share/2.

%   beta_share(+X, +A, +B, -I): regularised, by its continued fraction, which
%   converges quickly on one side of the mean; on the other I(X; A, B) is
%   1 - I(1-X; B, A).

beta_share(X, A, B, I) :-
    (   X < (A + 1)/(A + B + 2)
    ->  beta_fraction(X, A, B, I)
    ;   Y is 1 - X,
        beta_fraction(Y, B, A, J),
        I is 1 - J
    ).

beta_fraction(X, _, _, 0) :-
    X =:= 0,
    !.
beta_fraction(X, A, B, I) :-
    Front is exp(lgamma(A + B) - lgamma(A) - lgamma(B)
                 + A*log(X) + B*log(1 - X)) / A,
    D0 is 1 - (A + B)*X/(A + 1),
    away_from_0(D0, D1),
    D is 1/D1,
    beta_terms(1, X, A, B, 1, D, D, Fraction),
    I is Front*Fraction.

away_from_0(X, Y) :-
    (   abs(X) < 1.0e-300
    ->  Y = 1.0e-300
    ;   Y = X
    ).

%   Lentz' method: C and D are ratios of successive numerators, denominators.

beta_terms(M, X, A, B, C0, D0, F0, F) :-
    Even is M*(B - M)*X/((A + 2*M - 1)*(A + 2*M)),
    lentz(Even, C0, D0, F0, C1, D1, F1),
    Odd is -(A + M)*(A + B + M)*X/((A + 2*M)*(A + 2*M + 1)),
    lentz(Odd, C1, D1, F1, C2, D2, F2),
    (   abs(C2*D2 - 1) < 1.0e-15
    ->  F = F2
    ;   M1 is M + 1,
        beta_terms(M1, X, A, B, C2, D2, F2, F)
    ).

lentz(Term, C0, D0, F0, C, D, F) :-
    D1 is 1 + Term*D0,
    away_from_0(D1, D2),
    D is 1/D2,
    C1 is 1 + Term/C0,
    away_from_0(C1, C),
    F is F0*C*D.

                /*******************************
                *             RANKS            *
                *******************************/

%!  ranks(+Numbers:list(number), -Ranks:list(number)) is det.
%
%   Ranks of Numbers, from 1 on; equal numbers get the mean of their ranks.

ranks(Numbers, Ranks) :-
    length(Numbers, Count),
    findall(I, between(1, Count, I), Is),
    pairs_keys_values(Pairs, Numbers, Is),
    predsort(by_value, Pairs, Sorted),
    ranked(Sorted, 1, Ranked),
    msort(Ranked, InOrder),
    pairs_values(InOrder, Ranks).

%   By value: 1 and 1.0 are equal, and the standard order puts the float first.

by_value(Order, X-I, Y-J) :-
    (   X < Y
    ->  Order = (<)
    ;   X > Y
    ->  Order = (>)
    ;   compare(Order, I, J)
    ).

%   ranked(+Sorted, +First, -Ranked): pairs Index-Rank.

ranked([], _, []).
ranked([X-I|Pairs], First, Ranked) :-
    ties(Pairs, X, Ties, Rest),
    Is = [I|Ties],
    length(Is, Count),
    Rank0 is First + (Count - 1)/2,
    ( Rank0 =:= integer(Rank0) -> Rank is integer(Rank0) ; Rank = Rank0 ),
    findall(J-Rank, member(J, Is), Here),
    Next is First + Count,
    append(Here, More, Ranked),
    ranked(Rest, Next, More).

ties([Y-J|Pairs], X, [J|Ties], Rest) :-
    Y =:= X,
    !,
    ties(Pairs, X, Ties, Rest).
ties(Rest, _, [], Rest).

%!  rank_correlation(+Xs, +Ys, -Rho:float) is semidet.
%
%   Spearman's rank correlation: Pearson's correlation of the ranks.  Fails if
%   all of Xs or all of Ys are equal, or there are fewer than two.

rank_correlation(Xs, Ys, Rho) :-
    ranks(Xs, Rx),
    ranks(Ys, Ry),
    mean(Rx, Mx),
    mean(Ry, My),
    pairs_keys_values(Pairs, Rx, Ry),
    foldl(product(Mx, My), Pairs, sums(0, 0, 0), sums(Sxy, Sxx, Syy)),
    Sxx > 0,
    Syy > 0,
    Rho is Sxy/sqrt(Sxx*Syy).

product(Mx, My, X-Y, sums(Sxy0, Sxx0, Syy0), sums(Sxy, Sxx, Syy)) :-
    Dx is X - Mx,
    Dy is Y - My,
    Sxy is Sxy0 + Dx*Dy,
    Sxx is Sxx0 + Dx*Dx,
    Syy is Syy0 + Dy*Dy.

                /*******************************
                *          RANK TEST           *
                *******************************/

%!  rank_test(+Xs, +Ys, +Alternative, -U:number, -P:float) is semidet.
%
%   The rank test of Wilcoxon, Mann and Whitney of two samples.  U is the number
%   of pairs in which X is greater than Y, equal ones counted half; P is the
%   probability of a U as extreme, if both samples are of one distribution.
%   Alternative is `less` (X tends to be less than Y), `greater` or
%   `two_sided`.  P is exact for samples without equal numbers and of no more
%   than 50 each, else by the normal distribution, corrected for equal numbers
%   and for continuity.  Fails if a sample is empty.

rank_test(Xs, Ys, Alternative, U, P) :-
    length(Xs, M),
    length(Ys, N),
    M > 0,
    N > 0,
    append(Xs, Ys, All),
    ranks(All, Ranks),
    length(Of, M),
    append(Of, _, Ranks),
    sum_list(Of, Sum),
    U is Sum - M*(M + 1)/2,
    V is M*N - U,
    (   all_different(Ranks),
        M =< 50,
        N =< 50
    ->  exact(Alternative, U, V, M, N, P)
    ;   normal(Alternative, U, V, M, N, Ranks, P)
    ).

all_different(Ranks) :-
    sort(Ranks, Sorted),
    length(Ranks, Count),
    length(Sorted, Count).

exact(less, U, _, M, N, P) :-
    share_up_to(U, M, N, P).
exact(greater, _, V, M, N, P) :-
    share_up_to(V, M, N, P).
exact(two_sided, U, V, M, N, P) :-
    Least is min(U, V),
    share_up_to(Least, M, N, P0),
    P is min(1.0, 2*P0).

%   share_up_to(+U, +M, +N, -P): P is the share of the orders of both samples
%   with at most U inverted pairs.  The number of orders with k such pairs is
%   the coefficient of q^k in the product of (1-q^(N+i))/(1-q^i), i from 1 to M.

share_up_to(U, M, N, P) :-
    Size is integer(U) + 1,
    length(Zeros, Size),
    maplist(=(0), Zeros),
    Ways =.. [ways|Zeros],
    nb_setarg(1, Ways, 1),
    forall(between(1, M, I),
           ( J is N + I,
             times(Size, J, Ways),
             First is I + 1,
             divided(First, Size, I, Ways) )),
    Ways =.. [_|Counts],
    sum_list(Counts, Sum),
    All is M + N,
    choose(All, M, Total),
    P is float(Sum rdiv Total).

times(K, J, Ways) :-
    (   K =< J
    ->  true
    ;   From is K - J,
        arg(K, Ways, A),
        arg(From, Ways, B),
        C is A - B,
        nb_setarg(K, Ways, C),
        K1 is K - 1,
        times(K1, J, Ways)
    ).

divided(K, Size, I, Ways) :-
    (   K > Size
    ->  true
    ;   From is K - I,
        arg(K, Ways, A),
        arg(From, Ways, B),
        C is A + B,
        nb_setarg(K, Ways, C),
        K1 is K + 1,
        divided(K1, Size, I, Ways)
    ).

choose(N, K, Ways) :-
    numbers(1, K, Is),
    foldl(choose_step(N, K), Is, 1, Ways).

numbers(Low, High, Is) :-
    findall(I, between(Low, High, I), Is).

choose_step(N, K, I, W0, W) :-
    W is W0*(N - K + I)//I.

normal(Alternative, U, V, M, N, Ranks, P) :-
    All is M + N,
    msort(Ranks, Sorted),
    clumped_ties(Sorted, Ties),
    Variance is M*N/12*((All + 1) - Ties/(All*(All - 1))),
    (   Variance > 0
    ->  z(Alternative, U, V, Distance),
        Z is (Distance - 0.5)/sqrt(Variance),
        tail(Alternative, Z, P)
    ;   P = 1.0                         % all numbers are equal
    ).

%   Distance of the greater count from its mean, M*N/2 = (U+V)/2.

z(less, U, V, Distance) :- Distance is (V - U)/2.
z(greater, U, V, Distance) :- Distance is (U - V)/2.
z(two_sided, U, V, Distance) :- Distance is abs(U - V)/2.

tail(two_sided, Z, P) :-
    !,
    P is min(1.0, erfc(Z/sqrt(2))).
tail(_, Z, P) :-
    P is erfc(Z/sqrt(2))/2.

%   The sum of t^3-t over groups of t equal ranks.

clumped_ties([], 0).
clumped_ties([R|Ranks], Sum) :-
    same(Ranks, R, 1, T, Rest),
    clumped_ties(Rest, Sum0),
    Sum is Sum0 + T*T*T - T.

same([S|Ranks], R, T0, T, Rest) :-
    S =:= R,
    !,
    T1 is T0 + 1,
    same(Ranks, R, T1, T, Rest).
same(Rest, _, T, T, Rest).

%!  holm(+Ps:list(float), -Adjusted:list(float)) is det.
%
%   Holm's correction: the least of n probabilities is multiplied by n, the
%   next by n-1 and so on, without a decrease, to at most 1.  Any of the tests
%   with a result below 0.05 is wrong with a probability of at most 0.05.

holm(Ps, Adjusted) :-
    length(Ps, Count),
    numbers(1, Count, Is),
    pairs_keys_values(Pairs, Ps, Is),
    predsort(by_value, Pairs, Sorted),
    adjust(Sorted, Count, 0, ByIndex),
    msort(ByIndex, InOrder),
    pairs_values(InOrder, Adjusted).

adjust([], _, _, []).
adjust([P-I|Pairs], N, Least, [I-Q|More]) :-
    Q is min(1.0, max(Least, N*P)),
    N1 is N - 1,
    adjust(Pairs, N1, Q, More).
