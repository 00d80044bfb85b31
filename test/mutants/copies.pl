:- module(test_copies,
          [ with_copy/1,                % :Goal
            write_in_copy/3,            % +Copy, +File, +Text
            suite_in_copy/5             % +Copy, +Suite, +Tests, +Limits, -Result
          ]).

/** <module> Copies of this project, of which single files are changed

Files are named from the directory of the project on: `prolog/typhon.pl`.

*Threading*: the main thread only, as for test/run.pl.
*/

:- use_module('../lib/common',
              [project_file/2, wait_until/2, with_tmp_dir/1]).
:- use_module('../lib/process_stat', [process_seconds/2]).
:- use_module('../lib/left_behind',
              [ kill_all_left_behind/0, kill_left_behind/2, suite_mark/2 ]).
:- use_module('../lib/suites', [of_studies/1, runs_plainly/1]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(process),
              [ process_create/3, process_kill/2, process_wait/2,
                process_wait/3
              ]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- meta_predicate with_copy(1), in_copy(1, +).

%!  with_copy(:Goal) is semidet.
%
%   Call Goal(Copy) once. The directory Copy is removed afterwards.

with_copy(Goal) :-
    with_tmp_dir(in_copy(Goal)).

in_copy(Goal, Copy) :-
    project_file('.', Root),
    directory_files(Root, Entries0),
    exclude(left_out, Entries0, Entries),
    findall(file(Path),
            ( member(Entry, Entries), directory_file_path(Root, Entry, Path) ),
            Paths),
    append(Paths, [file(Copy)], Args),
    process_create(path(cp), ['-a'|Args], [process(Pid)]),
    process_wait(Pid, exit(0)),
    call(Goal, Copy).

left_out('.').
left_out('..').
left_out('.git').
left_out(out).

%!  write_in_copy(+Copy, +File, +Text) is det.

write_in_copy(Copy, File, Text) :-
    directory_file_path(Copy, File, Path),
    setup_call_cleanup(
        open(Path, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)),
    forall(( program_start(Start), may_hold(Start, File) ),
           remove_program(Copy, Start)).

                /*******************************
                *            PROGRAMS          *
                *******************************/

%   The suites of a copy run by saved states, see test_quick_swipl, which are made
%   when a suite needs them, and removed when a file that they hold is written.

:- dynamic holds/2.                     % Start, File

program_start(quick_start).
program_start(quick_study).

may_hold(Start, File) :-
    (   holds(Start, _)
    ->  holds(Start, File)
    ;   true
    ).

program_path(Copy, Start, Path) :-
    atomic_list_concat([Copy, states, Start], /, Path).

remove_program(Copy, Start) :-
    program_path(Copy, Start, Path),
    catch(delete_file(Path), error(existence_error(_, _), _), true).

%   program(+Copy, +Suite, -Program) is semidet: fails if the files do not load
%   without warnings.

program(_, Suite, Swipl) :-
    runs_plainly(Suite),
    !,
    current_prolog_flag(executable, Swipl).
program(Copy, Suite, Program) :-
    ( of_studies(Suite) -> Start = quick_study ; Start = quick_start ),
    program_path(Copy, Start, Program),
    (   exists_file(Program)
    ->  true
    ;   make_program(Copy, Start, Program)
    ).

make_program(Copy, Start, Program) :-
    file_directory_name(Program, Dir),
    make_directory_path(Dir),
    atomic_list_concat([Copy, '/test/lib/', Start, '.pl'], File),
    succeeds(path(swipl),
             [ '-f', none, '-o', Program, '-c', File, '--class=development',
               '--stand-alone=true', '--autoload=false', '--on-error=status',
               '--on-warning=status' ]),
    (   holds(Start, _)
    ->  true
    ;   note_held(Copy, Start, Program)
    ).

succeeds(Program, Args) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(null),
                     process(Pid) ]),
    process_wait(Pid, exit(0)).

