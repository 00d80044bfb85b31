:- module(test_suite, []).

/** <module> Runs one test suite

    swipl test/suite.pl -- test/test_x.pl results

loads the suite, runs it and writes its results to the file `results` as one
term `suite(Passed, Failed, Skipped, Problems)`: a number, the lists of failed
and of skipped tests as Unit:Name, and atoms for other problems. Started by
test/run.pl, one process for each suite.

plunit keeps its results in dynamic predicates whose first three arguments
are unit, test and line in SWI-Prolog 9.0 and 9.2 alike.  A test without a
result was skipped by its condition; if it has none, its setup failed.
*/

:- use_module('lib/common', [missing/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(plunit),
              [ run_tests/0, current_test/5, current_test_unit/2,
                set_test_options/1
              ]).

:- initialization(main, main).

:- public main/1.

%   Suites, and the files that they read, are UTF-8 in any locale, as on newer
%   versions.

main([File, Results]) :-
    set_prolog_flag(encoding, utf8),
    run_suite(File, Suite),
    setup_call_cleanup(
        open(Results, write, Out),
        format(Out, '~q.~n', [Suite]),
        close(Out)),
    halt.

run_suite(File, Suite) :-
    load_suite(File, LoadProblems),
    missing(Packages),
    (   LoadProblems \== []
    ->  Suite = suite(0, [], [], LoadProblems)
    ;   Packages \== []
    ->  atomic_list_concat(['all tests, without'|Packages], ' ', Skipped),
        Suite = suite(0, [], [Skipped], [])
    ;   run_units,
        suite_results(Suite)
    ).

load_suite(File, Problems) :-
    load_files(user:File, []),
    findall(Problem, load_problem(Problem), Problems).

load_problem('errors while loading') :-
    statistics(errors, Errors),
    Errors > 0.
load_problem('warnings while loading') :-
    statistics(warnings, Warnings),
    Warnings > 0.
load_problem('no tests') :-
    \+ current_test(_, _, _, _, _).

%   The results show whether all tests passed; SWI-Prolog 9.2 would otherwise
%   remove them.

run_units :-
    set_test_options([cleanup(false), run(manual)]),
    not_captured,
    (   run_tests
    ->  true
    ;   true
    ).

%   The output of tests is not captured, as in plunit of 10: threads that are
%   created meanwhile would keep the capturing stream, and outlive it.

not_captured :-
    catch(set_test_options([output(always)]),
          error(domain_error(_, _), _), true).

                /*******************************
                *            RESULTS           *
                *******************************/

suite_results(suite(Passed, Failed, Skipped, Problems)) :-
    aggregate_all(count, result(passed, _, _, _), Passed),
    findall(Unit:Name, failed(Unit, Name), Failed),
    findall(Unit:Name, skipped(Unit, Name), Skipped),
    findall(Problem, not_run(Problem), Problems).

failed(Unit, Name) :-
    member(Kind, [failed, timeout, sto]),
    result(Kind, Unit, Name, _).

result(Kind, Unit, Name, Line) :-
    current_predicate(plunit:Kind/Arity),
    Arity >= 3,
    functor(Head, Kind, Arity),
    predicate_property(plunit:Head, dynamic),
    arg(1, Head, Unit),
    arg(2, Head, Name),
    arg(3, Head, Line),
    call(plunit:Head).

without_result(Unit, Name, Options) :-
    current_test(Unit, Name, Line, _, Options),
    \+ ( member(Kind, [passed, failed, timeout, sto]),
         result(Kind, Unit, _, Line)
       ).

skipped(Unit, Name) :-
    without_result(Unit, Name, Options),
    may_skip(Unit, Options).

not_run(Problem) :-
    without_result(Unit, Name, Options),
    \+ may_skip(Unit, Options),
    format(atom(Problem), 'setup of ~q failed', [Unit:Name]).

may_skip(Unit, TestOptions) :-
    current_test_unit(Unit, UnitOptions),
    member(Options, [TestOptions, UnitOptions]),
    member(Option, Options),
    skips(Option, Unit),
    !.

%   If the condition is true the setup has failed.

skips(blocked(_), _).
skips(fixme(_), _).
skips(forall(Cases), Unit) :-
    fails(Cases, Unit).
skips(condition(Goal), Unit) :-
    fails(Goal, Unit).

fails(Goal, Unit) :-
    atom_concat(plunit_, Unit, Module),
    \+ catch(Module:Goal, error(_, _), fail).
