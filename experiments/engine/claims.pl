:- module(study_claims,
          [ claim_holds/2,              % :Test, +Points
            claim_verdict/3,            % :Test, +Points, -Verdict
            claim_shape/2,              % :Test, -Problem
            claim_name/2,               % :Test, -Name
            claim_value/2,              % :Test, -NameValue
            connective/2,               % ?Test, -Tests
            leaf/4                      % ?Test, -Relation, -Where, -Es
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(expressions,
              [ aggregate/3, context/2, line/3, of_all_points/1, on_line/4,
                selected/3, value/4 ]).

/** <module> Claims are terms

A claim is a test over points: Case-Measures, two dicts, one point for each
case.  Tests are

  - A < B, =<, >, >=, =:=, =\=: for every point at which both sides have a
    value, of which there is at least one
  - near(E, Value, Within), between(E, Least, Most): likewise
  - rises(E, along(P)), falls(E, along(P)): strictly, from each value of
    the parameter P to the next, on every line: the points that differ only
    in P and in derived parameters
  - rises(E, along(P), ends), falls(E, along(P), ends): from first to last
  - least(E, P=V), most(E, P=V): with this value less (more) than with any
    other, all else equal
  - at(Where, Test): Test for the points that satisfy Where, a list of
    Name=Value
  - some(Test): for at least one point
  - (A, B), (A ; B), \+ A
  - holds(Goal): call(Goal, Points) in the study, for all other tests

A test holds, fails, or is unknown: it needs a run that was not made (the
point Case-missing), or no point has the values that it compares. Then neither
the test nor its negation holds. A failing test fails whatever the missing runs
may give; a holding test holds whatever they may give.

*Threading*: pure.
*/

:- meta_predicate
    claim_holds(:, +),
    claim_verdict(:, +, -),
    claim_shape(:, -),
    claim_name(:, -),
    claim_value(:, -).

%!  claim_holds(:Test, +Points:list(pair)) is semidet.

claim_holds(Test, Points) :-
    claim_verdict(Test, Points, true).

%!  claim_verdict(:Test, +Points:list(pair), -Verdict) is det.
%
%   Verdict is `true`, `false` or `unknown`.

claim_verdict(M:Test, Points, Verdict) :-
    context(M:Points, Context),
    (   verdict(Test, M, Context, Truth)
    ->  Verdict = Truth
    ;   Verdict = unknown
    ).

%   verdict(+Test, +Module, +Context, -Truth) is semidet: `true`, `false`, or
%   `unknown` because a run is missing; fails if there is nothing to compare.

verdict((A, B), M, Context, Truth) :-
    !,
    findall(T, ( member(Test, [A, B]),
                 ( verdict(Test, M, Context, T0) -> T = T0 ; T = none ) ),
            Truths),
    all_of(Truths, Truth).
verdict((A ; B), M, Context, Truth) :-
    !,
    verdict(\+ (\+ A, \+ B), M, Context, Truth).
verdict(\+ A, M, Context, Truth) :-
    !,
    verdict(A, M, Context, Truth0),
    opposite(Truth0, Truth).
verdict(at(Where, Test), M, Context, Truth) :-
    !,
    selected(Where, Context, Selected),
    verdict(Test, M, Selected, Truth).
verdict(some(Test), M, context(Points, All, Follows), Truth) :-
    !,
    findall(T, ( member(Point, Points),
                 verdict(\+ Test, M, context([Point], All, Follows), T) ),
            Truths),
    all_of(Truths, Truth0),
    opposite(Truth0, Truth).
verdict(holds(Goal), M, context(Points, _, _), Truth) :-
    !,
    Points = [_|_],
    (   memberchk(_-missing, Points)
    ->  Truth = unknown
    ;   truth(call(M:Goal, Points), Truth)
    ).
verdict(Test, _, Context, Truth) :-
    findall(T, ( related(Test, Context, Relation, Values),
                 in_relation(Relation, Values, T) ),
            Truths),
    all_of(Truths, Truth).

%   all_of(+Truths, -Truth) is semidet: fails if some are `none`, or there are
%   no Truths, unless the others decide.

all_of(Truths, Truth) :-
    member(Truth, [false, unknown]),
    memberchk(Truth, Truths),
    !.
all_of([First|Truths], true) :-
    \+ memberchk(none, [First|Truths]).

opposite(true, false).
opposite(false, true).
opposite(unknown, unknown).

:- meta_predicate truth(0, -).

truth(Goal, Truth) :-
    (   \+ call(Goal)
    ->  Truth = false
    ;   Truth = true
    ).

%   related(+Test, +Context, -Relation, -Values) is nondet: Test holds if each
%   solution's Values stand in Relation.

related(Test, Context, Relation, Values) :-
    leaf(Test, Relation, Where, Es),
    compared(Where, Es, Context, Values).

compared(points, Es, Context, Values) :-
    Context = context(Points, _, _),
    (   maplist(of_all_points, Es)
    ->  Points = [Point|_]
    ;   member(Point, Points)
    ),
    values(Es, Point, Context, Values).
compared(against(P, V), [E], Context, [This, Other]) :-
    line(P, Context, Line),
    member(V-Point, Line),
    value(E, Point, Context, This),
    member(W-Another, Line),
    W \== V,
    value(E, Another, Context, Other).
compared(steps(P), [E], Context, [A, B]) :-
    along(P, E, Context, Values),
    append(_, [A, B|_], Values).
compared(ends(P), [E], Context, [A, B]) :-
    along(P, E, Context, [A|Values]),
    last(Values, B).

values([], _, _, []).
values([E|Es], Point, Context, [Value|Values]) :-
    value(E, Point, Context, Value),
    values(Es, Point, Context, Values).

along(P, E, Context, Values) :-
    line(P, Context, Line),
    findall(Value, ( member(_-Point, Line), value(E, Point, Context, Value) ),
            Values).

in_relation(_, Values, unknown) :-
    memberchk(missing, Values),
    !.
in_relation(Relation, Values, Truth) :-
    truth(stand_in(Relation, Values), Truth).

stand_in(near, [A, B, Within]) :- !, abs(A - B) =< Within.
stand_in(between, [A, Least, Most]) :- !, Least =< A, A =< Most.
stand_in(Order, [A, B]) :- call(Order, A, B).

                /*******************************
                *             SHAPE            *
                *******************************/

%!  claim_shape(:Test, -Problem) is nondet.
%
%   Problem is a part of Test that is neither a test nor an expression, or
%   calls an undefined predicate of the study.

claim_shape(M:Test, Problem) :-
    part(Test, M, problem(Problem)).

%!  claim_name(:Test, -Name) is nondet.
%
%   Name is a measure or a parameter in Test.

claim_name(M:Test, Name) :-
    part(Test, M, name(Name)).

%!  claim_value(:Test, -NameValue) is nondet.
%
%   NameValue, Name=Value, is a condition in Test.

claim_value(M:Test, NameValue) :-
    part(Test, M, value(NameValue)).

part(Test, _, problem(Test)) :-
    \+ callable(Test),
    !.
part(at(Where, Test), M, Part) :-
    !,
    (   of_where(Where, Part)
    ;   part(Test, M, Part)
    ).
part(holds(Goal), M, Part) :-
    !,
    \+ ( callable(Goal),
         functor(Goal, Name, Arity0),
         Arity is Arity0 + 1,
         current_predicate(M:Name/Arity) ),
    Part = problem(holds(Goal)).
part(Test, M, Part) :-
    connective(Test, Tests),
    !,
    member(One, Tests),
    part(One, M, Part).
part(Test, _, Part) :-
    leaf(Test, _, Where, Es),
    !,
    (   Where =.. [_, P|_],
        Part = name(P)
    ;   Where = against(P, V),
        Part = value(P=V)
    ;   member(E, Es),
        of_expression(E, Part)
    ).
part(Test, _, problem(Test)).

%!  connective(?Test, -Tests:list) is semidet.

connective((A, B), [A, B]).
connective((A ; B), [A, B]).
connective(\+ A, [A]).
connective(some(A), [A]).

%!  leaf(?Test, -Relation, -Where, -Es:list) is semidet.
%
%   Test claims that the values of Es stand in Relation, an order,
%   `near` or `between`.  Where selects the values:
%
%     - points
%       the values of each point by itself
%     - against(P, V)
%       with the value V of the parameter P, and with any other
%     - steps(P), ends(P)
%       with each value of P and the next, or with the first and the last

leaf(near(E, Value, Within), near, points, [E, Value, Within]).
leaf(between(E, Least, Most), between, points, [E, Least, Most]).
leaf(A < B, <, points, [A, B]).
leaf(A =< B, =<, points, [A, B]).
leaf(A > B, >, points, [A, B]).
leaf(A >= B, >=, points, [A, B]).
leaf(A =:= B, =:=, points, [A, B]).
leaf(A =\= B, =\=, points, [A, B]).
leaf(least(E, P=V), <, against(P, V), [E]).
leaf(most(E, P=V), >, against(P, V), [E]).
leaf(rises(E, along(P)), <, steps(P), [E]).
leaf(falls(E, along(P)), >, steps(P), [E]).
leaf(rises(E, along(P), ends), <, ends(P), [E]).
leaf(falls(E, along(P), ends), >, ends(P), [E]).

of_where(Where, name(Name)) :-
    is_list(Where),
    member(Name=_, Where).
of_where(Where, value(Name=Value)) :-
    is_list(Where),
    member(Name=Value, Where).
of_where(Where, problem(Where)) :-
    \+ ( is_list(Where), forall(member(W, Where), W = (_=_)) ).

of_expression(E, _) :-
    number(E),
    !,
    fail.
of_expression(E, Part) :-
    atom(E),
    !,
    Part = name(E).
of_expression(at(Where, E), Part) :-
    !,
    (   of_where(Where, Part)
    ;   of_expression(E, Part)
    ).
of_expression(Term, Part) :-
    aggregate(Term, _, E),
    !,
    of_expression(E, Part).
of_expression(correlation(E1, E2), Part) :-
    !,
    (   of_expression(E1, Part)
    ;   of_expression(E2, Part)
    ).
of_expression(Term, Part) :-
    on_line(Term, _, E, P),
    !,
    (   Part = name(P)
    ;   of_expression(E, Part)
    ).
of_expression(E, Part) :-
    compound(E),
    current_arithmetic_function(E),
    !,
    arg(_, E, E1),
    of_expression(E1, Part).
of_expression(E, problem(E)).
