/*  Agents that learn together: the figures of thesis chapter 4.

        swipl experiments/learning.pl -- --figure 4.9 --runs 3

    `--help` lists the parameters.
*/

:- module(learning, []).
:- use_module(lib/command, [acceptable/3, command/5, range/1]).
:- use_module(lib/jobs, [job_directory/3, jobs_run/3]).
:- use_module(lib/report,
              [claims_sentence/2, print_claims/2, save_csv/3, save_facts/2]).
:- use_module(learning/cases,
              [case_name/2, case_options/3, clock/1, figure/2,
               figure_cases/3]).
:- use_module(learning/claims, [learning_claims/3]).
:- use_module(learning/pictures, [draw_learning/4]).
:- use_module(learning/report,
              [load_result/2, print_cases/2, print_parameters/2,
               runs_table/3]).
:- use_module(learning/run, [learning_run/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,    figure,    atom).
opt_type(runs,      runs,      natural).
opt_type(seed,      seed,      integer).
opt_type(sizes,     sizes,     term).
opt_type(processes, processes, natural).
opt_type(queue,     queue,     natural).
opt_type(hop_time,  hop_time,  term).
opt_type(clock,     clock,     term).
opt_type(dynamic,   dynamic,   term).
opt_type(settings,  settings,  term).
opt_type(limit,     limit,     number).
opt_type(jobs,      jobs,      natural).
opt_type(single,    single,    boolean).
opt_type(nodes,     nodes,     natural).
opt_type(agents,    agents,    natural).
opt_type(out,       out,       atom).

opt_help(help(header), "Agents that learn the way through a maze by what \c
robots tell them and\nby what they tell each other (thesis chapter 4)\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,    "4.7, 4.8, 4.9, 4.10, 4.11, 4.12, 4.13 or all [all]").
opt_help(runs,      "Runs of each case, with consecutive seeds [3]").
opt_help(seed,      "The first seed [1]").
opt_help(sizes,     "Hosts of the networks, ascending [[10,20,30,40,50]]").
opt_help(processes, "Processes that the hosts of one network live in [2]").
opt_help(queue,     "Agents that a host admits beside its own [5]").
opt_help(hop_time,  "MIN-MAX host seconds that a hop takes, or none [none]").
opt_help(clock,     "Host seconds in a real second, or pace(P,MOST): P by \c
the number of agents, MOST at most [pace(200,60)]").
opt_help(dynamic,   "How links come and go in figure 4.13 and a single \c
run, or none [thesis_4_4_7]").
opt_help(settings,  "List of Name-Value for agents and maze [[]]").
opt_help(limit,     "Host seconds until a run is given up [10000]").
opt_help(jobs,      "Runs at the same time [3]").
opt_help(single,    "Make one run in this process, of so many nodes and \c
agents, without pictures [false]").
opt_help(nodes,     "Hosts of a single run [50]").
opt_help(agents,    "Agents of a single run [5]").
opt_help(out,       "Directory for tables, pictures and runs \c
[out/learning]").

opt_meta(figure,   'FIGURE').
opt_meta(sizes,    'LIST').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(clock,    'CLOCK').
opt_meta(dynamic,  'MODEL').
opt_meta(settings, 'LIST').
opt_meta(out,      'DIRECTORY').

defaults([ figure(all), runs(3), seed(1), sizes([10,20,30,40,50]),
           processes(2), queue(5), hop_time(none), clock(pace(200,60)),
           dynamic(thesis_4_4_7), settings([]), limit(10000), jobs(3),
           single(false), nodes(50), agents(5), out('out/learning')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    option(figure(Figure), Options),
    acceptable(( Figure == all ; figure(Figure, _) ), figure, Figure),
    option(clock(Clock), Options),
    acceptable(clock(Clock), clock, Clock),
    option(hop_time(HopTime), Options),
    acceptable(( HopTime == none ; range(HopTime) ), hop_time, HopTime),
    option(sizes(Sizes), Options),
    acceptable(sizes(Sizes), sizes, Sizes),
    option(limit(Limit), Options),
    acceptable(Limit > 0, limit, Limit).

sizes(Sizes) :-
    is_list(Sizes),
    Sizes \== [],
    forall(member(Size, Sizes), ( integer(Size), Size > 0 )),
    sort(Sizes, Sizes).

                /*******************************
                *             RUNS             *
                *******************************/

run(Options) :-
    option(single(true), Options),
    !,
    option(out(Out), Options),
    make_directory_path(Out),
    learning_run(Options, Out, Result),
    directory_file_path(Out, 'result.pl', File),
    save_facts(File, [result(Result)]).
run(Options) :-
    option(figure(Wanted), Options),
    findall(Figure, ( figure(Figure, _), wanted(Wanted, Figure) ), Figures),
    print_parameters(user_output, Options),
    needed(Figures, Options, Cases),
    make_runs(Cases, Options, Outcomes),
    maplist(make_figure(Options), Figures, ClaimLists),
    told(Options, Cases, ClaimLists),
    (   member(failed(_), Outcomes)
    ->  halt(1)
    ;   true
    ).

wanted(all, _) :-
    !.
wanted(Figure, Figure).

needed(Figures, Options, Cases) :-
    option(sizes(Sizes), Options),
    findall(Case,
            ( member(Figure, Figures),
              figure_cases(Figure, Sizes, Some),
              member(Case, Some) ),
            Cases0),
    sort(Cases0, Cases).

%   The first run of every case comes first.

make_runs(Cases, Options, Outcomes) :-
    seeds(Options, Seeds),
    findall(Job,
            ( member(Seed, Seeds),
              member(Case, Cases),
              job(Options, Case, Seed, Job) ),
            Jobs),
    runs_directory(Options, Root),
    option(jobs(N), Options),
    jobs_run(Jobs, [out(Root), jobs(N)], Outcomes).

runs_directory(Options, Root) :-
    option(out(Out), Options),
    directory_file_path(Out, runs, Root).

seeds(Options, Seeds) :-
    option(seed(First), Options),
    option(runs(Count), Options),
    Last is First + Count - 1,
    numlist(First, Last, Seeds).

job(Options, Case, Seed, job(Name, Script, Arguments)) :-
    module_property(learning, file(Script)),
    findall(Option, inherited(Options, Option), Common),
    case_options(Case, Common, Some),
    maplist(argument, [single(true), seed(Seed)|Some], Arguments),
    case_name(Case, CaseName),
    atomic_list_concat([CaseName, '-seed', Seed], Name).

inherited(Options, Option) :-
    member(Name, [ processes, queue, hop_time, clock, dynamic, settings,
                   limit ]),
    functor(Option, Name, 1),
    option(Option, Options).

argument(Option, Argument) :-
    Option =.. [Name, Value],
    format(atom(Argument), '--~w=~q', [Name, Value]).

                /*******************************
                *            FIGURES           *
                *******************************/

%   Runs that failed were told, and are left out.

case_runs(Options, Case, Case-Runs) :-
    seeds(Options, Seeds),
    runs_directory(Options, Root),
    findall(run(Directory, Result),
            ( member(Seed, Seeds),
              job(Options, Case, Seed, Job),
              job_directory(Job, Root, Directory),
              load_result(Directory, Result) ),
            Runs).

make_figure(Options, Figure, Figure-Claims) :-
    option(sizes(Sizes), Options),
    option(out(Out), Options),
    figure_cases(Figure, Sizes, Cases),
    maplist(case_runs(Options), Cases, CaseRuns),
    (   member(_-[], CaseRuns)
    ->  print_message(error, learning(not_made(Figure))),
        Claims = []
    ;   draw_learning(Figure, Out, Options, CaseRuns),
        learning_claims(Figure, CaseRuns, Claims),
        save_tables(Out, Figure, CaseRuns, Claims)
    ).

save_tables(Out, Figure, CaseRuns, Claims) :-
    runs_table(CaseRuns, Header, Rows),
    atomic_list_concat(['figure-', Figure, '.csv'], RunsName),
    directory_file_path(Out, RunsName, RunsFile),
    save_csv(RunsFile, Header, Rows),
    findall([Text, Held, Found], member(claim(Text, Held, Found), Claims),
            ClaimRows),
    atomic_list_concat(['figure-', Figure, '-claims.csv'], ClaimsName),
    directory_file_path(Out, ClaimsName, ClaimsFile),
    save_csv(ClaimsFile, [claim, held, found], ClaimRows).

told(Options, Cases, ClaimLists) :-
    maplist(case_runs(Options), Cases, CaseRuns),
    nl,
    print_cases(user_output, CaseRuns),
    forall(member(Figure-Claims, ClaimLists),
           ( figure(Figure, Title),
             format('~nFigure ~w: ~w~n', [Figure, Title]),
             print_claims(user_output, Claims) )),
    findall(Claim, ( member(_-Claims, ClaimLists), member(Claim, Claims) ),
            All),
    claims_sentence(All, Sentence),
    option(out(Out), Options),
    format('~n~w~nTables and pictures: ~w/figure-*~n', [Sentence, Out]).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- multifile prolog:message//1.

prolog:message(learning(not_made(Figure))) -->
    [ 'Figure ~w is not made, as runs are missing'-[Figure] ].
