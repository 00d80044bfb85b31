:- module(test_app_journal, []).

% Journals on the command line, as from a shell.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

:- needs([journal]).

:- meta_predicate with_typhon(+, -, -, 0).

with_typhon(Args, Pid, Lines, Goal) :-
    project_file('app/typhon.pl', App),
    with_swipl([App|Args], Pid, _, Out,
               ( read_line_to_string(Out, One),
                 read_line_to_string(Out, Two),
                 Lines = [One, Two],
                 call(Goal) )).

typhon(Args, Status, Lines) :-
    project_file('app/typhon.pl', App),
    run_swipl([App|Args], [], Status, Out, _),
    split_string(Out, "\n", "\n", Lines).

has(Lines, Text) :-
    member(Line, Lines),
    sub_string(Line, _, _, _, Text),
    !.

:- begin_tests(app_journal).

test(killed_network_restarts_with_its_journal) :-
    with_tmp_dir(twice).

twice(Tmp) :-
    directory_file_path(Tmp, 'waits.pl', Program),
    write_file(Program, ':- agent(waits, []).~n\c
                         main :- receive(_-X), result(X).~n', []),
    directory_file_path(Tmp, journal, Dir),
    Args = [ network, 'ring(2)', '--processes', 2, '--journal', Dir,
             '--restart' ],
    with_typhon(Args, Pid, Hosts,
                ( Hosts = [_, Host],
                  typhon([create, Program, '--host', Host], exit(0), [Agent]),
                  process_kill(Pid, kill) )),
    with_typhon(Args, Again, Hosts,
                ( typhon([send, Agent, hello], exit(0), _),
                  typhon([join, Agent, '--timeout', 20], exit(0), ["done"]),
                  process_kill(Again, int),
                  wait_for_end(Again, 20, exit(0)) )),
    typhon([journal, Dir, '--check'], exit(0), Lines),
    forall(member(Text, [ "process1:", "process2:", "host n2", "1 outcome",
                          "all of it can be read" ]),
           has(Lines, Text)),
    typhon([network, 'ring(3)', '--journal', Dir], exit(1), [""]).

:- end_tests(app_journal).
