:- module(test_full_mailbox, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [last/2, member/2, sum_list/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/agent), [mail_fitting/4]).

/** <module> Mailboxes that are full

*Threading*: one test at a time; several threads send in one of them.
*/

full(Agent, Options) :-
    create([(main :- receive(_-stop))], Agent, Options),
    wait_state(Agent, waiting),
    forall(between(1, 1000, I), agent_send(Agent, I)).

waiting(Agent, Messages) :-
    agent_property(Agent, mailbox(Messages)).

small(Goal) :-
    with_settings([typhon_mailbox:messages=1000], Goal).

:- meta_predicate small(0).

:- begin_tests(full_mailbox).

test(message_to_a_full_mailbox_raises_an_error,
     true(Formal-Count == resource_error(mailbox)-1000)) :-
    small(with_hosts([alpha],
                     ( full(A, []),
                       catch(agent_send(A, more), error(Formal, _), true),
                       waiting(A, All),
                       length(All, Count) ))).
test(agent_that_sends_to_a_full_mailbox_goes_on, true(O-W == done-1)) :-
    small(with_hosts([alpha],
                     capturing(( full(A, []),
                                 create([(main :- receive(_-to(To)),
                                                  send(To, more))], B),
                                 agent_send(B, to(A)),
                                 joined(B, O) ), Told))),
    Lost = undeliverable(resource_error(mailbox), _, _, more),
    aggregate_all(count, member(_-typhon(Lost), Told), W).
test(mailbox_has_never_more_messages_whatever_threads_send,
     true(Count-Refused == 1000-800)) :-
    small(with_hosts([alpha],
                     ( create([(main :- receive(_-stop))], A),
                       findall(T, ( between(1, 4, _),
                                    thread_create(send_many(A), T) ), Ts),
                       findall(R, ( member(T, Ts), thread_join(T, exited(R)) ),
                               Rs),
                       sum_list(Rs, Refused),
                       waiting(A, All),
                       length(All, Count) ))).
test(platform_messages_always_fit, true(Last == system-down(B, done))) :-
    small(with_hosts([alpha],
                     ( create([ (main :- receive(_-watch(C)), monitor(C),
                                         receive(_-stop)) ], A),
                       create([(main :- receive(_-stop))], B),
                       agent_send(A, watch(B)),
                       wait_until(agent_property(A, goals([receive(_-stop)])), 10),
                       forall(between(1, 1000, I), agent_send(A, I)),
                       agent_send(B, stop),
                       wait_until(( waiting(A, All), length(All, 1001) ), 10),
                       last(All, Last) ))).
test(messages_that_come_together_fit_as_far_as_there_is_space,
     [ forall(member(Before-Expected, [ 998-[user-1, user-2, system-3],
                                        1000-[system-3] ])),
       Fit == Expected ]) :-
    small(with_hosts([alpha],
                     ( create([(main :- receive(_-stop))], A),
                       wait_state(A, waiting),
                       forall(between(1, Before, I), agent_send(A, I)),
                       findall(mail(N, From, N),
                               member(From-N, [ user-1, user-2, user-4, system-3,
                                                user-5 ]),
                               Mail),
                       mail_fitting(A, Mail, Fitting, Rest),
                       length(Rest, Left),
                       length(Expected, Fitted),
                       Left =:= 5-Fitted,
                       findall(From-N, member(mail(_, From, N), Fitting),
                               Fit) ))).
test(full_mailbox_hops, true(Same-Error == true-resource_error(mailbox))) :-
    small(with_hosts([alpha, beta],
                     ( full(A, [host(alpha)]),
                       waiting(A, Before),
                       address(beta, Beta),
                       agent_move(A, Beta, [wait(20)]),
                       waiting(A, After),
                       ( After == Before -> Same = true ; Same = false ),
                       catch(agent_send(A, more), error(Error, _), true) ))).
test(message_from_another_process_is_reported_where_it_was_sent,
     Count-There == 1000-false) :-
    no_leaks(with_peers([a, b], remote_full(Count, There))).

remote_full(Count, There) :-
    peer_do(b, set_setting(typhon_mailbox:messages, 1000)),
    peer_host(b, B),
    peer_do(a, agent_create(clauses([ (:- agent(full, [])),
                                      (main :- receive(_-stop)) ]),
                            A, [host(B)])),
    peer_do(a, forall(between(1, 1001, I), agent_send(A, I))),
    wait_until(reported(a), 20),
    ( reported(b) -> There = true ; There = false ),
    peer_do(b, ( agent_property(A, mailbox(All)), length(All, Count) )).

reported(Peer) :-
    peer_messages(Peer, Lines),
    member(Line, Lines),
    sub_string(Line, _, _, _, "mailbox is full"),
    !.

send_many(A) :-
    aggregate_all(count, ( between(1, 450, _), \+ accepts(A) ), Refused),
    thread_exit(Refused).

accepts(A) :-
    catch(agent_send(A, m), error(resource_error(mailbox), _), fail).

:- end_tests(full_mailbox).
