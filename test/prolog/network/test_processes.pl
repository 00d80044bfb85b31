:- module(test_processes, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module('../../lib/fixtures').
:- use_module('../../lib/peers').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel), [whereabouts/2]).

/** <module> Tests of agents and hosts in separate processes

The host alpha is in the process of the test, beta and gamma each in one of
their own, which a unit of tests shares.
*/

world_start :-
    host_start(alpha),
    maplist(test_peers:start, [beta,gamma]).

world_end :-
    test_peers:stop_all,
    host_stop(alpha).

there(Peer, Host) :-
    peer_host(Peer, Host).

stands(Agent, Host) :-
    agent_property(Agent, host(Host)),
    !.

has_all(Agent, N) :-
    aggregate_all(count, fact_of(Agent, s(_)), N).

collector([(on_message(_, stop) :- dispose),
           (on_message(_, M) :- assertz(s(M)))]).

disposed(Agent) :-
    agent_dispose(Agent),
    joined(Agent, disposed).

%   A host that is in none of the processes.

missing_host(Missing) :-
    member(Host, [alpha,beta]),
    ( Host == alpha -> address(alpha, There) ; there(beta, There) ),
    atom_concat(Host, Rest, There),
    atom_concat(nowhere, Rest, Missing).

:- begin_tests(processes, [setup(world_start), cleanup(world_end)]).

test(create, true(H-Home == B-B)) :-
    there(beta, B),
    create([on_message(_, _)], A, [host(B)]),
    agent_property(A, host(H)),
    agent_property(A, home(Home)),
    disposed(A).
test(create_with_all_options, true(Fs == [p(7),s(0),s(1)])) :-
    there(beta, B),
    create([on_message(_, _), s(0)], A,
           [host(B), name(scout), facts([s(1)]), tokens([x]),
            payloads([payload(seven, [p/1], [p(7)])]), lifetime(3)]),
    facts(A, Fs),
    sub_atom(A, 0, _, _, 'scout.'),
    agent_property(A, payloads([seven])),
    disposed(A).
test(create_on_a_missing_host, error(existence_error(host, _))) :-
    there(beta, B),
    atom_concat(beta, Rest, B),
    atom_concat(nowhere, Rest, Nowhere),
    create([main], _, [host(Nowhere)]).
test(create_at_an_address_without_a_process,
     error(host_unreachable('x@127.0.0.1:1'))) :-
    create([main], _, [host('x@127.0.0.1:1')]).
test(join_an_agent_created_in_another_process, true(O == done)) :-
    there(beta, B),
    create([(main :- receive(_))], A, [host(B)]),
    agent_send(A, go),
    joined(A, O).
test(join_after_the_end, true(Os == [done,done])) :-
    there(beta, B),
    create([main], A, [host(B)]),
    joined(A, O1),
    joined(A, O2),
    Os = [O1,O2].
test(join_times_out, true(O == timeout)) :-
    there(beta, B),
    create([on_message(_, _)], A, [host(B)]),
    agent_join(A, O, 0.05),
    disposed(A).
test(join_an_agent_that_moved_away, true(O == done)) :-
    there(beta, B), there(gamma, C),
    create([(main :- r(X), move(X), receive(_-go))], A,
           [facts([r(B),s(C)])]),
    wait_until(stands(A, B), 10),
    agent_send(A, go),
    joined(A, O).
test(join_an_unknown_agent, error(existence_error(agent, _))) :-
    there(beta, B),
    atom_concat('x.1.2@', B, A),
    agent_join(A, _, 10).
test(failed_and_raised, true(Os == [failed,raised(oops)])) :-
    there(beta, B),
    findall(O, ( member(G, [fail,throw(oops)]),
                 create([(main :- G)], A, [host(B)]), joined(A, O) ), Os).
test(another_process_joins, true(O == done)) :-
    create([(main :- receive(_))], A),
    agent_send(A, go),
    peer_do(beta, agent_join(A, O, 10)).
test(faulty_in_another_process, true(S-F == faulty(oops)-[s(1)])) :-
    there(beta, B),
    create([s(1), (main :- throw(oops))], A, [host(B)]),
    joined(A, _),
    agent_property(A, state(S)),
    agent_property(A, facts(F)),
    agent_dispose(A),
    \+ agent_property(A, state(_)).
