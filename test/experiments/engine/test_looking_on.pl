:- module(test_looking_on, []).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module(library(plunit)).
:- use_module('../../../experiments/engine/follow').
:- use_module('../../../experiments/engine/progress').

/** <module> The progress of runs

*Threading*: one test at a time.
*/

:- begin_tests(progress).

test(sparse_lines_without_a_terminal,
     Text == "a\nc\nd\n") :-
    with_output_to(string(Text),
                   ( current_output(Out),
                     progress(Out, 0, a),
                     progress(Out, 0.05, b),
                     progress(Out, 0.15, c),
                     progress(Out, 1, d),
                     progress_done(Out) )).
test(growing_file, Lines == ["one", "two"]-["three"]) :-
    with_tmp_dir(growing(Lines)).
test(no_file_yet, Lines == []) :-
    new_lines('/nonexistent/file', 0, 0, Lines).

growing(Lines1-Lines2, Dir) :-
    atom_concat(Dir, '/log', File),
    append_text(File, 'one\ntwo\nthr'),
    new_lines(File, 0, Position, Lines1),
    append_text(File, 'ee\n'),
    new_lines(File, Position, _, Lines2).

append_text(File, Text) :-
    setup_call_cleanup(open(File, append, Out), write(Out, Text), close(Out)).

:- end_tests(progress).
