:- module(tartarus_clauses,
          [ body/3,                     % +Name, +Indicators, -Clauses
            body_copy/2,                % +Name, +Indicator
            body_erase/2,               % +Name, +Indicators
            body_has/2,                 % +Name, +Indicator
            body_install/1,             % +Clauses
            renamed/4                   % +Old, +New, +Term0, -Term
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/2, member/2]).

/** <module> Clauses of agents in module `user`

The clauses of an agent are those of its handler and its payload whose first
argument is its name.  They are copies of templates, which have `guid` there.
Tartarus replaced text; this module replaces atoms in terms, as the authors of
programs intended.

*Threading*: any thread; a mutex serialises changes of predicates to dynamic.
*/

%!  body(+Name, +Indicators, -Clauses) is det.
%
%   Clauses are the clauses of these predicates about Name, as Head :- Body.
%
%   @arg Indicators is a list of pairs (Predicate,Arity)

body(Name, Indicators, Clauses) :-
    maplist(clauses_of(Name), Indicators, Parts),
    append(Parts, Clauses).

clauses_of(Name, Indicator, Clauses) :-
    head(Indicator, Name, Head),
    findall((Head:-Body), own_clause(Head, Body), Clauses).

%   A clause whose first argument is a variable belongs to no agent.

own_clause(Head, Body) :-
    arg(1, Head, Name),
    functor(Head, Predicate, Arity),
    functor(General, Predicate, Arity),
    is_own(General),
    predicate_property(user:General, number_of_clauses(_)),
    arg(1, General, First),
    clause(user:General, Body),
    First == Name,
    Head = General.

head((Predicate,Arity), Name, Head) :-
    functor(Head, Predicate, Arity),
    arg(1, Head, Name).

%!  body_has(+Name, +Indicator) is semidet.

body_has(Name, Indicator) :-
    head(Indicator, Name, Head),
    own_clause(Head, _),
    !.

%!  body_copy(+Name, +Indicator) is det.
%
%   Copy the template of a predicate.

body_copy(Name, Indicator) :-
    clauses_of(guid, Indicator, Template),
    renamed(guid, Name, Template, Clauses),
    body_install(Clauses).

%!  body_install(+Clauses) is det.

body_install(Clauses) :-
    maplist(install, Clauses).

install((Head:-Body)) :-
    make_dynamic(Head),
    assertz(user:(Head:-Body)).

%!  body_erase(+Name, +Indicators) is det.

body_erase(Name, Indicators) :-
    maplist(erase_of(Name), Indicators).

%   Clauses are erased by reference, since other threads add clauses meanwhile.

erase_of(Name, (Predicate,Arity)) :-
    functor(Head, Predicate, Arity),
    (   is_own(Head),
        predicate_property(user:Head, dynamic)
    ->  arg(1, Head, First),
        findall(Ref, ( clause(user:Head, _, Ref), First == Name ), Refs),
        maplist(gone, Refs)
    ;   true
    ).

gone(Ref) :-
    catch(erase(Ref), error(existence_error(_, _), _), true).

%   A predicate of a program that is not declared dynamic becomes dynamic, and
%   keeps its clauses.

make_dynamic(Head) :-
    (   is_own(Head),
        predicate_property(user:Head, dynamic)
    ->  true
    ;   with_mutex(tartarus_dynamic, static_to_dynamic(Head))
    ).

static_to_dynamic(Head0) :-
    functor(Head0, Predicate, Arity),
    functor(Head, Predicate, Arity),
    (   is_static(Head)
    ->  findall((Head:-Body), clause(user:Head, Body), Clauses),
        abolish(user:Predicate/Arity)
    ;   Clauses = [],
        override_import(Head)
    ),
    dynamic(user:Predicate/Arity),
    forall(member(Clause, Clauses), assertz(user:Clause)).

is_static(Head) :-
    is_own(Head),
    \+ predicate_property(user:Head, dynamic).

%   As for a definition in a file, a predicate of a library that has the same
%   name is overridden.

override_import(Head) :-
    (   functor(Head, Predicate, Arity),
        current_predicate(user:Predicate/Arity)
    ->  redefine_system_predicate(user:Head)
    ;   true
    ).

%   is_own(+Head): module `user` defines the predicate.  current_predicate/1
%   comes first, because predicate_property/2 would load a library that has a
%   predicate of that name, and import it.

is_own(Head) :-
    functor(Head, Predicate, Arity),
    current_predicate(user:Predicate/Arity),
    \+ predicate_property(user:Head, imported_from(_)).

%!  renamed(+Old, +New, +Term0, -Term) is det.
%
%   Term is Term0 with the atom New in place of each argument Old.

renamed(Old, New, Term0, Term) :-
    (   Term0 == Old
    ->  Term = New
    ;   compound(Term0)
    ->  compound_name_arguments(Term0, Functor, Arguments0),
        maplist(renamed(Old, New), Arguments0, Arguments),
        compound_name_arguments(Term, Functor, Arguments)
    ;   Term = Term0
    ).
