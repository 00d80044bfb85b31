/*  Studies: many runs of agents, with measures, claims and plots.

        swipl experiments/study.pl -- 5.6 --runs 10
        swipl experiments/study.pl -- my_study.pl --set agents=20

    `--help` lists the options; doc/studies.md explains how to write a study.
*/

:- module(study, []).
:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(engine/catalogue, [catalogue/1, studies_named/2]).
:- use_module('../app/typhon/engine_options', [engine_options/3]).
:- use_module(engine/commands, [print_commands/2]).
:- use_module(engine/estimate, [longest_first/2]).
:- use_module(engine/figures, [figures/3]).
:- use_module(engine/machines, [beside_machines/2]).
:- use_module(engine/plan,
              [ planned/4, planned_case/4, planned_real/3, plans/3,
                real_way/3, runs_directory/2 ]).
:- use_module(engine/program, [run_option/4, run_program/1]).
:- use_module(engine/replays, [replay_runs/3]).
:- use_module(engine/report, [parameter_rows/3, print_table/3]).
:- use_module(engine/store, [run_result/3]).
:- use_module(engine/studies, [study_load/2, study_title/3]).
:- use_module(engine/work, [runs_make/4]).
:- autoload('../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).
:- use_module(engine/live, []).
:- autoload('engine/fleet_runs', [fleet_runs/5]).
:- use_module(engine/worker, [run_here/4]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, selectchk/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- initialization(main, main).

:- public main/1.

opt_type(Name,    Name,    Type) :-
    run_option(Name, Type, _, _).
opt_type(case,    case,    atom).
opt_type(logs,    logs,    boolean).
opt_type(replays, replays, boolean).
opt_type(real,    real,    boolean).
opt_type(page,    page,    boolean).
opt_type(port,    port,    nonneg).
opt_type(real_runs, real_runs, natural).
opt_type(real_clock, real_clock, number).
opt_type(machines, machines, atom).
opt_type(bind,    bind,    atom).
opt_type(means,   means,   boolean).
opt_type(fleet,   fleet,   atom).
opt_type(redis,   redis,   atom).
opt_type(user,    user,    atom).
opt_type(password_file, password_file, file(read)).
opt_type(cacert,  cacert,  file(read)).

opt_help(help(header),
"Makes runs of studies, and their tables, claims and pictures\n").
opt_help(help(usage),
" -- STUDY ... [options]

A STUDY is a file, a figure of the thesis such as 5.6, a folder of experiments/,
`thesis`: all figures and tables, or `beyond`: the studies beyond it. Without a
STUDY, the studies are listed. Finished runs are kept, and not repeated.").
opt_help(Name,    Help) :-
    run_option(Name, _, _, Help).
opt_help(case,    "Make one run, of this case with the first seed, in this \c
process: its number or name, such as delta=0.5,topology=ring").
opt_help(logs,    "Keep the log of each run, events.pl [false]").
opt_help(replays, "Repeat a run of the first study of each folder, for a \c
replay in a browser [false]").
opt_help(real,    "Make one case on real sockets, too, and report whether \c
its measures are within those of virtual time [false]").
opt_help(page,    "Show one run of the first study on a page, with sliders \c
for its parameters, until Ctrl-C [false]").
opt_help(port,    "Of that page; 0: any [8080]").
opt_help(real_runs, "Runs of that case, in real time [1]").
opt_help(real_clock, "Host seconds in one, in real time [as in real/2]").
opt_help(machines, "Make that case on machines, too: targets of ssh, with \c
commas, or a number, of machines that are made on this one").
opt_help(bind,    "With --machines: the address of this one for them").
opt_help(means,   "Print means and their confidence intervals, too [false]").
opt_help(fleet,   "Share the runs with all processes in which the same \c
command runs, on any machine, as members of this fleet").
opt_help(redis,   "With --fleet: its engine, a server of Redis or Valkey").
opt_help(user,    "With --fleet: user of the engine").
opt_help(password_file, "With --fleet: password of the engine").
opt_help(cacert,  "With --fleet: use TLS; certificate of the authority of \c
the engine").

opt_meta(Name, Meta) :-
    run_option(Name, _, Meta, _).
opt_meta(case, 'CASE').
opt_meta(machines, 'MACHINES').
opt_meta(bind, 'ADDRESS').
opt_meta(fleet, 'FLEET').
opt_meta(redis, 'HOST:PORT').
opt_meta(user, 'NAME').
opt_meta(password_file, 'FILE').
opt_meta(cacert, 'FILE').

main(Argv) :-
    run_program(( parsed(Argv, Names, Options),
                  command(Names, Options) )).

parsed(Argv0, Names, [help(true)|Options]) :-
    member(Help, ['--help', '-h']),
    selectchk(Help, Argv0, Argv),
    arguments(Argv, Names, Options),
    Names \== [],
    !.
parsed(Argv, Names, Options) :-
    arguments(Argv, Names, Options).

command([], _) :-
    !,
    catalogue(Rows),
    print_table(user_output, [study, title], Rows).
command(Names, Options) :-
    studies_named(Names, Files),
    maplist(study_load, Files, Studies),
    (   option(help(true), Options)
    ->  maplist(print_help, Studies)
    ;   plans(Studies, Options, Plans),
        perform(Plans, Options)
    ).

%   The parameters that --set may change.

print_help(Study) :-
    study_title(Study, Name, Title),
    format('~w: ~w~n~n', [Name, Title]),
    parameter_rows(Study, [], Rows),
    print_table(user_output, [parameter, value, why], Rows).

                /*******************************
                *             RUNS             *
                *******************************/

perform(Plans, Options) :-
    option(list(true), Options),
    !,
    print_commands(planned_run(Plans, Options), Options).
perform(Plans, Options) :-
    option(case(Text), Options),
    !,
    planned_case(Plans, Text, Study, Case),
    make_one(Study, Case, Options).
perform(Plans, Options) :-
    option(page(true), Options),
    !,
    option(port(Port), Options, 8080),
    planned(Plans, Options, _, run(Study, _, _)),
    !,
    call_cleanup(live_page(Study, Port), page_stop).
perform(_, Options) :-
    beside_machines(Options, Status),
    !,
    halt(Status).
perform(Plans, Options) :-
    option(collect(true), Options),
    !,
    figures(Plans, Options, Missing),
    halt_unless_none(Missing).
perform(Plans, Options) :-
    findall(Run, planned(Plans, Options, _, Run), Runs0),
    longest_first(Runs0, Runs),
    runs_directory(Options, Root),
    replay_runs(Plans, Options, Replays),
    make(Runs, Replays, Root, Options, Failed),
    make_real(Plans, Root, Options, RealFailed),
    figures(Plans, Options, Missing),
    halt_unless_none(Failed + Missing + RealFailed).

planned_run(Plans, Options, N, Study, Seed) :-
    planned(Plans, Options, N, run(Study, _, Seed)).

live_page(Study, Port) :-
    page_serve([port(Port), overlays([Study]), model(study_live:live(Study))],
               Link),
    format('~w~n', [Link]),
    flush_output,
    thread_get_message(stop).           % only a signal ends this

%   Logs for replays are large, so a fleet does not share them.

make(Runs, Replays, Root, Options, Failed) :-
    engine_options(study, Options, Engine),
    (   option(fleet(Fleet), Options)
    ->  fleet_runs(Fleet-Engine, Runs, Root, Options, Failed0),
        runs_make(Replays, Root, Options, Failed1),
        Failed is Failed0 + Failed1
    ;   append(Replays, Runs, All),
        runs_make(All, Root, Options, Failed)
    ).

halt_unless_none(Count) :-
    (   Count =:= 0
    ->  true
    ;   halt(1)
    ).

%   In real time runs disturb each other, so they are made one by one.

make_real(Plans, Root, Options, Failed) :-
    findall(Run, planned_real(Plans, Options, Run), Runs),
    (   Runs == [],
        real_way(Options, _, _)
    ->  print_message(warning, study_none_is_real)
    ;   true
    ),
    runs_make(Runs, Root, [jobs(1)|Options], Failed).

make_one(Study, Case, Options) :-
    option(seed(Seed), Options, 1),
    Run = run(Study, Case, Seed),
    runs_directory(Options, Root),
    run_here(Run, Root, Options, Outcome),
    (   Outcome = failed(Directory, _)
    ->  directory_file_path(Directory, output, File),
        read_file_to_string(File, Text, [encoding(utf8)]),
        format(user_error, '~w~nThe run failed; see ~w~n',
               [Text, File]),
        halt(1)
    ;   run_result(Root, Run, Measures),
        dict_pairs(Measures, _, Pairs),
        findall([Name, Value],
                ( member(Name-Value, Pairs), number(Value) ), Rows),
        print_table(user_output, [measure, value], Rows),
        format('~nIn ~w~n', [Measures.directory])
    ).

:- multifile
    prolog:message//1.

prolog:message(study_none_is_real) -->
    [ '--real: real/2 selects none of these cases'-[] ].
