:- module(study_claims,
          [ claim_holds/3,              % :Test, +Points, +All
            claim_found/4,              % :Test, +Points, +Names, -Text
            claim_shape/2               % :Test, -Problem
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, include/3, maplist/2, maplist/3]).
:- use_module(library(lists),
              [ append/3, last/2, max_list/2, member/2, memberchk/2,
                min_list/2, sum_list/2
              ]).
:- use_module(numbers, [median/2, number_text/2]).

/** <module> Claims are terms

A claim is a test over points: Case-Measures, two dicts, one point for each
case.  Tests are

  - A < B, =<, >, >=, =:=, =\=: of every point at which both sides have a
    value, of which there is at least one
  - near(E, Value, Within), between(E, Least, Most): likewise
  - rises(E, along(P)), falls(E, along(P)): strictly, from each value of
    the parameter P to the next, on every line: the points that differ in
    nothing else
  - rises(E, along(P), ends), falls(E, along(P), ends): from first to last
  - least(E, P=V), most(E, P=V): with this value less (more) than with any
    other, all else equal
  - at(Where, Test): of the points at which it is as Where, a list of
    Name=Value, says
  - some(Test): of at least one point
  - (A, B), (A ; B), \+ A
  - holds(Goal): call(Goal, Points) in the study, for what is not said
    with these words

Expressions E are numbers, measures and parameters by their names,
arithmetic over expressions, and

  - at(Where, E): where the case differs from this point's as Where says
  - sum(E), mean(E), median(E), least(E), most(E), number(E): over all
    points (of those that Where selects)
  - rise(E, along(P)), first(E, along(P)), last(E, along(P)): of the line
    through this point

*Threading*: pure.
*/

:- meta_predicate
    claim_holds(:, +, +),
    claim_found(:, +, +, -),
    claim_shape(:, -).

%!  claim_holds(:Test, +Points:list(pair), +All:list(pair)) is semidet.
%
%   Points are those looked at, All those that at/2 may select from.

claim_holds(M:Test, Points, All) :-
    holds(Test, context(M, Points, All)).

holds((A, B), Context) :-
    !,
    holds(A, Context),
    holds(B, Context).
holds((A ; B), Context) :-
    !,
    (   holds(A, Context)
    ->  true
    ;   holds(B, Context)
    ).
holds(\+ A, Context) :-
    !,
    \+ holds(A, Context).
holds(at(Where, Test), Context) :-
    !,
    selected(Where, Context, Selected),
    holds(Test, Selected).
holds(some(Test), context(M, Points, All)) :-
    !,
    member(Point, Points),
    holds(Test, context(M, [Point], All)),
    !.
holds(holds(Goal), context(M, Points, _)) :-
    !,
    call(M:Goal, Points),
    !.
holds(near(E, Value, Within), Context) :-
    !,
    each([E, Value], Context, [A, B]>>( abs(A - B) =< Within )).
holds(between(E, Least, Most), Context) :-
    !,
    each([E, Least, Most], Context, [A, B, C]>>( B =< A, A =< C )).
holds(least(E, P=V), Context) :-
    !,
    extreme(<, E, P, V, Context).
holds(most(E, P=V), Context) :-
    !,
    extreme(>, E, P, V, Context).
holds(rises(E, along(P)), Context) :-
    !,
    on_lines(E, P, Context, ordered(<)).
holds(falls(E, along(P)), Context) :-
    !,
    on_lines(E, P, Context, ordered(>)).
holds(rises(E, along(P), ends), Context) :-
    !,
    on_lines(E, P, Context, ends(<)).
holds(falls(E, along(P), ends), Context) :-
    !,
    on_lines(E, P, Context, ends(>)).
holds(Comparison, Context) :-
    comparison(Comparison, Order, A, B),
    each([A, B], Context, compares(Order)).

comparison(A < B, <, A, B).
comparison(A =< B, =<, A, B).
comparison(A > B, >, A, B).
comparison(A >= B, >=, A, B).
comparison(A =:= B, =:=, A, B).
comparison(A =\= B, =\=, A, B).

compares(Order, A, B) :-
    call(Order, A, B).

%   each(+Expressions, +Context, :Test): wherever all have a value.

each(Expressions, Context, Test) :-
    Context = context(_, Points, _),
    findall(Values,
            ( member(Point, Points),
              maplist(value(Point, Context), Expressions, Values) ),
            Tuples),
    Tuples = [_|_],
    forall(member(Values, Tuples), apply(Test, Values)).

selected(Where, context(M, Points0, All), context(M, Points, All)) :-
    include(is_where(Where), Points0, Points).

is_where(Where, Case-_) :-
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)).

