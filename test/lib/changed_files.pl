:- module(test_changed_files,
          [ changed_files/1,            % -Files
            changed_files/2             % +Dir, -Files
          ]).

/** <module> The files that were changed

*Threading*: any thread.
*/

:- use_module(common, [project_file/2]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).

%!  changed_files(-Files:list) is det.
%!  changed_files(+Dir, -Files:list) is det.
%
%   The files of the project, or of another tree Dir, that differ from what the
%   main branch was where this branch began, or are uncommitted; on the main
%   branch, without uncommitted files, those of the last commit. Without git:
%   the files that are newer than out/passed.pl, which a successful run of all
%   suites leaves; none if there was none.

changed_files(Files) :-
    project_file('.', Root),
    changed_files(Root, Files).

changed_files(Dir, Files) :-
    begin_of_branch(Dir, Begin),
    !,
    since(Dir, Begin, Files0),
    (   Files0 == [],
        since(Dir, 'HEAD~1', Files1)
    ->  Files = Files1
    ;   Files = Files0
    ).
changed_files(Dir, Files) :-
    directory_file_path(Dir, 'out/passed.pl', Passed),
    (   exists_file(Passed)
    ->  time_file(Passed, Time),
        findall(File, newer(Dir, Time, File), Files0),
        sort(Files0, Files)
    ;   Files = []
    ).

%   Dir may be in the working tree of another project.

begin_of_branch(Dir, Begin) :-
    git(Dir, ['rev-parse', '--show-prefix'], []),
    member(Main, ['origin/main', main, 'origin/master', master]),
    git(Dir, ['merge-base', 'HEAD', Main], [Begin]),
    !.

since(Dir, Commit, Files) :-
    git(Dir, [diff, '--name-only', Commit], Differ),
    git(Dir, ['ls-files', '--others', '--exclude-standard'], New),
    append(Differ, New, Files0),
    sort(Files0, Files).

%   git(+Dir, +Args, -Lines:list(atom)) is semidet: git succeeds.

git(Dir, Args, Lines) :-
    append(['-C', Dir, '-c', 'core.quotePath=false'], Args, All),
    catch(git_output(All, Text), error(_, _), fail),
    split_string(Text, "\n", "\n", Parts),
    subtract(Parts, [""], Strings),
    findall(Line, ( member(String, Strings), atom_string(Line, String) ),
            Lines).

git_output(Args, Text) :-
    setup_call_cleanup(
        process_create(path(git), Args,
                       [ stdin(null), stdout(pipe(Out)), stderr(null),
                         process(Pid) ]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, exit(0)).

newer(Dir, Time, File) :-
    directory_files(Dir, Entries),
    member(Entry, Entries),
    \+ memberchk(Entry, [., .., '.git', out]),
    directory_file_path(Dir, Entry, Top),
    (   exists_directory(Top)
    ->  directory_member(Top, Path, [recursive(true)]),
        \+ exists_directory(Path)
    ;   Path = Top
    ),
    time_file(Path, Changed),
    Changed > Time,
    directory_file_path(Dir, File, Path).
