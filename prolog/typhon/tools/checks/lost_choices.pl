:- module(typhon_lost_choices,
          [ lost_choice/3               % +Clauses, +Own, -Problem
          ]).
:- use_module(library(lists),
              [append/3, intersection/3, member/2, memberchk/2, union/3]).
:- use_module('../../kernel/program',
              [body_calls/2, built_in/1, control_use/2, is_mobile/2]).

/** <module> Choice points that a stop discards, and the program seems to rely
on

A control predicate commits: choice points that exist when an agent stops are
discarded.  The author of

    member(Host, Hosts), move(Host), look_around, fail

expects another hop for each of Hosts, and gets one hop.  A problem is reported
when, in one conjunction of a clause,

  1. a goal leaves choice points,
  2. after it, without a cut in between, an agent can stop,
  3. after that, without a cut in between, a goal is meant to fail.

Choice points are left by goals that are known to leave them (member/2,
between/3, sense/1 and others, and calls of a predicate of several facts, if
they bind a variable that occurs there for the first time), by a disjunction,
and by another clause whose head is at least as general, unless a goal before
the stop may be meant to choose between the two clauses.  Before a plain `fail`,
retract/1 and any predicate that may have several clauses count, too.  Goals
that are meant to fail are fail/0, a comparison, a type test, \+, memberchk/2,
forall/2, sense/1 and take/1; and the stop itself, if it is a receive with a
timeout.  The failure of a goal in a condition concerns that condition only.

*Threading*: pure.
*/

%!  lost_choice(+Clauses, +Own, -Problem) is nondet.
%
%   Clauses are rules, each with its location; Own is own(State, Mobile): the
%   indicators of mutable predicates, and of predicates that can reach a control
%   predicate.  There is at most one Problem for each clause,
%   problem(lost_choice(Choice, Control, Test), Location, commits(Choice)),
%   of three predicate indicators; Choice may be `clause`.

lost_choice(Clauses, Own,
            problem(lost_choice(Choice, Control, Test), Location,
                    commits(Choice))) :-
    append(_, [(Head:-Body)-Location|Later], Clauses),
    may_stop(Head, Own),
    other_clause(Later, Head, Left),
    phrase(walk(Body, Own-Clauses, path(Head, Left, []), _),
           [lost(Choice, Control, Test)|_]).

may_stop(Head, own(State, Mobile)) :-
    indicator(Head, PI),
    (   memberchk(PI, Mobile)
    ->  true
    ;   memberchk(PI, State)
    ).

other_clause(Later, Head, Left) :-
    (   member((General:-_)-_, Later),
        subsumes_term(General, Head)
    ->  Left = [other-clause]
    ;   Left = []
    ).

                /*******************************
                *            A BODY            *
                *******************************/

%   walk(+Body, +Program, +Path0, -Path)//: list the choice points that Body
%   discards and needs, as lost(Choice, Control, Test).
%
%   A path is path(Seen, Left, Lost), or `dead` after a fail/0.  Seen is a term
%   with the variables that have occurred.  Left are the present choice points,
%   as Kind-PI, Lost the discarded ones, as Kind-PI-Control.  Kind is
%
%     - sure: there is more than one solution
%     - other: another clause, or the other side of a disjunction
%     - chosen: the same, but a goal may have chosen between them
%     - maybe: there may be more than one solution

walk(_, _, dead, dead) -->
    !.
walk(Var, _, Path, Path) -->
    { var(Var) },
    !.
walk((A,B), Program, Path0, Path) -->
    !,
    walk(A, Program, Path0, Path1),
    walk(B, Program, Path1, Path).
walk(!, _, path(Seen, _, _), path(Seen, [], [])) -->
    !.
walk((If->Then;Else), Program, Path0, Path) -->
    !,
    condition(If, Program, Path0, Path1),
    walk(Then, Program, Path1, Path2),
    walk(Else, Program, Path0, Path3),
    { joined(Path2, Path3, Path) }.
