:- module(test_arguments, []).

% Files among the arguments of programs, without -- before them.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil)).

:- begin_tests(arguments).

program_of_files('experiments/study.pl', ['--runs', '1']).
program_of_files(Program, []) :-
    program(Program).

program('app/demo_page.pl').
program('app/typhon.pl').
program('bench/profile.pl').
program('bench/run.pl').
program('doc/course/check.pl').
program('doc/layers.pl').
program('doc/pictures.pl').
program('doc/site.pl').
program('examples/applications/fire.pl').
program('examples/applications/irrigation.pl').
program('examples/applications/solar.pl').
program('examples/applications/warehouse.pl').
program('experiments/counts.pl').
program('test/chaos/fuzz.pl').
program('test/chaos/hostile.pl').
program('test/chaos/lasting/run.pl').
program('test/chaos/run.pl').
program('test/chaos/scripted.pl').
program('test/run.pl').

%   Parsing arguments in any other way would bypass the check.

test(only_one_module_parses_arguments, Others == []) :-
    findall(File,
            ( member(Folder, [app, bench, doc, examples, experiments]),
              project_file(Folder, Dir),
              directory_member(Dir, File, [extensions([pl]), recursive(true)]),
              \+ ( member(Own, ['app/typhon.pl', 'app/typhon/arguments.pl']),
                   sub_atom(File, _, _, 0, Own) ),
              read_file_to_string(File, Text, []),
              sub_string(Text, _, _, _, "    argv_options(") ),
            Others).

test(files_without_dashes_are_an_error, forall(program_of_files(Rel, More))) :-
    with_tmp_dir(Dir,
        ( project_file(Rel, Script),
          directory_file_path(Dir, 'round.pl', File),
          write_file(File, ':- true.\n'),
          run_swipl([Script, File|More], [timeout(60)], Status, Text, Err),
          assertion(Status-Text == exit(1)-""),
          atomic_list_concat([Script, --, File|More], ' ', Command),
          assertion(sub_string(Err, _, _, _, Command)) )).
test(words_that_a_program_does_not_take_are_an_error) :-
    project_file('bench/profile.pl', Script),
    run_swipl([Script, --, nonsense], [timeout(60)], Status, Text, Err),
    assertion(Status-Text == exit(1)-""),
    assertion(sub_string(Err, _, _, _, "profile.pl does not take")).

test(files_after_dashes_are_arguments) :-
    with_tmp_dir(Dir,
        ( project_file('doc/course/check.pl', Script),
          directory_file_path(Dir, 'missing.pl', File),
          run_swipl([Script, --, File], [timeout(60)], _, _, Err),
          assertion(\+ sub_string(Err, _, _, _, "Arguments follow")) )).

:- end_tests(arguments).
