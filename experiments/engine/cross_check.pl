:- module(study_cross_check,
          [ real_case/4,                % +Study, +Cases, -Case, -Real
            cross_check/4               % +Runs, +RealRuns, +Measures, -Rows
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(numbers, [spread/4, spread_text/4]).
:- use_module(studies, [study_call/2]).

/** <module> Comparison of runs on real sockets with runs in virtual time

real(Where, Settings) of a study selects the case that is run both ways, and
the clock and the number of processes of the real run.  A measure of a real run
should be between the least and the greatest value of the virtual runs.

*Threading*: pure.
*/

%!  real_case(+Study, +Cases, -Case, -Real) is semidet.
%
%   Real is Case, the case that Study selects, on a real clock.

real_case(Study, Cases, Case, Real) :-
    study_call(Study, real(Where, Settings)),
    member(Case, Cases),
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)),
    !,
    dict_create(Changes, case, Settings),
    Real = Case.put(Changes).

%!  cross_check(+Runs:list, +RealRuns:list, +Measures:list, -Rows) is det.
%
%   Runs and RealRuns are dicts of measures.  Rows are [Measure, Virtual,
%   Real, Verdict], as text, for the measures that are numbers.

cross_check(Runs, RealRuns, Measures, Rows) :-
    findall([Measure, Virtual, Real, Verdict],
            ( member(Measure, Measures),
              values(Measure, Runs, Values),
              values(Measure, RealRuns, RealValues),
              spread(Values, Least, Median, Most),
              spread_text(Least, Median, Most, Virtual),
              spread(RealValues, RealLeast, RealMedian, RealMost),
              spread_text(RealLeast, RealMedian, RealMost, Real),
              verdict(Least, Most, RealMedian, Verdict) ),
            Rows).

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
