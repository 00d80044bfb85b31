:- module(test_monitors, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/cutting_proxy', [proxy_cut/1]).
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).

/** <module> Monitors: an agent gets one message when another ends

*Threading*: one test at a time; agent_monitor/2 calls its goals in workers.
*/

%   A watcher stores its messages from `system`, and executes orders.

watcher(Id, Options) :-
    create([ (on_message(system, M) :- assertz(s(M))),
             (on_message(user, do(N, G)) :- call(G), assertz(r(N))) ],
           Id, Options).

order(W, Goal) :-
    flag(test_monitors_order, N, N+1),
    agent_send(W, do(N, Goal)),
    wait_until(fact_of(W, r(N)), 10).

sleeper(Id, Options) :-
    create([(main :- receive(_-end(How)), call(How))], Id, Options).

monitors(W, A) :-
    order(W, monitor(A)).

ends(A, How) :-
    agent_send(A, end(How)).

receives(W, Message) :-
    wait_until(fact_of(W, s(Message)), 20).

%   Earlier reports have arrived.

in_sync(W) :-
    sleeper(B, []),
    monitors(W, B),
    ends(B, true),
    receives(W, down(B, done)).

                /*******************************
                *            STORIES           *
                *******************************/

%   story(-Name, -Places, -Steps): what happens to a watcher w, and agents a,
%   b and c, which begin in this process, if Places names no peer for them.
%   only(Reports) are all reports about them that w has.

story(outcome(How), [], [monitor(a), end(a, How), only([a-Outcome])]) :-
    member(How-Outcome,
           [true-done, fail-failed, throw(oops)-raised(oops)]).
story(disposed, [], [monitor(a), dispose(a), only([a-disposed])]).
story(monitored_after_its_end, [], [end(a), monitor(a), only([a-done])]).
story(monitored_twice, [],
      [monitor(a), monitor(a), end(a), only([a-done])]).
story(unmonitored, [], [monitor(a), unmonitor(a), end(a), only([])]).
story(monitored_again, [],
      [monitor(a), unmonitor(a), monitor(a), end(a), only([a-done])]).
story(also_by_another_watcher, [],
      [monitor(a), end(a), gets(a, done), watch(a), only([a-done])]).
story(resumed, [],
      [monitor(a), end(a, s(_)), gets(a, failed), resume(a), only([a-failed])]).
story(shares_its_end, [], [share(a), dispose(a), ended(w, disposed)]).
story(shares_the_end_of_its_watcher, [],
      [share(a), dispose(w), ended(a, disposed)]).
story(done_ends_no_other, [], [share(a), end(a), only([a-done])]).
story(follower_gets_no_message, [], [follow(a), end(a), only([])]).
story(unmonitor_ends_shared_fate, [],
      [ share(a), unmonitor(a), dispose(a), only([]), state(w, resident),
        share(b), unmonitor(b), share(c), dispose(w), ended(c, disposed),
        state(b, waiting) ]).
story(in_processes(W, A), [w-W, a-A], [monitor(a), end(a), only([a-done])]) :-
    member(W-A, [here-p1, p1-here, p1-p2, p1-p1]).
story(both_move, [],
      [ w/p1, monitor(a), a/p2, w/p2, a/p1, end(a), only([a-done]) ]).
story(lost_with_its_home, [a-p1, b-p1],
      [ monitor(a), monitor(b), end(b), gets(b, done), kill(p1),
        only([b-done, a-lost(p1)]) ]).
story(away_when_its_home_dies, [a-p1, b-p1],
      [ link(here, p3), link(p3, p2), monitor(a), a/p2, b/p2, kill(p1),
        only([a-lost(p1)]), gone_from(p2, a), is_on(p2, b) ]).
story(lost_in_a_dead_process, [],
      [monitor(a), a/p1, kill(p1), only([a-lost(p1)])]).
story(monitored_after_the_end_of_its_process, [],
      [ monitor(b), a/p1, b/p1, kill(p1), gets(b, lost(p1)), monitor(a),
        only([b-lost(p1), a-lost(p1)]) ]).
