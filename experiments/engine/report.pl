:- module(study_report,
          [ print_outcome/3,            % +Stream, +Study, +Outcome
            print_means/4,              % +Stream, +Study, +Outcome, +Runs
            evidence/3,                 % +Text, +Tests, -Evidence
            print_table/3,              % +Stream, +Header, +Rows
            case_texts/3,               % +Case, +Names, -Texts
            spread_text/3,              % +Row, +Measure, -Text
            shown_measures/3,           % +Study, +Rows, -Measures
            parameter_rows/3,           % +Study, +Given, -Rows
            claims_sentence/2,          % +Outcomes, -Sentence
            held_text/4,                % +Held, +Of, +Seeds, -Text
            medians_text/4              % +Held, +Of, +OfMedians, -Text
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3, maplist/4]).
:- use_module('../../prolog/typhon/kernel/base/names', [counted/3]).
:- use_module(library(lists),
              [ append/2, append/3, list_to_set/2, member/2, memberchk/2,
                nth1/3 ]).
:- use_module(cases, [parameters/3]).
:- use_module(evidence, [evidence_text/2]).
:- use_module(numbers, [number_text/2, spread_text/4]).
:- use_module(outcome, [case_numbers/4]).
:- use_module(statistics, [mean/2, mean_interval/4]).
:- use_module(studies, [study_call/2, study_title/3]).

/** <module> Printed tables

*Threading*: no state; any thread.
*/

%!  print_outcome(+Stream, +Study, +Outcome) is det.
%
%   Prints a line for each case: medians with the least and greatest run; and
%   for each claim the number of runs in which it held, its values, and its rank
%   tests. Outcome has two more keys: `given`, the values of --set, and
%   `checks`, tables of module `study_cross_check`.

print_outcome(Stream, Study, Outcome) :-
    study_title(Study, Name, Title),
    format(Stream, '~n~w: ~w~n~n', [Name, Title]),
    shown_measures(Study, Outcome.rows, Measures),
    findall(Cells,
            ( member(Row, Outcome.rows),
              row_cells(Row, Outcome.names, Measures, Cells) ),
            Rows),
    append([Outcome.names, [runs], Measures], Header),
    print_table(Stream, Header, Rows),
    nl(Stream),
    forall(member(Claim, Outcome.claims),
           print_claim(Stream, Outcome, Claim)),
    print_checks(Stream, Outcome.checks).

print_checks(Stream, Tables) :-
    forall(( member(table(Header, Rows), Tables), Rows \== [] ),
           ( nl(Stream), print_table(Stream, Header, Rows) )).

row_cells(Row, Names, Measures, Cells) :-
    Row = row(Case, Count, _),
    case_texts(Case, Names, Keys),
    maplist(spread_text(Row), Measures, Values),
    append([Keys, [Count], Values], Cells).

%!  shown_measures(+Study, +Rows, -Measures:list(atom)) is det.
%
%   Measures are the measures that have a label, or all if none has one.

shown_measures(Study, Rows, Measures) :-
    findall(Name, ( member(row(_, _, Spreads), Rows),
                    member(spread(Name, _, _, _, _), Spreads) ), Names),
    sort(Names, All),
    findall(Name, ( study_call(Study, label(Name, _)), memberchk(Name, All) ),
            Labelled),
    (   Labelled == []
    ->  Measures = All
    ;   list_to_set(Labelled, Measures)
    ).

%!  case_texts(+Case, +Names, -Texts) is det.
%!  spread_text(+Row, +Measure, -Text) is det.
%
%   Texts are the values of Names in Case.  Text is the median of Measure, with
%   the least and greatest run.

case_texts(Case, Names, Texts) :-
    findall(Text, ( member(Name, Names), get_dict(Name, Case, Value),
                    format(atom(Text), '~w', [Value]) ),
            Texts).

