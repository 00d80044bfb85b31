:- module(test_copies,
          [ with_copy/1,                % :Goal
            write_in_copy/3,            % +Copy, +File, +Text
            suite_in_copy/4             % +Copy, +Suite, +Limits, -Result
          ]).

/** <module> Copies of this project, of which single files are changed

Files are named from the directory of the project on: `prolog/typhon.pl`.

*Threading*: the main thread only, as for test/run.pl.
*/

:- use_module('../lib/common',
              [project_file/2, wait_for_end/3, with_tmp_dir/1]).
:- use_module('../lib/left_behind', [kill_left_behind/2, suite_mark/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).

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
        close(Out)).

%!  suite_in_copy(+Copy, +Suite, +Limits, -Result) is det.
%
%   Run the suite of the file Suite. Limits is limits(Processor, Seconds): the
%   processor time of each process, and of the whole, which only ends suites
%   that wait for ever. Result is passed, killed(Test) for the first test that
%   failed, or killed(Reason): `hangs`, `ends(Status)` or the problem of a
%   suite.

%   The limit is a soft one: a hard one keeps cells from setting their own.

suite_in_copy(Copy, Suite, limits(Processor, Seconds), Result) :-
    directory_file_path(Copy, 'test/suite.pl', Runner),
    directory_file_path(Copy, Suite, File),
    directory_file_path(Copy, 'suite.results', Results),
    directory_file_path(Copy, 'suite.log', Log),
    catch(delete_file(Results), error(_, _), true),
    suite_mark(Suite, Mark),
    format(atom(Line),
           'ulimit -S -t ~d; exec swipl --on-error=print --on-warning=print "$0" -- "$1" "$2" > "$3" 2>&1',
           [Processor]),
    process_create(path(bash),
                   [ '-c', Line, file(Runner), file(File), file(Results),
                     file(Log) ],
                   [ cwd(Copy), stdin(null), process(Pid),
                     environment(['TYPHON_SUITE'=Mark])
                   ]),
    ended(Pid, Seconds, Status),
    kill_left_behind(Mark, Left),
    result(Status, Left, Results, Result).

ended(Pid, Seconds, Status) :-
    wait_for_end(Pid, Seconds, Status0),
    (   Status0 == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _),
        Status = timeout
    ;   Status = Status0
    ).

result(timeout, _, _, killed(hangs)) :-
    !.
result(exit(0), Left, File, Result) :-
    exists_file(File),
    !,
    setup_call_cleanup(open(File, read, In), read(In, Suite), close(In)),
    (   fault(Suite, Left, Fault)
    ->  Result = killed(Fault)
    ;   Result = passed
    ).
result(Status, _, _, killed(ends(Status))).

fault(suite(_, [Test|_], _, _), _, Test).
fault(suite(_, _, _, [Problem|_]), _, Problem).
fault(_, [Process|_], left(Process)).
