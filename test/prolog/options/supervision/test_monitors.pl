:- module(test_monitors, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/cutting_proxy', [proxy_cut/1]).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon)).

/** <module> Monitors: an agent gets one message when another ends

*Threading*: one test at a time; agent_monitor/2 calls its goals in workers.
*/

%   A monitoring agent stores its messages in s/1, from `system` or others.

watcher(Clauses, [ (on_message(system, M) :- assertz(s(M))),
                   (on_message(user, monitor(A)) :- monitor(A),
                                                   assertz(r(A))),
                   (on_message(user, shared(A)) :-
                        monitor(A, [shared(true)]), assertz(r(A))),
                   (on_message(user, unmonitor(A)) :- unmonitor(A),
                                                      retractall(r(A))),
                   (on_message(user, move(H)) :- move(H))
                 | Clauses ]).

watcher(Id, Clauses, Options) :-
    watcher(Clauses, All),
    create(All, Id, Options).

%   monitors(+Watcher, +Agent): the order was executed.

monitors(W, A) :-
    agent_send(W, monitor(A)),
    set(W, A).

shares(W, A) :-
    agent_send(W, shared(A)),
    set(W, A).

set(W, A) :-
    wait_until(( agent_property(W, facts(Facts)), memberchk(r(A), Facts) ),
               10).

unmonitors(W, A) :-
    agent_send(W, unmonitor(A)),
    wait_until(( agent_property(W, facts(Facts)),
                 \+ memberchk(r(A), Facts) ), 10).

received(W, Messages) :-
    agent_property(W, facts(Facts)),
    findall(M, member(s(M), Facts), Messages).

receives(W, Message) :-
    wait_until(( received(W, Ms), memberchk(Message, Ms) ), 20).

%   No other message has arrived when the report about another agent does,
%   whose monitor began later.

once_only(W, Message) :-
    receives(W, Message),
    receives_other(W, Other),
    received(W, Ms),
    Ms == [Message, Other].

receives_other(W, down(B, done)) :-
    sleeper(B, []),
    monitors(W, B),
    ends(B, true),
    receives(W, down(B, done)).

sleeper(Id, Options) :-
    create([(main :- receive(_-end(How)), call(How))], Id, Options).

ends(A, How) :-
    agent_send(A, end(How)).

:- begin_tests(monitors).

test(outcomes_are_reported, [forall(member(How-Outcome,
                                           [ true-done, fail-failed,
                                             throw(oops)-raised(oops),
                                             dispose_now-disposed ]))]) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 (   How == dispose_now
                 ->  agent_dispose(A)
                 ;   capturing(( ends(A, How), joined(A, _) ), _)
                 ),
                 once_only(W, down(A, Outcome)) )).
test(monitored_after_its_end) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 create([(main :- true)], A),
                 joined(A, done),
                 monitors(W, A),
                 once_only(W, down(A, done)) )).
test(several_reports_are_one_message) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 findall(typhon_monitors:down(A, done), between(1, 4, _),
                         Reports),
                 concurrent(4, Reports, []),
                 once_only(W, down(A, done)) )).
test(unknown_agent) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 address(alpha, H),
                 atom_concat('unknown.x.1@', H, A),
                 monitors(W, A),
                 once_only(W, down(A, unknown)) )).
test(invalid_id, F == existence_error(agent, bob)) :-
    with_hosts([alpha],
               ( create([ (main :- catch(monitor(bob), error(F0, _), true),
                                   result(F0)) ], A),
                 agent_result(A, F, 10) )).
test(wrong_option, F = domain_error(monitor_option, _)) :-
    with_hosts([alpha],
               ( create([ (main :- self(A),
                                   catch(monitor(A, [hot(true)]), error(F0, _),
                                         true),
                                   result(F0)) ], A),
                 agent_result(A, F, 10) )).
