:- module(test_state_log, []).

:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(random), [random_member/2, random_between/3]).
:- use_module(library(typhon/options/journal/state_log)).
:- use_module(library(typhon/kernel/agent), [agent_state/2]).
:- use_module(library(typhon), []).

:- begin_tests(state_log).

%   A state after some rounds of changes equals the replay of its log, clauses
%   in their order, whatever changed it.

test(replay_restores_the_state,
     [ forall(between(1, 60, Seed)), Latest == Now ]) :-
    set_random(seed(Seed)),
    in_module(Module,
              ( seeded(Module),
                agent_state(Module, First),
                state_log_begin(Module),
                rounds(8, Module, All),
                agent_state(Module, Now0) )),
    state_replayed(First, All, Latest0),
    sorted(Now0, Now),
    sorted(Latest0, Latest).

test(unchanged_state_has_no_changes, Changes == []) :-
    in_module(Module,
              ( seeded(Module),
                state_log_begin(Module),
                assertz(Module:p(new), Ref),
                erase(Ref),
                state_log_changes(Module, Changes) )).

test(change_of_one_clause_logs_one_clause,
     Changes == [edit([0-p(500)], [], [p(new)])]) :-
    in_module(Module,
              ( forall(between(1, 1000, I), assertz(Module:p(I))),
                state_log_begin(Module),
                retract(Module:p(500)),
                assertz(Module:p(new)),
                state_log_changes(Module, Changes) )).

%   The abolished predicate has as many clauses as before, and no change was
%   reported.

test(redefined_predicate_is_set_as_a_whole,
     Changes == [set(p/1, [p(c), p(d)])]) :-
    in_module(Module,
              ( assertz(Module:p(a)),
                assertz(Module:p(b)),
                state_log_begin(Module),
                abolish(Module:p/1),
                assertz(Module:p(c)),
                assertz(Module:p(d)),
                state_log_changes(Module, Changes) )).

test(changes_by_other_threads_are_seen,
     Changes == [edit([], [], [p(101)])]) :-
    in_module(Module,
              ( forall(between(1, 100, I), assertz(Module:p(I))),
                state_log_begin(Module),
                thread_create(assertz(Module:p(101)), Thread),
                thread_join(Thread),
                state_log_changes(Module, Changes) )).

test(thread_local_predicate_is_harmless) :-
    forall(between(1, 200, _),
           in_module(Module,
                     ( thread_local(Module:p/1),
                       state_log_begin(Module),
                       assertz(Module:p(1)),
                       state_log_changes(Module, _),
                       retract(Module:p(1)),
                       state_log_changes(Module, _) ))),
    garbage_collect_clauses.

test(module_without_a_log, fail) :-
    state_log_changes(no_such_module, _).

test(changes_of_another_state_are_not_replayed,
     error(existence_error(clause, p(1)))) :-
    state_replayed(state([], [p(2)]), [[edit([0-p(1)], [], [])]], _).

:- meta_predicate in_module(-, 0).

in_module(Module, Goal) :-
    gensym(test_state_log_, Module),
    setup_call_cleanup(
        set_module(Module:class(temporary)),
        once(Goal),
        ( state_log_end(Module), '$destroy_module'(Module) )).

%   The order of predicates does not matter, that of clauses does.

sorted(state(Empty0, Clauses0), state(Empty, Clauses)) :-
    sort(Empty0, Empty),
    findall(Key-(N-Clause),
            ( nth1(N, Clauses0, Clause), key(Clause, Key) ), Pairs0),
    keysort(Pairs0, Pairs),
    findall(Clause, ( member(_-(_-Clause0), Pairs),
                      copy_term(Clause0, Clause),
                      numbervars(Clause, 0, _) ),
            Clauses).

key((Head:-_), Name/Arity) :-
    !,
    functor(Head, Name, Arity).
key(Head, Name/Arity) :-
    functor(Head, Name, Arity).

seeded(Module) :-
    forall(between(1, 40, _), ( random_clause(C), add(assertz, C, Module) )).

rounds(0, _, []) :-
    !.
rounds(N, Module, [Changes|All]) :-
    random_between(0, 25, Steps),
    forall(between(1, Steps, _), step(Module)),
    state_log_changes(Module, Changes),
    N1 is N-1,
    rounds(N1, Module, All).

step(Module) :-
    random_between(1, 100, Dice),
    ignore(step(Dice, Module)).

step(Dice, Module), Dice =< 35 =>
    random_clause(Clause),
    add(assertz, Clause, Module).
step(Dice, Module), Dice =< 45 =>
    random_clause(Clause),
    add(asserta, Clause, Module).
step(Dice, Module), Dice =< 65 =>
    random_ref(Module, Ref),
    erase(Ref).
step(Dice, Module), Dice =< 78 =>
    random_clause(Clause),
    without(Module, Clause).
step(Dice, Module), Dice =< 84 =>
    random_clause(Clause0),
    head(Clause0, Head),
    retractall(Module:Head).
step(Dice, Module), Dice =< 86 =>
    random_member(PI, [p/1, q/2, counter/1, r/0, other/3]),
    abolish(Module:PI).
step(Dice, Module), Dice =< 88 =>
    random_member(PI, [p/1, q/2, counter/1, other/3, new/1]),
    dynamic(Module:PI).
step(Dice, Module), Dice =< 91 =>
    random_clause(Clause),
    catch(snapshot(add(assertz, Clause, Module)), _, true).
step(Dice, Module), Dice =< 94 =>
    random_clause(Clause),
    transaction(( add(assertz, Clause, Module), without(Module, Clause) )).
step(Dice, Module), Dice =< 96 =>
    random_clause(Clause),
    ignore(transaction(( add(asserta, Clause, Module),
                         without(Module, Clause),
                         fail ))).
step(_, Module) =>
    forall(between(1, 5, _),
           ( retract(Module:counter(N0)), N is N0+1,
             asserta(Module:counter(N)) )).

without(Module, (Head:-Body)) :-
    !,
    retract(Module:(Head:-Body)).
without(Module, Head) :-
    retract(Module:Head).

add(How, Clause, Module) :-
    call(How, Module:Clause).

head((Head:-_), Head) :- !.
head(Head, Head).

random_ref(Module, Ref) :-
    findall(Ref,
            ( member(Head, [p(_), q(_,_), counter(_), r, other(_,_,_)]),
              predicate_property(Module:Head, dynamic),
              clause(Module:Head, _, Ref) ),
            Refs),
    random_member(Ref, Refs).

%   Few values are used, so that many clauses are alike.

random_clause(Clause) :-
    random_value(X),
    random_value(Y),
    random_member(Clause,
                  [ p(X), p(X), p(Y), p(X), q(X,Y), q(Y,_), p(_), counter(1),
                    r, other(X,Y,X), (p(X) :- q(X,_), \+ r),
                    (p(Z) :- Z == X), (q(Z,Y) :- p(Z)), (r :- p(X) ; r) ]).

random_value(Value) :-
    random_member(Value, [a, b, 1, 2.5, "text", f(_), f(a), [1,2], [], 'A b']).

:- end_tests(state_log).
