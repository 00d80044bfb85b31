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
:- use_module(library(prolog_wrap)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/fifo), [fifo_empty/2]).
:- use_module(library(typhon/kernel/travel), [whereabouts/2]).
:- use_module(library(typhon/network/nodes), []).

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

%   there(-Alpha, -Beta, -Gamma): their addresses.

there(H, B, C) :-
    address(alpha, H),
    maplist(peer_host, [beta,gamma], [B,C]).

stands(Agent, Host) :-
    agent_property(Agent, host(Host)),
    !.

has_all(Agent, N) :-
    aggregate_all(count, fact_of(Agent, s(_)), N).

%   gets(+Agent, +N, -Messages): the Messages of a collector that has N.

gets(Agent, N, Messages) :-
    wait_until(has_all(Agent, N), 30),
    findall(M, fact_of(Agent, s(M)), Messages),
    disposed(Agent).

%   An agent that goes over a route of hosts; it keeps its messages.

collector(Clauses, Route, Agent, Options) :-
    append(Clauses, [ (on_message(_, M) :- assertz(s(M))), route(Route),
                      (round :- route(L), go(L)),
                      go([]), (go([X|Xs]) :- move(X), go(Xs)) ], All),
    create(All, Agent, Options).

disposed(Agent) :-
    agent_dispose(Agent),
    joined(Agent, disposed).

%   A host that is in none of the processes.

missing_host(Missing) :-
    there(H, B, _),
    member(Name-There, [alpha-H,beta-B]),
    atom_concat(Name, Rest, There),
    atom_concat(nowhere, Rest, Missing).

:- begin_tests(processes, [setup(world_start), cleanup(world_end)]).

test(create, true(P-Fs == [B,B,[seven]]-[p(7),s(0),s(1)])) :-
    there(_, B, _),
    create([on_message(_, _), s(0)], A,
           [host(B), name(scout), facts([s(1)]), tokens([x]),
            payloads([payload(seven, [p/1], [p(7)])]), lifetime(3)]),
    facts(A, Fs),
    sub_atom(A, 0, _, _, 'scout.'),
    findall(X, ( member(Q, [host(X),home(X),payloads(X)]),
                 agent_property(A, Q) ), P),
    disposed(A).

%   nowhere(-Goal, -Formal): there is no such host, agent or process.

nowhere(Goal, existence_error(host, Missing)) :-
    missing_host(Missing),
    member(Goal, [ create([main], _, [host(Missing)]), remote(Missing, true),
                   host_property(Missing, state(_)) ]).
nowhere(Goal, existence_error(agent, A)) :-
    there(_, B, _),
    atom_concat('x.1.2@', B, A),
    member(Goal, [agent_join(A, _, 10), agent_dispose(A)]).
nowhere(Goal, host_unreachable(Host)) :-
    Host = 'x@127.0.0.1:1',
    member(Goal, [create([main], _, [host(Host)]), host_property(Host, state(_))]).
nowhere(agent_dispose('x.1.2@y@127.0.0.1:1'), host_unreachable(_)).

test(nowhere, [forall(nowhere(Goal, Formal)), error(Formal)]) :-
    call(Goal).
test(outcome_is_known_in_each_process,
     [ forall(( member(Home, [alpha,beta]),
                member(How-O, [true-done,fail-failed,throw(oops)-raised(oops)]) )),
       true(Os == [timeout,O,O,O]) ]) :-
    ( Home == alpha -> Host = alpha ; peer_host(Home, Host) ),
    create([(main :- receive(_-go(G)), call(G))], A, [host(Host)]),
    agent_join(A, O1, 0.05),
    agent_send(A, go(How)),
    capturing(maplist(joined, [A,A], [O2,O3]), _),
    peer_do(gamma, agent_join(A, O4, 10)),
    Os = [O1,O2,O3,O4].
test(join_an_agent_that_moved_away, true(O == done)) :-
    there(_, B, C),
    create([(main :- r(X), move(X), receive(_-go))], A,
           [facts([r(B),s(C)])]),
    wait_until(stands(A, B), 10),
    agent_send(A, go),
    joined(A, O).
test(faulty_in_another_process, true(S-F == faulty(oops)-[s(1)])) :-
    there(_, B, _),
    create([s(1), (main :- throw(oops))], A, [host(B)]),
    joined(A, _),
    agent_property(A, state(S)),
    agent_property(A, facts(F)),
    agent_dispose(A),
    \+ agent_property(A, state(_)).
