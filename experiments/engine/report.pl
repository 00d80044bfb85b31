:- module(study_report,
          [ print_outcome/3,            % +Stream, +Study, +Outcome
            print_table/3,              % +Stream, +Header, +Rows
            outcome_save/4,             % +Study, +Outcome, +Runs, +Directory
            claims_sentence/2,          % +Outcomes, -Sentence
            parameter_rows/2,           % +Study, -Rows
            held_text/3                 % +Held, +Of, -Text
          ]).
:- use_module(library(apply), [foldl/4, maplist/3, maplist/4, partition/4]).
:- use_module(library(csv), [csv_write_file/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2]).
:- use_module(numbers, [number_text/2]).
:- use_module(studies, [study_call/2, study_parameters/2, study_title/3]).

/** <module> Tables for people, CSV for other programs

*Threading*: no state; any thread.
*/

%!  print_outcome(+Stream, +Study, +Outcome) is det.
%
%   A line for each case: medians, and from which to which; and a line for
%   each claim.

print_outcome(Stream, Study, Outcome) :-
    study_title(Study, Name, Title),
    format(Stream, '~n~w: ~w~n~n', [Name, Title]),
    varied(Study, Names),
    shown_measures(Study, Outcome.rows, Measures),
    findall(Cells, ( member(Row, Outcome.rows),
                     row_cells(Row, Names, Measures, Cells) ), Rows),
    append([Names, [runs], Measures], Header),
    print_table(Stream, Header, Rows),
    nl(Stream),
    forall(member(Claim, Outcome.claims), print_claim(Stream, Claim)).

varied(Study, Names) :-
    findall(Name, study_call(Study, vary(Name, _)), Names).

%   Those that have a label, if any has one.

shown_measures(Study, Rows, Measures) :-
    findall(Name, ( member(row(_, _, Spreads), Rows),
                    member(spread(Name, _, _, _), Spreads) ), Names0),
    sort(Names0, All),
    findall(Name, ( study_call(Study, label(Name, _)), memberchk(Name, All) ),
            Labelled),
    (   Labelled == []
    ->  Measures = All
    ;   Measures = Labelled
    ).

row_cells(row(Case, Count, Spreads), Names, Measures, Cells) :-
    maplist([Name, Text]>>( get_dict(Name, Case, Value),
                            format(atom(Text), '~w', [Value]) ),
            Names, Keys),
    maplist(spread_cell(Spreads), Measures, Values),
    append([Keys, [Count], Values], Cells).

spread_cell(Spreads, Measure, Cell) :-
    memberchk(spread(Measure, Least, Median, Most), Spreads),
    !,
    number_text(Median, Text),
    (   Least =:= Most
    ->  Cell = Text
    ;   number_text(Least, LeastText),
        number_text(Most, MostText),
        format(atom(Cell), '~w (~w-~w)', [Text, LeastText, MostText])
    ).
spread_cell(_, _, '').

print_claim(Stream, claim(Text, _, Held, Of, OfMedians, Found)) :-
    held_text(Held, Of, Word),
    (   OfMedians == true
    ->  Medians = ''
    ;   Medians = ' (not of the medians)'
    ),
    format(Stream, '  ~w~t~22|~w~w~n~22|~w~n', [Word, Text, Medians, Found]).

%!  held_text(+Held, +Of, -Text) is det.

held_text(_, 0, 'not known') :-
    !.
held_text(Of, Of, Text) :-
    !,
    ( Of =:= 1 -> Text = held ; format(atom(Text), 'held, ~d runs', [Of]) ).
held_text(0, _, 'DID NOT HOLD') :-
    !.
held_text(Held, Of, Text) :-
    format(atom(Text), 'held in ~d of ~d', [Held, Of]).

%!  claims_sentence(+Outcomes:list, -Sentence:atom) is det.
%
%   How many of the claims of all Outcomes held.

claims_sentence(Outcomes, Sentence) :-
    findall(claim(Text, Held, Of),
            ( member(Outcome, Outcomes),
              member(claim(Text, _, Held, Of, _, _), Outcome.claims) ),
            Claims),
    partition([claim(_, Of, Of)]>>( Of > 0 ), Claims, Held, Others),
    length(Claims, Count),
    length(Held, HeldCount),
    (   Others == []
    ->  format(atom(Sentence), 'All ~d claims held.', [Count])
    ;   Others = [claim(Text, _, Of)],
        Of =< 1
    ->  format(atom(Sentence), '1 of ~d claims did not hold: ~w.',
               [Count, Text])
    ;   format(atom(Sentence), '~d of ~d claims held in all runs.',
               [HeldCount, Count])
    ).

