:- module(test_topology, []).
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [append/3, member/2, numlist/3, sum_list/2]).
:- use_module(library(ugraphs), [reachable/3, vertices_edges_to_ugraph/3]).
:- use_module(library(typhon)).
:- use_module('../../lib/virtual_networks', [network_shape/5]).

/** <module> The shapes of networks

*Threading*: the main thread.
*/

edges(Topology, Seed, N, Edges) :-
    network_shape(Topology, [seed(Seed)], N, _, Edges).

names(Topology, Names) :-
    network_shape(Topology, [], _, Names, _).

degrees(N, Edges, Degrees) :-
    numlist(1, N, Hosts),
    maplist(degree(Edges), Hosts, Degrees).

degree(Edges, Host, Degree) :-
    aggregate_all(count, touches(Host, Edges), Degree).

touches(Host, Edges) :-
    member(A-B, Edges),
    ( A == Host ; B == Host ).

well_formed(N, Edges) :-
    sort(Edges, Edges),
    forall(member(A-B, Edges),
           ( integer(A), integer(B), 1 =< A, A < B, B =< N )).

:- begin_tests(topologies).

test(every_topology_is_connected,
     forall(member(T, [star_bus(6,10), star_bus(1,1), star_bus(4,1), ring(1),
                       ring(2), ring(3), ring(60), tree(1), tree(60),
                       grid(6,10), grid(1,5), grid(1,1), mesh(1), mesh(50),
                       random(50, 0.1), random(50, 0.0), random(9, 1),
                       edges([a-b, b-c])]))) :-
    edges(T, 1, N, Edges),
    well_formed(N, Edges),
    numlist(1, N, Hosts),
    findall(B-A, member(A-B, Edges), Back),
    append(Edges, Back, Both),
    vertices_edges_to_ugraph(Hosts, Both, Graph),
    reachable(1, Graph, Reachable),
    length(Reachable, N).
test(star_bus_of_sixty) :-
    edges(star_bus(6, 10), 1, N, Edges),
    N == 60,
    length(Edges, 59),
    degrees(N, Edges, Degrees),
    msort(Degrees, Sorted),
    length(Leaves, 54),
    maplist(=(1), Leaves),
    append(Leaves, [10, 10, 11, 11, 11, 11], Sorted).
test(star_bus_hubs_in_a_chain, Hubs == [1-11, 11-21]) :-
    edges(star_bus(3, 10), 1, _, Edges),
    findall(A-B, ( member(A-B, Edges), A mod 10 =:= 1, B mod 10 =:= 1 ),
            Hubs).
test(ring, true) :-
    edges(ring(60), 1, N, Edges),
    degrees(N, Edges, Degrees),
    maplist(=(2), Degrees).
test(ring_of_three_closes, Edges == [1-2, 1-3, 2-3]) :-
    edges(ring(3), 1, 3, Edges).
test(small_rings, [Two, One] == [[1-2], []]) :-
    edges(ring(2), 1, 2, Two),
    edges(ring(1), 1, 1, One).
test(tree, Edges == [1-2, 1-3, 2-4, 2-5, 3-6, 3-7]) :-
    edges(tree(7), 1, 7, Edges).
test(grid, Edges == [1-2, 1-4, 2-3, 2-5, 3-6, 4-5, 5-6]) :-
    edges(grid(2, 3), 1, 6, Edges).
test(grid_of_sixty, L == 104) :-
    edges(grid(6, 10), 1, 60, Edges),
    length(Edges, L).
test(line, Edges == [1-2, 2-3, 3-4]) :-
    edges(line(4), 1, 4, Edges).
test(star, Edges == [1-2, 1-3, 1-4]) :-
    edges(star(4), 1, 4, Edges).
test(one_host, [forall(member(T, [line(1), star(1)])), N-Edges == 1-[]]) :-
    edges(T, 1, N, Edges).
test(mesh, L == 4950) :-
    edges(mesh(100), 1, 100, Edges),
    length(Edges, L).
test(random_with_probability_zero_is_a_tree, L == 29) :-
    edges(random(30, 0), 7, 30, Edges),
    length(Edges, L).
test(random_with_probability_one_is_a_mesh, L == 435) :-
    edges(random(30, 1.0), 7, 30, Edges),
    length(Edges, L).
test(random_is_repeatable, A == B) :-
    edges(random(40, 0.2), 5, 40, A),
    edges(random(40, 0.2), 5, 40, B),
    edges(random(40, 0.2), 6, 40, C),
    A \== C.
test(random_has_the_density_asked_for, true) :-
    findall(L,
            ( between(1, 20, Seed),
              edges(random(50, 0.3), Seed, 50, Edges),
              length(Edges, L) ),
            Ls),
    sum_list(Ls, Sum),
    Mean is Sum / (20 * 1225),
    abs(Mean - 0.3) < 0.012.            % four standard deviations
test(edges_by_name, N-Edges-Names == 4-[1-2, 2-3, 2-4]-[a, n7, b, n2]) :-
    T = edges([a-7, 7-b, b-7, n2-7]),
    network_shape(T, [], N, Names, Edges).
test(names, [forall(member(T, [ring(3), star(3)])), Names == [n1, n2, n3]]) :-
    names(T, Names).

:- end_tests(topologies).

:- begin_tests(topology_errors).

invalid(_, instantiation_error).
invalid(ring(_), instantiation_error).
invalid(Topology, type_error(positive_integer, 0)) :-
    member(Topology, [ line(0), ring(0), star(0), tree(0), mesh(0),
                       random(0, 0.5), grid(0, 2), grid(2, 0), star_bus(0, 2),
                       star_bus(2, 0) ]).
invalid(ring(many), type_error(positive_integer, many)).
invalid(torus(3), domain_error(topology, torus(3))).
invalid(grid(3), domain_error(topology, grid(3))).
invalid(random(5, 1.5), domain_error(probability, 1.5)).
invalid(random(5, -0.1), domain_error(probability, -0.1)).
invalid(random(5, p), type_error(number, p)).
invalid(edges([]), domain_error(topology, edges([]))).
invalid(edges([a]), type_error(edge, a)).
invalid(edges([a-a]), domain_error(edge, a-a)).
invalid(edges([1-n1]), domain_error(edge, 1-n1)).
invalid(edges([a-"b"]), type_error(host_name, "b")).
invalid(edges(a), type_error(list, a)).
invalid(edges([a-cost(1)]), type_error(edge, a-cost(1))).
invalid(edges([a-b-cost(x)]), type_error(number, x)).

test(invalid_topology, forall(invalid(Topology, Formal))) :-
    catch(network_start(Topology, _, []), error(Formal1, _), true),
    assertion(Formal1 =@= Formal).
test(invalid_seed, error(type_error(integer, a))) :-
    network_start(ring(3), _, [seed(a)]).

:- end_tests(topology_errors).
