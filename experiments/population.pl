/*  One kind of agent for each task, in the number that is asked for
    (thesis chapter 6, Figures 6.3 and 6.4).

        swipl experiments/population.pl -- --figure 6.3 --nodes 50,100

    `--help` lists the parameters.
*/

:- module(population, []).
:- use_module(lib/command, [acceptable/3, command/5, range/1]).
:- use_module(lib/jobs, [job_directory/3, jobs_run/3]).
:- use_module(lib/report, [claims_sentence/2, print_claims/2]).
:- use_module(population/claims, [population_claims/2, size_claims/2]).
:- use_module(population/report,
              [ load_result/2, print_parameters/2, print_runs/2,
                save_figure/4, save_group/4, save_result/3
              ]).
:- use_module(population/run, [population_run/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2, select_option/3]).
:- use_module(library(pairs), [pairs_values/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,      figure,      atom).
opt_type(nodes,       nodes,       atom).
opt_type(runs,        runs,        natural).
opt_type(seed,        seed,        integer).
opt_type(clock,       clock,       number).
opt_type(processes,   processes,   natural).
opt_type(mesh,        mesh,        atom).
opt_type(degree,      degree,      natural).
opt_type(tasks,       tasks,       natural).
opt_type(task_time,   task_time,   number).
opt_type(hop_time,    hop_time,    term).
opt_type(tick,        tick,        number).
opt_type(threshold,   threshold,   number).
opt_type(rounding,    rounding,    atom).
opt_type(replication, replication, atom).
opt_type(cr_start,    cr_start,    number).
opt_type(q_th,        q_th,        natural).
opt_type(crash,       crash,       nonneg).
opt_type(limit,       limit,       number).
opt_type(jobs,        jobs,        natural).
opt_type(out,         out,         atom).

opt_help(help(header), "Agents of one kind for each task execute a sequence \c
on all hosts of a mesh,\nin the number that is asked for (thesis \c
chapter 6)\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,      "6.3, or 6.4: hosts lose task 2 while task 4 is \c
executed [6.3]").
opt_help(nodes,       "Number of hosts, or several: 50,100 [50]").
opt_help(runs,        "Number of runs of each [3]").
opt_help(seed,        "Seed of the first run; the next has the next [1]").
opt_help(clock,       "Host seconds in a real second [10]").
opt_help(processes,   "Operating system processes the hosts live in [2]").
opt_help(mesh,        "Network of the hosts: rings or random [rings]").
opt_help(degree,      "Neighbours of a host, about [10]").
opt_help(tasks,       "Length of the sequence of tasks [5]").
opt_help(task_time,   "Host seconds that a task takes [1]").
opt_help(hop_time,    "MIN-MAX host seconds that a hop takes [0.8-1.2]").
opt_help(tick,        "Host seconds of an agent's turn in a queue [1]").
opt_help(threshold,   "Action potential that counts as zero [0.01]").
opt_help(rounding,    "Of the number of clones: floor or round [floor]").
opt_help(replication, "Cloning after a reward only: rewarded, or always \c
[rewarded]").
opt_help(cr_start,    "Cloning resource of the first agents [10]").
opt_help(q_th,        "Capacity of a queue [4]").
opt_help(crash,       "Hosts that lose task 2, in Figure 6.4 [20]").
opt_help(limit,       "Host seconds after which a run is ended [900]").
opt_help(jobs,        "Runs at a time, where there are several [1]").
opt_help(out,         "Directory for logs, tables and pictures \c
[out/population]").

opt_meta(figure,   'FIGURE').
opt_meta(nodes,    'N').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(mesh,     'HOW').
opt_meta(rounding, 'HOW').
opt_meta(replication, 'WHEN').
opt_meta(out,      'DIRECTORY').

defaults([ figure('6.3'), nodes('50'), runs(3), seed(1), clock(10),
           processes(2), mesh(rings), degree(10), tasks(5), task_time(1),
           hop_time(0.8-1.2), tick(1), threshold(0.01), rounding(floor),
           replication(rewarded), cr_start(10), q_th(4), crash(20),
           limit(900), jobs(1), out('out/population')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    forall(( member(Name, [clock, limit, tick, threshold]),
             value(Name, Options, Value) ),
           acceptable(Value > 0, Name, Value)),
    forall(choice(Name, Choices),
           ( value(Name, Options, Value),
             acceptable(memberchk(Value, Choices), Name, Value) )),
    option(hop_time(HopTime), Options),
    acceptable(range(HopTime), hop_time, HopTime),
    option(nodes(Nodes), Options),
    acceptable(sizes(Nodes, _), nodes, Nodes).

choice(figure, ['6.3', '6.4']).
choice(mesh, [rings, random]).
choice(rounding, [round, floor]).
choice(replication, [rewarded, always]).

value(Name, Options, Value) :-
    Option =.. [Name, Value],
    option(Option, Options).

sizes(Nodes, Sizes) :-
    atomic_list_concat(Parts, ',', Nodes),
    maplist(size, Parts, Sizes).

size(Part, Size) :-
    atom_number(Part, Size),
    integer(Size),
    Size > 1.

                /*******************************
                *             RUNS             *
                *******************************/

%   One run is made here; of several, each in a process of its own, in a
%   directory of its own below that of the figure.

run(Options) :-
    option(nodes(Nodes), Options),
    sizes(Nodes, Sizes),
    run(Sizes, Options).

run([Size], Options) :-
    option(runs(1), Options),
    !,
    option(out(Out), Options),
    print_parameters(user_output, Options),
    run_options(Size, Options, RunOptions),
    population_run(RunOptions, Out, Result),
    save_result(Out, Options, Result),
    tell(Out, Options, [Size-[Result]]).
run(Sizes, Options) :-
    option(out(Out), Options),
    option(jobs(AtATime), Options),
    print_parameters(user_output, Options),
    findall(Size-Jobs, ( member(Size, Sizes), jobs(Size, Options, Jobs) ),
            Groups0),
    pairs_values(Groups0, Nested),
    append(Nested, Jobs),
    jobs_run(Jobs, [out(Out), jobs(AtATime)], _),
    maplist(collect(Out), Groups0, Groups),
    tell(Out, Options, Groups).

run_options(Size, Options0, [nodes(Size), crash(Crash), settings(Settings)
                            | Options
                            ]) :-
    select_option(nodes(_), Options0, Options1),
    select_option(crash(Crash0), Options1, Options),
    (   option(figure('6.4'), Options)
    ->  Crash = Crash0
    ;   Crash = 0
    ),
    findall(Name-Value,
            ( member(Name, [ tick, threshold, rounding, replication,
                             cr_start ]),
              value(Name, Options, Value)
            ),
            Settings).

jobs(Size, Options, Jobs) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds),
    maplist(job(Size, Options), Seeds, Jobs).

job(Size, Options, Seed, job(Name, Script, Arguments)) :-
    module_property(population, file(Script)),
    option(figure(Figure), Options),
    atomic_list_concat([figure, Figure, Size, seed], -, Prefix),
    atom_concat(Prefix, Seed, Name),
    findall(Argument,
            ( member(Option, [nodes(Size), seed(Seed), runs(1)]),
              argument(Option, Argument)
            ),
            Given),
    findall(Argument,
            ( member(Option, Options),
              functor(Option, OptionName, 1),
              \+ memberchk(OptionName, [nodes, seed, runs, jobs, out]),
              argument(Option, Argument)
            ),
            Others),
    append(Given, Others, Arguments).

argument(Option, Argument) :-
    Option =.. [Name, Value],
    format(atom(Argument), '--~w=~w', [Name, Value]).

%   Runs that failed were told, and are left out.

collect(Out, Size-Jobs, Size-Results) :-
    findall(Result,
            ( member(Job, Jobs),
              job_directory(Job, Out, Directory),
              exists_directory(Directory),
              load_result(Directory, Result)
            ),
            Results).

tell(Out, Options, Groups0) :-
    findall(Size-Results, ( member(Size-Results, Groups0), Results \== [] ),
            Groups),
    (   Groups == []
    ->  halt(1)
    ;   tell_groups(Out, Options, Groups)
    ).

tell_groups(Out, Options, Groups) :-
    forall(member(Size-Results, Groups),
           ( print_runs(user_output, Results),
             save_figure(Out, Options, Size, Results) )),
    findall(Claims, ( member(_-Results, Groups),
                      population_claims(Results, Claims) ),
            Nested),
    size_claims(Groups, SizeClaims),
    append(Nested, Claims0),
    append(Claims0, SizeClaims, Claims),
    save_group(Out, Options, Groups, Claims),
    nl,
    print_claims(user_output, Claims),
    claims_sentence(Claims, Sentence),
    format('~n~w~nLogs, tables and figures: ~w/~n', [Sentence, Out]).
