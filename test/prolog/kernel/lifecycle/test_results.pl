:- module(test_results, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3, pairs_values/2]).
:- use_module(library(typhon)).

/** <module> The results of agents that have ended, and of all their clones

Time is virtual where no agent leaves the process.

*Threading*: one test at a time.
*/

:- meta_predicate virtually(0).

virtually(Goal) :-
    with_hosts([alpha-[clock(virtual)], beta-[clock(virtual)]], Goal).

:- begin_tests(results).

%   created_on_a(+Clauses, -Id)

created_on_a(Clauses, Id) :-
    peer_agent(a, [(:- agent(r))|Clauses], [], Id).

test(agent_whose_process_is_gone_is_lost, Outcome == lost(B)) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 created_on_a([(main :- move(B)), on_message(_, _)], Id),
                 wait_until(peer_do(b, agent_property(Id, state(resident))),
                            10),
                 wait_until(peer_do(a, typhon_whereabouts:home_knows(Id, B, _, _)), 10),
                 peer_do(a, agent_join(Id, timeout, 0)),
                 atomic_list_concat([_, There], @, B),
                 wait_until(peer_do(a, typhon_peer_cache:endpoint_peer(
                                             There, pending(0))),
                            10),
                 peer_kill(b),
                 wait_until(( peer_do(a, agent_join(Id, Outcome, 0.5)),
                              Outcome \== timeout ), 30) )).
%   The process that gave the order may end before it reports, so the host does.

test(host_of_a_resumed_agent_reports_it_to_the_home) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 created_on_a([(main :- move(B), receive(_, 0), receive(no))],
                              Id),
                 wait_until(peer_do(a, agent_join(Id, failed, 0)), 20),
                 peer_do(a, agent_send(Id, go)),
                 wait_until(peer_do(b, agent_property(Id, mailbox([_]))), 10),
                 peer_do(b, typhon_order_client:order_give(Id, resume, _)),
                 wait_until(peer_do(a, agent_join(Id, timeout, 0)), 20) )).
%   gives(-Behaviour, -Clauses, -Result): of an agent of Clauses.

gives(given_result, [(main :- X is 6*7, result(X))], 42).
gives(last_result_counts, [(main :- forall(member(I, [1,2,3]), result(I)))],
      3).
gives(result_may_be_any_term, [(main :- result(f(Z,Z,"text",1.5,[a|_])))],
      f(Y,Y,"text",1.5,[a|_])).
gives(result_travels, [(main :- result(1), move(beta))], 1).
gives(result_is_found_wherever_the_agent_ends,
      [(main :- result(1), move(beta), move(alpha), move(beta), hops(H),
                H == 3, result(2))], 2).
gives(result_given_before_a_failure, [(main :- result(1), fail)], 1).
gives(result_given_before_an_exception, [(main :- result(1), throw(oops))],
      1).
gives(result_that_cannot_travel,
      [(main :- current_output(S),
                catch(result(S), error(type_error(T, _), _), result(T)))],
      mobile_term).

test(gives, [ forall(gives(_, Clauses, Result)),
              true(( X =@= Result, Y =@= Result )) ]) :-
    virtually(capturing(( create(Clauses, A),
                          agent_result(A, X, 10),
                          agent_result(A, Y, 10) ), _)).
test(result_is_unified_with_a_pattern, X == 2) :-
    virtually(( create([(main :- result(p(1,2)))], A),
                agent_result(A, p(1,X), 10),
                \+ agent_result(A, p(2,_), 10) )).
test(result_is_not_a_fact_of_the_agent, Fs == []) :-
    virtually(( create([(main :- result(1)), on_message(_, _)], A),
                \+ agent_join(A, done, 1),
                facts(A, Fs) )).
test(result_fails_at_the_timeout, X == late) :-
    virtually(( create([(main :- result(1), sleep(100))], A),
                ( agent_result(A, X, 99.0) -> true ; X = late ),
                agent_result(A, 1, 2) )).
test(result_given_before_disposal, X == 1) :-
    virtually(( create([(main :- result(1), receive(_))], A),
                agent_join(A, timeout, 1),
                agent_dispose(A),
                agent_result(A, X, 10) )).
test(result_after_the_host_has_stopped, X == 1) :-
    with_hosts([alpha], ( create([(main :- result(1))], A),
                          joined(A, done), host_stop(alpha),
                          agent_result(A, X, 10) )).
test(agent_without_a_result, error(existence_error(result, _))) :-
    virtually(( create([main], A), agent_result(A, _, 10) )).
test(no_such_agent, true(Unknown == Id)) :-
    virtually(( address(alpha, Address),
                atom_concat('x.1@', Address, Id),
                catch(agent_result(Id, _, 1),
                      error(existence_error(agent, Unknown), _), true) )).
