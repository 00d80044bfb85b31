:- module(study_expressions,
          [ context/2,                  % :Points, -Context
            selected/3,                 % +Where, +Context, -Selected
            line/3,                     % +P, +Context, -Line
            value/4,                    % +E, +Point, +Context, -Value
            of_all_points/1,            % +E
            aggregate/3,                % ?Term, -Function, -E
            on_line/4                   % ?Term, -Function, -E, -P
          ]).
:- use_module(library(apply),
              [exclude/3, include/3, maplist/2, maplist/3, partition/4]).
:- use_module(library(lists),
              [ append/3, last/2, max_list/2, member/2, memberchk/2,
                min_list/2, sum_list/2 ]).
:- use_module(library(pairs), 
              [group_pairs_by_key/2, pairs_keys_values/3, pairs_values/2]).
:- use_module(numbers, [median/2]).
:- use_module(statistics, [mean/2, rank_correlation/3]).

/** <module> Expressions in claims

Expressions are numbers, measures and parameters by their names, arithmetic
over expressions, and

  - at(Where, E): E for the case that differs from this point's by Where
  - sum(E), mean(E), median(E), least(E), most(E), number(E): over all
    points (of those that Where selects)
  - correlation(E1, E2): Spearman's rank correlation, over the same points
  - rise(E, along(P)), first(E, along(P)), last(E, along(P)): on the line
    through this point: the points that differ in P alone

A point is Case-Measures, two dicts, or Case-missing if the run of this case
was not made.  A context is context(Points, All, Follows): the points of the
test, all points that at/2 may select from, and the names of derived
parameters: cases that differ in one parameter may also differ in these.

An expression has a number as its value, or none, or `missing`: it needs a
measure of a run that was not made.

*Threading*: pure.
*/

:- meta_predicate
    context(:, -).

%!  context(:Points:list(pair), -Context) is det.
%
%   Context has All points; the module is the study.

context(M:All, context(All, All, Follows)) :-
    findall(Name, follows(M, All, Name), Follows).

%   A derived parameter follows from others, unless it was given a value: then
%   cases differ in it alone.

follows(M, All, Name) :-
    current_predicate(M:derive/3),
    clause(M:derive(Name, _, _), _),
    atom(Name),
    \+ varies_alone(Name, All).

varies_alone(Name, All) :-
    findall(Key-Value,
            ( member(Case-_, All), get_dict(Name, Case, Value),
              key([Name], Case, Key) ),
            Keys0),
    sort(Keys0, Keys),
    group_pairs_by_key(Keys, Groups),
    memberchk(_-[_, _|_], Groups).

%   key(+Names, +Case, -Key): Key is the same for cases that differ in Names
%   alone.

key(Names, Case, Key) :-
    dict_pairs(Case, _, Pairs),
    exclude(names(Names), Pairs, Key).

names(Names, Name-_) :-
    memberchk(Name, Names).

%!  selected(+Where:list, +Context, -Selected) is det.
%
%   Selected has the points of Context that satisfy Where, a list of
%   Name=Value.

selected(Where, context(Points0, All, Follows),
         context(Points, All, Follows)) :-
    include(is_where(Where), Points0, Points).

is_where(Where, Case-_) :-
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)).

%!  line(+P, +Context, -Line:list(pair)) is nondet.
%
%   Line has the points that differ in the parameter P alone, with their
%   values of P: in the order of these if they are numbers, else in the order of
%   Context.

line(P, context(Points, _, Follows), Line) :-
    findall(Key-(V-(Case-Measures)),
            ( member(Case-Measures, Points), get_dict(P, Case, V),
              key([P|Follows], Case, Key) ),
            Keyed0),
    keysort(Keyed0, Keyed),
    group_pairs_by_key(Keyed, Groups),
    member(_-Line0, Groups),
    partition(is_number, Line0, _, Others),
    (   Others == []
    ->  keysort(Line0, Line)
    ;   Line = Line0
    ).

is_number(Value-_) :-
    number(Value).

%!  value(+E, +Point, +Context, -Value) is semidet.
%
%   The expression E has the Value, a number or `missing`, at Point.  Fails if
%   it has none, for example after a division by zero.

value(Number, _, _, Value) :-
    number(Number),
    !,
    Value = Number.
