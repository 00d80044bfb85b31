:- module(chaos_run,
          [ chaos/2,                    % +Options, -Reports
            main/1                      % +Argv
          ]).

/** <module> A suite that attacks

    swipl test/chaos/run.pl -- [--seconds N] [--seed N] [--scenario NAME|all]
        [--processes N] [--agents N] [--settle N] [--out DIR]

has agents travel, write to each other, clone themselves and carry tokens
between processes whose connections are cut and held, which are stopped and
killed, and then compares what there is with what must be.  See doc/chaos.md.

*Threading*: the main thread; see chaos_cluster.
*/

:- use_module('../common', [project_file/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(filesex),
              [ delete_directory_contents/1, directory_file_path/3,
                make_directory_path/1 ]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(main), [main/0, argv_options/3]).
:- use_module(library(option), [option/3]).
:- use_module(cluster).
:- use_module(evidence).
:- use_module(faults).
:- use_module(report).
:- use_module(verdict).
:- use_module(work).

:- initialization(main, main).

opt_type(seconds,   seconds,   number).
opt_type(seed,      seed,      integer).
opt_type(scenario,  scenario,  atom).
opt_type(processes, processes, integer).
opt_type(agents,    agents,    integer).
opt_type(settle,    settle,    number).
opt_type(out,       out,       atom).

opt_help(help(header), " [option ...]").
opt_help(seconds,   "How long the attack lasts, all scenarios together").
opt_help(seed,      "What the schedule of faults follows from").
opt_help(scenario,  "calm, cuts, stops, kills, deaths or all").
opt_help(processes, "How many processes, with three hosts each").
opt_help(agents,    "About so many agents to begin with").
opt_help(settle,    "At the most so long for things to settle").
opt_help(out,       "Directory for ledgers, messages and findings").

opt_meta(seconds, 'N').
opt_meta(seed, 'N').
opt_meta(scenario, 'NAME').
opt_meta(processes, 'N').
opt_meta(agents, 'N').
opt_meta(settle, 'N').
opt_meta(out, 'DIR').

main(Argv) :-
    argv_options(Argv, Rest, Options),
    (   Rest == [],
        scenarios(Options, _)
    ->  true
    ;   argv_usage([]),
        halt(2)
    ),
    chaos(Options, Reports),
    (   member(Report, Reports),
        report_wrong(Report)
    ->  halt(1)
    ;   halt(0)
    ).

argv_usage(_) :-
    findall(Name, scenario(Name, _), Names),
    format(user_error, 'Scenarios: ~w, or all~n', [Names]).

%!  chaos(+Options, -Reports) is det.
%
%   Run the scenarios, one after the other, and print what came of them.
%   Options are those of the command line.  A report is
%   report(Scenario, Figures, Findings), see chaos_report.

chaos(Options, Reports) :-
    set_prolog_flag(stack_limit, 8 000 000 000),
    scenarios(Options, Scenarios),
    length(Scenarios, Count),
    option(seconds(Total), Options, 40),
    Seconds is Total/Count,
    maplist(run_one(Options, Seconds), Scenarios, Reports),
    report_print(Reports, Options).

scenarios(Options, Scenarios) :-
    option(scenario(Name), Options, all),
    (   Name == all
    ->  findall(Scenario, scenario(Scenario, _), Scenarios)
    ;   scenario(Name, _),
        Scenarios = [Name]
    ).

run_one(Options, Seconds, Scenario, Report) :-
    option(seed(Seed), Options, 1),
    option(processes(Count), Options, 4),
    numlist(1, Count, Numbers),
    maplist([N,Name]>>( I is 0'a+N-1, char_code(Name, I) ), Numbers, Names),
    directory(Options, Scenario, Seed, Dir),
    schedule(Scenario, Seed, Seconds, Names, Events),
    report_begin(Scenario, Seconds, Dir),
    with_cluster(Names, Dir,
                 attack(Options, Scenario, Events, Seconds, Dir, Evidence)),
    verdict(Scenario, Evidence, Findings),
    report(Scenario, Dir, Events, Evidence.put(seconds, Seconds), Findings,
           Report).

directory(Options, Scenario, Seed, Dir) :-
    project_file('out/chaos', Default),
    option(out(Base), Options, Default),
    format(atom(Name), '~w-~w', [Scenario, Seed]),
    directory_file_path(Base, Name, Dir),
    make_directory_path(Dir),
    delete_directory_contents(Dir).

attack(Options, Scenario, Events, Seconds, Dir, Evidence) :-
    option(agents(Scale), Options, 48),
    option(settle(Longest), Options, 60),
    work_begin(Scale),
    get_time(Begin),
    play(Events, Begin),
    End is Begin+Seconds,
    cluster_wait(End),
    heal(Scenario),
    work_finish,
    settle(Longest),
    evidence(Dir, Evidence).

play([], _).
play([Time-Event|Events], Begin) :-
    Stamp is Begin+Time,
    cluster_wait(Stamp),
    work_answers,
    (   fault(Event)
    ->  true
    ;   work_event(Event)
    ->  true
    ;   print_message(error, format("Cannot do ~q", [Event]))
    ),
    play(Events, Begin).
