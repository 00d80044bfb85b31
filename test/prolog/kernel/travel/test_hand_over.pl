:- module(test_hand_over, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/travellers').
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).

/** <module> The short path of a hop between plain hosts

On the short path an agent under way is only the frame that was sent. Queries
and outcomes are the same as for an agent that was sent by request. Options
that are switched on and off while agents hop change the path, and no agent is
lost or duplicated.

*Threading*: the main thread; the hosts are in other processes.
*/

%   with_under_way(+Facts, -Agent, :Goal): an agent of a, created with Facts,
%   is under way to b, which is suspended, while Goal is called.

:- meta_predicate with_under_way(+, -, 0).

with_under_way(Facts, Id, Goal) :-
    with_peers([a, b], ( set_under_way(Facts, true, Id), call(Goal) )).

%   set_under_way(+Facts, :Change, -Id): b is suspended after Change.

set_under_way(Facts, Change, Id) :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 4),               % connects, and brings no program of its
    visitor(Clauses),
    peer_agent(a, Clauses, [to(B)|Facts], Id),
    wait_until(peer_do(a, agent_property(Id, state(waiting))), 10),
    call(Change),
    peer_signal(b, stop),
    peer_do(a, agent_send(Id, go)),
    wait_until(peer_do(a, handed_over(Id)), 10).

visitor([ (:- agent(visitor, [state([to/1, fact/1, got/1])])),
          (main :- receive(_-go), to(B),
                   catch(move(B), error(E, _), leave(raised(E))),
                   stay),
          (stay :- receive(_-Message),
                   (   Message == end
                   ->  findall(X, got(X), All),
                       here(Here),
                       result(Here-All)
                   ;   assertz(got(Message)),
                       stay
                   )) ]).

:- begin_tests(under_way).

test(properties_under_way,
     State-Facts-Hops-Ids == in_transit-[fact(1),fact(2)]-0-[Id]) :-
    with_under_way([fact(1), fact(2)], Id,
        ( peer_do(a, findall(A, agent_property(A, home(_)), Ids)),
          peer_do(a, agent_property(Id, state(State))),
          peer_do(a, agent_property(Id, facts(All))),
          findall(fact(X), member(fact(X), All), Facts),
          peer_do(a, agent_property(Id, hops(Hops))),
          goes_on(Id) )).
%   A query thaws the agent.

test(messages_follow_in_order,
     [ forall(member(Query, [ true,
                              peer_do(a, agent_property(Id,
                                                        state(in_transit))) ])),
       Result == B-All ]) :-
    numlist(1, 20, All),
    with_under_way([], Id,
        ( peer_host(b, B),
          forall(member(N, All),
                 ( peer_do(a, agent_send(Id, N)),
                   ( N =:= 10 -> call(Query) ; true ) )),
          peer_signal(b, cont),
          result_of(Id, Result) )).
test(its_host_is_stopped_during_the_hop) :-
    with_under_way([], Id,
        ( peer_signal(b, cont),
          peer_do(a, host_stop(a)),
          peer_do(a, \+ agent_here(Id)) )).

test(its_host_stops_and_it_is_refused, Outcome == disposed) :-
    with_peers([a, b],
        ( peer_do(a, host_start(other)),
          peer_agent(a, [ (:- agent(rests, [])), (main :- receive(_)) ], [],
                     Other),
          set_under_way([], peer_do(b, host_change(b, tokens([red]))), Id),
          peer_do(a, thread_create(host_stop(a), _, [alias(stops)])),
          wait_until(peer_do(a, \+ agent_here(Other)), 10),
          peer_signal(b, cont),
          peer_do(a, thread_join(stops)),
          peer_do(a, agent_join(Id, Outcome, 10)) )).

:- end_tests(under_way).

goes_on(Id) :-
    peer_signal(b, cont),
    wait_until(( peer_do(a, agent_property(Id, host(Host))),
                 peer_host(b, Host) ), 20).

