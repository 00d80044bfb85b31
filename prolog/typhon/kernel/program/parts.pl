:- module(typhon_parts,
          [ file_parts/4,               % +Kind, +Located, -Parts, -Problems
            part/3,                     % +What, +Parts, -Value
            in_state/2,                 % +State, +Rule
            library_directive/2,        % +Parts, -Library
            located_clause/2,           % +Located, -Clause
            clause_indicator/2          % +Clauses, -PI
          ]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(lists), [member/2, memberchk/2, selectchk/3]).
:- use_module(source,
              [ clause_parts/3, declaration/4, indicator_in/2,
                library_import/2 ]).

/** <module> What a program or payload file consists of

*Threading*: pure.
*/

%!  file_parts(+Kind, +Located, -Parts, -Problems:list) is det.
%!  part(+What, +Parts, -Value) is det.
%
%   Parts of the terms of a file that declares an agent or a payload, Kind;
%   the one of Problems is that it does not.  What is one of
%
%     - name, options: of the declaration
%     - directives: the others, each with its location
%     - clauses: each with its location
%     - rules: the same as (Head:-Body)
%     - state: predicate indicators of what is mutable

file_parts(Kind, Located, parts(Name, Options, Directives, Clauses, Rules,
                                State), Problems) :-
    declared(Kind, Located, Name, Options, Rest, Problems),
    partition(is_directive, Rest, Directives, Clauses),
    maplist(located_rule, Clauses, Rules),
    findall(PI, state_indicator(Options, Directives, PI), State0),
    sort(State0, State).

part(name, parts(Name, _, _, _, _, _), Name).
part(options, parts(_, Options, _, _, _, _), Options).
part(directives, parts(_, _, Directives, _, _, _), Directives).
part(clauses, parts(_, _, _, Clauses, _, _), Clauses).
part(rules, parts(_, _, _, _, Rules, _), Rules).
part(state, parts(_, _, _, _, _, State), State).

declared(Kind, Located, Name, Options, Rest, []) :-
    member(Term-_, Located),
    declaration(Kind, Term, Name, Options),
    !,
    selectchk(Term-_, Located, Rest).
declared(Kind, Located, unknown, [], Located,
         [problem(existence_error(declaration, Kind), Location,
                  declare(Kind))]) :-
    (   member((:- Directive)-Location0, Located),
        compound(Directive),
        compound_name_arity(Directive, Kind, _)
    ->  Location = Location0            % meant to be one
    ;   Located = [_-Location0|_]
    ->  Location = Location0
    ;   Location = clause(0)
    ).

is_directive(Term-_) :-
    nonvar(Term),
    Term = (:- _).

located_rule(Term-Location, (Head:-Body)-Location) :-
    clause_parts(Term, Head, Body).

state_indicator(Options, _, PI) :-
    member(state(PIs), Options),
    indicator_in(PIs, PI).
state_indicator(_, Directives, PI) :-
    member((:- dynamic(PIs))-_, Directives),
    indicator_in(PIs, PI).

%!  in_state(+State, +Rule) is semidet.
%
%   Rule, with its location, is one of a predicate of State.

in_state(State, (Head:-_)-_) :-
    callable(Head),
    functor(Head, Name, Arity),
    memberchk(Name/Arity, State).

%!  library_directive(+Parts, -Library) is nondet.
%
%   Library is imported, as in library_import/2.

library_directive(Parts, Library) :-
    part(directives, Parts, Directives),
    member((:- Directive)-_, Directives),
    library_import(Directive, Library).

%!  located_clause(+Located, -Clause) is det.
%!  clause_indicator(+Clauses, -PI) is nondet.
%
%   The clause without its location; predicates that have Clauses.

located_clause(Term-_, Clause) :-
    (   clause_parts(Term, Head, Body),
        Body \== true
    ->  Clause = (Head:-Body)
    ;   clause_parts(Term, Clause, _)
    ).

clause_indicator(Clauses, Name/Arity) :-
    member(Clause, Clauses),
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).
