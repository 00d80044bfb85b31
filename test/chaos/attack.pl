:- module(chaos_attack,
          [ chaos/2                     % +Options, -Reports
          ]).

/** <module> The chaos suite

Agents travel, send messages, clone themselves and carry tokens between
processes that are suspended and killed, and whose connections are cut and
blocked; then the result is compared with the invariants. See doc/chaos.md.

*Threading*: the main thread; see chaos_cluster.
*/

:- use_module('../lib/common', [project_file/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(filesex),
              [ delete_directory_contents/1, directory_file_path/3,
                make_directory_path/1 ]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(option), [option/3]).
:- use_module(cluster).
:- use_module(evidence).
:- use_module(faults).
:- use_module(report).
:- use_module(verdict).
:- use_module(work).

%!  chaos(+Options, -Reports) is det.
%
%   Run the scenarios, one after the other, and print the results. Options are
%   those of the command line, and swipl(Program): the Prolog of the
%   processes, by default that of this process.  A report is report(Scenario,
%   Figures, Findings), see chaos_report.

chaos(Options, Reports) :-
    set_prolog_flag(stack_limit, 8 000 000 000),
    scenarios(Options, Scenarios),
    option(seconds(Total), Options, 40),
    maplist(run_one(Options, Total), Scenarios, Reports),
    report_print(Reports, Options).

scenarios(Options, Scenarios) :-
    option(scenario(Name), Options, all),
    (   Name == all
    ->  findall(Scenario-Share, scenario(Scenario, Share, _), Scenarios)
    ;   scenario(Name, _, _)
    ->  Scenarios = [Name-100]
    ;   domain_error(scenario, Name)
    ).

run_one(Options, Total, Scenario-Share, Report) :-
    Seconds is Total*Share/100,
    option(seed(Seed), Options, 1),
    option(processes(Count), Options, 4),
    numlist(1, Count, Numbers),
    maplist(name, Numbers, Names),
    directory(Options, Scenario, Seed, Dir),
    schedule(Scenario, Seed, Seconds, Names, Events),
    report_begin(Scenario, Seconds, Dir),
    current_prolog_flag(executable, This),
    option(swipl(Swipl), Options, This),
    with_cluster(Names, Dir, Swipl,
                 attack(Options, Scenario, Events, Seconds, Dir, Evidence)),
    verdict(Scenario, Evidence, Findings),
    report(Scenario, Dir, Events, Evidence.put(seconds, Seconds), Findings,
           Report).

name(Number, Name) :-
    Code is 0'a+Number-1,
    char_code(Name, Code).

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
    work_halt,
    settle(Longest, rest(0, 0), Rest),
    work_roll_call,
    settle(Longest, Rest, _),
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