extreme(Order, E, P, V, Context) :-
    Context = context(_, Points, _),
    findall(This-Other,
            ( member(Case-M, Points),
              get_dict(P, Case, V),
              value(Case-M, Context, E, This),
              member(Case1-M1, Points),
              differs(P, Case, Case1),
              value(Case1-M1, Context, E, Other) ),
            Pairs),
    Pairs = [_|_],
    forall(member(This-Other, Pairs), call(Order, This, Other)).

%   differs(+P, +Case, +Case1): in P, and in nothing else that is varied.

differs(P, Case, Case1) :-
    get_dict(P, Case, A),
    get_dict(P, Case1, B),
    A \== B,
    alike(P, Case, Case1).

alike(P, Case, Case1) :-
    dict_pairs(Case, _, Pairs),
    dict_pairs(Case1, _, Pairs1),
    maplist(same_but(P), Pairs, Pairs1).

same_but(P, P-_, P-_) :-
    !.
same_but(_, Pair, Pair).

                /*******************************
                *             LINES            *
                *******************************/

on_lines(E, P, Context, Test) :-
    findall(Values, line_values(E, P, Context, _, Values), Lines),
    Lines = [_|_],
    forall(member(Values, Lines), call(Test, Values)).

%   line_values(+E, +P, +Context, -Case, -Values): Case is the first of the
%   line; lines with less than two values are none.

line_values(E, P, Context, Case, Values) :-
    Context = context(_, Points, _),
    member(Case-_, Points),
    first_of_line(Case, P, Points),
    line_through(Case, P, Points, Line),
    findall(V, ( member(Point, Line), value(Point, Context, E, V) ), Values),
    Values = [_, _|_].

first_of_line(Case, P, Points) :-
    member(Case1-_, Points),
    alike(P, Case, Case1),
    !,
    Case1 == Case.

line_through(Case, P, Points, Line) :-
    include([Case1-_]>>alike(P, Case, Case1), Points, Line).

ordered(Order, [A, B|Values]) :-
    call(Order, A, B),
    (   Values == []
    ->  true
    ;   ordered(Order, [B|Values])
    ).

ends(Order, [First|Values]) :-
    last(Values, Last),
    call(Order, First, Last).

                /*******************************
                *          EXPRESSIONS         *
                *******************************/

%   value(+Point, +Context, +Expression, -Number) is semidet.

value(_, _, Number, Number) :-
    number(Number),
    !.
value(Case-Measures, _, Name, Value) :-
    atom(Name),
    !,
    (   get_dict(Name, Measures, Value)
    ->  true
    ;   get_dict(Name, Case, Value)
    ),
    number(Value).
value(Case-_, context(M, _, All), at(Where, E), Value) :-
    !,
    include(is_where(Where), All, Points),
    elsewhere(Case, Where, Points, Point),
    value(Point, context(M, Points, All), E, Value).
value(Point, Context, Aggregate, Value) :-
    aggregate(Aggregate, Function, E),
    !,
    Context = context(_, Points, _),
    (   Function == count
    ->  aggregate_all(count, ( member(P, Points), value(P, Context, E, _) ),
                      Value)
    ;   findall(V, ( member(P, Points), value(P, Context, E, V) ), Values),
        Values = [_|_],
        call(Function, Values, Value)
    ),
    ignore(Point = _).
value(Point, Context, OnLine, Value) :-
    on_line(OnLine, Function, E, P),
    !,
    Point = Case-_,
    Context = context(_, _, All),
    line_through(Case, P, All, Line),
    findall(V, ( member(Other, Line), value(Other, Context, E, V) ), Values),
    call(Function, Values, Value).
value(Point, Context, Term, Value) :-
    compound(Term),
    Term =.. [Function|Es],
    maplist(value(Point, Context), Es, Values),
    Expression =.. [Function|Values],
    Value is Expression.

%   elsewhere(+Case, +Where, +Points, -Point): that of the case as Where
%   says; where Where says too little, what is selected comes first.

elsewhere(Case, Where, Points, Point) :-
    dict_create(Other, case, Where),
    Case1 = Case.put(Other),
    member(Point, Points),
    Point = Case2-_,
    dict_same(Case1, Case2),
    !.
elsewhere(_, _, [Point|_], Point).

dict_same(A, B) :-
    dict_pairs(A, _, Pairs),
    dict_pairs(B, _, Pairs1),
    Pairs == Pairs1.

aggregate(sum(E), sum_list, E).
aggregate(mean(E), mean, E).
aggregate(median(E), median, E).
aggregate(least(E), min_list, E).
aggregate(most(E), max_list, E).
aggregate(number(E), count, E).

mean(Values, Mean) :-
    sum_list(Values, Sum),
    length(Values, Count),
    Mean is Sum/Count.

