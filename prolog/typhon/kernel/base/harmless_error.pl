:- module(typhon_harmless_error,
          [ harmless_error/2            % +Ball0, -Ball
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(error_text, [context_indicator/3, is_abort/1, is_remark/1]).
:- use_module(trees, [is_tree/2]).

/** <module> Errors from elsewhere, raised again

An error that another process answers is raised in the thread that asked, and
the top level prints it: with the translations of SWI-Prolog and of its
libraries, which take some errors for programs.

*Threading*: pure.
*/

:- multifile
    formal_lines//1,            % +Formal: of an error of ISO, SWI-Prolog or this
                                % library
    prolog:error_message//1.

%!  harmless_error(+Ball0, -Ball) is det.
%
%   Ball is to be raised here in place of Ball0, which was raised elsewhere:
%   the same error, with as much of its context as is text, if printing it calls
%   nothing.  Else it is error(raised_elsewhere(Ball0), _).

harmless_error(Ball0, Ball) :-
    (   harmless(Ball0, Ball1)
    ->  Ball = Ball1
    ;   Ball = error(raised_elsewhere(Ball0), _)
    ).

harmless(error(Formal, Context0), error(Formal, Context)) :-
    !,
    nonvar(Formal),
    is_tree(Formal, 50 000),
    harmless_formal(Formal),
    harmless_context(Context0, Context).
harmless(Ball, Ball) :-
    nonvar(Ball),
    \+ is_abort(Ball),
    is_tree(Ball, 50 000),
    \+ translated(Ball).

%   Of these two SWI-Prolog looks into the context, or the culprit.

harmless_formal(resource_error(What)) :-
    !,
    atom(What),
    What \== stack.
harmless_formal(existence_error(reset, _)) :-
    !,
    fail.
harmless_formal(Formal) :-
    phrase(formal_lines(Formal), _),
    !.
harmless_formal(Formal) :-
    \+ translated(error(Formal, _)).

harmless_context(Context0, Context) :-
    nonvar(Context0),
    Context0 = context(PI0, Text0),
    !,
    ( context_indicator(PI0, _, _) -> PI = PI0 ; true ),
    ( is_remark(Text0) -> Text = Text0 ; true ),
    Context = context(PI, Text).
harmless_context(_, _).

%   translated(+Ball): a hook or SWI-Prolog translates it.  The two that are not
%   in its tables are in translate_message//1 itself.

translated(format(_, _)) :-
    !.
translated(message_lines(_)) :-
    !.
translated(Ball) :-
    translating(Ball, Term, Any, Hook),
    catch(takes(Term, Any, Hook),
          error(permission_error(_, _, _), _), true),   % it is protected
    !.

%   takes(+Term, ?Any, :Hook): a clause for Hook, which is about Any, takes
%   Term. One that takes anything does if the clauses do to which it hands it.

takes(Term, Any, Hook) :-
    predicate_property(Hook, defined),
    clause(Hook, Body),
    (   var(Any),
        Body = Module:Goal,
        callable(Goal),
        arg(_, Goal, Arg),
        Arg == Any
    ->  takes(Term, Any, Module:Goal)
    ;   \+ Any \= Term
    ),
    !.

translating(Ball, Ball, Any, Hook) :-
    member(Hook, [ prolog:message(Any, _, _), prolog:message(_, Any, _, _),
                   '$messages':prolog_message(Any, _, _) ]).
translating(error(Formal, _), Formal, Any, Hook) :-
    member(Hook, [ prolog:error_message(Any, _, _),
                   prolog:error_message(_, Any, _, _),
                   '$messages':iso_message(Any, _, _),
                   '$messages':swi_message(Any, _, _) ]).

prolog:error_message(raised_elsewhere(Ball)) -->
    [ 'Raised elsewhere: ~p'-[Ball] ].
