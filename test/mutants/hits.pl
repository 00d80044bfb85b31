:- module(test_hits, []).

/** <module> Notes which predicates a process executes

Loaded by the files of a copy of this project in which each rule of predicate
N calls `system:'$hit'(N)` first.  N is written to the file of the suite, see
suite_mark/2, when the process first executes it: also processes that are
killed have then noted what they did.

*Threading*: any thread.
*/

:- dynamic seen/1.
:- volatile seen/1.

system:'$hit'(Number) :-
    test_hits:seen(Number),
    !.
system:'$hit'(Number) :-
    test_hits:note(Number).

note(Number) :-
    assertz(seen(Number)),
    getenv('TYPHON_HITS', Dir),
    getenv('TYPHON_SUITE', Mark),
    !,
    atomic_list_concat([_, Suite], ':', Mark),
    atomic_list_concat([Dir, /, Suite], File),
    format(string(Line), '~d.~n', [Number]),
    catch(setup_call_cleanup(
              open(File, append, Out),
              write(Out, Line),
              close(Out)),
          error(_, _), true).           % within a cell
note(_).
