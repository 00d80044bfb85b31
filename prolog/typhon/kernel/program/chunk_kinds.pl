:- module(typhon_chunk_kinds,
          [ goal_kind/3,                % +Goal, +Own, -Kind
            cannot_stop/2               % +Goal, +Own
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(assoc), [get_assoc/3]).
:- use_module(library(lists), [append/2, member/2, memberchk/2]).
:- use_module(clause_places, [node_parts/3]).
:- use_module(bodies, [special/2]).
:- use_module(mobile, [body_calls/2, built_in/1]).

/** <module> How the goals of a clause are compiled

*Threading*: pure.
*/

%!  goal_kind(+Goal, +Own, -Kind) is det.
%
%   Kind is `true`, `cut`, `control`, `mobile`, `machine` (which runs it),
%   leaf(Heads) or parts(Heads).  The last two may stop only if one of Heads has
%   rules in the state of the agent.  Own is Module-Kinds of the program.

goal_kind(Goal, _, Kind), var(Goal) =>
    Kind = machine.
goal_kind(true, _, Kind) =>
    Kind = true.
goal_kind('$cut'(_), _, Kind) =>
    Kind = cut.
goal_kind(Goal, Own, Kind), node_parts(Goal, 0, Parts), Parts \== none =>
    (   parts_tests(Parts, Tests),
        maplist(testable(Own), Tests, Heads0)
    ->  append(Heads0, Heads),
        Kind = parts(Heads)
    ;   Kind = machine
    ).
goal_kind(Goal, _, Kind), special(Goal, Special) =>
    (   Special == control
    ->  Kind = control
    ;   Kind = machine
    ).
goal_kind(Goal, Module-Own, Kind), is_call(Goal) =>
    functor(Goal, Name, Arity),
    functor(Head, Name, Arity),
    (   get_assoc(Name/Arity, Own, OwnKind)
    ->  own_kind(OwnKind, Head, Kind)
    ;   built_in(Name/Arity)
    ->  Kind = leaf([])
    ;   '$get_predicate_attribute'(Module:Head, imported, _)
    ->  Kind = leaf([])
    ;   Kind = leaf([Head])
    ).
goal_kind(_, _, Kind) =>
    Kind = machine.

is_call(Goal) :-
    callable(Goal),
    \+ memberchk(Goal, [!, call(_), catch(_, _, _), _:_]).

own_kind(native, _, leaf([])).
own_kind(mobile, _, mobile).
own_kind(open, _, mobile).
own_kind(outside(Heads), _, leaf(Heads)).
own_kind(state, Head, leaf([Head])).

%   parts_tests(+Parts, -Tests) is semidet: Tests are the parts that must not
%   stop.

parts_tests(both(_, _), []).
parts_tests(either(_, _), []).
parts_tests(not(_-A), [A]).
parts_tests(if(->, _-If, _, _, _), [If]).
parts_tests(if(*->, _-If, _, _, _), [If]) :-    % else more might be noted
    node_parts(If, 0, none).

%   testable(+Own, +Goal, -Heads) is semidet: Goal cannot stop unless a
%   predicate of Heads has rules in the state, and the machine runs no part of
%   it.

testable(Own, Goal, Heads) :-
    node_parts(Goal, 0, Parts),
    testable(Parts, Goal, Own, Heads).

testable(none, Goal, Own, Heads) :-
    !,
    nonvar(Goal),
    (   memberchk(Goal, [!, true])
    ->  Heads = []
    ;   goal_kind(Goal, Own, leaf(Heads)),
        body_calls(Goal, Calls),
        \+ memberchk(unknown(_), Calls)
    ).
testable(Parts, _, Own, Heads) :-
    findall(Part, part(Parts, Part), Goals),
    maplist(testable(Own), Goals, Heads0),
    append(Heads0, Heads).

part(both(_-A, _-B), Part) :- member(Part, [A,B]).
part(either(_-A, _-B), Part) :- member(Part, [A,B]).
part(not(_-A), A).
part(if(_, _-A, _-B, _-C, _), Part) :- member(Part, [A,B,C]).

%!  cannot_stop(+Goal, +Own) is semidet.
%
%   Goal is a branch that is compiled where it stands.

cannot_stop(Goal, Own) :-
    goal_kind(Goal, Own, Kind),
    cannot_stop(Kind, Goal, Own).

cannot_stop(true, _, _).
cannot_stop(cut, _, _).
cannot_stop(leaf([]), _, _).
cannot_stop(parts([]), Goal, Own) :-
    node_parts(Goal, 0, Parts),
    branches(Parts, Branches),
    \+ ( member(Branch, Branches),
         \+ cannot_stop(Branch, Own) ).

branches(both(_-A, _-B), [A,B]).
branches(either(_-A, _-B), [A,B]).
branches(not(_), []).
branches(if(_, _, _-A, _-B, _), [A,B]).
