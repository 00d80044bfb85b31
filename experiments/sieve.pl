/*  The idiotypic sieve: Figures 3.3 to 3.5 of the thesis, and memory cells.

        swipl experiments/sieve.pl -- --figure 3.4 --runs 3

    `--help` lists the parameters.
*/

:- module(sieve, []).
:- use_module(lib/command, [acceptable/3, command/5]).
:- use_module(lib/jobs, [job_directory/3, jobs_run/3]).
:- use_module(lib/report,
              [claims_sentence/2, print_claims/2, save_csv/3, save_facts/2]).
:- use_module(sieve/claims, [sieve_claims/3]).
:- use_module(sieve/figure, [draw_sieve/4]).
:- use_module(sieve/memory,
              [draw_memory/3, memory_case/2, memory_claims/2]).
:- use_module(sieve/programs, [draw_programs/3, programs_claims/2]).
:- use_module(sieve/report,
              [figure_table/3, load_rounds/2, print_parameters/2]).
:- use_module(sieve/rounds, [plan/2]).
:- use_module(sieve/run, [sieve_run/3]).
:- use_module(sieve/simulation, [simulate/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,    figure,    atom).
opt_type(model,     model,     atom).
opt_type(runs,      runs,      natural).
opt_type(seed,      seed,      integer).
opt_type(topology,  topology,  term).
opt_type(dynamic,   dynamic,   term).
opt_type(processes, processes, natural).
opt_type(capacity,  capacity,  natural).
opt_type(hop_time,  hop_time,  term).
opt_type(clock,     clock,     number).
opt_type(attacked,  attacked,  natural).
opt_type(round,     round,     number).
opt_type(settings,  settings,  term).
opt_type(jobs,      jobs,      natural).
opt_type(single,    single,    boolean).
opt_type(out,       out,       atom).

opt_help(help(header), "Antibodies carried by mobile agents stimulate and \c
suppress each other\non the hosts of a network under attack (thesis \c
chapter 3)\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,    "3.3, 3.4, 3.5, memory, programs or all [all]").
opt_help(model,     "platform: agents on a network; simulation: a quick \c
model of it [platform]").
opt_help(runs,      "Runs with consecutive seeds [3]").
opt_help(seed,      "The first seed [1]").
opt_help(topology,  "Topology of the network [random(100,0.06)]").
opt_help(dynamic,   "How links come and go, or none \c
[links(uniform(10,20),0.5,0.5)]").
opt_help(processes, "Processes that the hosts of one network live in [2]").
opt_help(capacity,  "Agents that a host admits [40]").
opt_help(hop_time,  "MIN-MAX host seconds that a hop takes [0.6-1.4]").
opt_help(clock,     "Host seconds in a real second [5]").
opt_help(attacked,  "Hosts that each antigen attacks in a round [10]").
opt_help(round,     "Host seconds from round to round [40]").
opt_help(settings,  "List of Name-Value for the agents, before those of \c
the figure [[omega-200]]").
opt_help(jobs,      "Runs at the same time [1]").
opt_help(single,    "Make one run in this process, without pictures [false]").
opt_help(out,       "Directory for tables, pictures and runs [out/sieve]").

opt_meta(figure,   'FIGURE').
opt_meta(model,    'MODEL').
opt_meta(topology, 'TOPOLOGY').
opt_meta(dynamic,  'MODEL').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(settings, 'LIST').
opt_meta(out,      'DIRECTORY').

defaults([ figure(all), model(platform), runs(3), seed(1),
           topology(random(100,0.06)), dynamic(links(uniform(10,20),0.5,0.5)),
           processes(2), capacity(40), hop_time(0.6-1.4), clock(5),
           attacked(10), round(40), settings([omega-200]), jobs(1),
           single(false), out('out/sieve')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    option(figure(Figure), Options),
    acceptable(( Figure == all ; plan(Figure, _) ), figure, Figure),
    option(model(Model), Options),
    acceptable(memberchk(Model, [platform, simulation]), model, Model).

run(Options) :-
    option(single(true), Options),
    !,
    option(out(Out), Options),
    option(model(Model), Options),
    make_directory_path(Out),
    run_model(Model, Options, Out, Rounds),
    directory_file_path(Out, 'rounds.pl', File),
    save_facts(File, [rounds(Rounds)]).
run(Options) :-
    print_parameters(user_output, Options),
    option(figure(Wanted), Options),
    findall(Figure, ( plan(Figure, _), wanted(Wanted, Figure) ), Figures),
    maplist(make_figure(Options), Figures).

run_model(platform, Options, Out, Rounds) :-
    sieve_run(Options, Out, Rounds).
run_model(simulation, Options, _, Rounds) :-
    simulate(Options, Rounds).

wanted(all, _) :-
    !.
wanted(Figure, Figure).

                /*******************************
                *            FIGURES           *
                *******************************/

make_figure(Options, Figure) :-
    findall(Case-Settings, case(Figure, Case, Settings), Cases),
    maplist(runs(Options, Figure), Cases, CaseRuns),
    option(out(Out), Options),
    subtitle(Options, Subtitle),
    draw(Figure, Out, Subtitle, CaseRuns, Claims),
    figure_table(CaseRuns, Header, Rows),
    atomic_list_concat(['sieve-', Figure, '.csv'], CsvName),
    directory_file_path(Out, CsvName, Csv),
    save_csv(Csv, Header, Rows),
    format('~nFigure ~w~n', [Figure]),
    print_claims(user_output, Claims),
    claims_sentence(Claims, Sentence),
    format('~w~nTable and picture: ~w/sieve-~w.*~n', [Sentence, Out, Figure]).

draw(memory, Out, Subtitle, CaseRuns, Claims) :-
    !,
    draw_memory(Out, Subtitle, CaseRuns),
    memory_claims(CaseRuns, Claims).
draw(programs, Out, Subtitle, [_-Runs], Claims) :-
    !,
    draw_programs(Out, Subtitle, Runs),
    programs_claims(Runs, Claims).
draw(Figure, Out, Subtitle, [_-Runs], Claims) :-
    draw_sieve(Out, Figure, Subtitle, Runs),
    sieve_claims(Figure, Runs, Claims).

%   case(+Figure, -Case, -Settings): what is compared in a figure.

case(Figure, Case, Settings) :-
    (   Figure == memory
    ->  memory_case(Case, Settings)
    ;   Case = sieve,
        Settings = []
    ).

subtitle(Options, Subtitle) :-
    option(topology(Topology), Options),
    option(attacked(K), Options),
    option(round(Seconds), Options),
    option(runs(Runs), Options),
    option(settings(Settings), Options),
    option(model(Model), Options),
    format(atom(Subtitle), '~w, ~w, ~w hosts per antigen, rounds of ~w s, \c
~w, ~w runs', [Model, Topology, K, Seconds, Settings, Runs]).

%   runs(+Options, +Figure, +Case, -CaseRuns): CaseRuns is
%   Case-[Seed-Rounds, ...].

runs(Options, Figure, Case-More, Case-Runs) :-
    option(seed(First), Options),
    option(runs(Count), Options),
    Last is First + Count - 1,
    numlist(First, Last, Seeds),
    maplist(job(Options, Figure, More), Seeds, Jobs),
    option(out(Out), Options),
    option(jobs(N), Options),
    directory_file_path(Out, runs, Root),
    jobs_run(Jobs, [out(Root), jobs(N)], _),
    findall(Seed-Rounds,
            ( member(Seed, Seeds),
              job(Options, Figure, More, Seed, Job),
              job_directory(Job, Root, Directory),
              load_rounds(Directory, Rounds)
            ),
            Runs).

job(Options, Figure, More, Seed, job(Name, Script, Arguments)) :-
    module_property(sieve, file(Script)),
    option(settings(Settings0), Options),
    append(More, Settings0, Settings),
    findall(Option, inherited(Options, Option), Inherited),
    append([ figure(Figure), seed(Seed), settings(Settings), single(true) ],
           Inherited, All),
    maplist(argument, All, Arguments),
    option(model(Model), Options),
    atomic_list_concat([Figure, Model, Seed], -, Name).

inherited(Options, Option) :-
    member(Name, [ model, topology, dynamic, processes, capacity, hop_time,
                   clock, attacked, round ]),
    Option =.. [Name, _],
    option(Option, Options).

argument(Option, Argument) :-
    Option =.. [Name, Value],
    (   atom(Value)
    ->  format(atom(Argument), '--~w=~w', [Name, Value])
    ;   format(atom(Argument), '--~w=~q', [Name, Value])
    ).
