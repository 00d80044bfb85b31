:- module(typhon_parts,
          [ file_parts/4,               % +Kind, +Located, -Parts, -Problems
            part/3,                     % +What, +Parts, -Value
            in_state/2,                 % +State, +Rule
            library_directive/2,        % +Parts, -Library
            located_clause/2,           % +Located, -Clause
            clause_indicator/2,         % +Clauses, -PI
            file_problem/4              % +Kind, +Located, +Parts, -Problem
          ]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(lists), [member/2, memberchk/2, selectchk/3]).
:- use_module(source,
              [ clause_parts/3, declaration/4, indicator_in/2,
                reader_directive/1 ]).
:- use_module(libraries, [import_fault/2, library_import/2]).
:- use_module(bodies, [control/1]).
:- use_module('../base/names', [names_near/3]).

/** <module> The parts of a program or payload file, and its problems

A problem is problem(Formal, Location, Advice): an ISO error, its place, and
how to fix it, see typhon_problem_text.

*Threading*: pure.
*/

%!  file_parts(+Kind, +Located, -Parts, -Problems:list) is det.
%
%   Parts are the parts of a file that declares an `agent` or a `payload`, Kind.
%   Problems has one element if this declaration is missing.

file_parts(Kind, Located, parts(Name, Options, Directives, Clauses, Rules,
                                State), Problems) :-
    declared(Kind, Located, Name, Options, Rest, Problems),
    partition(is_directive, Rest, Directives, Clauses),
    maplist(located_rule, Clauses, Rules),
    findall(PI, state_indicator(Options, Directives, PI), State0),
    sort(State0, State).

%!  part(+What, +Parts, -Value) is det.
%
%   What is one of
%
%     - name, options: of the declaration
%     - directives: the others, each with its location
%     - clauses: each with its location
%     - rules: the same as (Head:-Body)
%     - state: indicators of the predicates that agents may change

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
    ->  Location = Location0            % meant as a declaration
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
%   Rule, with its location, belongs to a predicate of State.

in_state(State, (Head:-_)-_) :-
    callable(Head),
    functor(Head, Name, Arity),
    memberchk(Name/Arity, State).

%!  library_directive(+Parts, -Library) is nondet.
%
%   The file imports Library, as in library_import/2.

library_directive(Parts, Library) :-
    part(directives, Parts, Directives),
    member((:- Directive)-_, Directives),
    library_import(Directive, Library).

%!  located_clause(+Located, -Clause) is det.

located_clause(Term-_, Clause) :-
    (   clause_parts(Term, Head, Body),
        Body \== true
    ->  Clause = (Head:-Body)
    ;   clause_parts(Term, Clause, _)
    ).

%!  clause_indicator(+Clauses, -PI) is nondet.

clause_indicator(Clauses, Name/Arity) :-
    member(Clause, Clauses),
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).

                /*******************************
                *           PROBLEMS           *
                *******************************/

%!  file_problem(+Kind, +Located, +Parts, -Problem) is nondet.
%
%   Problem keeps the file from being used, besides those of file_parts/4.

file_problem(_, _, Parts, problem(Formal, Location, Advice)) :-
    part(directives, Parts, Directives),
    member((:- Directive)-Location, Directives),
    faulty_directive(Directive, Formal, Advice).
file_problem(_, _, Parts, problem(Formal, Location, Advice)) :-
    part(clauses, Parts, Clauses),
    member(Term-Location, Clauses),
    clause_parts(Term, Head, Body),
    faulty_clause(Head, Body, Formal, Advice).
file_problem(agent, Located, Parts, Problem) :-
    part(rules, Parts, Rules),
    no_entry(Located, Rules, Problem).
file_problem(Kind, Located, _, problem(Formal, Location, Advice)) :-
    member(Term-Location, Located),
    declaration(Kind, Term, _, Options),
    !,
    member(Option, Options),
    faulty_option(Kind, Option, Formal, Advice).

faulty_directive(Directive, instantiation_error, directive) :-
    var(Directive),
    !.
faulty_directive(dynamic(PIs), Formal, Advice) :-
    !,
    faulty_indicator(PIs, Formal, Advice).
faulty_directive(discontiguous(_), _, _) :-
    !,
    fail.