spread_text(row(_, Count, Spreads), Measure, Text) :-
    memberchk(spread(Measure, Least, Median, Most, Number), Spreads),
    !,
    spread_text(Least, Median, Most, Spread),
    (   Number =:= Count
    ->  Text = Spread
    ;   format(atom(Text), '~w in ~d', [Spread, Number])
    ).
spread_text(_, _, '').

print_claim(Stream, Outcome, claim(Text, _, Held, Of, OfMedians, Found)) :-
    held_text(Held, Of, Outcome.seeds, Word),
    medians_text(Held, Of, OfMedians, Medians),
    format(Stream, '  ~w ~t~22|~w~w~n~22|~w~n', [Word, Text, Medians, Found]),
    (   evidence(Text, Outcome.tests, Evidence)
    ->  format(Stream, '~22|~w~n', [Evidence])
    ;   true
    ).

%!  evidence(+Text, +Tests, -Evidence:atom) is semidet.
%
%   The rank tests of the claim Text; fails if the claim compares no cases.

evidence(Text, Tests, Evidence) :-
    memberchk(Text-Comparisons, Tests),
    evidence_text(Comparisons, Evidence).

%!  print_means(+Stream, +Study, +Outcome, +Runs) is det.
%
%   Prints a line for each case: means, and their confidence intervals.

print_means(Stream, Study, Outcome, Runs) :-
    shown_measures(Study, Outcome.rows, Measures),
    findall(Cells,
            ( member(row(Case, Count, _), Outcome.rows),
              case_texts(Case, Outcome.names, Keys),
              findall(Text,
                      ( member(Measure, Measures),
                        case_numbers(Runs, Case, Measure, Numbers),
                        mean_text(Numbers, Text) ),
                      Values),
              append([Keys, [Count], Values], Cells) ),
            Rows),
    append([Outcome.names, [runs], Measures], Header),
    format(Stream, '~nMeans, and their confidence intervals (95 %)~n~n', []),
    print_table(Stream, Header, Rows).

mean_text(Numbers, Text) :-
    mean(Numbers, Mean),
    !,
    (   mean_interval(Numbers, 0.95, Low, High)
    ->  spread_text(Low, Mean, High, Text)
    ;   number_text(Mean, Text)
    ).
mean_text(_, '').

%!  held_text(+Held, +Of, +Seeds, -Text) is det.

held_text(_, 0, _, 'not known') :- !.
held_text(1, 1, 1, held) :- !.
held_text(Of, Of, Of, Text) :- !, counted(Of, run, Runs),
    atom_concat('held, ', Runs, Text).
held_text(0, Of, Of, 'DID NOT HOLD') :- !.
held_text(Held, Of, Of, Text) :-
    !,
    format(atom(Text), 'held in ~d of ~d', [Held, Of]).
held_text(Held, Of, Seeds, Text) :-
    Unknown is Seeds - Of,
    format(atom(Text), 'held in ~d of ~d, ~d not known', [Held, Seeds, Unknown]).

%!  claims_sentence(+Outcomes:list, -Sentence:atom) is det.
%
%   How many of the claims of all Outcomes held.

claims_sentence(Outcomes, Sentence) :-
    findall(claim(Text, Held, Of, Seeds),
            ( member(Outcome, Outcomes),
              Seeds = Outcome.seeds,
              member(claim(Text, _, Held, Of, _, _), Outcome.claims) ),
            Claims),
    exclude(all_held, Claims, Others),
    length(Claims, Count),
    length(Others, OtherCount),
    HeldCount is Count - OtherCount,
    sentence(Others, HeldCount, Count, Sentence0),
    aggregate_all(count, member(claim(_, Same, Same, _), Others), Unknown),
    (   Unknown =:= 0
    ->  Sentence = Sentence0
    ;   format(atom(Sentence), '~w ~d not known.', [Sentence0, Unknown])
    ).

all_held(claim(_, Seeds, Seeds, Seeds)) :-
    Seeds > 0.

