:- module(typhon_chunk_compiler, []).

/** <module> The compiler of programs in chunks

See typhon_chunks.  A goal that cannot stop is called natively, and

    ( Goal *-> true ; typhon_faults:fails_at(Place, Vars, K) )

notes its failure.  If-then-else, `\+`, once/1 and ignore/1 are compiled if
their tests cannot stop; disjunctions always.  The machine runs the other
constructs, such as catch/3 and call/1, one by one.  It also runs the rest of a
chunk if a predicate that the chunk calls has rules in the agent's state.

A place of a program is (Number*Count+Clause)*2, for the goal of that number in
a clause, of which there are Count, plus 1 if a cut
of the clause is left there.  The goals that are left at a place are computed
from the clause when they are first asked for.  Then two tables of the
program's module hold them: '$goals'/4, from frames to goals, and, if that
saves time, '$frame'/5, from goals to frames.

Each goal of a clause has a number, in the order of the text.  When the machine
comes to a goal, certain goals of the clause are left: those from there on, and
within a condition the rest of the condition.  They depend on the clause alone.
So a number and the values of variables stand for a list of goals.

A node is N-Goal.  A place is place(N, Old, New, Goal, Goals): at Goal, the
machine has Goals left of the clause; Old are those of their variables that
occurred before, New those that occur first in Goal.  Cuts of the clause are
'$cut'(Barrier).

*Threading*: one mutex while a program is compiled, or a place is added.  The
compiler is pure, except for the destructive change of a term of its own.
*/

:- use_module(library(apply),
              [exclude/3, foldl/4, include/3, maplist/2, maplist/3]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, nth0/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module('../../kernel/program',
              [ body_calls/2, body_goals/4, built_in/1, clause_parts/3,
                code_compiled/2, code_program/2, goals_body/2, named/4,
                native_body/4, plain_goal/2, plain_goals/2, special/2 ]).
:- use_module(chunk_faults, []).

:- multifile
    typhon_chunks:compiled/1,
    typhon_chunks:place_left/4,
    typhon_chunks:place_plain/4,
    typhon_on_demand:joins/2.

typhon_on_demand:joins(program, runs).

typhon_chunks:compiled(Module) :-
    code_compiled(Hash, Module),
    code_program(Hash, Program),
    with_mutex(typhon_chunks, sig_atomic(compile_once(Module, Program))).

compile_once(Module, Program) :-
    (   '$get_predicate_attribute'(Module:'$go'(_, _, _, _), defined, 1)
    ->  '$get_predicate_attribute'(Module:'$goals'(_, _, _, _), defined, 1)
    ;   compile(Module, Program)
    ).

compile(Module, program(_, State, _, Clauses)) :-
    tables(Module),
    length(Clauses, Count),
    kinds(Module, Clauses, Kinds),
    findall(PI-state, member(PI, State), StateKinds),
    append(Kinds, StateKinds, OwnKinds),
    list_to_assoc(OwnKinds, Own),
    findall(I-Clause, nth0(I, Clauses, Clause), Numbered),
    findall(Compiled,
            ( append(_, [C|Later], Numbered),
              clause_compiled(C, Later, Count, Module, Own, Compiled)
            ),
            All),
    include(is_mobile, Kinds, Mobile),
    maplist(add_predicate(Module, All), Mobile, Made),
    forall(( member(compiled(_, _, _, _, Frames), All),
             member(Frame, Frames) ),
           add_frame(Module, Frame)),
    include(has_clauses(Module), ['$k'/6, '$run'/7], Tables),
    append([['$go'/4],Tables|Made], Static),
    compile_predicates(Module:Static),
    dynamic(Module:'$goals'/4).         % marks the program as compiled

has_clauses(Module, Name/Arity) :-
    functor(Head, Name, Arity),
    predicate_property(Module:Head, number_of_clauses(Count)),
    Count > 0.

tables(Module) :-
    '$clausable'(Module:'$k'/6),
    dynamic([Module:'$k'/6, Module:'$go'/4, Module:'$run'/7]),
    module_transparent([Module:'$k'/6, Module:'$go'/4]),
    assertz(Module:('$go'(['$k'(P,V)|K], X, B, O) :-
                 !,
                 '$k'(P, V, K, X, B, O))),
    assertz(Module:('$go'(K, X, B, O) :-
                 typhon_machine:continue(K, X, B, O))).

%   The kinds of mobile_predicates/3, from the table '$mobile'/6 of the module.

kinds(Module, Clauses, Kinds) :-
    maplist(head_pi, Clauses, PIs0),
    sort(PIs0, PIs),
    maplist(pi_kind(Module), PIs, Kinds).

pi_kind(Module, Name/Arity, (Name/Arity)-Kind) :-
    functor(General, Name, Arity),
    (   Module:'$mobile'(General, _, _, _, _, Kind0)
    ->  Kind = Kind0
    ;   Kind = native
    ).

head_pi(Clause, Name/Arity) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).

is_mobile(_-Kind) :-
    Kind \== native.

                /*******************************
                *          PREDICATES          *
                *******************************/

