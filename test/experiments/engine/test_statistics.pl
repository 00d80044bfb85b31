:- module(test_statistics, []).

% Each equation of the statistics of studies, beside numbers that others have
% published.

:- use_module('../../lib/common').
:- use_module('../../../experiments/engine/statistics').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(plunit)).

near(A, B, Within) :-
    assertion(abs(A - B) =< Within).

%   NIST, Statistical Reference Datasets, univariate: NumAcc1, NumAcc3 and
%   NumAcc4, with the certified means and standard deviations.

certified([10000001, 10000003, 10000002], 10000002, 1).
certified([1000000.2|Others], 1000000.2, 0.1) :-
    alternating(500, 1000000.1, 1000000.3, Others).
certified([10000000.2|Others], 10000000.2, 0.1) :-
    alternating(500, 10000000.1, 10000000.3, Others).

alternating(0, _, _, []) :-
    !.
alternating(N, A, B, [A, B|More]) :-
    N1 is N - 1,
    alternating(N1, A, B, More).

%   Student's distribution: the table of the NIST/SEMATECH e-Handbook of
%   Statistical Methods, 1.3.6.7.2.

t_table(0.95, 1, 6.314).
t_table(0.975, 1, 12.706).
t_table(0.99, 1, 31.821).
t_table(0.975, 2, 4.303).
t_table(0.975, 5, 2.571).
t_table(0.995, 5, 4.032).
t_table(0.95, 10, 1.812).
t_table(0.975, 10, 2.228).
t_table(0.995, 10, 3.169).
t_table(0.975, 30, 2.042).
t_table(0.975, 100, 1.984).

%   Hollander and Wolfe, Nonparametric Statistical Methods (1973), page 69:
%   permeability of membranes, as in the manual of wilcox.test of R, which gives
%   W = 35, p = 0.1272 for `greater`.

permeability([ 0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46 ],
             [ 1.15, 0.88, 0.90, 0.74, 1.21 ]).

%   The example of scipy.stats.mannwhitneyu: ages at diagnosis of diabetes,
%   U = 17, p = 0.1111 exact, 0.11134688653 by the normal distribution with
%   correction for continuity.

ages([19, 22, 16, 29, 24], [20, 11, 17, 12]).

:- begin_tests(statistics).

test(mean_and_deviation_of_certified_data,
     [forall(certified(Numbers, Mean, Deviation))]) :-
    mean(Numbers, M),
    near(M, Mean, 1e-7),
    deviation(Numbers, S),
    near(S, Deviation, 1e-8).
test(one_number_has_no_deviation, fail) :-
    deviation([1], _).

test(student_distribution_matches_the_table,
     [forall(t_table(P, Freedom, T))]) :-
    t_quantile(P, Freedom, Found),
    near(Found, T, 0.0005).
test(student_of_many_is_normal) :-
    t_quantile(0.975, 10000000, T),
    near(T, 1.959964, 1e-5).

% NIST/SEMATECH e-Handbook, 1.3.5.2: heat flow, ZARR13.DAT.
test(interval_of_the_mean) :-
    interval(9.261460, 0.022789, 195, 0.95, Low, High),
    near(Low, 9.258242, 2e-6),
    near(High, 9.264679, 2e-6).
test(interval_of_numbers) :-
    mean_interval([1, 2, 3, 4, 5], 0.95, Low, High),
    near(Low, 1.036757, 1e-6),          % 3 +- 2.776445*sqrt(2.5/5)
    near(High, 4.963243, 1e-6).

test(ranks_share_ties, Ranks == [1, 2.5, 4, 2.5]) :-
    ranks([1, 3, 5, 3.0], Ranks).

test(rank_test_of_permeability, U =:= 35) :-
    permeability(Xs, Ys),
    rank_test(Xs, Ys, greater, U, P),
    near(P, 0.1272, 0.00005),
    rank_test(Xs, Ys, two_sided, _, Both),
    near(Both, 0.2544, 0.00005).
test(rank_test_of_ages, U =:= 17) :-
    ages(Xs, Ys),
    rank_test(Xs, Ys, two_sided, U, P),
    near(P, 1/9, 1e-12).

% Mann and Whitney (1947), table I: the probability that U is not above 2 with
% samples of 3 and 4, of 4 and 4.
test(rank_test_matches_the_first_table,
     [forall(member(Xs-Ys-Expected, [ [1,2,5]-[3,4,6,7]-0.114,
                                      [1,2,3,6]-[4,5,7,8]-0.057 ]))]) :-
    rank_test(Xs, Ys, less, U, P),
    assertion(U =:= 2),
    near(P, Expected, 0.0005).

% Equal numbers: SciPy 1.17.1, mannwhitneyu(..., method="asymptotic").
test(rank_test_with_ties,
     [forall(member(Alternative-Expected,
                    [ less-0.07884169392287704,
                      greater-0.9370718041351203,
                      two_sided-0.15768338784575409 ]))]) :-
    rank_test([1, 2, 2, 3, 3, 3, 4, 9], [2, 3, 4, 4, 5, 5, 6], Alternative,
              U, P),
    assertion(U =:= 15.5),
    near(P, Expected, 1e-12).
test(rank_test_of_large_samples) :-
    numlist(1, 50, Xs),
    findall(Y, ( member(X, Xs), Y is X + 10.5 ), Ys),
    rank_test(Xs, Ys, less, U, P),
    assertion(U =:= 780),
    near(P, 0.0005275082355568331, 1e-15).
test(rank_test_of_equal_samples, P =:= 1) :-
    rank_test([3, 3, 3], [3, 3, 3], two_sided, _, P).
test(rank_test_needs_two_samples, fail) :-
    rank_test([], [1], less, _, _).

% The example of the English Wikipedia, Spearman's rank correlation
% coefficient: IQ and hours of television, -29/165.
test(rank_correlation) :-
    rank_correlation([106, 100, 86, 101, 99, 103, 97, 113, 112, 110],
                     [7, 27, 2, 50, 28, 29, 20, 12, 6, 17], Rho),
    near(Rho, -29/165, 1e-12).
test(rank_correlation_of_constant_data, fail) :-
    rank_correlation([1, 2, 3], [4, 4, 4], _).

% The example of the English Wikipedia, Holm-Bonferroni method: of these four
% the first and the last are rejected at 0.05.
test(holm, Rejected == [0.01, 0.005]) :-
    Ps = [0.01, 0.04, 0.03, 0.005],
    holm(Ps, Adjusted),
    numlist(1, 4, Is),
    findall(P, ( member(I, Is), nth(I, Ps, P), nth(I, Adjusted, Q),
                 Q =< 0.05 ),
            Rejected),
    forall(( member(I-E, [1-0.03, 2-0.06, 3-0.06, 4-0.02]),
             nth(I, Adjusted, Q) ),
           near(Q, E, 1e-12)).

nth(I, List, X) :-
    J is I - 1,
    length(Before, J),
    append(Before, [X|_], List).

:- end_tests(statistics).
