:- module(typhon_user_errors,
          [ user_errors/1               % +Module
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debugging/1, nodebug/1]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module('../kernel/base/error_text', [is_remark/1]).
:- autoload(library(occurs), [sub_term/2]).
:- autoload(library(readutil), [read_file_to_string/3]).

/** <module> Errors of public predicates

An error of a public predicate is a mistake of its caller: the top level prints
its message, in one line, and neither a backtrace of this library nor the
debugger. On 9.0.4 an error that passes a cleanup handler or a choice point,
and that nothing catches, opens the debugger at the top level. So public
predicates catch their errors and raise them again, with a context that
library(prolog_stack) does not change.

An error that an argument of the call has caused names the predicate and the
argument, as its PlDoc comment does; an unbound argument is one that the comment
does not call an output.

After `debug(typhon(errors))` errors have the backtrace of where they were
raised.

*Threading*: any thread.
*/

:- multifile
    prolog:message_context//1,
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
        reported(@(Wrapped, Caller), Home:Head, Reported)
    ;   reported(Wrapped, Home:Head, Body)
    ),
    wrap_predicate(Home:Head, typhon_user_errors, Wrapped, Body).

reported(Goal, Call,
         catch_with_backtrace(
             Goal, error(Formal, Context),
             typhon_user_errors:raise_again(Call, Formal, Context))).

defined_in(Module, Head, Home) :-
    predicate_property(Module:Head, imported_from(Home)),
    !.
defined_in(Module, _, Module).

:- public raise_again/3.        % called by the wrappers

raise_again(_, Formal, Context) :-
    debugging(typhon(errors)),
    !,
    throw(error(Formal, Context)).
raise_again(Call, Formal, Context0) :-
    without_stack(Context0, Call, Formal, Context),
    nb_setval(typhon_raised, Context),
    throw(error(Formal, Context)).

%   Other contexts, such as those of syntax errors, hold a place in a file, and
%   get no backtrace.

without_stack(Context, _, _, Context) :-
    nonvar(Context),
    Context \= context(_, _),
    !.
without_stack(context(Caller, Text), Call, Formal, context(By, Text)) :-
    raised_by(Caller, Call, Formal, By).

raised_by(_, Call, Formal, raised(argument(Name/Arity, Argument, Variable))) :-
    cause(Formal, Call, Argument, Variable),
    !,
    Call = _:Head,
    functor(Head, Name, Arity).
raised_by(Caller, _, _, By) :-
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

is_raised(Context) :-
    subsumes_term(context(raised(_), _), Context).

                /*******************************
                *           ARGUMENTS          *
                *******************************/

%   cause(+Formal, +Call, -Argument, -Variable) is semidet: Argument is the name
%   of the argument of Call that caused Formal, Variable that of its variable at
%   the top level if an earlier query has bound this name, else ''.

cause(Formal, Call, Name, Variable) :-
    \+ \+ culprit(Formal, Call, _),
    documented(Call, Modes),
    culprit(Formal, Call, I-Argument),
    nth1(I, Modes, Mode),
    named(Mode, Formal, Name),
    !,
    ( queried(Argument, Variable) -> true ; Variable = '' ).

culprit(instantiation_error, Call, I-Argument) :-
    argument(Call, I, _, Argument),
    var(Argument).
culprit(instantiation_error, Call, I-Variable) :-
    argument(Call, I, data, Argument),
    term_variables(Argument, [Variable|_]).
culprit(Formal, Call, I-none) :-
    wrong(Formal, Value),
    nonvar(Value),
    argument(Call, I, Kind, Argument),
    is_culprit(Kind, Value, Argument).

wrong(Formal, Value) :-
    nonvar(Formal),
    ( Formal = type_error(_, Value) ; Formal = domain_error(_, Value)
    ; Formal = uninstantiation_error(Value) ).

is_culprit(_, Value, Argument) :-
    strip_module(Value, _, Plain),
    Plain =@= Argument,
    !.
is_culprit(data, Value, Argument) :-
    acyclic_term(Argument),
    sub_term(Part, Argument),
    Part =@= Value,
    !.

%   argument(+Call, -I, -Kind, -Argument) is nondet: a goal is no data of its
%   call.