test(follower_ends_with_its_parent,
     [ forall(member(How-Outcome, [throw(oops)-disposed, true-done])),
       Ended == Outcome ]) :-
    with_hosts([alpha],
               ( agent_create(clauses([ (:- agent(parent, [state([child/1])])),
                                        (main :- Child = clauses(
                                                   [ (:- agent(child, [])),
                                                     (main :- receive(_-end)) ]),
                                                 create(Child, C0,
                                                        [follows(true)]),
                                                 assertz(child(C0)),
                                                 receive(_-end(G)), call(G)) ]),
                              P),
                 wait_until(agent_property(P, facts([child(C)])), 10),
                 capturing(( ends(P, How), joined(P, _) ), _),
                 ( How == true -> agent_send(C, end) ; true ),
                 joined(C, Ended) )).
test(follower_that_moves_before_its_first_turn, O == disposed) :-
    with_hosts([alpha, beta],
               ( create([ (main :- create(clauses([ (:- agent(c, [])),
                                                    (on_message(_, _)) ]),
                                          C0, [follows(true)]),
                                   assertz(r(C0)), receive(_-_)) ], P),
                 wait_until(( agent_property(P, facts([r(C)])),
                              agent_property(C, state(resident)) ), 10),
                 agent_move(C, beta, [wait(5)]),
                 agent_dispose(P),
                 joined(C, O) )).
test(followers_are_listed, Cs == [C]) :-
    with_hosts([alpha],
               ( create([ (main :- Child = clauses([ (:- agent(c, [])),
                                                     (main :- receive(_)) ]),
                                   create(Child, _, []),
                                   create(Child, C0, [follows(true)]),
                                   followers(Ds),
                                   result(Ds-C0)) ], P),
                 agent_result(P, Cs-C, 10) )).
test(follower_of_a_guarded_host, O == disposed) :-
    with_hosts([alpha-[policy(guarded), cell(none)]],
               ( create([ (main :- create(clauses([ (:- agent(c, [])),
                                                    (main :- receive(_)) ]),
                                          C0, [follows(true)]),
                                   assertz(r(C0)), receive(_-_)) ], P),
                 wait_until(agent_property(P, facts([r(C)])), 10),
                 agent_dispose(P),
                 joined(C, O) )).
test(monitoring_twice_reports_once) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 agent_send(W, monitor(A)),
                 wait_until(( agent_property(W, facts(Facts)),
                              findall(x, member(r(A), Facts), [_,_]) ), 10),
                 ends(A, true),
                 once_only(W, down(A, done)) )).
test(unmonitor_ends_reports, Ms == [Other]) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 unmonitors(W, A),
                 ends(A, true),
                 joined(A, done),
                 receives_other(W, Other),
                 received(W, Ms) )).
test(monitored_again_after_unmonitor) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 unmonitors(W, A),
                 monitors(W, A),
                 ends(A, true),
                 once_only(W, down(A, done)) )).
test(monitored_by_many, Count == 50) :-
    with_hosts([alpha],
               ( sleeper(A, []),
                 findall(W, ( between(1, 50, _), watcher(W, [], []) ), Ws),
                 forall(member(W, Ws), agent_send(W, monitor(A))),
                 forall(member(W, Ws), set(W, A)),
                 ends(A, true),
                 forall(member(W, Ws), receives(W, down(A, done))),
                 aggregate_all(count,
                               ( member(W, Ws), received(W, [down(A, done)]) ),
                               Count) )).
test(faulty_agent_is_reported_once, [true(Ms == [down(A, failed), Other])]) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 create([ (main :- receive(_-end(_)), s(_)) ], A),
                 monitors(W, A),
                 capturing(( ends(A, true), joined(A, failed) ), _),
                 receives(W, down(A, failed)),
                 agent_change(A, facts([s(1)])),
                 agent_resume(A),
                 joined(A, done),
                 receives_other(W, Other),
                 received(W, Ms) )).
test(both_agents_move) :-
    with_hosts([alpha, beta],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 monitors(W, A),
                 address(beta, Beta),
                 agent_move(A, Beta, [wait(5)]),
                 agent_move(W, Beta, [wait(5)]),
                 ends(A, true),
                 once_only(W, down(A, done)) )).
