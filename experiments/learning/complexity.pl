:- module(learning_complexity,
          [ exhaustive_search/3,        % +Actions, +Vectors, -Beta
            sharing_time/3,             % +Agents, +Time, -Total
            shared_search/4,            % +Beta, +Agents, +Time, -Gamma
            digits/2                    % +Number, -Count
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).

/** <module> Bounds of the time in which agents learn a path

Section 4.3.6 of the thesis.  All numbers are exact: the bounds of its maze have
some 7,000 digits.

*Threading*: pure.
*/

%!  exhaustive_search(+Actions:integer, +Vectors:integer, -Beta:integer) is det.
%
%   β, the upper bound: how many sequences of Actions there are, of lengths from
%   1 to Vectors - 1.  A maze of n x n cells has S·n² sensor vectors, S of each
%   cell.
%
%   @error type_error(Type, X)

exhaustive_search(Actions, Vectors, Beta) :-
    must_be(positive_integer, Actions),
    must_be(positive_integer, Vectors),
    (   Actions =:= 1
    ->  Beta is Vectors - 1
    ;   Beta is (Actions**Vectors - Actions) // (Actions - 1)
    ).

%!  sharing_time(+Agents:integer, +Time:rational, -Total:rational) is det.
%
%   How long it takes until each of Agents has shared with each other one, if two
%   take Time.  Of an even number half as many pairs share at once.  Of an odd
%   number one shares alone, after the others, as the thesis counts; in as many
%   rounds as agents each could rest once.
%
%   @error type_error(Type, X)

sharing_time(Agents, Time, Total) :-
    must_be(positive_integer, Agents),
    must_be(rational, Time),
    (   Agents mod 2 =:= 0
    ->  rounds(Agents, Rounds)
    ;   Even is Agents - 1,
        rounds(Even, Rounds0),
        Rounds is Rounds0 + Agents - 1
    ),
    Total is Rounds*Time.

%   All pairs, half as many at a time as there are agents.

rounds(0, 0) :-
    !.
rounds(Agents, Rounds) :-
    Pairs is Agents*(Agents - 1) // 2,
    Rounds is 2*Pairs // Agents.

%!  shared_search(+Beta:rational, +Agents:integer, +Time, -Gamma:rational)
%!      is det.
%
%   γ, the lower bound: Agents divide the work Beta, without redundance, and
%   share all they know.
%
%   @error type_error(Type, X)

shared_search(Beta, Agents, Time, Gamma) :-
    must_be(rational, Beta),
    sharing_time(Agents, Time, Sharing),
    Gamma is Beta rdiv Agents + Sharing.

%!  digits(+Number:rational, -Count:integer) is det.
%
%   Count is the number of digits of the integer part of Number, at least 1.
%
%   @error domain_error(nonneg, Number)

digits(Number, Count) :-
    must_be(rational, Number),
    (   Number >= 0
    ->  true
    ;   domain_error(nonneg, Number)
    ),
    Whole is truncate(Number),
    number_codes(Whole, Codes),
    length(Codes, Count).
