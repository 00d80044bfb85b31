:- module(typhon_goals,
          [ indicator/2,                % +Goal, -PI
            is_fail/1,                  % +Goal
            is_test/1,                  % +Goal
            chooses/1,                  % +Goal
            solutions/4                 % +Goal, +Seen, +Program, -Kind
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(mobile, [built_in/1]).

/** <module> What a goal of a program may be there for

As far as can be known without running it; doubtful goals are not reported.

*Threading*: pure.
*/

%!  indicator(+Goal, -PI) is det.
%!  is_fail(+Goal) is semidet.

indicator(Goal, Name/Arity) :-
    functor(Goal, Name, Arity).

is_fail(fail).
is_fail(false).

%!  is_test(+Goal) is semidet.
%
%   It is there to fail.

is_test(Goal) :-
    indicator(Goal, PI),
    memberchk(PI, [ (\+)/1, (==)/2, (\==)/2, (\=)/2, (=:=)/2, (=\=)/2,
                    (<)/2, (>)/2, (=<)/2, (>=)/2, (@<)/2, (@>)/2, (@=<)/2,
                    (@>=)/2, var/1, nonvar/1, atom/1, number/1, integer/1,
                    atomic/1, compound/1, callable/1, ground/1, is_list/1,
                    memberchk/2, forall/2, sense/1, take/1, receive/2,
                    receive_until/2 ]).

%!  chooses(+Goal) is semidet.
%
%   It may be there to choose between clauses.

chooses(Goal) :-
    is_test(Goal),
    !.
chooses(Goal) :-
    indicator(Goal, PI),
    (   memberchk(PI, [ (=)/2, retract/1 ])
    ->  true
    ;   \+ built_in(PI)
    ).

%!  solutions(+Goal, +Seen, +Program, -Kind) is semidet.
%
%   Goal has more than one solution, `sure` or `maybe`.  Seen has the variables
%   that occurred before it.  Program is own(State, _)-Clauses, see
%   lost_choice/3.

solutions(Goal, Seen, _-Clauses, sure) :-
    (   finds(Goal, What)
    ;   facts(Goal, Clauses, What)
    ),
    term_variables(Seen, Old),
    term_variables(What, Variables),
    \+ forall(member(V, Variables), (member(O, Old), O == V)),
    !.
solutions(repeat, _, _, sure) :-
    !.
solutions(retract(_), _, _, maybe) :-
    !.
solutions(Goal, _, own(State, _)-Clauses, maybe) :-
    indicator(Goal, PI),
    \+ built_in(PI),
    (   memberchk(PI, State)
    ->  true
    ;   findall(x, clause_of(Goal, Clauses, _), [_])
    ->  fail
    ;   true
    ).

%   finds(+Goal, -What) is semidet: Goal has several solutions where What is
%   not bound.

finds(member(X, List), X) :- \+ subsumes_term([_], List).
finds(select(X, _, _), X).
finds(select(X, _, _, _), X).
finds(nth0(I, _, _), I).
finds(nth1(I, _, _), I).
finds(between(_, _, X), X).
finds(append(X, _, _), X).
finds(permutation(_, X), X).
finds(clause(_, Body), Body).
finds(sub_atom(_, B, L, A, Sub), [B,L,A,Sub]).
finds(sub_string(_, B, L, A, Sub), [B,L,A,Sub]).
finds(current_op(P, T, N), [P,T,N]).
finds(sense(Fact), Fact).
finds(pheromone(Problem, Source, _), [Problem,Source]).
finds(neighbour(Host, _), Host).

%   facts(+Goal, +Clauses, -What): Goal has several clauses, all facts, and
%   What would choose one.

facts(Goal, Clauses, What) :-
    compound(Goal),
    arg(1, Goal, What),
    findall(Body, clause_of(Goal, Clauses, Body), [_,_|_]),
    \+ ( clause_of(Goal, Clauses, Body), Body \== true ).

clause_of(Goal, Clauses, Body) :-
    functor(Goal, Name, Arity),
    functor(Head, Name, Arity),
    member((Head:-Body)-_, Clauses).
