:- module(study_tables,
          [ outcome_save/4              % +Study, +Outcome, +Runs, +Directory
          ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(csv), [csv_write_file/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module('../../prolog/typhon/bridges/json',
              [json_text/2, json_value/1]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(outcome, [case_numbers/4]).
:- use_module(report, [case_texts/3, parameter_rows/3]).
:- use_module(series, [is_series/1, runs_over_time/3]).
:- use_module(statistics, [deviation/2, mean/2, mean_interval/4]).
:- use_module(numbers, [spread/4]).

/** <module> Data for other programs: CSV, and JSON lines

A file has a header and a row for each item, as pandas.read_csv and read.csv
of R expect it; unknown values are empty. NAME.jsonl has the same rows, each
as an object; unknown values are null.

*Threading*: no state; any thread.
*/

%!  outcome_save(+Study, +Outcome, +Runs, +Directory) is det.
%
%   Writes, as .csv and .jsonl: `runs`, the measures of each run; `steps`, the
%   measures at each step of time, if there are any; `summary`, of each case
%   and measure the mean, its confidence interval, the median and the
%   extremes; `tests`, the comparisons of claims; `claims`; `parameters`.

outcome_save(Study, Outcome, Runs, Directory) :-
    Names = Outcome.names,
    run_table(Runs, Names, RunTable),
    step_table(Runs, Names, StepTable),
    summary_table(Outcome, Runs, SummaryTable),
    test_table(Outcome, TestTable),
    claim_table(Outcome, ClaimTable),
    parameter_rows(Study, Outcome.given, ParameterRows),
    save(Directory, runs, RunTable),
    ( StepTable = [_] -> true ; save(Directory, steps, StepTable) ),
    save(Directory, summary, SummaryTable),
    save(Directory, tests, TestTable),
    save(Directory, claims, ClaimTable),
    save(Directory, parameters, [[parameter, value, why]|ParameterRows]).

                /*******************************
                *            TABLES            *
                *******************************/

run_table(Runs, Names, [Header|Rows]) :-
    measured(Runs, number, Measures),
    append([[seed], Names, Measures], Header),
    findall(Row,
            ( member(run(Case, Seed, Ms), Runs),
              run_row(Case, Seed, Ms, Names, Measures, Row) ),
            Rows).

run_row(Case, Seed, Ms, Names, Measures, Row) :-
    case_texts(Case, Names, Keys),
    maplist(number_cell(Ms), Measures, Values),
    append([[Seed], Keys, Values], Row).

measured(Runs, Is, Measures) :-
    findall(Name,
            ( member(run(_, _, Ms), Runs),
              get_dict(Name, Ms, V),
              call(Is, V) ),
            Names),
    sort(Names, Measures).

number_cell(Ms, Name, Value) :-
    (   get_dict(Name, Ms, Value0),
        number(Value0)
    ->  Value = Value0
    ;   Value = ''
    ).

step_table(Runs, Names, [Header|Rows]) :-
    measured(Runs, is_series, Measures),
    append([[seed], Names, [time], Measures], Header),
    runs_over_time(Runs, Measures, Steps),
    append(Names, [time], Keys),
    findall(Row,
            ( member(run(Case, Seed, Ms), Steps),
              run_row(Case, Seed, Ms, Keys, Measures, Row) ),
            Rows).

summary_table(Outcome, Runs, [Header|Rows]) :-
    append(Outcome.names,
           [ measure, runs, mean, sd, ci95_low, ci95_high, median, least, most
           ], Header),
    findall(Row,
            ( member(row(Case, _, Spreads), Outcome.rows),
              member(spread(Measure, _, _, _, _), Spreads),
              case_numbers(Runs, Case, Measure, Numbers),
              case_texts(Case, Outcome.names, Keys),
              summary(Numbers, Cells),
              append(Keys, [Measure|Cells], Row) ),
            Rows).

summary(Numbers, [Count, Mean, Deviation, Low, High, Median, Least, Most]) :-
    length(Numbers, Count),
    mean(Numbers, Mean),
    spread(Numbers, Least, Median, Most),
    (   deviation(Numbers, Deviation)
    ->  mean_interval(Numbers, 0.95, Low, High)
    ;   Deviation = '',
        Low = '',
        High = ''
    ).

%   effect: the probability that one of A is greater than one of B, equal ones
%   counted half (Vargha and Delaney's A).

test_table(Outcome, [Header|Rows]) :-
    Header = [ claim, compared, a, b, runs_a, runs_b, u, effect, p, p_holm ],
    findall([Text, E, A, B, M, N, U, Effect, P, Holm],
            ( member(Text-Comparisons, Outcome.tests),
              member(comparison(CaseA, CaseB, E0, Xs, Ys, U, P, Holm),
                     Comparisons),
              length(Xs, M),
              length(Ys, N),
              Effect is U/(M*N),
              format(atom(E), '~w', [E0]),
              maplist(case_text(Outcome.names), [CaseA, CaseB], [A, B]) ),
            Rows).

case_text(Names, Case, Text) :-
    case_texts(Case, Names, Texts),
    pairs_keys_values(Pairs, Names, Texts),
    findall(Part, ( member(Name-Value, Pairs),
                    atomic_list_concat([Name, Value], =, Part) ),
            Parts),
    atomic_list_concat(Parts, ',', Text).

claim_table(Outcome, [Header|Rows]) :-
    Header = [claim, held, of, of_medians, found, notes, unknown],
    findall([Text, Held, Of, OfMedians, Found, Notes, Unknown],
            ( member(claim(Text, Notes0, Held, Of, OfMedians, Found),
                     Outcome.claims),
              Unknown is Outcome.seeds - Of,
              format(atom(Notes), '~w', [Notes0]) ),
            Rows).

                /*******************************
                *            FILES             *
                *******************************/

save(Directory, Name, Rows) :-
    save_csv(Directory, Name, Rows),
    save_json_lines(Directory, Name, Rows).

save_csv(Directory, Name, Rows) :-
    table_file(Directory, Name, csv, File),
    findall(Line, ( member(Row, Rows), Line =.. [row|Row] ), Lines),
    csv_write_file(File, Lines, [encoding(utf8)]).

save_json_lines(Directory, Name, [Header|Rows]) :-
    table_file(Directory, Name, jsonl, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Row, Rows), save_json(Out, Header, Row)),
        close(Out)).

save_json(Out, Header, Row) :-
    maplist(json_value, Row, Values),
    maplist(pair, Header, Values, Pairs),
    json_text(json(Pairs), Text),
    format(Out, '~s~n', [Text]).

pair(Name, Value, Name=Value).

%   A number as text, such as the value of a parameter, is written as a
%   number, and one that JSON lacks, such as an infinite one, as text.

json_value('', null) :-
    !.
json_value(true, true) :-
    !.
json_value(false, false) :-
    !.
json_value(Value, Number) :-
    (   number(Value)
    ->  Number = Value
    ;   atom(Value),
        atom_number(Value, Number)
    ),
    catch(json_value(Number), error(_, _), fail),
    !.
json_value(Value, Text) :-
    format(string(Text), '~w', [Value]).

table_file(Directory, Name, Extension, File) :-
    file_name_extension(Name, Extension, Base),
    directory_file_path(Directory, Base, File).
