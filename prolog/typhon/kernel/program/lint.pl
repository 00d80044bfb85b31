:- module(typhon_lint,
          [ apart_problem/3,            % +Rules, +Known, -Problem
            undeclared_problem/3        % +Rules, +State, -Problem
          ]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- autoload(library(solution_sequences), [distinct/2]).
:- use_module(mobile, [body_calls/2]).
:- use_module(source, [indicator_in/2]).

/** <module> What a program says, and hardly means

Slips do not keep a program from running.  They are problems as in
typhon_problems.

*Threading*: pure.
*/

%!  apart_problem(+Rules, +Known, -Problem) is nondet.
%!  undeclared_problem(+Rules, +State, -Problem) is nondet.
%
%   A predicate that has clauses of others between its own; one that is
%   changed, and neither in the program nor in State, the predicate indicators
%   of what is mutable.  Rules have their locations; Known is
%   Directives-State.

apart_problem(Rules, Directives-State,
              problem(discontiguous(PI), Location, discontiguous(PI))) :-
    distinct(PI, apart(Rules, PI, Location)),
    \+ memberchk(PI, State),
    \+ declared_discontiguous(Directives, PI).

undeclared_problem(Rules, State,
                   problem(undeclared_state(PI), Location, undeclared(PI))) :-
    distinct(PI, changed(Rules, PI, Location)),
    \+ memberchk(PI, State),
    \+ defined(Rules, PI),
    \+ hidden(PI).

%   What the vocabulary keeps in an agent is none of the program's business.

hidden(Name/_) :-
    sub_atom(Name, 0, _, _, $).

%   apart(+Clauses, -PI, -Location) is nondet: a clause of PI is at Location,
%   others are before it, and what is directly before it is none.

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
