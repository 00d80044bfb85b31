:- module(study_cross_check,
          [ real_case/5,                % +Study, +Cases, +Changes, -Case, -Real
            cross_check/4,              % +Runs, +Ways, +Measures, -Table
            claims_check/5              % +Study, +Points, +Case, +Ways, -Table
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(claims, [claim_verdict/3]).
:- use_module(numbers, [spread/4, spread_text/4]).
:- use_module(studies, [study_call/2]).

/** <module> Comparison of real runs with runs in virtual time

real(Where, Settings) of a study selects the case that is run in several ways,
and the clock and the number of processes of the real run.  A measure of a real
run should be between the least and the greatest value of the virtual runs.

*Threading*: pure.
*/

%!  real_case(+Study, +Cases, +Changes:list, -Case, -Real) is semidet.
%
%   Real is Case, the case that Study selects, on a real clock, with Changes.

real_case(Study, Cases, Changes, Case, Real) :-
    study_call(Study, real(Where, Settings)),
    member(Case, Cases),
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)),
    !,
    dict_create(Set, case, Settings),
    dict_create(Changed, case, Changes),
    Real = Case.put(Set).put(Changed).

%!  cross_check(+Runs:list, +Ways:list, +Measures:list, -Table) is det.
%
%   Runs are dicts of measures; Ways are pairs Title-RealRuns.  Table is
%   table(Header, Rows) with a row for each of Measures that is a number: its
%   values in Runs, and in each of Ways, with a verdict.

cross_check(Runs, Ways, Measures, table([measure, virtual|Titles], Rows)) :-
    findall(Title, ( member(Way-_, Ways), member(Title, [Way, verdict]) ),
            Titles),
    findall([Measure, Virtual|Cells],
            ( member(Measure, Measures),
              measured(Measure, Runs, Least, _, Most, Virtual),
              findall(Cell,
                      ( member(_-RealRuns, Ways),
                        compared(Measure, RealRuns, Least, Most, Cell) ),
                      Cells) ),
            Rows).

measured(Measure, Runs, Least, Median, Most, Text) :-
    values(Measure, Runs, Values),
    spread(Values, Least, Median, Most),
    spread_text(Least, Median, Most, Text).

%   compared(+Measure, +Runs, +Least, +Most, -Cell): two cells.

compared(Measure, Runs, Least, Most, Cell) :-
    measured(Measure, Runs, _, Median, _, Text),
    !,
    verdict(Least, Most, Median, Verdict),
    member(Cell, [Text, Verdict]).
compared(_, _, _, _, Cell) :-
    member(Cell, ['', '']).

values(Measure, Runs, Values) :-
    findall(Value,
            ( member(Run, Runs), get_dict(Measure, Run, Value),
              number(Value) ),
            Values),
    Values \== [].

verdict(Least, Most, Real, inside) :-
    Least =< Real,
    Real =< Most,
    !.
verdict(Least, _, Real, below) :-
    Real < Least,
    !.
verdict(_, _, _, above).

%!  claims_check(+Study, +Points:list, +Case, +Ways:list, -Table) is det.
%
%   Points are lists Seed-Points, as of claim_verdict/3, for the virtual runs of
%   each seed; Ways are pairs Title-Seeds, Seeds a list of pairs of a seed and
%   the measures of Case in that way.  Table has a row for each claim of Study
%   that is not known without Case: for how many seeds it holds in virtual time,
%   and with the measures of each way in place of those of Case.

claims_check(Study, Points, Case, Ways, table([claim|Titles], Rows)) :-
    findall(Title, member(Title-_, Ways), Titles),
    findall([Claim|Cells],
            ( study_call(Study, claim(Text, _, Test)),
              format(atom(Claim), '"~w"', [Text]),
              depends(Study:Test, Points, Case),
              findall(Cell, ( member(_-Seeds, Ways),
                              held(Study:Test, Points, Case, Seeds, Cell) ),
                      Cells) ),
            Rows).

depends(Test, Points, Case) :-
    member(_-OfSeed, Points),
    with_measures(OfSeed, Case, missing, Without),
    holds(Test, Without, unknown),
    \+ holds(Test, OfSeed, unknown),
    !.

held(Test, Points, Case, Seeds, Cell) :-
    findall(Verdict,
            ( member(Seed-Measures, Seeds),
              memberchk(Seed-OfSeed, Points),
              with_measures(OfSeed, Case, Measures, With),
              holds(Test, With, Verdict) ),
            Verdicts),
    aggregate_all(count, member(true, Verdicts), Held),
    aggregate_all(count, ( member(V, Verdicts), V \== unknown ), Of),
    format(atom(Cell), '~d of ~d', [Held, Of]).

with_measures(Points, Case, Measures, With) :-
    append(Before, [Case1-_|After], Points),
    Case1 == Case,
    !,
    append(Before, [Case-Measures|After], With).

%   A mistake in a claim is reported with the results of the study.

holds(Test, Points, Verdict) :-
    catch(claim_verdict(Test, Points, Verdict), error(_, _), Verdict = unknown).
