:- module(test_outcome, []).

% The results of many runs: medians, shares of seeds, tables.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files', [study_messages/2, with_study/2]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/numbers').
:- use_module('../../../experiments/engine/outcome').
:- use_module('../../../experiments/engine/report').
:- use_module('../../../experiments/engine/tables', [outcome_save/4]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

toy([ 'study(toy, "A toy").',
      'vary(a, [1, 2]).',
      'fixed(c, 3, tuned("it fits")).',
      'measure(m, Log, M) :- M is Log.case.a.',
      'measure(n, Log, M) :- M is Log.case.a.',
      'label(m, "What is measured").',
      'claim("small", [], m < 25).',
      'claim("rises", [], rises(m, along(a))).',
      'claim("a mistake", [], holds(wrong)).',
      'wrong(Points) :- atom_length(Points, 1).',
      'claim("never measured", [ours], n > 0).' ]).

%   values(Seed, OfFirst, OfSecond)

outcome_of(Values, Outcome) :-
    toy(Lines),
    with_study(Lines, outcome_of(Values, Outcome)).

outcome_of(Values, Outcome, Study) :-
    study_cases(Study, [], Cases),
    Cases = [A, B],
    findall(run(Case, Seed, measures{m:M}),
            ( member(values(Seed, MA, MB), Values),
              member(Case-M, [A-MA, B-MB]),
              M \== missing ),
            Runs),
    outcome(Study, Cases, Runs, Outcome0),
    Outcome = Outcome0.put(_{given:[], checks:[], study:Study, runs:Runs}).

claim(Outcome, Text, Held-Of-OfMedians) :-
    memberchk(claim(Text, _, Held, Of, OfMedians, _), Outcome.claims).

quietly_outcome_of(Values, Outcome) :-
    study_messages(outcome_of(Values, Outcome), _).

three([values(1, 10, 20), values(2, 12, 30), values(3, 14, 4)]).

:- begin_tests(outcome).

test(medians_and_spreads, Spreads == [10-12-14-3, 4-20-30-3]) :-
    three(Values),
    quietly_outcome_of(Values, Outcome),
    findall(Least-Median-Most-Count,
            member(row(_, 3, [spread(m, Least, Median, Most, Count)]),
                   Outcome.rows),
            Spreads).
test(measured_in_some_runs_only, Text == '11 (10–12) in 2') :-
    quietly_outcome_of([ values(1, 10, 1), values(2, 12, 1),
                         values(3, none, 1) ], Outcome),
    Outcome.rows = [Row|_],
    spread_text(Row, m, Text).
test(shares_of_seeds, Share == 2-3-true) :-
    three(Values),
    quietly_outcome_of(Values, Outcome),
    claim(Outcome, "rises", Share).
test(claims_are_checked_per_seed, Share == 2-3-false) :-
    quietly_outcome_of([ values(1, 30, 40), values(2, 31, 41),
                         values(3, 60, 20) ], Outcome),
    claim(Outcome, "small", Small),
    assertion(Small == 0-3-false),
    quietly_outcome_of([ values(1, 30, 31), values(2, 2, 3),
                         values(3, 60, 20) ], Outcome1),
    claim(Outcome1, "rises", Share0),
    assertion(Share0 == 2-3-false),
    Share = Share0.
test(seeds_with_missing_cases_do_not_count, Share == 1-1-true) :-
    quietly_outcome_of([ values(1, 10, 20), values(2, 12, missing) ],
                       Outcome),
    claim(Outcome, "rises", Share).
test(without_runs_nothing_is_known, Share-Rows == (0-0-false)-[]) :-
    quietly_outcome_of([], Outcome),
    claim(Outcome, "rises", Share),
    Rows = Outcome.rows.
test(unmeasured_value_is_unknown, Share == 0-0-false) :-
    three(Values),
    quietly_outcome_of(Values, Outcome),
    claim(Outcome, "never measured", Share).
test(an_error_is_reported_and_other_claims_are_kept, Share == 0-1-false) :-
    study_messages(outcome_of([values(1, 10, 20)], Outcome), Text),
    assertion(once(sub_string(Text, _, _, _, "Claim \"a mistake\""))),
    claim(Outcome, "a mistake", Share).

:- end_tests(outcome).

:- begin_tests(numbers).

test(median, M == 2) :- median([3, 1, 2], M).
test(median_of_two, M =:= 2.5) :- median([3, 2], M).
test(median_of_none, fail) :- median([], _).
test(spread, A-B-C == 1-2-3.0) :- spread([3.0, 1, 2], A, B, C).
test(text_of_numbers, [ forall(member(N-T, [ 12345-'12,345', 104.52-'104.5',
                                             1234.6-'1,235', 0.0421-'0.042',
                                             1.5-'1.50', 0-'0', 0.0-'0',
                                             -3.25-'-3.25', none-none ])),
                        Text == T ]) :-
    number_text(N, Text).

:- end_tests(numbers).

printed(Values, Text) :-
    quietly_outcome_of(Values, Outcome),
    with_output_to(string(Text), print_outcome(current_output, Outcome.study,
                                               Outcome)).

saved(Name, Text) :-
    three(Values),
    quietly_outcome_of(Values, Outcome),
    with_tmp_dir(saved(Outcome, Name, Text)).

saved(Outcome, Name, Text, Dir) :-
    outcome_save(Outcome.study, Outcome, Outcome.runs, Dir),
    directory_file_path(Dir, Name, File),
    read_file_to_string(File, Text, []).

:- begin_tests(report).

test(held, [ forall(member(H/N-T, [ 0/0-'not known', 1/1-held,
                                    3/3-'held, 3 runs', 0/3-'DID NOT HOLD',
                                    2/3-'held in 2 of 3' ])),
             Text == T ]) :-
    held_text(H, N, Text).
test(table, Text == "  a    bb  c\n  1  2.50  some\n  2     3  x\n") :-
    with_output_to(string(Text),
                   print_table(current_output, [a, bb, c],
                               [[1, 2.5, some], [2, 3, x]])).
test(printed) :-
    three(Values),
    printed(Values, Text),
    forall(member(Part, [ "toy: A toy", "  1     3  12 (10–14)",
                          "held in 2 of 3      rises",
                          "m: 12 20" ]),
           assertion(once(sub_string(Text, _, _, _, Part)))).
test(only_labelled_measures_are_shown) :-
    printed([values(1, 1, 2)], Text),
    assertion(once(sub_string(Text, _, _, _, "  a  runs  m\n"))).
test(runs, Text == "seed,a,m\r\n1,1,10\r\n1,2,20\r\n2,1,12\r\n2,2,30\r\n\c
3,1,14\r\n3,2,4\r\n") :-
    saved('runs.csv', Text).
test(claims, nondet) :-
    saved('claims.csv', Text),
    sub_string(Text, _, _, _, "rises,2,3,true,m: 12 20,[]").
test(parameters, Text == "parameter,value,why\r\na,\"[1,2]\",varied\r\n\c
c,3,tuned after results were seen: it fits\r\n") :-
    saved('parameters.csv', Text).

:- end_tests(report).