%   clause_compiled(+Numbered, ...) is semidet: Compiled is compiled(Head,
%   Barrier, Arguments, Code, Frames).

clause_compiled(I-Clause, Later, Count, Module, Own,
                compiled(Head, Barrier, [K,X,Base,Out], Code, Frames)) :-
    clause_parts(Clause, Head, Body),
    functor(Head, Name, Arity),
    get_assoc(Name/Arity, Own, Kind),
    Kind \== native,
    phase(Name/Arity, Later, Phase),
    clause_code(own(Module, Own, I/Count), (Head:-Body), Phase,
                args(K, X, Base, Out, Barrier), Code-Frames).

%   phase(+PI, +Later, -Phase): `lead` if one of the Later clauses matches all
%   calls.

phase(Name/Arity, Later, lead) :-
    functor(General, Name, Arity),
    member(_-Clause, Later),
    clause_parts(Clause, Head, _),
    subsumes_term(Head, General),
    !.
phase(_, _, first).

%   add_predicate(+Module, +All, +Kind, -PIs): a call of 'run p' first records
%   where a cut cuts to, and notes a failure if no clause head matches.

add_predicate(Module, All, (Name/Arity)-Condition, PIs) :-
    functor(Head, Name, Arity),
    Args = [K,X,Base,Out],
    named('run ', Head, Args, Run),
    assertz(Module:'$run'(Head, Run, K, X, Base, Out, Condition)),
    findall(C, ( member(C, All), C = compiled(Head, _, _, _, _) ), Clauses),
    barriers(Clauses, Barriers),
    (   total(Clauses),
        Barriers == []
    ->  add_clauses(Clauses, Module, 'run ', [], [RunPI]),
        PIs = [RunPI]
    ;   add_clauses(Clauses, Module, 'do ', Barriers, [DoPI]),
        append(Barriers, Args, DoArgs),
        named('do ', Head, DoArgs, Do),
        add_heads(Clauses, Module, Head, Matches, HeadPIs),
        declare(Module, Run, RunPI),
        entry(Matches, Barriers, typhon_faults:fails(Head, K), Do, Entry),
        assertz(Module:(Run :- Entry)),
        PIs = [RunPI,DoPI|HeadPIs]
    ).

%   barriers(+Clauses, -Barriers): [_] if Clauses contain cuts, which need a
%   barrier, else [].

barriers(Clauses, [_]) :-
    member(compiled(_, Barrier, _, Code, _), Clauses),
    occurs(Barrier, Code),
    !.
barriers(_, []).

entry(Matches, [Barrier], Fails, Do, Entry) =>
    Entry = (prolog_current_choice(Barrier),Entry1),
    entry(Matches, [], Fails, Do, Entry1).
entry(true, [], _, Do, Entry) =>
    Entry = Do.
entry(Matches, [], Fails, Do, Entry) =>
    Entry = (\+ Matches -> Fails ; Do).

total(Clauses) :-
    member(compiled(Head, _, _, _, _), Clauses),
    functor(Head, Name, Arity),
    functor(General, Name, Arity),
    subsumes_term(Head, General),
    !.

add_heads(Clauses, _, _, true, []) :-
    total(Clauses),
    !.
add_heads(Clauses, Module, Head, Matches, [PI]) :-
    named('head ', Head, [], Matches),
    functor(Matches, Name, Arity),
    PI = Name/Arity,
    dynamic(Module:PI),
    forall(member(compiled(Head1, _, _, _, _), Clauses),
           ( named('head ', Head1, [], Fact),
             assertz(Module:Fact) )).

add_clauses([Clause|Clauses], Module, Prefix, Barriers, [PI]) :-
    run_head(Clause, Prefix, Barriers, Head0),
    declare(Module, Head0, PI),
    forall(member(C, [Clause|Clauses]),
           ( run_head(C, Prefix, Barriers, Head),
             C = compiled(_, _, _, Code, _),
             assertz(Module:(Head :- Code)) )).

run_head(compiled(Head, _, Args, _, _), Prefix, [], Run) :-
    named(Prefix, Head, Args, Run).
run_head(compiled(Head, Barrier, Args, _, _), Prefix, [_], Run) :-
    named(Prefix, Head, [Barrier|Args], Run).

declare(Module, Head, Name/Arity) :-
    functor(Head, Name, Arity),
    module_transparent(Module:Name/Arity),
    dynamic(Module:Name/Arity).

add_frame(Module, frame(Place, Vars, args(K, X, Base, Out, _), Code)) :-
    assertz(Module:('$k'(Place, Vars, K, X, Base, Out) :- Code)).

                /*******************************
                *             CODE             *
                *******************************/

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

                /*******************************
                *            GOALS             *
                *******************************/

typhon_chunks:place_plain(Place, Vars, Goals, Rest) :-
    place_plain(Place, Vars, Goals, Rest).

typhon_chunks:place_left(Place, Vars, Goal, Goals) :-
    place_left(Place, Vars, Goal, Goals).

