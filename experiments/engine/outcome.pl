:- module(study_outcome,
          [ outcome/4,                  % +Study, +Cases, +Runs, -Outcome
            claim_outcomes/4            % +Study, +Runs, +Cases, -Claims
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(claims, [claim_found/4, claim_holds/3]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> What came out of the runs of a study

Runs are run(Case, Seed, Measures), Measures a dict.

*Threading*: pure.
*/

%!  outcome(+Study, +Cases, +Runs, -Outcome:dict) is det.
%
%   Outcome has
%
%     - `rows`: a list of row(Case, Count, Spreads), one for each case of
%       which there are runs; Spreads are
%       spread(Measure, Least, Median, Most) of measures that are numbers
%     - `claims`: see claim_outcomes/4

outcome(Study, Cases, Runs, outcome{rows:Rows, claims:Claims}) :-
    findall(Row, ( member(Case, Cases), row(Runs, Case, Row) ), Rows),
    claim_outcomes(Study, Runs, Cases, Claims).

row(Runs, Case, row(Case, Count, Spreads)) :-
    findall(Ms, ( member(run(Case1, _, Ms), Runs), Case1 == Case ), All),
    length(All, Count),
    Count > 0,
    findall(Name,
            ( member(Ms, All), get_dict(Name, Ms, V), number(V) ), Names0),
    sort(Names0, Names),
    findall(spread(Name, Least, Median, Most),
            ( member(Name, Names),
              findall(V, ( member(Ms, All), get_dict(Name, Ms, V),
                           number(V) ), Vs),
              spread(Vs, Least, Median, Most) ),
            Spreads).

%!  claim_outcomes(+Study, +Runs, +Cases, -Claims:list) is det.
%
%   Claims are claim(Text, Notes, Held, Of, OfMedians, Found): the claim held
%   in Held of Of seeds, and OfMedians (`true` or `false`) of the medians of
%   all runs; Found is what the medians were, as text.  Seeds of which a case
%   is missing are not counted.  A claim of which nothing is known does not
%   hold.

claim_outcomes(Study, Runs, Cases, Claims) :-
    seeds(Runs, Cases, Seeds),
    length(Seeds, Of),
    findall(Points, ( member(Seed, Seeds), seed_points(Runs, Seed, Points) ),
            PointLists),
    median_points(Runs, Cases, Medians),
    findall(Name, study_call(Study, vary(Name, _)), Names),
    findall(claim(Text, Notes, Held, Of, OfMedians, Found),
            ( study_call(Study, claim(Text, Notes, Test)),
              aggregate_all(count,
                            ( member(Points, PointLists),
                              \+ \+ claim_holds(Study:Test, Points, Points) ),
                            Held),
              truth(claim_holds(Study:Test, Medians, Medians), OfMedians),
              claim_found(Study:Test, Medians, Names, Found) ),
            Claims).

:- meta_predicate truth(0, -).

truth(Goal, true) :-
    \+ \+ call(Goal),
    !.
truth(_, false).

%   seeds(+Runs, +Cases, -Seeds): those of which all cases are there.

seeds(Runs, Cases, Seeds) :-
    length(Cases, Count),
    findall(Seed, member(run(_, Seed, _), Runs), Seeds0),
    sort(Seeds0, Seeds1),
    findall(Seed,
            ( member(Seed, Seeds1),
              aggregate_all(count, member(run(_, Seed, _), Runs), Count) ),
            Seeds).

seed_points(Runs, Seed, Points) :-
    findall(Case-Measures, member(run(Case, Seed, Measures), Runs), Points).

%   Measures that are no numbers are of a single run, and have no median.

median_points(Runs, Cases, Points) :-
    findall(Case-Measures,
            ( member(Case, Cases),
              row(Runs, Case, row(_, _, Spreads)),
              findall(Name-Median, member(spread(Name, _, Median, _), Spreads),
                      Pairs),
              dict_create(Measures, measures, Pairs) ),
            Points).
