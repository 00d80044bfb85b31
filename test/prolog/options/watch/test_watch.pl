:- module(test_watch, []).

% The events that a watch of hosts receives.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/cutting_proxy', [proxy_cut/1]).
:- use_module('../../../lib/peers').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, last/2, member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).

:- dynamic told/2.              % Watcher, Event

note(Watcher, Event) :-
    assertz(told(Watcher, Event)).

%   watching(+Hosts, :Goal, -Events): Goal is called while Hosts are watched.

:- meta_predicate watching(+, 0, -), watching(+, 1, 0, -).

:- use_module(library(gensym), [gensym/2]).
:- use_module(library(yall)).

watching(Hosts, Goal, Events) :-
    gensym(watcher, Watcher),
    watching(Hosts, note(Watcher), Goal, Watcher),
    events(Watcher, Events).

watching(Hosts, OnEvent, Goal, _) :-
    setup_call_cleanup(
        watch(Hosts, OnEvent, Watch),
        once(Goal),
        with_settings([typhon_watches:last_seconds=20], unwatch(Watch))).

events(Watcher, Events) :-
    findall(Event, told(Watcher, Event), Events).

%   The first event blocks until the gate gets `go`.

:- meta_predicate with_gate(0).

with_gate(Goal) :-
    setup_call_cleanup(
        message_queue_create(Gate, [alias(watch_gate)]),
        once(Goal),
        message_queue_destroy(Gate)).

slowly(Watcher, Event) :-
    (   told(Watcher, _)
    ->  true
    ;   thread_get_message(watch_gate, go, [timeout(20)])
    ),
    note(Watcher, Event).

numbers(Watcher, Numbers) :-
    findall(N, told(Watcher, event(_, _, _, leave(f(N)))), Numbers).

%   all_accounted(+Watcher, +Count): Count events were reported, or counted as
%   skipped.

all_accounted(Watcher, Count) :-
    aggregate_all(count, ( told(Watcher, event(_, _, _, What)),
                           What \= skipped(_) ), Heard),
    aggregate_all(sum(C), told(Watcher, event(_, _, _, skipped(C))), Skipped),
    Heard+Skipped =:= Count.

:- begin_tests(watch).

                /*******************************
                *         ONE PROCESS          *
                *******************************/

traveller([ (main :- receive(_-go(Host)), move(Host), leave(fact(1)),
                     take(fact(_)), log(was(here)), send(user, done)) ]).

trip(A) :-
    traveller(Clauses),
    create(Clauses, A, [host(alpha)]),
    agent_send(A, go(beta)),
    joined(A, done).

test(events_of_an_agent) :-
    with_hosts([alpha, beta],
               ( address(alpha, Alpha), address(beta, Beta),
                 capturing(watching([alpha, beta], trip(A), Events), _) )),
    findall(Host-What, member(event(_, Host, A, What), Events), Story),
    assertion(Story = [ Alpha-created, Alpha-received(user), Alpha-left(Beta),
                        Beta-arrived(Alpha, _), Beta-leave(fact(1)),
                        Beta-take(fact(1)), Beta-log(was(here)),
                        Beta-sent(user), Beta-ended(done) ]),
    assertion(maplist([event(_, _, Watcher, _), Watcher]>>true, Events, [A|_])),
    findall(Time, member(event(Time, _, _, _), Events), Times),
    assertion(msort(Times, Times)),
    get_time(Now),
    last(Times, Last),
    Ago is Now-Last,
    assertion(soon(Ago, 5)).

test(only_watched_hosts_are_reported) :-
    with_hosts([alpha, beta],
               ( address(beta, Beta),
                 capturing(watching(beta, trip(_), Events), _) )),
    assertion(forall(member(event(_, Host, _, _), Events), Host == Beta)),
    assertion(( member(event(_, _, _, What), Events),
                What = arrived(_, _) )).

