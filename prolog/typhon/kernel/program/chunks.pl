:- module(typhon_chunks,
          [ chunks_ready/1,             % +Module
            place_left/4,               % +Place, +Vars, -Goal, -Goals
            place_marked/3              % +Place, +Vars, -Left
          ]).
:- use_module(library(apply), [include/3, maplist/2, maplist/3]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, nth0/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(bodies, [plain_goals/2]).
:- use_module(clause_places,
              [clause_places/5, node_parts/3]).
:- use_module(code, [code_module/2, code_program/2, native_body/4]).
:- use_module(control, [special/2]).
:- use_module(mobile, [body_calls/2, built_in/1]).
:- use_module(source, [clause_parts/3]).

/** <module> Programs compiled in chunks, from stop to stop

The machine (typhon_machine) says what a program means.  What runs is mostly
this: each clause of a predicate in which an agent may stop becomes native
clauses, when an agent runs the program first.

    'run p'(A1, ..., AN, K, X, Base, Out)

runs a call of p/N and then the goals K; the last three are those of run/4 of
the machine.  Where the clause calls another such predicate, what is left of it
is put before K as a frame

    '$k'(Place, 'program 7'(V1, ..., VM))

that names the place in the clause, see typhon_clause_places, and has the
values of its variables.  The name of the second term is the module of the
program.  These tables are in that module:

    '$k'(Place, Vars, K, X, Base, Out)  runs a frame, and then K
    '$goals'(Place, Vars, Goals, Rest)  the goals that a frame stands for
    '$frame'(First, Goals, Base, Frame, Rest)  the frame for goals
    '$run'(Head, Run, K, X, Base, Out, Condition)  how to call a predicate

No frame outlives a run: where the agent stops the goals are left (plain_goals/2),
and when it goes on, a frame is made of them again if that saves time.  So
whatever looks at an agent, or carries it, sees its goals.

A goal that cannot stop is called as it stands, and

    ( Goal *-> true ; typhon_faults:fails_at(Place, Vars, K) )

notes its failure.  If-then-else, `\+`, once/1 and ignore/1 are compiled if
their tests cannot stop, disjunctions always.  The machine runs the other
constructs, such as catch/3, and call/1, one by one, and what a chunk has left if
a predicate that it calls has rules in the agent's state.

*Threading*: one mutex while a program is compiled.
*/

%!  chunks_ready(+Module) is semidet.
%
%   Module is the module of a program, compiled now or before.

chunks_ready(Module) :-
    '$get_predicate_attribute'(Module:'$chunks'(_), defined, 1),
    !.
chunks_ready(Module) :-
    code_module(Hash, Module),
    code_program(Hash, Program),
    with_mutex(typhon_chunks, compile(Module, Program)).

compile(Module, _) :-
    '$get_predicate_attribute'(Module:'$chunks'(_), defined, 1),
    !.
compile(Module, program(_, State, _, Clauses)) :-
    length(Clauses, Count),
    maplist(head_pi, Clauses, PIs0),
    sort(PIs0, OwnPIs),
    maplist(pi_kind(Module), OwnPIs, Kinds),
    findall(PI-state, member(PI, State), StateKinds),
    append(Kinds, StateKinds, OwnKinds),
    list_to_assoc(OwnKinds, Own),
    tables(Module),
    numbered_clauses(Clauses, 0, Numbered),
    findall(Compiled,
            ( append(_, [C|Later], Numbered),
              clause_compiled(C, Later, Count, Module, Own, Compiled)
            ),
            All),
    include(is_mobile, Kinds, Mobile),
    maplist(add_predicate(Module, All), Mobile, Made),
    append(Made, Predicates),
    forall(( member(compiled(_, _, _, _, Frames), All),
             member(Frame, Frames) ),
           add_frame(Module, Frame)),
    assertz(Module:('$goals'(Place, Vars, Goals, Rest) :-
                        typhon_chunks:place_plain(Place, Vars, Goals, Rest))),
    assertz(Module:( '$frame'(_, _, _, _, _) => fail )),
    include(has_clauses(Module), ['$k'/6, '$run'/7], Tables),
    append([Tables,['$go'/4],Predicates], All1),
    maplist(qualified(Module), All1, PIs),
    compile_predicates(PIs),
    assertz(Module:'$chunks'(Count)).

qualified(Module, PI, Module:PI).

has_clauses(Module, Name/Arity) :-
    functor(Head, Name, Arity),
    predicate_property(Module:Head, number_of_clauses(Count)),
    Count > 0.

tables(Module) :-
    dynamic([ Module:'$k'/6, Module:'$go'/4, Module:'$goals'/4,
              Module:'$frame'/5, Module:'$run'/7, Module:'$marked'/4,
              Module:'$added'/1 ]),
    module_transparent([Module:'$k'/6, Module:'$go'/4]),
    assertz(Module:('$go'(['$k'(P,V)|K], X, B, O) :-
                 !,
                 '$k'(P, V, K, X, B, O))),
    assertz(Module:('$go'(K, X, B, O) :-
                 typhon_machine:continue(K, X, B, O))).

%   The kinds of typhon_mobile, as the table of the module has them.

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

numbered_clauses([], _, []).
numbered_clauses([Clause|Clauses], I, [I-Clause|Numbered]) :-
    I1 is I+1,
    numbered_clauses(Clauses, I1, Numbered).

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
    clause_places(Head, Body, Barrier, Nodes, Places),
    Env = env(Module, Own, Places, I/Count, args(K, X, Base, Out, Barrier),
              frames([])),
    phase(Name/Arity, Later, Phase),
    block(Nodes, [], tail, Phase, Env, Code),
    arg(6, Env, frames(Frames)).

%   phase(+PI, +Later, -Phase): of Later clauses, one is for all calls.

phase(Name/Arity, Later, lead) :-
    functor(General, Name, Arity),
    member(_-Clause, Later),
    clause_parts(Clause, Head, _),
    subsumes_term(Head, General),
    !.
phase(_, _, first).

%   add_predicate(+Module, +All, +Kind, -PIs): what calls 'run p' comes to its
%   clauses, or first notes that the head of none matches, and where a cut
%   cuts to.

add_predicate(Module, All, (Name/Arity)-Condition, PIs) :-
    functor(Head, Name, Arity),
    Args = [K,X,Base,Out],
    named('run ', Head, Args, Run),
    assertz(Module:'$run'(Head, Run, K, X, Base, Out, Condition)),
    findall(C, ( member(C, All), C = compiled(Head, _, _, _, _) ), Clauses),
    (   plain_entry(Clauses)
    ->  add_clauses(Clauses, Module, 'run ', [RunPI]),
        PIs = [RunPI]
    ;   add_clauses(Clauses, Module, 'do ', [DoPI]),
        named('do ', Head, [Barrier|Args], Do),
        add_heads(Clauses, Module, Head, Matches, HeadPIs),
        declare(Module, Run, RunPI),
        assertz(Module:(Run :-
                     prolog_current_choice(Barrier),
                     (   \+ Matches
                     ->  typhon_faults:fails(Head, K)
                     ;   Do
                     ))),
        PIs = [RunPI,DoPI|HeadPIs]
    ).

plain_entry(Clauses) :-
    total(Clauses),
    \+ ( member(compiled(_, Barrier, _, Code, _), Clauses),
         sub_variable(Barrier, Code) ).

%   Some clause is for all calls.

total(Clauses) :-
    member(compiled(Head, _, _, _, _), Clauses),
    functor(Head, Name, Arity),
    functor(General, Name, Arity),
    subsumes_term(Head, General),
    !.

sub_variable(Variable, Term) :-
    term_variables(Term, Variables),
    among(Variables, Variable).

among(Variables, Variable) :-
    member(Other, Variables),
    Other == Variable,
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

add_clauses([Clause|Clauses], Module, Prefix, [PI]) :-
    run_head(Clause, Prefix, Head0),
    declare(Module, Head0, PI),
    forall(member(C, [Clause|Clauses]),
           ( run_head(C, Prefix, Head),
             C = compiled(_, _, _, Code, _),
             assertz(Module:(Head :- Code)) )).

run_head(compiled(Head, _, Args, _, _), 'run ', Run) :-
    named('run ', Head, Args, Run).
run_head(compiled(Head, Barrier, Args, _, _), 'do ', Run) :-
    named('do ', Head, [Barrier|Args], Run).

declare(Module, Head, Name/Arity) :-
    functor(Head, Name, Arity),
    module_transparent(Module:Name/Arity),
    dynamic(Module:Name/Arity).

named(Prefix, Goal, More, Named) :-
    Goal =.. [Name|Args],
    atom_concat(Prefix, Name, NewName),
    append(Args, More, NewArgs),
    Named =.. [NewName|NewArgs].

                /*******************************
                *            FRAMES            *
                *******************************/

%   A frame is frame(Place, Vars, Args, Code).

add_frame(Module, frame(Place, Vars, args(K, X, Base, Out, _), Code)) :-
    assertz(Module:('$k'(Place, Vars, K, X, Base, Out) :- Code)).

%   frame_at(+Nodes, +Outer, +Env, -Place, -Vars): the frame of Nodes and then
%   Outer is made if it is not there yet.

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

%   at(+N, +Env, -Place, -Vars): the number of a place in a program
%   says its clause, too.

at(N, env(Module, _, Places, I/Count, _, _), Place, Vars) :-
    memberchk(place(N, Variables, _, _, _), Places),
    Place is N*Count+I,
    Vars =.. [Module|Variables].

rest(Nodes, Outer, Env, Goals) :-
    arg(5, Env, args(K, _, _, _, _)),
    (   Nodes == [],
        Outer == []
    ->  Goals = K
    ;   frame_at(Nodes, Outer, Env, Place, Vars),
        Goals = ['$k'(Place, Vars)|K]
    ).

%!  place_left(+Place, +Vars, -Goal, -Goals) is det.
%!  place_marked(+Place, +Vars, -Left) is det.
%
%   The goal at a place, and the goals that are left there, with cuts as the
%   machine has them; Left is Goals-Rest.  Vars is the name of the module alone
%   if they are not known.

place_marked(Place, Vars, Goals-Rest) :-
    functor(Vars, Module, _),
    (   Module:'$marked'(Place, Vars, Goals0, Rest)
    ->  Goals = Goals0
    ;   functor(Vars, _, Arity),
        functor(General, Module, Arity),
        place_left(Place, General, _, Goals1),
        append(Goals1, Rest1, Goals2),
        assertz(Module:'$marked'(Place, General, Goals2, Rest1)),
        place_marked(Place, Vars, Goals-Rest)
    ).

:- public place_plain/4.

%   The tables '$goals' and '$frame' have the places that were asked for, the
%   first of them last.

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
    Module:'$added'(Place),
    !.
add_place(Module, Place, General, Goals, Plain, List, Rest) :-
    assertz(Module:'$added'(Place)),
    asserta(Module:'$goals'(Place, General, List, Rest)),
    (   is_frame(Module, Place, General),
        worth(Plain),
        Plain = [First|_]
    ->  functor(First, Name, Arity),
        functor(Head, Name, Arity),
        barrier(Goals, Base),
        asserta(Module:( '$frame'(Head, List, Base0, Frame, Rest0) =>
                             Base0 = Base,
                             Frame = '$k'(Place, General),
                             Rest0 = Rest ))
    ;   true
    ).

is_frame(Module, Place, Vars) :-
    \+ \+ clause(Module:'$k'(Place, Vars, _, _, _, _), _).

%   It begins with native goals, as far as can be seen.

worth([A,B,C|_]) :-
    maplist(plain_goal, [A,B,C]).

plain_goal(Goal) :-
    callable(Goal),
    \+ special(Goal, _).

%   Cuts go to where the run began.

barrier(Goals, Barrier) :-
    sub_term(Cut, Goals),
    nonvar(Cut),
    Cut = '$cut'(Barrier),
    !.
barrier(_, _).

place_left(Place, Vars, Goal, Goals) :-
    functor(Vars, Module, _),
    Module:'$chunks'(Count),
    code_module(Hash, Module),
    code_program(Hash, program(_, _, _, Clauses)),
    I is Place mod Count,
    N is Place//Count,
    nth0(I, Clauses, Clause),
    clause_parts(Clause, Head, Body),
    clause_places(Head, Body, _, _, Places),
    memberchk(place(N, Old, New, Goal, Goals), Places),
    Vars =.. [_|Values],
    append(Old, New, Variables),
    append(Values, _, Variables),
    !.

                /*******************************
                *            BLOCKS            *
                *******************************/

%   block(+Nodes, +Outer, +Mode, +Phase, +Env, -Code): Code runs Nodes.  If Mode
%   is `tail` it goes on with Outer, and with K; `through` leaves that to what
%   comes after it, and cannot stop.  Phase is `lead` or `first` in the clause
%   of a predicate, `later` in a frame.  What fails in the lead need not be noted:
%   no cut came before, so that another clause is tried, and if that comes to
%   nothing, something in it has failed last.

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
    how(Goal, Env, How),
    block(How, N-Goal, Nodes, Outer, Mode, Phase, Env, Code).

block(true, _, Nodes, Outer, Mode, Phase, Env, Code) =>
    block(Nodes, Outer, Mode, Phase, Env, Code).
block(cut, _, Nodes, Outer, Mode, Phase, Env, Code) =>
    Code = (Cut,Rest),
    cut(Phase, Env, Cut),
    after_cut(Phase, Phase1),
    block(Nodes, Outer, Mode, Phase1, Env, Rest).
block(leaf(Heads), Node, Nodes, Outer, Mode, Phase, Env, Code) =>
    noted(Node, Phase, Env, Called),
    block(Nodes, Outer, Mode, Phase, Env, Rest),
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
            Code), Else = _-Fail, Fail == fail =>
    test(If, Env, Test),
    fails(N, Phase, Env, Fails),
    branches([Then], Nodes, Outer, Mode, Phase, Env, [CodeT], Rest),
    condition(Arrow, Test, CodeT, Fails, Code0),
    join(Code0, Rest, Code).
