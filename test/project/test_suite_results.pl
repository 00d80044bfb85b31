:- module(test_suite_results, []).
:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_terms/3]).

/** <module> What test/suite.pl says of a suite

*Threading*: the main thread.
*/

:- begin_tests(suite_results).

%   said(-Options, -Test, -Suite): of a unit u with Options and a Test.

said("", "test(a) :- true.", suite(1, [], [], [])).
said("", "test(a) :- fail.", suite(0, [u:a], [], [])).
said("", "test(a, [condition(fail)]) :- true.", suite(0, [], [u:a], [])).
said("", "test(a, [forall(fail)]) :- true.", suite(0, [], [u:a], [])).
said("", "test(a, [blocked(b)]) :- true.", suite(0, [], [u:a], [])).
said("", "test(a, [setup(fail)]) :- true.",
     suite(0, [], [], ['setup of u:a failed'])).
said("condition(fail)", "test(a) :- true.", suite(0, [], [u:a], [])).
said("setup(fail)", "test(a) :- true.",
     suite(0, [], [], ['setup of u:a failed'])).
said("setup(fail)", "test(a, [forall(member(_, [1]))]) :- true.",
     suite(0, [], [], ['setup of u:a failed'])).

test(results, [forall(said(Options, Test, Suite)), Said == [Suite]]) :-
    with_tmp_dir(results(Options, Test, Said)).

results(Options, Test, Said, Dir) :-
    directory_file_path(Dir, 'test_s.pl', File),
    directory_file_path(Dir, results, Results),
    format(string(Text), ":- module(s, []).~n\c
           :- use_module(library(plunit)).~n\c
           :- begin_tests(u, [~s]).~n~s~n:- end_tests(u).~n", [Options, Test]),
    write_file(File, Text),
    project_file('test/suite.pl', Runner),
    run_swipl([Runner, '--', File, Results], [], exit(0), _, _),
    read_file_to_terms(Results, Said, []).

:- end_tests(suite_results).