test(report_is_received, X == done) :-
    with_hosts([alpha],
               ( create([ (main :- create(clauses([(:- agent(c, [])),
                                                   (main :- sleep(0.1))]),
                                          C, []),
                                   monitor(C),
                                   receive(system-down(C, O)),
                                   result(O)) ], A),
                 agent_result(A, X, 10) )).
test(monitors_in_virtual_time, X == done-5.0) :-
    with_hosts([alpha-[clock(virtual)]],
               ( create([ (main :- now(T0),
                                   create(clauses([(:- agent(c, [])),
                                                   (main :- sleep(5.0))]),
                                          C, []),
                                   monitor(C),
                                   receive(system-down(C, O)),
                                   now(T), D is T-T0,
                                   result(O-D)) ], A),
                 agent_result(A, X, 10) )).
test(monitors_on_a_guarded_host, X == done) :-
    with_hosts([alpha-[policy(guarded), cell(none)]],
               ( create([ (main :- create(clauses([(:- agent(c, [])),
                                                   (main :- true)]),
                                          C, []),
                                   monitor(C),
                                   receive(system-down(C, O)),
                                   result(O)) ], A),
                 agent_result(A, X, 10) )).

:- end_tests(monitors).

:- begin_tests(shared_fate).

test(watcher_ends_with_the_agent, O == disposed) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 shares(W, A),
                 agent_dispose(A),
                 joined(W, O) )).
test(agent_ends_with_the_watcher, O == disposed) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 shares(W, A),
                 agent_dispose(W),
                 joined(A, O) )).
test(follower_gets_no_message, Ms == [Other]) :-
    with_hosts([alpha],
               ( watcher(W, [ (on_message(user, follows(A)) :-
                                  monitor(A, [shared(self)]),
                                  assertz(r(A))) ], []),
                 sleeper(A, []),
                 agent_send(W, follows(A)),
                 set(W, A),
                 ends(A, true),
                 joined(A, done),
                 receives_other(W, Other),
                 received(W, Ms) )).
test(outcome_done_is_reported) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 shares(W, A),
                 ends(A, true),
                 once_only(W, down(A, done)) )).
test(unmonitor_ends_shared_fate) :-
    with_hosts([alpha],
               ( watcher(W, [], []),
                 sleeper(A, []),
                 shares(W, A),
                 unmonitors(W, A),
                 agent_dispose(A),
                 receives_other(W, _),
                 agent_property(W, state(resident)),
                 sleeper(B, []),
                 sleeper(C, []),
                 shares(W, B),
                 unmonitors(W, B),
                 shares(W, C),
                 agent_dispose(W),
                 joined(C, disposed),
                 agent_property(B, state(waiting)) )).

:- end_tests(shared_fate).

:- begin_tests(agent_monitor).

:- dynamic down/2.

note(A, O) :-
    assertz(down(A, O)).

reported(A, O) :-
    wait_until(down(A, O), 20).

forget :-
    retractall(down(_, _)).

test(agent_of_this_process, [cleanup(forget)]) :-
    with_hosts([alpha],
               ( sleeper(A, [name(bob)]),
                 agent_monitor(bob, note),
                 ends(A, true),
                 reported(A, done) )).
test(goal_with_two_solutions_is_called_once,
     [cleanup(forget), true(Notes == [first])]) :-
    with_hosts([alpha],
               ( sleeper(A, []),
                 agent_monitor(A, [Id,_]>>( member(N, [first,second]),
                                            note(Id, N) )),
                 ends(A, true),
                 reported(A, first) )),
    findall(N, down(A, N), Notes).
test(goal_that_raises, [cleanup(forget)]) :-
    with_hosts([alpha],
               ( sleeper(A, []),
                 agent_monitor(A, no_such_predicate),
                 agent_monitor(A, note),
                 capturing(( ends(A, true), reported(A, done),
                             wait_until(was_printed(_, _), 5) ), _) )).
