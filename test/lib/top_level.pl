:- module(test_top_level_lib,
          [ typed/3,                    % +Lines, +Dir, -Written
            top_level_continues/0
          ]).

/** <module> Output of the top level for typed queries

*Threading*: any thread.
*/

:- use_module(common, [project_file/2, with_tmp_dir/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).

%!  typed(+Lines, +Dir, -Written:list(string)) is det.
%
%   Written is the output of a top level in Dir, that has loaded
%   library(typhon), for Lines, line by line and without empty ones.  The top
%   level ends with its input.

typed(Lines, Dir, Written) :-
    directory_file_path(Dir, typed, File),
    setup_call_cleanup(open(File, write, In),
                       forall(member(Line, Lines), format(In, '~w~n', [Line])),
                       close(In)),
    current_prolog_flag(executable, Swipl),
    project_file('prolog/typhon.pl', Typhon),
    setup_call_cleanup(
        process_create(path(sh),
                       [ '-c', 'exec "$0" -q -f none "$1" < "$2" 2>&1',
                         Swipl, Typhon, File ],
                       [cwd(Dir), stdout(pipe(Out)), process(Pid)]),
        read_string(Out, _, Text),
        ( close(Out), process_wait(Pid, _) )),
    split_string(Text, "\n", "\r", All),
    findall(Line, ( member(Line, All), Line \== "" ), Written).

%!  top_level_continues is semidet.
%
%   The top level continues after two errors of unrelated goals. SWI-Prolog
%   9.2.9 opens the debugger at the second.

top_level_continues :-
    with_tmp_dir(goes_on).

goes_on(Dir) :-
    typed(['atom_length(_, _).', 'atom_length(_, _).', 'nl, writeln(on).'],
          Dir, Written),
    memberchk("on", Written).
