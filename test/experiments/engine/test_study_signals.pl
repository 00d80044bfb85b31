:- module(test_study_signals, []).

% A signal to any thread ends a study in order.

:- use_module('../../lib/common',
              [project_file/2, wait_for_end/3, with_swipl/5, with_tmp_dir/1]).
:- use_module('../../lib/study_files', [save_lines/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [max_list/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).

%   The program reports that its threads exist, waits, and reports its end.

program([ ':- initialization(main, main).',
          'main :- stopping_on_signals(begin).',
          'begin :- thread_create(other, _), thread_get_message(other),',
          '    format("begun.~n"), flush_output,',
          '    call_cleanup(thread_get_message(never),',
          '                 format("left.~n")).',
          'other :- thread_send_message(main, other),',
          '    thread_get_message(never).'
        ]).

%   signalled(+Which, +Signal, -Status, -Said)

signalled(Which, Signal, Status, Said, Dir) :-
    project_file('experiments/engine/signals.pl', File),
    program(Lines),
    format(atom(Use), ':- use_module(\'~w\').', [File]),
    save_lines(Dir, 'program.pl', [Use|Lines]),
    directory_file_path(Dir, 'program.pl', Program),
    with_swipl([Program], Pid, _, Out,
               ( read(Out, begun),
                 thread_of(Which, Pid, Thread),
                 send(Pid, Thread, Signal),
                 wait_for_end(Pid, 30, Status),
                 said(Status, Out, Said) )).

said(timeout, _, Said) =>
    Said = nothing.
said(_, Out, Said) =>
    read(Out, Said).

%   Not by thread_property/2, which returns 0 in 9.2.9. The last thread is that
%   of the program; the other one collects garbage, and blocks signals.

thread_of(main, Pid, Pid).
thread_of(other, Pid, Thread) :-
    format(atom(Tasks), '/proc/~d/task', [Pid]),
    directory_files(Tasks, Entries),
    findall(Task,
            ( member(Entry, Entries), atom_number(Entry, Task), Task \== Pid ),
            Threads),
    max_list(Threads, Thread).

%   The system may deliver a signal to any thread.

send(Pid, Thread, Signal) :-
    process_create('/usr/bin/python3',
                   [ '-c', 'import ctypes, sys; \c
                      ctypes.CDLL(None).tgkill(*map(int, sys.argv[1:]))',
                     Pid, Thread, Signal ], []).

:- begin_tests(study_signals).

test(signal_to_the_main_thread, Status-Said == exit(143)-left) :-
    with_tmp_dir(signalled(main, 15, Status, Said)).
test(signal_to_another_thread, Status-Said == exit(143)-left) :-
    with_tmp_dir(signalled(other, 15, Status, Said)).
test(terminal_hangs_up, Status-Said == exit(129)-left) :-
    with_tmp_dir(signalled(other, 1, Status, Said)).

:- end_tests(study_signals).