test(no_such_agent, error(existence_error(agent, unknown))) :-
    with_hosts([alpha], agent_monitor(unknown, note)).
test(guest_monitors_an_agent_of_another_process, [cleanup(forget)]) :-
    no_leaks(with_peers([p1],
                 ( peer_host(p1, There),
                   sleeper(A, [host(There)]),
                   agent_monitor(A, note),
                   ends(A, true),
                   reported(A, done) ))).
test(agent_lost_with_its_process, [cleanup(forget), true(H == There)]) :-
    no_leaks(with_peers([p1],
                 ( peer_host(p1, There),
                   sleeper(A, [host(There)]),
                   sleeper(B, [host(There)]),
                   agent_monitor(A, note),
                   agent_monitor(B, note),
                   ends(B, true),
                   reported(B, done),
                   peer_kill(p1),
                   reported(A, lost(H)) ))).

:- end_tests(agent_monitor).

%   Watchers and agents in two processes, and in this one.

:- begin_tests(monitors_of_processes).

%   Leaks are checked after the processes have ended.

:- meta_predicate here(0).

here(Goal) :-
    setup_call_cleanup(host_start(alpha), once(Goal), host_stop(alpha)).

test(agents_and_watchers_in_each_process,
     [forall(member(Wh-Ah, [here-p1, p1-here, p1-p2, p1-p1]))]) :-
    no_leaks(with_peers([p1, p2],
        here(
            ( at(Wh, WHost), at(Ah, AHost),
              watcher(W, [], [host(WHost)]),
              sleeper(A, [host(AHost)]),
              monitors(W, A),
              ends(A, true),
              once_only(W, down(A, done)) )))).

at(here, Host) :-
    !,
    address(alpha, Host).
at(Peer, Host) :-
    peer_host(Peer, Host).

%   An agent that was created at p1, and runs here, shares its fate with
%   another one there: p1 would end that one for this process.

test(shared_fate_needs_the_right_to_give_orders,
     [ forall(member(Rights-Expected,
                     [ [agents,messages,watch]-(refused-resident),
                       [agents,messages,watch,orders]-(monitored-gone) ])),
       Said-State == Expected ]) :-
    no_leaks(with_peers(
        [p1-[host([peer([cookie-Rights])])]],
        here(shared_from_here(p1, Said, State)))).

shared_from_here(Peer, Said, State) :-
    address(alpha, Here),
    Victim = clauses([(:- agent(victim, [])), on_message(_, _)]),
    Sharer = clauses([ (:- agent(sharer, [state([with/2, said/1])])),
                       (main :- with(V, Host), move(Host),
                                catch(( monitor(V, [shared(agent)]),
                                        S = monitored ),
                                      error(_, _), S = refused),
                                assertz(said(S)), receive(_-end), fail) ]),
    peer_do(Peer, agent_create(Victim, V)),
    peer_do(Peer, agent_create(Sharer, A, [facts([with(V, Here)])])),
    wait_until(( agent_property(A, facts(Facts)),
                 memberchk(said(Said), Facts) ), 20),
    capturing(( agent_send(A, end), joined(A, failed) ), _),
    (   Said == monitored
    ->  peer_do(Peer, agent_join(V, disposed, 10)),
        State = gone
    ;   peer_do(Peer, agent_property(V, state(State)))
    ).

test(both_agents_move, [nondet]) :-
    no_leaks(with_peers([p1, p2],
        here(
            ( at(p1, H1), at(p2, H2),
              watcher(W, [], []),
              sleeper(A, []),
              agent_move(W, H1, [wait(5)]),
              monitors(W, A),
              agent_move(A, H2, [wait(5)]),
              agent_move(W, H2, [wait(5)]),
              agent_move(A, H1, [wait(5)]),
              ends(A, true),
              once_only(W, down(A, done)) )))).
