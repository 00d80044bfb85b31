/*  Simulated runs of synchronised execution (thesis chapter 5): thousands,
    in the time that a network needs for one.

        swipl experiments/simulation.pl -- --topology "grid(6,10)" \
            --delta 0.5 --runs 1000 --jobs 2 --out out/simulation
        swipl experiments/simulation.pl -- --study onset --runs 100

    `--help` lists the parameters.
*/

:- module(simulation, []).
:- use_module(lib/command, [acceptable/3, command/5]).
:- use_module(lib/chart, [draw_chart/3]).
:- use_module(lib/progress, [progress/4, progress_done/1]).
:- use_module(lib/report, [print_table/3, save_csv/3]).
:- use_module(simulation/batch, [batch/3, batch_row/2, quantile/3]).
:- use_module(simulation/reading, [reading/1]).
:- use_module(simulation/study, [study/2, study_chart/3, study_point/2]).
:- use_module(library(apply), [foldl/6, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, nth0/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [merge_options/3, option/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

:- initialization(main, main).

:- public main/1.

opt_type(topology,  topology,  term).
opt_type(agents,    agents,    natural).
opt_type(tasks,     tasks,     natural).
opt_type(delta,     delta,     number).
opt_type(hop_time,  hop_time,  term).
opt_type(task_time, task_time, term).
opt_type(dynamic,   dynamic,   term).
opt_type(failure,   failure,   term).
opt_type(reading,   reading,   term).
opt_type(service,   service,   oneof([exclusive, printed])).
opt_type(starts,    starts,    oneof([drawn, even])).
opt_type(strategy,  strategy,  term).
opt_type(seed,      seed,      integer).
opt_type(runs,      runs,      natural).
opt_type(jobs,      jobs,      natural).
opt_type(study,     study,     atom).
opt_type(out,       out,       atom).

opt_help(help(header), "Simulates synchronised execution (thesis \c
chapter 5)\n").
opt_help(help(usage), " -- [options]").
opt_help(topology,  "Topology of the network [grid(6,10)]").
opt_help(agents,    "Number of agents [10]").
opt_help(tasks,     "Length of the sequence of tasks [6]").
opt_help(delta,     "Penalty bias, above 0 [0.5]").
opt_help(hop_time,  "MIN-MAX seconds that a hop takes [0.3-0.6]").
opt_help(task_time, "Seconds that a task takes, MIN-MAX, or table_5_2 [1]").
opt_help(dynamic,   "How links come and go: dynamic_1, dynamic_2, ... \c
[none]").
opt_help(failure,   "atomic(T,N,D): N hosts lose task T when task D begins; \c
cascaded(T,N,D): and all later ones [none]").
opt_help(reading,   "Of equation 5.2: chosen, over_window, inside, \c
inside(Zero), scaled, signed [chosen]").
opt_help(service,   "exclusive, or as Algorithm 2 is printed [exclusive]").
opt_help(starts,    "Where the agents start: drawn, or at even distances \c
[drawn]").
opt_help(strategy,  "Of migration; orderly: conscientious without chance \c
[conscientious]").
opt_help(seed,      "Seed of the first run; the next has the next [1]").
opt_help(runs,      "Number of runs, for each point of a study [100]").
opt_help(jobs,      "Threads that share the work [2]").
opt_help(study,     "Vary something: topologies, onset, spread, readings, \c
service, order, agents, hosts, tasks, dynamic, healing").
opt_help(out,       "Directory for tables and figure [out/simulation]").

opt_meta(topology, 'TOPOLOGY').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(dynamic,  'MODEL').
opt_meta(failure,  'FAILURE').
opt_meta(out,      'DIRECTORY').

defaults([ topology(grid(6,10)), agents(10), tasks(6), delta(0.5),
           hop_time(0.3-0.6), task_time(1), dynamic(none), failure(none),
           reading(chosen), service(exclusive), starts(drawn),
           strategy(conscientious), seed(1), runs(100), jobs(2), study(none),
           out('out/simulation')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    option(delta(Delta), Options),
    acceptable(Delta > 0, delta, Delta),
    option(runs(Runs), Options),
    acceptable(Runs > 0, runs, Runs),
    option(reading(Reading), Options),
    acceptable(reading(Reading), reading, Reading),
    option(study(Study), Options),
    acceptable(( Study == none ; study(Study, _) ), study, Study).

                /*******************************
                *             RUNS             *
                *******************************/

run(Options) :-
    option(out(Out), Options),
    make_directory_path(Out),
    option(study(Study), Options),
    (   Study == none
    ->  run_batch(Options, Out)
    ;   run_study(Study, Options, Out)
    ).

run_batch(Options, Out) :-
    simulated(Options, Measures),
    findall([Name|Values],
            ( nth0(I, [idle, overlaps, tau, total, missing, twice, hops,
                       penalties], Name),
              Arg is I + 1,
              maplist(arg(Arg), Measures, Numbers),
              maplist(quantile_of(Numbers), [0, 0.05, 0.25, 0.5, 0.75, 0.95,
                                             1], Values)
            ),
            Rows),
    Header = [measure, least, 'q 5 %', 'q 25 %', median, 'q 75 %',
              'q 95 %', most],
    print_options(Options),
    print_table(user_output, Header, Rows),
    batch_row(Measures, Row),
    memberchk(runs-Runs, Row),
    memberchk(share_overlap-Overlap, Row),
    memberchk(share_tau3-Tau, Row),
    format('~n~d runs; with an overlapped execution: ~1f %, \c
with tau above 2: ~1f %~n', [Runs, 100*Overlap, 100*Tau]),
    directory_file_path(Out, 'quantiles.csv', File),
    save_csv(File, Header, Rows),
    save_runs(Out, Measures).

quantile_of(Numbers, P, Quantile) :-
    quantile(P, Numbers, Quantile).

save_runs(Out, Measures) :-
    Header = [idle, overlaps, tau, total, missing, twice, hops, penalties],
    length(Header, Count),
    length(Row, Count),
    findall(Row, ( member(M, Measures), M =.. [_|All], append(Row, _, All) ),
            Rows),
    directory_file_path(Out, 'runs.csv', File),
    save_csv(File, Header, Rows).

print_options(Options) :-
    findall(Text,
            ( member(Name, [topology, agents, tasks, delta, hop_time,
                            task_time, dynamic, failure, reading,
                            service, starts, strategy, seed]),
              Option =.. [Name, Value],
              option(Option, Options),
              format(atom(Text), '~w ~w', [Name, Value])
            ),
            Texts),
    atomic_list_concat(Texts, ', ', Line),
    format('~w~n~n', [Line]).

%   Table 5.2 of the thesis.

simulated(Options0, Measures) :-
    option(jobs(Jobs), Options0),
    (   option(task_time(table_5_2), Options0)
    ->  merge_options([task_time([ 0.5-1.4, 1.5-2.3, 2.0-3.0, 3.15-4.1,
                                   4.5-5.2, 6.0-8.0 ])], Options0, Options)
    ;   Options = Options0
    ),
    batch(Options, Jobs, Measures).

                /*******************************
                *           STUDIES            *
                *******************************/

run_study(Study, Options, Out) :-
    study(Study, What),
    print_options(Options),
    format('Varied: ~w~n~n', [What]),
    findall(Given, study_point(Study, Given), Points),
    length(Points, Total),
    foldl(run_point(Options, Total), Points, Rows, 0, _),
    progress_done(user_error),
    save_study(Study, Out, Rows),
    draw_study(Study, Out, Rows).

run_point(Options, Total, Given, Given-Numbers, Done0, Done) :-
    merge_options(Given, Options, PointOptions),
    simulated(PointOptions, Measures),
    batch_row(Measures, Numbers),
    Done is Done0 + 1,
    progress(user_error, Done, Total, points).

save_study(Study, Out, Rows) :-
    Rows = [Given-Numbers|_],
    findall(Name, ( member(Option, Given), functor(Option, Name, 1) ), Keys),
    pairs_keys_values(Numbers, Columns, _),
    append(Keys, Columns, Header),
    maplist(study_row, Rows, Cells),
    print_table(user_output, Header, Cells),
    file_name_extension(Study, csv, Name),
    directory_file_path(Out, Name, File),
    save_csv(File, Header, Cells).

study_row(Given-Numbers, Cells) :-
    findall(Text,
            ( member(Option, Given), arg(1, Option, Value),
              format(atom(Text), '~w', [Value]) ),
            Texts),
    pairs_keys_values(Numbers, _, Values),
    append(Texts, Values, Cells).

draw_study(Study, Out, Rows) :-
    study_chart(Study, Rows, Chart),
    !,
    draw_chart(Out, Study, Chart).
draw_study(_, _, _).
