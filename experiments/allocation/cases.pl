:- module(allocation_cases,
          [ figure/3,                   % ?Figure, ?Title, ?XLabel
            figure_cases/4,             % +Figure, +Options, -Cases, -Others
            panels/2                    % ?Figure, ?Measures
          ]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module(library(option), [option/2]).

/** <module> The cases of Figures 7.1 to 7.5

A case is case(Mechanism, Links, Hosts, Eligible, Required, Allocators).
Links are `dynamic` or `static`; each of the Allocators requires so many of
the Eligible robots.

*Threading*: pure.
*/

%!  figure(?Figure, ?Title, ?XLabel) is nondet.

figure('7.1', 'Allocators on a dynamic network', 'allocators').
figure('7.2', 'Allocators on a static network', 'allocators').
figure('7.3', 'Adaptive and constant back-off', 'allocators').
figure('7.4', 'Density of eligible robots', 'eligible robots').
figure('7.5', 'Size of the network, 1:2:10', 'hosts').

%!  panels(?Figure, ?Measures) is nondet.
%
%   Measures are those that the panels of Figure show, from the top;
%   `rate` is the time for each robot that an allocator requires.

panels('7.1', [communications, time, backoffs, interval]).
panels('7.2', [communications, time, backoffs, interval]).
panels('7.3', [communications, time]).
panels('7.4', [communications, time, backoffs, interval]).
panels('7.5', [communications, time, rate]).

%!  figure_cases(+Figure, +Options, -Cases, -Others) is det.
%
%   Cases are pairs X-Case, which Figure shows.  Others are cases with which
%   the thesis compares them in words.  Options are hosts(N), eligible(N),
%   required(N) and allocators(N), the most there are.

figure_cases(Figure, Options, Cases, Others) :-
    option(hosts(N), Options),
    option(eligible(E), Options),
    option(required(R), Options),
    option(allocators(K), Options),
    Base = base(N, E, R, K),
    findall(X-Case, shown(Figure, Base, X, Case), Cases0),
    list_to_set(Cases0, Cases),
    findall(Case, compared(Figure, Base, Case), Others).

shown('7.1', base(N, E, R, Most), K, case(M, dynamic, N, E, R, K)) :-
    member(M, [proposed, murdoch, anta]),
    between(1, Most, K).
shown('7.2', base(N, E, R, Most), K, case(M, static, N, E, R, K)) :-
    member(M, [proposed, murdoch, anta]),
    between(1, Most, K).
shown('7.3', base(N, E, R, Most), K, case(M, dynamic, N, E, R, K)) :-
    member(M, [proposed, constant]),
    between(1, Most, K).
shown('7.4', base(N, _, R, K), E, case(M, dynamic, N, E, R, K)) :-
    member(M, [proposed, murdoch, anta]),
    between(1, 5, Times),
    E is Times*R,
    E =< N.
shown('7.5', base(N0, _, _, K), N, case(proposed, dynamic, N, E, R, K)) :-
    between(1, 4, Halves),
    sized(N0, Halves, N, E, R).

sized(N0, Halves, N, E, R) :-
    R is max(1, round(Halves*N0/20)),
    E is 2*R,
    N is 10*R.

compared('7.2', base(N, E, R, K), case(M, dynamic, N, E, R, K)) :-
    member(M, [proposed, murdoch, anta]).
compared('7.5', base(N0, _, _, K), case(M, dynamic, N, E, R, K)) :-
    member(M, [murdoch, anta]),
    sized(N0, 2, N, E, R).
