:- module(test_example_study, []).

% The study that doc/studies.md shows is the one in examples/studies, and
% gives what is shown there.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files', [pandas_python/1, study_command/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

block(Kind, Begin, Lines) :-
    project_file('doc/studies.md', File),
    read_file_to_string(File, Document, [encoding(utf8)]),
    atomic_list_concat(Parts, '```', Document),
    atom_concat(Kind, '\n', Start0),
    atom_concat(Start0, Begin, Start),
    member(Part, Parts),
    atom_concat(Start, More, Part),
    !,
    atomic_list_concat([_|Lines], '\n', More).

%   The text after the comment at the beginning.

file(Name, Text) :-
    project_file(Name, File),
    read_file_to_string(File, Text0, [encoding(utf8)]),
    once(sub_string(Text0, Before, _, _, "\n\n")),
    sub_string(Text0, Before, _, 0, Text).

:- begin_tests(example_study).

test(same_agent, Shown == Text) :-
    block(prolog, '% explorer.pl', Lines),
    atomic_list_concat([''|Lines], '\n', Atom),
    atom_string(Atom, Shown),
    file('examples/studies/explorer.pl', Text).
test(same_study, Shown == Text) :-
    block(prolog, '% coverage.pl', Lines),
    atomic_list_concat([''|Lines], '\n', Atom),
    atom_string(Atom, Shown),
    file('examples/studies/coverage.pl', Text).
test(prints_the_shown_output) :-
    block(text, '$ swipl', Lines),
    made(_, Output),
    forall(member(Line, Lines),
           assertion(once(sub_string(Output, _, _, _, Line)))).
test(notebook_prints_the_shown_output,
     [condition(pandas_python(_)), true(Printed == Shown)]) :-
    block(python, '# look.py', Lines),
    atomic_list_concat(Lines, '\n', Script),
    made(Dir, _),
    pandas_python(Python),
    setup_call_cleanup(
        process_create(Python, ['-c', Script],
                       [ cwd(Dir), stdout(pipe(Out)), process(Pid) ]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, exit(0)),
    split_string(Text, "", "\n", [Printed]),
    block(text, 'strategy', Below),
    atomic_list_concat(['strategy  conscientious      random'|Below], '\n',
                       Table),
    split_string(Table, "", "\n", [Shown]).

:- end_tests(example_study).

%   The study runs once for all tests.

:- dynamic there/2.

made(Dir, Output) :-
    there(Dir, Output),
    !.
made(Dir, Output) :-
    make_tmp_dir(Dir),
    at_halt(delete_directory_and_contents(Dir)),
    project_file('examples/studies/coverage.pl', Study),
    study_command(Dir, [Study, '--runs', 10, '--out', out], exit(0), Output),
    assertz(there(Dir, Output)).

