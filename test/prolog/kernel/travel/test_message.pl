:- module(test_message, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [endpoint_address/1, endpoint_post/3]).

/** <module> Tests of messages: each reaches its agent once

Hosts of this process; for messages between processes see test_hop.pl.
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

%   got(+Agent, +Count, -Messages): when it has so many.

got(Agent, Count, Messages) :-
    wait_until(( numbers(Agent, Ns), length(Ns, Count) ), 20),
    numbers(Agent, Messages).

%   Another process sends a letter to Id.

passed_on(Id, Message) :-
    endpoint_address(Here),
    endpoint_post(Here, message,
                  message(Id, [mail('127.0.0.1:1', x, Message)], 64)).

:- begin_tests(messages).

test(sender_outside_agents_is_user, true(Ms == [user-hello])) :-
    with_hosts([alpha],
               ( create([(on_message(W, M) :- assertz(s(W-M)))], A),
                 agent_send(A, hello),
                 got(A, 1, Ms) )).
test(sender_is_an_agent, true(Ms == [B-hello])) :-
    with_hosts([alpha,beta],
               ( create([(on_message(W, M) :- assertz(s(W-M)))], A),
                 create([(main :- s(A0), move(beta), send(A0, hello))], B,
                        [facts([s(A)])]),
                 joined(B, done),
                 got(A, 1, Ms) )).
test(messages_are_answered, true(O == done)) :-
    with_hosts([alpha,beta],
               ( create([(on_message(W, ask(X)) :- Y is X*2, send(W, Y))], A,
                        [host(beta)]),
                 create([(main :- s(A0), send(A0, ask(21)), receive(A0-42))],
                        B, [facts([s(A)])]),
                 joined(B, O) )).
test(agent_writes_to_itself, true(Ms == [1])) :-
    with_hosts([alpha],
               ( create([(main :- self(S), send(S, 1)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 got(A, 1, Ms) )).
test(message_may_be_any_term, true(M =@= Term)) :-
    Term = f(Y,Y,_,"text",1.5,[a|b],7777777777777777777777),
    with_hosts([alpha],
               ( collector(A, []), agent_send(A, Term), got(A, 1, [M]) )).

%   invalid(-Ended, -Agent, -Message, -Error): Ended is an agent that has ended.

invalid(_, foo, hello, existence_error(agent, foo)).
invalid(_, _, hello, instantiation_error).
invalid(A, A, hello, existence_error(agent, A)).
invalid(_, 'x.1.2@gamma@127.0.0.1:1', hello, host_unreachable('127.0.0.1:1')).
invalid(A, A, S, type_error(mobile_term, _)) :-
    current_output(S).

test(invalid_message, true(Wrong == [])) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, done),
                 findall(To-E, ( invalid(A, To, Message, Error),
                                 catch(agent_send(To, Message), error(E, _),
                                       true),
                                 \+ subsumes_term(Error, E) ), Wrong) )).
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
                           got(B, 1, _) ), M)).
test(messages_of_each_thread_arrive_in_order,
     true(Parts == [Sent,Sent,Sent,Sent])) :-
    numlist(1, 200, Sent),
    with_hosts([alpha],
               ( collector(A, []),
                 concurrent_maplist([T]>>forall(member(N, Sent),
                                                agent_send(A, T-N)),
                                    [1,2,3,4]),
                 got(A, 800, All),
                 findall(P, ( member(T, [1,2,3,4]),
                              findall(N, member(T-N, All), P) ), Parts) )).
test(messages_from_many_agents) :-
    with_hosts([alpha,beta],
               ( collector(A, []),
                 findall(B, ( between(1, 50, _),
                              create([(main :- go(10)),
                                      (go(0) :- !),
                                      (go(K) :- s(A0), send(A0, K),
                                                K1 is K-1, go(K1))], B,
                                     [facts([s(A)]), host(beta)]) ), Bs),
                 maplist(joined, Bs, _),
                 got(A, 500, _) )).
test(messages_to_a_running_agent, true(Ns == [1,2,3])) :-
    with_hosts([alpha],
               ( create([(main :- take(stop), !), (main :- main),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 maplist(agent_send(A), [1,2,3]),
                 remote(alpha, leave(stop)),
                 got(A, 3, Ns) )).

:- end_tests(messages).

:- begin_tests(messages_and_moves).

test(sent_before_it_moved_travel_with_it, true(Ns == [1,2,3])) :-
    with_hosts([alpha,beta],
               ( create([(main :- receive(_-go), move(beta)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_state(A, waiting),
                 maplist(agent_send(A), [1,2,go,3]),
                 got(A, 3, Ns) )).
test(message_to_an_agent_in_flight,
     [ forall(member(Capacity, [1, 0])), true(Ns == [1,2,3]) ]) :-
    with_hosts([ alpha-[hop_time(uniform(1000, 1001))],
                 beta-[capacity(Capacity)] ],
               ( create([(main :- catch(move(beta), error(_, _), true)),
                         (on_message(_, M) :- assertz(s(M)))], A),
                 wait_state(A, in_transit),
                 maplist(agent_send(A), [1,2,3]),
                 once(typhon_scheduler:fire(A, leave)),
                 got(A, 3, Ns) )).
test(message_to_an_agent_that_moved, true(Ns == [1,2,3])) :-
    with_hosts([alpha,beta],
               ( collector(A, []),
                 agent_move(A, beta),
                 address(beta, B),
                 wait_until(agent_property(A, host(B)), 5),
                 maplist(agent_send(A), [1,2,3]),
                 got(A, 3, Ns) )).
test(messages_arrive_once_and_in_order,
     [ forall(member(Moves, [no,yes])), true(Ns == Sent) ]) :-
    numlist(1, 2000, Sent),
    with_hosts([alpha,beta],
               ( ( Moves == yes -> traveller(A) ; collector(A, []) ),
                 forall(member(N, Sent), agent_send(A, N)),
                 ( Moves == yes -> agent_send(A, stop) ; true ),
                 got(A, 2000, Ns) )).
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
                 got(A, 2000, Ns),
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

test(hint_is_right_or_wrong, [ forall(member(Hint, [beta,alpha])),
                               true(Ns == [1]) ]) :-
    with_hosts([alpha,beta],
               ( collector(A, [host(beta)]),
                 agent_send(at(A, Hint), 1),
                 got(A, 1, Ns) )).
test(hint_is_not_a_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha],
               ( collector(A, []), agent_send(at(A, nowhere), 1) )).
test(hint_of_an_agent, true(Ns == [1])) :-
    with_hosts([alpha,beta],
               ( collector(A, [host(beta)]),
                 create([(main :- s(A0), send(at(A0, beta), 1))], B,
                        [facts([s(A)])]),
                 joined(B, done),
                 got(A, 1, Ns) )).

:- end_tests(hints).

:- begin_tests(backlog_is_bounded).

test(messages_beyond_the_bound_are_lost, Waiting-Left == 50-0) :-
    with_settings([typhon_backlog:messages=50],
        capturing(with_hosts([alpha],
                             ( concurrent_forall(between(1, 200, N),
                                                 unknown_gets(N), [threads(4)]),
                               flag(typhon_mail, Waiting, Waiting) )), Ms)),
    flag(typhon_mail, Left, Left),
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