test(resumed_in_another_process, true(G-Os =@= [s(1),receive(_-go)]-
                                             [failed,timeout,done])) :-
    there(beta, B),
    create([r(B), (main :- r(X), move(X), s(1), receive(_-go))], A),
    joined(A, O1),
    agent_property(A, fault(fault(failed, s(1), main/0:1, B))),
    agent_property(A, goals(G0)),
    copy_term(G0, G),
    agent_change(A, facts([s(1)])),
    agent_resume(A),
    agent_join(A, O2, 0.1),
    agent_send(A, go),
    joined(A, O3),
    Os = [O1,O2,O3].
test(resumed_in_another_process_and_done_at_once, true(Os == [done])) :-
    there(beta, B),
    findall(O,
            ( between(1, 20, _),
              create([r(B), (main :- r(X), move(X), s(1))], A),
              joined(A, failed),
              agent_change(A, facts([s(1)])),
              agent_resume(A),
              joined(A, O) ),
            Os0),
    sort(Os0, Os).
test(fault_location_is_reported_from_any_process,
     true(Name:Line == 'far.pl':4)) :-
    there(beta, B),
    with_tmp_dir(test_processes:far(B, A)),
    joined(A, failed),
    agent_property(A, fault(fault(failed, s(1), File:Line, B))),
    file_base_name(File, Name).

test(faulty_agent_moves_home, true(L == 0)) :-
    there(beta, B), address(alpha, H),
    create([r(B), (main :- r(X), move(X), s(1))], A),
    joined(A, failed),
    agent_move(A, H),
    wait_until(( stands(A, H), state_of(A, faulty(failed)) ), 10),
    agent_property(A, fault(fault(failed, s(1), _, B))),
    peer_do(gamma, agent_join(A, failed, 10)),
    host_property(alpha, load(L)),
    agent_dispose(A),
    joined(A, failed).
test(properties, true(Ps =@= [ facts([s(1)]), goals([receive(_-go),foo]),
                               home(H), hops(1), host(B), mailbox([]),
                               payloads([x]), program(test),
                               state(waiting) ])) :-
    there(beta, B), address(alpha, H),
    create([s(1), foo, (main :- parent_host(X), move(X), receive(_-go), foo),
            parent_host(B)], A, [payloads([payload(x, [], [])])]),
    wait_until(( stands(A, B), state_of(A, waiting) ), 10),
    findall(P, agent_property(A, P), Ps0),
    sort(Ps0, Ps),
    disposed(A).
test(seen_from_a_third_process, true(H == B)) :-
    there(beta, B),
    create([(main :- to(X), move(X), receive(_)), to(B)], A),
    wait_until(stands(A, B), 10),
    peer_do(gamma, agent_property(A, host(H))),
    disposed(A).
test(ids_are_unique_among_processes, true(N == 150)) :-
    there(beta, B), there(gamma, C), address(alpha, H),
    findall(A, ( member(Host, [H,B,C]), between(1, 50, _),
                 create([main], A, [host(Host)]) ), As),
    maplist(joined, As, _),
    findall(Id, ( member(A, As), atomic_list_concat([Id,_,_], @, A) ), Ids),
    sort(Ids, Set),
    length(Set, N).

test(move_from_outside, true(F == [s(1)])) :-
    there(beta, B),
    create([on_message(_, _), s(1)], A),
    agent_move(A, B),
    wait_until(stands(A, B), 10),
    agent_property(A, facts(F)),
    disposed(A).
test(clone_from_outside, true(Hs == [B,B])) :-
    there(beta, B),
    create([on_message(_, _)], A, [host(B)]),
    agent_clone(A, C),
    findall(H, ( member(X, [A,C]), agent_property(X, host(H)) ), Hs),
    maplist(disposed, [A,C]).
test(clone_to_another_process, true(H1-H2 == H-B)) :-
    there(beta, B), address(alpha, H),
    create([on_message(_, _), to(B),
            (main :- to(X), clone(X, W), assertz(s(W)))], A),
    wait_state(A, resident),
    fact_of(A, s(parent(C))),
    wait_state(C, resident),
    agent_property(A, host(H1)),
    agent_property(C, host(H2)),
    fact_of(C, s(clone(A))),
    maplist(disposed, [A,C]).