test(resumed_in_another_process, true(G-Os =@= [s(1),receive(_-go)]-
                                             [failed,timeout,done])) :-
    there(_, B, _),
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
    there(_, B, _),
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
    there(_, B, _),
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'far.pl', Program),
          write_file(Program, ":- agent(far, [state([s/1])]).~n~n\c
                               main :- go(~q), move(nowhere).~n\c
                               go(H) :- move(H), s(1).~n", [B]),
          agent_create(Program, A) )),
    joined(A, failed),
    agent_property(A, fault(fault(failed, s(1), File:Line, B))),
    file_base_name(File, Name).
test(faulty_agent_moves_home, true(L == 0)) :-
    there(H, B, _),
    create([r(B), (main :- r(X), move(X), s(1))], A),
    joined(A, failed),
    agent_move(A, H),
    wait_until(( stands(A, H), state_of(A, faulty(failed)) ), 10),
    agent_property(A, fault(fault(failed, s(1), _, B))),
    peer_do(gamma, agent_join(A, failed, 10)),
    host_property(alpha, load(L)),
    agent_dispose(A),
    joined(A, failed).
test(properties, true(Ps-Third =@= [ facts([s(1)]), goals([receive(_-go),foo]),
                               home(H), hops(1), host(B), mailbox([]),
                               payloads([x]), program(test),
                               state(waiting) ]-B)) :-
    there(H, B, _),
    create([s(1), foo, (main :- parent_host(X), move(X), receive(_-go), foo),
            parent_host(B)], A, [payloads([payload(x, [], [])])]),
    wait_until(( stands(A, B), state_of(A, waiting) ), 10),
    findall(P, agent_property(A, P), Ps0),
    sort(Ps0, Ps),
    peer_do(gamma, agent_property(A, host(Third))),
    disposed(A).
test(ids_are_unique_among_processes, true(N == 150)) :-
    there(H, B, C),
    findall(A, ( member(Host, [H,B,C]), between(1, 50, _),
                 create([main], A, [host(Host)]) ), As),
    maplist(joined, As, _),
    findall(Id, ( member(A, As), atomic_list_concat([Id,_,_], @, A) ), Ids),
    sort(Ids, Set),
    length(Set, N).

test(moved_and_cloned_from_outside, true(Hs-F == [B,B]-[s(1)])) :-
    there(_, B, _),
    create([on_message(_, _), s(1)], A),
    agent_move(A, B),
    wait_until(stands(A, B), 10),
    agent_clone(A, C),
    agent_property(C, facts(F)),
    findall(H, ( member(X, [A,C]), agent_property(X, host(H)) ), Hs),
    maplist(disposed, [A,C]).
test(clone_to_another_process, true(H1-H2 == H-B)) :-
    there(H, B, _),
    create([on_message(_, _), to(B),
            (main :- to(X), clone(X, W), assertz(s(W)))], A),
    wait_state(A, resident),
    fact_of(A, s(parent(C))),
    wait_state(C, resident),
    agent_property(A, host(H1)),
    agent_property(C, host(H2)),
    fact_of(C, s(clone(A))),
    maplist(disposed, [A,C]).
test(payload_from_outside,
     true(P1-P2-E == [seven]-[]-permission_error(attach, procedure, s/1))) :-
    there(_, B, _),
    create([(main :- ( receive(_-stop, 0.001) -> true ; main ))], A,
           [host(B)]),
    payload_attach(A, payload(seven, [p/1], [p(7)])),
    agent_property(A, payloads(P1)),
    payload_detach(A, seven),
    agent_property(A, payloads(P2)),
    catch(payload_attach(A, payload(x, [s/1], [])), error(E, _), true),
    disposed(A).
test(saved_in_one_process_loaded_in_another, true(F-H == [s(1),s(2)]-Here)) :-
    there(Here, B, _),
    create([on_message(_, _),
            (main :- assertz(s(1)), receive(_-go), assertz(s(2)))], A,
           [host(B)]),
    wait_state(A, waiting),
    with_tmp_dir(Dir, ( directory_file_path(Dir, point, File),
                        agent_save(A, File),
                        agent_load(File, C) )),
    agent_send(C, go),
    wait_state(C, resident),
    agent_property(C, facts(F)),
    agent_property(C, host(H)),
    maplist(disposed, [A,C]).
test(orders_to_an_agent_circling_three_processes) :-
    there(H, B, C),
    collector([(main :- round, main)], [B,C,H], A, []),
    forall(between(1, 10, I),
           ( atom_concat(p, I, P),
             payload_attach(A, payload(P, [], [])),
             payload_detach(A, P),
             once(agent_property(A, hops(_))) )),
    disposed(A).

:- end_tests(processes).

