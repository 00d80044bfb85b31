:- module(sync_report,
          [ print_parameters/2,         % +Stream, +Options
            how/2,                      % +Options, -Text
            print_result/2,             % +Stream, +Result
            save_result/4,              % +Dir, +Options, +Result, +Claims
            result_summary/2            % +Result, -Summary
          ]).
:- use_module('../lib/report', [print_table/3, save_csv/3, save_facts/2]).
:- use_module(figure, [draw_figure/3]).
:- use_module(measures, [measures/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/2, member/2, memberchk/2]).
:- use_module(library(option), [option/2]).

/** <module> Telling people, and files, the result of a run

*Threading*: no state; any thread.
*/

%!  print_parameters(+Stream, +Options) is det.
%
%   What is going to be run, in two lines.

print_parameters(Stream, Options) :-
    what(Options, What),
    how(Options, How),
    format(Stream, '~w~n~w~n', [What, How]).

what(Options, What) :-
    option(tasks(Tasks), Options),
    option(agents(Agents), Options),
    option(topology(Topology), Options),
    option(processes(Processes), Options),
    format(atom(What),
           'Synchronised execution: ~d tasks, ~d agents, ~w in ~d processes',
           [Tasks, Agents, Topology, Processes]).

%!  how(+Options, -Text) is det.
%
%   Text tells the parameters that make the time of a run.

how(Options, How) :-
    option(delta(Delta), Options),
    option(hop_time(Min-Max), Options),
    option(task_time(Seconds), Options),
    option(clock(Rate), Options),
    option(seed(Seed), Options),
    findall(Text, circumstance(Options, Text), Texts),
    atomic_list_concat(Texts, More),
    time_text(Seconds, Time),
    format(atom(How),
           'δ = ~w, hop ~w–~w s, tasks ~w s, host clock ×~w, seed ~w~w',
           [Delta, Min, Max, Time, Rate, Seed, More]).

circumstance(Options, Text) :-
    option(dynamic(Model), Options),
    Model \== none,
    format(atom(Text), ', ~w', [Model]).
circumstance(Options, Text) :-
    option(failure(Failure), Options),
    Failure =.. [Kind, Task, Count, During],
    format(atom(Text), ', ~w failure of T~w at ~w hosts during T~w',
           [Kind, Task, Count, During]).

time_text(Times, Text) :-
    is_list(Times),
    !,
    maplist(time_text, Times, Texts),
    atomic_list_concat(Texts, ', ', Text).
time_text(Min-Max, Text) :-
    !,
    format(atom(Text), '~w–~w', [Min, Max]).
time_text(Seconds, Seconds).

%!  print_result(+Stream, +Result) is det.
%
%   The table of the tasks and what follows from it.

print_result(Stream, Result) :-
    memberchk(rows(Rows), Result),
    findall([Name, First, Last, End, Count, Idle],
            ( member(task(Task, First, Last, End, Count, Idle0), Rows),
              atom_concat('T', Task, Name),
              cell(Idle0, Idle)
            ),
            Cells),
    print_table(Stream,
                [ task, 'first start', 'last start', 'last end', executions,
                  'idle gap'
                ], Cells),
    result_summary(Result, summary(Idle, Overlaps, Tau, Total, Wall)),
    format(Stream,
           '~nidle ~2f s in all, ~d overlapped executions, τ at most ~d, \c
~2f s in all (~1f s of real time)~n', [Idle, Overlaps, Tau, Total, Wall]).

cell(none, '-') :- !.
cell(X, X).

%!  result_summary(+Result, -Summary) is det.
%
%   Summary is summary(Idle, Overlaps, TauMax, Total, Wall).

result_summary(Result, summary(Idle, Overlaps, Tau, Total, Wall)) :-
    measures(Result, Measures),
    memberchk(idle(Idle), Measures),
    memberchk(overlaps(Overlaps), Measures),
    memberchk(tau(Tau), Measures),
    memberchk(total(Total), Measures),
    memberchk(real_time(Wall), Measures).

%!  save_result(+Directory, +Options, +Result, +Claims) is det.
%
%   Write executions.csv, tasks.csv, metadata.pl and the figure.

save_result(Directory, Options, Result, Claims) :-
    save_executions(Directory, Result),
    save_tasks(Directory, Result),
    save_metadata(Directory, Options, Result, Claims),
    (   option(picture(true), Options)
    ->  draw_run(Directory, Options, Result)
    ;   true
    ).

draw_run(Directory, Options, Result) :-
    what(Options, Title),
    how(Options, Subtitle),
    draw_figure(Directory, synchronisation,
                [title(Title), subtitle(Subtitle)|Result]).

save_executions(Directory, Result) :-
    memberchk(executions(Executions), Result),
    findall([Task, Host, Start, End],
            member(execution(Task, Host, Start, End), Executions), Cells),
    directory_file_path(Directory, 'executions.csv', File),
    save_csv(File, [task, host, start, end], Cells).

save_tasks(Directory, Result) :-
    memberchk(rows(Rows), Result),
    findall([Task, First, Last, End, Count, Idle],
            ( member(task(Task, First, Last, End, Count, Idle0), Rows),
              blank(Idle0, Idle)
            ),
            Cells),
    directory_file_path(Directory, 'tasks.csv', File),
    save_csv(File, [ task, first_start, last_start, last_end, executions,
                     idle_gap
                   ], Cells).

blank(none, '') :- !.
blank(X, X).

%   Facts parameter(Name, Value), version(Program, Version), hosts(List),
%   result(Name, Value) and claim(Text, Held, Found).

save_metadata(Directory, Options, Result, Claims) :-
    findall(parameter(Name, Value),
            ( member(Option, Options), Option =.. [Name, Value] ),
            Parameters),
    findall(version(Program, Version), version(Program, Version), Versions),
    memberchk(hosts(Hosts), Result),
    measures(Result, Measures),
    findall(result(Name, Value),
            ( member(Measure, Measures), Measure =.. [Name, Value] ),
            Results),
    append([Parameters, Versions, [hosts(Hosts)], Results, Claims], Facts),
    directory_file_path(Directory, 'metadata.pl', File),
    save_facts(File, Facts).

version(swi_prolog, Version) :-
    current_prolog_flag(version_data, Version).
version(architecture, Arch) :-
    current_prolog_flag(arch, Arch).
version(typhon, Version) :-
    module_property(sync_report, file(File)),
    relative_file_name(Pack, File, '../../pack.pl'),
    exists_file(Pack),
    setup_call_cleanup(
        open(Pack, read, In),
        pack_version(In, Version),
        close(In)).

pack_version(In, Version) :-
    repeat,
    read(In, Term),
    (   Term == end_of_file
    ->  !,
        fail
    ;   Term = version(Version)
    ),
    !.
