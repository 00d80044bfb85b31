:- module(sync_saying,
          [ in_runs/4,                  % +Runs, :Test, -Held, -Found
            truth/2,                    % :Goal, -Truth
            line/3,                     % +Data, +Name, -Pairs
            all_runs/2,                 % +Pairs, -Runs
            measured/3,                 % +Pairs, +Measure, -Values
            medians/3,                  % +Pairs, +Measure, -Medians
            claim_held/2,               % +Run, +Text
            at_most/3,                  % +Measure, +Most, +Run
            falling/1,                  % +Numbers
            not_rising/1,               % +Numbers
            near/2,                     % +Number, +Printed
            seconds/2,                  % +Numbers, -Text
            decimals/2,                 % +Numbers, -Texts
            text/3                      % +Format, +Arguments, -Text
          ]).
:- use_module('../../lib/chart', [median/2]).
:- use_module(library(apply), [include/3, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> What statements about several runs are made of

Data is as in statements/3; Pairs are pairs Key-Runs or X-Runs.

*Threading*: pure.
*/

:- meta_predicate
    in_runs(+, 1, -, -),
    truth(0, -).

%!  in_runs(+Runs, :Test, -Held, -Found) is det.
%
%   Held is `true` if Test is true of every one of Runs, otherwise `false`.
%   Found says of how many it is.

in_runs(Runs, Test, Held, Found) :-
    include(Test, Runs, Good),
    length(Runs, Count),
    length(Good, GoodCount),
    truth(GoodCount =:= Count, Held),
    text('in ~d of ~d runs', [GoodCount, Count], Found).

%!  truth(:Goal, -Truth) is det.
%
%   Truth is `true` or `false`.

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).

%!  line(+Data, +Name, -Pairs) is semidet.
%
%   Pairs are the pairs X-Runs of the line Name, in order.  Fails where
%   there are none.

line(Data, Name, Pairs) :-
    findall(X-Runs, member(Name-X-Runs, Data), Pairs),
    Pairs = [_|_].

%!  all_runs(+Pairs, -Runs) is det.

all_runs(Pairs, Runs) :-
    findall(Run, ( member(_-Some, Pairs), member(Run, Some) ), Runs).

%!  measured(+Pairs, +Measure, -Values) is det.
%!  medians(+Pairs, +Measure, -Medians) is semidet.
%
%   What the runs gave for Measure, a name: all values, or the median of
%   each pair.

measured(Pairs, Measure, Values) :-
    Term =.. [Measure, Value],
    findall(Value, ( member(_-Runs, Pairs), member(Run, Runs),
                     memberchk(Term, Run) ), Values).

medians(Pairs, Measure, Medians) :-
    maplist(median_of(Measure), Pairs, Medians).

median_of(Measure, Pair, Median) :-
    measured([Pair], Measure, Values),
    median(Values, Median).

%!  claim_held(+Run, +Text) is semidet.
%
%   The claim Text about Run by itself held.

claim_held(Run, Text) :-
    memberchk(claims(Claims), Run),
    memberchk(claim(Text, true, _), Claims).

%!  at_most(+Measure, +Most, +Run) is semidet.

at_most(Measure, Most, Run) :-
    Term =.. [Measure, Value],
    memberchk(Term, Run),
    Value =< Most.

%!  falling(+Numbers) is semidet.
%!  not_rising(+Numbers) is semidet.
%
%   Each is less than the one before; or no greater.

falling([_]).
falling([A, B|Rest]) :-
    A > B,
    falling([B|Rest]).

not_rising([_]).
not_rising([A, B|Rest]) :-
    A >= B,
    not_rising([B|Rest]).

%!  near(+Number, +Printed) is semidet.
%
%   Within a factor of two of what the thesis prints.

near(X, Printed) :-
    X >= Printed / 2,
    X =< Printed * 2.

%!  seconds(+Numbers, -Text) is det.
%!  decimals(+Numbers, -Texts) is det.

seconds(Numbers, Text) :-
    maplist([N, T]>>text('~1f', [N], T), Numbers, Texts),
    atomic_list_concat(Texts, ', ', Joined),
    text('~w s', [Joined], Text).

decimals(Numbers, Texts) :-
    maplist([N, T]>>text('~2f', [N], T), Numbers, Texts).

%!  text(+Format, +Arguments, -Text:atom) is det.

text(Format, Arguments, Text) :-
    format(atom(Text), Format, Arguments).
