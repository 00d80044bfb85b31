:- module(test_outcome, []).

% The results of many runs: medians, shares of seeds, tables.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files',
              [study_messages/2, with_study/2, with_study/3]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/cross_check', [claims_check/5, cross_check/4]).
:- use_module('../../../experiments/engine/numbers').
:- use_module('../../../experiments/engine/outcome').
:- use_module('../../../experiments/engine/report').
:- use_module('../../../experiments/engine/tables', [outcome_save/4]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(random), [maybe/1]).
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
    with_study(Lines, Study, outcome_of(Values, Outcome, Study)).

outcome_of(Values, Outcome, Study) :-
    study_cases(Study, [], Cases),
    Cases = [A, B],
    findall(Seed, member(values(Seed, _, _), Values), Seeds),
    findall(run(Case, Seed, measures{m:M}),
            ( member(values(Seed, MA, MB), Values),
              member(Case-M, [A-MA, B-MB]),
              M \== missing ),
            Runs),
    outcome(plan(Study, [], Cases), Seeds, Runs, Outcome0),
    Outcome = Outcome0.put(_{given:[], checks:[], study:Study, runs:Runs}).

claim(Outcome, Text, Held-Of-OfMedians) :-
    memberchk(claim(Text, _, Held, Of, OfMedians, _), Outcome.claims).

quietly_outcome_of(Values, Outcome) :-
    study_messages(outcome_of(Values, Outcome), _).

three([values(1, 10, 20), values(2, 12, 30), values(3, 14, 4)]).

%   A study of three ways and two sizes, run for some of the cases.

ways([ 'study(ways, "Three ways").',
       'vary(way, [slow, plain, fast]).',
       'vary(size, [1, 2]).',
       'measure(m, Log, M) :- M is Log.case.size.',
       'claim("fast is least", [], least(m, way=fast)).',
       'claim("slow rises", [], at([way=slow], rise(m, along(size))) > 0).',
       'claim("slow by itself", [], at([way=slow], rises(m, along(size)))).',
       'claim("all rise", [], rises(m, along(size))).',
       'claim("no way is great", [], \\+ some(m > 60)).',
       'claim("plain is not slow", [],',
       '      at([size=2], at([way=plain], m) =\\= at([way=slow], m))).' ]).

ways_shares(Given, Runs, Shares) :-
    ways(Lines),
    with_study(Lines, Study, ways_shares(Given, Runs, Shares, Study)).

ways_shares(Given, Made, Shares, Study) :-
    study_cases(Study, Given, Cases),
    findall(run(Case, Seed, measures{m:M}),
            ( member(Seed, [1, 2]), member(Case, Cases),
              memberchk(Case.way-Base, [slow-50, plain-30, fast-10]),
              call(Made, Seed, Case),
              M is Base + Case.size ),
            Runs),
    outcome(plan(Study, Given, Cases), [1, 2], Runs, Outcome),
    findall(Text-(Held/Of), member(claim(Text, _, Held, Of, _, _),
                                   Outcome.claims),
            Shares).

all(_, _).

none(_, _) :-
    fail.

not_first(Seed, Case) :-
    \+ ( Seed == 1, Case.way == fast ).

some_of(Odds, _, _) :-
    maybe(Odds).

%   shares(Name, Given, Made, Shares): of the claims about ways, in their order.

shares(all_runs, [], all, [2/2, 2/2, 2/2, 2/2, 2/2, 2/2]).
shares(no_run, Given, none, [0/0, 0/0, 0/0, 0/0, 0/0, 0/0]) :-
    member(Given, [[], [way-fast], [way-odd]]).
shares(a_given_way_says_nothing_of_others, [way-fast], all,
       [0/0, 0/0, 0/0, 0/0, 0/0, 0/0]).
shares(two_given_ways_say_nothing_of_the_third, [way-[fast,slow]], all,
       [0/0, 2/2, 2/2, 0/0, 0/0, 0/0]).
shares(a_given_size_has_no_trend, [size-2], all, [_, 0/0, 0/0, 0/0, _, _]).
shares(failed_runs_of_a_seed, [], not_first, [1/1, 2/2, 2/2, 1/1, 1/1, 2/2]).

%   holds(Name, Values, Claim, Share): Share is Held-Of-OfMedians.

holds(shares_of_seeds, Values, "rises", 2-3-true) :-
    three(Values).
holds(claims_are_checked_per_seed,
      [values(1, 30, 40), values(2, 31, 41), values(3, 60, 20)], "small",
      0-3-false).
