:- module(test_message, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [endpoint_address/1, endpoint_post/3]).

/** <module> Tests of messages: each reaches its agent once

Hosts of this process; for messages between processes see test_processes.pl.
*/

%   collector(-Agent, +Options): an agent that stores received messages in
%   order.

collector(Agent, Options) :-
    create([(on_message(_, M) :- assertz(s(M)))], Agent, Options).

%   An agent that goes round while messages are sent to it, and stops at an
%   order.

traveller(Agent) :-
    create([ (main :- ( receive(_-stop, 0)
                      -> true
                      ;  move(beta), move(alpha), main )),
             (on_message(_, M) :- assertz(s(M))) ], Agent).

numbers(Agent, Ns) :-
    findall(N, fact_of(Agent, s(N)), Ns).

has_all(Agent, N) :-
    aggregate_all(count, fact_of(Agent, s(_)), N).

%   Another process sends a letter to Id.

passed_on(Id, Message) :-
    endpoint_address(Here),
    endpoint_post(Here, message,
                  message(Id, [mail('127.0.0.1:1', x, Message)], 64)).

:- begin_tests(messages).

test(sender_outside_agents_is_user, true(F == [s(user-hello)])) :-
    with_hosts([alpha],
               ( create([(on_message(W, M) :- assertz(s(W-M)))], A),
                 agent_send(A, hello),
                 wait_until(has_all(A, 1), 5),
                 facts(A, F) )).
test(sender_is_an_agent, true(F == [s(B-hello)])) :-
    with_hosts([alpha,beta],
               ( create([(on_message(W, M) :- assertz(s(W-M)))], A),
                 create([(main :- s(A0), move(beta), send(A0, hello))], B,
                        [facts([s(A)])]),
                 joined(B, done),
                 wait_until(has_all(A, 1), 5),
                 facts(A, F) )).
test(messages_are_answered, true(O == done)) :-
    with_hosts([alpha,beta],
               ( create([(on_message(W, ask(X)) :- Y is X*2, send(W, Y))], A,
                        [host(beta)]),
                 create([(main :- s(A0), send(A0, ask(21)), receive(A0-42))],
                        B, [facts([s(A)])]),
                 joined(B, O) )).
test(agent_writes_to_itself, true(F == [s(1)])) :-
    with_hosts([alpha],
               ( create([(main :- self(S), send(S, 1)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_until(has_all(A, 1), 5),
                 facts(A, F) )).
test(message_may_be_any_term,
     true(F =@= [s(f(X,X,_,"text",1.5,[a|b],7777777777777777777777))])) :-
    with_hosts([alpha],
               ( collector(A, []),
                 agent_send(A, f(Y,Y,_,"text",1.5,[a|b],7777777777777777777777)),
                 wait_until(has_all(A, 1), 5),
                 facts(A, F) )),
    X = _.
test(message_that_cannot_travel, error(type_error(mobile_term, _))) :-
    with_hosts([alpha],
               ( collector(A, []), current_output(S), agent_send(A, S) )).
test(message_to_unknown_agent, error(existence_error(agent, foo))) :-
    with_hosts([alpha], agent_send(foo, hello)).
test(message_to_an_unbound_id, error(instantiation_error)) :-
    with_hosts([alpha], agent_send(_, hello)).
test(message_to_an_ended_agent, error(existence_error(agent, _))) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, done), agent_send(A, hello) )).
test(message_to_a_faulty_agent_is_kept, true(M == [user-hello])) :-
    with_hosts([alpha],
               capturing(( create([(main :- throw(x))], A),
                           joined(A, _),
                           agent_send(A, hello),
                           agent_property(A, mailbox(M)) ), _)).
test(message_of_an_agent_to_unknown_agent,
     true(O-M = done-[warning-typhon(undeliverable(_, foo, _, hello))])) :-
    with_hosts([alpha],
               capturing(( create([(main :- send(foo, hello))], A),
                           joined(A, O) ), M)).
test(message_to_the_user,
     true(M = [informational-typhon(told(_, hello))])) :-
    with_hosts([alpha],
               capturing(( create([(main :- send(user, hello))], A),
                           joined(A, done) ), M)).
test(message_to_an_address_without_a_process,
     error(host_unreachable('127.0.0.1:1'))) :-
    with_hosts([alpha], agent_send('x.1.2@gamma@127.0.0.1:1', hello)).