result_of(Id, Result) :-
    peer_do(a, agent_send(Id, end)),
    wait_until(peer_do(a, agent_result(Id, Result, 1)), 20).

%   connected(:Goal): Goal is called with the host of b, which has had agents.

:- meta_predicate connected(-, 0).

connected(B, Goal) :-
    with_peers([a, b], ( peer_host(a, A),
                         peer_host(b, B),
                         travel(a, [B, A], 4),
                         call(Goal) )).

raised_on_a(Error) :-
    wait_until(peer_do(a, remote(a, take(raised(Error)))), 20).

:- begin_tests(not_accepted).

test(refusal_raises_at_the_move,
     [ forall(member(Change-Reason, [ tokens([red])-token,
                                      capacity(0)-capacity ])),
       Error == move_refused(B, Reason) ]) :-
    connected(B,
        ( peer_do(b, host_change(b, Change)),
          peer_agent(a, [ (:- agent(mover, [])),
                          (main :- catch(move(B), error(E, _),
                                         leave(raised(E)))) ], [], _),
          raised_on_a(Error) )).
test(unserializable_agent_raises_at_the_move,
     Error = type_error(mobile_term, _)) :-
    connected(B,
        ( peer_agent(a,
              [ (:- agent(carrier, [])),
                (main :- stream_property(S, alias(user_error)),
                         catch(go(S), error(E, _),
                               ( E = type_error(K, _),
                                 leave(raised(type_error(K, x))) ))),
                (go(S) :- to(B1), move(B1), atom(S)),
                to(B) ], [], _),
          raised_on_a(Error) )).
test(agent_that_stays_keeps_its_mail,
     [ forall(stays(Change, Held)), Mail == [1,2,3] ]) :-
    connected(B,
        ( peer_do(b, host_change(b, Change)),
          peer_agent(a, [ (:- agent(stayer, [state([got/1])])),
                          (main :- receive(_-go), held(S),
                                   catch(( move(B), atom(S) ), error(_, _),
                                         true),
                                   hear),
                          (hear :- (   receive(_-M, 0)
                                   ->  assertz(got(M)), hear
                                   ;   findall(M, got(M), Ms), leave(mail(Ms))
                                   )),
                          Held ], [], Id),
          forall(member(M, [1,2,3,go]), peer_do(a, agent_send(Id, M))),
          wait_until(peer_do(a, remote(a, take(mail(Mail)))), 20) )).

%   stays(?Change, ?Held): the host changes, or the agent cannot travel.

stays(tokens([red]), held(none)).
stays(capacity(0), held(none)).
stays(tokens([]), (held(S) :- stream_property(S, alias(user_error)))).

:- end_tests(not_accepted).

:- begin_tests(options_under_traffic).

%   Ten agents hop, while one option after the other is switched on and off on
%   both hosts.

test(changing_options_loses_no_agent, [forall(may_have(Options))]) :-
    with_peers([a-[host(Options)], b-[host(Options)]],
        ( peer_host(a, A),
          peer_host(b, B),
          travel(a, [B, A], 2),
          findall(Id, ( between(1, 10, _), set_out(a, [B, A], 100, Id) ), Ids),
          forall(( between(1, 2, _),
                   switched(On, Off),
                   member(Peer, [a, b]) ),
                 ( peer_do(Peer, host_change(Peer, On)),
                   forall(member(X, [a, b]), travel(X, [B, A], 4)),
                   peer_do(Peer, host_change(Peer, Off)) )),
          forall(member(Id, Ids), ended_done(a, Id, 100)) )).

:- end_tests(options_under_traffic).

%   Without cell(none) a policy needs cells.

may_have([]) :-
    missing([cells], []).
may_have([cell(none)]).

switched(quota([hops(1 000 000)]), quota([])).
switched(peer([cookie-all]), peer([cookie-[agents, messages, orders, remote,
                                           watch]])).
switched(hop_time(uniform(0.0, 0.001)), hop_time(uniform(0.0, 0.0))).
switched(policy(guarded), policy(trusted)).
