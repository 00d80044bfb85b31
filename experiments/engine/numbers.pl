:- module(study_numbers,
          [ median/2,                   % +Numbers, -Median
            spread/4,                   % +Numbers, -Least, -Median, -Most
            spread_text/4,              % +Least, +Median, +Most, -Text
            number_text/2              % +Number, -Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [last/2, nth0/3]).

/** <module> Numbers of several runs

*Threading*: pure.
*/

%!  median(+Numbers:list(number), -Median:number) is semidet.
%
%   Median is the middle number, or the mean of the two middle numbers.
%   Fails for an empty list.

median(Numbers, Median) :-
    msort(Numbers, Sorted),
    length(Sorted, Count),
    Count > 0,
    Low is (Count - 1) // 2,
    High is Count // 2,
    nth0(Low, Sorted, A),
    nth0(High, Sorted, B),
    (   Low =:= High
    ->  Median = A
    ;   Median is (A + B)/2
    ).

%!  spread(+Numbers:list(number), -Least, -Median, -Most) is semidet.

spread(Numbers, Least, Median, Most) :-
    median(Numbers, Median),
    sort(0, @=<, Numbers, Sorted),
    Sorted = [Least|_],
    last(Sorted, Most).

%!  spread_text(+Least, +Median, +Most, -Text:atom) is det.
%
%   As 12 (10-14), or 12 if all numbers are equal.

spread_text(Least, Median, Most, Text) :-
    Least =:= Most,
    !,
    number_text(Median, Text).
spread_text(Least, Median, Most, Text) :-
    maplist(number_text, [Median, Least, Most], Texts),
    format(atom(Text), '~w (~w\u2013~w)', Texts).

%!  number_text(+Number, -Text:atom) is det.
%
%   Rounded to the digits that matter: 12,345  104.5  0.042.

number_text(Number, Text) :-
    number(Number),
    !,
    Size is abs(Number),
    number_text(Size, Number, Text).
number_text(Other, Text) :-
    format(atom(Text), '~w', [Other]).

number_text(Size, _, '0') :-
    Size =:= 0,
    !.
number_text(Size, Number, Text) :-
    ( integer(Number) ; Size >= 1000 ),
    !,
    Rounded is round(Number),
    format(atom(Text), '~D', [Rounded]).
number_text(Size, Number, Text) :-
    digits(Size, Digits),
    format(atom(Text), '~*f', [Digits, Number]).

digits(Size, 1) :- Size >= 10, !.
digits(Size, 2) :- Size >= 0.1, !.
digits(_, 3).
