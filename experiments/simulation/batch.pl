:- module(simulation_batch,
          [ batch/3,                    % +Options, +Jobs, -Measures
            batch_row/2,                % +Measures, -Row
            quantile/3,                 % +P, +Numbers, -Quantile
            run_measures/3              % +Options, +Run, -Measures
          ]).
:- use_module(model, [simulate/2]).
:- use_module('../sync/healing', [healing/4, phases/4]).
:- use_module('../sync/metrics',
              [ idle_time/2, marks/3, overlaps/2, required/5, task_rows/2,
                tau/2, tau_max/2 ]).
:- use_module('../../prolog/typhon/network/topology', [topology_names/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3, maplist/3, maplist/4]).
:- use_module(library(lists),
              [append/2, member/2, nth1/3, numlist/3, sum_list/2]).
:- use_module(library(option), [merge_options/3, option/2, option/3]).
:- use_module(library(thread), [concurrent/3]).

/** <module> Many simulated runs, and what they have in common

What is measured is what experiments/sync/metrics.pl measures of the log of
a network. The measures of one run are a term

    measures(Idle, Overlaps, Tau, Total, Missing, Twice, Hops, Penalties,
             Healing)

Missing is the number of pairs of a host and a task that were not executed,
Twice the number of executions of what had been executed there before, and
Healing a list, empty if nothing failed; see sync_healing.

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

run_measures(Options, run(Executions, Failures, _, Hops, Penalties),
             measures(Idle, Overlaps, Tau, Total, Missing, Twice, Hops,
                      Penalties, Healing)) :-
    task_rows(Executions, Rows),
    idle_time(Rows, Idle),
    option(failure(Failure), Options, none),
    phases(Failure, Executions, Failures, Phases),
    maplist(overlaps, Phases, Overlapping),
    append(Overlapping, AllOverlapping),
    length(AllOverlapping, Overlaps),
    aggregate_all(max(End), member(execution(_, _, _, End), Executions),
                  Total),
    tau_steps(Options, Executions, Failures, Total, Steps),
    tau_max(Steps, Tau),
    healing(Executions, Failures, Steps, Healing),
    counted(Options, Executions, Missing, Twice).

tau_steps(Options, Executions, Failures, End, Steps) :-
    sizes(Options, HostCount, TaskCount),
    numlist(1, HostCount, Hosts),
    numlist(1, TaskCount, Tasks),
    marks(Executions, Failures, Marks),
    required(Hosts, Tasks, Marks, End, Segments),
    tau(Segments, Steps).

sizes(Options, HostCount, TaskCount) :-
    option(topology(Topology), Options),
    option(tasks(TaskCount), Options),
    topology_names(Topology, Names),
    length(Names, HostCount).

counted(Options, Executions, Missing, Twice) :-
    sizes(Options, HostCount, TaskCount),
    length(Executions, Count),
    findall(H-T, member(execution(T, H, _, _), Executions), Pairs0),
    sort(Pairs0, Pairs),
    length(Pairs, Distinct),
    Missing is HostCount * TaskCount - Distinct,
    Twice is Count - Distinct.

                /*******************************
                *           SUMMARY            *
                *******************************/

%!  batch_row(+Measures:list, -Row:list(pair)) is det.
%
%   Row is a list of Name-Number, what is told of many runs: how many; the
%   shares of those with an overlap, with tau above 2 and with something
%   missing or executed twice; the mean number of overlapped executions;
%   mean and quantiles of the idle time, median of the total time and of
%   hops and penalties. After failures also the shares of runs that healed
%   all, that had tau at 3 and above 3 meanwhile, and the median time.

batch_row(Measures, [ runs-Runs, share_overlap-Overlap, share_tau3-Tau3,
                      share_missing-Missing, share_twice-Twice,
                      overlaps_mean-OverlapMean, idle_mean-IdleMean,
                      idle_q05-Idle05, idle_median-Idle50,
                      idle_q95-Idle95, total_median-Total,
                      hops_median-Hops, penalties_median-Penalties
                    | Healed ]) :-
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
    maplist(median_of(Measures), [4, 7, 8], [Total, Hops, Penalties]),
    healed(Measures, Healed).

healed(Measures, [ share_healed-Healed, share_heal_tau3-Tau3,
                   share_heal_tau4-Tau4, share_later_tau3-Later,
                   heal_median-Median ]) :-
    findall(H, ( member(M, Measures), arg(9, M, H), H = [_|_] ), Healings),
    Healings = [_|_],
    !,
    part_of(Healings, all_redone, Healed),
    part_of(Healings, tau_during(3), Tau3),
    part_of(Healings, tau_during(4), Tau4),
    part_of(Healings, tau_after(3), Later),
    findall(Time, ( member(H, Healings), option(failed_at(From), H),
                    option(healed_at(To), H), Time is To - From ), Times),
    quantile(0.5, Times, Median).
healed(_, []).

part_of(List, Condition, Share) :-
    include(Condition, List, Those),
    length(List, All),
    length(Those, Count),
    Share is Count / All.

all_redone(Healing) :-
    option(lost(Lost), Healing),
    option(redone(Lost), Healing).

tau_during(Least, Healing) :-
    option(healing_tau(Tau), Healing),
    Tau >= Least.

tau_after(Least, Healing) :-
    option(later_tau(Tau), Healing),
    Tau >= Least.

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
