:- module(typhon_guard,
          [ guard_program/3,            % +Policy, +Program0, -Program
            guard_refuses/4,            % +Policy, +Program, +Clause, -Formal
            guard_state/3,              % +Policy, +State0, -State
            guard_clauses/3,            % +Policy, +Clauses0, -Clauses
            guard_declares/2,           % +Policy, +PI
            guard_goals/3,              % +Own, +Goals0, -Goals
            guard_called/3,             % +Own, +Goal0, -Goal
            guard_closure/4             % +Own, +Closure, +Extra, -Goal
          ]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(assoc),
              [empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module(allowed, [allowed/3, allowed_library/1, own_name/1]).
:- use_module(machine, [control/1]).
:- use_module(source, [clause_parts/3]).

/** <module> Programs of strangers

A program of a stranger is rewritten before it runs.  Goals that are known
are looked at now: what is not allowed, see typhon_allowed, is refused.  What
will only be known at run time, and what depends on its arguments, becomes

    '$guarded'(Goal)            '$guarded'(Closure, A, ...)

which looks then, see typhon_guarded.  A goal M:G is refused always.  What
has been rewritten stays the same when it is rewritten again, and means the
same on a host that guards nothing.

An agent may have static predicates of any name: they are found first, as
long as it has its program.  What comes and goes (state, payloads) must not
have the name of what is to be kept from it, else a goal that is the agent's
own today would be the system's tomorrow.

*Threading*: pure.
*/

:- setting(atom_chars, positive_integer, 1000,
           "Atoms that strangers make have at most so many characters").
:- setting(ball_cells, positive_integer, 10 000,
           "What strangers throw has at most so many parts").
:- setting(clause_cells, positive_integer, 200 000,
           "Clauses that strangers add have at most so many parts").

%!  guard_program(+Policy, +Program0, -Program) is det.
%
%   @error permission_error(call, sandboxed, Goal) for what is not allowed:
%          a goal, `:- use_module(Library)`, or the name of a predicate

guard_program(Policy, program(Name, State, Libraries, Clauses0),
              program(Name, State, Libraries, Clauses)) :-
    maplist(library_allowed, Libraries),
    maplist(state_allowed, State),
    heads(Clauses0, Own),
    maplist(guard_clause(own(heads(Own), Policy)), Clauses0, Clauses).

%!  guard_refuses(+Policy, +Program:list, +Clause, -Formal) is semidet.
%
%   Clause, one of those of Program, is why that is not let in.

guard_refuses(Policy, Clauses, Clause, Formal) :-
    heads(Clauses, Own),
    catch(( guard_clause(own(heads(Own), Policy), Clause, _), fail ),
          error(Formal, _), true).

library_allowed(Library-Imports) :-
    (   ground(Library),
        allowed_library(Library),
        ( Imports == all ; is_list(Imports), maplist(is_indicator, Imports) )
    ->  true
    ;   refuse((:- use_module(Library)))
    ).

is_indicator(Import) :-
    ground(Import),
    Import = Name/Arity,
    atom(Name),
    integer(Arity).

state_allowed(PI) :-
    (   is_indicator(PI),
        PI = Name/Arity,
        between(0, 255, Arity),
        functor(Head, Name, Arity),
        own_name(Head)
    ->  true
    ;   refuse(PI)
    ).

heads(Clauses, Own) :-
    empty_assoc(Empty),
    foldl(add_head, Clauses, Empty, Own).

add_head(Clause, Own0, Own) :-
    clause_parts(Clause, Head, _),
    (   callable(Head),
        functor(Head, Name, Arity),
        \+ reserved(Name, Arity)
    ->  put_assoc(Name/Arity, Own0, true, Own)
    ;   refuse(Head)
    ).

reserved(:, 2).
reserved(Name, _) :- sub_atom(Name, 0, _, _, $).
reserved(Name, _) :- sub_atom(Name, 0, _, _, 'mobile ').

guard_clause(Own, Clause0, Clause) :-
    clause_parts(Clause0, Head, Body0),
    must_be_tree(Clause0),
    (   Body0 == true
    ->  Clause = Clause0
    ;   guard(Body0, Own, Body),
        Clause = (Head:-Body)
    ).

%!  guard_state(+Policy, +State0, -State) is det.
%!  guard_clauses(+Policy, +Clauses0, -Clauses) is det.
%!  guard_declares(+Policy, +PI) is det.
%
%   The state of an agent, as of agent_state/2; clauses, as those of a
%   payload; and what a payload provides.

guard_state(Policy, state(PIs, Clauses0), state(PIs, Clauses)) :-
    maplist(declared_allowed, PIs),
    maplist(guard_fact(own(none, Policy)), Clauses0, Clauses).

declared_allowed('$legacy'/1) :-
    !.
declared_allowed(PI) :-
    state_allowed(PI).

%   Facts of the platform in its state: what it leaves behind, who had it, and
%   whose it is.

guard_fact(_, Fact, Fact) :-
    nonvar(Fact),
    of_platform(Fact),
    !,
    must_be_tree(Fact).
guard_fact(_, Fact, Fact) :-
    callable(Fact),
    Fact \= (_:-_),
    Fact \= _:_,
    own_name(Fact),
    !,
    must_be_tree(Fact).
guard_fact(Own, Clause0, Clause) :-
    guard_own_clause(Own, Clause0, Clause).

of_platform('$legacy'(_)).
of_platform('$trail'(_, _)).
of_platform('$owner'(_)).

guard_declares(_, PI) :-
    state_allowed(PI).

guard_clauses(Policy, Clauses0, Clauses) :-
    maplist(guard_own_clause(own(none, Policy)), Clauses0, Clauses).

guard_own_clause(Own, Clause0, Clause) :-
    clause_head(Clause0, Head),
    (   callable(Head),
        Head \= _:_,
        own_name(Head)
    ->  guard_clause(Own, Clause0, Clause)
    ;   refuse(Head)
    ).

clause_head(Clause, Head) :-
    clause_parts(Clause, Head, _).

%!  guard_goals(+Own, +Goals0, -Goals) is det.
%
%   Goals are what an agent is to do.  Own is own(module(Module), Policy) for
%   one that has the program in Module.

guard_goals(Own, Goals0, Goals) :-
    must_be_tree(Goals0),
    maplist(guard_left(Own), Goals0, Goals).

%   What stands in a suspended list besides goals of the program.

guard_left(_, Goal, Goal) :-
    nonvar(Goal),
    Goal = '$fault'(_),
    !.
guard_left(Own, Goal0, Goal) :-
    guard(Goal0, Own, Goal).

%!  guard_called(+Own, +Goal0, -Goal) is det.
%
%   Goal may be called now.
%
%   @error instantiation_error
%   @error permission_error(call, sandboxed, Culprit)

guard_called(Own, Goal0, Goal) :-
    (   var(Goal0)
    ->  throw(error(instantiation_error, _))
    ;   acyclic_term(Goal0)
    ->  guard_now(Goal0, Own, Goal)
    ;   refuse_cyclic(Goal0)
    ).

guard_now(Goal, Own, Goal) :-
    control(Goal),
    functor(Goal, Name, _),
    Name \== call,
    \+ sub_atom(Name, 0, _, _, $),
    \+ own(Goal, Own),
    !.
guard_now(Goal0, Own, Goal) :-
    plain(Goal0, Own),
    Own = own(_, Policy),
    allowed(Policy, Goal0, look(Kind)),
    !,
    looked(Kind, Policy, Goal0, Goal).
guard_now(Goal0, Own, Goal) :-
    guard(Goal0, Own, Goal).

%   plain(+Goal, +Own): Goal is no construct, and not the agent's own.

plain(Goal, Own) :-
    callable(Goal),
    \+ own(Goal, Own).

refuse_cyclic(Goal) :-
    functor(Goal, Name, Arity),
    refuse(cyclic(Name/Arity)).

%!  guard_closure(+Own, +Closure, +Extra:list, -Goal) is det.
%
%   Goal is Closure called with Extra.  Of a lambda expression the body is
%   guarded, for its parameters may be goals.

guard_closure(Own, Closure, Extra, Goal) :-
    (   is_lambda(Closure)
    ->  length(Extra, N),
        lambda(Closure, N, Own, Closure1),
        extended(Closure1, Extra, Goal)
    ;   extended(Closure, Extra, Goal0),
        guard_called(Own, Goal0, Goal)
    ).

extended(Closure, Extra, Goal) :-
    (   callable(Closure),
        Closure \= _:_
    ->  Closure =.. List0,
        append(List0, Extra, List),
        Goal =.. List
    ;   refuse(Closure)
    ).

                /*******************************
                *            GOALS             *
                *******************************/

%   guard(+Body0, +Own, -Body): Own is own(Heads, Policy), where Heads is
%   heads(Assoc) or module(Module), where the static predicates are, or
%   `none`.

guard(Goal, _, '$guarded'(Goal)) :-
    var(Goal),
    !.
guard(Goal0, Own, Goal) :-
    construct(Goal0, Parts0, Goal, Parts),
    !,
    maplist(guard_part(Own), Parts0, Parts).
guard(Goal, _, Goal) :-
    passes(Goal),
    !.
guard(Goal, Own, Goal) :-
    own(Goal, Own),
    !.
guard(sleep(Seconds), _, '$guarded'(sleep(Seconds))) :-
    !.
guard(Goal0, Own, Goal) :-
    callable(Goal0),
    Goal0 \= _:_,
    Own = own(_, Policy),
    allowed(Policy, Goal0, How),
    !,
    guard_allowed(How, Goal0, Own, Goal).
guard(Goal0, Own, Goal) :-
    compound(Goal0),
    compound_name_arguments(Goal0, call, [Closure0|Extra]),
    Extra \== [],
    !,
    length(Extra, N),
    closure(N, Own, Closure0, Closure),
    compound_name_arguments(Goal, call, [Closure|Extra]).
guard(phrase(NT, List), Own, phrase(NT1, List)) :-
    !,
    non_terminal(NT, Own, NT1).
guard(phrase(NT, List, Rest), Own, phrase(NT1, List, Rest)) :-
    !,
    non_terminal(NT, Own, NT1).
guard(Goal, _, Goal) :-
    callable(Goal),
    unknown(Goal),
    !.
guard(Goal, _, _) :-
    refuse(Goal).

guard_part(Own, Part0, Part) :-
    guard(Part0, Own, Part).

construct((A0,B0), [A0,B0], (A,B), [A,B]).
construct((A0;B0), [A0,B0], (A;B), [A,B]).
construct((A0->B0), [A0,B0], (A->B), [A,B]).
construct((A0*->B0), [A0,B0], (A*->B), [A,B]).
construct(\+A0, [A0], \+A, [A]).
construct(call(A0), [A0], call(A), [A]).
construct(once(A0), [A0], once(A), [A]).
construct(ignore(A0), [A0], ignore(A), [A]).
construct(catch(A0,C,B0), [A0,B0], catch(A,C,B), [A,B]).

%   What is guarded already, where a suspended agent goes on, and what an
%   agent says to stop, but for what the system would do in its place.

passes(Goal) :-
    compound(Goal),
    compound_name_arity(Goal, '$guarded', _).
passes('$at'(_, Answer)) :-
    ( Answer == fail ; subsumes_term(throw(error(_, _)), Answer) ).
passes(Goal) :-
    control(Goal),
    Goal \= sleep(_),
    functor(Goal, Name, _),
    Name \== call,
    \+ sub_atom(Name, 0, _, _, $).

%   Nothing but the agent or what its place offers can have it.

unknown(Goal) :-
    Goal \= _:_,
    own_name(Goal),
    \+ allowed(guarded, Goal, _).

own(Goal, own(Heads, _)) :-
    defined_in(Heads, Goal).

defined_in(heads(Own), Goal) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    get_assoc(Name/Arity, Own, _).
defined_in(module(Module), Goal) :-
    callable(Goal),
    Goal \= _:_,
    '$c_current_predicate'(_, Module:Goal),
    '$get_predicate_attribute'(Module:Goal, transparent, 1),
    \+ '$get_predicate_attribute'(Module:Goal, imported, _).

guard_allowed(free, Goal, _, Goal).
guard_allowed(look(_), Goal, _, '$guarded'(Goal)).
guard_allowed(runs(Spec), Goal0, Own, Goal) :-
    compound_name_arguments(Goal0, Name, Args0),
    compound_name_arguments(Spec, _, Modes),
    maplist(argument(Own), Modes, Args0, Args),
    compound_name_arguments(Goal, Name, Args).

argument(Own, 0, Goal0, Goal) =>
    guard(Goal0, Own, Goal).
argument(Own, ^, Goal0, Goal) =>
    below_variables(Goal0, Own, Goal).
argument(Own, N, Closure0, Closure), integer(N) =>
    closure(N, Own, Closure0, Closure).
argument(_, _, Arg0, Arg) =>
    Arg = Arg0.

below_variables(Goal0, Own, Goal) :-
    nonvar(Goal0),
    Goal0 = V^Below0,
    !,
    Goal = V^Below,
    below_variables(Below0, Own, Below).
below_variables(Goal0, Own, Goal) :-
    guard(Goal0, Own, Goal).

%   closure(+N, +Own, +Closure0, -Closure): to be called with N arguments
%   more.  One whose goals are not as they stand is looked at when it is
%   called.

closure(_, _, Closure, '$guarded'(Closure)) :-
    var(Closure),
    !.
closure(_, _, Closure, Closure) :-
    passes(Closure),
    !.
closure(N, Own, Closure0, Closure) :-
    is_lambda(Closure0),
    !,
    lambda(Closure0, N, Own, Closure).
closure(N, Own, Closure0, Closure) :-
    callable(Closure0),
    Closure0 \= _:_,
    !,
    length(Extra, N),
    extended(Closure0, Extra, Goal0),
    guard(Goal0, Own, Goal),
    (   Goal == Goal0
    ->  Closure = Closure0
    ;   Closure = '$guarded'(Closure0)
    ).
closure(_, _, Closure, _) :-
    refuse(Closure).

is_lambda(Closure) :-
    nonvar(Closure),
    ( Closure = _>>_ ; Closure = _/_ ),
    !.

lambda(Free/Lambda0, N, Own, Free/Lambda) :-
    !,
    closure(N, Own, Lambda0, Lambda).
lambda(Parameters>>Body0, N, Own, Parameters>>Body) :-
    parameters(Parameters, Count),
    !,
    Rest is max(0, N-Count),
    (   Rest =:= 0
    ->  guard(Body0, Own, Body)
    ;   closure(Rest, Own, Body0, Body)
    ).
lambda(Lambda, _, _, _) :-
    refuse(Lambda).

parameters(Parameters, Count) :-
    nonvar(Parameters),
    ( Parameters = _/List -> true ; List = Parameters ),
    is_list(List),
    length(List, Count).

%   A grammar rule by its name, not a body of one.

non_terminal(NT, _, _) :-
    ( var(NT) ; \+ callable(NT) ; is_list(NT) ; body_of_grammar(NT) ),
    !,
    refuse(phrase(NT, _)).
non_terminal(NT0, Own, NT) :-
    closure(2, Own, NT0, NT).

body_of_grammar((_,_)).
body_of_grammar((_;_)).
body_of_grammar((_|_)).
body_of_grammar((_->_)).
body_of_grammar(\+_).
body_of_grammar({_}).
body_of_grammar(!).
body_of_grammar(NT) :- functor(NT, call, _).

                /*******************************
                *          ARGUMENTS           *
                *******************************/

%   looked(+Kind, +Policy, +Goal0, -Goal): what a goal depends on is known now.

looked(clause, Policy, Goal0, Goal) :-
    Goal0 =.. [Name,Clause0],
    must_be_tree(Clause0),
    nonvar(Clause0),
    \+ ( Clause0 = (Head:-_), \+ callable(Head) ),
    !,
    guard_own_clause(own(none, Policy), Clause0, Clause),
    Goal =.. [Name,Clause].
looked(pattern, _, Goal, Goal) :-
    Goal = retract(Clause),
    nonvar(Clause),
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    unqualified(Head),
    !.
looked(head, _, Goal, Goal) :-
    arg(1, Goal, Head),
    unqualified(Head),
    own_name(Head),
    !.
looked(ball, _, throw(Ball), throw(Ball)) :-
    nonvar(Ball),
    \+ ends_thread(Ball),
    setting(ball_cells, Max),
    is_tree(Ball, Max),
    !.
looked(format, _, Goal, Goal) :-
    Goal = format(Sink, Format, _),
    nonvar(Sink),
    sink(Sink),
    text_of(Format, Codes),
    harmless(Codes),
    !.
looked(text, _, Goal, Goal) :-
    short_text(Goal),
    !.
looked(term_text, _, Goal, Goal) :-
    must_be_tree(Goal),
    no_quotation(Goal),
    !.
looked(payload, _, attach(Spec), attach(Spec)) :-
    nonvar(Spec),
    Spec = payloads(Path),
    ground(Path),
    inside(Path),
    !.
looked(_, _, Goal, _) :-
    refuse(Goal).

unqualified(Head) :-
    callable(Head),
    Head \= _:_.

%   What ends a thread, or stops what is measured.

ends_thread('$aborted').
ends_thread(unwind(_)).
ends_thread(inference_limit_exceeded(_)).
ends_thread(depth_limit_exceeded).
ends_thread(time_limit_exceeded).
ends_thread(time_limit_exceeded(_)).

sink(string(_)).
sink(codes(_)).
sink(chars(_)).

text_of(Text, Codes) :-
    ( atomic(Text) ; is_list(Text), ground(Text) ),
    catch(text_to_string(Text, String), error(_, _), fail),
    string_codes(String, Codes).

%   No directive that calls (`~@`), asks others how to print (`~p`), takes
%   its width from the arguments (`~*`), or has one of more than 999.

harmless([]).
harmless([0'~|Codes]) :-
    !,
    directive(Codes, 0, Rest),
    harmless(Rest).
harmless([_|Codes]) :-
    harmless(Codes).

directive([Digit|Codes], N, Rest) :-
    code_type(Digit, digit),
    !,
    N < 3,
    N1 is N+1,
    directive(Codes, N1, Rest).
directive([0'`,_|Codes], _, Rest) :-
    !,
    directive(Codes, 0, Rest).
directive([Code|Rest], _, Rest) :-
    \+ memberchk(Code, [0'@, 0'p, 0'*, 0'i]).

%   Atoms live outside the stacks of the agent, so they are kept short;
%   long texts are strings.

short_text(Goal) :-
    setting(atom_chars, Max),
    Goal =.. [_|Args],
    text_length(Args, Max).

text_length([], _).
text_length([Arg|Args], Left) :-
    argument_length(Arg, Left, Length),
    Left1 is Left-Length,
    Left1 >= 0,
    text_length(Args, Left1).

argument_length(Arg, _, 0) :- var(Arg), !.
argument_length(Arg, Left, Length) :-
    is_list(Arg),
    !,
    length(Arg, Count),
    Count =< Left,
    items_length(Arg, 0, Length).
argument_length(Arg, _, Length) :-
    atomic(Arg),
    !,
    atom_length(Arg, Length).
argument_length(_, _, 0).               % which is a type error

items_length([], N, N).
items_length([Item|Items], N0, N) :-
    (   atomic(Item)
    ->  atom_length(Item, Length),
        N1 is N0+Length
    ;   N1 = N0
    ),
    items_length(Items, N1, N).

no_quotation(Goal) :-
    \+ ( arg(_, Goal, Text),
         atomic(Text),
         sub_string(Text, _, _, _, "{|") ).

inside(Path) :-
    (   atom(Path)
    ->  \+ sub_atom(Path, _, _, _, '..'),
        \+ is_absolute_file_name(Path)
    ;   Path = A/B,
        inside(A),
        inside(B)
    ).

%   must_be_tree(+Term): it is acyclic, and not larger than clauses may be
%   when what is shared in it is written out.

must_be_tree(Term) :-
    setting(clause_cells, Max),
    (   is_tree(Term, Max)
    ->  true
    ;   throw(error(resource_error(clause_cells), _))
    ).

%   What is large is told by its name.

refuse(Culprit) :-
    (   \+ is_tree(Culprit, 1000),
        callable(Culprit)
    ->  functor(Culprit, Name, Arity),
        permission_error(call, sandboxed, Name/Arity)
    ;   permission_error(call, sandboxed, Culprit)
    ).
