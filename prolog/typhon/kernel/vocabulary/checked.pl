:- module(typhon_checked,
          [ '$checked'/1,               % :Goal
            '$checked'/2,               % :Closure, ...
            '$checked'/3,
            '$checked'/4,
            '$checked'/5,
            '$checked'/6,
            '$checked'/7,
            '$checked'/8,
            '$uncaught'/1               % ?Ball
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module('../base/error_text', [is_abort/1]).
:- use_module('../agent', [agent_variant/2]).

/** <module> Goals that are checked when they are called

Variants of programs, see typhon_agent_module, contain

    '$checked'(Goal)            '$checked'(Closure, A, ...)

where it is known only at run time what is called, and begin with
'$uncaught'(Ball) what is done when something was caught.  The machine unfolds
checked goals, so that an agent can stop in there; inside what Prolog runs to
its end they are called as they stand.  For agents that run their program as
it is they are call/N.

*Threading*: the thread that runs the agent.
*/

:- multifile typhon_machine:checked/3.

:- module_transparent
    '$checked'/1, '$checked'/2, '$checked'/3, '$checked'/4,
    '$checked'/5, '$checked'/6, '$checked'/7, '$checked'/8.

%!  '$checked'(:Goal) is nondet.
%!  '$checked'(:Closure, ?A) is nondet.
%!  '$checked'(:Closure, ?A, ?B) is nondet.
%!  '$checked'(:Closure, ?A, ?B, ?C) is nondet.
%!  '$checked'(:Closure, ?A, ?B, ?C, ?D) is nondet.
%!  '$checked'(:Closure, ?A, ?B, ?C, ?D, ?E) is nondet.
%!  '$checked'(:Closure, ?A, ?B, ?C, ?D, ?E, ?F) is nondet.
%!  '$checked'(:Closure, ?A, ?B, ?C, ?D, ?E, ?F, ?H) is nondet.
%
%   @error what the variant of the agent raises

'$checked'(G) :-
    context_module(M),
    typhon_checked:native(M, G, [], Goal),
    call(M:Goal).
'$checked'(G, A) :-
    context_module(M),
    typhon_checked:native(M, G, [A], Goal),
    call(M:Goal).
'$checked'(G, A, B) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B], Goal),
    call(M:Goal).
'$checked'(G, A, B, C) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B,C], Goal),
    call(M:Goal).
'$checked'(G, A, B, C, D) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B,C,D], Goal),
    call(M:Goal).
'$checked'(G, A, B, C, D, E) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B,C,D,E], Goal),
    call(M:Goal).
'$checked'(G, A, B, C, D, E, F) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B,C,D,E,F], Goal),
    call(M:Goal).
'$checked'(G, A, B, C, D, E, F, H) :-
    context_module(M),
    typhon_checked:native(M, G, [A,B,C,D,E,F,H], Goal),
    call(M:Goal).

:- public native/4.

%   native(+Module, +Closure, +Extra, -Goal): the sleep/1 of the system would
%   hold the thread.

native(Module, Closure, Extra, Goal) :-
    called(Module, Closure, Extra, Goal),
    (   Goal = sleep(_)
    ->  permission_error(call, control_predicate, sleep/1)
    ;   true
    ).

called(Module, Closure, Extra, Goal) :-
    agent_variant(Module, Variant),
    !,
    typhon_agent_module:called(Variant, Module, Closure, Extra, Goal).
called(_, Closure, [], Closure) :-
    !.
called(_, Closure, Extra, Goal) :-
    compound_name_arguments(Goal, call, [Closure|Extra]).

typhon_machine:checked(context(_, Module), Checked, Goal) :-
    compound_name_arguments(Checked, _, [Closure|Extra]),
    called(Module, Closure, Extra, Goal).

%!  '$uncaught'(?Ball) is det.
%
%   Ball, which was caught, is one that an agent may catch.  What interrupts it,
%   and that its stack is full, it may not: it is raised again, before the
%   agent goes on.

'$uncaught'(Ball) :-
    uncaught(Ball),
    !,
    throw(Ball).
'$uncaught'(_).

uncaught(Ball) :-
    is_abort(Ball),
    !.
uncaught(Ball) :-
    subsumes_term(error(resource_error(stack), _), Ball).