walk((If*->Then;Else), Program, Path0, Path) -->
    !,
    walk((If->Then;Else), Program, Path0, Path).
walk((A;B), Program, Path0, Path) -->
    !,
    { leaves(other, (;)/2, Path0, Path1) },
    walk(A, Program, Path1, Path2),
    walk(B, Program, Path0, Path3),
    { joined(Path2, Path3, Path4),
      leaves(maybe, (;)/2, Path4, Path)
    }.
walk((If->Then), Program, Path0, Path) -->
    !,
    condition(If, Program, Path0, Path1),
    walk(Then, Program, Path1, Path).
walk((If*->Then), Program, Path0, Path) -->
    !,
    walk((If->Then), Program, Path0, Path).
walk(ignore(Goal), Program, Path0, Path) -->
    !,
    condition(Goal, Program, Path0, Path).
walk(once(Goal), Program, Path0, Path) -->
    !,
    walk(Goal, Program, Path0, _),
    { stopped(Goal, Program, Path0, Path) }.
walk(call(Goal), Program, Path0, Path) -->
    !,
    walk(Goal, Program, Path0, Path).
walk(catch(Goal,_,Recovery), Program, Path0, Path) -->
    !,
    walk(Goal, Program, Path0, Path),
    walk(Recovery, Program, path(Goal, [], []), _).
walk(Goal, Program, Path0, Path) -->
    { stopped(Goal, Program, Path0, Path1) },
    fails(Goal, Path1),
    { after_goal(Goal, Program, Path1, Path) }.

%   condition(+If, +Program, +Path0, -Path)//: when If fails, no goal before it
%   is retried.

condition(If, Program, Path0, Path) -->
    { Path0 = path(Seen, _, _) },
    walk(If, Program, path(Seen, [], []), _),
    { stopped(If, Program, Path0, Path) }.

%   fails(+Goal, +Path)//: list a discarded choice point that the failure of
%   Goal is meant to retry.

fails(Goal, path(_, Left, Lost)) -->
    { failing(Goal, Left, Kinds),
      member(Kind-Choice-Control, Lost),
      memberchk(Kind, Kinds)
    },
    !,
    { indicator(Goal, Test) },
    [ lost(Choice, Control, Test) ].
fails(_, _) -->
    [].

%   failing(+Goal, +Left, -Kinds) is semidet: the failure of Goal is meant to
%   retry choice points of Kinds that were discarded, and not those that are
%   Left.

failing(Goal, Left, [sure,other,chosen,maybe]) :-
    is_fail(Goal),
    !,
    \+ ( member(Kind-(;)/2, Left), Kind \== maybe ).
failing(Goal, [], [sure,other]) :-
    is_test(Goal).

                /*******************************
                *             PATHS            *
                *******************************/

%   stopped(+Goal, +Program, +Path0, -Path): if the agent may stop in Goal, the
%   choice points that are left in Path0 are discarded in Path.

stopped(Goal, own(_, Mobile)-_, path(Seen, Left, Lost0),
        path(Seen-Goal, [], Lost)) :-
    body_calls(Goal, Calls),
    member(call(PI, run), Calls),
    is_mobile(PI, Mobile),
    !,
    findall(Choice-PI, member(Choice, Left), Given),
    append(Given, Lost0, Lost).
stopped(Goal, _, path(Seen, Left, Lost), path(Seen-Goal, Left, Lost)).

%   after_goal(+Goal, +Program, +Path0, -Path): the path after Goal; stopped/4
%   has dealt with its stop.

after_goal(Goal, _, _, dead) :-
    is_fail(Goal),
    !.
after_goal(Goal, Program, path(Seen, Left0, Lost), Path) :-
    Seen = Before-_,
    (   may_choose(Goal)
    ->  chosen(Left0, Left)
    ;   Left = Left0
    ),
    (   solutions(Goal, Before, Program, Kind)
    ->  indicator(Goal, PI),
        leaves(Kind, PI, path(Seen, Left, Lost), Path)
    ;   Path = path(Seen, Left, Lost)
    ).

