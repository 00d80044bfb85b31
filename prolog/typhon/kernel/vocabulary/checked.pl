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
:- use_module('../program', [control_of_system/1]).
:- use_module('../agent', [agent_variant/2]).

/** <module> Goals that are checked when they are called

Variants of programs, see typhon_agent_module, contain

    '$checked'(Goal)            '$checked'(Closure, A, ...)

for goals that are known only at run time, and call '$uncaught'(Ball) first
where an exception was caught.  The machine unfolds checked goals, so that an
agent can stop in them; inside goals that Prolog runs to their end they are
called natively.  For agents that run their program unchanged they are call/N.

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
%   @error those of the variant of the agent

term_expansion(checked_clauses, Clauses) :-
    findall(( Head :-
                  context_module(M),
                  typhon_checked:native(M, Closure, Extra, Goal),
                  call(M:Goal) ),
            ( between(0, 7, Count),
              length(Extra, Count),
              Head =.. ['$checked',Closure|Extra] ),
            Clauses).

checked_clauses.

:- public native/4.

%   native(+Module, +Closure, +Extra, -Goal): Goal is no control predicate of
%   the system, as sleep/1, which would occupy the thread.

native(Module, Closure, Extra, Goal) :-
    called(Module, Closure, Extra, Goal),
    (   nonvar(Goal),
        control_of_system(Goal)
    ->  functor(Goal, Name, Arity),
        permission_error(call, control_predicate, Name/Arity)
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
%   The agent caught Ball.  It may not catch an interrupt or a full stack:
%   these are raised again before the agent goes on.

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
