:- module(test_costs, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
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

%   The cost of a link after goals that make it, at both of its hosts.

test(cost_of_the_last_link_counts,
     [ forall(member(Goals-Cost,
                     [ [link(alpha, beta)]-1,
                       [link(alpha, beta, [cost(2.5)])]-2.5,
                       [link(alpha, beta, [cost(2)]), link(alpha, beta)]-2,
                       [ link(alpha, beta, [cost(2)]),
                         link(beta, alpha, [cost(7)]) ]-7,
                       [ link(alpha, beta, [cost(2)]),
                         link(beta, alpha, [cost(0)]) ]-0,
                       [ link(alpha, beta, [cost(2)]), host_stop(beta),
                         host_start(beta), link(alpha, beta) ]-1 ])),
       true(A-B == [beta-Cost]-[alpha-Cost]) ]) :-
    with_hosts([alpha,beta],
               ( maplist(call, Goals), costs_at(alpha, A), costs_at(beta, B) )).
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
test(bad_link,
     [ forall(member(Goal-Formal,
                     [ link(alpha, beta, [cost(-1)])-domain_error(cost, -1),
                       link(alpha, beta, [cost(dear)])-type_error(number, dear),
                       link(alpha, beta, [price(1)])-
                       domain_error(link_option, price(1)),
                       link(alpha, nowhere, [cost(1)])-
                       existence_error(host, nowhere) ])),
       error(Formal) ]) :-
    with_hosts([alpha,beta], Goal).

:- end_tests(link_costs).

:- begin_tests(network_costs).

test(one_cost_for_all_links,
     [ forall(member(Options-Cost, [[]-1, [cost(3)]-3])),
       C == [n1-Cost,n3-Cost] ]) :-
    with_network(line(3), [clock(virtual)|Options], _, costs_at(n2, C)).
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
test(invalid_cost, [ forall(member(Cost, [dear, -1, uniform(2, 1)])),
                    error(domain_error(cost, Cost)) ]) :-
    network_start(line(2), _, [cost(Cost)]).

:- end_tests(network_costs).
