:- module(test_machine, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(random)).
:- use_module('../../../lib/random_programs', [program_installed/3]).
:- use_module(library(typhon/kernel/program), [code_clear/0, machine_run/3]).
:- use_module(library(typhon/kernel/base/text), [term_text/2, text_term/2]).

/** <module> Tests of typhon_machine: agents stop and continue anywhere

An agent is run here without a host: at every control predicate its goals
and its state go through the text form of the wire and are put into a new
module, as on another host.
*/

                /*******************************
                *            HARNESS           *
                *******************************/

%   travel(+Terms, +Reply, -Outcome, -Trace, -Stops): run main/0 of the
%   program; Reply(Control, HoleGoal) answers each control predicate.
%   t(X) in a program adds X to the trace.

travel(Terms, Reply, Outcome, Trace, Stops) :-
    program_installed([(:- agent(test, [state([t_/1,n/1,rule/1])]))|Terms],
                      Module, Initial),
    fresh(Module, Initial, Agent),
    journey(Agent, Module, [main], Reply, 0, Stops, Outcome, Final),
    findall(X, Final:t_(X), Trace),
    '$destroy_module'(Final).

fresh(Program, Clauses, Agent) :-
    gensym('test agent ', Agent),
    set_module(Agent:class(temporary)),
    set_module(Agent:base(Program)),
    add_import_module(Agent, user, end),
    dynamic([Agent:t_/1, Agent:n/1, Agent:rule/1]),
    forall(member(C, Clauses), assertz(Agent:C)).

journey(Agent, Program, Goals, Reply, N, Stops, Outcome, Final) :-
    machine_run(context(Program, Agent), Goals, Outcome0),
    (   Outcome0 = effect(Control, Hole, Goals1)
    ->  call(Reply, Control, Hole),
        findall(C, state(Agent, C), Clauses),
        round_trip(Goals1-Clauses, Goals2-Clauses2),
        '$destroy_module'(Agent),
        fresh(Program, Clauses2, Next),
        N1 is N+1,
        journey(Next, Program, Goals2, Reply, N1, Stops, Outcome, Final)
    ;   Outcome = Outcome0,
        Final = Agent,
        Stops = N
    ).

state(Agent, (Head:-Body)) :-
    member(Head, [t_(_), n(_), rule(_)]),
    clause(Agent:Head, Body).

round_trip(Term, Copy) :-
    term_text(Term, Text),
    text_term(Text, Copy).

go(_, true).

refuse(move(bad), Hole) :- !, Hole = throw(error(refused, _)).
refuse(receive(_, _), Hole) :- !, Hole = fail.
refuse(_, true).

trace_program(Terms0, [(t(X) :- assertz(t_(X)))|Terms0]).

run(Terms0, Reply, Outcome, Trace) :-
    trace_program(Terms0, Terms),
    travel(Terms, test_machine:Reply, Outcome, Trace, _).

%   runs(-Behaviour, -Clauses, -Outcome, -Trace): each move succeeds.

runs(conjunction, [(main :- t(1), move(a), t(2), move(b), t(3))],
     done, [1,2,3]).
runs(binding_made_before_a_move, [(main :- X = 7, move(a), t(X))], done, [7]).
runs(disjunction_keeps_the_branch_it_is_in,
     [(main :- ( t(1), move(a), t(2) ; t(3) ))], done, [1,2]).
runs(disjunction_second, [(main :- ( fail ; t(3) ), move(a), t(4))],
     done, [3,4]).
runs(a_move_commits, [(main :- member(X, [1,2]), t(X), move(a), X > 1)],
     failed, [1]).
runs(a_move_commits_to_the_clause,
     [(main :- t(1), move(a), fail), (main :- t(2))], failed, [1]).
runs(condition_then, [(main :- ( t(1), move(a), t(2) -> t(3) ; t(4) ))],
     done, [1,2,3]).
runs(condition_else, [(main :- ( t(1), move(a), fail -> t(3) ; t(4) ))],
     done, [1,4]).
