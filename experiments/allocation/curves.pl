:- module(allocation_curves,
          [ values/4,                   % +Measure, +Case, +Data, -Values
            curve/5                     % +Mechanism, +Measure, +Cases, +Data,
                                        % -Curve
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(metrics, [measure/3]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> Measures of several runs of each case

Data are pairs Case-Runs, Runs being pairs Seed-Result of allocation_run/3.
Only runs that ended before their limit count here.

*Threading*: pure.
*/

%!  values(+Measure, +Case, +Data, -Values:list(number)) is det.
%
%   What the runs of Case gave; a run may have none, as the interval of
%   back-offs where there was no back-off.  Measure is that of measure/3, or
%   `rate`: the time by the robots that an allocator requires.

values(Measure, Case, Data, Values) :-
    findall(Value,
            ( member(Case-Runs, Data),
              member(_-Result, Runs),
              memberchk(ended(true), Result),
              value(Measure, Case, Result, Value) ),
            Values).

value(rate, case(_, _, _, _, Required, _), Result, Value) :-
    !,
    measure(time, Result, Time),
    Value is Time/Required.
value(Measure, _, Result, Value) :-
    measure(Measure, Result, Value).

%!  curve(+Mechanism, +Measure, +Cases, +Data, -Curve:list(pair)) is det.
%
%   Curve is X-Median, in the order of X, of those Cases, pairs X-Case, that
%   are of Mechanism and have any value.

curve(Mechanism, Measure, Cases, Data, Curve) :-
    findall(X-Median,
            ( member(X-Case, Cases),
              Case = case(Mechanism, _, _, _, _, _),
              values(Measure, Case, Data, Values),
              median(Values, Median) ),
            Curve0),
    sort(1, @<, Curve0, Curve).