story(lost_in_a_third_process, [w-p3, a-p1],
      [monitor(a), a/p2, kill(p2), only([a-lost(p2)])]).
story(hopped_on, [b-p1],
      [ monitor(a), monitor(b), a/p1, a/p2, kill(p1), gets(b, lost(p1)),
        end(a), only([b-lost(p1), a-done]) ]).
story(restarted_at_the_same_address, [a-p1],
      [monitor(a), kill(p1), restart(p1), only([a-lost(p1)])]).
story(orderly_stop, [a-p1], [monitor(a), stop(p1), disposed_or_lost(a, p1)]).
story(shares_the_end_of_a_process, [w-p1],
      [ share(a), monitor(b), end(b), gets(b, done), kill(p1),
        ended(a, disposed) ]).
story(broken_connection, [a-p1, b-p1],
      [ monitor(a), cut(p1), monitor(b), end(b), gets(b, done), end(a),
        only([b-done, a-done]) ]).

happens(Places, Steps) :-
    findall(Peer, ( member(P, [p1, p2, p3]), occurs(P, Places-Steps),
                    ( occurs(cut(P), Steps) -> Peer = P-[proxy(true)]
                    ; Peer = P ) ), Peers),
    happens(Peers, Places, Steps).

happens(Peers, Places, Steps) :-
    no_leaks(with_peers(Peers, here(capturing(happens_to(Places, Steps), _)))).

occurs(Part, Term) :-
    sub_term(Part0, Term),
    Part0 == Part,
    !.

%   Leaks are checked after the processes have ended.

:- meta_predicate here(0).

here(Goal) :-
    setup_call_cleanup(host_start(alpha), once(Goal), host_stop(alpha)).

happens_to(Places, Steps) :-
    findall(Name-Id,
            ( member(Name, [w, a, b, c]),
              ( Name == w -> true ; occurs(Name, Steps) ),
              ( memberchk(Name-P, Places) -> true ; P = here ),
              at(P, Host),
              ( Name == w -> watcher(Id, [host(Host)])
              ; sleeper(Id, [host(Host)]) ) ),
            Ids),
    forall(member(Step, Steps),
           ( step(Step, Ids) -> true ; throw(failed_at(Step)) )).

at(here, Host) :-
    !,
    address(alpha, Host).
at(Peer, Host) :-
    peer_host(Peer, Host).

step(monitor(X), Ids)   => ordered(Ids, X, A, monitor(A)).
step(share(X), Ids)     => ordered(Ids, X, A, monitor(A, [shared(true)])).
step(follow(X), Ids)    => ordered(Ids, X, A, monitor(A, [shared(self)])).
step(unmonitor(X), Ids) => ordered(Ids, X, A, unmonitor(A)).
step(watch(X), Ids) =>
    memberchk(X-A, Ids),
    watcher(V, []),
    monitors(V, A),
    receives(V, down(A, _)).
step(X/P, Ids) =>
    memberchk(X-A, Ids),
    at(P, Host),
    agent_move(A, Host, [wait(5)]).
step(end(X), Ids) => step(end(X, true), Ids).
step(end(X, How), Ids) =>
    memberchk(X-A, Ids),
    ends(A, How),
    joined(A, _).
step(dispose(X), Ids) => memberchk(X-A, Ids), agent_dispose(A).
step(resume(X), Ids) =>
    memberchk(X-A, Ids),
    agent_change(A, facts([s(1)])),
    agent_resume(A),
    joined(A, done).
step(kill(P), _)    => peer_kill(P).
step(restart(P), _) => peer_restart(P).
step(stop(P), _)    => peer_do(P, host_stop(P)).
step(cut(P), _)     => peer_proxy(P, Proxy), proxy_cut(Proxy).
step(link(here, P), _) => at(P, Host), link(alpha, Host).
step(link(P, Q), _) => at(Q, Host), peer_do(P, link(P, Host)).
step(gets(X, O), Ids) =>
    memberchk(w-W, Ids),
    report(Ids, X-O, Message),
    receives(W, Message).
