:- module(test_study_files,
          [ with_study/2,               % +Lines, :Goal
            with_study/3,               % +Lines, -Study, :Goal
            with_study_file/2,          % +Lines, :Goal
            with_study_file/4,          % +Lines, -Dir, -File, :Goal
            save_lines/3,               % +Dir, +Name, +Lines
            study_command/4,            % +Dir, +Arguments, -Status, -Text
            study_messages/2,           % :Goal, -Text
            pandas_python/1             % -Python
          ]).

/** <module> Studies for tests

*Threading*: the thread that loads studies.
*/

:- use_module(common).
:- use_module('../../experiments/engine/studies', [study_load/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).

:- meta_predicate
    with_study(+, 1),
    with_study(+, -, 0),
    with_study_file(+, 2),
    with_study_file(+, -, -, 0),
    study_messages(0, -).

%!  with_study(+Lines, :Goal) is semidet.
%!  with_study(+Lines, -Study, :Goal) is semidet.
%!  with_study_file(+Lines, :Goal) is semidet.
%!  with_study_file(+Lines, -Dir, -File, :Goal) is semidet.
%
%   Call Goal, or Goal(Study), or Goal(Dir, File), with a study that has Lines,
%   in a directory of its own.

with_study(Lines, Goal) :-
    with_study(Lines, Study, call(Goal, Study)).

with_study(Lines, Study, Goal) :-
    with_study_file(Lines, _, File, ( study_load(File, Study), Goal )).

with_study_file(Lines, Goal) :-
    with_study_file(Lines, Dir, File, call(Goal, Dir, File)).

with_study_file(Lines, Dir, File, Goal) :-
    with_tmp_dir(Dir,
                 ( save_lines(Dir, 'study.pl', Lines),
                   directory_file_path(Dir, 'study.pl', File),
                   Goal )).

%!  save_lines(+Dir, +Name, +Lines) is det.

save_lines(Dir, Name, Lines) :-
    directory_file_path(Dir, Name, File),
    atomic_list_concat(Lines, '\n', Text),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        format(Out, '~w~n', [Text]),
        close(Out)).

%!  study_command(+Dir, +Arguments, -Status, -Text) is det.
%
%   The exit status and the output of experiments/study.pl with Arguments in
%   Dir.
%
%   @error unexpected(Status, Text) if the status is another

study_command(Dir, Arguments, Status, Text) :-
    project_file('experiments/study.pl', Script),
    run_swipl([Script, --|Arguments], [cwd(Dir), timeout(120)],
              Ended, Out, Err),
    string_concat(Out, Err, Text),
    (   Ended = Status
    ->  true
    ;   throw(error(unexpected(Ended, Text), _))
    ).

%!  study_messages(:Goal, -Text) is semidet.
%
%   Text is what Goal prints on user_error.

study_messages(Goal, Text) :-
    with_tmp_dir(messages(Goal, Text)).

messages(Goal, Text, Dir) :-
    directory_file_path(Dir, messages, File),
    stream_property(Old, alias(user_error)),
    setup_call_cleanup(
        ( open(File, write, Out, [encoding(utf8)]),
          set_stream(Out, alias(user_error)) ),
        once(Goal),
        ( set_stream(Old, alias(user_error)),
          close(Out) )),
    read_file_to_string(File, Text, [encoding(utf8)]).

%!  pandas_python(-Python) is semidet.
%
%   Python is the interpreter that .ci/pandas has installed; fails if there is
%   none.

pandas_python(Python) :-
    missing([pandas], []),
    project_file('.ci/pandas', Script),
    process_create(Script, ['--where'], [stdout(pipe(Out))]),
    call_cleanup(read_line_to_string(Out, Directory), close(Out)),
    directory_file_path(Directory, 'bin/python', Python).
