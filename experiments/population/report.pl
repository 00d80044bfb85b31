:- module(population_report,
          [ print_parameters/2,         % +Stream, +Options
            print_runs/2,               % +Stream, +Results
            save_result/3,              % +Directory, +Options, +Result
            load_result/2,              % +Directory, -Result
            save_figure/4,              % +Directory, +Options, +Size, +Results
            save_group/4                % +Directory, +Options, +Groups, +Claims
          ]).
:- use_module('../lib/report', [print_table/3, save_csv/3, save_facts/2]).
:- use_module('../sync/metrics', [overlaps/2]).
:- use_module(claims, [task_gaps/2]).
:- use_module(figure, [draw_population/4]).
:- use_module(metrics, [peak/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, sum_list/2]).
:- use_module(library(option), [option/2]).

/** <module> Telling people, and files, how populations fared

*Threading*: no state; any thread.
*/

%!  print_parameters(+Stream, +Options) is det.
%
%   What is going to be run.

print_parameters(Stream, Options) :-
    what(Options, What),
    how(Options, How),
    format(Stream, '~w~n~w~n~n', [What, How]),
    flush_output(Stream).

what(Options, What) :-
    option(figure(Figure), Options),
    option(tasks(Tasks), Options),
    option(mesh(Kind), Options),
    option(degree(Degree), Options),
    option(processes(Processes), Options),
    format(atom(What),
           'Figure ~w: specialists for ~d tasks, a mesh (~w) of degree ~d \c
in ~d processes', [Figure, Tasks, Kind, Degree, Processes]).

how(Options, How) :-
    option(hop_time(Min-Max), Options),
    option(tick(Tick), Options),
    option(task_time(Seconds), Options),
    option(threshold(Threshold), Options),
    option(rounding(Rounding), Options),
    option(clock(Rate), Options),
    format(atom(How),
           'hop ~w–~w s, turn ~w s, tasks ~w s, Ψ < ~w is 0, η by ~w, \c
host clock ×~w', [Min, Max, Tick, Seconds, Threshold, Rounding, Rate]).

%!  print_runs(+Stream, +Results) is det.
%
%   A table of the tasks of all runs, and one of the runs.

print_runs(Stream, Results) :-
    task_table(Results, TaskHeader, TaskRows),
    print_table(Stream, TaskHeader, TaskRows),
    nl(Stream),
    run_table(Results, Header, Rows),
    print_table(Stream, Header, Rows),
    nl(Stream).

task_table(Results,
           [hosts, seed, task, 'first start', 'last end', span, gap,
            'most agents'], Rows) :-
    findall([Nodes, Seed, Task, First, End, Span, Gap, Peak],
            ( member(Result, Results),
              memberchk(nodes(Nodes), Result),
              memberchk(seed(Seed), Result),
              memberchk(steps(Steps), Result),
              gap_of(Result, Task, First, End, Gap),
              Span is End - First,
              peak(Task, Steps, _-Peak)
            ),
            Rows).

gap_of(Result, Task, First, End, Gap) :-
    memberchk(rows(Rows), Result),
    task_gaps(Result, Gaps0),
    append(Gaps0, [-], Gaps),
    maplist(row_gap, Rows, Gaps, Pairs),
    member(task(Task, First, _, End, _, _)-Gap, Pairs).

row_gap(Row, Gap, Row-Gap).

run_table(Results,
          [ hosts, seed, executions, overlapped, again, 'most agents',
            idle, end, settled, 'real time' ], Rows) :-
    maplist(run_row, Results, Rows).

run_row(Result,
        [ Nodes, Seed, Executions, Overlapped, Again, Peak, Idle, End,
          Settled, Wall ]) :-
    memberchk(nodes(Nodes), Result),
    memberchk(seed(Seed), Result),
    memberchk(executions(List), Result),
    length(List, Executions),
    overlaps(List, Overlapping),
    length(Overlapping, Overlapped),
    memberchk(again(AgainList), Result),
    length(AgainList, Again),
    memberchk(steps(Steps), Result),
    peak(total, Steps, _-Peak),
    task_gaps(Result, Gaps),
    findall(Gap, ( member(Gap, Gaps), Gap > 0 ), Idles),
    sum_list(Idles, Idle),
    memberchk(end(End), Result),
    memberchk(settled(Settled), Result),
    memberchk(wall(Wall), Result).

                /*******************************
                *             FILES            *
                *******************************/

%!  save_result(+Directory, +Options, +Result) is det.
%!  load_result(+Directory, -Result) is semidet.
%
%   The files of one run: result.pl with result(Result) and the parameters,
%   executions.csv and population.csv.

save_result(Directory, Options, Result) :-
    parameters(Options, Parameters),
    directory_file_path(Directory, 'result.pl', File),
    save_facts(File, [result(Result)|Parameters]),
    save_executions(Directory, Result),
    save_populations(Directory, Result).

parameters(Options, Parameters) :-
    findall(parameter(Name, Value),
            ( member(Option, Options), Option =.. [Name, Value] ),
            Parameters).

load_result(Directory, Result) :-
    directory_file_path(Directory, 'result.pl', File),
    exists_file(File),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read(In, result(Result)),
        close(In)).

save_executions(Directory, Result) :-
    findall([Task, Host, Start, End, Time],
            ( member(Kind-Time, [executions-first, again-again]),
              Part =.. [Kind, Executions],
              memberchk(Part, Result),
              member(execution(Task, Host, Start, End), Executions)
            ),
            Rows),
    directory_file_path(Directory, 'executions.csv', File),
    save_csv(File, [task, host, start, end, time], Rows).

save_populations(Directory, Result) :-
    memberchk(tasks(Tasks), Result),
    memberchk(steps(Steps), Result),
    findall(Name, ( member(Task, Tasks), atom_concat(agent, Task, Name) ),
            Names),
    findall(Row,
            ( member(step(Time, Counts, Total), Steps),
              append([[Time], Counts, [Total]], Row)
            ),
            Rows),
    append([[time], Names, [all]], Header),
    directory_file_path(Directory, 'population.csv', File),
    save_csv(File, Header, Rows).

%!  save_figure(+Directory, +Options, +Size:integer, +Results) is det.
%
%   Draw the figure of the runs with Size hosts.

save_figure(Directory, Options, Size, Results) :-
    make_directory_path(Directory),
    option(figure(Figure), Options),
    length(Results, Count),
    how(Options, How),
    format(atom(Name), 'figure-~w-~d', [Figure, Size]),
    format(atom(Title), 'Figure ~w, ~d hosts: ~w (~d runs)',
           [Figure, Size, 'one kind of agent for each task', Count]),
    draw_population(Directory, Name, Title-How, Results).

%!  save_group(+Directory, +Options, +Groups, +Claims) is det.
%
%   The files of all runs: tasks.csv, runs.csv and metadata.pl, with facts
%   parameter(Name, Value), version(Program, Version) and
%   claim(Text, Held, Found).

save_group(Directory, Options, Groups, Claims) :-
    findall(Result, ( member(_-Results, Groups), member(Result, Results) ),
            All),
    task_table(All, _, TaskRows),
    directory_file_path(Directory, 'tasks.csv', TasksFile),
    save_csv(TasksFile, [ hosts, seed, task, first_start, last_end, span,
                          gap, most_agents ], TaskRows),
    run_table(All, _, RunRows),
    directory_file_path(Directory, 'runs.csv', RunsFile),
    save_csv(RunsFile, [ hosts, seed, executions, overlapped, again,
                         most_agents, idle, end, settled, real_time ],
             RunRows),
    parameters(Options, Parameters),
    current_prolog_flag(version, Version),
    append([Parameters, [version(swi_prolog, Version)], Claims], Facts),
    directory_file_path(Directory, 'metadata.pl', File),
    save_facts(File, Facts).
