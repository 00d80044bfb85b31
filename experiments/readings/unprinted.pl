:- module(readings_unprinted,
          [ unprinted/4,                % ?Chapter, ?Parameter, -Values, -Why
            evidence/3                  % ?Chapter, -Study, -Sets
          ]).

/** <module> What the thesis does not print, and what it may have been

Only parameters of the studies, each of which has one value for all figures of a
chapter.  The value with which the figures are made is that of the studies, and
is not repeated here.

*Threading*: facts.
*/

%!  unprinted(?Chapter, ?Parameter, -Values:list, -Why) is nondet.
%
%   Each of Values is possible for Parameter, by what the thesis prints.

unprinted(sieve, reading, [current, common, total],
          "which agents are related, and which is the better one (section \c
3.4.2)").
unprinted(sieve, attacked, [4, 20],
          "several nodes (section 3.5.2)").
unprinted(sieve, patience, [0.8, 1.6],
          "until danger signals have died down (section 3.5.2)").
unprinted(sieve, topology, [random(100, 0.04), random(100, 0.1)],
          "100 nodes (section 3.6)").
unprinted(sieve, dynamic, [none, links(uniform(2, 4), 0.5, 0.5)],
          "links alter with a given probability (section 3.5.2)").

unprinted(learning, light, [10, 1000],
          "intensity at the goal (section 4.3.3)").
unprinted(learning, queue, [2, 10],
          "less than the number of agents (section 4.2.1)").
unprinted(learning, hop_time, [0.05-0.15],
          "as in chapter 7, or another").
unprinted(learning, settings,
          [ [stay-0.3], [rho_min-2], [rho_min-0.5], [c-0.25],
            [k_r-1, search-2], [k_r-0, search-3] ],
          "constants of equations 4.2 to 4.6; an agent alone takes 195 \c
executions").

unprinted(sync, task_time, [1, 2, 4, 5],
          "C: one for all tasks (section 5.5); T1 is executed for 9 s on 60 \c
hosts").
unprinted(sync, hop_time, [0.16-0.32, 0.4-0.4, 0.4-0.8],
          "six computers of one network").
unprinted(sync, starts, [drawn, even],
          "the same in all experiments (section 5.6)").
unprinted(sync, choices, [by_chance, in_order],
          "no decision is made by chance (section 5.4.1)").

unprinted(population, hop_time, [0.16-0.32, 0.4-0.8, 1.04-1.56],
          "as in chapter 5, or another").
unprinted(population, tick, [1.25, 1.6, 2.2],
          "one instant of a lifetime (section 6.3)").
unprinted(population, threshold, [0.01, 0.1, 1, 3],
          "equation 6.6 multiplies, and never reaches 0").
unprinted(population, degree, [10, 30],
          "a mesh").
unprinted(population, rounding, [round],
          "equation 6.2 gives a real number").
unprinted(population, replication, [always],
          "when the resource crosses CRmin (section 6.3.2)").
unprinted(population, task_time, [3, 5],
          "as in chapter 5, or another").
unprinted(population, crash_share, [0.05, 0.5, 0.8],
          "while T4 is in progress").

unprinted(allocation, beta, [0],
          "back-offs that an allocator has experienced (equation 7.5)").
unprinted(allocation, hop_time, [0.02-0.06, 0.04-0.10, 0.27-0.53],
          "an allocator alone backs off for 5.16 s; or as in chapter 5").
unprinted(allocation, change, [1-2, 5-10, 10-20],
          "robots alter links by a variant of G(n, p) (section 7.5)").
unprinted(allocation, probability, [0.03, 0.04, 0.1],
          "p of G(n, p) (section 7.5)").
unprinted(allocation, duration, [1, 10],
          "execution time of a task (section 7.4.1)").

%!  evidence(?Chapter, -Study, -Sets) is nondet.
%
%   The claims of Study decide between the readings of Chapter, in the cases that
%   Sets select, values of --set.  Figures that vary nothing else, or a part of
%   them, so that a reading takes few runs.  Figure 6.4 has the claims of 6.3, too;
%   auctions take most runs of chapter 7, and have a study of their own,
%   `contention`.

evidence(sieve, '3.3', []).
evidence(sieve, '3.4', []).
evidence(sieve, '3.5', []).
evidence(learning, '4.7', []).
evidence(learning, '4.9', ['network=[50]']).
evidence(learning, '4.13', []).
evidence(sync, '5.5', []).
evidence(population, '6.4', []).
evidence(allocation, '7.1', [ 'links=[dynamic]',
                              'mechanism=[proposed,constant]' ]).
evidence(allocation, '7.4', ['mechanism=[proposed]']).
evidence(allocation, '7.5', ['mechanism=[proposed]']).