test(clones_have_their_own_results, Xs == [parent,none]) :-
    virtually(( create([ (main :- result(parent), clone(Branch), go(Branch)),
                         go(parent(_)), go(clone(_)) ], A),
                agent_join(family(A), [A-done,B-done], 10),
                findall(X, ( member(C, [A,B]),
                             catch(agent_result(C, X, 10),
                                   error(existence_error(result, C), _),
                                   X = none) ), Xs) )).
test(result_in_a_restore_point, X == 1) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, point, File),
          virtually(( create([(main :- result(1), receive(_-go))], A),
                      agent_join(A, timeout, 1),
                      agent_save(A, File),
                      agent_load(File, B),
                      agent_send(B, go),
                      agent_result(B, X, 10) )) )).
test(too_large_result,
     true(O = raised(error(resource_error(result_bytes), _)))) :-
    virtually(capturing(( create([(main :- numlist(1, 500000, L),
                                           result(L))], A),
                          joined(A, O) ), _)).
%   On 32 bits SWI-Prolog 9.0.4 may crash with strings of more than 512 kB in
%   records, which messages are as well.

test(largest_accepted_result,
     [condition(current_prolog_flag(address_bits, 64)), N == 999900]) :-
    virtually(( create([(main :- format(string(S), "~`xt~999900|", []),
                                 result(S))], A),
                agent_result(A, X, 60), string_length(X, N) )).
test(result_outside_an_agent, error(existence_error(running_agent, here))) :-
    virtually(remote(alpha, result(1))).
test(results_are_bounded, Kept == [none,1]) :-
    with_settings([typhon_outcomes:results=50],
                  virtually(( findall(A, ( between(1, 301, _),
                                           create([(main :- result(1))], A) ),
                                      As),
                              maplist(joined, As, _),
                              As = [First|_], last(As, Last),
                              maplist(kept, [First,Last], Kept) ))).

kept(Agent, X) :-
    catch(agent_result(Agent, X, 10), error(existence_error(result, _), _),
          X = none).

%   The family spreads over processes.

test(results_reach_another_process,
     [ forall(member(Main-Result, [ ( move(B), result(here) )-here,
                                    ( result(7), move(B) )-7 ])),
       X-Y == Result-Result ]) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 created_on_a([(main :- Main)], Id),
                 peer_do(b, agent_result(Id, Y, 20)),
                 peer_do(a, agent_result(Id, X, 20)) )).

%   There are more results than one frame holds.

test(many_large_results, Lengths == [30000]) :-
    with_peers([ a, b-[setup(set_setting(typhon_session:frame_bytes,
                                         100000))] ],
               ( peer_host(b, B),
                 peer_do(a, findall(New,
                            ( between(1, 40, _),
                              agent_create(
                                  clauses([ (:- agent(r)),
                                            (main :- move(B),
                                                     format(string(S),
                                                       "~`xt~30000|", []),
                                                     result(S)) ]),
                                  New, []) ), Ids)),
                 peer_do(a, ( findall(N, ( member(Id, Ids),
                                           agent_result(Id, X, 60),
                                           string_length(X, N) ),
                                      Ns),
                              sort(Ns, Lengths) )) )).

%   The home knows at least that the agent has ended.

test(result_longer_than_a_frame, Error == existence_error(result, Id)) :-
    with_peers([ a, b-[setup(set_setting(typhon_session:frame_bytes, 70000))] ],
               ( peer_host(b, B),
                 created_on_a([(main :- move(B),
                                        format(string(S), "~`xt~90000|", []),
                                        result(S))], Id),
                 peer_do(a, agent_join(Id, done, 20)),
                 peer_try(a, agent_result(Id, _, 20), Outcome),
                 peer_messages(b, Lines) )),
    Outcome = raised(error(Error, _)),
    once(( member(Line, Lines), sub_string(Line, _, _, _, "too long") )).

:- end_tests(results).

                /*******************************
                *            FAMILIES          *
                *******************************/

%   A tree of clones: each makes two, Depth deep, and sleeps a while.

tree(Depth, Clauses) :-
    Clauses = [ (main :- grow(Depth)),
                (grow(0) :- !, sleep(1)),
                (grow(N) :- N1 is N-1,
                            clone(W1), ( W1 = clone(_) -> grow(N1)
                                       ; clone(W2),
                                         ( W2 = clone(_) -> grow(N1)
                                         ; sleep(0.5) ) )) ].

:- begin_tests(families).

test(all_clones, N-Set == 15-[done]) :-
    tree(3, Clauses),
    virtually(( create(Clauses, A), agent_join(family(A), Os, 100) )),
    Os = [A-_|_],
    pairs_keys_values(Os, As, Outcomes),
    sort(As, Different),
    length(Different, N),
    length(As, N),
    sort(Outcomes, Set).
