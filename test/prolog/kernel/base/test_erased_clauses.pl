:- module(test_erased_clauses, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common', [project_file/2, run_swipl/5]).

% Each hop erases the clauses of a state. A process of its own, because what was
% loaded before leaves references to erased clauses.  Otherwise 80 to 110 times; by
% qemu some 45, as references remain that elsewhere vanish after the first.

:- begin_tests(erased_clauses).

test(hops_do_not_collect_atoms, true(Collections < 65)) :-
    does('host_start(a), host_start(b), \c
          agent_create(clauses([ (:- agent(x, [state([left/1])])), left(2000), \c
                                 (main :- left(0), !), \c
                                 (main :- retract(left(N)), M is N-1, \c
                                          assertz(left(M)), \c
                                          ( 1 is N mod 2 -> H = a ; H = b ), \c
                                          move(H), main) ]), A, [host(a)]), \c
          statistics(agc, N0), agent_join(A, done, 60), \c
          statistics(agc, N1), N is N1-N0, print(N)', Out),
    number_string(Collections, Out).
test(factor_of_the_program_is_kept, Out == "2.0") :-
    does('\'$cgc_params\'(S, _, C, S, 2.0, C), host_start(a), \c
          \'$cgc_params\'(S, F, C, S, F, C), print(F)', Out).

:- end_tests(erased_clauses).

does(Goal, Out) :-
    project_file('prolog/typhon.pl', Typhon),
    atom_concat(Goal, ', flush_output', Flushed),
    run_swipl(['-g', Flushed, '-t', halt, Typhon], [timeout(100)], Status, Out, _),
    assertion(Status == exit(0)).
