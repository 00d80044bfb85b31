:- module(study_evidence,
          [ claim_comparisons/3,        % :Test, +OfSeeds, -Comparisons
            weakest/2,                  % +Comparisons, -P
            evidence_text/2             % +Comparisons, -Text
          ]).
:- use_module(library(apply), [exclude/3, maplist/4]).
:- use_module(library(lists), [append/3, last/2, max_list/2, member/2, memberchk/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_keys_values/3]).
:- use_module(claims, [connective/2, leaf/4]).
:- use_module(expressions, [context/2, line/3, selected/3, value/4]).
:- use_module(statistics, [holm/2, rank_test/5]).

/** <module> Rank tests of claims

A claim that compares cases is significant if the runs of one case tend to
have lower ranks than those of the other.  Each pair of cases that it compares
is tested, in the claimed direction, with the values of the compared
expression in all seeds; Holm's correction accounts for the number of pairs.

Claims that compare with a number, and claims with one run of each case, have
no comparisons.

*Threading*: pure.
*/

:- meta_predicate claim_comparisons(:, +, -).

%!  claim_comparisons(:Test, +OfSeeds:list, -Comparisons:list) is det.
%
%   OfSeeds are the points of each seed; those in which a compared run is
%   missing do not count.  Comparisons are comparison(A, B, E, Xs, Ys, U, P,
%   Adjusted): E, or one of its sides, has the values Xs in the case A, and Ys
%   in B; each for at least four seeds.

claim_comparisons(M:Test, OfSeeds, Comparisons) :-
    findall(Value, ( member(Points, OfSeeds),
                     seed_values(M:Test, Points, OfSeed),
                     member(Value, OfSeed) ),
            Values0),
    keysort(Values0, Values),
    group_pairs_by_key(Values, Groups),
    findall(Key-(Xs-Ys)-(U-P),
            ( member(Key-Pairs, Groups),
              pairs_keys_values(Pairs, Xs, Ys),
              Xs = [_, _, _, _|_],
              Key = key(_, _, _, Alternative),
              rank_test(Xs, Ys, Alternative, U, P) ),
            Tested0),
    once_each(Tested0, Tested),
    findall(P, member(_-(_-P), Tested), Ps),
    holm(Ps, Adjusted),
    maplist(comparison, Tested, Adjusted, Comparisons).

%   seed_values(:Test, +Points, -Values) is semidet: fails if a run is missing.

seed_values(M:Test, Points, Values) :-
    context(M:Points, Context),
    findall(Key-(X-Y), compared(Test, Context, Key, X, Y), Values),
    \+ ( member(_-(X-Y), Values), memberchk(missing, [X,Y]) ).

%   at/2 produces the same pair from several cases.

once_each([], []).
once_each([Test|Tests], [Test|Others]) :-
    Test = key(_, _, E, _)-Samples-_,
    exclude(same_samples(E, Samples), Tests, Rest),
    once_each(Rest, Others).

same_samples(E, Samples, key(_, _, E, _)-Samples-_).

comparison(key(A, B, E, _)-(Xs-Ys)-(U-P), Adjusted,
           comparison(A, B, E, Xs, Ys, U, P, Adjusted)).

%   compared(+Test, +Context, -Key, -X, -Y) is nondet: Key is key(A, B, E,
%   Alternative).

compared(at(Where, Test), Context0, Key, X, Y) :-
    !,
    selected(Where, Context0, Context),
    compared(Test, Context, Key, X, Y).
compared(\+ _, _, _, _, _) :-
    !,
    fail.
compared(Test, Context, Key, X, Y) :-
    connective(Test, Tests),
    !,
    member(One, Tests),
    compared(One, Context, Key, X, Y).
compared(Test, Context, key(A, B, E, Alternative), X, Y) :-
    leaf(Test, Relation, Where, Es),
    alternative(Relation, Alternative),
    sides(Where, Es, Context, A-X, B-Y, E).

alternative(<, less).
alternative(=<, less).
alternative(>, greater).
alternative(>=, greater).

%   sides(+Where, +Es, +Context, -AX, -BY, -E) is nondet: pairs Case-Value.

sides(points, [E1, E2], Context, Case-X, Case-Y, E1-E2) :-
    \+ number(E1),
    \+ number(E2),
    Context = context(Points, _, _),
    member(Point, Points),
    Point = Case-_,
    value(E1, Point, Context, X),
    value(E2, Point, Context, Y).
sides(against(P, V), [E], Context, A-X, B-Y, E) :-
    line(P, Context, Line),
    member(V-This, Line),
    member(W-Other, Line),
    W \== V,
    side(E, This, Context, A-X),
    side(E, Other, Context, B-Y).
sides(steps(P), [E], Context, AX, BY, E) :-
    along(P, E, Context, Values),
    append(_, [AX, BY|_], Values).
sides(ends(P), [E], Context, AX, BY, E) :-
    along(P, E, Context, [AX|Values]),
    last(Values, BY).

side(E, Point, Context, Case-Value) :-
    Point = Case-_,
    value(E, Point, Context, Value).

along(P, E, Context, Values) :-
    line(P, Context, Line),
    findall(Side, ( member(_-Point, Line), side(E, Point, Context, Side) ),
            Values).

%!  weakest(+Comparisons, -P:float) is semidet.
%
%   The greatest of the adjusted probabilities; fails if there are none.

weakest(Comparisons, P) :-
    findall(Q, member(comparison(_, _, _, _, _, _, _, Q), Comparisons), Qs),
    max_list(Qs, P).

%!  evidence_text(+Comparisons, -Text:atom) is semidet.
%
%   For people; fails if there are no comparisons.

evidence_text(Comparisons, Text) :-
    weakest(Comparisons, P),
    length(Comparisons, Count),
    p_text(P, PText),
    (   Count =:= 1
    ->  format(atom(Text), 'rank test: ~w', [PText])
    ;   format(atom(Text), 'rank tests, ~d pairs of cases: ~w',
               [Count, PText])
    ).

p_text(P, 'p < 0.0001') :-
    P < 0.0001,
    !.
p_text(P, Text) :-
    (   P < 0.001
    ->  Digits = 4
    ;   Digits = 3
    ),
    format(atom(Text), 'p = ~*f', [Digits, P]).
