:- module(random_programs,
          [ random_program/1,           % -Clauses
            program_installed/3,        % +Clauses, -Module, -Initial
            engines_differ/2            % +Clauses, -Difference
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(random),
              [random/1, random_between/3, random_member/2]).
:- use_module(library(typhon/kernel/program),
              [ code_install/3, code_module/2, fault/3, machine_run/3,
                plain_goals/2, program_load/6 ]).

/** <module> Random agent programs, run by all engines for comparison

Each program is run by the machine alone, by chunks, and by both in turn.  At
each stop the remaining goals and the state are passed to a new agent: as
goals, or, as within a process, as frames.
*/

                /*******************************
                *           PROGRAMS           *
                *******************************/

%!  random_program(-Clauses) is det.
%
%   main/0 and p1/1 to p4/1, each of which calls only those after it; n/1, o/1,
%   d/2 and c/1 cannot stop; c/1 raises an error after garbage collection.

random_program([ (:- agent(random, [state([t_/1, f/1, r/1])])),
                 (main :- n(X), Body),
                 (t(T) :- assertz(t_(T))),
                 n(1), n(2), n(3), o(2), (o(X) :- X > 2),
                 (d(X, Y) :- Y is X+1), (s(X) :- f(X)),
                 c(1), (c(3) :- garbage_collect, atom_length(_, _)),
                 f(7), f(8), r(5)
               | Clauses ]) :-
    body(0, X, Body),
    findall((Head:-Body1),
            ( between(1, 4, I),
              random_between(1, 3, Count),
              between(1, Count, _),
              argument(A),
              predicate(I, A, Head),
              term_variables(A, Vs),
              ( Vs = [V|_] -> true ; true ),
              body(I, V, Body1)
            ),
            Clauses).

argument(A) :-
    random_member(Kind, [v, v, v, v, 1, 2, f]),
    (   Kind == v
    ->  true
    ;   Kind == f
    ->  A = g(_)
    ;   A = Kind
    ).

predicate(I, A, Goal) :-
    atom_concat(p, I, Name),
    Goal =.. [Name,A].

body(I, X, Body) :-
    random_between(1, 5, Count),
    goals(Count, I, X, Body).

part(I, X, Body) :-
    random_between(1, 3, Count),
    goals(Count, I, X, Body).

goals(1, I, X, Goal) :-
    !,
    goal(I, X, Goal).
goals(Count, I, X, (Goal,Goals)) :-
    goal(I, X, Goal),
    Count1 is Count-1,
    goals(Count1, I, X, Goals).

goal(I, X, Goal) :-
    random(R),
    (   R < 0.50
    ->  usual(X, Goal)
    ;   R < 0.58
    ->  unusual(X, Goal)
    ;   R < 0.80                        % more would have no end
    ->  construct(I, X, Goal)
    ;   I < 4
    ->  J is I+1,
        random_between(J, 4, K),
        random_member(A, [X, X, _, 1, 2, g(X)]),
        predicate(K, A, Goal)
    ;   Goal = t(X)
    ).

usual(X, Goal) :-
    random_between(1, 99, K),
    random_member(Goal,
                  [ t(K-X), t(K-X), move(b), move(b), move(b), move(b),
                    move(b), move(b), n(X), o(X), f(X), s(X), r(X), X == 2,
                    X = 2, !, !, d(X, _), X > 1, _ is X+1, Y is X*2, t(Y),
                    true, assertz(f(X)), retract(f(X)), member(X, [1,2,3]),
                    functor(X, _, _) ]).

unusual(X, Goal) :-
    random_member(Goal,
                  [ fail, throw(oops), receive(X, 0), move(refused),
                    _ is foo+X, atom_length(X, _), unknown(X), c(X), c(_),
                    assertz((r(Z) :- move(b), Z = 3)),
                    assertz((r(Z) :- n(Z), Z > 1)),
                    findall(Z, n(Z), X), forall(n(Z), Z > 0), \+ \+ X = 1,
                    copy_term(X, _), G^true, call(move, b),
                    ( G = t(X), G ), ( G = move(b), call(G) ) ]).

construct(I, X, Goal) :-
    random_between(1, 16, Kind),
    construct(Kind, I, X, Goal).

construct(1, I, X, (A->B;C)) :- parts(I, X, [A,B,C]).
construct(2, I, X, (A->B;C)) :- test(X, A), part(I, X, B), part(I, X, C).
construct(3, I, X, (A->B;C)) :- test(X, A), part(I, X, B), part(I, X, C).
construct(4, I, X, (A->B)) :- test(X, A), part(I, X, B).
construct(5, I, X, (A*->B;C)) :- parts(I, X, [A,B,C]).
construct(6, I, X, (A*->B;C)) :- test(X, A), part(I, X, B), part(I, X, C).
construct(7, I, X, (A;B)) :- parts(I, X, [A,B]).
construct(8, I, X, (A;B)) :- parts(I, X, [A,B]).
construct(9, _, X, \+ A) :- test(X, A).
construct(10, _, X, once(A)) :- test(X, A).
construct(11, I, X, once(A)) :- uncut(I, X, A).
construct(12, I, X, ignore(A)) :- uncut(I, X, A).
construct(13, I, X, catch(A, Ball, B)) :-
    random_member(Ball, [oops, _, error(_, _)]),
    uncut(I, X, A),
    uncut(I, X, B).
construct(14, I, X, call(A)) :- part(I, X, A).
construct(15, I, X, (A->B;C;D)) :-
    test(X, A), part(I, X, B), test(X, C), part(I, X, D).
construct(16, _, X, ( n(X), X > 1 -> t(X), t(a), t(b) ; t(c) )).

parts(I, X, Parts) :-
    maplist(part(I, X), Parts).

uncut(I, X, Part) :-
    repeat,
    part(I, X, Part),
    \+ ( sub_term(Cut, Part), Cut == (!) ),
    !.

test(X, Test) :-
    random_between(1, 3, Count),
    tests(Count, X, Test).

tests(1, X, Test) :-
    !,
    random_member(Test,
                  [ X == 2, X = 1, n(X), n(_), X > 1, o(X), f(X), s(X), r(X),
                    var(X), nonvar(X), fail, true, \+ X = 2, !, ( n(X) ; o(X) ),
                    ( X == 1 -> true ; n(X) ), once(n(X)), _ is X+1, d(X, _),
                    member(X, [3,4]), unknown(X), c(X), t(test-X) ]).
tests(Count, X, (Test,Tests)) :-
    tests(1, X, Test),
    Count1 is Count-1,
    tests(Count1, X, Tests).

                /*******************************
                *            ENGINES           *
                *******************************/

%!  program_installed(+Clauses, -Module, -Initial) is det.
%
%   The program of Clauses is in Module; an agent begins with the state Initial.

program_installed(Clauses, Module, Initial) :-
    program_load(clauses(Clauses), Program, Initial, Hash, Kinds, _),
    code_install(Hash, Program, Kinds),
    code_module(Hash, Module).

%!  engines_differ(+Clauses, -Difference) is semidet.
%
%   Difference is differs(Engine, Log, Reference), where Log is all that can be
%   seen of a run.

engines_differ(Clauses, differs(Engine, Log, Reference)) :-
    program_installed(Clauses, Module, Initial),
    run_log(machine, Module, Initial, Reference),
    member(Engine, [chunks, frames, mixed, mixed_frames]),
    run_log(Engine, Module, Initial, Log),
    \+ Log =@= Reference,
    !.

run_log(Engine, Module, Initial, Log) :-
    fresh(Module, Initial, Agent),
    journey(0, Engine, Module, Agent, [main], Log).

fresh(Program, Clauses, Agent) :-
    gensym('random agent ', Agent),
    set_module(Agent:class(temporary)),
    set_module(Agent:base(Program)),
    dynamic([Agent:t_/1, Agent:f/1, Agent:r/1]),
    forall(member(C, Clauses), assertz(Agent:C)).

%   The machine alone is given the module reference_machine for the program's.

journey(Stops, Engine, Module, Agent, Goals, Log) :-
    engine_now(Engine, Stops, Module, Name),
    nb_setval(random_program, Module),
    ran(Name, Agent, Goals, Outcome),
    state(Agent, State),
    '$destroy_module'(Agent),
    (   Outcome = effect(Control, Hole, Left0),
        Stops < 25
    ->  plain_goals(Left0, Goals1),
        Log = [stop(Control, Hole, Goals1, State)|Log1],
        ( keeps_frames(Engine) -> Left = Left0 ; Left = Goals1 ),
        answer(Control, Answer),
        copy_term(Hole-Left-State, Answer-Left1-State1),
        fresh(Module, State1, Next),
        Stops1 is Stops+1,
        journey(Stops1, Engine, Module, Next, Left1, Log1)
    ;   end(Outcome, Goals, End),
        Log = [end(End, State)]
    ).

%   engine_now(+Engine, +Stops, +Module, -Name): after so many stops.

engine_now(machine, _, _, reference) :-
    !.
engine_now(Engine, Stops, _, reference) :-
    memberchk(Engine, [mixed, mixed_frames]),
    Stops mod 2 =:= 1,
    !.
engine_now(_, _, Module, Module).

keeps_frames(frames).
keeps_frames(mixed_frames).

ran(reference, Agent, Goals, Outcome) :-
    limited(context(reference_machine, Agent), Goals, Outcome).
ran(Module, Agent, Goals, Outcome) :-
    Module \== reference,
    limited(context(Module, Agent), Goals, Outcome).

limited(Context, Goals, Outcome) :-
    call_with_inference_limit(machine_run(Context, Goals, Outcome0), 3000000,
                              Within),
    !,
    ( Within == inference_limit_exceeded -> Outcome = endless
    ; Outcome = Outcome0
    ).

end(Outcome, Goals, fault(Formal, Goal, Left, Raising)) :-
    (   Outcome == failed
    ->  Formal = failed
    ;   Outcome = raised(Error),
        formal(Error, Formal)
    ),
    !,
    fault(Outcome, Goals, fault(Goal, Left, natives(Raising0, _))),
    (   Raising0 == Goal
    ->  Raising = itself
    ;   copy_term(Raising0, Raising)
    ).
end(effect(Control, Hole, Left0), _, effect(Control, Hole, Left)) :-
    !,
    plain_goals(Left0, Left).
end(Outcome, _, Outcome).

formal(error(existence_error(procedure, _:PI), _), unknown(PI)) :- !.
formal(error(Formal, _), Formal) :- !.
formal(Ball, Ball).

answer(move(refused), '$at'(move(refused), throw(error(refused, _)))) :- !.
answer(receive(_, _), '$at'(receive(_, 0), fail)) :- !.
answer(_, true).

state(Agent, Clauses) :-
    findall((Head:-Body),
            ( member(Head, [t_(_), f(_), r(_)]),
              clause(Agent:Head, Body)
            ),
            Clauses).

reference_machine:'$mobile'(Goal, Program:Clause, More, Goals, Barrier, Guard) :-
    nb_getval(random_program, Program),
    Program:'$mobile'(Goal, Clause, More, Goals, Barrier, Guard).