test(lambda_keeps_its_global_variables, Whats == [log(1)]) :-
    with_hosts([alpha],
               ( message_queue_create(Queue),
                 watch(alpha, [E]>>thread_send_message(Queue, E), Watch),
                 capturing(( create([(main :- log(1))], A),
                             joined(A, done) ), _),
                 unwatch(Watch),
                 queued(Queue, Events),
                 message_queue_destroy(Queue) )),
    findall(What, ( member(event(_, _, A, What), Events), What = log(_) ),
            Whats).

queued(Queue, Events) :-
    (   thread_peek_message(Queue, _)
    ->  thread_get_message(Queue, Event),
        Events = [Event|Rest],
        queued(Queue, Rest)
    ;   Events = []
    ).

test(clones_and_refused_moves) :-
    with_hosts([alpha, beta-[capacity(0)]],
               watching([alpha, beta], clone_and_stay(A, Clone), Events)),
    assertion(memberchk(event(_, _, A, cloned(Clone)), Events)),
    assertion(memberchk(event(_, _, Clone, created), Events)),
    findall(What, ( member(event(_, _, A, What), Events),
                    memberchk(What, [left(_), stayed(_)]) ), Hops),
    assertion(Hops = [left(Beta), stayed(Beta)]).

clone_and_stay(A, Clone) :-
    create([ (main :- clone(Watcher), after(Watcher)),
             (after(parent(C)) :- result(C),
                                  catch(move(beta), error(_, _), true)),
             after(clone(_)) ], A, [host(alpha)]),
    joined(A, done),
    agent_result(A, Clone, 5),
    joined(Clone, done).

test(faults_are_reported) :-
    with_hosts([alpha],
               capturing(watching(alpha, faulty(A, Fault), Events), _)),
    findall(What, member(event(_, _, A, What), Events), Story),
    assertion(Story = [created, fault(Fault), ended(raised(_))]).

faulty(A, Fault) :-
    create([(main :- foo(_) is _)], A),
    wait_state(A, faulty(_)),
    agent_property(A, fault(Fault)),
    agent_dispose(A),
    joined(A, raised(_)).

test(changes_of_links_and_hosts) :-
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 watching(alpha,
                          ( host_start(beta), address(beta, Beta),
                            link(alpha, beta),
                            link(alpha, beta, [cost(2)]),
                            unlink(alpha, beta),
                            link(alpha, beta),
                            host_stop(beta) ),
                          Events) )),
    findall(Host-What, member(event(_, Host, none, What), Events), Story),
    assertion(Story == [ Alpha-link(Beta), Alpha-unlink(Beta),
                         Alpha-link(Beta), Alpha-unlink(Beta) ]).

test(restarted_host, Whats == [stopped, started, created]) :-
    with_hosts([alpha, beta],
               watching(beta,
                        ( host_stop(beta),
                          host_start(beta),
                          create([on_message(_, _)], _, [host(beta)]) ),
                        Events)),
    findall(What, member(event(_, _, _, What), Events), Whats).

test(unserializable_term_is_reported_as_text, Type == atom) :-
    with_hosts([alpha],
               capturing(watching(alpha,
                                  ( create([(main :- current_output(S),
                                                     catch(log(S), _, true))],
                                           A),
                                    joined(A, done) ),
                                  Events), _)),
    memberchk(event(_, _, A, log(Text)), Events),
    ( atom(Text) -> Type = atom ; Type = other ).

                /*******************************
                *         WHO WATCHES          *
                *******************************/

test(one_of_two_watchers_ends) :-
    with_hosts([alpha],
               ( watch(alpha, note(one), One),
                 watch(alpha, note(two), Two),
                 create([main], A), joined(A, done),
                 unwatch(One),
                 create([main], B), joined(B, done),
                 unwatch(Two) )),
    events(one, Ones),
    events(two, Twos),
    maplist([Events, Ids]>>findall(Id, member(event(_, _, Id, created), Events),
                                   Ids),
            [Ones, Twos], Ids),
    assertion(Ids == [[A], [A, B]]).

