:- module(test_mutants_suite, []).
:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2, write_file/2]).
:- use_module('../mutants/changes').
:- use_module('../mutants/copies', [suite_in_copy/5]).
:- use_module('../mutants/coverage', [tests_executing/3]).
:- use_module('../mutants/equivalent',
              [equivalent_change/2, outdated_equivalent/1]).
:- use_module('../promises', [promise/5, promise_problem/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(assoc), [assoc_to_list/2]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3, nth1/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(plunit)).

/** <module> Changes that take a promise away, and the table of promises

*Threading*: one test at a time.
*/

program(":- module(m, [p/2]).\n\c
         \n\c
         p(X, Y) :-\n    \c
             (   X < 3,\n        \c
                 !\n    \c
             ->  \\+ q(X),\n        \c
                 r(Y, a, b)\n    \c
             ;   true\n    \c
             ).\n\c
         p(_, 7).\n").

%   changed(-Kinds, -Texts): the changes of the program.

changed(Changes, Texts) :-
    program(Program),
    changes_of(Program, Changes0),
    findall(Kind-Line,
            member(change(_, _, _, _, Kind, p/2, Line), Changes0), Changes),
    findall(Text,
            ( member(Change, Changes0), changed_text(Program, Change, Text) ),
            Texts).

changes_of(Program, Changes) :-
    with_tmp_dir(Dir, ( directory_file_path(Dir, 'm.pl', File),
                        write_file(File, Program),
                        file_changes(File, Changes) )).

%   tried(+Kind, +Program, -Lines): of changes of Kind that change something.

tried(Kind, Program, Lines) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'm.pl', File),
          write_file(File, Program),
          file_changes(File, Changes),
          findall(Line, ( member(Change, Changes),
                          Change = change(_, _, _, _, Kind, _, Line),
                          \+ equivalent_change(Change, _) ), Lines) )).

%   parts(-Parts): predicate, kind, line and new text of the changes of a
%   program whose clauses have =>.

parts(Parts) :-
    Program = ":- module(m, [p/1]).\n\c
               p(a) => true.\n\c
               p(X), X > 1 => q(X), !.\n\c
               p(X), (integer(X), r(X)) =>\n    \c
                   q(X).\n\c
               q(_) => true.\n",
    changes_of(Program, Changes),
    findall(Predicate-Kind-Line-New,
            member(change(_, _, _, New, Kind, Predicate, Line), Changes),
            Parts).

terms(Text, Count) :-
    setup_call_cleanup(
        open_string(Text, In),
        aggregate_all(count, term_of(In), Count),
        close(In)).

term_of(In) :-
    repeat,
    read(In, Term),
    (   Term == end_of_file
    ->  !, fail
    ;   true
    ).

waits_for_ever(Result, Dir) :-
    suite_of(Dir, ":- thread_get_message(never).\n", limits(10, 1), Result).

%   No signal ends it.

never_handles_signals(Result, Dir) :-
    suite_of(Dir, ":- sig_atomic(( repeat, fail )).\n", limits(1, 1000), Result).

%   As cells do.

limits_itself(Result, Dir) :-
    suite_of(Dir, ":- shell('prlimit --cpu=1000 true', Status), halt(Status).\n",
             limits(10, 60), Result).

suite_of(Dir, Text, Limits, Result) :-
    directory_file_path(Dir, test, Tests),
    make_directory_path(Tests),
    directory_file_path(Tests, 'suite.pl', Runner),
    write_file(Runner, Text),
    suite_in_copy(Dir, 'test_pack.pl', all, Limits, Result).

%   first_failure(+Tests, +Dir, -Suite): d would not end.