note_held(Copy, Start, Program) :-
    atom_concat(Copy, /, Root),
    setup_call_cleanup(
        process_create(Program,
                       [ '-g', 'forall(source_file(F), (writeq(F), writeln(.)))',
                         '-t', halt ],
                       [stdin(null), stdout(pipe(Out)), stderr(null)]),
        read_held(Out, Root, Start),
        close(Out)).

read_held(Out, Root, Start) :-
    repeat,
    read(Out, Path),
    (   Path == end_of_file
    ->  !
    ;   atom_concat(Root, File, Path),
        assertz(holds(Start, File)),
        fail
    ).

                /*******************************
                *             SUITES           *
                *******************************/

%!  suite_in_copy(+Copy, +Suite, +Tests, +Limits, -Result) is det.
%
%   Run the suite of the file Suite until a test fails: those of Tests, a list of
%   Unit:Name, or `all`. Limits is limits(Processor, Seconds): the processor time
%   of each process, and of the whole, which only ends suites that wait for ever.
%   Result is passed, killed(Test) for the first test that failed, or
%   killed(Reason): `loads`, `hangs`, `ends(Status)` or the problem of a suite.

%   The limit is a soft one: a hard one keeps cells from setting their own.

suite_in_copy(Copy, Suite, _, _, killed(loads)) :-
    \+ program(Copy, Suite, _),
    !.
suite_in_copy(Copy, Suite, Tests, limits(Processor, Seconds), Result) :-
    program(Copy, Suite, Program),
    directory_file_path(Copy, 'test/suite.pl', Runner),
    directory_file_path(Copy, Suite, File),
    directory_file_path(Copy, 'suite.results', Results),
    directory_file_path(Copy, 'suite.log', Log),
    catch(delete_file(Results), error(_, _), true),
    suite_mark(Suite, Mark),
    format(atom(Text), '~q', [Tests]),
    format(atom(Line),
           'ulimit -S -t ~d; exec "$0" --on-error=print --on-warning=print "$1" -- "${@:3}" > "$2" 2>&1',
           [Processor]),
    process_create(path(bash),
                   [ '-c', Line, Program, file(Runner), file(Log), file(File),
                     file(Results), Text ],
                   [ cwd(Copy), stdin(null), process(Pid),
                     environment(['TYPHON_SUITE'=Mark, 'TYPHON_QUICK'=Program])
                   ]),
    ended(Pid, Processor, Seconds, Status),
    results(Results, Suite1),
    left_behind(Suite1, Mark, Left),
    result(Status, Left, Suite1, Result).

%   Results of a process that did not end are those of a test that failed.

results(File, Results) :-
    exists_file(File),
    catch(read_file_to_terms(File, [Results], []), error(_, _), fail),
    !.
results(_, none).

left_behind(suite(_, [], _, []), Mark, Left) :-
    !,
    kill_left_behind(Mark, Left).
left_behind(_, _, []) :-
    kill_all_left_behind.

%   Prolog catches the signal of a limit of processor time, and may not come to
%   handle it.

ended(Pid, Processor, Seconds, Status) :-
    catch(wait_until(over(Pid, Processor, Status0), Seconds),
          error(timeout_error(wait_until, _), _),
          Status0 = timeout),
    (   Status0 == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _),
        Status = timeout
    ;   Status = Status0
    ).

over(Pid, _, Status) :-
    process_wait(Pid, Status, [timeout(0)]),
    Status \== timeout,
    !.
over(Pid, Processor, timeout) :-
    process_seconds(Pid, Seconds),
    Seconds > Processor+2.

result(_, Left, Suite, killed(Fault)) :-
    fault(Suite, Left, Fault),
    !.
result(exit(0), _, suite(_, _, _, _), passed) :-
    !.
result(timeout, _, _, killed(hangs)) :-
    !.
result(Status, _, _, killed(ends(Status))).

fault(suite(_, [Test|_], _, _), _, Test).
fault(suite(_, _, _, [Problem|_]), _, Problem).
fault(_, [Process|_], left(Process)).