test(message_to_an_unreachable_process_is_dropped_after_a_time,
     true(M = [warning-typhon(undeliverable(_, Id, x, hello))])) :-
    Id = 'x.1.2@gamma@127.0.0.1:none',
    with_hosts([alpha],
               with_settings([typhon_news:news_seconds=1],
                             capturing(( passed_on(Id, hello),
                                         wait_until(was_printed(warning, _),
                                                    60) ),
                                       M))).
test(message_from_elsewhere_to_an_ended_agent_is_dropped, M == []) :-
    with_hosts([alpha],
               capturing(( create([main], A),
                           joined(A, done),
                           collector(B, []),
                           passed_on(A, hello),
                           passed_on(B, hello),
                           wait_until(has_all(B, 1), 10) ), M)).
test(messages_arrive_in_order, true(Ns == Sent)) :-
    numlist(1, 1000, Sent),
    with_hosts([alpha],
               ( collector(A, []),
                 forall(member(N, Sent), agent_send(A, N)),
                 wait_until(has_all(A, 1000), 10),
                 numbers(A, Ns) )).
test(messages_of_each_thread_arrive_in_order,
     true(Parts == [Sent,Sent,Sent,Sent])) :-
    numlist(1, 200, Sent),
    with_hosts([alpha],
               ( collector(A, []),
                 concurrent_maplist([T]>>forall(member(N, Sent),
                                                agent_send(A, T-N)),
                                    [1,2,3,4]),
                 wait_until(has_all(A, 800), 10),
                 numbers(A, All),
                 findall(P, ( member(T, [1,2,3,4]),
                              findall(N, member(T-N, All), P) ), Parts) )).
test(messages_from_many_agents, true(N == 50*10)) :-
    with_hosts([alpha,beta],
               ( collector(A, []),
                 findall(B, ( between(1, 50, _),
                              create([(main :- go(10)),
                                      (go(0) :- !),
                                      (go(K) :- s(A0), send(A0, K),
                                                K1 is K-1, go(K1))], B,
                                     [facts([s(A)]), host(beta)]) ), Bs),
                 maplist(joined, Bs, _),
                 wait_until(has_all(A, 500), 10),
                 has_all(A, N0) )),
    N = 50*10, N0 =:= N.
