:- module(test_atoms_collected, []).

/** <module> Terms are read while atoms are collected

    swipl test/lib/atoms_collected.pl -- TIMES

Three threads read so many terms with atoms of their own, four times each, while
another collects atoms without a pause.  Prints `well`; if an atom is lost it
reports this, or the process crashes.

*Threading*: the main thread waits for the others.
*/

:- use_module('../../prolog/typhon/kernel/base/prolog_faults').
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(random), [random_between/3]).

:- initialization(main, main).

:- public main/1.

main([Text]) :-
    atom_number(Text, Times),
    findall(T, ( between(1, 3, _), thread_create(read_often(Times), T) ), Ts),
    thread_create(collect, _, [detached(true)]),
    forall(member(T, Ts), thread_join(T, true)),
    format('well~n').

collect :-
    repeat,
    garbage_collect_atoms,
    fail.

%   Earlier contents of the stack look like the head of a large term.

read_often(Times) :-
    thread_self(Me),
    forall(between(1, Times, I),
           ( fresh(Me, I, Term),
             fast_term_serialized(Term, Bytes),
             forall(between(1, 4, _), ( left_behind, whole(Bytes) )) )).

fresh(Me, I, t(A, Pairs, A)) :-
    term_to_atom(c(Me, I), A),
    findall(Atom-Text,
            ( between(1, 6000, J), term_to_atom(c(Me, I, J), Atom),
              xs(60, Text) ),
            Pairs).

left_behind :-
    findall(Text, ( between(1, 9000, _), xs(90, Text) ), Texts),
    ground(Texts).

xs(Most, Text) :-
    random_between(1, Most, Length),
    format(string(Text), "~`xt~*|", [Length]).

whole(Bytes) :-
    fast_bytes_term(Bytes, t(A, Pairs, A)),
    (   forall(member(Atom-_, [A-_|Pairs]),
               ( atom(Atom), sub_atom(Atom, 0, 1, _, c) ))
    ->  true
    ;   format('lost~n'),
        halt(1)
    ).
