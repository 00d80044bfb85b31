:- module(typhon_problems,
          [ directive_problem/2,        % +Directives, -Problem
            clause_problem/2,           % +Clauses, -Problem
            entry_problem/3,            % +Located, +Clauses, -Problem
            option_problem/3            % +Kind, +Located, -Problem
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(control, [control/1]).
:- use_module(source, [clause_parts/3, declaration/4, library_import/2]).

/** <module> What can be wrong with an agent program or a payload

A problem is problem(Formal, Location, Advice): an ISO error, where it
stands and what to do about it, see typhon_problem_text.

*Threading*: pure.
*/

%!  directive_problem(+Directives, -Problem) is nondet.
%!  clause_problem(+Clauses, -Problem) is nondet.
%!  entry_problem(+Located, +Clauses, -Problem) is semidet.
%!  option_problem(+Kind, +Located, -Problem) is nondet.
%
%   Problems with the directives, the clauses, the entries and the options
%   of a program, or of a payload: Kind is `agent` or `payload`.  Directives,
%   Clauses and Located are pairs Term-Location; for entries Clauses are rules.

directive_problem(Directives, problem(Formal, Location, Advice)) :-
    member((:- Directive)-Location, Directives),
    faulty_directive(Directive, Formal, Advice).

faulty_directive(Directive, instantiation_error, directive) :-
    var(Directive),
    !.
faulty_directive(dynamic(PIs), Formal, Advice) :-
    !,
    faulty_indicator(PIs, Formal, Advice).
faulty_directive(discontiguous(_), _, _) :-
    !,
    fail.
faulty_directive(Directive, existence_error(library, Library), library) :-
    library_import(Directive, library(Library)-_),
    !,
    \+ absolute_file_name(library(Library), _,
                          [ file_type(prolog), access(read),
                            file_errors(fail) ]).
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
faulty_directive(Directive, domain_error(directive, Directive), directive).

%   faulty_indicator(+PIs, -Formal, -Advice) is nondet: PIs are meant to be
%   dynamic.

faulty_indicator(PIs, instantiation_error, indicator) :-
    var(PIs),
    !.
faulty_indicator([], _, _) :-
    !,
    fail.
faulty_indicator([A|B], Formal, Advice) :-
    !,
    (   faulty_indicator(A, Formal, Advice)
    ;   faulty_indicator(B, Formal, Advice)
    ).
faulty_indicator((A,B), Formal, Advice) :-
    !,
    (   faulty_indicator(A, Formal, Advice)
    ;   faulty_indicator(B, Formal, Advice)
    ).
faulty_indicator(Name/Arity, Formal, redefined) :-
    atom(Name),
    integer(Arity),
    Arity >= 0,
    !,
    functor(Head, Name, Arity),
    taken(Head, Formal).
faulty_indicator(PI, type_error(predicate_indicator, PI), indicator).

clause_problem(Clauses, problem(Formal, Location, Advice)) :-
    member(Term-Location, Clauses),
    clause_parts(Term, Head, Body),
    faulty_clause(Head, Body, Formal, Advice).

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

%   taken(+Head, -Formal): it means something to the machine or to Prolog.

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

entry_problem(Located, Clauses,
              problem(existence_error(entry, main/0), Location, entry)) :-
    \+ ( member((Head:-_)-_, Clauses),
         nonvar(Head),
         ( Head = main ; Head = on_message(_, _) )
       ),
    Located = [_-Location|_].

option_problem(Kind, Located, problem(Formal, Location, Advice)) :-
    member(Term-Location, Located),
    declaration(Kind, Term, _, Options),
    !,
    member(Option, Options),
    faulty_option(Kind, Option, Formal, Advice).

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