on_line(rise(E, along(P)), rise, E, P).
on_line(first(E, along(P)), first, E, P).
on_line(last(E, along(P)), last_value, E, P).

rise([First|Values], Rise) :-
    last(Values, Last),
    Rise is Last - First.

first([Value|_], Value).

last_value(Values, Value) :-
    last(Values, Value).

                /*******************************
                *             FOUND            *
                *******************************/

%!  claim_found(:Test, +Points, +Names:list(atom), -Text:atom) is det.
%
%   Text has the values of the expressions that Test looks at, of Points,
%   usually medians; Names are the parameters that vary.  Of many values
%   only some are shown.

claim_found(M:Test, Points, Names, Text) :-
    findall(Part,
            ( looked_at(Test, context(M, Points, Points), E, Context),
              part(E, Context, Names, Part) ),
            Parts0),
    distinct(Parts0, Parts),
    atomic_list_concat(Parts, '; ', Text).

distinct(Parts0, Parts) :-
    foldl([Part, Seen0, Seen]>>( memberchk(Part, Seen0)
                               -> Seen = Seen0
                               ;  append(Seen0, [Part], Seen) ),
          Parts0, [], Parts).

looked_at(Test, Context, E, EContext) :-
    parts(Test, Tests),
    !,
    member(Part, Tests),
    looked_at(Part, Context, E, EContext).
looked_at(at(Where, Test), Context0, E, EContext) :-
    !,
    selected(Where, Context0, Context),
    looked_at(Test, Context, E, EContext).
looked_at(Test, Context, E, Context) :-
    expressions(Test, Es),
    member(E, Es),
    \+ number(E).

parts((A, B), [A, B]).
parts((A ; B), [A, B]).
parts(\+ A, [A]).
parts(some(A), [A]).

expressions(near(E, _, _), [E]) :- !.
expressions(between(E, _, _), [E]) :- !.
expressions(least(E, _=_), [E]) :- !.
expressions(most(E, _=_), [E]) :- !.
expressions(rises(E, _), [E]) :- !.
expressions(falls(E, _), [E]) :- !.
expressions(rises(E, _, _), [E]) :- !.
expressions(falls(E, _, _), [E]) :- !.
expressions(Test, [A, B]) :-
    comparison(Test, _, A, B),
    !.
expressions(_, []).

part(at(Where, E), context(M, _, All), Names, Part) :-
    !,
    include(is_where(Where), All, Points),
    part(E, context(M, Points, All), Names, Part).
part(E, Context, Names, Part) :-
    Context = context(_, Points, _),
    findall(Case-Value,
            ( member(Case-Measures, Points),
              value(Case-Measures, Context, E, Value) ),
            Values),
    lines_text(Values, Names, Texts),
    atomic_list_concat(Texts, ', ', Joined),
    format(atom(Part), '~w: ~w', [E, Joined]).

%   The last parameter that varies makes the values of a line, all others
%   name it.

lines_text(Values, Names, Texts) :-
    Values = [Case0-_|_],
    !,
    findall(Name,
            ( member(Name, Names),
              get_dict(Name, Case0, First),
              \+ forall(member(Case-_, Values), get_dict(Name, Case, First)) ),
            Varied),
    (   append(Naming, [_], Varied)
    ->  true
    ;   Naming = []
    ),
    findall(Key, ( member(Case-_, Values), key(Naming, Case, Key) ), Keys0),
    distinct(Keys0, Keys),
    findall(Text,
            ( member(Key, Keys),
              findall(N, ( member(Case-V, Values), key(Naming, Case, Key),
                           number_text(V, N) ), Numbers),
              shortened(Numbers, Shown),
              atomic_list_concat(Shown, ' ', Line),
              atomic_list_concat(Key, ' ', Label),
              ( Label == '' -> Text = Line
              ; atomic_list_concat([Label, ' ', Line], Text) ) ),
            Texts).
lines_text([], _, ['no value']).

key(Names, Case, Key) :-
    findall(Value, ( member(Name, Names), get_dict(Name, Case, Value) ), Key).

shortened(Numbers, Shown) :-
    length(Numbers, Count),
    Count > 12,
    !,
    length(Some, 11),
    append(Some, _, Numbers),
    append(Some, ['...'], Shown).
shortened(Numbers, Numbers).

%!  claim_shape(:Test, -Problem) is nondet.
%
%   Problem is a part of Test that is no test.

claim_shape(_:Test, Problem) :-
    (   parts(Test, Tests)
    ->  member(Part, Tests),
        claim_shape(user:Part, Problem)
    ;   Test = at(_, Part)
    ->  claim_shape(user:Part, Problem)
    ;   Test = holds(_)
    ->  fail
    ;   expressions(Test, [_|_])
    ->  fail
    ;   Problem = Test
    ).
