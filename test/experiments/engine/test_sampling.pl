:- module(test_sampling, []).

% Sampled parameters; series over time; tables that pandas reads; rank tests
% beside claims.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module('../../lib/study_files',
              [pandas_python/1, study_command/4, with_study/3]).
:- use_module('../../../experiments/engine/cases').
:- use_module('../../../experiments/engine/evidence').
:- use_module('../../../experiments/engine/sampling').
:- use_module('../../../experiments/engine/series').
:- use_module('../../../experiments/engine/studies', [study_load/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(http/json), [atom_json_dict/3]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

drawn(Ranges, Design, Name, Values) :-
    sampled_points(Ranges, Design, Points),
    findall(Value, ( member(Point, Points), memberchk(Name-Value, Point) ),
            Values).

%   The part, of Count, in which each value lies.

parts(Low, High, Count, Values, Parts) :-
    findall(Part,
            ( member(Value, Values),
              Part is floor((Value - Low)/(High - Low)*Count) ),
            Parts0),
    msort(Parts0, Parts).

:- begin_tests(sampling).

test(hypercube_has_one_point_in_each_part,
     [forall(member(Name-Low-High, [a-0-1, b-10-30])), Parts == All]) :-
    Ranges = [a-uniform(0, 1), b-uniform(10, 30)],
    drawn(Ranges, latin_hypercube(20), Name, Values),
    parts(Low, High, 20, Values, Parts),
    numlist(0, 19, All).
test(hypercube_of_powers_of_ten, Parts == [0, 1, 2, 3]) :-
    drawn([a-loguniform(1, 10000)], latin_hypercube(4), a, Values),
    findall(Part, ( member(V, Values), Part is floor(log10(V)) ), Parts0),
    msort(Parts0, Parts).
test(hypercube_of_values_has_each_equally_often,
     Sorted == [x, x, x, y, y, y]) :-
    drawn([a-[x, y]], latin_hypercube(6), a, Values),
    msort(Values, Sorted).
test(hypercube_of_integers, Sorted == [1, 1, 2, 2, 3, 3]) :-
    drawn([a-integer(1, 3)], latin_hypercube(6), a, Values),
    msort(Values, Sorted).
test(random_is_in_range) :-
    drawn([a-uniform(-1, 1), b-integer(3, 5)], random(200), a, Values),
    forall(member(Value, Values), assertion(( -1 =< Value, Value =< 1 ))),
    drawn([b-integer(3, 5)], random(200), b, Integers),
    sort(Integers, Distinct),
    assertion(Distinct == [3, 4, 5]).
test(random_sample_can_be_continued, nondet) :-
    drawn([a-uniform(0, 1)], random(5), a, Few),
    drawn([a-uniform(0, 1)], random(9), a, Many),
    append(Few, _, Many).
test(parameters_are_independent, Alone == Together) :-
    drawn([a-uniform(0, 1)], latin_hypercube(5), a, Alone),
    drawn([b-[x, y], a-uniform(0, 1)], latin_hypercube(5), a, Together).
test(parameters_of_one_range_have_other_values, true(A \== B)) :-
    Ranges = [a-uniform(0, 1), b-uniform(0, 1)],
    drawn(Ranges, random(5), a, A),
    drawn(Ranges, random(5), b, B).
test(design_has_as_many_points, [forall(member(D, [random(7),
                                                   latin_hypercube(7)])),
                                 Count == 7]) :-
    drawn([a-uniform(0, 1)], D, a, Values),
    length(Values, Count).
test(other_seed_draws_other_values, true(A \== B)) :-
    drawn([a-uniform(0, 1)], random(5), a, A),
    drawn([a-uniform(0, 1)], random(5, 2), a, B).

:- end_tests(sampling).

sampled([ 'study(toy, "A toy").',
          'vary(kind, [x, y]).',
          'sample(rate, uniform(0, 1)).',
          'sample(size, integer(1, 9)).',
          'design(latin_hypercube(5)).',
          'measure(m, Log, M) :- M is Log.case.rate.' ]).

sampled_cases(Given, Cases) :-
    sampled(Lines),
    with_study(Lines, Study, cases_of(Given, Cases, Study)).

cases_of(Given, Cases, Study) :-
    study_cases(Study, Given, Cases).

:- begin_tests(sampled_studies).

test(each_combination_has_all_points, Count-Few == 10-5) :-
    sampled_cases([], Cases),
    length(Cases, Count),
    findall(R-S, ( member(Case, Cases), R = Case.rate, S = Case.size ), All),
    sort(All, Distinct),
    length(Distinct, Few).
test(given_parameter_is_not_sampled, Rates == [0.5]) :-
    sampled_cases([rate-0.5], Cases),
    findall(R, ( member(Case, Cases), R = Case.rate ), All),
    sort(All, Rates).
test(another_design, Count == 6) :-
    sampled_cases([design-random(3)], Cases),
    length(Cases, Count).
test(unknown_design, error(domain_error(study_design, many))) :-
    sampled_cases([design-many], _).
test(sampled_parameters_vary, Names == [kind, rate, size]) :-
    sampled(Lines),
    with_study(Lines, Study,
        ( study_cases(Study, [], Cases),
          varied(Study, Cases, Names) )).
test(wrong_ranges_and_designs_are_errors,
     [ forall(member(Line, [ 'sample(b, uniform(2, 1)).',
                             'design(hypercube(5)).' ])),
       error(study(_, [_|_])) ]) :-
    sampled(Lines0),
    append(Lines0, [Line], Lines),
    with_study(Lines, Study, cases_of([], _, Study)).
test(example_study_has_forty_cases, Count == 40) :-
    project_file('examples/studies/search.pl', File),
    study_load(File, Study),
    study_cases(Study, [], Cases),
    length(Cases, Count).

:- end_tests(sampled_studies).

:- begin_tests(series).

test(counted, Series == [0-0, 2-1, 4-3, 6-3]) :-
    counted([3, 1, 3.5], 2, 7, Series).
test(stepped_begins_with_the_first_change, Series == [2-a, 4-c]) :-
    stepped([1-a, 3-b, 4-c, 9-d], 2, 5, Series).
test(step_must_be_positive, error(domain_error(step_of_time, 0))) :-
    counted([], 0, 7, _).
test(is_series, [forall(member(No, [[], [1], [a-1], [1-a], x, 3, [1-2|_]])),
                 fail]) :-
    is_series(No).
test(runs_over_time,
     Rows == [0-(x-[m-1]), 1-(x-[m-2]), 1-(x-[n-5])]) :-
    Case = case{kind:x},
    runs_over_time([ run(Case, 1, measures{m:[0-1, 1-2], o:7}),
                     run(Case, 2, measures{n:[1-5]}) ], [m, n], Runs),
    findall(Time-(Kind-Pairs),
            ( member(run(C, _, Ms), Runs),
              get_dict(time, C, Time),
              get_dict(kind, C, Kind),
              dict_pairs(Ms, _, Pairs) ),
            Rows).

:- end_tests(series).

                /*******************************
                *           RANK TESTS         *
                *******************************/

%   Points of six seeds: of a=1 lower than of a=2 but in one seed.

of_seeds(OfSeeds) :-
    findall([case{a:1}-measures{m:X}, case{a:2}-measures{m:Y}],
            member(X-Y, [1-7, 2-8, 3-9, 4-10, 5-11, 6-5.5]), OfSeeds).

compared(Test, Comparisons) :-
    of_seeds(OfSeeds),
    claim_comparisons(user:Test, OfSeeds, Comparisons).

:- begin_tests(evidence).

test(pairs_are_tested_in_the_claimed_direction,
     [forall(member(Test-Less, [ least(m, a=1)-true, rises(m, along(a))-true,
                                 rises(m, along(a), ends)-true,
                                 at([a=1], m < at([a=2], m))-true,
                                 most(m, a=1)-false,
                                 falls(m, along(a))-false ]))]) :-
    compared(Test, [comparison(_, _, _, _, _, U, P, P)]),
    assertion(U =:= 1),
    (   Less == true
    ->  assertion(P < 0.005)            % 2/924
    ;   assertion(P > 0.995)
    ).
test(numbers_are_not_compared, Comparisons == []) :-
    compared(m < 3, Comparisons).
test(several_pairs_are_corrected, Adjusted =:= 2*P) :-
    compared(( least(m, a=1), 2*m < at([a=2], 3*m) ), Comparisons),
    member(comparison(_, _, m, _, _, _, P, Adjusted), Comparisons),
    !.
test(few_seeds_are_not_tested, Comparisons == []) :-
    of_seeds([A, B, C|_]),
    claim_comparisons(user:least(m, a=1), [A, B, C], Comparisons).
test(greatest_p_is_shown, Text == 'rank tests, 3 pairs of cases: p = 0.200') :-
    findall(comparison(a, b, m, [], [], 0, Q, Q), member(Q, [0.01, 0.2, 0.1]),
            Comparisons),
    evidence_text(Comparisons, Text).
test(text, Text == 'rank test: p = 0.002') :-
    compared(least(m, a=1), Comparisons),
    evidence_text(Comparisons, Text).

:- end_tests(evidence).

                /*******************************
                *            PANDAS            *
                *******************************/

table([ 'study(table, "A table").',
        'vary(kind, [new_one, \'it"s, so\']).',
        'vary(n, [1, 2.5]).',
        'measure(m, Log, M) :- M is Log.case.n*Log.case.seed.',
        'measure(late, Log, 7) :- Log.case.seed > 1.',
        'measure(s, _, [0-1, 1-3]).',
        'claim("grows", [], rises(m, along(n))).' ]).

:- meta_predicate with_tables(1).

with_tables(Goal) :-
    tables(Tables),
    call(Goal, Tables).

%   The study runs once for all tests.

:- dynamic made/1.

tables(Tables) :-
    made(Tables),
    !.
tables(Tables) :-
    make_tmp_dir(Dir),
    at_halt(delete_directory_and_contents(Dir)),
    table(Lines),
    atomic_list_concat(Lines, '\n', Text),
    directory_file_path(Dir, 'table.pl', File),
    write_file(File, '~w~n', [Text]),
    study_command(Dir, [File, '--runs', 2, '--out', out], exit(0), _),
    directory_file_path(Dir, 'out/table', Tables),
    assertz(made(Tables)).

lines_of(Name, Lines, Tables) :-
    directory_file_path(Tables, Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    split_string(Text, "\n", "\r", Lines).

pandas_reads(Tables) :-
    pandas_python(Python),
    project_file('test/experiments/engine/read_tables.py', Script),
    setup_call_cleanup(
        process_create(Python, [Script],
                       [ cwd(Tables), stdout(pipe(Out)), process(Pid) ]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, Status),
    assertion(Status-Text == exit(0)-"read\n").

:- begin_tests(tables).

test(json_lines) :-
    with_tables(lines_of('runs.jsonl', [First|_])),
    atom_json_dict(First, Line, []),
    assertion(Line = _{seed:1, kind:"new_one", n:1, late:null, m:1}).
test(steps) :-
    with_tables(lines_of('steps.csv', [Header, First|_])),
    assertion(Header == "seed,kind,n,time,s"),
    assertion(First == "1,new_one,1,0,1").
test(pandas_reads_all, [condition(pandas_python(_))]) :-
    with_tables(pandas_reads).

:- end_tests(tables).