first_failure(Tests, Dir, Suite) :-
    maplist(directory_file_path(Dir), ['test_u.pl', results], [File, Results]),
    write_file(File, ":- use_module(library(plunit)).\n\c
                      :- begin_tests(u).\n\c
                      test(a) :- fail.\n\c
                      test(b) :- true.\n\c
                      test(c) :- fail.\n\c
                      test(d) :- thread_get_message(never).\n\c
                      :- end_tests(u).\n"),
    project_file('test/suite.pl', Runner),
    run_swipl([Runner, --, File, Results, Tests], [timeout(100)], exit(0), _, _),
    read_file_to_terms(Results, [Suite], []).

:- begin_tests(mutants).

test(each_kind_of_change_is_made, Missing == []) :-
    changed(Changes, _),
    findall(Kind-Line,
            ( member(Kind-Line,
                     [ clause-3, clause-10, order-3, goal-4, comparison-4,
                       bound-4, cut-5, test-4, test-6, goal-6, goal-7,
                       constants-7, bound-10 ]),
              \+ memberchk(Kind-Line, Changes) ),
            Missing).
test(bodies_and_guards_of_single_sided_rules_are_changed, Missing == []) :-
    parts(Parts),
    findall(Part,
            ( member(Part,
                     [ clause-2-"", clause-4-"\n", goal-3-"true", cut-3-"true",
                       comparison-3-"=<", bound-3-"((1)+1)",
                       test-3-"\\+ (X > 1)", goal-4-"true",
                       test-4-"\\+ ((integer(X), r(X)))", goal-5-"true",
                       order-2-_, order-3-_ ]),
              Part = Kind-Line-New,
              \+ memberchk(p/1-Kind-Line-New, Parts) ),
            Missing).
test(single_sided_rules_are_clauses_of_their_predicates,
     Others == [q/1-clause-6]) :-
    parts(Parts),
    findall(P-Kind-Line, ( member(P-Kind-Line-_, Parts), P \== p/1 ), Others).
test(changed_program_is_a_program_with_as_many_lines, Faults == []) :-
    changed(_, Texts),
    findall(Text,
            ( member(Text, Texts),
              \+ ( catch(terms(Text, Count), error(syntax_error(_), _), fail),
                   memberchk(Count, [2,3]),
                   split_string(Text, "\n", "", Lines),
                   length(Lines, 11) ) ),
            Faults).
test(suite_that_waits_for_ever_is_ended, Result == killed(hangs)) :-
    with_tmp_dir(waits_for_ever(Result)).
test(suite_that_computes_for_ever_is_ended, Result == killed(hangs)) :-
    with_tmp_dir(never_handles_signals(Result)).
test(suite_may_start_cells,
     [condition(missing([cells], [])), Result == killed(ends(exit(0)))]) :-
    with_tmp_dir(limits_itself(Result)).
test(chosen_tests_run_until_one_fails, Suite == suite(0, [u:c], [], [])) :-
    with_tmp_dir(Dir, first_failure("[u:b,u:c,u:d]", Dir, Suite)).
test(chosen_tests_pass, Suite == suite(1, [], [], [])) :-
    with_tmp_dir(Dir, first_failure("[u:b]", Dir, Suite)).
test(tests_execute_what_is_noted_between_their_begin_and_end,
     Tests-Of == [(u:a)-1.0, (u:b)-0.5]-[5-[a,b], 6-[a,b], 7-[a], 8-[a,b], 9-[b]]) :-
    tests_executing([ hit(1, 5),        % before the unit: both
                      begins(1, u:a, 0.0), hit(1, 6), hit(2, 7), ends(1, 1.0),
                      begins(1, u:b, 2.0), hit(1, 6),
                      hit(2, 8),        % by a process that began in u:a: both
                      hit(3, 9), ends(1, 2.5) ],
                    Tests, Masks),
    assoc_to_list(Masks, List),
    findall(N-Names,
            ( member(N-Mask, List),
              findall(Name, ( nth0(Bit, Tests, (u:Name)-_),
                              getbit(Mask, Bit) =:= 1 ), Names) ),
            Of).
test(equivalent_changes_are_still_possible, Outdated == []) :-
    findall(File, outdated_equivalent(File), Outdated).
test(order_of_messages_is_equivalent, Orders == [4,6]) :-
    tried(order, ":- module(m, []).\n\c
            prolog:message(a(_)) --> [x].\n% two\n\c
            prolog:message(b(_)) --> [y].\n\c
            prolog:message(b(_)) --> [z].\n\c
            p(a) --> [x].\np(b) --> [y].\n", Orders).
test(order_of_single_sided_rules_of_other_goals_is_equivalent,
     Orders == [3,4,5]) :-
    tried(order, ":- module(m, []).\n\c
            p(a, _), x => true.\n\c
            p(b, _), y => true.\n\c
            p(b, 1) => true.\n\c
            p(X, _), X \\== c => true.\n\c
            p(_, 1) => true.\n\c
            q(a) => true.\n", Orders).
test(cut_before_an_error_is_equivalent, Lines == [5,6]) :-
    tried(cut, ":- module(m, []).\n\c
            p :- !, throw(x).\n\c
            p :- !,\n type_error(a, b).\n\c
            p :- !, q, throw(x).\n\c
            p :- !.\n", Lines).
test(no_change_leaves_the_program_as_it_was, [fail]) :-
    changed(_, Texts),
    program(Program),
    member(Program, Texts).
test(order_of_a_list_that_is_searched_is_equivalent, Lines == [4,5,6,7,8,9]) :-
    tried(constants, ":- module(m, []).\n\c
        p(X) :- memberchk(X, [a,b,c]).\n\c
        p(X) :- memberchk(X,\n [a]),\n\c
        member(X, [b,a]).\n\c
        p(X) :- memberchk(x(X), [a,b]).\n\c
        p(X) :- memberchk(X, [a]), q(b).\n\c
        p(X) :- memberchk(X, [x(a,b)]).\n\c
        p(X) :- memberchk(X-[c], [a,b]).\n", Lines0),
    sort(Lines0, Lines).
test(assumed_values_and_orders_of_declarations_of_studies_are_equivalent,
     Kinds == [ assumed-equivalent, order-equivalent, printed-tried ]) :-
    findall(Kind-Verdict,
            ( member(File, [ 'experiments/robots/study_pole.pl',
                             'experiments/hierarchy/beyond_lead.pl' ]),
              project_file(File, Path),
              file_changes(Path, Changes),
              member(change(_, S, E, New, Kind0, fixed/3, Line), Changes),
              fixed_kind(Kind0, Path, Line, Kind),
              (   equivalent_change(change(File, S, E, New, Kind0, fixed/3,
                                           Line), _)
              ->  Verdict = equivalent
              ;   Verdict = tried
              ) ),
            Kinds0),
    sort(Kinds0, Kinds).

test(sides_of_comparisons_without_direction_are_equivalent,
     Lines == [5, 6, 7]) :-
    tried(constants, ":- module(m, []).\n\c
                      p(X) :- X = (a == b).\n\c
                      p(X) :- q(a =\\= b, X).\n\c
                      p(X) :- q(X, [a \\== b]).\n\c
                      p(X) :- q(X-a =:= b).\n\c
                      p(X) :- q(a =:= b+X).\n\c
                      p(X) :- q(X, a > b).\n", Lines).
test(order_of_measures_of_a_study_is_equivalent, Verdicts == [equivalent]) :-
    verdicts('experiments/applications/study_warehouse.pl', order, measure/3,
             _, Verdicts).
test(order_of_claims_of_a_study_is_equivalent, Verdicts == [equivalent]) :-
    verdicts('experiments/hierarchy/beyond_lead.pl', order, claim/3, _,
             Verdicts).
test(line_of_the_thesis_in_a_claim_is_equivalent,
     Printed-Bounds == [equivalent]-[tried]) :-
    File = 'experiments/learning/study_light.pl',
    verdicts(File, bound, claim/3, "2373", Printed),
    verdicts(File, bound, claim/3, "3000", Bounds).
test(order_of_options_of_other_names_is_equivalent, Lines == [3, 4, 5]) :-
    tried(order, ":- module(m, []).\n\c
            typhon_options:declared(d, a(X), t, X).\n\c
            typhon_options:declared(d, b(X), t, X).\n\c
            typhon_options:declared(d, b(X, Y), t, X-Y).\n\c
            typhon_options:declared(d, X, t, X) :- p.\n\c
            typhon_options:declared(d, c(X), t, X).\n", Lines).

%   verdicts(+File, +Kind, +Predicate, ?Old, -Verdicts): of its changes of Old.

verdicts(File, Kind, Predicate, Old, Verdicts) :-
    project_file(File, Path),
    file_changes(Path, Changes),
    findall(Verdict,
            ( member(change(_, Start, End, New, Kind, Predicate, Line),
                     Changes),
              Change = change(File, Start, End, New, Kind, Predicate, Line),
              change_words(Change, Old, _),
              (   equivalent_change(Change, _)
              ->  Verdict = equivalent
              ;   Verdict = tried
              ) ),
            All),
    sort(All, Verdicts).

fixed_kind(order, _, _, order).
fixed_kind(bound, Path, Line, Kind) :-
    file_lines(Path, Lines),
    nth1(Line, Lines, Text),
    member(Kind, [assumed, printed]),
    once(sub_string(Text, _, _, _, Kind)).

:- end_tests(mutants).

:- begin_tests(promises).

test(each_has_an_anchor_a_test_and_its_text, Problems == []) :-
    findall(Problem, promise_problem(Problem), Problems).

:- end_tests(promises).

:- begin_tests(mutants_run).

printed(Args, Lines) :-
    project_file('test/mutants/run.pl', Run),
    run_swipl([Run, --|Args], [timeout(200)], exit(0), Text, _),
    split_string(Text, "\n", "\n", Lines).

test(declared_changes_of_documents_within_a_time,
     Lines == [Untried, "0 of 0 killed, in 0 s of processor"]) :-
    aggregate_all(count,
                  ( member(Document, ['doc/security.md', 'doc/wire.md']),
                    promise(_, Document, _, _, _) ),
                  Count),
    format(string(Untried), "~d not tried in time", [Count]),
    printed(['--part', declared, '--documents', 'security,wire',
             '--seconds', '0', '--jobs', '1'], Lines).

test(nothing_if_no_file_of_the_part_was_changed,
     Lines == ["no file of nothing was changed"]) :-
    printed(['--part', declared, '--touched', nothing], Lines).

:- end_tests(mutants_run).