test(an_exception_is_reported_once, Warnings-Count == 1-4) :-
    flag(calls, _, 0),
    with_hosts([alpha],
               capturing(watching(alpha, raises,
                                  ( create([main], A), joined(A, done),
                                    create([main], B), joined(B, done) ),
                                  _),
                         Messages)),
    aggregate_all(count,
                  member(warning-typhon(watch_raised(_, oops)), Messages),
                  Warnings),
    flag(calls, Count, 0).

raises(_) :-
    flag(calls, N, N+1),
    throw(oops).

%   The agent begins, leaves 5000 facts and ends.

test(slow_watcher_gets_the_number_of_lost_events) :-
    with_settings([typhon_watch_senders:events = 100],
                  with_hosts([alpha], with_gate(slow_watcher))),
    numbers(slow, Got),
    assertion(all_accounted(slow, 5002)),
    assertion(told(slow, event(_, _, none, skipped(_)))),
    assertion(( sort(Got, Sorted), Sorted == Got )).

%   The slow watcher delays no other; it ends only when all agents have.

slow_watcher :-
    address(alpha, Alpha),
    watch(Alpha, slowly(slow), Watch),
    create([(main :- forall(between(1, 5000, N), leave(f(N))))], A),
    joined(A, done),
    thread_send_message(watch_gate, go),
    wait_until(all_accounted(slow, 5002), 20),
    unwatch(Watch).

test(watcher_unwatches_itself) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 watch(alpha, once_only, Watch),
                 note(within, Watch),
                 agent_send(A, one),
                 wait_until(told(over, Watch), 5),
                 agent_send(A, two) )),
    findall(E, told(only, E), Heard),
    assertion(Heard = [event(_, _, A, received(user))]),
    catch(( unwatch(Watch), Again = ended ), error(Again, _), true),
    assertion(Again == existence_error(watch, Watch)).

once_only(Event) :-
    told(within, Watch),
    note(only, Event),
    unwatch(Watch),
    note(over, Watch).

test(hanging_watcher_is_ended) :-
    with_settings([typhon_watches:last_seconds = 0.2],
                  with_hosts([alpha],
                             ( message_queue_create(Never),
                               watch(alpha, hang(Never), Watch),
                               create([on_message(_, _)], _),
                               unwatch(Watch),
                               message_queue_destroy(Never) ))).

hang(Queue, _) :-
    thread_get_message(Queue, _).

test(no_events_after_unwatch) :-
    with_hosts([alpha, beta],
               ( watching([alpha, beta], true, _),
                 \+ ( member(Kind, [life, hops, messages, facts]),
                      typhon_events:event_subscribed(Kind) ),
                 wait_until(\+ is_watched(alpha), 5) )).

test(unknown_watch, error(existence_error(watch, watch_of_mine))) :-
    unwatch(watch_of_mine).
test(invalid_watch, error(instantiation_error)) :-
    unwatch(_).
test(unknown_host, error(existence_error(host, nowhere))) :-
    no_leaks(watch(nowhere, note(x), _)).
test(no_process_at_the_address, error(host_unreachable(Host))) :-
    free_port(Port),
    atom_concat('a@127.0.0.1:', Port, Host),
    no_leaks(watch(Host, note(x), _)).
test(not_callable, error(type_error(callable, 7))) :-
    watch([], 7, _).
test(unbound_host, error(instantiation_error)) :-
    no_leaks(watch([_], note(x), _)).

                /*******************************
                *         VIRTUAL TIME         *
                *******************************/

wanderers(Events) :-
    network_start(ring(4), Network,
                  [ clock(virtual), seed(7), hop_time(uniform(1, 3)) ]),
    network_property(Network, hosts([Host|_])),
    watching(Network,
             ( forall(member(N, [ann, bob, cid]),
                      agent_create(clauses([ (:- agent(wanderer, [])),
                                             (main :- tour(5)),
                                             tour(0),
                                             (tour(I) :- neighbours(Hs),
                                                         random_member(H, Hs),
                                                         move(H), J is I-1,
                                                         tour(J)) ]),
                                   _, [host(Host), name(N)])),
               network_advance(Network, 100) ),
             Events),
    network_stop(Network).