test(messages_to_a_running_agent, true(Ns == [1,2,3])) :-
    with_hosts([alpha],
               ( create([(main :- take(stop), !), (main :- main),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 maplist(agent_send(A), [1,2,3]),
                 remote(alpha, leave(stop)),
                 wait_until(has_all(A, 3), 5),
                 numbers(A, Ns) )).

:- end_tests(messages).

:- begin_tests(messages_and_moves).

test(sent_before_it_moved_travel_with_it, true(Ns == [1,2,3])) :-
    with_hosts([alpha,beta],
               ( create([(main :- receive(_-go), move(beta)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_state(A, waiting),
                 maplist(agent_send(A), [1,2,go,3]),
                 wait_until(has_all(A, 3), 5),
                 numbers(A, Ns) )).
test(message_to_an_agent_in_flight, true(Ns == [1,2,3])) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1001))],beta],
               ( create([(main :- move(beta)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_state(A, in_transit),
                 maplist(agent_send(A), [1,2,3]),
                 once(typhon_scheduler:fire(A, leave)),
                 wait_until(has_all(A, 3), 5),
                 numbers(A, Ns) )).
test(message_to_an_agent_in_flight_to_a_refusing_host, true(Ns == [1,2,3])) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1001))],beta-[capacity(0)]],
               ( create([(main :- catch(move(beta), error(_, _), true)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_state(A, in_transit),
                 maplist(agent_send(A), [1,2,3]),
                 once(typhon_scheduler:fire(A, leave)),
                 wait_until(has_all(A, 3), 5),
                 numbers(A, Ns) )).
test(message_to_an_agent_that_moved, true(Ns == [1,2,3])) :-
    with_hosts([alpha,beta],
               ( collector(A, []),
                 agent_move(A, beta),
                 address(beta, B),
                 wait_until(agent_property(A, host(B)), 5),
                 maplist(agent_send(A), [1,2,3]),
                 wait_until(has_all(A, 3), 5),
                 numbers(A, Ns) )).
test(moving_agent_gets_each_message_once, true(Sorted == Sent)) :-
    numlist(1, 2000, Sent),
    with_hosts([alpha,beta],
               ( traveller(A),
                 forall(member(N, Sent), agent_send(A, N)),
                 agent_send(A, stop),
                 wait_until(has_all(A, 2000), 20),
                 numbers(A, Ns),
                 msort(Ns, Sorted),
                 assertion(Ns == Sent) )).
test(many_senders_to_a_moving_agent, true(N == 2000)) :-
    with_hosts([alpha,beta],
               ( traveller(A),
                 findall(B, ( member(H, [alpha,beta]), between(1, 10, _),
                              create([(main :- go(100)),
                                      (go(0) :- !),
                                      (go(K) :- s(A0), self(S),
                                                send(A0, S-K),
                                                K1 is K-1, go(K1))], B,
                                     [facts([s(A)]), host(H)]) ), Bs),
                 maplist(joined, Bs, _),
                 agent_send(A, stop),
                 wait_until(has_all(A, 2000), 20),
                 numbers(A, Ns),
                 sort(Ns, Set),
                 length(Set, N) )).
test(travelling_agents_exchange_messages, true(Os == [done,done])) :-
    with_hosts([alpha,beta],
               ( Play = [ (main :- receive(_-with(B)), play(B, 200)),
                          (play(_, 0) :- !),
                          (play(B, K) :- send(B, ball(K)),
                                         receive(_-ball(K)),
                                         ( K mod 2 =:= 0 -> move(beta)
                                         ; move(alpha) ),
                                         K1 is K-1, play(B, K1)) ],
                 create(Play, A),
                 create(Play, B, [host(beta)]),
                 agent_send(A, with(B)),
                 agent_send(B, with(A)),
                 maplist(joined, [A,B], Os) )).
test(selective_receive_across_moves, true(F == [s(a),s(b),s(c)])) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _),
                         (main :- get(a), move(beta), get(b), move(alpha),
                                  get(c)),
                         (get(X) :- receive(_-m(X)), assertz(s(X)))], A),
                 forall(member(M, [c,b,a]), agent_send(A, m(M))),
                 wait_state(A, resident),
                 facts(A, F) )).

:- end_tests(messages_and_moves).

:- begin_tests(hints).

test(right_hint, true(Ns == [1])) :-
    with_hosts([alpha,beta],
               ( collector(A, [host(beta)]),
                 agent_send(at(A, beta), 1),
                 wait_until(has_all(A, 1), 5),
                 numbers(A, Ns) )).
test(wrong_hint, true(Ns == [1])) :-
    with_hosts([alpha,beta],
               ( collector(A, [host(beta)]),
                 agent_send(at(A, alpha), 1),
                 wait_until(has_all(A, 1), 5),
                 numbers(A, Ns) )).
test(hint_is_not_a_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha],
               ( collector(A, []), agent_send(at(A, nowhere), 1) )).
test(hint_of_an_agent, true(Ns == [1])) :-
    with_hosts([alpha,beta],
               ( collector(A, [host(beta)]),
                 create([(main :- s(A0), send(at(A0, beta), 1))], B,
                        [facts([s(A)])]),
                 joined(B, done),
                 wait_until(has_all(A, 1), 5),
                 numbers(A, Ns) )).

:- end_tests(hints).

:- begin_tests(backlog_is_bounded).

test(messages_beyond_the_bound_are_lost, Waiting-Left == 50-0) :-
    with_settings([typhon_backlog:messages=50],
        capturing(with_hosts([alpha],
                             ( forall(between(1, 200, N), unknown_gets(N)),
                               flag(typhon_backlog, Waiting, Waiting) )), Ms)),
    flag(typhon_backlog, Left, Left),
    findall(N, ( member(_-typhon(M), Ms), lost_in(M, N) ), Ns),
    sum_list(Ns, Lost),         % and some that waited, as the host stops
    assertion(between(150, 200, Lost)).

:- end_tests(backlog_is_bounded).

unknown_gets(N) :-
    format(atom(To), 'x~d.1.2@g@127.0.0.1:none', [N]),
    passed_on(To, N).

lost_in(undeliverable(resource_error(backlog), _, _, _), 1).
lost_in(more(lost_messages, Groups), N) :-
    findall(C, member(C-_, Groups), Cs),
    sum_list(Cs, N).
