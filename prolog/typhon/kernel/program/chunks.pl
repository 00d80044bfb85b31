:- module(typhon_chunks,
          [ chunks_ready/1              % +Module
          ]).
:- use_module(library(apply), [include/3, maplist/2, maplist/3]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists), [append/2, append/3, member/2, nth0/3]).
:- use_module(bodies, [named/4]).
:- use_module(chunk_code, [clause_code/5]).
:- use_module(clause_places, [occurs/2]).
:- use_module(code, [code_compiled/2, code_program/2]).
:- use_module(source, [clause_parts/3]).

/** <module> Programs compiled in chunks, from stop to stop

The machine (typhon_machine) defines the meaning of a program.  Usually
compiled code runs instead: each clause of a predicate in which an agent may
stop is compiled to native clauses when an agent first runs the program.

    'run p'(A1, ..., AN, K, X, Base, Out)

runs a call of p/N and then the goals K; the last three arguments are those of
run/4 of the machine.  Where the clause calls another such predicate, the rest
of the clause is put before K as a frame

    '$k'(Place, 'program 7'(V1, ..., VM))

that names the place in the clause, see typhon_clause_places, and has the
values of its variables.  The name of the second term is the module of the
program.  These tables are in that module:

    '$k'(Place, Vars, K, X, Base, Out)  runs a frame, and then K
    '$run'(Head, Run, K, X, Base, Out, Condition)  how to call a predicate
    '$goals'(Place, Vars, Goals, Rest)  the goals that a frame stands for
    '$frame'(First, Goals, Base, Frame, Rest)  the frame for goals

Frames have a meaning only in this process, and only where the program runs
compiled.  Goals that are sent to another process, noted, shown, or run in
another way are converted to the goals that the frames stand for
(plain_goals/2), and a frame is made of these again if that saves time.  The
last two tables hold only places that were asked for.

A goal that cannot stop is called natively, and

    ( Goal *-> true ; typhon_faults:fails_at(Place, Vars, K) )

notes its failure.  If-then-else, `\+`, once/1 and ignore/1 are compiled if
their tests cannot stop; disjunctions always.  The machine runs the other
constructs, such as catch/3 and call/1, one by one.  It also runs the rest of a
chunk if a predicate that the chunk calls has rules in the agent's state.

*Threading*: one mutex while a program is compiled.
*/

%!  chunks_ready(+Module) is semidet.
%
%   The program in Module is compiled; compile it now if it was not.  Fails if
%   compiling has run out of memory; the machine runs the program then.

chunks_ready(Module) :-
    '$get_predicate_attribute'(Module:'$goals'(_, _, _, _), defined, 1),
    !.
chunks_ready(Module) :-
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