parts_block(if(Arrow, If, Then, Else, _), _, Nodes, Outer, Mode, Phase, Env,
            Code) =>
    test(If, Env, Test),
    branches([Then,Else], Nodes, Outer, Mode, Phase, Env, [CodeT,CodeE], Rest),
    condition(Arrow, Test, CodeT, CodeE, Code0),
    join(Code0, Rest, Code).

condition(->, If, Then, Else, (If->Then;Else)).
condition(*->, If, Then, Else, (If*->Then;Else)).

join(Code, none, Code) :-
    !.
join(Code, Rest, (Code,Rest)).

%   branches(+Branches, +Nodes, ...): if no branch can stop what comes after is
%   Rest, else each goes on with it.

branches(Branches, Nodes, Outer, Mode, Phase, Env, Codes, Rest) :-
    (   \+ ( member(Branch, Branches),
             \+ cannot_stop(Branch, Env) )
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

%   A branch may have cut.

after_branches(Branches, lead, first) :-
    sub_term(Cut, Branches),
    nonvar(Cut),
    Cut = '$cut'(_),
    !.
after_branches(_, Phase, Phase).

%   unless_ruled(+Heads, +Node, +Env, +Code0, -Code): Code0 if none of Heads holds
%   rules in the state of the agent.

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

%   noted(+Node, +Phase, +Env, -Called): Goal is called, and its failure noted.

noted(N-(Variable = Term), _, Env, Called), fresh(Variable, Term, N, Env) =>
    Called = (Variable = Term).
noted(N-(Variable is Expression), Phase, Env, Called),
        added(Variable, Expression, N, Env, Number) =>
    Called = ( integer(Number)
             ->  Variable is Expression
             ;   Other
             ),
    called(N-(Variable is Expression), Phase, Env, Other).
noted(Node, Phase, Env, Called) =>
    called(Node, Phase, Env, Called).

called(N-Goal, Phase, Env, Called) :-
    native(N, Goal, Env, Native),
    fails(N, Phase, Env, Fails),
    Called = ( Native *-> true ; Fails ).

%   This cannot fail.

fresh(Variable, Term, N, Env) :-
    new(N, Env, New),
    var(Variable),
    among(New, Variable),
    \+ sub_variable(Variable, Term).

%   This is quick, and cannot fail either, if Number is an integer.

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

%   What fails_at/3 is called with has the variables that are new in the goal,
%   too, for what reads them where an error is raised, and no barrier.

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

%   native(+N, +Goal, +Env, -Native): arithmetic that the compiler would do in
%   the clause is called, so that an error has a frame.  Variables are kept even
%   if they occur but once, so that they can be read then.

native(_, Variable is Expression, _, Native) :-
    !,
    (   current_prolog_flag(optimise, true)
    ->  Native = call(Variable is Expression)
    ;   Native = ( Variable = _, Variable is Expression )
    ).
native(_, Goal, _, call(Goal)) :-
    current_prolog_flag(optimise, true),
    Goal =.. [Name,_,_],
    memberchk(Name, [<,>,=<,>=,=:=,=\=]),
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

%   test(+Node, +Env, -Code): of what fails in a condition the machine makes
%   nothing in the end; of an error in it the place is told by what would be
%   called then.

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
    native(N, Goal, Env, Native),
    fails(N, lead, Env, Fails),
    Code = ( Native *-> true ; Fails ).

%   It raises no error.

harmless(Goal) :-
    memberchk(Goal, [ !, true, fail, false, _ = _, _ == _, _ \== _, var(_),
                      nonvar(_), atom(_), integer(_), number(_), atomic(_),
                      compound(_) ]).

                /*******************************
                *        CLASSIFICATION        *
                *******************************/

%   how(+Goal, +Env, -How): how Goal is compiled.  leaf(Heads) and parts(Heads)
%   may stop only if one of Heads has rules in the state.

how(Goal, _, How), var(Goal) =>
    How = machine.
how(true, _, How) =>
    How = true.
how('$cut'(_), _, How) =>
    How = cut.
how(Goal, Env, How), node_parts(Goal, 0, Parts), Parts \== none =>
    (   parts_tests(Parts, Tests),
        maplist(testable(Env), Tests, Heads0)
    ->  append(Heads0, Heads),
        How = parts(Heads)
    ;   How = machine
    ).
how(Goal, Env, How) =>
    goal_how(Goal, Env, How).

%   parts_tests(+Parts, -Tests): the parts that must not stop.

parts_tests(both(_, _), []).
parts_tests(either(_, _), []).
parts_tests(not(_-A), [A]).
parts_tests(if(->, _-If, _, _, _), [If]).
parts_tests(if(*->, _-If, _, _, _), [If]) :-    % else more might be noted
    node_parts(If, 0, none).

goal_how(Goal, _, How), special(Goal, Kind) =>
    (   Kind == control
    ->  How = control
    ;   How = machine
    ).
goal_how(Goal, env(Module, Own, _, _, _, _), How), callable(Goal),
        \+ memberchk(Goal, [!, call(_), catch(_, _, _), _:_]) =>
    functor(Goal, Name, Arity),
    (   get_assoc(Name/Arity, Own, Kind)
    ->  own_how(Kind, Goal, How)
    ;   bound(Goal, Module)
    ->  How = leaf([])
    ;   functor(Head, Name, Arity),
        How = leaf([Head])
    ).
goal_how(_, _, How) =>
    How = machine.

own_how(native, _, leaf([])).
own_how(mobile, _, mobile).
own_how(open, _, mobile).
own_how(outside(Heads), _, leaf(Heads)).
own_how(state, Goal, leaf([Head])) :-
    functor(Goal, Name, Arity),
    functor(Head, Name, Arity).

bound(Goal, Module) :-
    functor(Goal, Name, Arity),
    (   built_in(Name/Arity)
    ->  true
    ;   '$get_predicate_attribute'(Module:Goal, imported, _)
    ).

%   testable(+Env, +Goal, -Heads) is semidet: Goal cannot stop, unless one of
%   Heads has rules in the state, and the machine has no part in it.

testable(Env, Goal, Heads) :-
    node_parts(Goal, 0, Parts),
    testable(Parts, Goal, Env, Heads).

testable(none, Goal, Env, Heads) :-
    !,
    nonvar(Goal),
    (   memberchk(Goal, [!, true])
    ->  Heads = []
    ;   how(Goal, Env, leaf(Heads)),
        body_calls(Goal, Calls),
        \+ memberchk(unknown(_), Calls)
    ).
testable(Parts, _, Env, Heads) :-
    findall(Part, part(Parts, Part), Goals),
    maplist(testable(Env), Goals, Heads0),
    append(Heads0, Heads).

part(both(_-A, _-B), Part) :- ( Part = A ; Part = B ).
part(either(_-A, _-B), Part) :- ( Part = A ; Part = B ).
part(not(_-A), A).
part(if(_, _-A, _-B, _-C, _), Part) :- ( Part = A ; Part = B ; Part = C ).

%   cannot_stop(+Node, +Env) is semidet: a branch that is compiled in its place.

cannot_stop(_-Goal, Env) :-
    how(Goal, Env, How),
    cannot_stop(How, Goal, Env).

cannot_stop(true, _, _).
cannot_stop(cut, _, _).
cannot_stop(leaf([]), _, _).
cannot_stop(parts([]), Goal, Env) :-
    node_parts(Goal, 0, Parts),
    branches_of(Parts, Branches),
    \+ ( member(Branch, Branches),
         \+ cannot_stop(Branch, Env) ).

branches_of(both(A, B), [A,B]).
branches_of(either(A, B), [A,B]).
branches_of(not(_), []).
branches_of(if(_, _, A, B, _), [A,B]).
