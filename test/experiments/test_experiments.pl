:- use_module('../lib/common', [with_tmp_dir/1]).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../experiments/engine/follow').
:- use_module('../../experiments/lib/progress').
:- use_module('../../experiments/lib/report').

/** <module> What is told of an experiment: tables, claims, files
*/

:- begin_tests(reports).

test(sentence_held, S == 'All 2 claims held.') :-
    claims_sentence([claim(a, true, x), claim(b, true, x)], S).
test(sentence_not_held, S == '1 of 2 claims did not hold: b.') :-
    claims_sentence([claim(a, true, x), claim(b, false, x)], S).
test(table, Text == "  task  idle\n     1  0.50\n     2     -\n") :-
    with_output_to(string(Text),
                   ( current_output(Out),
                     print_table(Out, [task, idle], [[1, 0.5], [2, -]]) )).
test(csv, Text == "a,b\r\n1,\"x,y\"\r\n") :-
    with_tmp_dir(saved_csv(Text)).
test(facts, Terms == [a('B', "c"), d]) :-
    with_tmp_dir(saved_facts(Terms)).
test(sparse_lines_without_a_terminal,
     Text == "0/20 a\n3/20 c\n20/20 d\n") :-
    with_output_to(string(Text),
                   ( current_output(Out),
                     progress(Out, 0, 20, a),
                     progress(Out, 1, 20, b),
                     progress(Out, 3, 20, c),
                     progress(Out, 20, 20, d),
                     progress_done(Out) )).
test(growing_file, Lines == ["one", "two"]-["three"]) :-
    with_tmp_dir(growing(Lines)).
test(no_file_yet, Lines == []) :-
    new_lines('/nonexistent/file', 0, 0, Lines).

saved_csv(Text, Dir) :-
    atom_concat(Dir, '/t.csv', File),
    save_csv(File, [a, b], [[1, 'x,y']]),
    read_file_to_string(File, Text, []).

saved_facts(Terms, Dir) :-
    atom_concat(Dir, '/t.pl', File),
    save_facts(File, [a('B', "c"), d]),
    read_file_to_terms(File, Terms, []).

growing(Lines1-Lines2, Dir) :-
    atom_concat(Dir, '/log', File),
    append_text(File, 'one\ntwo\nthr'),
    new_lines(File, 0, Position, Lines1),
    append_text(File, 'ee\n'),
    new_lines(File, Position, _, Lines2).

append_text(File, Text) :-
    setup_call_cleanup(open(File, append, Out), write(Out, Text), close(Out)).

:- end_tests(reports).
