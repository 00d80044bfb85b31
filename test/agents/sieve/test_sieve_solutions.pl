:- module(test_sieve_solutions, []).

/** <module> Settings of printers as antibodies: payloads(sieve/solutions)
*/

:- use_module('../../lib/common').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/prng)).
:- use_module(library(typhon/kernel/program), [payload_load/2]).

%   The clauses of the payload in a module of their own, as in an agent.

:- dynamic
    solutions:setting/2,
    solutions:here/1.

:- initialization(( payload_load(payloads('sieve/solutions'),
                                 payload(_, PIs, Clauses)),
                    forall(member(PI, PIs), dynamic(solutions:PI)),
                    forall(member(C, Clauses), assertz(solutions:C)) )).

%   on(+Printer, +Settings, -Xi): with printers as alike as they can be.

on(Printer, Settings, Xi) :-
    retractall(solutions:here(_)),
    retractall(solutions:setting(_, _)),
    atom_concat(Printer, '@x:1', Host),
    assertz(solutions:here(Host)),
    assertz(solutions:setting(difference, 0)),
    solutions:feedback(print, found(climb, Settings), Xi).

:- begin_tests(sieve_solutions).

test(better_pages_have_more_feedback) :-
    on(n1, [3,photo,glossy,6,5,1], Good),
    on(n1, [3,photo,glossy,6,7,1], Worse),
    on(n1, [1,draft,thin,9,9,5], Bad),
    assertion(Good =< 31),
    assertion(Good > Worse),
    assertion(Worse > Bad),
    assertion(Bad =:= 0).
test(each_printer_judges_by_itself, true(Count > 1)) :-
    findall(Xi, ( member(P, [n1, n2, n3]),
                  on(P, [3,photo,glossy,6,5,1], Xi) ), Xis),
    sort(Xis, Distinct),
    length(Distinct, Count).
test(candidates_are_drawn, Distinct == [found(a, [1]), found(b, [2])]) :-
    retractall(solutions:setting(_, _)),
    assertz(solutions:setting(candidates, [found(a, [1]), found(b, [2])])),
    findall(Found,
            ( between(1, 20, Seed), chance_seed(Seed, Chance),
              solutions:random_antibody(Chance, Found, _) ),
            All),
    sort(All, Distinct).

:- end_tests(sieve_solutions).
