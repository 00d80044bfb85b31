:- module(allocation_claims,
          [ allocation_claims/4         % +Figure, +Cases, +Data, -Claims
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(curves, [curve/5, values/4]).
:- use_module(mechanisms, [mechanism/2]).
:- use_module(statements, [statement/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [last/2, member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> Do the statements of the thesis hold of what was measured?

Of medians of the runs.  Where a mechanism has no value, as the interval of
back-offs without any, it is not compared; a statement that nothing is known
of does not hold.

*Threading*: pure.
*/

%!  allocation_claims(+Figure, +Cases, +Data, -Claims) is det.
%
%   Claims are for print_claims/2.  Cases are pairs X-Case; Data also has
%   the other cases that Figure is compared with, see allocation_curves.

allocation_claims(Figure, Cases, Data, [Ended|Claims]) :-
    ended(Data, Ended),
    findall(claim(Text, Held, Found),
            ( statement(Figure, Text, Test),
              judged(Test, Cases, Data, Held, Found) ),
            Claims).

ended(Data, claim('every run completed all its tasks before the limit',
                  Held, Found)) :-
    findall(Ended,
            ( member(_-Runs, Data), member(_-Result, Runs),
              memberchk(ended(Ended), Result) ),
            All),
    length(All, Count),
    aggregate_all(count, member(true, All), Good),
    verdict(( Good =:= Count, Count > 0 ), Held),
    format(atom(Found), '~d of ~d', [Good, Count]).

:- meta_predicate verdict(0, -).

verdict(Goal, Verdict) :-
    (   call(Goal)
    ->  Verdict = true
    ;   Verdict = false
    ).

judged(Test, Cases, Data, Held, Found) :-
    concerns(Test, Mechanisms, Measure),
    findall(Mechanism-Curve,
            ( member(Mechanism, Mechanisms),
              curve(Mechanism, Measure, Cases, Data, Curve) ),
            Curves),
    verdict(holds(Test, Curves, Cases, Data), Held),
    maplist(shown, Curves, Texts0),
    extra(Test, Cases, Data, Texts0, Texts),
    atomic_list_concat(Texts, '; ', Found).

concerns(least(M, Ms, Measure), [M|Ms], Measure).
concerns(most(M, Ms, Measure), [M|Ms], Measure).
concerns(steeper(M1, M2, Measure), [M1, M2], Measure).
concerns(same_rise(M1, M2, Measure, _), [M1, M2], Measure).
concerns(grows(M, Measure), [M], Measure).
concerns(falls(M, Measure), [M], Measure).
concerns(lower_at_last(M, Measure), [M], Measure).
concerns(last_below(M, Measure, _), [M], Measure).
concerns(last_above(M, Measure, _), [M], Measure).
concerns(first_near(M, Measure, _, _), [M], Measure).
concerns(compared(M, Measure, _, _), [M], Measure).
concerns(last_below_other(_, Measure), [proposed], Measure).

                /*******************************
                *             TESTS            *
                *******************************/

%   holds(+Test, +Curves, +Cases, +Data) is semidet.

holds(least(M, Ms, _), Curves, _, _) :-
    memberchk(M-Curve, Curves),
    forall(member(Other, Ms),
           ( memberchk(Other-Others, Curves), throughout(<, Curve, Others) )).
holds(most(M, Ms, _), Curves, _, _) :-
    memberchk(M-Curve, Curves),
    forall(member(Other, Ms),
           ( memberchk(Other-Others, Curves), throughout(>, Curve, Others) )).
holds(steeper(_, _, _), [_-Curve1, _-Curve2], _, _) :-
    rise(Curve1, Rise1),
    rise(Curve2, Rise2),
    Rise1 > Rise2.
holds(same_rise(_, _, _, Most), [_-Curve1, _-Curve2], _, _) :-
    rise(Curve1, Rise1),
    rise(Curve2, Rise2),
    Rise1 > 0,
    Rise2 > 0,
    Rise1 =< Most*Rise2,
    Rise2 =< Most*Rise1.
holds(grows(_, _), [_-Curve], _, _) :-
    ordered(<, Curve).
holds(falls(_, _), [_-Curve], _, _) :-
    ordered(>, Curve).
holds(lower_at_last(_, _), [_-Curve], _, _) :-
    rise(Curve, Rise),
    Rise < 0.
holds(last_below(_, _, Most), [_-Curve], _, _) :-
    last(Curve, _-Value),
    Value < Most.
holds(last_above(_, _, Least), [_-Curve], _, _) :-
    last(Curve, _-Value),
    Value > Least.
holds(first_near(_, _, Wanted, Most), [_-[_-Value|_]], _, _) :-
    abs(Value - Wanted) =< Most.
holds(compared(M, Measure, Least, Most), [_-Curve], Cases, Data) :-
    last(Curve, _-Value),
    other(M, Measure, Cases, Data, Other),
    Value >= Least*Other,
    Value =< Most*Other.
holds(last_below_other(M, Measure), [_-Curve], Cases, Data) :-
    last(Curve, _-Value),
    other(M, Measure, Cases, Data, Other),
    Value < Other.

%   throughout(+Order, +Curve1, +Curve2): wherever both have a value, and
%   there is such a place.

throughout(Order, Curve1, Curve2) :-
    findall(A-B, ( member(X-A, Curve1), memberchk(X-B, Curve2) ), Pairs),
    Pairs = [_|_],
    forall(member(A-B, Pairs), compares(Order, A, B)).

compares(<, A, B) :-
    A < B.
compares(>, A, B) :-
    A > B.

ordered(Order, Curve) :-
    pairs_values(Curve, [Value, Next|Values]),
    ordered_values([Value, Next|Values], Order).

ordered_values([_], _).
ordered_values([A, B|Values], Order) :-
    compares(Order, A, B),
    ordered_values([B|Values], Order).

rise([_-First|Curve], Rise) :-
    last(Curve, _-Last),
    Rise is Last - First.

%   other(+Mechanism, +Measure, +Cases, +Data, -Median): of the case of
%   Mechanism in Data that is not one of Cases.

other(M, Measure, Cases, Data, Median) :-
    member(Case-_, Data),
    Case = case(M, _, _, _, _, _),
    \+ memberchk(_-Case, Cases),
    values(Measure, Case, Data, Values),
    median(Values, Median),
    !.

                /*******************************
                *             TEXT             *
                *******************************/

shown(Mechanism-Curve, Text) :-
    mechanism(Mechanism, Title),
    pairs_values(Curve, Values),
    maplist(number_text, Values, Numbers),
    atomic_list_concat([Title|Numbers], ' ', Text).

extra(compared(M, Measure, _, _), Cases, Data, Texts0, Texts) :-
    !,
    against(M, Measure, Cases, Data, Texts0, Texts).
extra(last_below_other(M, Measure), Cases, Data, Texts0, Texts) :-
    !,
    against(M, Measure, Cases, Data, Texts0, Texts).
extra(_, _, _, Texts, Texts).

against(M, Measure, Cases, Data, [Text0], [Text]) :-
    (   other(M, Measure, Cases, Data, Median)
    ->  number_text(Median, Other)
    ;   Other = nothing
    ),
    mechanism(M, Title),
    format(atom(Text), '~w, against ~w of ~w', [Text0, Other, Title]).

number_text(Number, Text) :-
    (   Number >= 100
    ->  Rounded is round(Number),
        format(atom(Text), '~D', [Rounded])
    ;   format(atom(Text), '~2f', [Number])
    ).
