:- module(test_away, []).

% Hosts that are out of reach for a while, in virtual time.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/networks').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- meta_predicate with_two(-, -, -, 0).

with_two(Network, Here, There, Goal) :-
    with_network(line(2), [clock(virtual), seed(7)], Network,
                 ( network_property(Network, hosts([Here,There])),
                   once(Goal) )).

away(Network, Host, From, To) :-
    network_at(Network, From, host_change(Host, away(true))),
    network_at(Network, To, host_change(Host, away(false))).

goer(There, Here, Agent) :-
    create([ (main :- sleep(10), go(There, E1), sleep(20), go(There, E2),
                      here(Where), sleep(30), go(Here, E3), sleep(30),
                      go(Here, E4), result([E1,E2,Where,E3,E4])),
             (go(To, E) :- catch(( move(To), E = none ), error(E, _), true)) ],
           Agent, [host(Here)]).

:- begin_tests(away).

test(no_agent_comes_to_or_leaves_a_host_that_is_away,
     true(Found == [ host_unreachable(There), none, There,
                     host_unreachable(Here), none ])) :-
    no_leaks(with_two(N, Here, There,
                      ( away(N, There, 5, 15),
                        away(N, There, 50, 70),
                        goer(There, Here, Agent),
                        agent_join(Agent, done, 1000),
                        agent_result(Agent, Found, 1) ))).

test(no_clone_goes_to_a_host_that_is_away,
     true(Found == host_unreachable(There))) :-
    with_two(_, Here, There,
             ( host_change(There, away(true)),
               create([(main :- catch(( clone(There, _), E = none ),
                                      error(E, _), true),
                                result(E))], Agent, [host(Here)]),
               agent_join(Agent, done, 10),
               agent_result(Agent, Found, 1) )).

test(no_message_comes_to_or_from_a_host_that_is_away,
     true(Found-Got == [host_unreachable(Here),none]-[inside,later])) :-
    with_two(N, Here, There,
             ( create([(main :- receive(_-A), receive(_-B), result([A,B]))],
                      Reader, [host(There)]),
               create([(main :- receive(_), result(none))], Other,
                      [host(Here)]),
               host_change(There, away(true)),
               network_at(N, 20, host_change(There, away(false))),
               assertion(catch(agent_send(Reader, outside),
                               error(host_unreachable(There), _), true)),
               create([(main :- catch(( send(Other, a), E = none ),
                                      error(E, _), true),
                                send(Reader, inside), sleep(30),
                                catch(( send(Other, b), F = none ),
                                      error(F, _), true),
                                send(Reader, later), result([E,F]))],
                      Sender, [host(There)]),
               agent_join(Sender, done, 100),
               agent_result(Sender, Found, 1),
               agent_join(Reader, done, 10),
               agent_result(Reader, Got, 1),
               agent_join(Other, done, 10) )).

test(host_is_away_only_where_all_hosts_are_in_one_process,
     error(permission_error(change, host_option, away(true)))) :-
    with_hosts([alpha-[]], host_change(alpha, away(true))).

:- end_tests(away).