value(Name, Case-Measures, _, Value) :-
    atom(Name),
    !,
    (   is_dict(Measures),
        get_dict(Name, Measures, Value)
    ->  number(Value)
    ;   get_dict(Name, Case, Value)
    ->  number(Value)
    ;   Measures == missing,
        Value = missing
    ).
value(at(Where, E), Case-_, context(_, All, Follows), Value) :-
    !,
    include(is_where(Where), All, Points),
    elsewhere(Where, Case, Points, Follows, Point),
    value(E, Point, context(Points, All, Follows), Value).
value(Aggregate, _, Context, Value) :-
    aggregate(Aggregate, Function, E),
    !,
    Context = context(Points, _, _),
    Points = [_|_],
    values(E, Points, Context, Values),
    of_known(Values, Function, Value).
value(correlation(E1, E2), _, Context, Value) :-
    !,
    Context = context(Points, _, _),
    findall(X-Y,
            ( member(Point, Points),
              value(E1, Point, Context, X),
              value(E2, Point, Context, Y) ),
            Pairs),
    pairs_keys_values(Pairs, Xs, Ys),
    append(Xs, Ys, All),
    (   memberchk(missing, All)
    ->  Value = missing
    ;   rank_correlation(Xs, Ys, Value)
    ).
value(OnLine, Case-_, Context, Value) :-
    on_line(OnLine, Function, E, P),
    !,
    Context = context(_, All, Follows),
    line(P, context(All, All, Follows), Line),
    memberchk(_-(Case-_), Line),
    pairs_values(Line, Points),
    values(E, Points, Context, Values),
    call(Function, Values, Value).
value(Term, Point, Context, Value) :-
    compound(Term),
    Term =.. [Function|Es],
    maplist(value_at(Point, Context), Es, Values),
    of_known(Values, result(Function), Value).

%   of_known(+Values, +Goal, -Value): call(Goal, Values, Value), if none of
%   Values is missing.

:- meta_predicate of_known(+, 2, -).

of_known(Values, _, Value) :-
    memberchk(missing, Values),
    !,
    Value = missing.
of_known(Values, Goal, Value) :-
    call(Goal, Values, Value).

result(Function, Values, Value) :-
    Expression =.. [Function|Values],
    catch(Value is Expression, error(evaluation_error(_), _), fail).

%!  of_all_points(+E) is semidet.
%
%   True if E has the same value for all points of a context: it consists of
%   numbers, aggregates and correlations.

of_all_points(E) :-
    number(E),
    !.
of_all_points(correlation(_, _)) :-
    !.
of_all_points(E) :-
    aggregate(E, _, _),
    !.
of_all_points(E) :-
    compound(E),
    current_arithmetic_function(E),
    E =.. [_|Es],
    maplist(of_all_points, Es).

value_at(Point, Context, E, Value) :-
    value(E, Point, Context, Value).

values(E, Points, Context, Values) :-
    findall(V, ( member(Point, Points), value(E, Point, Context, V) ), Values).

%   elsewhere(+Where, +Case, +Points, +Follows, -Point): Point is the point of
%   the case that differs by Where.  If there is no such case, Point has no
%   measures, only aggregates.

elsewhere(Where, Case, Points, Follows, Point) :-
    dict_create(Other, case, Where),
    exclude(is_said(Where), Follows, Free),
    key(Free, Case.put(Other), Key),
    (   member(Case1-Measures, Points),
        key(Free, Case1, Key)
    ->  Point = Case1-Measures
    ;   dict_pairs(Case2, case, Key),
        Point = Case2-_{}
    ).

is_said(Where, Name) :-
    memberchk(Name=_, Where).

%!  aggregate(?Term, -Function, -E) is semidet.
%!  on_line(?Term, -Function, -E, -P) is semidet.
%
%   Term is Function of the values that E has at several points.

aggregate(sum(E), sum, E).
aggregate(mean(E), mean, E).
aggregate(median(E), median, E).
aggregate(least(E), min_list, E).
aggregate(most(E), max_list, E).
aggregate(number(E), length, E).

on_line(rise(E, along(P)), rise, E, P).
on_line(first(E, along(P)), first, E, P).
on_line(last(E, along(P)), last, E, P).

:- public [sum/2, rise/2, first/2].

sum([V|Values], Sum) :-
    sum_list([V|Values], Sum).

rise([First|Values], Rise) :-
    last(Values, Last),
    of_known([Last,First], result(-), Rise).

first([Value|_], Value).
