:- module(typhon_warnings, []).
:- use_module(library(apply), [partition/4]).
:- use_module(library(lists), [append/2, member/2, memberchk/2]).
:- use_module('../../kernel/base/bounds', [bounded/2]).
:- use_module('../../kernel/program',
              [ advice_text/2, clause_parts/3, code_program/2, in_file_order/3,
                problem_error/3, source_same/1 ]).
:- use_module(goal_lines, [problem_at_goal/2]).
:- use_module(program_warnings,
              [program_warnings/3, unknown_advice/3, unknown_problems/2]).

/** <module> Warnings about programs that are read

Warnings about a program are printed when it is read, and not again until it
changes.  Those about calls of predicates that it does not define wait until an
agent is created from it: payloads of the agent, or its place, may define these
predicates.

*Threading*: any thread.  A mutex protects the record.
*/

:- multifile
    typhon_fault:advice/3,
    typhon_loaded:read_anew/4,
    typhon_loaded:unknown/3,
    typhon_on_demand:joins/2.

%   warned(Key, Sources, Hash, Unknown): the warnings about the program with
%   Hash were printed, except those of the calls Unknown.  Key is its file, or
%   the hash of its clauses.

:- dynamic warned/4.

typhon_on_demand:joins(program, read).

typhon_loaded:read_anew(Key, Hash, Sources, doubtful(Located, Kinds, Once)) :-
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
    ->  forall(member(Warning, Warnings), print_warning(Warning))
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
    assertz(warned(Key, Sources, Hash, Unknown)),
    bounded(warned(_, _, _, _), typhon_loaded:files).

print_warning(Warning0) :-
    problem_at_goal(Warning0, Warning),
    problem_error(Warning, [], Error),
    print_message(warning, Error).

typhon_loaded:unknown(Hash, State, Offered) :-
    warned(Key, Sources, Hash, Unknown),
    Unknown = [_|_],
    assertz(warned(Key, Sources, Hash, [])),
    retract(warned(Key, Sources, Hash, Unknown)), % succeeds in one thread
    !,
    forall(( member(Problem, Unknown),
             Problem = problem(unknown_procedure(PI), _, _),
             \+ memberchk(PI, State),
             \+ call(Offered, Problem) ),
           print_warning(Problem)).

                /*******************************
                *         FAULTY AGENTS        *
                *******************************/

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