test(join_waits_for_the_last_clone, T =:= 1.0) :-
    tree(2, Clauses),
    virtually(( create(Clauses, A), agent_join(family(A), _, 100),
                remote(alpha, now(T)) )).
test(only_descendants, Cs == Ds) :-
    virtually(( create([(main :- clone(W), on(W)), on(parent(_)),
                        (on(clone(_)) :- clone(_))], A),
                agent_join(family(A), [A-done,B-done,C-done], 10),
                Cs = [B-done,C-done],
                agent_join(family(B), Ds, 10) )).
test(parent_precedes_its_clones, Hops == [0,1,2]) :-
    virtually(( create([(main :- clone(W), on(W)), on(parent(_)),
                        (on(clone(_)) :- result(1), clone(V), more(V)),
                        more(parent(_)), (more(clone(_)) :- result(2))], A),
                agent_join(family(A), Os, 10),
                findall(X, ( member(M-_, Os), value(M, X) ), Hops) )).

value(Agent, X) :-
    catch(agent_result(Agent, X, 0), error(existence_error(_, _), _), X = 0).

test(outcomes_of_their_own, Os == [disposed,done,failed]) :-
    virtually(capturing(( create([ (main :- clone(V), ( V = clone(_) -> true
                                            ; clone(W), ( W = clone(_) -> fail
                                            ; dispose ) )) ], A),
                          agent_join(family(A), Pairs, 10) ), _)),
    pairs_values(Pairs, Os).
test(timeout, Os == [timeout,timeout,done]) :-
    virtually(( create([ (main :- clone(V), ( V = clone(_) -> sleep(20)
                                            ; clone(W), ( W = clone(_) -> true
                                            ; receive(_-go) ) )) ], A),
                agent_join(family(A), Pairs, 10.0),
                agent_send(A, go),
                agent_join(family(A), Later, 100) )),
    pairs_values(Pairs, Os),
    pairs_values(Later, [done,done,done]).
test(timeout_of_a_join,
     [ forall(member(Timeout-Outcome, [0-timeout, inf-done])),
       Os == [A-Outcome] ]) :-
    virtually(( create([(main :- sleep(5))], A),
                agent_join(family(A), Os, Timeout) )).
test(clones_ordered_from_outside, N == 3) :-
    virtually(( create([(main :- receive(_-go))], A),
                agent_join(A, timeout, 1),
                agent_clone(A, B), agent_clone(B, C),
                forall(member(X, [A,B,C]), agent_send(X, go)),
                agent_join(family(A), Os, 10),
                length(Os, N) )).
test(clone_that_could_not_start, Os == [A-done]) :-
    with_hosts([alpha,beta-[capacity(0)]],
               ( create([ (main :- catch(clone(beta, _), error(_, _), true)),
                          (main :- true) ], A),
                 agent_join(family(A), Os, 10) )).
test(invalid_join,
     [ forall(member(Agent-Timeout-Error,
                     [ foo-1-existence_error(agent, foo),
                       _-1-instantiation_error,
                       foo-soon-type_error(number, soon) ])),
       error(Error) ]) :-
    virtually(agent_join(family(Agent), _, Timeout)).

%   A clones itself on its own host, and on that of the other process by
%   clone/2 and after a move; its clones do the same.

test(family_in_several_processes, true(Outcomes-N == [done]-10)) :-
    with_peers([a, b],
               ( peer_host(a, A), peer_host(b, B),
                 peer_agent(a,
                     [ (:- agent(f)),
                       (main :- clone(W1), ( W1 = clone(_) -> leaf(B)
                              ; clone(B, W2), ( W2 = clone(_) -> leaf(A)
                              ; move(B), clone(W3), ( W3 = clone(_) -> leaf(A)
                              ; move(A), sleep(0.1) ) ) )),
                       (leaf(H) :- clone(H, W), ( W = parent(_)
                                                -> clone(_), sleep(0.1)
                                                ;  true )) ], [], Id),
                 peer_do(b, agent_join(family(Id), FromB, 20)),
                 peer_do(a, agent_join(family(Id), FromA, 20)) )),
    FromA == FromB,
    pairs_keys_values(FromA, Members, Os),
    sort(Os, Outcomes),
    sort(Members, Set),
    length(Set, N).
test(cloned_elsewhere_from_outside, Os == [timeout,timeout]) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 peer_agent(a,
                     [ (:- agent(f)), (main :- move(B), receive(_-go)) ],
                     [], Id),
                 peer_do(b, wait_until(agent_state_here(Id, waiting), 10)),
                 peer_do(a, agent_clone(Id, _)),
                 peer_do(a, agent_join(family(Id), Pairs, 0.2)) )),
    pairs_values(Pairs, Os).

:- end_tests(families).