runs(condition_is_cut_after_a_move,
     [(main :- ( move(a), member(X, [1,2]) -> t(X), X > 1 ; t(9) ))],
     failed, [1]).
runs(soft_cut, [(main :- ( member(X, [1,2,3]) *-> t(X), X > 2, move(a)
                         ; t(9) ))], done, [1,2,3]).
runs(soft_cut_after_a_move,
     [(main :- ( move(a), member(X, [1,2,3]) *-> t(X), X > 2 ; t(9) ))],
     done, [1,2,3]).
runs(soft_cut_else, [(main :- ( move(a), fail *-> t(1) ; t(9) ))],
     done, [9]).
runs(soft_cut_and_a_cut_in_the_second_solution,
     [ (main :- ( ( true ; !, t(2), fail ; t(3) ), m(1) *-> fail ; t(4) )),
       (m(X) :- ( X == 2 -> move(a) ; true )) ], failed, [2]).
runs(own_predicate_named_like_a_library_predicate,
     [ (main :- assertz((rule(X) :- t(1), move(X))), go(a), t(2)),
       (go(X) :- append(X, _, _)), (append(X, _, _) :- rule(X)) ],
     done, [1,2]).
runs(if_without_else_fails, [(main :- ( move(a), fail -> t(1) ))],
     failed, []).
runs(negation, [(main :- \+ fail, t(1), move(a), \+ member(x, [y]), t(2))],
     done, [1,2]).
runs(cut_before, [(main :- p, t(2)), (p :- t(1), !, move(a)), (p :- t(9))],
     done, [1,2]).
runs(cut_after,
     [ (main :- p, fail), (p :- move(a), member(_, [x,y]), t(1), !, t(1)),
       (p :- t(9)) ], failed, [1,1]).
runs(cut_is_local_to_its_clause,
     [ (main :- move(a), member(X, [1,2]), p(X), X > 1),
       (p(X) :- t(X), member(_, [x,y]), !, t(X)) ], done, [1,1,2,2]).
runs(cut_in_a_condition_is_local,
     [(main :- member(X, [1,2]), ( ! , move(a) -> t(X) ; true ), t(2))],
     done, [1,2]).
runs(call, [(main :- G = (t(1), move(a), t(2)), call(G))], done, [1,2]).
runs(call_with_many,
     [ (main :- call(sum, 1, 2, 3, 4, 5, 6, 7, 8, 9)),
       (sum(A, B, C, D, E, F, G, H, I) :- move(a), X is A+B+C+D+E+F+G+H+I,
                                          t(X)) ], done, [45]).
runs(call_n, [ (main :- twice(go(5), 6)), (twice(G, X) :- call(G, X)),
               (go(X, Y) :- t(X), move(a), t(Y)) ], done, [5,6]).
runs(call_is_opaque_to_cut,
     [(main :- member(X, [1,2]), call((t(X), !)), X > 1, move(a))],
     done, [1,2]).
runs(once_and_ignore,
     [(main :- once((member(X, [1,2]), move(a), t(X))),
               ignore((move(b), fail)), t(2))], done, [1,2]).
runs(catch_around_a_move,
     [(main :- catch((t(1), move(a), throw(oops)), E, t(caught(E))), t(3))],
     done, [1,caught(oops),3]).
runs(catch_ends_with_its_goal,
     [(main :- catch(move(a), _, t(caught)), throw(late))], raised(late), []).
runs(catch_nested,
     [(main :- catch(( catch((move(x), throw(b)), b, t(inner(b))),
                       move(y), throw(c) ), E, t(outer(E))))],
     done, [inner(b),outer(c)]).
runs(catch_undoes_bindings,
     [(main :- move(a), catch((X = 1, throw(e)), e, true),
               ( var(X) -> t(unbound) ; t(X) ))], done, [unbound]).
runs(recovery_may_move, [(main :- catch(throw(x), x, (t(1), move(a), t(2))))],
     done, [1,2]).