argument(Module:Head, I, Kind, Argument) :-
    functor(Head, Name, Arity),
    functor(Spec, Name, Arity),
    ignore(predicate_property(Module:Head, meta_predicate(Spec))),
    between(1, Arity, I),
    arg(I, Spec, Mode),
    arg(I, Head, Argument0),
    (   Mode == (:)
    ->  Kind = data,
        strip_module(Argument0, _, Argument)
    ;   ( integer(Mode) ; Mode == (^) ; Mode == (//) )
    ->  Kind = goal,
        strip_module(Argument0, _, Argument)
    ;   Kind = data,
        Argument = Argument0
    ).

%   queried(+Variable, -Name): the query of the top level calls it Name, as an
%   earlier query did that has given a value to Name.

queried(Variable, Name) :-
    var(Variable),
    prolog_current_frame(Frame),
    query_bindings(Frame, 1000, Bindings),
    member(Name=Value, Bindings),
    Value == Variable,
    toplevel_variables:toplevel_var(Name, _),
    !.

query_bindings(Frame, _, Bindings) :-
    prolog_frame_attribute(Frame, predicate_indicator,
                           '$toplevel':'$execute_goal2'/3),
    !,
    prolog_frame_attribute(Frame, argument(2), Bindings).
query_bindings(Frame, Depth, Bindings) :-
    Depth > 0,
    prolog_frame_attribute(Frame, parent, Parent),
    Higher is Depth-1,
    query_bindings(Parent, Higher, Bindings).

%   named(+Mode, +Formal, -Name): the argument is called Name, and can cause the
%   error Formal: an output cannot be unbound by mistake.

named(-(_), instantiation_error, _) :-
    !,
    fail.
named(Mode:_, Formal, Name) :-
    !,
    named(Mode, Formal, Name).
named('$VAR'(Name), _, Name) :-
    !.
named(Mode, _, Name) :-
    compound(Mode),
    arg(1, Mode, First),
    named(First, none, Name).

%   documented(+Call, -Modes): Modes are the arguments in the PlDoc comment of
%   the predicate. Without its source the names of arguments are numbers.

documented(Module:Head, Modes) :-
    functor(Head, Name, Arity),
    predicate_property(Module:Head, file(File)),
    catch(read_file_to_string(File, Text, [encoding(utf8)]),
          error(_, _), fail),
    format(string(Begin), "\n%!  ~w(", [Name]),
    sub_string(Text, Before, _, _, Begin),
    Start is Before+5,
    sub_string(Text, Start, _, 0, Rest),
    once(sub_string(Rest, Length, _, _, "\n\n")),
    sub_string(Rest, 0, Length, _, Comment),
    modes(Comment, Name/Arity, Modes),
    !.
documented(_:Head, Modes) :-
    functor(Head, _, Arity),
    findall(+('$VAR'(I)), between(1, Arity, I), Modes).

:- op(200, fy, [?, :, @]).

modes(Comment, Name/Arity, Modes) :-
    split_string(Comment, "\n", "%", Lines),
    atomic_list_concat(Lines, Line),
    sub_string(Line, Before, 1, _, ")"),
    End is Before+1,
    sub_string(Line, 0, End, _, Text),
    catch(term_string(Term, Text, [ module(typhon_user_errors),
                                    variable_names(Names) ]),
          error(syntax_error(_), _), fail),
    functor(Term, Name, Arity),
    !,
    maplist(variable_named, Names),
    Term =.. [_|Modes].

variable_named(Name='$VAR'(Name)).

                /*******************************
                *             TEXT             *
                *******************************/

prolog:message_location(context(Raised, _)) -->
    { nonvar(Raised),
      Raised = raised(Where) },
    where(Where).

where(Where) -->
    { subsumes_term(argument(_/_, _, _), Where),
      Where = argument(Name/Arity, Argument, _),
      maplist(atomic, [Name, Arity, Argument]) },
    !,
    [ '~q, argument ~w: '-[Name/Arity, Argument] ].
where(_) -->
    [].

prolog:message_context(context(Raised, Text)) -->
    { subsumes_term(raised(argument(_, _, _)), Raised),
      Raised = raised(argument(_, _, Variable)),
      atom(Variable),
      Variable \== '' },
    [ ' (its value in an earlier query is $~w)'-[Variable] ],
    ( { is_remark(Text) } -> [ ' (~w)'-[Text] ] ; [] ).
