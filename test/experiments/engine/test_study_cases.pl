:- module(test_study_cases, []).

% The cases of a study: parameters that vary, are fixed, derived or given.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module('../../lib/study_files',
              [save_lines/3, study_command/4, with_study/2,
               with_study_file/4]).
:- use_module('../../../experiments/engine/cases').
:- use_module('../../../experiments/engine/studies', [study_load/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

base([ 'study(toy, "A toy").',
       'vary(a, [1, 2]).',
       'vary(b, [x, y]).',
       'fixed(c, 3, assumed("it is small")).',
       'measure(m, Log, M) :- M is Log.case.a.' ]).

study(More, Goal) :-
    base(Base),
    append(Base, More, Lines),
    with_study(Lines, Goal).

cases(More, Given, Names, Rows) :-
    study(More, rows(Given, Names, Rows)).

%   The values of Names in each case.

rows(Given, Names, Rows, Study) :-
    study_cases(Study, Given, Cases),
    findall(Row, ( member(Case, Cases), maplist(value(Case), Names, Row) ),
            Rows).

value(Case, Name, Value) :-
    get_dict(Name, Case, Value).

all_parameters(Given, Parameters, Study) :-
    parameters(Study, Given, Parameters).

all_varied(Given, Names, Study) :-
    study_cases(Study, Given, Cases),
    varied(Study, Cases, Names).

first_name(Name, Study) :-
    study_cases(Study, [], [Case|_]),
    case_name(Study, Case, Name).

expected(Given, Rows) :-
    study([], expected(Given, Rows)).

expected(Given, Rows, Study) :-
    expected_cases(Study, Given, Cases),
    findall([A, B, C], ( member(Case, Cases), maplist(value(Case), [a, b, c],
                                                      [A, B, C]) ),
            Rows).

:- begin_tests(study_cases).

test(claims_are_about_what_given_values_leave_out,
     [ forall(member(Given, [[b-x], [b-[x]], [b-[y, x]]])),
       Rows == [[1, x, 3], [1, y, 3], [2, x, 3], [2, y, 3]] ]) :-
    expected(Given, Rows).
test(claims_are_about_other_conditions,
     Rows == [[1, z, 4], [2, z, 4]]) :-
    expected([b-z, c-4], Rows).
test(claims_are_about_more_cases,
     Rows == [[1, x, 3], [1, y, 3], [1, z, 3]]) :-
    expected([a-[1], b-[z, x]], All),
    findall([1, B, C], member([1, B, C], All), Rows).

test(first_varies_slowest,
     Rows == [[1, x, 3], [1, y, 3], [2, x, 3], [2, y, 3]]) :-
    cases([], [], [a, b, c], Rows).
test(derived_parameter, Rows == [[1, 4], [2, 5]]) :-
    cases([ 'derive(d, Case, D) :- D is Case.a + Case.c.' ], [b-x], [a, d],
          Rows).
test(parameter_derived_from_a_derived_one, Rows == [[4, 8], [5, 10]]) :-
    cases([ 'derive(d, Case, D) :- D is Case.a + Case.c.',
            'derive(e, Case, E) :- E is 2*Case.d.' ], [b-x], [d, e], Rows).
test(derivation_that_fails, error(study_goal_failed(derive(d)))) :-
    cases([ 'derive(d, Case, 1) :- Case.a > 1.' ], [], [a, d], _).
test(skipped, Rows == [[1, x], [1, y], [2, y]]) :-
    cases([ 'skip(Case) :- Case.a =:= 2, Case.b == x.' ], [], [a, b], Rows).
test(given_parameter, Rows == [[7, y, 5]]) :-
    cases([], [a-7, b-y, c-5], [a, b, c], Rows).
test(given_list_is_varied, Rows == [[1, 5], [1, 6], [2, 5], [2, 6]]) :-
    cases([], [b-y, c-[5, 6]], [a, c], Rows).
test(given_is_not_derived, Rows == [[1, 9], [2, 9]]) :-
    cases([ 'derive(d, Case, D) :- D is Case.a + Case.c.' ], [b-x, d-9],
          [a, d], Rows).
test(skip_uses_given_values, Rows == [[2, 9]]) :-
    cases([ 'skip(Case) :- Case.a =:= 1, Case.c =:= 9.' ], [b-x, c-9],
          [a, c], Rows).
test(same_value_twice_is_one_case, Rows == [[1, x], [1, y]]) :-
    cases([], [a-[1, 1]], [a, b], Rows).
test(unknown, error(study_parameter(_, d))) :-
    cases([], [d-1], [a], _).
test(parameter_missing_in_a_case, error(existence_error(key, aa, _))) :-
    cases(['derive(d, Case, D) :- D = Case.aa.'], [], [d], _).
test(missing_parameter_is_reported) :-
    dict_pairs(Case, case, [delta-1, hosts-2]),
    catch(_ = Case.dleta, Error, true),
    message_text(Error, Text),
    assertion(once(sub_string(Text, _, _, _,
                              "no parameter dleta (did you mean delta?)"))).
test(unknown_parameter_is_reported, Status-true == exit(1)-true) :-
    base(Base),
    with_study_file(Base, Dir, File,
        study_command(Dir, [File, '--set', 'd=1'], Status, Text)),
    once(sub_string(Text, _, _, _,
                    "study.pl has no parameter d; it has a, b, c")).
test(engine_adds_clock_and_processes,
     Rows == [[virtual, 1]]) :-
    cases([ 'network(_, ring(2), []).' ], [a-1, b-x], [clock, processes],
          Rows).
test(clock_may_be_fixed, Rows == [[10, 1]]) :-
    cases([ 'network(_, ring(2), []).',
            'fixed(clock, 10, assumed("slow")).' ], [a-1, b-x],
          [clock, processes], Rows).

%   The text of a study, and a study that includes it.

included(Lines, Names, Rows) :-
    with_tmp_dir(included(Lines, Names, Rows)).

included(Lines, Names, Rows, Dir) :-
    base(Base),
    save_lines(Dir, 'ground.pl', Base),
    save_lines(Dir, 'study.pl', [':- include(ground).'|Lines]),
    directory_file_path(Dir, 'study.pl', File),
    study_load(File, Study),
    rows([], Names, Rows, Study).

test(study_fixes_a_fixed_parameter, Rows == [[1, 4], [2, 4]]) :-
    included([ 'vary(b, [x]).', 'fixed(c, 4, printed("there")).' ],
             [a, c], Rows).
test(study_fixes_a_varied_parameter, Rows == [[5, x], [5, y]]) :-
    included([ 'fixed(a, 5, printed("there")).' ], [a, b], Rows).
test(study_varies_a_fixed_parameter,
     Rows == [[1, x], [1, x], [2, x], [2, x]]) :-
    included([ 'vary(b, [x]).', 'vary(c, [4, 5]).' ], [a, b], Rows).
test(study_derives_a_fixed_parameter, Rows == [[1, 10], [2, 20]]) :-
    included([ 'vary(b, [x]).',
               'derive(c, Case, C) :- C is 10*Case.a.' ], [a, c], Rows).

test(parameters,
     Parameters == [ parameter(a, [1, 2], varied),
                     parameter(b, y, given),
                     parameter(c, 3, assumed("it is small")) ]) :-
    study([], all_parameters([b-y], Parameters)).

test(varied_parameters_include_those_with_several_values,
     Names == [a, b, c]) :-
    study([], all_varied([b-x, c-[1, 2]], Names)).
test(derived_parameters_are_not_varied, Names == [a, b]) :-
    study([ 'derive(d, Case, D) :- D is Case.a.' ], all_varied([], Names)).

test(name, Name == 'a=1,b=x') :-
    study([], first_name(Name)).

:- end_tests(study_cases).