sentence(_, _, 0, 'Nothing is claimed.') :-
    !.
sentence([], _, Count, Sentence) :-
    !,
    format(atom(Sentence), 'All ~d claims held.', [Count]).
sentence([claim(Text, 0, 1, 1)], _, Count, Sentence) :-
    !,
    format(atom(Sentence), '1 of ~d claims did not hold: ~w.', [Count, Text]).
sentence(_, Held, Count, Sentence) :-
    format(atom(Sentence), '~d of ~d claims held in all runs.', [Held, Count]).

%!  medians_text(+Held, +Of, +OfMedians, -Text) is det.
%
%   Text says whether a claim holds for the medians, if that differs from the
%   runs.

medians_text(Held, Of, false, ' (not of the medians)') :-
    Of > 1,
    Held > 0,
    !.
medians_text(0, Of, true, ' (but of the medians)') :-
    Of > 1,
    !.
medians_text(_, _, _, '').

%!  print_table(+Stream, +Header, +Rows) is det.
%
%   Rows are lists of cells, as many as Header has.  Columns of numbers are
%   right aligned, others left.

print_table(Stream, Header, Rows0) :-
    maplist(maplist(cell), Rows0, Rows),
    findall(Column, column(Header, Rows, Column), Columns),
    forall(member(Row, [Header|Rows]), print_row(Stream, Columns, Row)).

cell(Cell, Text) :-
    number(Cell),
    !,
    number_text(Cell, Text).
cell(Cell, Text) :-
    format(atom(Text), '~w', [Cell]).

%   column(+Header, +Rows, -Column) is nondet: column(Side, Width).

column(Header, Rows, column(Side, Width)) :-
    nth1(N, Header, Title),
    findall(Cell, ( member(Row, Rows), nth1(N, Row, Cell) ), Cells),
    (   forall(member(Cell, Cells), of_numbers(Cell))
    ->  Side = right
    ;   Side = left
    ),
    aggregate_all(max(Length),
                  ( member(Cell, [Title|Cells]), atom_length(Cell, Length) ),
                  Longest),
    Width is Longest + 2.

of_numbers('').
of_numbers(Cell) :-
    sub_atom(Cell, 0, 1, _, First),
    ( First == (-) ; char_type(First, digit) ),
    !.

print_row(Stream, Columns, Row) :-
    maplist(cell_text, Columns, Row, Texts),
    atomic_list_concat(Texts, Line),
    split_string(Line, "", " ", [Inside]),
    once(sub_string(Line, Indent, _, _, Inside)),
    format(Stream, '~t~*|~w~n', [Indent, Inside]).

cell_text(column(right, Width), Cell, Text) :-
    format(atom(Text), '  ~t~w~*|', [Cell, Width]).
cell_text(column(left, Width), Cell, Text) :-
    format(atom(Text), '  ~w~t~*|', [Cell, Width]).

%!  parameter_rows(+Study, +Given, -Rows) is det.
%
%   Rows are [Name, Value, Why], as text.

parameter_rows(Study, Given, Rows) :-
    parameters(Study, Given, Parameters),
    findall([Name, ValueText, WhyText],
            ( member(parameter(Name, Value, Why), Parameters),
              ( var(Value) -> ValueText = ''
              ; format(atom(ValueText), '~w', [Value]) ),
              why(Why, WhyText) ),
            Rows).

why(default, '') :- !.
why(derived, 'follows from others') :- !.
why(given, 'given by --set') :- !.
why(design, 'of what is sampled') :- !.
why(tuned(Why), Text) :- !,
    format(atom(Text), 'tuned after results were seen: ~w', [Why]).
why(Term, Text) :-                      % assumed(Why), printed(Where)
    compound(Term),
    Term =.. [Name, Why],
    !,
    format(atom(Text), '~w: ~w', [Name, Why]).
why(Why, Text) :- format(atom(Text), '~w', [Why]).