%!  print_table(+Stream, +Header, +Rows) is det.
%
%   Rows are lists of cells, as many as Header has.  The columns are right
%   aligned.

print_table(Stream, Header, Rows0) :-
    maplist(maplist(cell), [Header|Rows0], Lines),
    Lines = [First|Others],
    maplist(atom_length, First, Widths0),
    foldl(widen, Others, Widths0, Widths),
    forall(member(Line, Lines), print_row(Stream, Widths, Line)).

cell(Cell, Text) :-
    number(Cell),
    !,
    number_text(Cell, Text).
cell(Cell, Text) :-
    format(atom(Text), '~w', [Cell]).

widen(Line, Widths0, Widths) :-
    maplist(atom_length, Line, Lengths),
    maplist([A, B, C]>>( C is max(A, B) ), Widths0, Lengths, Widths).

print_row(Stream, Widths, Line) :-
    maplist(print_cell(Stream), Widths, Line),
    nl(Stream).

print_cell(Stream, Width, Text) :-
    Column is Width + 2,
    format(atom(Cell), '~t~w~*|', [Text, Column]),
    write(Stream, Cell).

%!  parameter_rows(+Study, -Rows) is det.
%
%   Rows are [Name, Value, Why], as text.

parameter_rows(Study, Rows) :-
    study_parameters(Study, Parameters),
    findall([Name, ValueText, WhyText],
            ( member(parameter(Name, Value, Why), Parameters),
              format(atom(ValueText), '~w', [Value]),
              why(Why, WhyText) ),
            Rows).

why(varied, 'varied') :- !.
why(default, '') :- !.
why(printed(Where), Text) :- !, format(atom(Text), 'thesis, ~w', [Where]).
why(assumed(Why), Text) :- !, format(atom(Text), 'assumed: ~w', [Why]).
why(chosen(Why), Text) :- !,
    format(atom(Text), 'chosen after results were seen: ~w', [Why]).
why(Why, Text) :- format(atom(Text), '~w', [Why]).

%!  outcome_save(+Study, +Outcome, +Runs, +Directory) is det.
%
%   Write runs.csv, claims.csv and parameters.csv.

outcome_save(Study, Outcome, Runs, Directory) :-
    varied(Study, Names),
    measured(Runs, Measures),
    findall(Row, run_row(Runs, Names, Measures, Row), RunRows),
    append([[seed], Names, Measures], Header),
    save_csv(Directory, 'runs.csv', Header, RunRows),
    findall([Text, Held, Of, OfMedians, Found, Notes],
            ( member(claim(Text, Notes0, Held, Of, OfMedians, Found),
                     Outcome.claims),
              format(atom(Notes), '~w', [Notes0]) ),
            ClaimRows),
    save_csv(Directory, 'claims.csv',
             [claim, held, of, of_medians, found, notes], ClaimRows),
    parameter_rows(Study, ParameterRows),
    save_csv(Directory, 'parameters.csv', [parameter, value, why],
             ParameterRows).

measured(Runs, Measures) :-
    findall(Name,
            ( member(run(_, _, Ms), Runs), get_dict(Name, Ms, V), number(V) ),
            Names),
    sort(Names, Measures).

run_row(Runs, Names, Measures, [Seed|Cells]) :-
    member(run(Case, Seed, Ms), Runs),
    maplist([Name, Text]>>( get_dict(Name, Case, V),
                            format(atom(Text), '~w', [V]) ), Names, Keys),
    maplist(csv_cell(Ms), Measures, Values),
    append(Keys, Values, Cells).

csv_cell(Ms, Name, Value) :-
    get_dict(Name, Ms, Value0),
    number(Value0),
    !,
    Value = Value0.
csv_cell(_, _, '').

save_csv(Directory, Name, Header, Rows) :-
    directory_file_path(Directory, Name, File),
    findall(Line, ( member(Row, [Header|Rows]), Line =.. [row|Row] ), Lines),
    csv_write_file(File, Lines).
