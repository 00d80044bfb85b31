/*  The figures, tables and claims of thesis chapter 5, one or all.

        swipl experiments/figures.pl -- --figure 5.6

    `--help` lists the parameters.
*/

:- module(figures, []).
:- use_module(lib/command, [acceptable/3, command/5]).
:- use_module(lib/jobs, [job_directory/3, jobs_run/3]).
:- use_module(lib/report, [print_claims/2, save_facts/2]).
:- use_module(sync/cases,
              [print_runs/2, run_measures/2, run_result/3, save_runs/2]).
:- use_module(sync/claimed, [figures_sentence/2, gather_claims/2]).
:- use_module(sync/pictures, [draw_picture/5]).
:- use_module(sync/potentials, [potential_steps/3]).
:- use_module(sync/scenarios,
              [case_arguments/4, case_name/3, figure/2, figure_cases/2]).
:- use_module(sync/statements, [statements/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, memberchk/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,    figure,    atom).
opt_type(runs,      runs,      natural).
opt_type(seed,      seed,      integer).
opt_type(jobs,      jobs,      natural).
opt_type(hop_time,  hop_time,  term).
opt_type(task_time, task_time, number).
opt_type(clock,     clock,     number).
opt_type(processes, processes, natural).
opt_type(limit,     limit,     number).
opt_type(out,       out,       atom).

opt_help(help(header), "Pictures, tables and claims of thesis chapter 5: \c
synchronised\nexecution of tasks\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,    "5.2, 5.5, 5.6, 5.7a, 5.7b, 5.8, 5.9, 5.10, 5.11, 5.12 \c
or all [all]").
opt_help(runs,      "Runs of each case, with consecutive seeds [3]").
opt_help(seed,      "The first seed [1]").
opt_help(jobs,      "Runs at the same time [3]").
opt_help(hop_time,  "MIN-MAX host seconds that a hop takes [0.3-0.6]").
opt_help(task_time, "Host seconds that a task takes [1]").
opt_help(clock,     "Host seconds in a real second [10]").
opt_help(processes, "Processes that the hosts of one network live in [2]").
opt_help(limit,     "Real seconds after which a run is given up [120]").
opt_help(out,       "Directory for pictures, tables, claims and runs \c
[out/figures]").

opt_meta(figure,   'FIGURE').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(out,      'DIRECTORY').

defaults([ figure(all), runs(3), seed(1), jobs(3), hop_time(0.3-0.6),
           task_time(1), clock(10), processes(2), limit(120),
           out('out/figures')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, wanted(_), run).

wanted(Figures, Options) :-
    option(figure(Wanted), Options),
    findall(Figure,
            ( figure(Figure, _),
              ( Wanted == all ; names_figure(Wanted, Figure) )
            ),
            Figures),
    acceptable(Figures = [_|_], figure, Wanted).

%   5.5c is part of 5.5, and 5.7 is 5.7a and 5.7b.

names_figure(Figure, Figure).
names_figure(Wanted, Figure) :-
    ( atom_concat(Wanted, Letter, Figure)
    ; atom_concat(Figure, Letter, Wanted)
    ),
    atom_length(Letter, 1),
    char_type(Letter, lower).

                /*******************************
                *             RUNS             *
                *******************************/

run(Options) :-
    wanted(Figures, Options),
    option(out(Out), Options),
    option(jobs(N), Options),
    directory_file_path(Out, runs, Root),
    make_directory_path(Root),
    figures_jobs(Figures, Options, Jobs),
    jobs_run(Jobs, [out(Root), jobs(N)], Outcomes),
    forall(member(Figure, Figures), make_figure(Figure, Root, Options)),
    gather_claims(Out, Claims),
    print_figures_claims(Figures, Claims),
    figures_sentence(Claims, Sentence),
    format('~n~w~nPictures, tables and claims: ~w/~n', [Sentence, Out]),
    (   member(failed(_), Outcomes)
    ->  halt(1)
    ;   true
    ).

%   Those that were asked for.

print_figures_claims(Figures, Claims) :-
    forall(member(Figure, Figures),
           ( findall(Claim, member(Figure-Claim, Claims), FigureClaims),
             format('Figure ~w~n', [Figure]),
             print_claims(user_output, FigureClaims) )).

%   The first run of every case comes first.

figures_jobs(Figures, Options, Jobs) :-
    seeds(Options, Seeds),
    findall(Job,
            ( member(Seed, Seeds),
              member(Figure, Figures),
              figure_cases(Figure, Cases),
              member(_-Case, Cases),
              case_job(Options, Seed, Case, Job)
            ),
            Jobs).

seeds(Options, Seeds) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds).

case_job(Options, Seed, Case, job(Name, Script, Arguments)) :-
    module_property(figures, file(File)),
    file_directory_name(File, Directory),
    directory_file_path(Directory, 'synchronisation.pl', Script),
    case_name(Case, Seed, Name),
    findall(Option, common(Options, Case, Option), Common),
    case_arguments(Case, Seed, Common, Arguments).

common(Options, Case, Option) :-
    member(Name, [hop_time, task_time, clock, processes, limit]),
    functor(Option, Name, 1),
    \+ memberchk(Option, Case),
    option(Option, Options).
common(_, _, picture(false)).

                /*******************************
                *            FIGURES           *
                *******************************/

make_figure('5.2', _, Options) :-
    !,
    Rewards = [1, 2, 3, 5, 8, 13, 21],
    findall(curve(Delta, Rewards, Steps),
            ( member(Delta, [0.2, 0.3, 0.5, 0.8, 1.0]),
              potential_steps(Delta, Rewards, Steps)
            ),
            Curves),
    figure_directory('5.2', Options, Directory),
    draw_picture('5.2', Directory, Curves, [], Options),
    save_claims('5.2', Directory, Curves).
make_figure(Figure, Root, Options) :-
    figure_cases(Figure, Cases),
    seeds(Options, Seeds),
    findall(Key-Directories,
            ( member(Key-Case, Cases),
              findall(Directory,
                      ( member(Seed, Seeds),
                        case_job(Options, Seed, Case, Job),
                        job_directory(Job, Root, Directory),
                        exists_directory(Directory)
                      ),
                      Directories)
            ),
            Found),
    (   memberchk(_-[], Found)
    ->  print_message(error, figures(not_made(Figure)))
    ;   show_figure(Figure, Found, Options)
    ).

show_figure(Figure, Found, Options) :-
    maplist([Key-Directories, Key-Runs]>>maplist(run_measures, Directories,
                                                 Runs),
            Found, Data),
    figure_directory(Figure, Options, Directory),
    (   memberchk(Figure, ['5.5', '5.8', '5.11', '5.12'])
    ->  maplist([Key-[D|_], Key-Result]>>run_result(D, _, Result),
                Found, First)
    ;   First = []
    ),
    draw_picture(Figure, Directory, Data, First, Options),
    directory_file_path(Directory, 'runs.csv', Csv),
    save_runs(Csv, Data),
    figure(Figure, Title),
    format('Figure ~w: ~w~n', [Figure, Title]),
    print_runs(user_output, Data),
    nl,
    save_claims(Figure, Directory, Data).

figure_directory(Figure, Options, Directory) :-
    option(out(Out), Options),
    atom_concat('figure-', Figure, Name),
    directory_file_path(Out, Name, Directory),
    make_directory_path(Directory).

save_claims(Figure, Directory, Data) :-
    statements(Figure, Data, Claims),
    directory_file_path(Directory, 'claims.pl', File),
    save_facts(File, Claims).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- multifile prolog:message//1.

prolog:message(figures(not_made(Figure))) -->
    [ 'Figure ~w is not made, as runs are missing'-[Figure] ].
