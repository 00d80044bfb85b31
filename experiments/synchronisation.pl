/*  Synchronised execution of a sequence of tasks (thesis chapter 5).

        swipl experiments/synchronisation.pl -- --seed 1 --out out/demo

    `--help` lists the parameters.
*/

:- module(synchronisation, []).
:- use_module(lib/command, [acceptable/3, command/5, range/1]).
:- use_module(lib/report,
              [claims_sentence/2, print_claims/2, print_table/3, save_csv/3]).
:- use_module(sync/claims, [sync_claims/2]).
:- use_module(sync/report,
              [ print_parameters/2, print_result/2, result_summary/2,
                save_result/4
              ]).
:- use_module(sync/run, [sync_run/3]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2, select_option/3]).

:- initialization(main, main).

:- public main/1.

opt_type(topology,  topology,  term).
opt_type(processes, processes, natural).
opt_type(agents,    agents,    natural).
opt_type(tasks,     tasks,     natural).
opt_type(delta,     delta,     number).
opt_type(hop_time,  hop_time,  term).
opt_type(task_time, task_time, term).
opt_type(dynamic,   dynamic,   term).
opt_type(failure,   failure,   term).
opt_type(picture,   picture,   boolean).
opt_type(clock,     clock,     number).
opt_type(seed,      seed,      integer).
opt_type(runs,      runs,      natural).
opt_type(limit,     limit,     number).
opt_type(out,       out,       atom).

opt_help(help(header), "Mobile agents execute a sequence of tasks in step on \c
all hosts\nof a network (thesis chapter 5)\n").
opt_help(help(usage), " -- [options]").
opt_help(topology,  "Topology of the network [grid(6,10)]").
opt_help(processes, "Operating system processes the hosts live in [4]").
opt_help(agents,    "Number of agents [10]").
opt_help(tasks,     "Length of the sequence of tasks [6]").
opt_help(delta,     "Penalty bias, above 0 [0.5]").
opt_help(hop_time,  "MIN-MAX host seconds that a hop takes [0.3-0.6]").
opt_help(task_time, "Host seconds that a task takes: S, or MIN-MAX, drawn by \c
each\nhost, or a list of these, one for each task [1]").
opt_help(dynamic,   "How links come and go: dynamic_1, dynamic_2, ... [none]").
opt_help(failure,   "atomic(T,N,D): N hosts lose task T when task D begins; \c
cascaded(T,N,D): and all later ones [none]").
opt_help(clock,     "Host seconds in a real second [10]").
opt_help(seed,      "Seed of the first run; the next has the next [1]").
opt_help(runs,      "Number of runs [1]").
opt_help(limit,     "Real seconds to wait for the agents of a run [90]").
opt_help(picture,   "Whether a picture of the run is drawn [true]").
opt_help(out,       "Directory for log, tables and pictures \c
[out/synchronisation]").

opt_meta(topology, 'TOPOLOGY').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(task_time, 'TIME').
opt_meta(dynamic,  'MODEL').
opt_meta(failure,  'FAILURE').
opt_meta(out,      'DIRECTORY').

defaults([ topology(grid(6,10)), processes(4), agents(10), tasks(6),
           delta(0.5), hop_time(0.3-0.6), task_time(1), clock(10), seed(1),
           runs(1), limit(90), dynamic(none), failure(none), picture(true),
           out('out/synchronisation')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    forall(( member(Name, [delta, clock, limit]),
             Option =.. [Name, Value],
             option(Option, Options) ),
           acceptable(Value > 0, Name, Value)),
    option(tasks(Tasks), Options),
    option(hop_time(HopTime), Options),
    acceptable(range(HopTime), hop_time, HopTime),
    option(task_time(TaskTime), Options),
    acceptable(task_time(TaskTime, Tasks), task_time, TaskTime),
    option(failure(Failure), Options),
    acceptable(failure(Failure, Tasks), failure, Failure).

task_time(Times, Tasks) :-
    is_list(Times),
    !,
    length(Times, Count),
    Count >= Tasks,
    forall(member(Time, Times), one_task_time(Time)).
task_time(Time, _) :-
    one_task_time(Time).

one_task_time(Time) :-
    (   number(Time)
    ->  Time >= 0
    ;   range(Time)
    ).

failure(none, _) :-
    !.
failure(Failure, Tasks) :-
    nonvar(Failure),
    Failure =.. [Kind, Task, Count, During],
    memberchk(Kind, [atomic, cascaded]),
    integer(Count),
    between(1, Tasks, Task),
    between(1, Tasks, During).

                /*******************************
                *             RUNS             *
                *******************************/

run(Options) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds),
    maplist(run_seed(Options), Seeds, Summaries),
    (   Runs > 1
    ->  print_runs(Options, Seeds, Summaries)
    ;   true
    ).

%   The files of one run are in the directory itself; of several, each has
%   a directory of its own below it.

run_seed(Options0, Seed, Summary) :-
    select_option(seed(_), Options0, Options1),
    Options = [seed(Seed)|Options1],
    option(runs(Runs), Options),
    option(out(Out), Options),
    (   Runs =:= 1
    ->  Directory = Out
    ;   atom_concat(seed, Seed, Name),
        directory_file_path(Out, Name, Directory)
    ),
    nl,
    print_parameters(user_output, Options),
    nl,
    flush_output,
    sync_run(Options, Directory, Result),
    sync_claims(Result, Claims),
    save_result(Directory, Options, Result, Claims),
    print_result(user_output, Result),
    nl,
    print_claims(user_output, Claims),
    claims_sentence(Claims, Sentence),
    format('~n~w~nLog, tables and figure: ~w/~n', [Sentence, Directory]),
    result_summary(Result, Summary).

print_runs(Options, Seeds, Summaries) :-
    option(out(Out), Options),
    maplist(summary_row, Seeds, Summaries, Rows),
    Header = [seed, idle, overlaps, tau, total, real_time],
    nl,
    print_table(user_output, Header, Rows),
    directory_file_path(Out, 'runs.csv', File),
    save_csv(File, Header, Rows).

summary_row(Seed, summary(Idle, Overlaps, Tau, Total, Wall),
            [Seed, Idle, Overlaps, Tau, Total, Wall]).