holds(claims_are_checked_per_seed,
      [values(1, 30, 31), values(2, 2, 3), values(3, 60, 20)], "rises",
      2-3-false).
holds(seeds_with_missing_cases_are_not_known,
      [values(1, 10, 20), values(2, 12, missing)], "rises", 1-1-unknown).
holds(a_run_may_decide_without_the_others,
      [values(1, 10, 20), values(2, 30, missing)], "small", 1-2-unknown).
holds(with_one_of_two_cases_nothing_rises,
      [values(1, 10, missing), values(2, 10, missing), values(3, 10, missing)],
      "rises", 0-0-unknown).
holds(without_runs_nothing_is_known, [], "rises", 0-0-unknown).
holds(unmeasured_value_is_unknown, Values, "never measured", 0-0-unknown) :-
    three(Values).

:- begin_tests(outcome).

test(shares_of_claims, [ forall(shares(_, Given, Made, Expected)),
                         Found = Expected ]) :-
    ways_shares(Given, Made, Shares),
    findall(Share, member(_-Share, Shares), Found).
test(claim_holds_in_seeds, [ forall(holds(_, Values, Text, Expected)),
                             Share == Expected ]) :-
    quietly_outcome_of(Values, Outcome),
    claim(Outcome, Text, Share).
test(missing_runs_and_seeds_are_counted, Missing-Seeds-Rows == 1-2-2) :-
    quietly_outcome_of([values(1, 10, 20), values(2, 12, missing)], Outcome),
    _{missing:Missing, seeds:Seeds} :< Outcome,
    length(Outcome.rows, Rows).
test(without_runs_there_are_no_rows, Rows == []) :-
    quietly_outcome_of([], Outcome),
    Rows = Outcome.rows.
test(fewer_runs_hold_in_no_more_seeds) :-
    ways_shares([], all, All),
    forall(( between(1, 20, _), ways_shares([], some_of(0.7), Some),
             member(Text-(Held/Of), Some) ),
           ( memberchk(Text-(Most/_), All),
             assertion(Held =< Most),
             assertion(Held =:= Of) )).

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
    saved(Values, Name, Text).

saved(Values, Name, Text) :-
    quietly_outcome_of(Values, Outcome),
    with_tmp_dir(saved(Outcome, Name, Text)).

%   row_of(+Table, +Begin, -Numbers): Numbers are the other cells of the row of
%   Table that begins with Begin, of four runs of each case.

row_of(Table, Begin, Numbers) :-
    saved([ values(1, 10, 20), values(2, 12, 30), values(3, 14, 40),
            values(4, 15, 13) ], Table, Text),
    split_string(Text, "\n", "\r", Lines),
    member(Line, Lines),
    string_concat(Begin, Rest, Line),
    !,
    split_string(Rest, ",", "", Cells),
    maplist([Cell, Number]>>number_string(Number, Cell), Cells, Numbers).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-4.

shown_of(Names, Shown, Study) :-
    findall(spread(Name, 1, 1, 1, 1), member(Name, Names), Spreads),
    shown_measures(Study, [row(case{}, 1, Spreads)], Shown).

saved(Outcome, Name, Text, Dir) :-
    outcome_save(Outcome.study, Outcome, Outcome.runs, Dir),
    directory_file_path(Dir, Name, File),
    read_file_to_string(File, Text, []).

:- begin_tests(cross_check).

test(real_run_beside_the_virtual_ones,
     [ forall(member(Real-Verdict, [ 1-inside, 3-inside, 2.5-inside,
                                     0.9-below, 3.1-above ])),
       Found == Verdict ]) :-
    cross_check([ms{m:1, o:x}, ms{m:3}, ms{m:2}], [real-[ms{m:Real}]], [m, o],
                table([measure, virtual, real, verdict], [[m, _, _, Found]])).
test(median_of_the_real_runs, Found == inside) :-
    cross_check([ms{m:1}, ms{m:2}], [real-[ms{m:2}, ms{m:9}, ms{m:0}]], [m],
                table(_, [[m, _, _, Found]])).
test(several_ways, Row == [m, '1', '2', above, '', '', '1', inside]) :-
    cross_check([ms{m:1}], [a-[ms{m:2}], b-[ms{}], c-[ms{m:1}]], [m],
                table(_, [Row])).
