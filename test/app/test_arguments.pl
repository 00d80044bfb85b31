:- module(test_arguments, []).

% Files among the arguments of programs, without -- before them.

:- use_module('../lib/common').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).

:- begin_tests(arguments).

program_of_files('experiments/study.pl', ['--runs', '1']).
program_of_files('doc/course/check.pl', []).

test(files_without_dashes_are_an_error, forall(program_of_files(Rel, More))) :-
    with_tmp_dir(without_dashes(Rel, More)).

without_dashes(Relative, More, Dir) :-
    project_file(Relative, Script),
    directory_file_path(Dir, 'round.pl', File),
    setup_call_cleanup(open(File, write, Out),
                       write(Out, ':- true.\n'),
                       close(Out)),
    run_swipl([Script, File|More], [timeout(60)], Status, Text, Err),
    assertion(Status-Text == exit(1)-""),
    atomic_list_concat([Script, --, File|More], ' ', Command),
    assertion(sub_string(Err, _, _, _, Command)).

test(files_after_dashes_are_arguments) :-
    with_tmp_dir(after_dashes).

after_dashes(Dir) :-
    project_file('doc/course/check.pl', Script),
    directory_file_path(Dir, 'missing.pl', File),
    run_swipl([Script, --, File], [timeout(60)], _, _, Err),
    assertion(\+ sub_string(Err, _, _, _, "Arguments follow")).

:- end_tests(arguments).
