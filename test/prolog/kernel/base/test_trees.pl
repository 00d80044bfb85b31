:- module(test_trees, []).

:- use_module('../../../../prolog/typhon/kernel/base/error_text').
:- use_module(library(plunit)).

:- begin_tests(trees).

test(dict_is_a_tree) :-
    dict_pairs(Dict, tag, [key-f(x)]),
    is_tree(Dict, 10).

test(shared_subterms_are_counted_each_time, fail) :-
    shared(40, Term),
    is_tree(Term, 1 000 000).

test(cyclic_term_is_no_tree, fail) :-
    Term = f(Term),
    is_tree(Term, 10).

test(long_name_counts, fail) :-
    length(Codes, 1000),
    maplist(=(0'a), Codes),
    atom_codes(Name, Codes),
    compound_name_arguments(Term, Name, [x]),
    is_tree(Term, 50).

shared(0, x) :-
    !.
shared(N, f(Term, Term)) :-
    N1 is N-1,
    shared(N1, Term).

:- end_tests(trees).