reported(Peer, Agent) :-
    peer_messages(Peer, Lines),
    member(Line, Lines),
    sub_string(Line, _, _, _, Agent),
    !.

:- begin_tests(messages_between_processes,
               [setup(world_start), cleanup(world_end)]).

test(messages_arrive_in_order, true(Ns == Sent)) :-
    numlist(1, 2000, Sent),
    there(_, B, _),
    collector([], [], A, [host(B)]),
    forall(member(N, Sent), agent_send(A, N)),
    gets(A, 2000, Ns).
test(messages_are_answered, true(O == done)) :-
    there(_, B, _),
    create([(on_message(W, ask(X)) :- Y is X*2, send(W, Y))], A, [host(B)]),
    create([(main :- s(Other), send(Other, ask(21)), receive(Other-42))], C,
           [facts([s(A)])]),
    joined(C, O),
    disposed(A).

%   The move is over when the agent's home, this process, is notified: earlier
%   messages go by way of beta, and may be overtaken.

test(messages_reach_an_agent_that_moved_away, true(Ns == [1,2,3])) :-
    there(_, B, C),
    collector([(main :- round)], [B,C], A, []),
    wait_until(whereabouts(A, C), 10),
    forall(member(N, [1,2,3]), agent_send(A, N)),
    gets(A, 3, Ns).

%   From a process without its location, and by hints that are right or not.

test(messages_find_an_agent,
     [ forall(member(Way, [from(gamma),hint(alpha),hint(beta),hint(gamma)])),
       true(Ns == [1]) ]) :-
    there(_, B, _),
    collector([(main :- round)], [B], A, []),
    wait_until(stands(A, B), 10),
    (   Way = from(Peer)
    ->  peer_do(Peer, agent_send(A, 1))
    ;   Way = hint(Hint),
        ( Hint == alpha -> H = alpha ; peer_host(Hint, H) ),
        agent_send(at(A, H), 1)
    ),
    gets(A, 1, Ns).
test(moving_agent_gets_each_message_once, true(N == 1500)) :-
    there(H, B, C),
    collector([(main :- ( receive(_-stop, 0) -> true ; round, main ))],
              [B,C,H], A, []),
    forall(member(P, [beta,gamma]),
           peer_do(P, send_in_background(A, 500))),
    forall(between(1, 500, I), agent_send(A, n(I))),
    agent_send(A, stop),
    gets(A, 1500, Ms),
    findall(I, member(n(I), Ms), Is),
    length(Is, N),
    sort(Is, Set),
    assertion(length(Set, 500)).
test(message_to_an_ended_agent_is_dropped_silently) :-
    there(_, B, _),
    create([main], A, [host(B)]),
    joined(A, done),
    agent_send(A, hello),
    peer_do(beta, true),
    \+ reported(beta, A).
test(message_to_unknown_agent_is_reported_where_it_was_sent) :-
    there(_, _, C),
    atom_concat('x.1.2@', C, A),
    peer_do(beta, agent_send(A, hello)),
    wait_until(reported(beta, A), 10),
    \+ reported(gamma, A).

:- end_tests(messages_between_processes).

%   gives(-Result, -Term, -Goal, ?H, ?B): the instances of Term for which Goal is
%   true, or its error. H is the host of this process, B another.

gives([3-B], X-Y, remote(B, ( X is 1+2, here(Y) )), _, B).
gives([], x, remote(B, fail), _, B).
gives([1], X, remote(B, member(X, [1,2])), _, B).
gives(type_error(evaluable, foo/0), x, remote(B, _ is foo), _, B).
gives(oops(1), x, remote(B, throw(oops(1))), _, B).
gives(_, x, remote(B, ( current_output(S), throw(error(foo(S), _)) )), _, B).
gives(type_error(mobile_term, _), x, remote(B, current_output(_)), _, B).
gives(type_error(mobile_term, _), x, ( current_output(S), remote(B, write(S, x)) ),
      _, B).
gives([x], x, ( remote(B, X = Y), X == Y ), _, B).
gives([1], X, ( remote(B, leave(p(1))), remote(B, take(p(X))) ), _, B).
gives([H], X, remote(B, typhon:remote(H, here(X))), H, B).
gives([running-B], X-Y, ( host_property(B, state(X)),
                          host_property(B, address(Y)) ), _, B).

:- begin_tests(hosts_of_other_processes,
               [setup(world_start), cleanup(world_end)]).

test(goals_on_a_host_of_another_process,
     [forall(gives(Result, Term, Goal, H, B)), true(Given = Result)]) :-
    there(H, B, _),
    catch(findall(Term, Goal, Given), Error, true),
    ( nonvar(Error), Error = error(Formal, _) -> Given = Formal ; Given = Error ).
