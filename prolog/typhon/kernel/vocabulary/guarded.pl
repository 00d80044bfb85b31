:- module(typhon_guarded,
          [ '$guarded'/1,               % :Goal
            '$guarded'/2,               % :Closure, ...
            '$guarded'/3,
            '$guarded'/4,
            '$guarded'/5,
            '$guarded'/6,
            '$guarded'/7,
            '$guarded'/8,
            '$uncaught'/1               % ?Ball
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module('../program', [guard_called/3, guard_closure/4]).
:- use_module('../host', [atoms_made/1, module_policy/2]).
:- use_module('../agent', [state_text_add/2]).

/** <module> Goals that strangers make up at run time

What typhon_guard leaves for then: '$guarded'(Goal) and '$guarded'(Closure,
A, ...) call the goal if it is allowed.  The machine unfolds them, so that an
agent can stop in there; inside what Prolog runs to its end they are called
as they stand.  For agents that are not guarded they are call/N.

*Threading*: whatever thread runs the agent.
*/

:- multifile
    typhon_guard_texts:made/1,
    typhon_machine:guarded/3.

:- module_transparent
    '$guarded'/1, '$guarded'/2, '$guarded'/3, '$guarded'/4,
    '$guarded'/5, '$guarded'/6, '$guarded'/7, '$guarded'/8.

%!  '$guarded'(:Goal) is nondet.
%!  '$guarded'(:Closure, ?A) is nondet.
%!  '$guarded'(:Closure, ?A, ?B) is nondet.
%!  '$guarded'(:Closure, ?A, ?B, ?C) is nondet.
%!  '$guarded'(:Closure, ?A, ?B, ?C, ?D) is nondet.
%!  '$guarded'(:Closure, ?A, ?B, ?C, ?D, ?E) is nondet.
%!  '$guarded'(:Closure, ?A, ?B, ?C, ?D, ?E, ?F) is nondet.
%!  '$guarded'(:Closure, ?A, ?B, ?C, ?D, ?E, ?F, ?H) is nondet.
%
%   @error permission_error(call, sandboxed, Culprit)

'$guarded'(G) :-
    context_module(M),
    typhon_guarded:native(M, G, [], Goal),
    call(M:Goal).
'$guarded'(G, A) :-
    context_module(M),
    typhon_guarded:native(M, G, [A], Goal),
    call(M:Goal).
'$guarded'(G, A, B) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B], Goal),
    call(M:Goal).
'$guarded'(G, A, B, C) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B,C], Goal),
    call(M:Goal).
'$guarded'(G, A, B, C, D) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B,C,D], Goal),
    call(M:Goal).
'$guarded'(G, A, B, C, D, E) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B,C,D,E], Goal),
    call(M:Goal).
'$guarded'(G, A, B, C, D, E, F) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B,C,D,E,F], Goal),
    call(M:Goal).
'$guarded'(G, A, B, C, D, E, F, H) :-
    context_module(M),
    typhon_guarded:native(M, G, [A,B,C,D,E,F,H], Goal),
    call(M:Goal).

%!  '$uncaught'(?Ball) is det.
%
%   Ball, which was caught, is one that an agent may catch.  What interrupts it,
%   and that its stack is full, it may not: it is raised again, before the
%   agent goes on.

'$uncaught'(Ball) :-
    nonvar(Ball),
    uncaught(Ball),
    !,
    throw(Ball).
'$uncaught'(_).

uncaught('$aborted').
uncaught(unwind(_)).
uncaught(error(Formal, _)) :-
    nonvar(Formal),
    Formal = resource_error(What),
    What == stack.

:- public native/4.

%   native(+Module, +Closure, +Extra, -Goal): the sleep/1 of the system would
%   hold the thread.

native(Module, Closure, Extra, Goal) :-
    may_call(Module, Closure, Extra, Goal),
    (   Goal = sleep(_)
    ->  permission_error(call, control_predicate, sleep/1)
    ;   true
    ).

typhon_machine:guarded(context(_, Module), Guarded, Goal) :-
    compound_name_arguments(Guarded, _, [Closure|Extra]),
    may_call(Module, Closure, Extra, Goal).

typhon_guard_texts:made(Length) :-
    atoms_made(Length).

may_call(Module, Closure, Extra, Goal) :-
    module_policy(Module, Policy),
    !,
    import_module(Module, Program),
    !,
    Own = own(module(Program), Policy),
    checked(Extra, Own, Closure, Goal0),
    own_only(Goal0, Module, Goal).
may_call(_, Closure, [], Closure) :-
    !.
may_call(_, Closure, Extra, Goal) :-
    compound_name_arguments(Goal, call, [Closure|Extra]).

checked([], Own, Goal0, Goal) :-
    !,
    guard_called(Own, Goal0, Goal).
checked(Extra, Own, Closure, Goal) :-
    guard_closure(Own, Closure, Extra, Goal).

%   own_only(+Goal0, +Module, -Goal): what is changed or read is the agent's
%   own, not what a place offers, or the clauses of its program.

own_only(Goal0, Module, Goal) :-
    touches(Goal0, Head),
    !,
    ( adds(Goal0, Clause) -> state_text_add(Module, Clause) ; true ),
    (   '$c_current_predicate'(_, Module:Head)
    ->  (   '$get_predicate_attribute'(Module:Head, imported, _)
        ->  permission_error(call, sandboxed, Goal0)
        ;   Goal = Goal0
        )
    ;   Goal0 = clause(_, _)
    ->  Goal = fail
    ;   Goal = Goal0
    ).
own_only(Goal, _, Goal).

touches(Goal, Head) :- adds(Goal, Clause), clause_of(Clause, Head).
touches(retract(Clause), Head) :- clause_of(Clause, Head).
touches(retractall(Head), Head).
touches(clause(Head, _), Head).

adds(assert(Clause), Clause).
adds(asserta(Clause), Clause).
adds(assertz(Clause), Clause).

clause_of((Head:-_), Head) :- !.
clause_of(Head, Head).