test(claims_with_the_measures_of_each_way,
     Rows == [['"a above 2"', '1 of 2', '2 of 2'], ['"b below a"', '2 of 2', '1 of 2']]) :-
    with_study([ 'study(toy, "Toy").',
                 'vary(c, [a, b]).',
                 'measure(m, _, 1).',
                 'claim("a above 2", [], at([c=a], m > 2)).',
                 'claim("b alone", [], at([c=b], m > 2)).',
                 'claim("b below a", [], at([c=b], m < at([c=a], m))).' ],
               Study,
               claims_check(Study,
                            [ 1-[case{c:a}-ms{m:2}, case{c:b}-ms{m:1}],
                              2-[case{c:a}-ms{m:5}, case{c:b}-ms{m:4}] ],
                            case{c:a},
                            [ virtual-[1-ms{m:2}, 2-ms{m:5}],
                              real-[1-ms{m:3}, 2-ms{m:4}] ],
                            table([claim, virtual, real], Rows))).

:- end_tests(cross_check).

:- begin_tests(report).

test(held, [ forall(member(H/N/S-T, [ 0/0/3-'not known', 1/1/1-held,
                                      3/3/3-'held, 3 runs',
                                      0/3/3-'DID NOT HOLD',
                                      2/3/3-'held in 2 of 3',
                                      2/2/3-'held in 2 of 3, 1 not known',
                                      0/1/3-'held in 0 of 3, 2 not known' ])),
             Text == T ]) :-
    held_text(H, N, S, Text).
test(medians_that_differ,
     [ forall(member(H/N/M-T, [ 2/3/false-' (not of the medians)',
                                0/3/true-' (but of the medians)', 3/3/true-'',
                                0/3/false-'', 2/3/unknown-'', 1/1/false-'' ])),
       Text == T ]) :-
    medians_text(H, N, M, Text).
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
test(measures_without_a_label_are_not_shown, Shown == [m]) :-
    toy(Lines),
    with_study(Lines, shown_of([m, n], Shown)).
test(all_measures_are_shown_if_none_has_a_label, Shown == [m, n]) :-
    toy(Lines0),
    exclude([Line]>>sub_atom(Line, 0, _, _, label), Lines0, Lines),
    with_study(Lines, shown_of([m, n], Shown)).
test(runs, Text == "seed,a,m\r\n1,1,10\r\n1,2,20\r\n2,1,12\r\n2,2,30\r\n\c
3,1,14\r\n3,2,4\r\n") :-
    saved('runs.csv', Text).
test(claims, nondet) :-
    saved('claims.csv', Text),
    sub_string(Text, _, _, _, "rises,2,3,true,m: 12 20,[]").
test(summary, true(maplist(close_to, Numbers,
                           [ 4, 12.75, 2.21736, 9.22167, 16.27833, 13, 10,
                             15 ]))) :-
    row_of('summary.csv', "1,m,", Numbers).
test(pair_of_cases_in_tests,                % 14 and 15 are above 13
     true(maplist(close_to, Numbers,
                  [4, 4, 2, 0.125, 0.05714, 0.05714]))) :-
    row_of('tests.csv', "rises,m,a=1,a=2,", Numbers).
test(runs_for_which_a_claim_is_unknown, nondet) :-
    saved([values(1, 10, 20), values(2, 12, missing)], 'claims.csv', Text),
    sub_string(Text, _, _, _, "rises,1,1,unknown,m: 11 20,[],1\r").
test(a_parameter_has_one_row_and_a_reason, Rows == Expected) :-
    Expected = [ [a, '[1,2]', varied], [b, '[4]', 'given by --set'],
                 [c, '3', 'assumed: so'], [d, '5', 'printed: there'],
                 [e, '6', 'tuned after results were seen: it fits'],
                 [f, '', 'follows from others'] ],
    with_study([ 'study(toy, "A toy").', 'vary(a, [1, 2]).',
                 'fixed(b, 3, assumed("so")).', 'fixed(c, 3, assumed("so")).',
                 'fixed(d, 5, printed("there")).',
                 'fixed(e, 6, tuned("it fits")).',
                 'derive(f, Case, F) :- F is Case.a.', 'measure(m, _, 1).' ],
               Study, parameter_rows(Study, [b-[4]], All)),
    findall([Name|Row], ( member([Name|Row], All),
                          atom_length(Name, 1) ), Rows).
test(parameters, Text == "parameter,value,why\r\na,\"[1,2]\",varied\r\n\c
c,3,tuned after results were seen: it fits\r\n") :-
    saved('parameters.csv', Text).

:- end_tests(report).
