:- module(test_quotas, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

/** <module> Quotas of agents, owners and hosts

*Threading*: one test at a time.
*/

%   ends(-Name, -Specs, -Clauses, -Outcome): Outcome is `done`, or the quota that
%   an agent of Clauses exceeds on the first of the hosts Specs.

ends(hops_per_second, [g-[quota([hops(20)])], t],
     [(main :- move(t), move(g), main)], hops).
ends(caught_error, [g-[quota([hops(20)])], t],
     [(main :- catch(( move(t), move(g) ), _, true), main)], hops).
ends(repeatedly_caught_error, [g-[quota([messages(20)])]],
     [(main :- repeat, catch(send(user, x), _, true), fail)], messages).
ends(slow_traveller, [g-[quota([hops(3)])], t],
     [ (main :- lap(4)), lap(0),
       (lap(N) :- move(t), move(g), sleep(0.4), M is N-1, lap(M)) ], done).
ends(clones_of_one_parent, [g-[quota([clones(5)])]],
     [ (main :- clone(W), on(W)), on(clone(_)), (on(parent(_)) :- main),
       on_message(_, _) ], clones).
ends(state_growth_of_a_visitor, [t, g-[quota([state(50 000)])]],
     [(main :- move(g), forall(between(1, 5000, X), assertz(s(X))))], state).
ends(waiting_agent, [g-[clock(virtual), quota([lifetime(100)])]],
     [(main :- receive(_))], lifetime).
ends(sleeping_agent, [g-[clock(virtual), quota([lifetime(100)])]],
     [(main :- sleep(7), main)], lifetime).
ends(running_agent, [g-[quota([lifetime(0.3)])]], [(main :- lp), (lp :- lp)],
     lifetime).
ends(lifetime_restarts_at_each_arrival,
     [g-[clock(virtual), quota([lifetime(10)])], t-[clock(virtual)]],
     [ (main :- lap(10)), lap(0),
       (lap(N) :- sleep(8), move(t), move(g), M is N-1, lap(M)) ], done).
ends(seconds_of_all_agents, [g-[quota([host(seconds(0.3))])]],
     [(main :- lp), (lp :- lp)], seconds).
ends(tuples, [g-[quota([tuples(5)])]], Clauses, tuples) :- leaver(10, Clauses).
ends(fewer_tuples, [g-[quota([tuples(5)])]], Clauses, done) :-
    leaver(5, Clauses).
ends(taken_tuples, [g-[quota([tuples(5)])]],
     [(main :- forall(between(1, 20, X), ( leave(f(X)), take(f(X)) )))], done).

leaver(N, [(main :- forall(between(1, N, X), leave(f(X))))]).

%   over(+Agent, -Quota): what ended it, which was reported.

over(Agent, Quota) :-
    agent_join(Agent, Outcome, 1000),
    (   Outcome = raised(error(resource_error(Quota), _))
    ->  Report = typhon(over_limit(Agent, Quota)),
        wait_until(was_printed(warning, Report), 5)
    ;   Quota = Outcome
    ).

%   A visitor from the process p, on the host of this process with Quotas.

with_visitors(Quotas, Clauses, Count, As, Goal) :-
    no_leaks(with_peers([p],
        with_host_here([quota(Quotas)],
            capturing(( visitors(p, Clauses, Count, As), Goal ), _)))).

:- meta_predicate with_visitors(+, +, +, -, 0), with_host_here(0),
                  with_host_here(+, 0).

with_host_here(Goal) :-
    with_host_here([], Goal).

with_host_here(Options, Goal) :-
    setup_call_cleanup(host_start(here, Options), once(Goal), host_stop(here)).

:- begin_tests(quotas_of_agents).

test(agent_that_exceeds_a_quota_ends,
     [forall(ends(_, Specs, Clauses, Expected)), true(Quota == Expected)]) :-
    Specs = [First|_],
    ( First = Host-_ -> true ; Host = First ),
    with_hosts(Specs, capturing(( create(Clauses, A, [host(Host)]),
                                  over(A, Quota) ), _)).

%   Inside a probe the agent could not be ended in time.

test(traced_goals, O == messages) :-
    with_hosts([g-[quota([messages(20)])]],
               capturing(( create([ (main :- receive(_),
                                             forall(between(1, 50, _), say)),
                                    (say :- catch(send(user, x), _, true)) ],
                                  A, [host(g)]),
                           agent_trace(A, [goals]),
                           agent_send(A, go),
                           over(A, O) ), _)).
test(logging_by_the_user_is_not_counted) :-
    with_hosts([g-[quota([log(2)])]],
               capturing(remote(g, forall(between(1, 5, X), log(X))), _)).
test(agents_with_quotas_cannot_be_stepped,
     error(permission_error(step, agent, _))) :-
    with_hosts([g-[quota([messages(20)])]],
               ( create([ (main :- receive(_)) ], A, [host(g)]),
                 wait_state(A, waiting),
                 agent_step(A) )).

%   The agent runs where another one was ended by its quota, on a host without
%   quotas.

test(quota_exceeded_by_another_agent, Told == []) :-
    with_hosts([g-[quota([messages(5)])], t],
               capturing(( talker(10, Talker),
                           created([host(g)], 8, Talker, As),
                           outcomes(As, _),
                           created([host(t)], 3, [ (main :- lp), (lp :- lp) ],
                                   Bs),
                           forall(member(B, Bs),
                                  ( wait_state(B, running),
                                    agent_dispose(B, [force(0)]) )),
                           outcomes(Bs, [disposed,disposed,disposed]) ),
                         Messages)),
    findall(B, ( member(B, Bs),
                 memberchk(warning-typhon(over_limit(B, _)), Messages) ),
            Told).
%   The clones' parent was created in another process, and is of the same
%   family.

test(clones_of_a_visitor, O == resource_error(clones)) :-
    with_visitors([clones(5)],
                  [ (main :- s(H), move(H), many), (many :- clone(W), on(W)),
                    on(clone(_)), (on(parent(_)) :- many), on_message(_, _) ],
                  1, [A], joined(A, raised(error(O, _)))).
test(arriving_state_is_checked,
     R = error(move_refused(_, quota(state)), _)) :-
    with_hosts([t, g-[quota([state(50 000)])]],
               ( create([ (main :- forall(between(1, 5000, X), assertz(s(X))),
                                   catch(move(g), E, true), result(E)) ],
                        A, [host(t)]),
                 agent_result(A, R, 5) )).
:- end_tests(quotas_of_agents).

:- begin_tests(lifetime).

test(lifetime_ends_in_virtual_time, T =:= 100.0) :-
    with_hosts([g-[clock(virtual), quota([lifetime(100)])]],
               capturing(( create([(main :- receive(_))], A, [host(g)]),
                           over(A, lifetime),
                           remote(g, now(T)) ), _)).
test(changed_quota_applies_to_present_agents, O == lifetime) :-
    with_hosts([g],
               capturing(( create([on_message(_, _)], A, [host(g)]),
                           host_change(g, quota([lifetime(0.2)])),
                           over(A, O) ), _)).
test(removed_quota_ends_no_agent, State == resident) :-
    with_hosts([g-[clock(virtual), quota([lifetime(5)])]],
               ( create([on_message(_, _)], A, [host(g)]),
                 host_change(g, quota([])),
                 create([ (main :- sleep(9), result(late)) ], B, [host(g)]),
                 agent_result(B, late, 1000),
                 state_of(A, State) )).

:- end_tests(lifetime).

:- begin_tests(mailbox).

%   An agent that receives nothing until it finds a fact that permits it.

test(overflow_is_reported, Xs == [1,2,3,4,5]) :-
    with_hosts([g-[quota([mailbox(5)])]],
               capturing(( sleeper(g, A),
                           forall(between(1, 10, X), agent_send(A, X)),
                           wait_until(lost(A, 5), 10),
                           remote(g, leave(go)),
                           agent_result(A, Xs, 5) ), _)).
test(received_messages_free_space, Xs == [1,2,3,4,5,6]) :-
    with_hosts([g-[quota([mailbox(1)])]],
               ( create([ (main :- numlist(1, 6, Ns), each(Ns, Xs), result(Xs)),
                          each([], []),
                          (each([_|Ns], [X|Xs]) :- receive(_-X), assertz(s(X)),
                                                   each(Ns, Xs)) ], A,
                        [host(g)]),
                 forall(between(1, 5, X),
                        ( agent_send(A, X), wait_until(fact_of(A, s(X)), 5) )),
                 agent_send(A, 6),
                 agent_result(A, Xs, 5) )).
test(agent_is_refused_where_its_mail_does_not_fit,
     R-M = error(move_refused(_, quota(mailbox)), _)-[1,2,3]) :-
    with_hosts([g-[quota([mailbox(2)])], t],
               ( create([ (main :- receive(_-go), catch(move(g), E, true),
                                   receive(_-A), receive(_-B), receive(_-C),
                                   result(E-[A,B,C])) ], A, [host(t)]),
                 forall(member(X, [1,2,3,go]), agent_send(A, X)),
                 agent_result(A, R-M, 5) )).
test(agent_is_refused_between_processes,
     R-M = error(move_refused(_, quota(mailbox)), _)-[1,2,3]) :-
    no_leaks(with_peers([p-[host([quota([mailbox(2)])])]],
        with_host_here(
            ( peer_host(p, There),
              create([ (main :- receive(_-to(G)), catch(move(G), E, true),
                                receive(_-A), receive(_-B), receive(_-C),
                                result(E-[A,B,C])) ], A),
              forall(member(X, [1,2,3,to(There)]), agent_send(A, X)),
              agent_result(A, R-M, 5) )))).
test(overflow_is_reported_to_the_sender) :-
    no_leaks(with_peers([p-[host([quota([mailbox(1)])])]],
        with_host_here(
            ( peer_host(p, There),
              create([ (main :- sleep(1000)) ], A, [host(There)]),
              capturing(( forall(between(1, 5, X), agent_send(A, X)),
                          wait_until(lost(A, 4), 10) ), _) )))).
test(sender_is_not_ended_by_overflow, R == sent) :-
    with_hosts([g-[quota([mailbox(1)])]],
               capturing(( sleeper(g, A),
                           create([ (main :- s(B), send(B, 1), send(B, 2),
                                             result(sent)) ], C,
                                  [host(g), facts([s(A)])]),
                           agent_result(C, R, 5),
                           wait_until(lost(A, 1), 10) ), _)).

:- end_tests(mailbox).

sleeper(Host, A) :-
    create([ (main :- sense(go), !, rest(Xs), result(Xs)),
             (main :- sleep(0.02), main),
             (rest(Xs) :- ( receive(_-X, 0) -> Xs = [X|Ys], rest(Ys)
                          ; Xs = [] )) ], A, [host(Host)]).

lost(A, Count) :-
    aggregate_all(sum(N), lost_with(A, N), Count).

lost_with(A, 1) :-
    printed_message(warning,
                    typhon(undeliverable(resource_error(mailbox), A, _, _))).
lost_with(A, N) :-
    printed_message(
        warning,
        typhon(undeliverable(resource_error(mailbox), A, _, _, More))),
    N is More+1.
lost_with(A, N) :-
    printed_message(warning, typhon(more(lost_messages, Groups))),
    member(N-A, Groups).

                /*******************************
                *            TOGETHER          *
                *******************************/

%   A process with a host is an owner.

outcomes(As, Os) :-
    findall(O, ( member(A, As), joined(A, O) ), Os).

talker(Times, [ (main :- forall(between(1, Times, X), send(user, X))) ]).

created(Where, Times, Clauses, As) :-
    findall(A, ( between(1, Times, _), create(Clauses, A, Where) ), As).

:- begin_tests(quotas_of_owners).

test(messages_of_one_owner, true(Ended >= 5)) :-
    talker(10, Clauses),
    with_hosts([g-[quota([owner(messages(30))])]],
               capturing(( created([host(g)], 12, Clauses, As),
                           outcomes(As, Os) ), _)),
    aggregate_all(count, member(raised(error(resource_error(messages), _)), Os),
                  Ended).
test(other_owners_are_not_affected,
     [Theirs,Ours] == [resource_error(messages),done]) :-
    with_visitors([owner(messages(20))],
                  [ (main :- s(H), move(H), lp),
                    (lp :- send(user, x), sleep(0.001), lp) ], 3, As,
                  ( member(A, As),
                    joined(A, raised(error(Theirs, _))),
                    talker(10, Clauses),
                    create(Clauses, B),
                    joined(B, Ours),
                    forall(member(C, As), disposed(C)) )).
test(agents_of_one_owner, R-Ours == refused-3) :-
    no_leaks(with_peers([p],
        with_host_here([quota([owner(agents(3))])],
            ( created([], 3, [on_message(_, _)], As),
              length(As, Ours),
              (   catch(create([on_message(_, _)], _),
                        error(move_refused(_, quota(agents)), _), R = refused)
              ->  true
              ;   true
              ),
              visitors(p, [ (main :- s(H), move(H), receive(_)) ], 1, [V]),
              wait_until(agent_property(V, state(waiting)), 5),
              disposed(V) )))).
test(clones_count_for_their_owner, R = move_refused(_, quota(agents))) :-
    with_visitors([owner(agents(3))],
                  [ (main :- s(H), move(H), many(0)),
                    (many(N) :- catch(clone(W), error(E, _), true),
                                on(W, E, N)),
                    (on(W, _, _) :- nonvar(W), W = clone(_), !, sleep(1000)),
                    (on(W, _, N) :- nonvar(W), !, M is N+1, many(M)),
                    (on(_, E, _) :- result(E)) ], 1, [V],
                  agent_result(V, R, 10)).
test(largest_consumer_ends_first,
     [Hog,Other] == [resource_error(messages),done]) :-
    with_visitors([host(messages(50))],
                  [(main :- s(H), move(H), lp), (lp :- send(user, x), lp)],
                  1, [A],
                  ( talker(10, Clauses),
                    create(Clauses, B),
                    joined(B, Other),
                    joined(A, raised(error(Hog, _))) )).
test(state_of_one_owner, Ended-Left == 1-2) :-
    current_prolog_flag(address_bits, Bits),
    Most is 300 000*Bits//64,
    with_hosts([g-[quota([owner(state(Most))])]],
               capturing(( fat(700, A), fat(800, B), fat(1500, C),
                           outcome_of_one([A,B,C], Big),
                           Big == C,
                           typhon_quota_enforcer:look,
                           findall(X, ( member(X, [A,B]),
                                        agent_property(X, state(_)) ), Xs) ),
                         Messages)),
    length(Xs, Left),
    aggregate_all(count, member(warning-typhon(over_limit(_, state)), Messages),
                  Ended).
%   One second of real time; without pauses the agent would use nearly one of a
%   processor, too, unless others do.

test(busy_agent_yields_to_others, O == resource_error(seconds)) :-
    with_hosts([g-[quota([seconds(1)])]],
               capturing(( create([ (main :- sleep(0.02), main) ], B, [host(g)]),
                           statistics(process_cputime, T0),
                           create([ (main :- lp), (lp :- lp) ], A, [host(g)]),
                           joined(A, raised(error(O, _))),
                           statistics(process_cputime, T1),
                           agent_dispose(B) ), _)),
    T1-T0 < 0.7.

:- end_tests(quotas_of_owners).

fat(N, A) :-
    create([ (main :- forall(between(1, N, X), assertz(s(X))), receive(_)) ], A,
           [host(g)]),
    wait_state(A, waiting).

outcome_of_one(As, A) :-
    wait_until(( member(X, As), \+ agent_property(X, state(_)) ), 5),
    member(A, As),
    \+ agent_property(A, state(_)),
    !.

%   The agents are created at the peer, and know where to go.

visitors(Peer, Clauses, Count, As) :-
    address(here, Address),
    findall(A, ( between(1, Count, _),
                 peer_do(Peer,
                         agent_create(clauses([ (:- agent(test, [state([s/1])])),
                                                s(Address)|Clauses ]), A)) ),
            As).

disposed(A) :-
    catch(agent_dispose(A), error(existence_error(_, _), _), true).

:- begin_tests(tuples).

test(tuples_taken_by_others_free_space, O == done) :-
    with_hosts([g-[quota([tuples(5)])]],
               ( create([ (main :- lap(4)), lap(0),
                          (lap(N) :- forall(between(1, 5, X), leave(f(N, X))),
                                     receive(_), M is N-1, lap(M)) ], A,
                        [host(g)]),
                 forall(between(1, 4, _),
                        ( wait_until(remote(g, sense(f(_, 5))), 5),
                          forall(between(1, 5, X), remote(g, take(f(_, X)))),
                          agent_send(A, on) )),
                 joined(A, O) )).
test(agent_that_fills_the_space_ends, [A,B] == [resource_error(tuples),done]) :-
    with_visitors([host(tuples(20))],
                  [ (main :- s(H), move(H),
                             forall(between(1, 30, X), leave(f(X)))) ], 1, [C],
                  ( joined(C, raised(error(A, _))), leaves(5, B) )).

%   The agents that left the tuples are known after the restart, and tuples of
%   theirs that are taken then do not count any more.

test(owner_of_tuples_is_kept,
     [ condition(missing([journal], [])), O == tuples-done ]) :-
    no_leaks(with_tmp_dir(left_before(O))).

left_before(O-Taken, Dir) :-
    Options = [journal(Dir), quota([host(tuples(5))])],
    with_host_here(Options, leaves(5, done)),
    with_host_here(Options,
                   capturing(( leaves(1, O),
                               remote(here, take(f(_))),
                               leaves(1, Taken) ), _)).

leaves(N, Quota) :-
    leaver(N, Clauses),
    create(Clauses, A),
    over(A, Quota).

:- end_tests(tuples).

:- begin_tests(invalid_quotas).

test(invalid_quota,
     [ forall(member(Quota-Error,
                     [ owner(cells(1))-domain_error(quota, owner(cells(1))),
                       owner(messages(x))-type_error(number, x),
                       host(state(0))-domain_error(quota, host(state(0))) ])),
       error(Error) ]) :-
    host_start(g, [quota([Quota])]).

:- end_tests(invalid_quotas).
