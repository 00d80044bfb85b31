:- module(test_dict_calls, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [declared_meta/3]).

/** <module> Dicts in programs of agents

*Threading*: one test at a time.
*/

%   found(+Text, -X): an agent whose clauses are in Text leaves got(X).

found(Text, X) :-
    setup_call_cleanup(open_string(Text, In), terms(In, Terms), close(In)),
    with_hosts([here],
               ( create(Terms, A),
                 joined(A, done),
                 remote(here, take(got(X0))),
                 X = X0 )).

terms(In, Terms) :-
    read_term(In, Term, [module(test_dict_calls)]),
    (   Term == end_of_file
    ->  Terms = []
    ;   Terms = [Term|Rest],
        terms(In, Rest)
    ).

:- begin_tests(dict_calls).

test(value_of_a_key, X == 7) :-
    found("main :- M = _{a:7}, X = M.a, leave(got(X)).", X).
test(values_in_values, X == 3) :-
    found("main :- M = _{a:_{b:3}}, leave(got(M.a.b)).", X).
test(value_in_each_branch, X == 2) :-
    found("main :- M = _{b:2}, ( get_dict(a, M, _) -> X = M.a ; X = M.b ),
                   leave(got(X)).", X).
test(value_for_each_solution, X == [1,2]) :-
    found("main :- findall(X, ( member(M, [_{a:1}, _{a:2}]), X = M.a ), L),
                   leave(got(L)).", X).
test(value_in_a_head, X == 5) :-
    found("main :- p(_{a:5}, X), leave(got(X)). p(M, M.a).", X).
test(functions_of_dicts, X == 9) :-
    found("main :- M = _{a:1}.put(a, 9), leave(got(M.a)).", X).
test(missing_key, X == missing(b)) :-
    found("main :- M = _{a:1},
                   catch(X = M.b, error(existence_error(key, K, _), _),
                         X = missing(K)),
                   leave(got(X)).", X).

test(goals_of_a_library_that_is_not_loaded_are_known,
     [ condition(\+ current_module(thread)),
       Metas-Loaded == [concurrent_forall(0, 0), concurrent_maplist(1, +)]-[] ]) :-
    findall(Meta,
            ( member(Head, [concurrent_forall(_, _), concurrent_maplist(_, _)]),
              declared_meta(typhon_vocabulary, Head, Meta) ),
            Metas),
    findall(x, current_module(thread), Loaded).

:- end_tests(dict_calls).
