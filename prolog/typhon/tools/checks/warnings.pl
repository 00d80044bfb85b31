:- module(typhon_warnings,
          [ program_warnings/3,         % +Located, +Kinds, -Warnings
            apart_problem/3,            % +Rules, +Known, -Problem
            unknown_problems/2,         % +Located, -Problems
            print_problem/2             % +Severity, +Problem
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(lists),
              [append/2, append/3, last/2, member/2, memberchk/2]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module('../../kernel/base/names', [names_near/3]).
:- use_module('../../kernel/program',
              [ body_calls/2, built_in/1, clause_parts/3, code_program/2,
                indicator_in/2, near_built_in/2 ]).
:- use_module('../../language',
              [ advice_text/2, file_parts/4, in_file_order/3,
                library_directive/2, library_export/2, part/3, problem_error/3,
                source_same/1 ]).
:- use_module(goal_lines, [problem_at_goal/2]).
:- use_module(lost_choices, [lost_choice/3]).

/** <module> Warnings: likely mistakes in a program

These warnings do not keep a program from running.  They are problems as in
typhon_programs.

Warnings about a program are printed when it is read, and not again until it
changes.  Those about calls of predicates that it does not define wait until an
agent is created from it: payloads of the agent, or its place, may define these
predicates.

*Threading*: any thread.  A mutex protects the record of printed warnings.
*/

:- multifile
    typhon_fault:advice/3,
    typhon_programs:read_anew/4,
    typhon_programs:unknown/3,
    typhon_on_demand:joins/2.

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
    findall(PI, own_predicate(Parts, PI), Own0),
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

own_predicate(Parts, Name/Arity) :-
    part(rules, Parts, Rules),
    member((Head:-_)-_, Rules),
    callable(Head),
    functor(Head, Name, Arity).
own_predicate(Parts, PI) :-
    part(rules, Parts, Rules),
    member((_:-Body)-_, Rules),
    body_calls(Body, Calls),
    member(changes(PI), Calls).
own_predicate(Parts, PI) :-
    part(state, Parts, State),
    member(PI, State).

imported(Parts, PI) :-
    library_directive(Parts, Library-_),
    library_export(Library, PI),
    !.

%   unknown_advice(+PI, +Own:list, -Advice) is det.
%
%   Advice, see typhon_problem_text, proposes a fix for a call of PI in a
%   program whose own predicates are Own: import library(typhon), or call a
%   predicate with the same name and another arity, or with a similar name.

unknown_advice(PI, _, of_library(typhon)) :-
    library_export(library(typhon), PI),
    !.
unknown_advice(Name/Arity, Own, offered(Near)) :-
    findall(PI, ( member(PI, Own) ; near_built_in(Name/Arity, PI) ), PIs),
    findall(Name/N, member(Name/N, PIs), Same),
    ( Same == [] -> Known = PIs ; Known = Same ),
    sort(Known, Sorted),
    names_near(Name, Sorted, Near).

                /*******************************
                *     PROGRAMS THAT ARE READ   *
                *******************************/

%   warned(Key, Sources, Hash, Unknown): the warnings about the program with
%   Hash were printed, except those of the calls Unknown.  Key is its file, or
%   the hash of its clauses.

:- dynamic warned/4.

typhon_on_demand:joins(program, read).

typhon_programs:read_anew(Key, Hash, Sources, doubtful(Located, Kinds, Once)) :-
    program_warnings(Located, Kinds, Likely),
    unknown_problems(Located, Unknown),
    append([Once, Likely, Unknown], Warnings0),
    in_file_order(Warnings0, Located, Warnings),
    warn(Key, Hash, Sources, Warnings).

warn(_, _, _, []) :-
    !.
warn(Key, Hash, Sources, Warnings0) :-
    partition(is_unknown, Warnings0, Unknown, Warnings),
    (   with_mutex(typhon_warnings, is_new(Key, Sources, Hash, Unknown))
    ->  forall(member(Warning, Warnings), print_problem(warning, Warning))
    ;   true
    ).

is_unknown(problem(unknown_procedure(_), _, _)).

is_new(Key, _, _, _) :-
    warned(Key, Sources, _, _),
    source_same(Sources),
    !,
    fail.
is_new(Key, Sources, Hash, Unknown) :-
    retractall(warned(Key, _, _, _)),
    bounded(warned(_, _, _, _), typhon_loaded:files,
            assertz(warned(Key, Sources, Hash, Unknown))).

%!  print_problem(+Severity, +Problem) is det.
%
%   Print Problem, with the line of its goal, as a message of Severity.

print_problem(Severity, Problem0) :-
    problem_at_goal(Problem0, Problem),
    problem_error(Problem, [], Error),
    print_message(Severity, Error).

typhon_programs:unknown(Hash, State, Offered) :-
    warned(Key, Sources, Hash, Unknown),
    Unknown = [_|_],
    assertz(warned(Key, Sources, Hash, [])),
    retract(warned(Key, Sources, Hash, Unknown)), % succeeds in one thread
    !,
    forall(( member(Problem, Unknown),
             Problem = problem(unknown_procedure(PI), _, _),
             \+ memberchk(PI, State),
             \+ call(Offered, Problem) ),
           print_problem(warning, Problem)).

typhon_fault:advice(PI, Hash, Text) :-
    findall(Own, own(Hash, Own), PIs),
    unknown_advice(PI, PIs, Advice),
    advice_text(Advice, Text).

own(Hash, PI) :-
    code_program(Hash, program(_, State, _, Clauses)),
    (   member(PI, State)
    ;   member(Clause, Clauses),
        clause_parts(Clause, Head, _),
        functor(Head, Name, Arity),
        PI = Name/Arity
    ).
