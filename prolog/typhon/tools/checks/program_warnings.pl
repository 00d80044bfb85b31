:- module(typhon_program_warnings,
          [ program_warnings/3,         % +Located, +Kinds, -Warnings
            apart_problem/3,            % +Rules, +Known, -Problem
            unknown_problems/2,         % +Located, -Problems
            unknown_advice/3            % +PI, +Own, -Advice
          ]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- autoload(library(solution_sequences), [distinct/2]).
:- use_module('../../kernel/base/names', [names_near/3]).
:- use_module('../../kernel/program',
              [ body_calls/2, built_in/1, file_parts/4, indicator_in/2,
                library_directive/2, near_built_in/2, part/3 ]).
:- use_module(lost_choices, [lost_choice/3]).

/** <module> Warnings: likely mistakes in a program

These warnings do not keep a program from running.  They are problems as in
typhon_parts.

*Threading*: pure, except that a library is looked up.
*/

%!  program_warnings(+Located, +Kinds, -Warnings:list) is det.
%
%   Warnings are the likely mistakes in the agent program Located, terms with
%   their locations.  Kinds are the kinds of its predicates; if there are none,
%   the program has errors, and gets no warnings.

program_warnings(_, [], []) :-
    !.
program_warnings(Located, Kinds, Warnings) :-
    file_parts(agent, Located, Parts, _),
    findall(Problem, likely_mistake(Parts, Kinds, Problem), Warnings).

likely_mistake(Parts, Kinds, Problem) :-
    part(rules, Parts, Rules),
    part(directives, Parts, Directives),
    part(state, Parts, State),
    findall(PI, member(PI-mobile, Kinds), Mobile),
    (   apart_problem(Rules, Directives-State, Problem)
    ;   undeclared_problem(Rules, State, Problem)
    ;   lost_choice(Rules, own(State, Mobile), Problem)
    ).

%!  apart_problem(+Rules, +Known, -Problem) is nondet.
%
%   Problem is a predicate with clauses of other predicates between its own.
%   Rules have their locations; Known is Directives-State, where State are the
%   indicators of mutable predicates.

apart_problem(Rules, Directives-State,
              problem(discontiguous(PI), Location, discontiguous(PI))) :-
    distinct(PI, apart(Rules, PI, Location)),
    \+ memberchk(PI, State),
    \+ declared_discontiguous(Directives, PI).

%   A changed predicate is neither in the program nor in State.

undeclared_problem(Rules, State,
                   problem(undeclared_state(PI), Location, undeclared(PI))) :-
    distinct(PI, changed(Rules, PI, Location)),
    \+ memberchk(PI, State),
    \+ defined(Rules, PI),
    \+ reserved(PI).

%   Predicates of the vocabulary keep facts in the state of an agent under names
%   that begin with $; programs do not declare these.

reserved(Name/_) :-
    sub_atom(Name, 0, _, _, $).

%   apart(+Clauses, -PI, -Location) is nondet: a clause of PI is at Location;
%   other clauses of PI are before it, and the clause directly before it is of
%   another predicate.

apart(Clauses, PI, Location) :-
    append(Before, [Clause-Location|_], Clauses),
    last(Before, Last-_),
    indicator(Clause, PI),
    \+ indicator(Last, PI),
    defined(Before, PI).

defined(Clauses, PI) :-
    member(Clause-_, Clauses),
    indicator(Clause, PI),
    !.

indicator((Head:-_), Name/Arity) :-
    functor(Head, Name, Arity).

declared_discontiguous(Directives, PI) :-
    member((:- discontiguous(PIs))-_, Directives),
    indicator_in(PIs, PI),
    !.

changed(Clauses, PI, Location) :-
    member((_:-Body)-Location, Clauses),
    body_calls(Body, Calls),
    member(changes(PI), Calls).

                /*******************************
                *     UNDEFINED PREDICATES     *
                *******************************/

%   A place or a payload may define an undefined predicate, or its name is
%   mistyped.

%!  unknown_problems(+Located, -Problems:list) is det.
%
%   Problems are unknown_procedure(PI) for each predicate that the agent program
%   Located calls, and that neither the program nor Prolog nor the vocabulary
%   defines.  Predicates that the program changes are its state, declared or
%   not.

unknown_problems(Located, Problems) :-
    file_parts(agent, Located, Parts, _),
    part(rules, Parts, Rules),
    findall(PI, own(Parts, PI), Own0),
    sort(Own0, Own),
    findall(problem(unknown_procedure(PI), Location, Advice),
            ( unknown(Rules, Own, Parts, PI, Location),
              unknown_advice(PI, Own, Advice) ),
            Problems0),
    sort(Problems0, Problems).

unknown(Rules, Own, Parts, PI, Location) :-
    member((_:-Body)-Location, Rules),
    body_calls(Body, Calls),
    member(call(PI, _), Calls),
    \+ memberchk(PI, Own),
    \+ built_in(PI),
    \+ imported(Parts, PI).

own(Parts, Name/Arity) :-
    part(rules, Parts, Rules),
    member((Head:-_)-_, Rules),
    callable(Head),
    functor(Head, Name, Arity).
own(Parts, PI) :-
    part(rules, Parts, Rules),
    member((_:-Body)-_, Rules),
    body_calls(Body, Calls),
    member(changes(PI), Calls).
own(Parts, PI) :-
    part(state, Parts, State),
    member(PI, State).

imported(Parts, PI) :-
    library_directive(Parts, Library-_),
    exports(Library, PI),
    !.

exports(Library, PI) :-
    absolute_file_name(Library, File,
                       [ file_type(prolog), access(read),
                         file_errors(fail) ]),
    load_files(File, [if(not_loaded), imports([])]),
    module_property(Module, file(File)),
    exported(Module, PI).

exported(Module, PI) :-
    module_property(Module, exports(Exports)),
    memberchk(PI, Exports).

%!  unknown_advice(+PI, +Own:list, -Advice) is det.
%
%   Advice, see typhon_problem_text, proposes a fix for a call of PI in a
%   program whose own predicates are Own: import library(typhon), or call a
%   predicate with the same name and another arity, or with a similar name.

unknown_advice(PI, _, of_library(typhon)) :-
    exported(typhon, PI),
    !.
unknown_advice(Name/Arity, Own, offered(Near)) :-
    findall(PI, ( member(PI, Own) ; near_built_in(Name/Arity, PI) ), PIs),
    findall(Name/N, member(Name/N, PIs), Same),
    ( Same == [] -> Known = PIs ; Known = Same ),
    sort(Known, Sorted),
    names_near(Name, Sorted, Near).
