:- module(test_costs, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(typhon)).

/** <module> Costs of links, and of the links of networks

*Threading*: one test at a time.
*/

%   costs_at(+Host, -Costs): the costs of the links of Host, by the names of
%   their other hosts.

costs_at(Host, Costs) :-
    remote(Host, findall(To-Cost, neighbour(To, Cost), Pairs)),
    findall(Name-Cost,
            ( member(To-Cost, Pairs), atomic_list_concat([Name, _], @, To) ),
            Costs0),
    sort(Costs0, Costs).

:- begin_tests(link_costs).

test(cost_is_one_by_default, A-B == [beta-1]-[alpha-1]) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), costs_at(alpha, A), costs_at(beta, B) )).
test(cost_applies_in_both_directions, A-B == [beta-2.5]-[alpha-2.5]) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta, [cost(2.5)]),
                 costs_at(alpha, A), costs_at(beta, B) )).
test(cost_is_changed_by_linking_again,
     All == [[beta-2],[beta-2],[beta-7],[beta-0]]) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta, [cost(2)]), costs_at(alpha, C1),
                 link(alpha, beta), costs_at(alpha, C2),
                 link(beta, alpha, [cost(7)]), costs_at(alpha, C3),
                 link(beta, alpha, [cost(0)]), costs_at(alpha, C4) )),
    All = [C1,C2,C3,C4].
test(cost_is_forgotten_by_unlink, A == [beta-1]) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta, [cost(2)]), unlink(alpha, beta),
                 \+ remote(alpha, neighbour(_, _)),
                 link(alpha, beta), costs_at(alpha, A) )).
test(order_of_neighbours_is_kept, Names == [gamma,beta]) :-
    with_hosts([alpha,beta,gamma],
               ( link(alpha, gamma), link(alpha, beta),
                 link(alpha, gamma, [cost(9)]),
                 remote(alpha, neighbours(Hosts)),
                 findall(Name, ( member(H, Hosts),
                                 atomic_list_concat([Name,_], @, H) ),
                         Names) )).
test(cost_of_one_neighbour, C == 4) :-
    with_hosts([alpha,beta,gamma],
               ( link(alpha, beta, [cost(4)]), address(beta, Beta),
                 remote(alpha, neighbour(beta, C)),
                 remote(alpha, neighbour(Beta, C)),
                 \+ remote(alpha, neighbour(gamma, _)) )).
test(agent_takes_the_cheapest_path, F == [s(gamma)]) :-
    with_hosts([alpha,beta,gamma],
               ( link(alpha, beta, [cost(4)]), link(alpha, gamma, [cost(3)]),
                 create([ on_message(_, _),
                          (main :- findall(C-H, neighbour(H, C), L),
                                   keysort(L, [_-Next|_]), move(Next),
                                   here(Here),
                                   atomic_list_concat([Name,_], @, Here),
                                   assertz(s(Name))) ], A),
                 wait_state(A, resident), facts(A, F) )).
test(restarted_host_has_no_costs, A == [beta-1]) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta, [cost(2)]),
                 host_stop(beta), host_start(beta),
                 link(alpha, beta), costs_at(alpha, A) )).
test(negative, error(domain_error(cost, -1))) :-
    with_hosts([alpha,beta], link(alpha, beta, [cost(-1)])).
test(no_number, error(type_error(number, dear))) :-
    with_hosts([alpha,beta], link(alpha, beta, [cost(dear)])).
test(unknown_option, error(domain_error(link_option, price(1)))) :-
    with_hosts([alpha,beta], link(alpha, beta, [price(1)])).
test(unknown_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], link(alpha, nowhere, [cost(1)])).

:- end_tests(link_costs).

:- begin_tests(network_costs).

test(one_cost_for_all_links, C == [n1-3,n3-3]) :-
    with_network(line(3), [cost(3), clock(virtual)], _, costs_at(n2, C)).
test(default_cost, C == [n1-1,n3-1]) :-
    with_network(line(3), [clock(virtual)], _, costs_at(n2, C)).
test(costs_of_listed_links, A-B == [b-4]-[a-4,c-2]) :-
    with_network(edges([a-b-cost(4), b-c]), [cost(2), clock(virtual)], _,
                 ( costs_at(a, A), costs_at(b, B) )).
test(costs_drawn_from_the_seed, C1 == C2) :-
    drawn(5, C1),
    drawn(5, C2),
    drawn(6, C3),
    C1 \== C3,
    forall(member(_-C, C1), ( C >= 2, C =< 9 )).

drawn(Seed, Costs) :-
    with_network(mesh(5), [cost(uniform(2, 9)), seed(Seed), clock(virtual)],
                 _, findall(H-C, ( member(H, [n1,n2,n3,n4,n5]),
                                   costs_at(H, Cs), member(_-C, Cs) ),
                            Costs)).

%   Links come and go repeatedly: two hosts have the same cost whenever they
%   are linked.

test(costs_of_returning_links) :-
    with_network(ring(6), [ cost(uniform(1, 100)), seed(3), clock(virtual),
                            dynamic(dynamic_2) ], Network,
                 ( costs(Early),
                   findall(Costs, ( between(1, 10, _),
                                    network_advance(Network, 20),
                                    costs(Costs) ),
                           Lists),
                   last(Lists, Late) )),
    Early \== Late,
    findall(Pair-C, ( member(L, [Early|Lists]), member(Pair-C, L) ), All0),
    sort(All0, All),
    forall(( member(P-C1, All), member(P-C2, All) ), C1 =:= C2).

costs(Costs) :-
    findall(Pair-C,
            ( member(H, [n1,n2,n3,n4,n5,n6]), costs_at(H, Cs),
              member(To-C, Cs), msort([H,To], Pair) ),
            Costs).

test(costs_in_several_processes, [C1,C2,C4] == [[n2-5],[n1-5,n3-8],[n3-5]]) :-
    with_network(edges([n1-n2, n2-n3-cost(8), n3-n4]),
                 [processes(2), cost(5)], _, [A1,A2,_,A4],
        maplist(costs_at, [A1,A2,A4], [C1,C2,C4])).
test(invalid_cost, error(domain_error(cost, dear))) :-
    network_start(line(2), _, [cost(dear)]).
test(negative_cost, error(domain_error(cost, -1))) :-
    network_start(line(2), _, [cost(-1)]).
test(invalid_interval, error(domain_error(cost, uniform(2, 1)))) :-
    network_start(line(2), _, [cost(uniform(2, 1))]).

:- end_tests(network_costs).
