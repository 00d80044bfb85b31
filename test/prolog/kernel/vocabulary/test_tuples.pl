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

%   leaves(-Before, -New, -Left): whether New is left after Before, and the
%   tuples p(X) then.

leaves(true, p(1), true-[1]).
leaves(leave(p(1)), p(1), false-[1]).
leaves(leave(p(1)), p(_), false-[1]).
leaves(leave(p(a)), p(1), true-[a,1]).
leaves(( leave_new(p(1)), take(p(1)) ), p(2), true-[2]).
leaves(leave(q(1)), p(1), true-[1]).
leaves(leave(p(1, 2)), p(1), true-[1]).

test(tuple_is_left_where_none_unifies,
     [forall(leaves(Before, New, Expected)), Left-Xs == Expected]) :-
    with_hosts([alpha],
               ( remote(alpha, Before),
                 ( remote(alpha, leave_new(New)) -> Left = true
                 ; Left = false ),
                 remote(alpha, findall(X, sense(p(X)), Xs)) )).
test(existing_tuple_is_not_bound, true(( Xs = [X], var(X) ))) :-
    with_hosts([alpha],
               ( remote(alpha, leave(p(_))),
                 \+ remote(alpha, leave_new(p(1))),
                 remote(alpha, findall(X0, sense(p(X0)), Xs)) )).
test(no_tuple, [ forall(member(Tuple-Error,
                               [ p(user_output)-mobile_term, 3-callable ])),
                 error(type_error(Error, _)) ]) :-
    ( Tuple = p(Alias) -> stream_property(S, alias(Alias)), New = p(S)
    ; New = Tuple ),
    with_hosts([alpha], remote(alpha, leave_new(New))).

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
