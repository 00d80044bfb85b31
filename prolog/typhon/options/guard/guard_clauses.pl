:- module(typhon_guard_clauses,
          [ guard_program/3,            % +Policy, +Program0, -Program
            guard_refuses/4,            % +Policy, +Program, +Clause, -Formal
            guard_state/3,              % +Policy, +State0, -State
            guard_clauses/3,            % +Policy, +Clauses0, -Clauses
            guard_declares/2,           % +Policy, +PI
            allowed_fact/2              % +Fact, +Max
          ]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/2, maplist/3]).
:- use_module(library(assoc), [empty_assoc/1, put_assoc/4]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/program', [clause_parts/3]).
:- use_module(allowed, [allowed_library/1, definable/1, own_name/1]).
:- use_module(guard_bodies, [guard/3, guard_parts/1]).
:- use_module(guard_limits, [clause_cells/1, must_be_tree/1, refuse/1]).

/** <module> Programs and clauses of untrusted agents

A program is rewritten before it runs.  Known goals are checked now, and those
that are not allowed, see typhon_allowed, are refused.  A goal that will be
known only at run time, or whose safety depends on its arguments, becomes

    '$checked'(Goal)            '$checked'(Closure, A, ...)

which is checked when it runs, see typhon_guard_calls.  The recovery goal of
catch/3 begins with '$uncaught'(Ball), see typhon_checked.  A goal M:G is always
refused.  Rewriting a rewritten program changes nothing, and a rewritten program
means the same on a host that runs programs as they are.

An agent may have static predicates of any name: they are found first, as
long as it has its program.  Dynamic predicates (state, payloads) must not have
the name of a forbidden predicate, else a goal that calls the agent's own
predicate today would call that of the system tomorrow.

*Threading*: pure.
*/

%!  guard_program(+Policy, +Program0, -Program) is det.
%
%   Program is Program0 rewritten for Policy.
%
%   @error permission_error(call, sandboxed, Goal) if Goal is not allowed: a
%          goal, `:- use_module(Library)`, or the name of a predicate

guard_program(Policy, program(Name, State, Libraries0, Clauses0),
              program(Name, State, Libraries, Clauses)) :-
    exclude(is_typhon, Libraries0, Libraries),
    maplist(library_allowed, Libraries),
    maplist(state_allowed, State),
    heads(Clauses0, Own),
    maplist(guard_clause(own(heads(Own), Policy)), Clauses0, Clauses).

%!  guard_refuses(+Policy, +Program:list, +Clause, -Formal) is semidet.
%
%   Formal is the error by which Clause, a clause of Program, is refused.

guard_refuses(Policy, Clauses, Clause, Formal) :-
    heads(Clauses, Own),
    catch(( guard_clause(own(heads(Own), Policy), Clause, _), fail ),
          error(Formal, _), true).

%   Importing library(typhon) is harmless and has no effect: untrusted agents
%   can call only its vocabulary, which they have already.

is_typhon(Library-_) :-
    Library == library(typhon).

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
        definable(Head)
    ->  functor(Head, Name, Arity),
        put_assoc(Name/Arity, Own0, true, Own)
    ;   refuse(Head)
    ).

guard_clause(Own, Clause0, Clause) :-
    clause_parts(Clause0, Head, Body0),
    must_be_tree(Clause0),
    (   Body0 == true
    ->  Clause = Clause0
    ;   clause_cells(Max),
        guard_parts(Max),
        guard(Body0, Own, Body),
        Clause = (Head:-Body)
    ).

%!  guard_state(+Policy, +State0, -State) is det.
%!  guard_clauses(+Policy, +Clauses0:list, -Clauses:list) is det.
%!  guard_declares(+Policy, +PI) is det.
%
%   Guard the state of an agent, see agent_state/2; guard clauses, such as those
%   of a payload; check a predicate that a payload defines.
%
%   @error permission_error(call, sandboxed, Culprit)

guard_state(Policy, state(PIs, Clauses0), state(PIs, Clauses)) :-
    maplist(declared_allowed, PIs),
    clause_cells(Max),
    maplist(guard_fact(Max, own(none, Policy)), Clauses0, Clauses).

guard_fact(Max, _, Fact, Fact) :-
    allowed_fact(Fact, Max),
    !.
guard_fact(_, _, Fact, Fact) :-
    nonvar(Fact),
    of_platform(Fact),
    !,
    must_be_tree(Fact).
guard_fact(_, Own, Clause0, Clause) :-
    guard_own_clause(Own, Clause0, Clause).

%!  allowed_fact(+Fact, +Max) is semidet.
%
%   Fact may be a fact of an untrusted agent: it has at most Max parts.

allowed_fact(Fact, Max) :-
    callable(Fact),
    Fact \= (_:-_),
    Fact \= _:_,
    own_name(Fact),
    is_tree(Fact, Max).

declared_allowed(Name/Arity) :-
    functor(Fact, Name, Arity),
    of_platform(Fact),
    !.
declared_allowed(PI) :-
    state_allowed(PI).

%   The platform keeps these facts in the state; no agent can name them.

of_platform('$global'(_, _)).
of_platform('$legacy'(_)).
of_platform('$memory'(_)).
of_platform('$owner'(_)).
of_platform('$trail'(_, _, _, _)).
of_platform('$signed'(_, _)).

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

