:- module(study_outcome,
          [ outcome/4,                  % +Study, +Cases, +Runs, -Outcome
            case_numbers/4              % +Runs, +Case, +Measure, -Numbers
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(cases, [varied/3]).
:- use_module(claims, [claim_holds/2, claim_known/2]).
:- use_module(evidence, [claim_comparisons/3]).
:- use_module(found, [claim_found/4]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> Results of the runs of a study

*Threading*: pure.
*/

:- multifile
    prolog:message//1.

%!  outcome(+Study, +Cases, +Runs, -Outcome:dict) is det.
%
%   Runs are run(Case, Seed, Measures), Measures a dict.  Outcome has
%
%     - `names`: the parameters that vary
%     - `rows`: a list of row(Case, Count, Spreads), one for each case that has
%       runs; Spreads are spread(Measure, Least, Median, Most, Count) for
%       measures that are numbers in Count of them
%     - `claims`: a list of claim(Text, Notes, Held, Of, OfMedians, Found):
%       the claim held in Held of Of seeds, and OfMedians (`true` or `false`)
%       for the medians of all runs; Found are the medians, as text.
%       Seeds with a missing case do not count; Of is 0 if no seed has values
%       to compare.
%     - `tests`: a list of Text-Comparisons, the rank tests of each claim, see
%       claim_comparisons/3.

outcome(Study, Cases, Runs,
        outcome{names:Names, rows:Rows, claims:Claims, tests:Tests}) :-
    varied(Study, Cases, Names),
    findall(Row, ( member(Case, Cases), row(Runs, Case, Row) ), Rows),
    seeds(Runs, Cases, Seeds),
    findall(Points,
            ( member(Seed, Seeds),
              findall(Case-Ms, member(run(Case, Seed, Ms), Runs), Points) ),
            OfSeeds),
    median_points(Rows, Medians),
    findall(Claim, claim(Study, Names, OfSeeds, Medians, Claim), Claims),
    findall(Text-Comparisons, tested(Study, OfSeeds, Text, Comparisons), Tests).

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

%   seeds(+Runs, +Cases, -Seeds): the seeds that have runs of all cases.

seeds(Runs, Cases, Seeds) :-
    length(Cases, Count),
    findall(Seed, member(run(_, Seed, _), Runs), All),
    sort(All, Distinct),
    findall(Seed,
            ( member(Seed, Distinct),
              aggregate_all(count, member(run(_, Seed, _), Runs), Count) ),
            Seeds).

%   Measures that are not numbers belong to a single run, and have no median.

median_points(Rows, Points) :-
    findall(Case-Measures,
            ( member(row(Case, _, Spreads), Rows),
              findall(Name-Median,
                      member(spread(Name, _, Median, _, _), Spreads), Pairs),
              dict_create(Measures, measures, Pairs) ),
            Points).

claim(Study, Names, OfSeeds, Medians, claim(Text, Notes, Held, Of, M, Found)) :-
    study_call(Study, claim(Text, Notes, Test)),
    length(OfSeeds, Count),
    catch(( judged(Study:Test, Names, OfSeeds, Medians, Held, M, Found),
            counted(Study:Test, OfSeeds, Count, Of) ),
          error(Formal, Context),
          ( print_message(warning, study_claim(Text, error(Formal, Context))),
            t(Held, M, Found, Of)
            = t(0, false, 'a mistake in the claim', Count) )).

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

%   With given parameters there may be nothing to compare.

counted(Test, OfSeeds, Count, Of) :-
    (   member(Points, OfSeeds),
        claim_known(Test, Points)
    ->  Of = Count
    ;   Of = 0
    ).

judged(Test, Names, OfSeeds, Medians, Held, OfMedians, Found) :-
    aggregate_all(count,
                  ( member(Points, OfSeeds), claim_holds(Test, Points) ),
                  Held),
    (   claim_holds(Test, Medians)
    ->  OfMedians = true
    ;   OfMedians = false
    ),
    claim_found(Test, Medians, Names, Found).

prolog:message(study_claim(Text, Error)) -->
    [ 'Claim "~w": '-[Text] ],
    '$messages':translate_message(Error).
