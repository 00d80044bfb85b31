:- module(test_moves, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Orders to move whose caller waits for the outcome

*/

%   A resident agent on host alpha.

resident(Agent, Options) :-
    create([on_message(_, _)], Agent, [host(alpha)|Options]),
    wait_state(Agent, resident).

stands(Agent, Host) :-
    address(Host, Address),
    agent_property(Agent, host(At)),
    At == Address.

%   moved(+Agent, +Host, -Formal): `none` if the agent has arrived.

moved(Agent, Host, Formal) :-
    catch(( agent_move(Agent, Host, [wait(10)]), Formal = none ),
          error(Formal, _), true).

:- begin_tests(moves).

test(caller_returns_when_the_agent_is_there,
     [ forall(member(Options, [[], [hop_time(uniform(0.1, 0.2))]])) ]) :-
    with_hosts([alpha-Options, beta],
               ( resident(A, []),
                 forall(between(1, 2, _),
                        ( agent_move(A, beta, [wait(10)]),
                          assertion(stands(A, beta)) )) )).
test(caller_waits_in_virtual_time, T == 30.0) :-
    with_hosts([ alpha-[clock(virtual), hop_time(uniform(30, 30))],
                 beta-[clock(virtual)] ],
               ( resident(A, []),
                 agent_move(A, beta, [wait(100)]),
                 assertion(stands(A, beta)),
                 remote(beta, now(T)) )).
test(caller_waits_for_another_process) :-
    with_hosts([alpha],
               with_peers([beta, gamma],
                          ( resident(A, []),
                            peer_host(beta, Beta),
                            agent_move(A, Beta, [wait(10)]),
                            assertion(agent_property(A, host(Beta))),
                            peer_host(gamma, Gamma),
                            agent_move(A, Gamma, [wait(10)]),
                            assertion(agent_property(A, host(Gamma))),
                            agent_dispose(A),
                            agent_join(A, _, 5) ))).
test(refusal_is_an_error_and_no_warning,
     Formal-Warnings == move_refused(Beta, capacity)-[]) :-
    with_hosts([alpha, beta-[capacity(0)]],
               ( address(beta, Beta),
                 resident(A, []),
                 capturing(moved(A, beta, Formal), Warnings),
                 assertion(stands(A, alpha)) )).
test(refusal_by_another_process_is_an_error,
     Formal == move_refused(Beta, capacity)) :-
    with_hosts([alpha],
               with_peers([beta-[host([capacity(0)])]],
                          ( peer_host(beta, Beta),
                            resident(A, []),
                            moved(A, Beta, Formal),
                            assertion(stands(A, alpha)) ))).
test(unreachable_host_is_an_error, Formal == host_unreachable(Host)) :-
    free_port(Port),
    format(atom(Host), 'nowhere@127.0.0.1:~d', [Port]),
    with_hosts([alpha],
               ( resident(A, []),
                 moved(A, Host, Formal),
                 assertion(stands(A, alpha)) )).
test(immobile_agent_is_an_error,
     Formal == permission_error(move, static_agent, A)) :-
    with_hosts([alpha, beta],
               ( resident(A, [static(true)]), moved(A, beta, Formal) )).
test(agent_that_ends_before_the_move_is_an_error,
     Formal == existence_error(agent, A)) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1000))], beta],
               ( resident(A, []),
                 thread_create(( wait_state(A, in_transit),
                                 agent_dispose(A) ), Thread),
                 moved(A, beta, Formal),
                 thread_join(Thread) )).
test(order_is_executed_after_a_timeout) :-
    with_hosts([ alpha-[clock(virtual), hop_time(uniform(30, 30))],
                 beta-[clock(virtual)] ],
               ( resident(A, []),
                 catch(agent_move(A, beta, [wait(10)]), error(Formal, _),
                       true),
                 assertion(Formal == timeout_error(order, A)),
                 agent_join(A, timeout, 30),
                 assertion(stands(A, beta)) )).
test(option_is_checked, error(domain_error(move_option, wiat(1)))) :-
    with_hosts([alpha], ( resident(A, []),
                          agent_move(A, alpha, [wiat(1)]) )).

:- end_tests(moves).