test(payload_from_outside, true(P1-P2 == [seven]-[])) :-
    there(beta, B),
    create([(main :- ( receive(_-stop, 0.001) -> true ; main ))], A,
           [host(B)]),
    payload_attach(A, payload(seven, [p/1], [p(7)])),
    agent_property(A, payloads(P1)),
    payload_detach(A, seven),
    agent_property(A, payloads(P2)),
    disposed(A).
test(errors_of_orders_are_returned,
     error(permission_error(attach, procedure, s/1))) :-
    there(beta, B),
    create([on_message(_, _)], A, [host(B)]),
    call_cleanup(payload_attach(A, payload(x, [s/1], [])), disposed(A)).
test(order_to_agent_of_a_missing_process, error(existence_error(agent, _))) :-
    there(beta, B),
    atom_concat('x.1.2@', B, A),
    agent_dispose(A).
test(order_to_an_address_without_a_process, error(host_unreachable(_))) :-
    agent_dispose('x.1.2@y@127.0.0.1:1').
test(saved_in_one_process_loaded_in_another, true(F-H == [s(1),s(2)]-Here)) :-
    there(beta, B), address(alpha, Here),
    with_tmp_dir(test_processes:save_and_load(B, F, H)).
test(orders_to_a_constantly_moving_agent, true(O == disposed)) :-
    there(beta, B), there(gamma, C),
    create([(main :- to(X), move(X), main), to(B), to(C)], A),
    forall(between(1, 10, I),
           ( atom_concat(p, I, P),
             payload_attach(A, payload(P, [], [])),
             payload_detach(A, P),
             once(agent_property(A, state(_))) )),
    agent_dispose(A),
    joined(A, O).
test(orders_to_an_agent_circling_three_processes, true(O == disposed)) :-
    there(beta, B), there(gamma, C), address(alpha, H),
    create([(main :- round), round_trip([B,C,H]),
            (round :- round_trip(L), go(L), round),
            (go([]) :- true), (go([X|Xs]) :- move(X), go(Xs))], A),
    forall(between(1, 10, I),
           ( atom_concat(p, I, P),
             payload_attach(A, payload(P, [], [])),
             payload_detach(A, P),
             once(agent_property(A, hops(_))) )),
    agent_dispose(A),
    joined(A, O).

:- end_tests(processes).

%   far(+Address, -Agent, +Dir): an agent created here from a file, which fails
%   at Address.