test(virtual_runs_repeat) :-
    no_leaks(wanderers(Events)),
    wanderers(Again),
    assertion(Events == Again),
    findall(Time, member(event(Time, _, _, arrived(_, _)), Events), Times),
    length(Times, Arrivals),
    assertion(Arrivals =:= 15),
    assertion(( msort(Times, Times), last(Times, Last), Last =< 15.0 )),
    assertion(forall(member(event(_, _, _, arrived(_, Seconds)), Events),
                     ( Seconds >= 1, Seconds =< 3 ))).

:- end_tests(watch).

:- begin_tests(watch_other_processes).

test(network_of_processes) :-
    no_leaks(( network_start(ring(4), Network, [processes(2)]),
               network_property(Network, hosts([H1, H2, H3, H4])),
               watching(Network, round_trip(H1, H3, A), Events),
               network_stop(Network) )),
    findall(H-What, member(event(_, H, A, What), Events), Story0),
    msort(Story0, Story),
    msort([ H1-created, H1-left(H3), H1-arrived(H3, _), H3-left(H1),
            H3-arrived(H1, _), H1-ended(done) ], Expected),
    assertion(subsumes_term(Expected, Story)),
    findall(What, member(event(_, H3, A, What), Events), AtH3),
    assertion(AtH3 = [arrived(H1, _), left(H1)]),
    assertion(forall(member(H, [H1, H2, H3, H4]), atom(H))).

round_trip(From, To, A) :-
    create([ (main :- s(To), here(Home), move(To), move(Home)) ], A,
           [host(From), facts([s(To)])]),
    joined(A, done).

test(hosts_of_a_stopping_network) :-
    network_start(ring(4), Network, [processes(2)]),
    network_property(Network, hosts(Hosts)),
    watch(Network, note(stops), Watch),
    network_stop(Network),
    wait_until(stopped(Stopped), 10),
    findall(H, told(stops, event(_, H, none, lost)), Lost),
    unwatch(Watch),
    assertion(Stopped == Hosts),
    assertion(Lost == []).

stopped([A,B,C,D]) :-
    findall(H, told(stops, event(_, H, none, stopped)), Stopped),
    msort(Stopped, [A,B,C,D]).

test(killed_process) :-
    no_leaks(( network_start(ring(4), Network, [processes(2)]),
               network_property(Network, hosts([H1, _, H3, H4])),
               network_property(Network, processes([_, Pid])),
               capturing(watching(Network, killed(Pid, H1, H4, A), Events), _),
               capturing(network_stop(Network), _) )),
    findall(H, member(event(_, H, none, lost), Events), Lost),
    assertion(Lost == [H3, H4]),
    once(append(_, [event(_, H4, none, lost)|After], Events)),
    assertion(memberchk(event(_, H1, A, ended(done)), After)).

killed(Pid, H1, H4, A) :-
    process_kill(Pid, kill),
    wait_until(( told(_, event(_, H4, none, lost)) ), 10),
    create([main], A, [host(H1)]),
    joined(A, done).

test(hosts_lost_before_the_watch, Lost == [H3, H4]) :-
    no_leaks(( network_start(ring(4), Network, [processes(2)]),
               network_property(Network, hosts([_, _, H3, H4])),
               network_property(Network, processes([_, Pid])),
               capturing(( process_kill(Pid, kill),
                           wait_until(network_property(Network, processes([_])),
                                      10),
                           watching(Network, true, Events),
                           network_stop(Network) ), _) )),
    findall(H, member(event(_, H, none, lost), Events), Lost).

with_peer(Options, Goal) :-
    no_leaks(with_peers([b-Options],
                        ( peer_host(b, B),
                          call(Goal, B) ))).

:- meta_predicate with_peer(+, 1).

leaves(From, To) :-
    peer_do(b, remote(b, forall(between(From, To, N), leave(f(N))))).

