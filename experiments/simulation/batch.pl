:- module(simulation_batch,
          [ batch/3,                    % +Options, +Jobs, -Measures
            batch_columns/1,            % -Names
            batch_row/2,                % +Measures, -Values
            quantile/3,                 % +P, +Numbers, -Quantile
            run_measures/3              % +Options, +Run, -Measures
          ]).
:- use_module(model, [simulate/2]).
:- use_module('../sync/metrics',
              [ idle_time/2, marks/3, overlaps/2, required/5, task_rows/2,
                tau/2, tau_max/2 ]).
:- use_module('../../prolog/typhon/topology', [topology_names/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists),
              [append/2, member/2, nth1/3, numlist/3, sum_list/2]).
:- use_module(library(option), [merge_options/3, option/2]).
:- use_module(library(thread), [concurrent/3]).

/** <module> Many simulated runs, and what they have in common

What is measured is what experiments/sync/metrics.pl measures of the log of
a network. The measures of one run are a term

    measures(Idle, Overlaps, Tau, Total, Missing, Twice, Hops, Penalties)

Missing is the number of pairs of a host and a task that were not executed,
Twice the number of executions of what had been executed there before.

*Threading*: batch/3 makes as many threads as it is told, and waits.
*/

%!  batch(+Options, +Jobs, -Measures:list) is det.
%
%   Measures are those of each run. Options are those of simulate/2, and
%   runs(N); the first run has the seed given, each next run the next one.
%   They are made by Jobs threads; the result does not depend on how many.

batch(Options, Jobs, Measures) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    Stride is max(1, min(Jobs, Runs)),
    findall(Seeds, part(First, Last, Stride, Seeds), Parts),
    maplist(part_goal(Options), Parts, Goals, Results),
    concurrent(Stride, Goals, []),
    append(Results, Pairs0),
    sort(1, @<, Pairs0, Pairs),
    findall(M, member(_-M, Pairs), Measures).

part(First, Last, Stride, Seeds) :-
    End is First + Stride - 1,
    between(First, End, Begin),
    findall(Seed, ( between(Begin, Last, Seed),
                    (Seed - Begin) mod Stride =:= 0 ), Seeds).

part_goal(Options, Seeds, simulation_batch:part_run(Options, Seeds, Result),
          Result).

part_run(Options, Seeds, Result) :-
    findall(Seed-Measures,
            ( member(Seed, Seeds),
              merge_options([seed(Seed)], Options, RunOptions),
              simulate(RunOptions, Run),
              run_measures(RunOptions, Run, Measures)
            ),
            Result).

%!  run_measures(+Options, +Run, -Measures) is det.
%
%   Measures of the Run of simulate/2 with Options.

run_measures(Options, run(Executions, _, Hops, Penalties),
             measures(Idle, Overlaps, Tau, Total, Missing, Twice, Hops,
                      Penalties)) :-
    option(topology(Topology), Options),
    option(tasks(TaskCount), Options),
    topology_names(Topology, Names),
    length(Names, HostCount),
    numlist(1, HostCount, Hosts),
    numlist(1, TaskCount, Tasks),
    task_rows(Executions, Rows),
    idle_time(Rows, Idle),
    overlaps(Executions, Overlapping),
    length(Overlapping, Overlaps),
    aggregate_all(max(End), member(execution(_, _, _, End), Executions),
                  Total),
    marks(Executions, [], Marks),
    required(Hosts, Tasks, Marks, Total, Segments),
    tau(Segments, Steps),
    tau_max(Steps, Tau),
    length(Executions, Count),
    findall(H-T, member(execution(T, H, _, _), Executions), Pairs0),
    sort(Pairs0, Pairs),
    length(Pairs, Distinct),
    Missing is HostCount * TaskCount - Distinct,
    Twice is Count - Distinct.

                /*******************************
                *           SUMMARY            *
                *******************************/

%!  batch_columns(-Names:list(atom)) is det.
%!  batch_row(+Measures:list, -Values:list(number)) is det.
%
%   What is told of many runs: how many; the shares of those with an
%   overlap, with tau above 2 and with something missing or executed twice;
%   the mean number of overlapped executions; mean and quantiles of the
%   idle time, median of the total time and of hops and penalties.

batch_columns([ runs, share_overlap, share_tau3, share_missing, share_twice,
                overlaps_mean, idle_mean, idle_q05, idle_median, idle_q95,
                total_median, hops_median, penalties_median
              ]).

batch_row(Measures, [ Runs, Overlap, Tau3, Missing, Twice, OverlapMean,
                      IdleMean, Idle05, Idle50, Idle95, Total, Hops,
                      Penalties ]) :-
    length(Measures, Runs),
    share(2, 0, Measures, Overlap),
    share(3, 2, Measures, Tau3),
    share(5, 0, Measures, Missing),
    share(6, 0, Measures, Twice),
    column(2, Measures, Overlaps),
    mean(Overlaps, OverlapMean),
    column(1, Measures, Idles),
    mean(Idles, IdleMean),
    quantile(0.05, Idles, Idle05),
    quantile(0.5, Idles, Idle50),
    quantile(0.95, Idles, Idle95),
    maplist(median_of(Measures), [4, 7, 8], [Total, Hops, Penalties]).

column(Arg, Measures, Values) :-
    maplist(arg(Arg), Measures, Values).

share(Arg, Limit, Measures, Share) :-
    aggregate_all(count, ( member(M, Measures), arg(Arg, M, X), X > Limit ),
                  Count),
    length(Measures, Runs),
    Share is Count / Runs.

mean(Values, Mean) :-
    sum_list(Values, Sum),
    length(Values, Count),
    Mean is Sum / Count.

median_of(Measures, Arg, Median) :-
    column(Arg, Measures, Values),
    quantile(0.5, Values, Median).

%!  quantile(+P:number, +Numbers:list, -Quantile:number) is semidet.
%
%   At least the share P of Numbers is not above Quantile, which is one of
%   them. Fails for an empty list.

quantile(P, Numbers, Quantile) :-
    msort(Numbers, Sorted),
    length(Sorted, Count),
    Index is max(1, ceiling(P * Count)),
    nth1(Index, Sorted, Quantile).