far(Address, Agent, Dir) :-
    directory_file_path(Dir, 'far.pl', File),
    write_file(File, ":- agent(far, [state([s/1])]).~n~n\c
                      main :- go(~q), move(nowhere).~n\c
                      go(H) :- move(H), s(1).~n", [Address]),
    agent_create(File, Agent).

save_and_load(B, Facts, Host, Dir) :-
    directory_file_path(Dir, point, File),
    create([on_message(_, _),
            (main :- assertz(s(1)), receive(_-go), assertz(s(2)))], A,
           [host(B)]),
    wait_state(A, waiting),
    agent_save(A, File),
    agent_load(File, C),
    agent_send(C, go),
    wait_state(C, resident),
    agent_property(C, facts(Facts)),
    agent_property(C, host(Host)),
    maplist(disposed, [A,C]).

reported(Peer, Agent) :-
    peer_messages(Peer, Lines),
    member(Line, Lines),
    sub_string(Line, _, _, _, Agent),
    !.

:- begin_tests(messages_between_processes,
               [setup(world_start), cleanup(world_end)]).

test(messages_arrive_in_order, true(Ns == Sent)) :-
    numlist(1, 2000, Sent),
    there(beta, B),
    collector(Cs),
    create(Cs, A, [host(B)]),
    forall(member(N, Sent), agent_send(A, N)),
    wait_until(has_all(A, 2000), 20),
    findall(N, fact_of(A, s(N)), Ns),
    disposed(A).
test(messages_are_answered, true(O == done)) :-
    there(beta, B),
    create([(on_message(W, ask(X)) :- Y is X*2, send(W, Y))], A, [host(B)]),
    create([(main :- s(Other), send(Other, ask(21)), receive(Other-42))], C,
           [facts([s(A)])]),
    joined(C, O),
    disposed(A).

%   The move is over when the agent's home, this process, is notified: earlier
%   messages go by way of beta, and may be overtaken.

test(messages_reach_an_agent_that_moved_away, true(Ns == [1,2,3])) :-
    there(beta, B), there(gamma, C),
    collector(Cs),
    create([(main :- to(X,Y), move(X), move(Y)), to(B,C)|Cs], A),
    wait_until(whereabouts(A, C), 10),
    forall(member(N, [1,2,3]), agent_send(A, N)),
    wait_until(has_all(A, 3), 10),
    findall(N, fact_of(A, s(N)), Ns),
    disposed(A).
test(messages_from_a_process_without_its_location, true(Ns == [1])) :-
    there(beta, B),
    collector(Cs),
    create([(main :- to(X), move(X)), to(B)|Cs], A),
    wait_until(stands(A, B), 10),
    peer_do(gamma, agent_send(A, 1)),
    wait_until(has_all(A, 1), 10),
    findall(N, fact_of(A, s(N)), Ns),
    disposed(A).
test(hints, [forall(member(Hint, [alpha,beta,gamma])), true(Ns == [1])]) :-
    there(beta, B),
    ( Hint == alpha -> H = alpha ; there(Hint, H) ),
    collector(Cs),
    create([(main :- to(X), move(X)), to(B)|Cs], A),
    wait_until(stands(A, B), 10),
    agent_send(at(A, H), 1),
    wait_until(has_all(A, 1), 10),
    findall(N, fact_of(A, s(N)), Ns),
    disposed(A).
test(moving_agent_gets_each_message_once, true(N == 1500)) :-
    there(beta, B), there(gamma, C), address(alpha, H),
    create([ (main :- ( receive(_-stop, 0)
                      -> true
                      ;  round_trip(L), go(L), main )),
             round_trip([B,C,H]),
             (go([]) :- true), (go([X|Xs]) :- move(X), go(Xs)),
             (on_message(_, M) :- assertz(s(M))) ], A),
    forall(member(P, [beta,gamma]),
           peer_do(P, send_in_background(A, 500))),
    forall(between(1, 500, I), agent_send(A, n(I))),
    agent_send(A, stop),
    wait_until(has_all(A, 1500), 30),
    findall(I, fact_of(A, s(n(I))), Is),
    length(Is, N),
    sort(Is, Set),
    assertion(length(Set, 500)),
    disposed(A).
test(message_to_an_ended_agent_is_dropped_silently) :-
    there(beta, B),
    create([main], A, [host(B)]),
    joined(A, done),
    agent_send(A, hello),
    peer_do(beta, true),
    peer_messages(beta, Lines),
    \+ ( member(Line, Lines), sub_string(Line, _, _, _, A) ).
test(message_to_unknown_agent_is_reported_where_it_was_sent) :-
    there(gamma, C),
    atom_concat('x.1.2@', C, A),
    peer_do(beta, agent_send(A, hello)),
    wait_until(reported(beta, A), 10),
    \+ reported(gamma, A).

:- end_tests(messages_between_processes).

:- begin_tests(hosts_of_other_processes,
               [setup(world_start), cleanup(world_end)]).

test(remote, true(X-Y == 3-B)) :-
    there(beta, B),
    remote(B, ( X is 1+2, here(Y) )).
test(remote_fails, [fail]) :-
    there(beta, B), remote(B, fail).
test(remote_once, true(Xs == [1])) :-
    there(beta, B), findall(X, remote(B, member(X, [1,2])), Xs).
test(remote_error, error(type_error(evaluable, foo/0))) :-
    there(beta, B), remote(B, _ is foo).
test(remote_exception, throws(oops(1))) :-
    there(beta, B), remote(B, throw(oops(1))).
test(remote_exception_that_cannot_travel, error(_)) :-
    there(beta, B), remote(B, ( current_output(S), throw(error(foo(S), _)) )).
test(remote_result_that_cannot_travel, error(type_error(mobile_term, _))) :-
    there(beta, B), remote(B, current_output(_)).
test(remote_goal_that_cannot_travel, error(type_error(mobile_term, _))) :-
    there(beta, B), current_output(S), remote(B, write(S, x)).
test(remote_shares_variables, true(X == Y)) :-
    there(beta, B), remote(B, X = Y).
test(remote_tuple_space, true(X == 1)) :-
    there(beta, B), remote(B, leave(p(1))), remote(B, take(p(X))).
test(remote_on_a_missing_host, error(existence_error(host, _))) :-
    there(beta, B), atom_concat(beta, Rest, B),
    atom_concat(nowhere, Rest, Nowhere),
    remote(Nowhere, true).
test(nested_remote, true(X == H)) :-
    there(beta, B), address(alpha, H),
    remote(B, typhon:remote(H, here(X))).
test(remote_from_many_threads, true(N == 100)) :-
    there(beta, B),
    numlist(1, 100, Is),
    concurrent_maplist([I]>>remote(B, leave(i(I))), Is),
    remote(B, aggregate_all(count, sense(i(_)), N)).
test(remote_after_a_restart_of_the_process,
     true(E = connection_lost(D))) :-
    test_peers:start(delta),
    there(delta, D),
    thread_create(( catch(remote(D, ( leave(busy), repeat, fail )),
                          error(E0, _), true),
                    thread_exit(E0) ), T),
    wait_until(peer_do(delta, remote(delta, sense(busy))), 10),
    peer_kill(delta),
    peer_restart(delta),
    thread_join(T, exited(E)).

test(host_property, true(S-N == running-B)) :-
    there(beta, B),
    host_property(B, state(S)),
    host_property(B, address(N)).
test(host_property_of_unknown_host, error(existence_error(host, _))) :-
    there(beta, B), atom_concat(beta, Rest, B),
    atom_concat(nowhere, Rest, Nowhere),
    host_property(Nowhere, state(_)).
test(host_property_at_an_address_without_a_process,
     error(host_unreachable(_))) :-
    host_property('x@127.0.0.1:1', state(_)).
test(link, true(A-C == [B]-[H])) :-
    there(beta, B), address(alpha, H),
    link(alpha, B),
    host_property(alpha, neighbours(A)),
    host_property(B, neighbours(C)),
    unlink(B, H),
    host_property(alpha, neighbours([])),
    host_property(B, neighbours([])).
test(link_two_remote_hosts, true(X-Y == [C]-[B])) :-
    there(beta, B), there(gamma, C),
    link(B, C),
    host_property(B, neighbours(X)),
    host_property(C, neighbours(Y)),
    unlink(C, B),
    host_property(B, neighbours([])).
test(failed_link_is_removed_on_both_sides,
     [ forall(missing_host(Missing)),
       true(Errors-N-L == [E,E,E,E]-[]-[]) ]) :-
    there(beta, B),
    address(alpha, H),
    E = existence_error(host, Missing),
    findall(Error,
            ( member(X-Y, [H-Missing,Missing-H,B-Missing,Missing-B]),
              catch(link(X, Y), error(Error, _), true) ),
            Errors),
    host_property(H, neighbours(N)),
    host_property(B, neighbours(L)).
test(unlink_from_an_unreachable_host, [ forall(member(Way, [to,from])),
                                        true(L == []) ]) :-
    address(alpha, H),
    Gone = 'x@127.0.0.1:1',
    typhon_links:host_link(alpha, Gone, same),
    ( Way == to -> A-B = H-Gone ; A-B = Gone-H ),
    catch(unlink(A, B), error(host_unreachable(Gone), _), true),
    host_property(H, neighbours(L)).

:- end_tests(hosts_of_other_processes).

:- begin_tests(peers_that_hang).

%   The stop waits for the other process as long as its setting says, and no
%   longer. Agents in doubt are reported then, and no process is queried any
%   more.

test(host_stop_with_a_hanging_peer, true((Seconds < 20, Errors == []))) :-
    with_settings([ typhon_hosting:stop_seconds=0.2,
                    typhon_endpoint:flush_time=0.2 ],
                  no_leaks(with_peers([beta],
                                      stop_beside_a_hanging_one(Seconds,
                                                                Errors)))).

stop_beside_a_hanging_one(Seconds, Errors) :-
    host_start(alpha),
    there(beta, B), address(alpha, A),
    forall(between(1, 10, _),
           create([(main :- round(A, B)),
                   (round(X, Y) :- move(Y), move(X), round(X, Y))], _)),
    create([on_message(_, _)], C, [host(B)]),
    peer_signal(beta, stop),
    forall(between(1, 1000, I), agent_send(C, I)),
    get_time(T0),
    capturing(host_stop(alpha), Told),
    get_time(T1),
    Seconds is T1-T0,
    findall(Error, member(error-Error, Told), Errors).

:- end_tests(peers_that_hang).