test(broken_connection_loses_no_event) :-
    with_peer([proxy(true)], cut).

cut(B) :-
    watch(B, note(cut), Watch),
    leaves(1, 100),
    peer_proxy(b, Proxy),
    wait_until(numbers(cut, [_|_]), 5),
    forall(between(1, 5, I),
           ( proxy_cut(Proxy),
             From is I*100+1, To is From+99,
             leaves(From, To) )),
    findall(N, between(1, 600, N), All),
    wait_until(numbers(cut, All), 20),
    unwatch(Watch),
    assertion(\+ ( told(cut, event(_, _, _, What)),
                   memberchk(What, [lost, started]) )).

test(restarted_process) :-
    with_peer([], back).

back(B) :-
    watch(B, note(back), Watch),
    leaves(1, 10),
    wait_until(told(back, event(_, _, _, leave(f(10)))), 10),
    peer_kill(b),
    wait_until(told(back, event(_, B, none, lost)), 10),
    peer_restart(b),
    wait_until(told(back, event(_, B, none, started)), 20),
    leaves(11, 20),
    wait_until(told(back, event(_, _, _, leave(f(20)))), 10),
    unwatch(Watch),
    findall(What, told(back, event(_, B, none, What)), Whats0),
    exclude([leave(_)]>>true, Whats0, Whats),
    assertion(Whats == [lost, started]),
    findall(N, between(1, 20, N), All),
    assertion(numbers(back, All)).

test(watcher_leaves_nothing_in_the_other_process) :-
    with_peer([], left).

left(B) :-
    watch(B, note(left), Watch),
    assertion(peer_do(b, once(typhon_events:event_subscribed(hops)))),
    unwatch(Watch),
    assertion(peer_do(b, \+ typhon_events:event_subscribed(hops))),
    wait_until(senders(b, 0), 5).

senders(Peer, Count) :-
    peer_do(Peer,
            aggregate_all(count,
                          ( thread_property(_, alias(Alias)),
                            sub_atom(Alias, 0, _, _, typhon_event_sender) ),
                          Count0)),
    Count = Count0.

test(watches_of_another_process_are_bounded,
     error(permission_error(watch, host, _))) :-
    with_peer([], too_many).

too_many(B) :-
    peer_do(b, set_setting(typhon_watch_senders:watches, 2)),
    setup_call_cleanup(
        ( watch(B, ignored, First), watch(B, ignored, Second) ),
        watch(B, ignored, _),
        ( unwatch(First), unwatch(Second) )).

ignored(_).

test(dead_watcher_is_removed) :-
    with_peers([a, b], dies).

dies :-
    peer_host(b, B),
    peer_do(a, watch(B, writeln, _)),
    assertion(senders(b, 1)),
    peer_kill(a),
    wait_until(senders(b, 0), 20),
    assertion(peer_do(b, \+ typhon_events:event_subscribed(hops))).

test(slow_watcher_does_not_delay_other_processes) :-
    with_gate(with_peer([setup(set_setting(typhon_watch_senders:events, 100))],
                        slow_for)).

slow_for(B) :-
    watch(B, slowly(far), Watch),
    leaves(1, 10 000),
    thread_send_message(watch_gate, go),
    wait_until(all_accounted(far, 10 000), 20),
    assertion(told(far, event(_, B, none, skipped(_)))),
    unwatch(Watch).

test(too_long_events_are_skipped) :-
    with_peer([setup(set_setting(typhon_session:frame_bytes, 70 000))],
              too_long).

too_long(B) :-
    watch(B, note(long), Watch),
    peer_do(b, remote(b, ( numlist(1, 100 000, Long), leave(f(1)),
                           leave(f(Long)), leave(f(2)) ))),
    wait_until(told(long, event(_, _, _, leave(f(2)))), 10),
    unwatch(Watch),
    findall(What, told(long, event(_, _, _, What)), Whats),
    assertion(Whats == [leave(f(1)), skipped(1), leave(f(2))]).

:- end_tests(watch_other_processes).
