:- module(typhon_chunk_code,
          [ clause_code/5               % +Own, +Clause, +Phase, +Args, -Code
          ]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(bodies, [named/4]).
:- use_module(clause_places,
              [ among/2, cannot_stop/2, clause_places/5, goal_kind/3,
                node_parts/3, occurs/2 ]).
:- use_module(code, [native_body/4]).

/** <module> The code of a chunk

Translates a clause to native code, see typhon_chunks.

*Threading*: pure, except for the destructive change of a term of its own.
*/

%!  clause_code(+Own, +Clause, +Phase, +Args, -Code) is det.
%
%   @arg Own is own(Module, Kinds, I/Count): Clause, (Head:-Body), is clause I
%        of Count clauses of the program in Module.
%   @arg Phase says whether a later clause matches all calls, see block/6.
%   @arg Args is args(K, X, Base, Out, Barrier), the variables of the code.
%   @arg Code is Body-Frames, a frame being frame(Place, Vars, Args, Body).

clause_code(own(Module, Own, Number), (Head:-Body), Phase, Args, Code-Frames) :-
    arg(5, Args, Barrier),
    clause_places(Head, Body, Barrier, Nodes, Places),
    Env = env(Module, Own, Places, Number, Args, frames([])),
    block(Nodes, [], tail, Phase, Env, Code),
    arg(6, Env, frames(Frames)).

                /*******************************
                *            FRAMES            *
                *******************************/

%   frame_at(+Nodes, +Outer, +Env, -Place, -Vars): the frame of Nodes, followed
%   by Outer.  It is made if it does not exist yet.

frame_at(Nodes, Outer, Env, Place, Vars) :-
    append(Nodes, Outer, [N-_|_]),
    at(N, Env, Place, Vars),
    arg(6, Env, Frames),
    (   arg(1, Frames, List),
        memberchk(frame(Place, _, _, _), List)
    ->  true
    ;   arg(5, Env, Args),
        Frame = frame(Place, Vars, Args, Code),
        arg(1, Frames, List0),
        setarg(1, Frames, [Frame|List0]),
        (   Nodes == []
        ->  Own = Outer,
            After = []
        ;   Own = Nodes,
            After = Outer
        ),
        block(Own, After, tail, later, Env, Code)
    ).

%   at(+N, +Env, -Place, -Vars): Place, the number of a place in a program,
%   also encodes its clause, and whether a cut is left there.

at(N, env(Module, _, Places, I/Count, Args, _), Place, Vars) :-
    memberchk(place(N, Variables, _, _, _), Places),
    arg(5, Args, Barrier),
    ( among(Variables, Barrier) -> Cuts = 1 ; Cuts = 0 ),
    Place is (N*Count+I)*2+Cuts,
    Vars =.. [Module|Variables].

rest(Nodes, Outer, Env, Goals) :-
    arg(5, Env, args(K, _, _, _, _)),
    (   Nodes == [],
        Outer == []
    ->  Goals = K
    ;   frame_at(Nodes, Outer, Env, Place, Vars),
        Goals = ['$k'(Place, Vars)|K]
    ).

                /*******************************
                *            BLOCKS            *
                *******************************/

kind(Goal, env(Module, Own, _, _, _, _), Kind) :-
    goal_kind(Goal, Module-Own, Kind).

%   block(+Nodes, +Outer, +Mode, +Phase, +Env, -Code): Code runs Nodes.  In
%   Mode `tail` it goes on with Outer, and with K; in Mode `through` the code
%   after it does that, and the block cannot stop.  Phase is `lead` or `first`
%   in the clause of a predicate, `later` in a frame.  A failure in the lead
%   need not be noted: no cut came before, so another clause is tried, and if
%   all of them fail, a goal in them has failed last.

block([], Outer, tail, _, Env, Code) =>
    Env = env(_, _, _, _, args(K, X, Base, Out, _), _),
    (   Outer == []
    ->  Code = '$go'(K, X, Base, Out)
    ;   frame_at([], Outer, Env, Place, Vars),
        Code = '$k'(Place, Vars, K, X, Base, Out)
    ).
block([], _, through, _, _, Code) =>
    Code = true.
block([N-Goal|Nodes], Outer, Mode, Phase, Env, Code) =>
    kind(Goal, Env, How),
    block(How, N-Goal, Nodes, Outer, Mode, Phase, Env, Code).

block(true, _, Nodes, Outer, Mode, Phase, Env, Code) =>
    block(Nodes, Outer, Mode, Phase, Env, Code).
block(cut, _, Nodes, Outer, Mode, Phase, Env, Code) =>
    Code = (Cut,Rest),
    cut(Phase, Env, Cut),
    after_cut(Phase, Phase1),
    block(Nodes, Outer, Mode, Phase1, Env, Rest).
block(leaf(Heads), Node, Nodes, Outer, Mode, Phase, Env, Code) =>
    block(Nodes, Outer, Mode, Phase, Env, Rest),
    noted(Node, Rest, Phase, Env, Called),
    unless_ruled(Heads, Node, Env, (Called,Rest), Code).
block(control, _-Goal, Nodes, Outer, _, _, Env, Code) =>
    rest(Nodes, Outer, Env, Goals),
    Env = env(_, _, _, _, args(_, _, _, Out, _), _),
    Code = (Out = effect(Goal, Hole, [Hole|Goals])).
block(mobile, _-Goal, Nodes, Outer, _, _, Env, Code) =>
    rest(Nodes, Outer, Env, Goals),
    Env = env(_, _, _, _, args(_, X, Base, Out, _), _),
    named('run ', Goal, [Goals,X,Base,Out], Code).
block(machine, _-Goal, Nodes, Outer, _, _, Env, Code) =>
    rest(Nodes, Outer, Env, Goals),
    Env = env(_, _, _, _, args(_, X, Base, Out, _), _),
    Code = typhon_machine:step(Goal, Goals, X, Base, Out).
block(parts(Heads), Node, Nodes, Outer, Mode, Phase, Env, Code) =>
    Node = N-Goal,
    node_parts(Goal, N, Parts),
    parts_block(Parts, Node, Nodes, Outer, Mode, Phase, Env, Code0),
    unless_ruled(Heads, Node, Env, Code0, Code).

parts_block(both(A, B), _, Nodes, Outer, Mode, Phase, Env, Code) =>
    block([A,B|Nodes], Outer, Mode, Phase, Env, Code).
parts_block(not(A), N-_, Nodes, Outer, Mode, Phase, Env, Code) =>
    Code = ((\+ Test -> true ; Fails), Rest),
    test(A, Env, Test),
    fails(N, Phase, Env, Fails),
    block(Nodes, Outer, Mode, Phase, Env, Rest).
parts_block(either(A, B), _, Nodes, Outer, Mode, Phase, Env, Code) =>
    branches([A,B], Nodes, Outer, Mode, Phase, Env, [CodeA,CodeB], Rest),
    join((CodeA;CodeB), Rest, Code).
parts_block(if(Arrow, If, Then, Else, N-_), _, Nodes, Outer, Mode, Phase, Env,
            Code) =>
    test(If, Env, Test),
    (   Else = _-Fail,
        Fail == fail
    ->  fails(N, Phase, Env, CodeE),
        branches([Then], Nodes, Outer, Mode, Phase, Env, [CodeT], Rest)
    ;   branches([Then,Else], Nodes, Outer, Mode, Phase, Env, [CodeT,CodeE],
                 Rest)
    ),
    condition(Arrow, Test, CodeT, CodeE, Code0),
    join(Code0, Rest, Code).

condition(->, If, Then, Else, (If->Then;Else)).
condition(*->, If, Then, Else, (If*->Then;Else)).

join(Code, none, Code) :-
    !.
join(Code, Rest, (Code,Rest)).

%   branches(+Branches, +Nodes, ...): if no branch can stop, the code after
%   them is Rest; else each branch goes on with it.

branches(Branches, Nodes, Outer, Mode, Phase, Env, Codes, Rest) :-
    Env = env(Module, Own, _, _, _, _),
    (   \+ ( member(_-Branch, Branches),
             \+ cannot_stop(Branch, Module-Own) )
    ->  maplist(branch(through, [], Phase, Env), Branches, Codes),
        after_branches(Branches, Phase, Phase1),
        block(Nodes, Outer, Mode, Phase1, Env, Rest)
    ;   append(Nodes, Outer, After),
        maplist(branch(tail, After, Phase, Env), Branches, Codes),
        Rest = none
    ).

branch(Mode, After, Phase, Env, Branch, Code) :-
    block([Branch], After, Mode, Phase, Env, Code).

cut(later, env(_, _, _, _, args(_, _, _, _, Barrier), _), Cut) =>
    Cut = prolog_cut_to(Barrier).
cut(_, _, Cut) =>
    Cut = (!).

after_cut(lead, first) :-
    !.
after_cut(Phase, Phase).

%   A branch may have cut: after it the phase is not `lead`.

after_branches(Branches, lead, first) :-
    sub_term(Cut, Branches),
    nonvar(Cut),
    Cut = '$cut'(_),
    !.
after_branches(_, Phase, Phase).

%   unless_ruled(+Heads, +Node, +Env, +Code0, -Code): run Code0 if no predicate
%   of Heads has rules in the state of the agent.

unless_ruled([], _, _, Code, Code) :-
    !.
unless_ruled(Heads, N-_, Env, Code, Ruling) :-
    at(N, Env, Place, Vars),
    Env = env(_, _, _, _, args(K, X, Base, Out, _), _),
    Ruling = ( Ruled
              ->  typhon_machine:handed(Place, Vars, K, X, Base, Out)
              ;   Code
              ),
    (   Heads = [Head]
    ->  Ruled = ( '$get_predicate_attribute'(Head, number_of_rules, Count),
                  Count \== 0,
                  typhon_machine:ruled(Heads, X)
                )
    ;   Ruled = typhon_machine:ruled(Heads, X)
    ).

                /*******************************
                *        NATIVE GOALS          *
                *******************************/

%   noted(+Node, +Rest, +Phase, +Env, -Called): Called calls the goal of Node,
%   and notes its failure.  Rest is the code after it.

noted(N-(Variable = Term), _, _, Env, Called), fresh(Variable, Term, N, Env) =>
    Called = (Variable = Term).
noted(N-(Variable is Expression), Rest, Phase, Env, Called),
        added(Variable, Expression, N, Env, Number) =>
    Called = ( integer(Number)
             ->  Variable is Expression
             ;   Other
             ),
    called(N-(Variable is Expression), Rest, Phase, Env, Other).
noted(Node, Rest, Phase, Env, Called) =>
    called(Node, Rest, Phase, Env, Called).

called(N-Goal, Rest, Phase, Env, Called) :-
    native(N, Goal, Env, Native),
    fails(N, Phase, Env, Fails),
    live(Goal, Rest, Live),
    Called = ( Native *-> Live ; Fails ).

%   live(+Goal, +Rest, -Code): after the last use of a variable garbage
%   collection may undo its binding.  A variable of Goal that Rest does not use
%   has its last use when Goal is called.  If Goal then raised an error, the
%   fault would not show the binding that Goal made.  Code, after Goal, uses the
%   variable.  Foreign predicates do not need this: they raise errors before
%   they bind variables.

live(Goal, _, true) :-
    '$get_predicate_attribute'(system:Goal, foreign, 1),
    \+ '$get_predicate_attribute'(system:Goal, transparent, 1),
    !.
live(Goal, Rest, Code) :-
    term_variables(Rest, Needed),
    term_variables(Goal, Variables),
    exclude(among(Needed), Variables, Dead),
    foldl(needs, Dead, true, Code).

needs(Variable, Code, (Variable == Variable, Code)).

%   fresh(+Variable, +Term, +N, +Env): Variable is new at N and not in Term, so
%   Variable = Term cannot fail.

fresh(Variable, Term, N, Env) :-
    new(N, Env, New),
    var(Variable),
    among(New, Variable),
    \+ occurs(Variable, Term).

%   added(...) is semidet: Expression is the sum of Number and a small integer,
%   which is fast, and cannot fail either, if Number is an integer.

added(Variable, Expression, N, Env, Number) :-
    nonvar(Expression),
    ( Expression = Number+I ; Expression = Number-I ),
    var(Number),
    integer(I),
    abs(I) < 1000,
    fresh(Variable, Number, N, Env),
    \+ current_prolog_flag(optimise, true).

new(N, Env, New) :-
    arg(3, Env, Places),
    memberchk(place(N, _, New, _, _), Places).

%   The arguments of fails_at/3 include the variables that are new in the goal,
%   because the fault of an error is read from them, and leave out the barrier.

fails(N, Phase, Env, typhon_faults:Fails) :-
    ( Phase == lead -> Name = test_fails ; Name = fails_at ),
    Env = env(Module, _, Places, _, args(K, _, _, _, Barrier), _),
    at(N, Env, Place, _),
    memberchk(place(N, Old, New, _, _), Places),
    append(Old, New, Variables0),
    maplist(but_for(Barrier), Variables0, Variables),
    Vars =.. [Module|Variables],
    Fails =.. [Name, Place, Vars, K].

but_for(Barrier, Variable, Other) :-
    (   Variable == Barrier
    ->  Other = none
    ;   Other = Variable
    ).

%   native(+N, +Goal, +Env, -Native): arithmetic that would be compiled into
%   the clause is called instead, so that an error has a frame.  Variables are
%   kept even if they occur only once, so that they can be read after an error.

native(_, Variable is Expression, _, Native) :-
    !,
    (   current_prolog_flag(optimise, true)
    ->  Native = call(Variable is Expression)
    ;   Native = ( Variable = _, Variable is Expression )
    ).
native(_, Goal, _, call(Goal)) :-
    inlined(Goal),
    !.
native(N, Goal, Env, Native) :-
    Env = env(Module, Own, _, _, _, _),
    native_body(Goal, Module, Own, Native0),
    (   '$get_predicate_attribute'(system:Goal, system, 1)
    ->  Native = Native0
    ;   new(N, Env, New),
        kept(New, Native0, Native)
    ).

kept([], Native, Native).
kept([Variable|Variables], Native0, (Variable = _, Native)) :-
    kept(Variables, Native0, Native).

%   With the flag `optimise` arithmetic is compiled into the clause, and var(X)
%   of a new X is compiled wrongly: after a condition with it X may be
%   uninitialized, which crashes.

inlined(Goal) :-
    current_prolog_flag(optimise, true),
    functor(Goal, Name, Arity),
    memberchk(Name/Arity, [ var/1, nonvar/1, (<)/2, (>)/2, (=<)/2, (>=)/2,
                            (=:=)/2, (=\=)/2 ]).

%   test(+Node, +Env, -Code): the failure of a goal in a condition is not noted.
%   The call of test_fails/3 after the goal holds the place of an error.

test(N-Goal, Env, Code) :-
    node_parts(Goal, N, Parts),
    test(Parts, N-Goal, Env, Code).

test(both(A, B), _, Env, Code) =>
    Code = (CodeA,CodeB),
    test(A, Env, CodeA),
    test(B, Env, CodeB).
test(either(A, B), _, Env, Code) =>
    Code = (CodeA;CodeB),
    test(A, Env, CodeA),
    test(B, Env, CodeB).
test(not(A), _, Env, Code) =>
    Code = (\+ CodeA),
    test(A, Env, CodeA).
test(if(Arrow, If, Then, Else, _), _, Env, Code) =>
    test(If, Env, CodeI),
    test(Then, Env, CodeT),
    test(Else, Env, CodeE),
    condition(Arrow, CodeI, CodeT, CodeE, Code).
test(none, _-Goal, _, Code), harmless(Goal) =>
    Code = Goal.
test(none, N-Goal, Env, Code) =>
    called(N-Goal, true, lead, Env, Code).

%   Goal raises no error.

harmless(Goal) :-
    \+ inlined(Goal),
    memberchk(Goal, [ !, true, fail, false, _ = _, _ == _, _ \== _, var(_),
                      nonvar(_), atom(_), integer(_), number(_), atomic(_),
                      compound(_) ]).