leaves(_, _, dead, dead) :-
    !.
leaves(Kind, PI, path(Seen, Left, Lost), path(Seen, [Kind-PI|Left], Lost)).

chosen([], []).
chosen([Kind0-PI|Left0], [Kind-PI|Left]) :-
    ( Kind0 == other -> Kind = chosen ; Kind = Kind0 ),
    chosen(Left0, Left).

joined(dead, Path, Path) :-
    !.
joined(Path, dead, Path) :-
    !.
joined(path(Seen1, Left1, Lost1), path(Seen2, Left2, Lost2),
       path(Seen1-Seen2, Left, Lost)) :-
    intersection(Left1, Left2, Left),
    union(Lost1, Lost2, Lost).

                /*******************************
                *       PURPOSE OF A GOAL      *
                *******************************/

%   The purpose of a goal is a guess from its predicate.  Where it is doubtful,
%   nothing is reported.

indicator(Goal, Name/Arity) :-
    functor(Goal, Name, Arity).

is_fail(fail).
is_fail(false).

%   is_test(+Goal) is semidet: Goal is meant to fail.

is_test(Goal) :-
    indicator(Goal, PI),
    memberchk(PI, [ (\+)/1, (==)/2, (\==)/2, (\=)/2, (=:=)/2, (=\=)/2,
                    (<)/2, (>)/2, (=<)/2, (>=)/2, (@<)/2, (@>)/2, (@=<)/2,
                    (@>=)/2, var/1, nonvar/1, atom/1, number/1, integer/1,
                    atomic/1, compound/1, callable/1, ground/1, is_list/1,
                    memberchk/2, forall/2, sense/1, take/1 ]).
is_test(Goal) :-
    control_use(Goal, called(semidet)).

%   may_choose(+Goal) is semidet: Goal may be meant to choose between clauses.

may_choose(Goal) :-
    is_test(Goal),
    !.
may_choose(Goal) :-
    indicator(Goal, PI),
    (   memberchk(PI, [ (=)/2, retract/1 ])
    ->  true
    ;   \+ built_in(PI)
    ).

%   solutions(+Goal, +Seen, +Program, -Kind) is semidet: Goal has more than one
%   solution, `sure` or `maybe`.  Seen has the variables that occurred before
%   it.  Program is own(State, _)-Clauses.

solutions(Goal, Seen, _-Clauses, sure) :-
    (   leaves_choices(Goal, What)
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

%   leaves_choices(+Goal, -What) is semidet: Goal has several solutions if What
%   is unbound.

leaves_choices(member(X, List), X) :- \+ subsumes_term([_], List).
leaves_choices(select(X, _, _), X).
leaves_choices(select(X, _, _, _), X).
leaves_choices(nth0(I, _, _), I).
leaves_choices(nth1(I, _, _), I).
leaves_choices(between(_, _, X), X).
leaves_choices(append(X, _, _), X).
leaves_choices(permutation(_, X), X).
leaves_choices(clause(_, Body), Body).
leaves_choices(sub_atom(_, B, L, A, Sub), [B,L,A,Sub]).
leaves_choices(sub_string(_, B, L, A, Sub), [B,L,A,Sub]).
leaves_choices(current_op(P, T, N), [P,T,N]).
leaves_choices(sense(Fact), Fact).
leaves_choices(pheromone(Problem, Source, _), [Problem,Source]).
leaves_choices(neighbour(Host, _), Host).

%   facts(+Goal, +Clauses, -What): the predicate of Goal has several clauses,
%   all facts; What is its first argument, which selects one of them if it is
%   bound.

facts(Goal, Clauses, What) :-
    compound(Goal),
    arg(1, Goal, What),
    findall(Body, clause_of(Goal, Clauses, Body), [_,_|_]),
    \+ ( clause_of(Goal, Clauses, Body), Body \== true ).

clause_of(Goal, Clauses, Body) :-
    functor(Goal, Name, Arity),
    functor(Head, Name, Arity),
    member((Head:-Body)-_, Clauses).
