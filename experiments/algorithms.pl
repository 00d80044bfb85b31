/*  Learning beyond the thesis: another problem, other learning algorithms,
    two in one population, exchange while agents live, cloning.

        swipl experiments/algorithms.pl -- --figure settings --runs 3

    `--help` lists the parameters.
*/

:- module(algorithms, []).
:- use_module(algorithms/cases,
              [case_name/2, case_options/2, figure/2, figure_case/2]).
:- use_module(algorithms/claims, [algorithms_claims/3]).
:- use_module(algorithms/figure, [draw_algorithms/4]).
:- use_module(algorithms/metrics, [runs_table/3]).
:- use_module(algorithms/run, [algorithms_run/3]).
:- use_module(lib/command, [acceptable/3, command/5]).
:- use_module(lib/jobs, [job_directory/3, jobs_run/3]).
:- use_module(lib/report,
              [ claims_sentence/2, print_claims/2, print_options/3, print_table/3, save_csv/3,
                save_facts/2
              ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,    figure,    atom).
opt_type(runs,      runs,      natural).
opt_type(seed,      seed,      integer).
opt_type(processes, processes, natural).
opt_type(queue,     queue,     natural).
opt_type(rho_max,   rho_max,   number).
opt_type(clock,     clock,     number).
opt_type(jobs,      jobs,      natural).
opt_type(single,    single,    boolean).
opt_type(case,      case,      atom).
opt_type(out,       out,       atom).

opt_help(help(header), "Other problems and learning algorithms for agents \c
that learn together,\ntwo in one population, exchange, cloning\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,    "settings, islands, mixed, exchange, cloning or all \c
[all]").
opt_help(runs,      "Runs of each case, with consecutive seeds [3]").
opt_help(seed,      "The first seed [1]").
opt_help(processes, "Processes that the hosts of one network live in [1]").
opt_help(queue,     "Agents that a host admits beside its own [5]").
opt_help(rho_max,   "Migration resource: how far agents go between \c
executions [4]").
opt_help(clock,     "Host seconds in a real second [100]").
opt_help(jobs,      "Runs at the same time [2]").
opt_help(single,    "Make one run of the case in this process, without \c
pictures [false]").
opt_help(case,      "Of a single run [climb]").
opt_help(out,       "Directory for tables, pictures and runs \c
[out/algorithms]").

opt_meta(figure, 'FIGURE').
opt_meta(case,   'CASE').
opt_meta(out,    'DIRECTORY').

defaults([ figure(all), runs(3), seed(1), processes(1), queue(5),
           rho_max(4), clock(100), jobs(2), single(false), case(climb),
           out('out/algorithms')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    option(figure(Figure), Options),
    acceptable(( Figure == all ; figure(Figure, _) ), figure, Figure),
    option(case(Case), Options),
    acceptable(case_name(Case, _), case, Case),
    option(runs(Runs), Options),
    acceptable(Runs > 0, runs, Runs),
    option(clock(Clock), Options),
    acceptable(Clock > 0, clock, Clock).

run(Options) :-
    option(single(true), Options),
    !,
    option(out(Out), Options),
    make_directory_path(Out),
    option(case(Case), Options),
    case_options(Case, CaseOptions),
    append(CaseOptions, Options, All),
    algorithms_run(All, Out, Result),
    directory_file_path(Out, 'result.pl', File),
    save_facts(File, [result(Result)]).
run(Options) :-
    print_options(user_output, Options, []),
    option(figure(Wanted), Options),
    findall(Figure, ( figure(Figure, _), wanted(Wanted, Figure) ), Figures),
    maplist(make_figure(Options), Figures).

wanted(all, _) :-
    !.
wanted(Figure, Figure).

                /*******************************
                *            FIGURES           *
                *******************************/

make_figure(Options, Figure) :-
    findall(Case, figure_case(Figure, Case), Cases),
    seeds(Options, Seeds),
    findall(Job,
            ( member(Seed, Seeds), member(Case, Cases),
              job(Options, Case, Seed, Job) ),
            Jobs),
    option(out(Out), Options),
    option(jobs(N), Options),
    directory_file_path(Out, runs, Root),
    jobs_run(Jobs, [out(Root), jobs(N)], _),
    maplist(case_runs(Options, Root, Seeds), Cases, CaseRuns),
    shown(Figure, Out, Options, CaseRuns).

shown(Figure, _, _, CaseRuns) :-
    member(_-[], CaseRuns),
    !,
    print_message(error, algorithms(not_made(Figure))).
shown(Figure, Out, Options, CaseRuns) :-
    figure(Figure, Title),
    format('~nFigure ~w: ~w~n~n', [Figure, Title]),
    runs_table(CaseRuns, Header, Rows),
    print_table(user_output, Header, Rows),
    file(Out, Figure, csv, Csv),
    save_csv(Csv, Header, Rows),
    draw_algorithms(Figure, Out, Options, CaseRuns),
    algorithms_claims(Figure, CaseRuns, Claims),
    nl,
    print_claims(user_output, Claims),
    claims_sentence(Claims, Sentence),
    format('~w~nTable and picture: ~w/algorithms-~w.*~n',
           [Sentence, Out, Figure]).

file(Out, Figure, Extension, File) :-
    atomic_list_concat(['algorithms-', Figure, '.', Extension], Name),
    directory_file_path(Out, Name, File).

seeds(Options, Seeds) :-
    option(seed(First), Options),
    option(runs(Count), Options),
    Last is First + Count - 1,
    numlist(First, Last, Seeds).

%   Runs that failed were told, and are left out.

case_runs(Options, Root, Seeds, Case, Case-Runs) :-
    findall(Seed-Result,
            ( member(Seed, Seeds),
              job(Options, Case, Seed, Job),
              job_directory(Job, Root, Directory),
              directory_file_path(Directory, 'result.pl', File),
              exists_file(File),
              read_file_to_terms(File, [result(Result)], [encoding(utf8)])
            ),
            Runs).

job(Options, Case, Seed, job(Name, Script, Arguments)) :-
    module_property(algorithms, file(Script)),
    findall(Option, inherited(Options, Option), Inherited),
    maplist(argument,
            [single(true), case(Case), seed(Seed)|Inherited], Arguments),
    atomic_list_concat([Case, '-seed', Seed], Name).

inherited(Options, Option) :-
    member(Name, [processes, queue, rho_max, clock]),
    functor(Option, Name, 1),
    option(Option, Options).

argument(Option, Argument) :-
    Option =.. [Name, Value],
    format(atom(Argument), '--~w=~q', [Name, Value]).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- multifile prolog:message//1.

prolog:message(algorithms(not_made(Figure))) -->
    [ 'Figure ~w is not made, as runs are missing'-[Figure] ].
