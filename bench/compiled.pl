:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program),
              [ code_install/3, code_module/2, machine_run/3, program_load/6 ]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(lists), [member/2, memberchk/2, numlist/3]).

/*  The cost of agents between their stops: compiled programs compared with
    plain Prolog (a stop is a call of a fact) and with the interpreter, which
    runs stepped and guarded agents.  Microseconds of processor time from stop
    to stop.

    swipl bench/compiled.pl -- 4000 */

:- initialization(main, main).

main([Argument]) :-
    atom_number(Argument, Count),
    forall(program(Name, Clauses, Share),
           ( Stops is max(10, Count//Share),
             compared(Name, Clauses, Stops) )).

%   program(-Name, -Clauses, -Share): its stops take Share times as long.

program('a learner of some hundred goals', Clauses, 1) :-
    Clauses =
    [ (:- agent(bench, [state([threshold/1,last/1,seen/2])])),
      threshold(3), last(none), seen(0, 0),
      (main :- tour(0)),
      (tour(N) :-
           visit(10, N, S),
           keep(last(S)),
           ( S mod 2 =:= 0 -> X = even ; X = odd ),
           seen(A, _),
           keep(seen(A, X)),
           N1 is (N+1) mod 1000,
           move(b),
           tour(N1)),
      (visit(0, S, S) :- !),
      (visit(K, S0, S) :-
           threshold(T),
           S1 is S0+K*T,
           ( S1 > 100 -> S2 is S1 mod 97 ; S2 = S1 ),
           rare(S2),
           K1 is K-1,
           visit(K1, S2, S)),
      (rare(S) :- S < 0, !, receive(_)),
      rare(_),
      (keep(F) :- functor(F, N, A), functor(G, N, A), retractall(G), assertz(F))
    ].
program('60 native goals before a stop', Clauses, 1) :-
    native_goals(Goals),
    Clauses = [(:- agent(bench, [])), (main :- Goals, move(b), main)].
program('60 native goals after a stop', Clauses, 1) :-
    native_goals(Goals),
    Clauses = [(:- agent(bench, [])), (main :- move(b), Goals, main)].
program('fib(18) in a predicate that can stop', Clauses, 200) :-
    Clauses =
    [ (:- agent(bench, [])),
      (main :- fib(18, _), move(b), main),
      (fib(N, F) :- N < 2, !, F = N),
      (fib(N, F) :- A is N-1, B is N-2, fib(A, X), fib(B, Y), F is X+Y),
      (fib(stop(X), _) :- move(X)) ].
program('nrev of 30 elements in predicates that can stop', Clauses, 40) :-
    numlist(1, 30, List),
    Clauses =
    [ (:- agent(bench, [])),
      (main :- nrev(List, _), move(b), main),
      nrev([], []),
      (nrev([X|Xs], Ys) :- nrev(Xs, Zs), app(Zs, [X], Ys)),
      (nrev(stop(X), _) :- move(X)),
      app([], Ys, Ys),
      (app([X|Xs], Ys, [X|Zs]) :- app(Xs, Ys, Zs)),
      (app(stop(X), _, _) :- move(X)) ].
program('a stop and nothing else', Clauses, 1) :-
    Clauses = [(:- agent(bench, [])), (main :- move(a), move(b), main)].

native_goals(Goals) :-
    numlist(1, 30, Numbers),
    goals(Numbers, Goals).

goals([], true).
goals([N|Ns], (X = f(N), functor(X, _, _), Goals)) :-
    goals(Ns, Goals).

compared(Name, Clauses, Stops) :-
    plain(Clauses, Plain),
    program_load(clauses(Clauses), Program, Facts, Hash, Kinds, _),
    code_install(Hash, Program, Kinds),
    code_module(Hash, Module),
    Program = program(_, State, _, _),
    nb_setval(bench_program, Module),
    module_property(Module, size(Size0)),
    least(plain_stops(Plain, Stops), Stops, P, _),
    agent(Module, State, Facts, Agent1),
    least(stops(bench_machine, Agent1, Stops), Stops, M, MI),
    agent(Module, State, Facts, Agent2),
    least(stops(Module, Agent2, Stops), Stops, C, CI),
    module_property(Module, size(Size)),
    report(Name, 'us', C, us),
    report(Name, inferences, CI, inferences),
    report(Name, 'the machine alone, inferences', MI, inferences),
    atomic_list_concat([Name,', against plain Prolog'], PlainName),
    ratio(PlainName, C, P, us, 'plain'),
    atomic_list_concat([Name,', the machine alone'], MachineName),
    ratio(MachineName, C, M, us, 'the machine'),
    atomic_list_concat([Name,', memory of the program'], SizeName),
    ratio(SizeName, Size, Size0, bytes, 'before it ran').

report(Name, What, Value, Unit) :-
    atomic_list_concat([Name,', ',What], Full),
    figure(Full, Value, Unit).

agent(Module, State, Facts, Agent) :-
    gensym('bench agent ', Agent),
    set_module(Agent:class(temporary)),
    set_module(Agent:base(Module)),
    forall(member(PI, State), dynamic(Agent:PI)),
    forall(member(Fact, Facts), assertz(Agent:Fact)).

stops(Module, Agent, Stops) :-
    stops(Stops, Module, Agent, [main]).

stops(0, _, _, _) :-
    !.
stops(N, Module, Agent, Goals) :-
    machine_run(context(Module, Agent), Goals, effect(_, true, Left)),
    N1 is N-1,
    stops(N1, Module, Agent, Left).

%   The table of the machine, without chunks.

bench_machine:'$mobile'(Goal, Program:Clause, More, Goals, Barrier, Guard) :-
    nb_getval(bench_program, Program),
    Program:'$mobile'(Goal, Clause, More, Goals, Barrier, Guard).

plain(Clauses, Module) :-
    gensym('bench plain ', Module),
    memberchk((:- agent(_, Options)), Clauses),
    ( memberchk(state(State), Options) -> true ; State = [] ),
    findall(Clause,
            ( member(Clause, Clauses), Clause \= (:- _) ),
            Own),
    findall(Name/Arity,
            ( member(Clause, Own),
              ( Clause = (Head:-_) -> true ; Head = Clause ),
              functor(Head, Name, Arity)
            ),
            PIs0),
    sort(PIs0, PIs),
    forall(member(PI, PIs), dynamic(Module:PI)),
    forall(member(Clause, Own), assertz(Module:Clause)),
    assertz(Module:(move(_) :- bench_stop)),
    assertz(Module:receive(_)),
    findall(Module:PI, ( member(PI, PIs), \+ memberchk(PI, State) ), Static),
    compile_predicates(Static).

:- public bench_stop/0.

bench_stop :-
    nb_getval(bench_stops, N),
    (   N =< 1
    ->  throw(bench_over)
    ;   N1 is N-1,
        nb_setval(bench_stops, N1)
    ).

plain_stops(Module, Stops) :-
    nb_setval(bench_stops, Stops),
    catch(Module:main, bench_over, true).

%   least(:Goal, +Stops, -Micros, -Inferences): least values of five runs, for
%   each stop.

:- meta_predicate least(0, +, -, -).

least(Goal, Stops, Micros, Inferences) :-
    \+ \+ call(Goal),
    findall(M-I,
            ( between(1, 5, _), garbage_collect, measured(Goal, M, I) ),
            Runs),
    sort(Runs, [M-I|_]),
    Micros is M/Stops,
    Inferences is I/Stops.

measured(Goal, Micros, Inferences) :-
    statistics(inferences, I0),
    statistics(process_cputime, T0),
    \+ \+ call(Goal),
    statistics(process_cputime, T1),
    statistics(inferences, I1),
    Micros is (T1-T0)*1.0e6,
    Inferences is I1-I0.
