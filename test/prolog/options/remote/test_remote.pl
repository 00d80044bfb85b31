:- module(test_remote, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Tests of remote/2 on hosts of this process

Those of other processes are used by all tests of hops.
*/

:- begin_tests(remote).

%   answers(-Behaviour, -Goal, -X, -Value): Goal on alpha, of alpha and beta,
%   binds X to Value.

answers(bindings_are_returned, ( Y is 1+2, atom_concat(a, Y, X) ), X, a3).
answers(tuple_space,
        ( leave(p(1)), leave(p(2)), take(p(1)), sense(p(X)) ), X, 2).
answers(vocabulary_of_a_host, ( neighbours(N), host_load(L), here(_) ), N-L,
        []-0).
answers(qualified_goal, lists:last([a,b,c], X), X, c).
answers(nested_remote, ( typhon:remote(beta, leave(q(7))),
                         typhon:remote(beta, take(q(X))) ), X, 7).
answers(each_host_has_its_own_place,
        ( leave(a), typhon:remote(beta, findall(Y, sense(Y), X)) ), X, []).

%   raises(-Host, -Goal, -Error): called where alpha runs.

raises(alpha, _ is foo, type_error(evaluable, foo/0)).
raises(alpha, self(_), existence_error(running_agent, here)).
raises(alpha, _, instantiation_error).
raises(alpha, 3, type_error(callable, 3)).
raises(_, true, instantiation_error).
raises(nowhere, true, existence_error(host, nowhere)).
raises('gamma@127.0.0.1:1', true, host_unreachable('gamma@127.0.0.1:1')).
raises(beta, true, permission_error(remote, host, beta)).

test(answers, [ forall(( answers(_, Goal, X, Value),
                         member(By, [name,address]) )), X == Value ]) :-
    with_hosts([alpha,beta],
               ( ( By == name -> Host = alpha ; address(alpha, Host) ),
                 remote(Host, Goal) )).
test(raises, [forall(raises(Host, Goal, Error)), error(Error)]) :-
    with_hosts([alpha, beta-[remote(false)]], remote(Host, Goal)).
test(failure, [fail]) :-
    with_hosts([alpha], remote(alpha, fail)).
test(remote_goal_is_called_once, true(Xs == [1])) :-
    with_hosts([alpha], findall(X, remote(alpha, member(X, [1,2])), Xs)).
test(exceptions, throws(oops)) :-
    with_hosts([alpha], remote(alpha, throw(oops))).
test(goal_runs_in_the_place, true(P == Place)) :-
    with_hosts([alpha],
               ( host_property(alpha, place(Place)),
                 remote(alpha, ( assertz(p(1)), context_module(P) )),
                 assertion(predicate_property(Place:p(_), dynamic)) )).
test(unknown_host_of_a_process, error(existence_error(host, _))) :-
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 atom_concat(alpha, Endpoint, Alpha),
                 atom_concat(nowhere, Endpoint, Nowhere),
                 remote(Nowhere, true) )).
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
