:- module(typhon_dict_calls,
          [ dict_calls/2                % +Clause0, -Clause
          ]).
:- use_module(library(lists), [append/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module('../kernel/program', [declared_meta/3, goals_body/2]).

/** <module> Dicts in clauses: Map.key as a call

A term Map.key in a goal stands for its value: `./3` computes it before the
goal.  Prolog does this when it loads a file, and runs the expansion hooks of
the user then; here nothing is run.

*Threading*: pure.
*/

%!  dict_calls(+Clause0, -Clause) is det.
%
%   Terms Map.key of the head are computed at the beginning of the body, those
%   of a goal before it, also in arguments of meta predicates that are goals.

dict_calls(Clause, Clause) :-
    \+ has_function(Clause),
    !.
dict_calls((:- Directive), (:- Directive)) :-
    !.
dict_calls((Head0 :- Body0), (Head :- Body)) :-
    !,
    phrase(values(Head0, Head), Calls),
    with_calls(Body0, Body1),
    append(Calls, [Body1], Goals),
    goals_body(Goals, Body).
dict_calls(Head0, (Head :- Body)) :-
    phrase(values(Head0, Head), Calls),
    goals_body(Calls, Body).

has_function(Term) :-
    sub_term(Function, Term),
    is_function(Function),
    !.

is_function(Term) :-
    compound(Term),
    compound_name_arity(Term, '.', 2).

%   with_calls(+Goal0, -Goal): the goal with the calls that it needs.

with_calls(Goal, Goal) :-
    \+ has_function(Goal),
    !.
with_calls(Goal0, Body) :-
    compound_name_arguments(Goal0, Name, Args0),
    specs(Goal0, Specs),
    phrase(arguments(Specs, Args0, Args), Calls),
    compound_name_arguments(Goal, Name, Args),
    append(Calls, [Goal], Goals),
    goals_body(Goals, Body).

specs(Goal, Specs) :-
    compound_name_arity(Goal, Name, Arity),
    functor(Head, Name, Arity),
    functor(Any, Name, Arity),
    (   declared_meta(typhon_vocabulary, Head, Meta)
    ->  true
    ;   Meta = Any
    ),
    Meta =.. [_|Specs].

arguments([], [], []) -->
    [].
arguments([Spec|Specs], [Arg0|Args0], [Arg|Args]) -->
    argument(Spec, Arg0, Arg),
    arguments(Specs, Args0, Args).

argument(Spec, Arg0, Arg) -->
    { nonvar(Arg0), nonvar(Spec), memberchk(Spec, [0,^]) },
    !,
    { goal_argument(Arg0, Arg) }.
argument(_, Arg0, Arg) -->
    values(Arg0, Arg).

goal_argument(Var^Goal0, Var^Goal) :-
    !,
    goal_argument(Goal0, Goal).
goal_argument(Goal0, Goal) :-
    with_calls(Goal0, Goal).

%   values(+Term0, -Term)//: Term has the value in place of each Map.key.

values(Term, Term) -->
    { \+ compound(Term) },
    !.
values(Term0, Term) -->
    { compound_name_arguments(Term0, Name, Args0) },
    all_values(Args0, Args),
    (   { is_function(Term0) }
    ->  { append(Args, [Term], All),
          compound_name_arguments(Call, Name, All) },
        [Call]
    ;   { compound_name_arguments(Term, Name, Args) }
    ).

all_values([], []) -->
    [].
all_values([Arg0|Args0], [Arg|Args]) -->
    values(Arg0, Arg),
    all_values(Args0, Args).
