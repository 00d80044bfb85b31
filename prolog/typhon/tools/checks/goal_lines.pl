:- module(typhon_goal_lines,
          [ problem_at_goal/2           % +Problem0, -Problem
          ]).
:- use_module(library(lists), [append/3, nth1/3]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module('../../language', [source_clause/2]).

/** <module> The line of the goal of a problem

The checks find problems clause by clause, with the line at which the clause
begins.  Before a problem is printed or raised, its clause is read again with
the positions of its parts, to find the line of its goal or variable.

*Threading*: any thread.
*/

:- multifile typhon_programs:problem_at_goal/2.

typhon_programs:problem_at_goal(Problem0, Problem) :-
    problem_at_goal(Problem0, Problem).

%!  problem_at_goal(+Problem0, -Problem) is det.
%
%   Problem is Problem0 with the line of its goal.  Its line is unchanged if the
%   goal is not found, as in clauses that were not read from a file.

problem_at_goal(problem(Formal, File:Line0, Advice),
                problem(Formal, File:Line, Advice)) :-
    problem_target(Formal, Advice, Target),
    source_clause(File:Line0, Clause),
    position(Target, Clause, Offset),
    line_at(File, Offset, Line),
    Line >= Line0,
    !.
problem_at_goal(Problem, Problem).

%   problem_target(+Formal, +Advice, -Target) is semidet: a problem with Formal
%   and Advice is located at Target: goal(PI), a call of PI; within(Context,
%   PI), a call of PI in an argument of Context; change(PI), a goal that changes
%   PI; or variable(Name).

problem_target(unknown_procedure(PI), _, goal(PI)).
problem_target(lost_choice(_, PI, _), _, goal(PI)).
problem_target(permission_error(call, control_predicate, PI), inside(Context),
               within(Context, PI)).
problem_target(permission_error(modify, static_procedure, PI), undeclared(PI),
               change(PI)).
problem_target(undeclared_state(PI), _, change(PI)).
problem_target(singletons([Name|_]), _, variable(Name)).

%   position(+Target, +Clause, -Offset) is semidet.

position(variable(Name), clause(Term, Layout, Names), Offset) :-
    !,
    memberchk(Name=Variable, Names),
    part(Term, Layout, Part, At),
    Part == Variable,
    !,
    start_offset(At, Offset).
position(Target, clause(Term, Layout, _), Offset) :-
    body(Term, Layout, Body, BodyAt),
    part(Body, BodyAt, Part, At),
    is_target(Target, Part, At, Offset),
    !.

body(Term, parentheses_term_position(_, _, At), Body, BodyAt) :-
    !,
    body(Term, At, Body, BodyAt).
body((_:-Body), term_position(_, _, _, _, [_,At]), Body, At).
body((_-->Body), term_position(_, _, _, _, [_,At]), Body, At).

is_target(goal(PI), Part, At, Offset) :-
    calls(Part, PI),
    start_offset(At, Offset).
is_target(within(Context, PI), Part, At, Offset) :-
    calls(Part, Context),
    argument(Part, At, Argument, ArgumentAt),
    part(Argument, ArgumentAt, Goal, GoalAt),
    calls(Goal, PI),
    start_offset(GoalAt, Offset).
is_target(change(Name/Arity), Part, At, Offset) :-
    compound(Part),
    compound_name_arguments(Part, Change, [Clause]),
    memberchk(Change, [assert, asserta, assertz, retract, retractall]),
    nonvar(Clause),
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    callable(Head),
    functor(Head, Name, Arity),
    start_offset(At, Offset).

%   calls(+Term, +PI) is semidet: Term calls PI, or is a closure of PI, to which
%   arguments are added.

calls(Term, Name/Arity) :-
    callable(Term),
    functor(Term, Name, N),
    N =< Arity.

%   part(+Term, +Layout, -Part, -At) is nondet: Part of Term has the layout At.
%   Solutions are in the order of the text.

part(Term, Layout, Part, At) :-
    nonvar(Layout),
    (   Layout = parentheses_term_position(_, _, Inner)
    ->  part(Term, Inner, Part, At)
    ;   part_of(Term, Layout, Part, At)
    ).

part_of(Term, Layout, Term, Layout).
part_of(Term, Layout, Part, At) :-
    argument(Term, Layout, Argument, ArgumentAt),
    part(Argument, ArgumentAt, Part, At).

argument(Term, term_position(_, _, _, _, Ats), Argument, At) :-
    compound(Term),
    nth1(I, Ats, At),
    arg(I, Term, Argument).
argument({Argument}, brace_term_position(_, _, At), Argument, At).
argument(List, list_position(_, _, Ats, _), Argument, At) :-
    nth1(I, Ats, At),
    nth1(I, List, Argument).
argument(List, list_position(_, _, Ats, At), Tail, At) :-
    At \== none,
    length(Ats, Count),
    length(Begin, Count),
    append(Begin, Tail, List).

start_offset(Layout, Offset) :-
    arg(1, Layout, Offset).

%   Offset is a number of characters, so the text is read, not the bytes.

line_at(File, Offset, Line) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    sub_string(Text, 0, Offset, _, Before),
    split_string(Before, "\n", "", Lines),
    length(Lines, Line).
