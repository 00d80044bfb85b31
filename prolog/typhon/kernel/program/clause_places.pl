:- module(typhon_clause_places,
          [ clause_places/5,            % +Head, +Body, -Barrier, -Nodes, -Places
            node_parts/3,               % +Goal, +N, -Parts
            among/2,                    % +Variables, +Variable
            occurs/2,                   % +Variable, +Term
            goal_kind/3,                % +Goal, +Own, -Kind
            cannot_stop/2               % +Goal, +Own
          ]).
:- use_module(library(apply), [exclude/3, foldl/4, include/3, maplist/3]).
:- use_module(library(assoc), [get_assoc/3]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(bodies, [body_goals/4, goals_body/2, special/2]).
:- use_module(mobile, [body_calls/2, built_in/1]).

/** <module> The goals of a clause: their places, and how they are compiled

Each goal of a clause has a number, in the order of the text.  When the machine
comes to a goal, certain goals of the clause are left: those from there on, and
within a condition the rest of the condition.  They depend on the clause alone.
So a number and the values of variables stand for a list of goals.

A node is N-Goal.  A place is place(N, Old, New, Goal, Goals): at Goal, the
machine has Goals left of the clause; Old are those of their variables that
occurred before, New those that occur first in Goal.  Cuts of the clause are
'$cut'(Barrier).

*Threading*: pure.
*/

%!  clause_places(+Head, +Body, -Barrier, -Nodes, -Places) is det.
%
%   Nodes are the goals of Body.

clause_places(Head, Body, Barrier, Nodes, Places) :-
    body_goals(Body, Barrier, Goals, []),
    numbered(Goals, 0, Nodes),
    phrase(places(Nodes, [], top, Head-Barrier), Places).

numbered([], _, []).
numbered([Goal|Goals], N, [N-Goal|Nodes]) :-
    size(Goal, Size),
    N1 is N+Size,
    numbered(Goals, N1, Nodes).

%   size(+Goal, -Size): Goal takes Size numbers.  This does not number its
%   parts: numbering computes sizes, so the time for a deep clause would be
%   exponential.

size(Goal, Size) :-
    (   nonvar(Goal),
        parts(Goal, Parts)
    ->  parts_nodes(Parts, Tests, Branches),
        append(Tests, Branches, Nodes),
        foldl(add_size, Nodes, 1, Size0),
        (   Parts = if(_, _, _, _, _)
        ->  Size is Size0+1             % a number for its failure
        ;   Size = Size0
        )
    ;   Size = 1
    ).

add_size(_-Goal, Size0, Size) :-
    size(Goal, Own),
    Size is Size0+Own.

%!  node_parts(+Goal, +N, -Parts) is det.
%
%   Parts are the nodes that Goal consists of: both(A, B), either(A, B),
%   not(A), if(Arrow, If, Then, Else, Failing), or `none`.  Failing is a node,
%   too: the goal that, in the machine, has failed where no branch is taken, if
%   Else is `fail`.

node_parts(Goal, N, Parts) :-
    (   nonvar(Goal),
        parts(Goal, Parts0)
    ->  Parts = Parts0,
        N1 is N+1,
        number_parts(Parts, N1)
    ;   Parts = none
    ).

parts((A,B), both(_-A, _-B)).
parts((Or;Else), Parts) :-
    (   condition(Or, Arrow, If, Then)
    ->  Parts = if(Arrow, _-If, _-Then, _-Else, _-Or)
    ;   Parts = either(_-Or, _-Else)
    ).
parts(\+ A, not(_-A)).
parts(once(A), if(->, _-A, _-true, _-fail, _-(A->true))).
parts(ignore(A), if(->, _-A, _-true, _-true, _-(A->true))).
parts((If->Then), if(->, _-If, _-Then, _-fail, _-(If->Then))).
parts((If*->Then), if(*->, _-If, _-Then, _-fail, _-(If*->Then))).

condition(Or, Arrow, If, Then) :-
    nonvar(Or),
    (   Or = (If->Then)
    ->  Arrow = (->)
    ;   Or = (If*->Then),
        Arrow = (*->)
    ).

%   parts_nodes(+Parts, -Tests, -Branches): the goals of Parts; the code after
%   them follows Branches.

parts_nodes(both(A, B), [], [A,B]).
parts_nodes(either(A, B), [], [A,B]).
parts_nodes(not(A), [A], []).
parts_nodes(if(_, If, Then, Else, _), [If], [Then,Else]).

number_parts(both(N-A, M-_), N) :-
    next(N, A, M).
number_parts(either(N-A, M-_), N) :-
    next(N, A, M).
number_parts(not(N-_), N).
number_parts(if(_, I-If, T-Then, E-_, N-_), N) :-
    I is N+1,
    next(I, If, T),
    next(T, Then, E).

next(N, Goal, Next) :-
    size(Goal, Size),
    Next is N+Size.

%   places(+Nodes, +Outer, +Within, +Seen)//: the places of Nodes, which Outer
%   follows.  Within is `top`, or within(Construct, Nodes, Within) inside a
%   condition.

places([], _, _, _) -->
    [].
places([Node|Nodes], Outer, Within, Seen) -->
    { append(Nodes, Outer, Rest),
      Node = N-Goal,
      place(N, Goal, [Node|Rest], Within, Seen, Place),
      node_parts(Goal, N, Parts)
    },
    [Place],
    part_places(Parts, Nodes, Outer, Rest, Within, Seen),
    next_places(Parts, Goal, Nodes, Outer, Within, Seen).

next_places(both(_, _), _, _, _, _, _) -->
    !.
next_places(_, Goal, Nodes, Outer, Within, Seen) -->
    places(Nodes, Outer, Within, Seen-Goal).

part_places(none, _, _, _, _, _) -->
    [].
part_places(both(A, B), Nodes, Outer, _, Within, Seen) -->
    places([A,B|Nodes], Outer, Within, Seen).
part_places(either(A, B), _, _, Rest, Within, Seen) -->
    places([A], Rest, Within, Seen),
    places([B], Rest, Within, Seen).
part_places(not(A), _, _, Rest, Within, Seen) -->
    { A = _-Goal },
    places([A], [], within(not(Goal), Rest, Within), Seen).
part_places(if(Arrow, If, Then, Else, Failing), _, _, Rest, Within, Seen) -->
    { If = _-Condition,
      Then = _-Yes,
      Else = _-No,
      Failing = N-Goal,
      place(N, Goal, [Failing|Rest], Within, Seen, Place)
    },
    [Place],
    places([If], [], within(if(Arrow, Yes, No), Rest, Within), Seen),
    places([Then], Rest, Within, Seen-Condition),
    places([Else], Rest, Within, Seen).

place(N, Goal, Nodes, Within, Seen, place(N, Old, New, Goal, Goals)) :-
    pairs_values(Nodes, Goals0),
    all_left(Within, Goals0, Goals),
    term_variables(Seen, Before),
    term_variables(Goals, Variables),
    include(among(Before), Variables, Old),
    term_variables(Goal, InGoal),
    exclude(among(Before), InGoal, New).

%!  among(+Variables:list, @Variable) is semidet.
%
%   Variable is one of Variables.

among(Variables, Variable) :-
    member(Other, Variables),
    Other == Variable,
    !.

%!  occurs(+Variable, +Term) is semidet.
%
%   Variable occurs in Term.

occurs(Variable, Term) :-
    term_variables(Term, Variables),
    among(Variables, Variable).

all_left(top, Goals, Goals).
all_left(within(Construct, Nodes, Within), Goals0, Goals) :-
    goals_body(Goals0, Left),
    constructed(Construct, Left, Goal),
    pairs_values(Nodes, Goals1),
    all_left(Within, [Goal|Goals1], Goals).

constructed(not(Goal), _, \+ Goal).
constructed(if(->, Then, Else), Left, (Left->Then;Else)).
constructed(if(*->, Then, Else), Left, (Left*->Then;Else)).

                /*******************************
                *            KINDS             *
                *******************************/

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
own_kind(outside(Heads), _, leaf(Heads)).
own_kind(state, Head, leaf([Head])).

%   parts_tests(+Parts, -Tests) is semidet: Tests are the parts that must not
%   stop.

parts_tests(if(*->, _-If, _, _, _), _) :-       % else more might be noted
    node_parts(If, 0, Parts),
    Parts \== none,
    !,
    fail.
parts_tests(Parts, Goals) :-
    parts_nodes(Parts, Tests, _),
    pairs_values(Tests, Goals).

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
    parts_nodes(Parts, Tests, Branches),
    append(Tests, Branches, Nodes),
    pairs_values(Nodes, Goals),
    maplist(testable(Own), Goals, Heads0),
    append(Heads0, Heads).

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
    parts_nodes(Parts, _, Branches),
    \+ ( member(_-Branch, Branches),
         \+ cannot_stop(Branch, Own) ).
