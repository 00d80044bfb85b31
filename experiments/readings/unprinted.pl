:- module(readings_unprinted,
          [ unprinted/4,                % ?Chapter, ?Parameter, -Values, -Why
            evidence/2                  % ?Chapter, -Studies
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

%!  evidence(?Chapter, -Studies) is nondet.
%
%   The claims of Studies decide between the readings: those figures that vary
%   nothing else, so that a reading takes few runs.

evidence(sync, ['5.5']).
evidence(population, ['6.3', '6.4']).
