:- use_module('../../lib/common', [run_swipl/5, with_tmp_dir/1, project_file/2]).
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).

/** <module> The experiment with populations, small

By its own command line: two runs, each in a process of its own, on six
hosts with a fast clock and low demands.
*/

run(More, Status, Out, Err) :-
    project_file('experiments/population.pl', Script),
    append([Script, '--'], More, Arguments),
    run_swipl(Arguments, [timeout(60)], Status, Out, Err).

file(Dir, Pattern, File) :-
    atomic_list_concat([Dir, /, Pattern], Wild),
    expand_file_name(Wild, [File]),
    exists_file(File).

two_runs(Dir) :-
    run([ '--figure', '6.4', '--nodes', '6', '--runs', '2', '--jobs', '2',
          '--seed', '4', '--degree', '4', '--tasks', '4', '--clock', '25',
          '--threshold', '20', '--tick', '0.5', '--task_time', '0.5',
          '--hop_time', '0.1-0.2', '--crash', '2', '--out', Dir
        ], Status, Out, Err),
    (   Status == exit(0)
    ->  true
    ;   throw(error(population_failed(Status, Err), _))
    ),
    sub_string(Out, _, _, _, "6 hosts: every host executes all tasks: 2 of 2"),
    sub_string(Out, _, _, _, "all that lost T2 execute it again"),
    forall(member(Name, [ 'metadata.pl', 'runs.csv', 'tasks.csv',
                          'figure-6.4-6.gnuplot',
                          'figure-6.4-6-seed4*/events.pl',
                          'figure-6.4-6-seed5*/population.csv' ]),
           ( file(Dir, Name, File), size_file(File, Size), Size > 0 )),
    check_result(Dir),
    check_metadata(Dir).

check_result(Dir) :-
    file(Dir, 'figure-6.4-6-seed5*/result.pl', File),
    read_file_to_terms(File, Facts, []),
    memberchk(result(Result), Facts),
    memberchk(settled(true), Result),
    memberchk(executions(Executions), Result),
    length(Executions, 24),
    memberchk(failures(Failures), Result),
    length(Failures, 2),
    memberchk(again(Again), Result),
    length(Again, 2),
    memberchk(parameter(seed, 5), Facts).

check_metadata(Dir) :-
    file(Dir, 'metadata.pl', File),
    read_file_to_terms(File, Facts, []),
    aggregate_all(count, member(claim(_, _, _), Facts), 13),
    memberchk(parameter(nodes, '6'), Facts).

refused(Arguments, Name) :-
    run(Arguments, exit(1), _, Err),
    sub_string(Err, _, _, _, Name),
    !.

:- begin_tests(population_run).

test(two_runs) :-
    with_tmp_dir(two_runs).
test(wrong_parameters,
     [ forall(member(Arguments-Name,
                     [ ['--nodes', 'many']-"nodes",
                       ['--figure', '6.2']-"figure",
                       ['--hop_time', '2-1']-"hop_time" ])) ]) :-
    refused(Arguments, Name).

:- end_tests(population_run).