test(agent_lost_with_its_home, [nondet]) :-
    no_leaks(with_peers([p1],
        here(
            ( at(p1, H1),
              watcher(W, [], []),
              sleeper(A, [host(H1)]),
              sleeper(B, [host(H1)]),
              monitors(W, A),
              monitors(W, B),
              ends(B, true),
              receives(W, down(B, done)),
              peer_kill(p1),
              receives(W, down(A, lost(H1))),
              receives_other(W, Other),
              received(W, Ms),
              assertion(Ms == [down(B, done), down(A, lost(H1)), Other]) )))).
test(agent_away_when_its_home_dies, [nondet]) :-
    no_leaks(with_peers([p1, p2, p3],
        here(
            ( at(p1, H1), at(p2, H2), at(p3, H3),
              link(alpha, H3),
              peer_do(p3, link(p3, H2)),
              watcher(W, [], []),
              sleeper(A, [host(H1)]),
              sleeper(B, [host(H1)]),
              monitors(W, A),
              agent_move(A, H2, [wait(5)]),
              agent_move(B, H2, [wait(5)]),
              peer_kill(p1),
              once_only(W, down(A, lost(H1))),
              assertion(\+ peer_do(p2, typhon_agents:agent_on(A, _))),
              assertion(peer_do(p2, typhon_agents:agent_on(B, _))) )))).
test(agent_lost_in_a_dead_process, [nondet]) :-
    no_leaks(with_peers([p1],
        here(
            ( at(p1, H1),
              watcher(W, [], []),
              sleeper(A, []),
              monitors(W, A),
              agent_move(A, H1, [wait(5)]),
              peer_kill(p1),
              once_only(W, down(A, lost(H1))) )))).
test(agent_lost_in_a_third_process, [nondet]) :-
    no_leaks(with_peers([p1, p2, p3],
        here(
            ( at(p1, H1), at(p2, H2), at(p3, H3),
              watcher(W, [], [host(H3)]),
              sleeper(A, [host(H1)]),
              monitors(W, A),
              agent_move(A, H2, [wait(5)]),
              peer_kill(p2),
              once_only(W, down(A, lost(H2))) )))).
test(agent_that_hopped_on_is_not_lost, [nondet]) :-
    no_leaks(with_peers([p1, p2],
        here(
            ( at(p1, H1), at(p2, H2),
              watcher(W, [], []),
              sleeper(A, []),
              sleeper(B, [host(H1)]),
              monitors(W, A),
              monitors(W, B),
              agent_move(A, H1, [wait(5)]),
              agent_move(A, H2, [wait(5)]),
              peer_kill(p1),
              receives(W, down(B, lost(H1))),
              ends(A, true),
              receives(W, down(A, done)),
              received(W, Ms),
              assertion(Ms == [down(B, lost(H1)), down(A, done)]) )))).
test(process_restarted_at_the_same_address, [nondet]) :-
    no_leaks(with_peers([p1],
        here(
            ( at(p1, H1),
              watcher(W, [], []),
              sleeper(A, [host(H1)]),
              monitors(W, A),
              peer_kill(p1),
              peer_restart(p1),
              once_only(W, down(A, lost(H1))) )))).
test(orderly_stop, [nondet]) :-
    no_leaks(with_peers([p1],
        here(
            ( at(p1, H1),
              watcher(W, [], []),
              sleeper(A, [host(H1)]),
              monitors(W, A),
              peer_do(p1, host_stop(p1)),
              wait_until(received(W, [_]), 20),
              received(W, [down(A, O)]),
              assertion(memberchk(O, [disposed, lost(H1)])) )))).
test(shared_fate_with_an_agent_of_a_dying_process, [nondet]) :-
    no_leaks(with_peers([p1],
        here(
            ( at(p1, H1),
              watcher(W, [], [host(H1)]),
              sleeper(A, []),
              shares(W, A),
              receives_other(W, _),
              peer_kill(p1),
              joined(A, O),
              assertion(O == disposed) )))).
%   The parent's home dies before it creates the child, which only the parent
%   knows.

