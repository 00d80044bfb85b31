:- module(test_suite, []).

/** <module> Runs one test suite

    swipl test/suite.pl -- test/test_x.pl results [tests]

loads the suite, runs it and writes its results to the file `results` as one
term `suite(Passed, Failed, Skipped, Problems)`: a number, the lists of failed
and of skipped tests as Unit:Name, and atoms for other problems. Started by
test/run.pl, one process for each suite. With `tests`, a list of Unit:Name or
`all`, only those run, until one of them fails.

plunit keeps its results in dynamic predicates whose first three arguments
are unit, test and line in SWI-Prolog 9.0 and 9.2 alike.  A test without a
result was skipped by its condition; if it has none, its setup failed.
*/

:- use_module('lib/common', [missing/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(plunit),
              [ run_tests/0, run_tests/1, current_test/5, current_test_unit/2,
                set_test_options/1
              ]).

:- initialization(main, main).

:- public main/1.

%   Suites, and the files that they read, are UTF-8 in any locale, as on newer
%   versions.

main([File, Results]) :-
    run(File, Results, each).
main([File, Results, Text]) :-
    term_to_atom(Tests, Text),
    assertz(first_failure_to(Results)),
    run(File, Results, Tests).

run(File, Results, Tests) :-
    set_prolog_flag(encoding, utf8),
    run_suite(File, Tests, Suite),
    write_results(Results, Suite),
    halt.

write_results(Results, Suite) :-
    setup_call_cleanup(
        open(Results, write, Out),
        format(Out, '~q.~n', [Suite]),
        close(Out)).

%   The first failure ends the process.

:- dynamic first_failure_to/1.

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(plunit(failed(Unit, Name, _, _)), error, Lines) :-
    first_failure_to(Results),
    print_message_lines(user_error, kind(error), Lines),
    write_results(Results, suite(0, [Unit:Name], [], [])),
    halt.

run_suite(File, Tests, Suite) :-
    load_suite(File, LoadProblems),
    missing(Packages),
    (   LoadProblems \== []
    ->  Suite = suite(0, [], [], LoadProblems)
    ;   Packages \== []
    ->  atomic_list_concat(['all tests, without'|Packages], ' ', Skipped),
        Suite = suite(0, [], [Skipped], [])
    ;   run_units(Tests),
        suite_results(Tests, Suite)
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

run_units(Tests) :-
    set_test_options([cleanup(false), run(manual)]),
    not_captured,
    (   run_chosen(Tests)
    ->  true
    ;   true
    ).

run_chosen(Tests) :-
    is_list(Tests),
    !,
    findall(Unit-Name, member(Unit:Name, Tests), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Unit:Names, member(Unit-Names, Groups), Chosen),
    run_tests(Chosen).
run_chosen(_) :-
    run_tests.

%   The output of tests is not captured, as in plunit of 10: threads that are
%   created meanwhile would keep the capturing stream, and outlive it.

not_captured :-
    catch(set_test_options([output(always)]),
          error(domain_error(_, _), _), true).

                /*******************************
                *            RESULTS           *
                *******************************/

suite_results(Tests, suite(Passed, Failed, Skipped, Problems)) :-
    aggregate_all(count, result(passed, _, _, _), Passed),
    findall(Unit:Name, failed(Unit, Name), Failed),
    findall(Unit:Name, skipped(Unit, Name), Skipped),
    findall(Problem, not_run(Tests, Problem), Problems).

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

not_run(Tests, Problem) :-
    without_result(Unit, Name, Options),
    ( is_list(Tests) -> memberchk(Unit:Name, Tests) ; true ),
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