test(remote_from_many_threads, true(N == 100)) :-
    there(_, B, _),
    numlist(1, 100, Is),
    concurrent_maplist([I]>>remote(B, leave(i(I))), Is),
    remote(B, aggregate_all(count, sense(i(_)), N)).
test(remote_after_a_restart_of_the_process,
     true(E = connection_lost(D))) :-
    test_peers:start(delta),
    peer_host(delta, D),
    thread_create(( catch(remote(D, ( leave(busy), repeat, fail )),
                          error(E0, _), true),
                    thread_exit(E0) ), T),
    wait_until(peer_do(delta, remote(delta, sense(busy))), 10),
    peer_kill(delta),
    peer_restart(delta),
    thread_join(T, exited(E)).

neighbours([A,B], [NsA,NsB]) :-
    host_property(A, neighbours(NsA)),
    host_property(B, neighbours(NsB)).

test(link, [forall(member(Here, [alpha,gamma])), true(Ls == [[[B],[A]],[[],[]]])]) :-
    there(H, B, C),
    ( Here == alpha -> A = H, Name = alpha ; A = C, Name = C ),
    link(Name, B),
    neighbours([A,B], Linked),
    unlink(B, A),
    neighbours([A,B], Unlinked),
    Ls = [Linked,Unlinked].
test(failed_link_is_removed_on_both_sides,
     [ forall(missing_host(Missing)),
       true(Errors-Ns == [E,E,E,E]-[[],[]]) ]) :-
    there(H, B, _),
    E = existence_error(host, Missing),
    findall(Error,
            ( member(X-Y, [H-Missing,Missing-H,B-Missing,Missing-B]),
              catch(link(X, Y), error(Error, _), true) ),
            Errors),
    neighbours([H,B], Ns).
test(unlink_from_an_unreachable_host, [ forall(member(Way, [to,from])),
                                        true(L == []) ]) :-
    address(alpha, H),
    Gone = 'x@127.0.0.1:1',
    typhon_hosts:host_link(alpha, Gone, same),
    ( Way == to -> A-B = H-Gone ; A-B = Gone-H ),
    catch(unlink(A, B), error(host_unreachable(Gone), _), true),
    host_property(H, neighbours(L)).

:- end_tests(hosts_of_other_processes).

:- begin_tests(peers_that_hang).

%   The stop waits for the other process as long as its setting says, and no
%   longer. Agents in doubt are reported then, and no process is queried any
%   more.

test(host_stop_with_a_hanging_peer, true((soon(Seconds, 20), Errors == []))) :-
    with_settings([ typhon_hosting:stop_seconds=0.2,
                    typhon_endpoint:flush_time=0.2 ],
                  no_leaks(with_peers([beta],
                                      stop_beside_a_hanging_one(Seconds,
                                                                Errors)))).

stop_beside_a_hanging_one(Seconds, Errors) :-
    host_start(alpha),
    peer_host(beta, B), address(alpha, A),
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

:- begin_tests(orders).

%   Networks are often started in the setup of a cleanup, where a wait that
%   expires may not end.

test(wait_for_an_order_is_cut_only_to_watch_the_processes,
     [ forall(member(Watch-Waits, [ (typhon_nodes:unwatched)-[60],
                                    (=([1]))-[1] ])),
       Seconds == Waits ]) :-
    setup_call_cleanup(
        assertz(typhon_nodes:up(n, 1, '127.0.0.1:1', 0)),
        awaited(Watch, Seconds),
        typhon_nodes:nodes_forget(n)).

%   awaited(+Watch, -Waits): Waits are the lengths of the waits for an answer,
%   which comes during the first, in seconds.

awaited(Watch, Waits) :-
    message_queue_create(Asked),
    message_queue_create(Waited),
    setup_call_cleanup(
        ( wrap_predicate(typhon_nodes:ask(_, _, OnAnswer), held, _,
                         thread_send_message(Asked, OnAnswer)),
          wrap_predicate(typhon_monotonic:wait_within(Left, _), seen, Wait,
                         ( thread_send_message(Waited, Left),
                           thread_get_message(Asked, Answers),
                           call(Answers, done),
                           Wait )) ),
        typhon_nodes:nodes_ask(n, [1], alive, 60, Watch, [1-done]),
        ( unwrap_predicate(typhon_nodes:ask/3, held),
          unwrap_predicate(typhon_monotonic:wait_within/2, seen) )),
    fifo_empty(Waited, Exact),
    maplist([S, W]>>(W is round(S)), Exact, Waits),
    maplist(message_queue_destroy, [Asked, Waited]).

:- end_tests(orders).
