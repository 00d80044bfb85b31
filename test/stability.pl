:- module(test_stability, []).

/** <module> Runs all suites many times, and notes how they end

    swipl test/stability.pl -- [--runs N] [--busy N] [--pin CORE]
                               [--file FILE] [SUITE ...]

runs test/run.pl so often, beside so many processes that are always busy, and
on one processor only if CORE is given, and appends a line of each run to
FILE, by default stability.md in this folder. If a test failed the exit status
is 1, and out/failed.log has what that run printed.

*Threading*: the main thread only.
*/

:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(lib/common, [project_file/2, with_tmp_dir/1]).
:- use_module(lib/run_log, [suite_time/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [copy_file/2, directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, last/2, member/2, numlist/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- initialization(main, main).

:- public main/1.

opt_type(runs, runs, nonneg).
opt_type(busy, busy, nonneg).
opt_type(pin, pin, nonneg).
opt_type(file, file, atom).
opt_help(runs, 'how often (default 10)').
opt_help(busy, 'busy processes meanwhile (default 0)').
opt_help(pin, 'the only processor on which all run').
opt_help(file, 'to which the results are appended').

main(Argv) :-
    arguments(Argv, Names, Options),
    option(runs(Runs), Options, 10),
    findall(Status,
            ( between(1, Runs, _),
              with_tmp_dir(run(Names, Options, Status)) ),
            Statuses),
    (   member(Status, Statuses),
        Status \== exit(0)
    ->  halt(1)
    ;   true
    ).

run(Names, Options, Status, Dir) :-
    directory_file_path(Dir, log, Log),
    option(busy(Busy), Options, 0),
    setup_call_cleanup(
        busy_processes(Busy, Options, Pids),
        suites_run(Names, Options, Log, Status, Seconds),
        maplist(end_process, Pids)),
    read_file_to_string(Log, Text, []),
    kept_if_failed(Status, Log),
    result(Text, Status, Result),
    line(Options, Seconds, Result, Line),
    note(Options, Line).

%   out/failed.log has what the last run printed in which a test failed.

kept_if_failed(exit(0), _) :-
    !.
kept_if_failed(_, Log) :-
    project_file(out, Out),
    make_directory_path(Out),
    directory_file_path(Out, 'failed.log', Kept),
    copy_file(Log, Kept).

busy_processes(0, _, []) :-
    !.
busy_processes(Count, Options, Pids) :-
    numlist(1, Count, Numbers),
    maplist(busy_process(Options), Numbers, Pids).

busy_process(Options, _, Pid) :-
    pinned(Options, ['/bin/sh', '-c', 'while :; do :; done'], Command),
    start(Command, [], Pid).

end_process(Pid) :-
    process_kill(Pid, kill),
    process_wait(Pid, _).

suites_run(Names, Options, Log, Status, Seconds) :-
    current_prolog_flag(executable, Swipl),
    project_file('test/run.pl', Run),
    pinned(Options, [Swipl, Run, --|Names], Command),
    get_time(Start),
    setup_call_cleanup(
        open(Log, write, Out),
        ( start(Command, [stdout(stream(Out)), stderr(stream(Out))], Pid),
          process_wait(Pid, Status) ),
        close(Out)),
    get_time(End),
    Seconds is End-Start.

pinned(Options, Command, ['taskset', '-c', Core|Command]) :-
    option(pin(Core), Options),
    !.
pinned(_, Command, Command).

start([Program|Args], Options, Pid) :-
    (   is_absolute_file_name(Program)
    ->  Path = Program
    ;   Path = path(Program)
    ),
    process_create(Path, Args, [stdin(null), process(Pid)|Options]).

%   result(+Text, +Status, -Result): result(Processor, Passed, Failed, Names) of
%   what a run printed.

result(Text, Status, result(Processor, Passed, Failed, Names)) :-
    split_string(Text, "\n", "", Lines),
    aggregate_all(sum(P), ( member(Line, Lines),
                            suite_time(Line, time(_, P, _, _)) ), Processor),
    findall(Name, ( member(Line, Lines),
                    string_concat("failed ", Name, Line) ), Names0),
    (   findall(Line, sum_line(Lines, Line), Sums),
        last(Sums, sum(Passed, Failed))
    ->  Names = Names0
    ;   Passed = 0,
        Failed = 0,
        format(string(Name), "no result: ~w", [Status]),
        append(Names0, [Name], Names)
    ).

sum_line(Lines, sum(Passed, Failed)) :-
    member(Line, Lines),
    split_string(Line, " ", ",", [P, "passed", F, "failed"]),
    number_string(Passed, P),
    number_string(Failed, F).

%   A row of the table of stability.md.

line(Options, Seconds, result(Processor, Passed, Failed, Names), Line) :-
    get_time(Now),
    format_time(string(Date), '%F %R', Now),
    commit(Commit),
    current_prolog_flag(cpu_count, Cores),
    option(busy(Busy), Options, 0),
    ( option(pin(Core), Options) -> true ; Core = '-' ),
    atomic_list_concat(Names, '; ', Which),
    format(string(Line),
           "| ~s | ~w | ~d | ~d | ~w | ~0f | ~0f | ~d | ~d | ~w |",
           [Date, Commit, Cores, Busy, Core, Seconds, Processor, Passed,
            Failed, Which]).

%   A `+` is for changes that are not committed.

commit(Commit) :-
    project_file('.', Root),
    process_create(path(sh),
                   ['-c', 'git describe --always --match= --dirty=+ || echo -'],
                   [ cwd(Root), stdin(null), stdout(pipe(Out)), stderr(null),
                     process(Pid) ]),
    call_cleanup(read_string(Out, _, Text), close(Out)),
    process_wait(Pid, _),
    normalize_space(atom(Commit), Text).

note(Options, Line) :-
    project_file('test/stability.md', Default),
    option(file(File), Options, Default),
    setup_call_cleanup(
        open(File, append, Out, [encoding(utf8)]),
        format(Out, '~s~n', [Line]),
        close(Out)),
    format('~s~n', [Line]),
    flush_output.