step(only(Reports), Ids) =>
    memberchk(w-W, Ids),
    maplist(report(Ids), Reports, Messages),
    forall(member(M, Messages), receives(W, M)),
    in_sync(W),
    has_of_them(W, Ids, Messages).
step(ended(X, O), Ids)  => memberchk(X-A, Ids), joined(A, O).
step(state(X, S), Ids)  => memberchk(X-A, Ids), wait_state(A, S).
step(is_on(P, X), Ids)  => memberchk(X-A, Ids), on_peer(P, A).
step(gone_from(P, X), Ids) => memberchk(X-A, Ids), \+ on_peer(P, A).
step(disposed_or_lost(X, P), Ids) =>
    memberchk(w-W, Ids),
    memberchk(X-A, Ids),
    at(P, Host),
    wait_until(fact_of(W, s(_)), 20),
    member(O, [disposed, lost(Host)]),
    has_of_them(W, Ids, [down(A, O)]),
    !.

on_peer(P, Pattern) :-
    peer_do(P, ( agent_property(A, state(_)), sub_atom(A, 0, _, _, Pattern) )).

ordered(Ids, X, A, Goal) :-
    memberchk(w-W, Ids),
    memberchk(X-A, Ids),
    order(W, Goal).

report(Ids, X-O0, down(A, O)) :-
    memberchk(X-A, Ids),
    ( O0 = lost(P) -> at(P, Host), O = lost(Host) ; O = O0 ).

has_of_them(W, Ids, Messages) :-
    findall(down(A, O), ( fact_of(W, s(down(A, O))), memberchk(_-A, Ids) ),
            Messages).

:- begin_tests(monitors).

test(reports, [forall(story(Name, Places, Steps)), nondet]) :-
    ( happens(Places, Steps) -> true ; throw(story(Name)) ).
test(unknown_agent) :-
    with_hosts([alpha],
               ( watcher(W, []),
                 address(alpha, H),
                 atom_concat('unknown.x.1@', H, A),
                 monitors(W, A),
                 receives(W, down(A, unknown)) )).
test(monitor_that_cannot_be_set,
     [ forall(member(Goal-Error,
                     [ monitor(bob)-existence_error(agent, bob),
                       ( self(A), monitor(A, [hot(true)]) )
                           -domain_error(monitor_option, _) ])),
       true(subsumes_term(Error, Formal)) ]) :-
    result_on([alpha],
              [(main :- catch(Goal, error(F, _), true), result(F))], Formal).

%   A parent P and its child C, which has the clause Does.

child(Does, clauses([(:- agent(c, [])), Does])).

parent(Does, C, P) :-
    child(Does, Child),
    create([ (main :- create(Child, Id, [follows(true)]), assertz(r(Id)),
                      receive(_-end(How)), call(How)) ], P),
    wait_until(( fact_of(P, r(C)), state_of(C, State),
                 memberchk(State, [resident, waiting]) ), 10).

test(follower_ends_with_its_parent,
     [ forall(( member(Options, [[], [policy(guarded), cell(none)]]),
                member(How-Outcome, [throw(oops)-disposed, true-done]) )),
       Ended == Outcome ]) :-
    with_hosts([alpha-Options],
               ( parent((main :- receive(_-end)), C, P),
                 capturing(( ends(P, How), joined(P, _) ), _),
                 ( How == true -> agent_send(C, end) ; true ),
                 joined(C, Ended) )).
test(follower_that_moves_before_its_first_turn, O == disposed) :-
    with_hosts([alpha, beta],
               ( parent(on_message(_, _), C, P),
                 agent_move(C, beta, [wait(5)]),
                 agent_dispose(P),
                 joined(C, O) )).
test(followers_are_listed, Cs == [C]) :-
    child((main :- receive(_)), Child),
    result_on([alpha], [ (main :- create(Child, _, []),
                                  create(Child, C0, [follows(true)]),
                                  followers(Ds), result(Ds-C0)) ], Cs-C).
test(monitored_by_many, Lists == [[down(A, done)]]) :-
    with_hosts([alpha],
               ( sleeper(A, []),
                 findall(W, ( between(1, 50, _), watcher(W, []),
                              monitors(W, A) ), Ws),
                 ends(A, true),
                 forall(member(W, Ws), receives(W, down(A, done))),
                 findall(Ms, ( member(W, Ws),
                               findall(M, fact_of(W, s(M)), Ms) ), Lists0),
                 sort(Lists0, Lists) )).

