:- module(typhon_user_errors,
          [ user_errors/1               % +Module
          ]).
:- use_module(library(debug), [debugging/1, nodebug/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).

/** <module> Errors of public predicates

An error of a public predicate is a mistake of its caller: the top level prints
its message, in one line, and neither a backtrace of this library nor the
debugger. On 9.0.4 an error that passes a cleanup handler or a choice point,
and that nothing catches, opens the debugger at the top level. So public
predicates catch their errors and raise them again, with a context that
library(prolog_stack) does not change.

After `debug(typhon(errors))` errors have the backtrace of where they were
raised.

*Threading*: any thread.
*/

:- multifile
    prolog:message_location//1,
    prolog:prolog_exception_hook/5,
    user:prolog_exception_hook/4.

:- dynamic
    public_module/1,            % Module
    prolog:prolog_exception_hook/5,
    user:prolog_exception_hook/4.

%   Create the topic, so that debug/1 does not warn.

:- nodebug(typhon(errors)).

%!  user_errors(+Module) is det.
%
%   Errors of all predicates that Module exports are errors of their callers.

user_errors(Module) :-
    retractall(public_module(Module)),
    assertz(public_module(Module)),
    wrap_exports(Module).

%   A saved state does not keep wrappers.

:- initialization(forall(public_module(Module), wrap_exports(Module)),
                  restore_state).

wrap_exports(Module) :-
    module_property(Module, exports(PIs)),
    forall(member(PI, PIs), wrap(Module, PI)).

%   The wrapper calls a module transparent predicate in the context of its
%   caller, because 9.2 does not.

wrap(Module, Name/Arity) :-
    functor(Head, Name, Arity),
    defined_in(Module, Head, Home),
    (   predicate_property(Home:Head, transparent)
    ->  Body = ( prolog_current_frame(Frame),
                 prolog_frame_attribute(Frame, context_module, Caller),
                 Reported ),
        reported(@(Wrapped, Caller), Reported)
    ;   reported(Wrapped, Body)
    ),
    wrap_predicate(Home:Head, typhon_user_errors, Wrapped, Body).

reported(Goal,
         catch_with_backtrace(
             Goal, error(Formal, Context),
             typhon_user_errors:raise_again(Formal, Context))).

defined_in(Module, Head, Home) :-
    predicate_property(Module:Head, imported_from(Home)),
    !.
defined_in(Module, _, Module).

:- public raise_again/2.        % called by the wrappers

raise_again(Formal, Context) :-
    debugging(typhon(errors)),
    !,
    throw(error(Formal, Context)).
raise_again(Formal, Context0) :-
    without_stack(Context0, Context),
    nb_setval(typhon_raised, Context),
    throw(error(Formal, Context)).

%   Other contexts, such as those of syntax errors, hold a place in a file, and
%   get no backtrace.

without_stack(Context, Context) :-
    nonvar(Context),
    Context \= context(_, _),
    !.
without_stack(context(Caller, Text), context(By, Text)) :-
    raised_by(Caller, By).

raised_by(Caller, raised(_)) :-
    var(Caller),
    !.
raised_by(prolog_stack(_), raised(_)) :-
    !.
raised_by(Caller, raised(Caller)) :-
    is_indicator(Caller),
    !.
raised_by(Caller, Caller).              % it holds more than a predicate

is_indicator(_:_).
is_indicator(_/_).

%   These clauses run before the hook of library(prolog_stack), which would add
%   a backtrace.

:- asserta((user:prolog_exception_hook(Error, Error, _, _) :-
                typhon_user_errors:raised_again(Error))).
:- asserta((prolog:prolog_exception_hook(Error, Error, _, _, _) :-
                typhon_user_errors:raised_again(Error))).

:- public raised_again/1.

raised_again(error(_, Context)) :-
    is_raised(Context),
    !.
raised_again(error(_, Context)) :-
    nb_current(typhon_raised, Last),
    Last =@= Context.

prolog:message_location(Context) -->
    { is_raised(Context) }.

is_raised(Context) :-
    subsumes_term(context(raised(_), _), Context).
