:- module(test_within, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Agents hop between hosts of one process

*Threading*: tests run one at a time.
*/

:- begin_tests(hops_within_a_process).

test(mail_comes_along, true(F == [s(1),s(2),s(3)])) :-
    with_hosts([alpha,beta],
               ( create([ (main :- receive(_-go), move(beta), move(alpha),
                                   take(3)),
                          (take(0) :- !),
                          (take(N) :- receive(_-M), assertz(s(M)), N1 is N-1,
                                      take(N1)),
                          on_message(_, _) ], A),
                 maplist(agent_send(A), [1,2,3,go]),
                 wait_state(A, resident),
                 agent_property(A, facts(F)) )).
test(it_stands_nowhere_else, true(Loads-In-Out == [0,1]-1-1)) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta)), on_message(_, _)], A),
                 wait_state(A, resident),
                 maplist(load, [alpha,beta], Loads),
                 host_property(beta, hop_time(in, stats(In, _, _, _))),
                 host_property(alpha, hop_time(out, stats(Out, _, _, _))) )).
test(refused_it_takes_no_room, true(Loads == [1,0])) :-
    with_hosts([alpha,beta-[tokens([red])]],
               ( create([(main :- catch(move(beta), _, true)),
                         on_message(_, _)], A),
                 wait_state(A, resident),
                 maplist(load, [alpha,beta], Loads) )).
test(orders_find_it_wherever_it_is, true(Loads == [0,0,0])) :-
    with_hosts([alpha,beta,gamma],
               ( findall(A, ( between(1, 30, _), walker(A) ), Agents),
                 numlist(1, 20, Numbers),
                 forall(( member(N, Numbers), member(A, Agents) ),
                        agent_send(A, N)),
                 maplist(heard(Numbers), Agents),
                 maplist(agent_dispose, Agents),
                 maplist(joined_as(disposed), Agents),
                 maplist(load, [alpha,beta,gamma], Loads) )).

:- end_tests(hops_within_a_process).

load(Host, Load) :-
    host_property(Host, load(Load)).

%   It goes round until it is ended, and keeps what it is told in order.

walker(A) :-
    create([ (main :- move(beta), hear, move(gamma), hear, move(alpha), hear,
                      main),
             (hear :- ( receive(_-M, 0)
                      -> assertz(s(M)), hear
                      ;  true )) ], A).

heard(Numbers, Agent) :-
    wait_until(( agent_property(Agent, facts(Facts)),
                 findall(N, member(s(N), Facts), Heard),
                 Heard == Numbers ), 20).

joined_as(Outcome, Agent) :-
    joined(Agent, Outcome).