%   The child is monitored until it ends, if it has not ended before.

test(report_is_received,
     [ forall(member(Options-Life, [ []-0.1, [clock(virtual)]-5.0,
                                     [policy(guarded), cell(none)]-0 ])),
       true(O == done) ]) :-
    result_on([alpha-Options],
              [ (main :- now(T0),
                         create(clauses([ (:- agent(c, [])),
                                          (main :- sleep(Life)) ]), C, []),
                         monitor(C), receive(system-down(C, O0)),
                         now(T), Took is T-T0, result(O0-Took)) ], O-Took),
    assertion(( Life == 5.0 -> Took =:= Life ; true )).

:- end_tests(monitors).

:- begin_tests(agent_monitor).

:- dynamic noted/2.

note(A, O) :-
    assertz(noted(A, O)).

is_noted(A, O) :-
    wait_until(noted(A, O), 20).

forget :-
    retractall(noted(_, _)).

test(goal_is_called_once,
     [ cleanup(forget), true(Notes == [first]) ]) :-
    with_hosts([alpha],
               ( sleeper(A, [name(bob)]),
                 agent_monitor(bob, [Id,_]>>( member(N, [first,second]),
                                              note(Id, N) )),
                 ends(A, true),
                 is_noted(A, first) )),
    findall(N, noted(A, N), Notes).
test(goal_that_raises, [cleanup(forget)]) :-
    with_hosts([alpha],
               ( sleeper(A, []),
                 agent_monitor(A, no_such_predicate),
                 agent_monitor(A, note),
                 capturing(( ends(A, true), is_noted(A, done),
                             wait_until(was_printed(_, _), 5) ), _) )).
test(no_such_agent, error(existence_error(agent, unknown))) :-
    with_hosts([alpha], agent_monitor(unknown, note)).
test(process_without_a_host, [cleanup(forget), true(H == There)]) :-
    no_leaks(with_peers([p1],
                 ( peer_host(p1, There),
                   sleeper(A, [host(There)]),
                   sleeper(B, [host(There)]),
                   agent_monitor(A, note),
                   agent_monitor(B, note),
                   ends(B, true),
                   is_noted(B, done),
                   peer_kill(p1),
                   is_noted(A, lost(H)) ))).

:- end_tests(agent_monitor).

%   Watchers and agents in two processes, and in this one.

:- begin_tests(monitors_of_processes).

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
    wait_until(fact_of(A, said(Said)), 20),
    capturing(( agent_send(A, end), joined(A, failed) ), _),
    (   Said == monitored
    ->  peer_do(Peer, agent_join(V, disposed, 10)),
        State = gone
    ;   peer_do(Peer, agent_property(V, state(State)))
    ).

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
              wait_until(\+ ( agent_property(A, state(_)), A == P ), 20),
              wait_until(\+ on_peer(p2, 'left.'), 20) )))).

:- end_tests(monitors_of_processes).

%   With a journal a monitor survives the processes of both.

:- begin_tests(monitors_in_the_journal, [condition(missing([journal], []))]).

with_journals(Ps, Peers, Dir) :-
    findall(P-[host([journal(J)])],
            ( member(P, Ps), atomic_list_concat([Dir, /, P], J) ), Peers).

both_die(Dir) :-
    with_journals([p1, p2], Peers, Dir),
    happens(Peers, [w-p1, a-p2, b-p2],
            [ monitor(a), monitor(b), kill(p1), kill(p2), restart(p2),
              state(a, waiting), end(a), restart(p1), state(w, resident),
              only([a-done]), end(b), gets(b, done) ]).

%   The goals of agent_monitor/2 end with their process: the next process does
%   not call them.

goals_end(Dir) :-
    with_journals([p1], Peers, Dir),
    with_peers(Peers, here(monitored_again)).

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
    with_tmp_dir(both_die).

:- end_tests(monitors_in_the_journal).
