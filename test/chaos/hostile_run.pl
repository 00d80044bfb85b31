:- module(hostile_run,
          [ hostile/2                   % +Options, -Faults
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(random),
              [random_between/3, random_member/2]).
:- use_module(library(typhon)).

/** <module> Hostile agents at random

Every predicate of the system, of libraries that are loaded and of the
platform itself is mixed into programs, with arguments that may do harm,
written out or constructed at run time.  They run on a guarded host. Another
agent runs on an unguarded host of the process; from time to time the test
checks that it still answers, and that the state of the process is unchanged.

*Threading*: the thread that calls hostile/2.
*/

:- dynamic
    pool/1,                     % Predicates: a term of Module:PI
    let_in/1.                   % Count: agents that ran

%!  hostile(+Options, -Faults:list) is det.
%
%   Options: count(N), agents; seed(I), of the first; the others have the
%   numbers that follow.  progress(true) prints how far it is.  cell(Kind) is
%   that option of their host.

hostile(Options, Faults) :-
    option(count(Count), Options, 500),
    option(seed(Seed), Options, 1),
    option(progress(Progress), Options, false),
    option(cell(Cell), Options, none),
    fill_pool,
    retractall(let_in(_)),
    assertz(let_in(0)),
    quotas(Quotas),
    setup_call_cleanup(
        ( host_start(home),
          host_start(hostile, [ policy(guarded), cell(Cell),
                                quota(Quotas) ]) ),
        ( Last is Seed+Count-1,
          bystander(Canary),
          world(Before),
          batches(Seed, Last, Canary-Before, Progress, Faults) ),
        ( host_stop(hostile), host_stop(home) )).

quotas([ seconds(0.3), stack(32 000 000), state(500 000), clones(5),
         messages(50), log(5), facts(50), tuples(1000) ]).

fill_pool :-
    findall(Name/Arity,
            ( member(Module, [system, user, typhon, typhon_vocabulary]),
              predicate_property(Module:Head, defined),
              functor(Head, Name, Arity)
            ; current_module(Module),
              module_property(Module, exports(PIs)),
              member(Name/Arity, PIs)
            ),
            All),
    sort(All, Sorted),
    Pool =.. [pool|Sorted],
    retractall(pool(_)),
    assertz(pool(Pool)).

bystander(Canary) :-
    agent_create(clauses([ (:- agent(bystander, [state([secret/1])])),
                           secret(42),
                           (on_message(From, ask(N)) :-
                                secret(S), send(From, answer(N, S))) ]),
                 Canary, [host(home)]).

%   world(-World): the state that must not change.

world(world(Ops, Flags, Files, Users)) :-
    aggregate_all(count, current_op(_, _, _), Ops),
    findall(F-V, ( member(F, [ double_quotes, occurs_check, unknown,
                               stack_limit, autoload, debug, gc ]),
                   current_prolog_flag(F, V) ), Flags),
    working_directory(Files, Files),
    aggregate_all(count, ( predicate_property(user:H, dynamic),
                           \+ predicate_property(user:H, imported_from(_)) ),
                  Users).

batches(From, Last, _, _, []) :-
    From > Last,
    !.
batches(From, Last, Kept, Progress, Faults) :-
    To is min(Last, From+99),
    forall(between(From, To, Seed), attack(Seed)),
    findall(fault(From-To, What), harm(From, Kept, What), Faults0),
    print_progress(Progress, To),
    Next is To+1,
    (   Faults0 == []
    ->  batches(Next, Last, Kept, Progress, Faults)
    ;   Faults = Faults0
    ).

print_progress(true, To) :-
    To mod 1000 < 100,
    !,
    statistics(process_cputime, Cpu),
    let_in(Ran),
    aggregate_all(count, thread_property(_, status(running)), Threads),
    format("~D, of which ~D ran, ~0f s, ~d threads~n",
           [To, Ran, Cpu, Threads]),
    flush_output.
print_progress(_, _).

harm(Batch, Canary-_, bystander) :-
    \+ answers(Canary, Batch).
harm(_, _-Before, changed(Before, Now)) :-
    world(Now),
    Now \== Before.
harm(_, _, threads(Count)) :-
    aggregate_all(count, thread_property(_, status(running)), Count),
    Count > 150.
harm(_, _, stream(S)) :-
    member(S, [user_input, user_output, user_error]),
    \+ is_stream(S).

%   A caller still gets the correct answer.

answers(Canary, Batch) :-
    agent_create(clauses([ (:- agent(asker, [])),
                           (main :- send(Canary, ask(Batch)),
                                    receive(_-answer(Batch, Secret), 10),
                                    result(Secret)) ]),
                 Asker, [host(home)]),
    catch(agent_result(Asker, 42, 15), error(_, _), fail).

attack(Seed) :-
    set_random(seed(Seed)),
    program(Clauses),
    catch(( agent_create(clauses(Clauses), A, [host(hostile)]),
            retract(let_in(N0)),
            N is N0+1,
            assertz(let_in(N)),
            ( agent_join(A, _, 5) -> true ; true ),
            agent_dispose(A, [force(0)]) ),
          error(_, _),
          true).

                /*******************************
                *           PROGRAMS           *
                *******************************/

program([(:- agent(hostile, [state([s/1,goal/1])])) | Clauses]) :-
    goals(Goals),
    random_member(Kind, [ written, called, called, found, mapped, ruled,
                          caught, met, lambda, after_hop ]),
    shaped(Kind, Goals, Clauses).

goals([Goal|Goals]) :-
    goal(2, Goal),
    (   random_between(1, 2, 1)
    ->  Goals = []
    ;   goals(Goals)
    ).

shaped(written, [G|Gs], [(main :- Body)]) :-
    body(Gs, G, Body).
shaped(called, Gs, [(main :- goal(G), catch(G, _, true), fail), main|Facts]) :-
    facts(Gs, Facts).
shaped(found, Gs, [(main :- goal(G), findall(x, catch(G, _, true), _), fail),
                   main|Facts]) :-
    facts(Gs, Facts).
shaped(mapped, Gs, [(main :- findall(G, goal(G), L), maplist(call, L))
                    |Facts]) :-
    facts(Gs, Facts).
shaped(ruled, Gs, [(main :- goal(G), catch(assertz((s(_) :- G)), _, true),
                            catch(s(1), _, true), fail), main|Facts]) :-
    facts(Gs, Facts).
shaped(caught, Gs, [(main :- goal(G), catch(throw(x), _, G))|Facts]) :-
    facts(Gs, Facts).
shaped(met, Gs, [(main :- goal(G), forall(G, \+ G))|Facts]) :-
    facts(Gs, Facts).
shaped(lambda, Gs, [(main :- findall(G, goal(G), L),
                             catch(maplist([X]>>X, L), _, true),
                             catch(foldl([X,Y,Y]>>call(call, X), L, a, _), _,
                                   true))|Facts]) :-
    facts(Gs, Facts).
shaped(after_hop, Gs, [(main :- findall(G, goal(G), L), clone(_), all(L)),
                       all([]), (all([G|L]) :- ignore(catch(G, _, true)),
                                               all(L))|Facts]) :-
    facts(Gs, Facts).

body([], Goal, Goal).
body([G|Gs], Goal, (catch(Goal, _, true), Body)) :-
    body(Gs, G, Body).

facts([], []).
facts([G|Gs], [goal(G)|Facts]) :-
    facts(Gs, Facts).

goal(Depth, Goal) :-
    pool(Pool),
    functor(Pool, _, Size),
    random_between(1, Size, I),
    arg(I, Pool, Name/Arity),
    random_between(1, 12, Dice),
    (   Dice =:= 1
    ->  random_member(M, [user, system, typhon_agents, typhon_place]),
        Goal = M:Goal0
    ;   Goal = Goal0
    ),
    length(Args, Arity),
    arguments(Args, Depth),
    Goal0 =.. [Name|Args].

arguments([], _).
arguments([Arg|Args], Depth) :-
    argument(Depth, Arg),
    arguments(Args, Depth).

argument(Depth, Arg) :-
    random_between(1, 10, Dice),
    (   Dice =< 2
    ->  true
    ;   Dice =< 4,
        Depth > 0
    ->  Less is Depth-1,
        goal(Less, Arg)
    ;   findall(A, harmful(A), Harmful),
        random_member(Arg, Harmful)
    ).

harmful(user). harmful(system). harmful(main). harmful(user_output).
harmful(user_input). harmful(user_error). harmful(halt). harmful(abort).
harmful(user:halt). harmful(system:halt). harmful('@'(halt, user)).
harmful([]). harmful([halt]). harmful(0). harmful(1). harmful(-1).
harmful(3000). harmful(1.0e300). harmful(N) :- N is 1<<70.
harmful("text"). harmful("halt."). harmful('~@~w~p'). harmful("~@").
harmful(f(_, _)). harmful((a :- halt)). harmful((portray(_) :- halt)).
harmful((user:portray(_) :- true)). harmful(goal_expansion(_, _)).
harmful(portray/1). harmful(halt/0). harmful([user:halt]).
harmful(library(process)). harmful('/etc/passwd'). harmful(string(_)).
harmful(atom(_)). harmful(inf). harmful(typhon_turns).
harmful('$aborted'). harmful(unwind(halt(0))). harmful(stack_limit).
harmful(double_quotes). harmful(on_error). harmful([X]>>X). harmful(X>>X).
harmful(_^halt). harmful(_^_). harmful(call(_)). harmful(call).
harmful(findall(_, halt, _)). harmful(bystander). harmful(home).
harmful('hostile'). harmful(s(1)). harmful(s). harmful(typhon_worker_0).
harmful(repeat). harmful(between(1, inf, _)). harmful((repeat, fail)).
harmful(X) :- length(L, 300), X =.. [f|L].
harmful(X) :- length(X, 500).
