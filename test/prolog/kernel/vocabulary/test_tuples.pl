:- module(test_tuples, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(typhon)).

/** <module> leave_new: a tuple is left only if none there unifies with it

*Threading*: one test at a time; the agents run in all workers.
*/

%   crowd(+Count, +Clauses, -Outcomes): so many agents of Clauses at once.

crowd(Count, Clauses, Outcomes) :-
    findall(Agent,
            ( between(1, Count, I),
              create(Clauses, Agent, [facts([s(I)])]) ),
            Agents),
    maplist(joined, Agents, Outcomes).

all_done(Outcomes) :-
    maplist(==(done), Outcomes).

:- begin_tests(leave_new).

test(tuple_is_left_where_none_unifies, Xs == [1]) :-
    with_hosts([alpha],
               ( remote(alpha, leave_new(p(1))),
                 remote(alpha, findall(X, sense(p(X)), Xs)) )).
test(fails_where_a_tuple_unifies, Xs == [1]) :-
    with_hosts([alpha],
               ( remote(alpha, leave(p(1))),
                 \+ remote(alpha, leave_new(p(1))),
                 \+ remote(alpha, leave_new(p(_))),
                 remote(alpha, findall(X, sense(p(X)), Xs)) )).
test(existing_tuple_is_not_bound) :-
    with_hosts([alpha],
               ( remote(alpha, leave(p(_))),
                 \+ remote(alpha, leave_new(p(1))),
                 remote(alpha, leave_new(q(1))),
                 remote(alpha, leave_new(p(1, 2))) )).
test(tuple_is_left_again_after_a_take, Xs == [2]) :-
    with_hosts([alpha],
               ( remote(alpha, ( leave_new(p(1)), take(p(1)),
                                 leave_new(p(2)) )),
                 remote(alpha, findall(X, sense(p(X)), Xs)) )).
test(each_host_has_its_own_tuple_space) :-
    with_hosts([alpha,beta],
               ( remote(alpha, leave_new(p)), remote(beta, leave_new(p)) )).
test(term_that_cannot_travel, error(type_error(mobile_term, _))) :-
    with_hosts([alpha],
               ( current_output(Out), remote(alpha, leave_new(p(Out))) )).
test(not_a_fact, error(type_error(callable, 3))) :-
    with_hosts([alpha], remote(alpha, leave_new(3))).

%   In any order: each key has one owner.

test(one_of_many_concurrent_calls_succeeds, Owned == Keys) :-
    numlist(1, 300, Keys),
    with_hosts([alpha],
               ( crowd(20, [ (main :- forall(between(1, 300, K), claim(K))),
                             (claim(K) :- leave_new(key(K))
                                       -> s(I), leave(owns(K, I))
                                       ;  true) ], Outcomes),
                 all_done(Outcomes),
                 remote(alpha, findall(K, sense(owns(K, _)), Owned0)) )),
    msort(Owned0, Owned).

%   A lock: the agent that has left the tuple is alone in a critical section.

test(leave_new_implements_a_lock, Count == 400) :-
    with_hosts([alpha],
               ( remote(alpha, leave(count(0))),
                 crowd(8, [ (main :- times(50)),
                            times(0),
                            (times(N) :- N > 0, lock, add,
                                         N1 is N-1, times(N1)),
                            (lock :- leave_new(lock) -> true
                                  ;  sleep(0.001), lock),
                            (add :- take(count(C0)), C is C0+1,
                                    leave(count(C)), take(lock)) ], Outcomes),
                 all_done(Outcomes),
                 remote(alpha, sense(count(Count))) )).

:- end_tests(leave_new).