%   The tables '$goals' and '$frame' hold the places that were asked for, the
%   first of them last.  They cannot be rules with `=>`: a call while the first
%   rule is being added finds none and raises an error; with `:-` it fails.

place_plain(Place, Vars, Goals, Rest) :-
    functor(Vars, Module, Arity),
    functor(General, Module, Arity),
    place_left(Place, General, _, Goals0),
    plain_goals(Goals0, Plain),
    append(Plain, Rest0, List),
    with_mutex(typhon_chunks,
               add_place(Module, Place, General, Goals0, Plain, List, Rest0)),
    Vars-Goals-Rest = General-List-Rest0.

add_place(Module, Place, _, _, _, _, _) :-
    clause(Module:'$goals'(Place, _, _, _), true),
    !.
add_place(Module, Place, General, Goals, Plain, List, Rest) :-
    asserta(Module:'$goals'(Place, General, List, Rest)),
    (   \+ \+ clause(Module:'$k'(Place, General, _, _, _, _), _),
        worth(Plain),
        Plain = [First|_]
    ->  functor(First, Name, Arity),
        functor(Head, Name, Arity),
        barrier(Goals, Base),
        term_variables(General, Known),
        term_variables(Plain, Variables),
        exclude(among(Known), Variables, New),
        untouched(New, General-Rest, Untouched),
        asserta(Module:('$frame'(Head, List0, Base, '$k'(Place, General), Rest) :-
                            subsumes_term(List, List0),
                            List = List0,
                            Untouched,
                            !))
    ;   true
    ).

%   untouched(+New, +Others, -Code): a frame does not hold the variables that
%   are New in its goals.  So Code succeeds if these are unbound, without
%   attributes, different from each other, and occur nowhere else, as when the
%   agent stopped at the place.  Code binds them to numbers to check that:
%   term_variables/2 would take twice as long.

untouched([], _, true) :-
    !.
untouched(New, Others, ( Unbound,
                         term_attvars(Variables, []),
                         term_variables(Others, Known),
                         \+ \+ ( Numbered,
                                 term_variables(Known, Left),
                                 Left == Known ) )) :-
    Variables =.. [new|New],
    foldl(unbound, New, true, Unbound),
    foldl(numbered, New, 0-true, _-Numbered).

unbound(Variable, Code, (var(Variable),Code)).

numbered(Variable, N0-Code, N-(Variable=N,Code)) :-
    N is N0+1.

%   worth(+Goals) is semidet: a frame saves time.  Goals begin with three goals
%   that are probably native.

worth([A,B,C|_]) :-
    maplist(plain_goal, [A,B,C]).

plain_goal(Goal) :-
    callable(Goal),
    \+ special(Goal, _).

%   Cuts go to the choice point at which the run began.

barrier(Goals, Barrier) :-
    sub_term(Cut, Goals),
    nonvar(Cut),
    Cut = '$cut'(Barrier),
    !.
barrier(_, _).

place_left(Place, Vars, Goal, Goals) :-
    functor(Vars, Module, _),
    code_compiled(Hash, Module),
    code_program(Hash, program(_, _, _, Clauses)),
    length(Clauses, Count),
    I is Place//2 mod Count,
    N is Place//2//Count,
    nth0(I, Clauses, Clause),
    clause_parts(Clause, Head, Body),
    clause_places(Head, Body, _, _, Places),
    memberchk(place(N, Old, New, Goal, Goals), Places),
    Vars =.. [_|Values],
    append(Old, New, Variables),
    append(Values, _, Variables),
    !.

                /*******************************
                *      PLACES IN CLAUSES       *
                *******************************/

%   clause_places(+Head, +Body, -Barrier, -Nodes, -Places): Nodes are the goals
%   of Body.

clause_places(Head, Body, Barrier, Nodes, Places) :-
    body_goals(Body, Barrier, Goals, []),
    goal_nodes(Goals, 0, Nodes),
    phrase(places(Nodes, [], top, Head-Barrier), Places).

goal_nodes([], _, []).
goal_nodes([Goal|Goals], N, [N-Goal|Nodes]) :-
    size(Goal, Size),
    N1 is N+Size,
    goal_nodes(Goals, N1, Nodes).

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

%   node_parts(+Goal, +N, -Parts): Parts are the nodes that Goal consists of:
%   both(A, B), either(A, B), not(A), if(Arrow, If, Then, Else, Failing), or
%   `none`. Failing is a node, too: the goal that, in the machine, has failed
%   where no branch is taken, if Else is `fail`.

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

%   among(+Variables:list, @Variable): Variable is one of Variables.

among(Variables, Variable) :-
    member(Other, Variables),
    Other == Variable,
    !.

%   occurs(+Variable, +Term): Variable occurs in Term.

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

%   goal_kind(+Goal, +Own, -Kind): Kind is `true`, `cut`, `control`, `mobile`,
%   `machine` (which runs it), leaf(Heads) or parts(Heads). The last two may
%   stop only if one of Heads has rules in the state of the agent. Own is
%   Module-Kinds of the program.

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

%   cannot_stop(+Goal, +Own): Goal is a branch that is compiled where it
%   stands.

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
