:- module(study_outcome,
          [ outcome/4,                  % +Plan, +Seeds, +Runs, -Outcome
            seed_points/4,              % +Cases, +Runs, +Seed, -Points
            case_numbers/4              % +Runs, +Case, +Measure, -Numbers
          ]).
:- use_module(library(apply), [exclude/3, include/3, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(cases, [expected_cases/3, varied/3]).
:- use_module(claims, [claim_verdict/3]).
:- use_module(evidence, [claim_comparisons/3]).
:- use_module(found, [claim_found/4]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> Results of the runs of a study

*Threading*: pure.
*/

:- multifile
    prolog:message//1.

%!  outcome(+Plan, +Seeds, +Runs, -Outcome:dict) is det.
%
%   Runs, of the seeds Seeds of Plan, are run(Case, Seed, Measures), Measures a
%   dict.  Outcome has
%
%     - `names`: the parameters that vary
%     - `seeds`: the number of seeds
%     - `missing`: the number of runs that were planned and are missing
%     - `rows`: a list of row(Case, Count, Spreads), one for each case that has
%       runs; Spreads are spread(Measure, Least, Median, Most, Count) for
%       measures that are numbers in Count of them
%     - `claims`: a list of claim(Text, Notes, Held, Of, OfMedians, Found):
%       the claim held in Held of the Of seeds for which it is known, and
%       OfMedians (`true`, `false` or `unknown`) for the medians of all runs;
%       Found are the medians, as text.
%     - `tests`: a list of Text-Comparisons, the rank tests of each claim, see
%       claim_comparisons/3.
%
%   The claims are about all of expected_cases/3: a run that was not made is a
%   missing point, and a case that lacks a run of a seed has no median.

outcome(plan(Study, Given, Cases), Seeds, Runs,
        outcome{names:Names, seeds:SeedCount, missing:Missing, rows:Rows,
                claims:Claims, tests:Tests}) :-
    varied(Study, Cases, Names),
    findall(Row, ( member(Case, Cases), row(Runs, Case, Row) ), Rows),
    maplist(length, [Seeds, Cases, Runs], [SeedCount, CaseCount, RunCount]),
    Missing is SeedCount*CaseCount - RunCount,
    expected_cases(Study, Given, Expected),
    findall(Points, ( member(Seed, Seeds),
                      seed_points(Expected, Runs, Seed, Points) ), OfSeeds),
    points(Expected, median(Rows, 1), Found),
    points(Expected, median(Rows, SeedCount), Medians),
    findall(Claim, claim(Study, Names, OfSeeds, Medians, Found, Claim), Claims),
    findall(Text-Comparisons, tested(Study, OfSeeds, Text, Comparisons), Tests).

%!  seed_points(+Cases, +Runs, +Seed, -Points:list(pair)) is det.
%
%   Points are those of claim_verdict/3 for the runs with Seed.

seed_points(Cases, Runs, Seed, Points) :-
    findall(Case-Ms, member(run(Case, Seed, Ms), Runs), OfSeed),
    points(Cases, of_case(OfSeed), Points).

:- meta_predicate points(+, 2, -).

points(Cases, Measured, Points) :-
    findall(Case-Measures,
            ( member(Case, Cases),
              (   call(Measured, Case, Measures0)
              ->  Measures = Measures0
              ;   Measures = missing
              ) ),
            Points).

of_case(Points, Case, Measures) :-
    member(Case1-Measures, Points),
    Case1 == Case.

%   Measures that are not numbers belong to a single run, and have no median.

median(Rows, Least, Case, Measures) :-
    member(row(Case1, Count, Spreads), Rows),
    Case1 == Case,
    Count >= Least,
    findall(Name-Median, member(spread(Name, _, Median, _, _), Spreads), Pairs),
    dict_create(Measures, measures, Pairs).

row(Runs, Case, row(Case, Count, Spreads)) :-
    findall(Ms, ( member(run(Case1, _, Ms), Runs), Case1 == Case ), All),
    length(All, Count),
    Count > 0,
    findall(Name-Value,
            ( member(Ms, All), get_dict(Name, Ms, Value), number(Value) ),
            Values),
    findall(Name, member(Name-_, Values), Names0),
    sort(Names0, Names),
    findall(spread(Name, Least, Median, Most, Number),
            ( member(Name, Names),
              findall(Value, member(Name-Value, Values), Vs),
              length(Vs, Number),
              spread(Vs, Least, Median, Most) ),
            Spreads).

claim(Study, Names, OfSeeds, Medians, FoundMedians,
      claim(Text, Notes, Held, Of, OfMedians, Found)) :-
    study_call(Study, claim(Text, Notes, Test)),
    catch(( maplist(claim_verdict(Study:Test), OfSeeds, Verdicts),
            claim_verdict(Study:Test, Medians, OfMedians),
            claim_found(Study:Test, FoundMedians, Names, Found),
            counted(Verdicts, Held, Of) ),
          error(Formal, Context),
          ( print_message(warning, study_claim(Text, error(Formal, Context))),
            t(Held, OfMedians, Found) = t(0, false, 'a mistake in the claim'),
            length(OfSeeds, Of) )).

counted(Verdicts, Held, Of) :-
    exclude(==(unknown), Verdicts, Known),
    include(==(true), Known, True),
    maplist(length, [True, Known], [Held, Of]).

%   A mistake in a claim has been reported when the claim was evaluated.

tested(Study, OfSeeds, Text, Comparisons) :-
    study_call(Study, claim(Text, _, Test)),
    catch(claim_comparisons(Study:Test, OfSeeds, Comparisons), error(_, _),
          fail).

%!  case_numbers(+Runs, +Case, +Measure, -Numbers:list(number)) is det.
%
%   The values of Measure in the runs of Case in which it is a number.

case_numbers(Runs, Case, Measure, Numbers) :-
    findall(Value,
            ( member(run(Case1, _, Ms), Runs),
              Case1 == Case,
              get_dict(Measure, Ms, Value),
              number(Value) ),
            Numbers).

prolog:message(study_claim(Text, Error)) -->
    [ 'Claim "~w": '-[Text] ],
    '$messages':translate_message(Error).
