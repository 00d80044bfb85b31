:- module(test_single, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/single_life').
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).

/** <module> The kernel in a Prolog that was started without threads

*Threading*: the main thread.
*/

:- begin_tests(single).

test(agents_run, Unexpected = unexpected([], [came(virtual_program, _)])) :-
    life_file(File),
    without_threads(main, [File], Status, Out, _),
    assertion(Status == exit(0)),
    life_differences(Out, Unexpected).

:- end_tests(single).

without_threads(Goal, Files, Status, Out, Err) :-
    project_file(prolog, Prolog),
    atom_concat('library=', Prolog, Library),
    format(atom(Text), '~q', [Goal]),
    append(['--no-threads', '-p', Library, '-g', Text, '-t', halt], Files,
           Args),
    run_swipl(Args, [], Status, Out, Err).
