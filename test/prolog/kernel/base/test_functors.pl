:- module(test_functors, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common', [project_file/2, run_swipl/5]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(typhon/kernel/base/prolog_faults)).

/** <module> Functors that several threads make are the same for all

*Threading*: each thread makes functors of names of its own.
*/

:- dynamic made/2.                      % Name, Term: by one of the threads

make(Thread) :-
    forall(between(1, 3000, I),
           ( atomic_list_concat([functor_of, Thread, I], '_', Name),
             functor(Term, Name, 1),
             assertz(made(Name, Term)) )).

%   A lost functor exists twice.

lost(Name) :-
    made(Name, Term),
    functor(Again, Name, 1),
    Again \= Term.

:- begin_tests(functors,
               [cleanup(retractall(made(_, _)))]).

test(table_is_reserved_for_many_functors, true(Free >= 12000)) :-
    functors_room,
    statistics(functors, Count),
    next_power(Count, Power),
    Free is Power-Count.
test(second_reservation_adds_none, true(Count1-Count0 =< 1)) :-
    statistics(functors, Count0),
    functors_room,
    statistics(functors, Count1).
test(functor_table_is_reserved_when_the_library_loads,
     Status-Out == exit(0)-"free") :-
    project_file('prolog/typhon.pl', Typhon),
    run_swipl([ '-g', 'statistics(functors, N), N > 0x4001, write(free)',
                '-t', halt, Typhon ],
              [timeout(60)], Status, Out, _).
test(concurrent_threads_lose_no_functors, Lost == []) :-
    numlist(1, 4, Threads),
    maplist([I,T]>>thread_create(test_functors:make(I), T), Threads, Ids),
    maplist([T]>>thread_join(T, true), Ids),
    findall(Name, lost(Name), Lost).

next_power(Count, Power) :-
    Power is 1<<(msb(Count)+1).

:- end_tests(functors).
