:- module(test_remote, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Tests of remote/2 on hosts of this process

Between processes: test_processes.pl.
*/

:- begin_tests(remote).

test(bindings_are_returned, true(X-Y == 3-abc)) :-
    with_hosts([alpha], remote(alpha, ( X is 1+2, atom_concat(a, bc, Y) ))).
test(failure, [fail]) :-
    with_hosts([alpha], remote(alpha, fail)).
test(remote_goal_is_called_once, true(Xs == [1])) :-
    with_hosts([alpha], findall(X, remote(alpha, member(X, [1,2])), Xs)).
test(errors, error(type_error(evaluable, foo/0))) :-
    with_hosts([alpha], remote(alpha, _ is foo)).
test(exceptions, throws(oops)) :-
    with_hosts([alpha], remote(alpha, throw(oops))).
test(by_address, true(X == 1)) :-
    with_hosts([alpha], ( address(alpha, A), remote(A, X = 1) )).
test(goal_runs_in_the_place, true(P == Place)) :-
    with_hosts([alpha],
               ( host_property(alpha, place(Place)),
                 remote(alpha, ( assertz(p(1)), context_module(P) )),
                 assertion(predicate_property(Place:p(_), dynamic)) )).
test(each_host_has_its_own_place, true(L-M == [a]-[b])) :-
    with_hosts([alpha,beta],
               ( remote(alpha, leave(a)), remote(beta, leave(b)),
                 remote(alpha, findall(X, sense(X), L)),
                 remote(beta, findall(X, sense(X), M)) )).
test(tuple_space, true(X == 2)) :-
    with_hosts([alpha],
               ( remote(alpha, leave(p(1))), remote(alpha, leave(p(2))),
                 remote(alpha, take(p(1))), remote(alpha, sense(p(X))) )).
test(vocabulary_of_a_host, true(N-L == []-0)) :-
    with_hosts([alpha], remote(alpha, ( neighbours(N), host_load(L), here(_) ))).
test(remote_goal_has_no_self, error(existence_error(running_agent, here))) :-
    with_hosts([alpha], remote(alpha, self(_))).
test(qualified_goal, true(X == c)) :-
    with_hosts([alpha], remote(alpha, lists:last([a,b,c], X))).
test(refused_remote_goal, error(permission_error(remote, host, alpha))) :-
    with_hosts([alpha-[remote(false)]], remote(alpha, true)).
test(unknown_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], remote(nowhere, true)).
test(unknown_host_of_a_process, error(existence_error(host, _))) :-
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 atom_concat(alpha, Endpoint, Alpha),
                 atom_concat(nowhere, Endpoint, Nowhere),
                 remote(Nowhere, true) )).
test(unbound_host, error(instantiation_error)) :-
    with_hosts([alpha], remote(_, true)).
test(unbound_goal, error(instantiation_error)) :-
    with_hosts([alpha], remote(alpha, _)).
test(not_callable, error(type_error(callable, 3))) :-
    with_hosts([alpha], remote(alpha, 3)).
test(unreachable, error(host_unreachable('gamma@127.0.0.1:1'))) :-
    with_hosts([alpha], remote('gamma@127.0.0.1:1', true)).
test(nested_remote, true(X == 7)) :-
    with_hosts([alpha,beta],
               remote(alpha, ( typhon:remote(beta, leave(q(7))),
                               typhon:remote(beta, take(q(X))) ))).
test(error_context_is_returned, true(H1 == A)) :-
    with_hosts([alpha,beta],
               ( address(alpha, A),
                 remote(alpha, ( catch(typhon:remote(beta, throw(x)), x, true),
                                 here(H1) )) )).
test(remote_goals_of_many_threads, true(N == 100)) :-
    with_hosts([alpha],
               ( numlist(1, 100, Is),
                 concurrent_maplist([I]>>remote(alpha, leave(i(I))), Is),
                 remote(alpha, aggregate_all(count, sense(i(_)), N)) )).
test(remote_goal_of_an_agent, true(F == [s(1)])) :-
    with_hosts([alpha,beta],
               ( remote(beta, leave(p(1))),
                 create([on_message(_, _),
                         (main :- typhon:remote(beta, sense(p(X))),
                                  assertz(s(X)))], A),
                 wait_state(A, resident),
                 facts(A, F) )).

:- end_tests(remote).
