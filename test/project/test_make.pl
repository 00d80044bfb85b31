:- module(test_make, []).

% The Makefile and the installer, with an apt-get that only records its calls.

:- use_module('../lib/common').
:- use_module(library(apply), [maplist/3]).
:- use_module('../lib/texts', [write_file/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [ chmod/2, copy_file/2, directory_file_path/3, link_file/3 ]).
:- use_module(library(lists), [last/2, member/2, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_stream_to_codes/2]).

run(Program, Args, Options, Status, Output) :-
    project_file('.', Root),
    setup_call_cleanup(
        process_create(Program, Args,
                       [ cwd(Root), stdin(null), stdout(pipe(Out)),
                         stderr(null), process(Pid)
                       | Options
                       ]),
        read_stream_to_codes(Out, Codes),
        close(Out)),
    process_wait(Pid, Status),
    string_codes(Output, Codes).

%   The installer on a machine where only Commands exist. Notes are the
%   recorded arguments of apt-get; its first Failures calls fail.

install_with(Commands, Failures, Status, Notes) :-
    install_with(Commands, [], Failures, Status, Notes).

install_with(Commands, Names, Failures, Status, Notes) :-
    with_tmp_dir(install_in(Commands, Names, Failures, Status, Notes)).

install_in(Commands, Names, Failures, Status, Notes, Dir) :-
    forall(( member(Command, [env, id, grep, wc, cat|Commands]) ),
           link_command(Dir, Command)),
    directory_file_path(Dir, notes, File),
    fake_apt(Dir, File, Failures),
    run('.ci/install', Names, [environment(['PATH'=Dir])], Status, _),
    (   exists_file(File)
    ->  read_file_to_string(File, Text, []),
        split_string(Text, "\n", "\n", Notes)
    ;   Notes = []
    ).

link_command(Dir, Command) :-
    directory_file_path(Dir, Command, Link),
    absolute_file_name(path(Command), File, [access(execute)]),
    link_file(File, Link, symbolic).

fake_apt(Dir, Notes, Failures) :-
    directory_file_path(Dir, 'apt-get', Apt),
    write_file(Apt, '#!/bin/sh~n\c
                     echo "$@" >> ~w~n\c
                     [ "$(wc -l < ~w)" -gt ~d ]~n', [Notes, Notes, Failures]),
    chmod(Apt, +x).

commands([swipl, make, git, gnuplot, dot, ip]).

has_serial :-
    catch(( process_create('/usr/bin/python3', ['-c', 'import serial'],
                           [stderr(null), process(Pid)]),
            process_wait(Pid, exit(0))
          ),
          error(_, _), fail).

root :-
    run(path(id), ['-u'], [], exit(0), "0\n").

:- begin_tests(make).

test(lists_targets, Status == exit(0)) :-
    run(path(make), [], [], Status, Output),
    split_string(Output, "\n", "\n", Lines),
    assertion(forall(member(Line, Lines),
                     sub_string(Line, 0, _, _, "  make "))),
    forall(member(Target, [demo, test, bench, check]),
           ( atom_concat('  make ', Target, Start),
             assertion(( member(Line, Lines),
                         sub_string(Line, 0, _, _, Start)
                       ))
           )).

test(install_does_nothing, Status-Output == exit(0)-"") :-
    run(path(make), [install], [], Status, Output).

test(check_reports_success,
     Status-Output == exit(0)-"check: no mistakes found\n") :-
    run(path(make), [check], [], Status, Output).

:- end_tests(make).

:- begin_tests(installer, [condition(( has_serial, root ))]).

test(no_program_is_missing, Status-Notes == exit(0)-[]) :-
    commands(Commands),
    install_with(Commands, 0, Status, Notes).

test(only_missing_programs_are_listed, Status == exit(0)) :-
    commands(Commands),
    subtract(Commands, [gnuplot, dot], Rest),
    install_with(Rest, 0, Status, [Note]),
    assertion(sub_string(Note, _, _, 0, " gnuplot-nox graphviz")).

test(program_selected_by_name, Status == exit(0)) :-
    commands(Commands),
    subtract(Commands, [gnuplot, dot], Rest),
    install_with(Rest, [graphviz], 0, Status, [Note]),
    assertion(sub_string(Note, _, _, 0, "recommends graphviz")).
test(unknown_name, Status-Notes == exit(2)-[]) :-
    install_with([], [core, 'no-such'], 0, Status, Notes).
test(dry_run_lists_installations, Output == "graphviz\n") :-
    with_tmp_dir(missing([graphviz, make], [make], Output)).
test(lists_all) :-
    run('.ci/install', ['--packages'], [], exit(0), Core),
    run('.ci/install', ['--packages', all], [], exit(0), All),
    assertion(string_concat("swi-prolog-nox ", _, Core)),
    split_string(Core, "", "\n", [Packages]),
    assertion(string_concat(Packages, _, All)).

test(contents_of_roots_are_listed, [ forall(contents_of_root(Names)),
                                     true(Status == exit(0)) ]) :-
    run('.ci/install', ['--packages'|Names], [], Status, _).

contents_of_root(Names) :-
    project_file('test/portability/run', File),
    read_file_to_string(File, Text, []),
    findall(Names0, words_after("contents=", Text, Names0), All),
    assertion(All = [_, _|_]),
    member(Names, All).

%   Of lines like `contents=core`, `contents="core gpio"`.

words_after(Start, Text, Words) :-
    split_string(Text, "\n", " ", Lines),
    member(Line, Lines),
    string_concat(Start, Value, Line),
    split_string(Value, "\" ", "\" ", Strings),
    findall(Word, ( member(String, Strings), String \== "",
                    atom_string(Word, String) ), Words).

missing(Names, Commands, Output, Dir) :-
    forall(member(Command, [env|Commands]), link_command(Dir, Command)),
    run('.ci/install', ['--missing'|Names], [environment(['PATH'=Dir])],
        exit(0), Output).

test(update_only_when_needed, Status == exit(0)) :-
    commands(Commands),
    subtract(Commands, [gnuplot], Rest),
    install_with(Rest, 1, Status, [First, Second, Third]),
    assertion(sub_string(First, _, _, 0, " gnuplot-nox")),
    assertion(sub_string(Second, 0, _, _, "update")),
    assertion(Third == First).

test(failed_installation, Status == exit(1)) :-
    commands(Commands),
    subtract(Commands, [gnuplot], Rest),
    install_with(Rest, 3, Status, _).

:- end_tests(installer).

%   ci(+Passes, +Notices, -Status, -Last, -Made): .ci/run, where make is a
%   program that notes what is Made, and whose targets `test` and `mutants` end
%   with these statuses. Last is the last line.

ci(Passes, Notices, Status, Last, Made) :-
    with_tmp_dir(ci(Passes, Notices, Status, Last, Made)).

ci(Passes, Notices, Status, Last, Made, Dir) :-
    forall(member(Name, ['.ci', bin]),
           ( directory_file_path(Dir, Name, New), make_directory(New) )),
    project_file('.ci/run', Run),
    maplist(directory_file_path(Dir),
            ['.ci/run', '.ci/install', 'bin/make', bin, made],
            [Copy, Install, Make, Bin, File]),
    copy_file(Run, Copy),
    shell_script(Install, "exit 0"),
    format(string(Line),
           "echo \"$@\" >> ~w\n\c
            case $1 in\n\c
            test) echo 3 passed, ~d failed; exit ~d ;;\n\c
            mutants) echo 1 of 2 killed; exit ~d ;;\n\c
            esac", [File, Passes, Passes, Notices]),
    shell_script(Make, Line),
    getenv('PATH', Path0),
    atomic_list_concat([Bin, Path0], :, Path),
    run(path(sh), [Copy], [environment(['PATH'=Path])], Status, Output),
    split_string(Output, "\n", "\n", Lines),
    last(Lines, Last),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "\n", Made).

:- begin_tests(continuous_integration).

test(promises_of_security_are_tried_after_the_tests,
     Status-Last == exit(0)-"3 passed, 0 failed") :-
    ci(0, 0, Status, Last, ["tools-all", "test", Mutants]),
    assertion(sub_string(Mutants, 0, _, _, "mutants PART=declared")).

test(promise_that_no_test_notices_is_a_failure,
     Status-Last == exit(1)-"3 passed, 0 failed") :-
    ci(0, 1, Status, Last, _).

test(failed_test_is_a_failure, Status-Last == exit(1)-"3 passed, 2 failed") :-
    ci(2, 0, Status, Last, ["tools-all", "test"]).

:- end_tests(continuous_integration).