runs(failure, [(main :- move(a), fail)], failed, []).
runs(exception, [(main :- move(a), throw(boom))], raised(boom), []).
runs(unknown_procedure, [(main :- move(a), nowhere_to_be_found)],
     raised(error(existence_error(procedure, _), _)), []).
runs(call_of_an_unbound_goal, [(main :- move(a), call(_))],
     raised(error(instantiation_error, _)), []).
runs(rules_in_the_state_may_move,
     [(main :- rule(1)), (rule(X) :- t(X), move(a), Y is X+1, t(Y))],
     done, [1,2]).
runs(rules_asserted_later_may_move,
     [ (main :- assertz((rule(X) :- t(X), move(a), t(2))), helper),
       (helper :- rule(1), t(2)) ], done, [1,2,2]).
runs(cut_in_a_state_rule,
     [(main :- rule(_), move(a)), (rule(_) :- t(1), !), (rule(_) :- t(2))],
     done, [1]).
runs(control_where_prolog_cannot_stop,
     [(main :- move(b), G = move(a), \+ call(G))],
     raised(error(permission_error(call, control_predicate, move/1), _)), []).

:- begin_tests(machine, [cleanup(code_clear)]).

test(runs, [ forall(runs(_, Clauses, Outcome, Trace)),
             true(subsumes_term(Outcome-Trace, O-T)) ]) :-
    run(Clauses, go, O, T).
test(error_of_the_move_itself, T == [refused,2]) :-
    run([(main :- catch(move(bad), error(refused, _), t(refused)), t(2))],
         refuse, _, T).
test(a_timeout_is_a_failure_in_a_condition, T == [late]) :-
    run([(main :- ( receive(_, 1) -> t(got) ; t(late) ))], refuse, _, T).
test(goals_are_source_goals,
     Goals =@= [(_->writeln(x);true), (a, ! ; b), !, main]) :-
    program_installed([ (:- agent(g)),
                        (main :- ( sleep(1) -> writeln(x) ; true ),
                                 ( a, ! ; b ), !, main) ], M, _),
    machine_run(context(M, M), [main], effect(sleep(1), _, Goals)).
test(tail_recursion_uses_constant_space, O-N-L == done-100000-2) :-
    program_installed([ (:- agent(g, [state([n/1])])),
                        (main :- n(0), !),
                        (main :- retract(n(N)), N1 is N-1, assertz(n(N1)),
                                 move(there), main),
                        n(100000) ], M, Initial),
    fresh(M, Initial, A),
    hops(M, A, [main], 0, N, 0, L, O).

hops(M, A, Goals0, N0, N, L0, L, O) :-
    machine_run(context(M, A), Goals0, O0),
    (   O0 = effect(move(there), true, Goals)
    ->  length(Goals, L1),
        L2 is max(L0, L1),
        N1 is N0+1,
        hops(M, A, Goals, N1, N, L2, L, O)
    ;   N = N0, L = L0, O = O0
    ).

:- end_tests(machine).

                /*******************************
                *      RANDOM PROGRAMS         *
                *******************************/

/*  A random program gives the same results natively, where hop/0 is true, and
with hops at every hop/0. A hop removes choice points to its left, so a
program must not depend on those.  Goals of kind `sure` succeed; `test`, which
may fail after side effects and hops, stand in conditions only. */

random_program(Clauses) :-
    findall(C, ( member(P, [p,q,r]), random_clause(P, C) ), Clauses0),
    Clauses = [(main :- p(3), hop, t(end))|Clauses0].

random_clause(P, (Head :- N =< 0, !, t(P))) :-
    Head =.. [P,N].
random_clause(P, (Head :- N1 is N-1, Body)) :-
    Head =.. [P,N],
    body(sure, 3, N1, Body).

body(Kind, 0, N, Goal) :-
    !,
    leaf(Kind, N, Goal).
body(Kind, D0, N, Goal) :-
    D is D0-1,
    random_member(Shape, [conj,conj,conj,ite,ite,soft,disj,call,catch,
                          once,throw,cut,leaf]),
    shape(Shape, Kind, D, N, Goal).