test(child_of_a_parent_without_a_home, [nondet]) :-
    no_leaks(with_peers([p1, p2],
        here(
            ( at(p1, H1), at(p2, H2),
              create([ (main :- receive(_-to(H)),
                                catch(create(clauses([(:- agent(c, [])),
                                                      (main :- receive(_))]),
                                             _, [host(H), name(left),
                                                 follows(true)]),
                                      error(E, _), true),
                                assertz(r(E)), receive(_)) ],
                     P, [host(H1)]),
              address(alpha, Here),
              agent_move(P, Here, [wait(5)]),
              peer_kill(p1),
              agent_send(P, to(H2)),
              wait_until(\+ typhon_agents:agent(P, _, _, _, _), 20),
              wait_until(\+ peer_do(p2, ( typhon_agents:agent(Id, _, _, _, _),
                                          sub_atom(Id, 0, _, _, 'left.') )),
                         20) )))).
test(broken_connection, [nondet]) :-
    no_leaks(with_peers([p1-[proxy(true)]],
        here(
            ( at(p1, H1),
              watcher(W, [], []),
              sleeper(A, [host(H1)]),
              monitors(W, A),
              peer_proxy(p1, Proxy),
              sleeper(B, [host(H1)]),
              proxy_cut(Proxy),
              monitors(W, B),
              ends(B, true),
              receives(W, down(B, done)),
              ends(A, true),
              receives(W, down(A, done)),
              received(W, Ms),
              assertion(Ms == [down(B, done), down(A, done)]) )))).

:- end_tests(monitors_of_processes).

%   With a journal a monitor survives the processes of both.

:- begin_tests(monitors_in_the_journal, [condition(missing([journal], []))]).

lasting(Dir) :-
    findall(P-[host([journal(J)])],
            ( member(P, [p1, p2]), atomic_list_concat([Dir, /, P], J) ),
            Specs),
    with_peers(Specs, lasts).

lasts :-
    setup_call_cleanup(host_start(alpha), both_die, host_stop(alpha)).

both_die :-
    peer_host(p1, H1),
    peer_host(p2, H2),
    watcher(W, [], [host(H1)]),
    sleeper(A, [host(H2)]),
    sleeper(B, [host(H2)]),
    monitors(W, A),
    monitors(W, B),
    peer_kill(p1),
    peer_kill(p2),
    peer_restart(p2),
    wait_until(agent_property(A, state(waiting)), 20),
    ends(A, true),
    joined(A, done),
    peer_restart(p1),
    wait_until(agent_property(W, state(resident)), 20),
    once_only(W, down(A, done)),
    ends(B, true),
    receives(W, down(B, done)).

%   The goals of agent_monitor/2 end with their process: the next process does
%   not call them.

goals_end(Dir) :-
    atomic_list_concat([Dir, /, p1], J),
    with_peers([p1-[host([journal(J)])]], goals_end).

goals_end :-
    setup_call_cleanup(host_start(alpha), monitored_again, host_stop(alpha)).

monitored_again :-
    sleeper(A, []),
    sleeper(B, []),
    monitored_by_peer(A),
    peer_kill(p1),
    peer_restart(p1),
    monitored_by_peer(B),
    ends(A, true),
    joined(A, done),
    ends(B, true),
    wait_until(peer_do(p1, user:down(B)), 20),
    \+ peer_do(p1, user:down(A)).

monitored_by_peer(A) :-
    peer_do(p1, dynamic(user:down/1)),
    peer_do(p1, agent_monitor(A, [Id,_]>>assertz(user:down(Id)))),
    peer_do(p1, ( agent_create(clauses([(:- agent(x, [])), main]), X),
                  agent_join(X, done, 10) )).     % so that all is committed

test(monitoring_goals_end_with_their_process, [nondet]) :-
    no_leaks(with_tmp_dir(goals_end)).
test(both_processes_die, [nondet]) :-
    no_leaks(with_tmp_dir(lasting)).

:- end_tests(monitors_in_the_journal).