faulty_directive(Directive, Formal, library) :-
    library_import(Directive, Import),
    !,
    import_fault(Import, Formal).
faulty_directive(Directive, Formal, Advice) :-
    functor(Directive, Kind, _),
    memberchk(Kind, [agent,payload]),
    !,
    (   declaration(Kind, (:- Directive), Name, _)
    ->  Formal = permission_error(declare, Kind, Name),
        Advice = once
    ;   Formal = domain_error(Kind, Directive),
        Advice = declare(Kind)
    ).
faulty_directive(Directive, Formal, directive) :-
    (   catch(reader_directive(Directive), error(Formal0, _), true)
    ->  nonvar(Formal0),
        Formal = Formal0
    ;   Formal = domain_error(directive, Directive)
    ).

%   faulty_indicator(+PIs, -Formal, -Advice) is nondet: a problem of PIs, the
%   argument of dynamic/1.

faulty_indicator(PIs, instantiation_error, indicator) :-
    var(PIs),
    !.
faulty_indicator([], _, _) :-
    !,
    fail.
faulty_indicator(PIs, Formal, Advice) :-
    ( PIs = [A|B] ; PIs = (A,B) ),
    !,
    ( Part = A ; Part = B ),
    faulty_indicator(Part, Formal, Advice).
faulty_indicator(Name/Arity, Formal, redefined) :-
    atom(Name),
    integer(Arity),
    Arity >= 0,
    !,
    functor(Head, Name, Arity),
    taken(Head, Formal).
faulty_indicator(PI, type_error(predicate_indicator, PI), indicator).

faulty_clause(Head, _, instantiation_error, head) :-
    var(Head),
    !.
faulty_clause(Head, _, type_error(callable, Head), head) :-
    \+ callable(Head),
    !.
faulty_clause(Head, _, domain_error(clause_head, Head), qualified) :-
    Head = _:_,
    !.
faulty_clause(Head, _, domain_error(clause, Head), rule) :-
    memberchk(Head, [(_=>_), (?-_), (_:-_)]),
    !.
faulty_clause(Head, _, Formal, redefined) :-
    taken(Head, Formal),
    !.
faulty_clause(_, Body, type_error(callable, Body), body) :-
    \+ is_body(Body).

%   taken(+Head, -Formal): the machine or Prolog defines Head already.

taken(Head, permission_error(modify, control_predicate, Name/Arity)) :-
    control(Head),
    !,
    functor(Head, Name, Arity).
taken(Head, permission_error(modify, static_procedure, Name/Arity)) :-
    (   '$get_predicate_attribute'(system:Head, iso, 1)
    ;   memberchk(Head, [(_*->_), ignore(_)])
    ),
    !,
    functor(Head, Name, Arity).

is_body(Body) :- var(Body), !.
is_body((A,B)) :- !, is_body(A), is_body(B).
is_body((A;B)) :- !, is_body(A), is_body(B).
is_body((A->B)) :- !, is_body(A), is_body(B).
is_body((A*->B)) :- !, is_body(A), is_body(B).
is_body(Body) :- callable(Body).

no_entry(Located, Rules,
         problem(existence_error(entry, main/0), Location, entry(Near))) :-
    findall(Name/Arity,
            ( member((Head:-_)-_, Rules), callable(Head),
              functor(Head, Name, Arity) ),
            PIs),
    \+ ( member(PI, PIs), is_entry(PI) ),
    Located = [_-Location|_],
    findall(PI-Entry,
            ( is_entry(Entry), Entry = Name/Arity, member(PI, PIs),
              PI = Written/Arity, names_near(Name, [Written], [_]) ),
            Near).

is_entry(main/0).
is_entry(on_message/2).

faulty_option(Kind, Option, Formal, Advice) :-
    nonvar(Option),
    lists(Kind, Option, PIs),
    is_list(PIs),
    !,
    faulty_indicator(PIs, Formal, Advice0),
    ( Advice0 == indicator -> Advice = options(Kind) ; Advice = Advice0 ).
faulty_option(Kind, Option, domain_error(Domain, Option), options(Kind)) :-
    atom_concat(Kind, '_declaration', Domain).

lists(agent, state(PIs), PIs).
lists(payload, provides(PIs), PIs).