shape(conj, Kind, D, N, (A, hop, B)) :-
    body(sure, D, N, A), body(Kind, D, N, B).
shape(ite, Kind, D, N, (A -> B ; C)) :-
    body(test, D, N, A), body(Kind, D, N, B), body(Kind, D, N, C).
shape(soft, Kind, D, N, (A *-> B ; C)) :-
    body(test, D, N, A), body(Kind, D, N, B), body(Kind, D, N, C).
shape(disj, Kind, D, N, (fail, hop ; A)) :-
    body(Kind, D, N, A).
shape(call, Kind, D, N, call(A)) :-
    body(Kind, D, N, A).
shape(catch, Kind, D, N, catch(A, ball, B)) :-
    body(Kind, D, N, A), body(Kind, D, N, B).
shape(throw, Kind, D, N, catch((A, hop, throw(ball), t(no)), ball, B)) :-
    body(sure, D, N, A), body(Kind, D, N, B).
shape(once, Kind, D, N, once(A)) :-
    body(Kind, D, N, A).
shape(cut, Kind, D, N, (A, !, B)) :-
    body(sure, D, N, A), body(Kind, D, N, B).
shape(leaf, Kind, _, N, Goal) :-
    leaf(Kind, N, Goal).

leaf(sure, N, Goal) :-
    random_between(1, 99, X),
    random_member(Goal, [ t(X), (t(X), hop), (hop, t(X)), (hop, p(N)),
                          q(N), call(r, N), (\+ fail, t(X)),
                          (\+ \+ member(X, [X]), hop) ]).
leaf(test, N, Goal) :-
    random_between(1, 99, X),
    random_member(Goal, [ (t(X), hop, fail), (hop, t(X)), fail,
                          (memberchk(Y, [X,0]), hop, t(Y)), (t(X), q(N)) ]).

native_trace(Clauses0, Outcome, Trace) :-
    gensym('test native ', M),
    set_module(M:class(temporary)),
    dynamic(M:t_/1),
    Clauses = [hop, (t(X) :- assertz(t_(X)))|Clauses0],
    forall(member(C, Clauses), assertz(M:C)),
    catch(( call_with_inference_limit(M:main, 200000, R)
          ->  ( R == inference_limit_exceeded -> Outcome = long
              ; Outcome = done )
          ;   Outcome = failed ), Ball, Outcome = raised(Ball)),
    findall(X1, M:t_(X1), Trace),
    '$destroy_module'(M).

hopping_trace(Clauses0, Outcome, Trace, Stops) :-
    maplist(hop_to_move, Clauses0, Clauses1),
    trace_program(Clauses1, Clauses),
    travel(Clauses, test_machine:go, Outcome, Trace, Stops).

hop_to_move(Term0, Term) :-
    (   Term0 == hop
    ->  Term = move(somewhere)
    ;   compound(Term0)
    ->  mapargs_hop(Term0, Term)
    ;   Term = Term0
    ).

mapargs_hop(Term0, Term) :-
    Term0 =.. [F|Args0],
    maplist(hop_to_move, Args0, Args),
    Term =.. [F|Args].

:- begin_tests(random_programs, [cleanup(code_clear)]).

test(hops_do_not_change_the_results, Bad-Many == none-true) :-
    set_random(seed(20)),
    compare(300, 0, Hops, Bad),
    ( Hops > 3000 -> Many = true ; Many = Hops ).

compare(0, Hops, Hops, none) :-
    !.
compare(N, Hops0, Hops, Bad) :-
    random_program(Program),
    native_trace(Program, Outcome1, Trace1),
    (   Outcome1 == long
    ->  compare(N, Hops0, Hops, Bad)
    ;   hopping_trace(Program, Outcome2, Trace2, Stops),
        (   Outcome1-Trace1 == Outcome2-Trace2
        ->  Hops1 is Hops0+Stops,
            N1 is N-1,
            compare(N1, Hops1, Hops, Bad)
        ;   Bad = Program-Outcome1-Trace1-Outcome2-Trace2,
            Hops = Hops0
        )
    ).

:- end_tests(random_programs).
