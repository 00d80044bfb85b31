:- module(test_left_behind,
          [ suite_mark/2,               % +Name, -Mark
            kill_left_behind/2,         % +Mark, -Names
            kill_all_left_behind/0
          ]).

/** <module> Processes that suites leave behind

They are known by the environment variable TYPHON_SUITE, which they inherit.

*Threading*: any thread.
*/

:- use_module(common, [wait_until/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

%!  suite_mark(+Name, -Mark) is det.
%
%   Mark is what TYPHON_SUITE is in the processes of the suite Name.

suite_mark(Name, Mark) :-
    current_prolog_flag(pid, Me),
    format(atom(Mark), '~d:~w', [Me, Name]).

%!  kill_left_behind(+Mark, -Names) is det.
%!  kill_all_left_behind is det.
%
%   Kill the processes of one suite, or of all suites of this process.
%   Processes that are about to end have half a minute; kill_all_left_behind/0
%   does not wait.

kill_left_behind(Mark, Names) :-
    catch(( wait_until(marked_processes(Mark, []), 30),
            Pids = []
          ),
          error(timeout_error(wait_until, _), _),
          marked_processes(Mark, Pids)),
    maplist(process_name, Pids, Names),
    maplist(kill_process, Pids).

kill_all_left_behind :-
    suite_mark('', Mark),
    marked_processes(Mark, Pids),
    (   Pids == []
    ->  true
    ;   maplist(kill_process, Pids),
        kill_all_left_behind            % those that were just being started
    ).

marked_processes(Mark, Pids) :-
    exists_directory('/proc/self'),
    !,
    atom_concat('TYPHON_SUITE=', Mark, Setting),
    directory_files('/proc', Entries),
    findall(Pid,
            ( member(Entry, Entries),
              atom_number(Entry, Pid),
              process_file(Pid, environ, Text),
              sub_string(Text, _, _, _, Setting)
            ),
            Pids).
marked_processes(_, []).

process_name(Pid, Name) :-
    process_file(Pid, cmdline, Text),
    !,
    split_string(Text, "\000", "\000", Words),
    atomic_list_concat(Words, ' ', Line),
    format(atom(Name), '~d (~w)', [Pid, Line]).
process_name(Pid, Pid).

process_file(Pid, Name, Text) :-
    format(atom(File), '/proc/~d/~w', [Pid, Name]),
    catch(read_file_to_string(File, Text, [encoding(octet)]),
          error(_, _),                  % not ours, or gone by now
          fail).

kill_process(Pid) :-
    catch(process_kill(Pid, kill),
          error(existence_error(process, _), _),
          true).
