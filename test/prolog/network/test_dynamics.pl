:- module(test_dynamics, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures', [capturing/2, was_printed/2]).
:- use_module('../../lib/networks').
:- use_module('../../lib/virtual_networks', [network_history/5]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, foldl/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [ append/3, max_list/2, member/2, min_list/2, nth1/3,
                subtract/3, sum_list/2 ]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).

/** <module> Links that come and go

*Threading*: the main thread.
*/

%   history(+Model, +Topology, +Seed, +Until, -N, -Edges, -Changes): in a
%   network of N hosts, that begins with Edges, Changes before Until.

history(Model, Topology, Seed, Until, N, Edges, Changes) :-
    network_history(Topology, [dynamic(Model), seed(Seed)], Until,
                    shape(N, Edges, _), Changes).

apply_change(_-link(I, J), L, [I-J|L]) :-
    assertion(\+ memberchk(I-J, L)).
apply_change(_-unlink(I, J), L0, L) :-
    assertion(memberchk(I-J, L0)),
    subtract(L0, [I-J], L).

degrees(N, Links, Degrees) :-
    findall(D,
            ( between(1, N, Host),
              aggregate_all(count,
                            ( member(A-B, Links), ( A == Host ; B == Host ) ),
                            D) ),
            Degrees).

count_changes(Changes, Functor, Count) :-
    aggregate_all(count,
                  ( member(_-Change, Changes), functor(Change, Functor, 2) ),
                  Count).

:- begin_tests(link_dynamics).

test(unknown_model,
     [ forall(member(M, [chaos, links(5, 0.1, 0.1),
                         links(uniform(0, 1), 0.1, 0.1),
                         links(uniform(2, 1), 0.1, 0.1),
                         toggle(uniform(1, 2), 1.5, 0)])),
       error(domain_error(dynamic_model, M)) ]) :-
    network_start(ring(3), _, [dynamic(M)]).
test(unbound_model, error(instantiation_error)) :-
    network_start(ring(3), _, [dynamic(_)]).
test(named_models_are_special_cases,
     [ forall(member(Name-Model,
                     [ random_links-links(uniform(10,20), 0.3, 0.5),
                       thesis_4_4_7-links(uniform(10,20), each(0.3), 0.5),
                       dynamic_1-toggle(uniform(10,20), 0.5, 0.7),
                       dynamic_2-links(uniform(10,20), 0.5, 0.7) ])),
       true(Named == General) ]) :-
    history(Name, grid(4, 5), 2, 100, _, _, Named),
    history(Model, grid(4, 5), 2, 100, _, _, General).
test(seed_determines_the_changes,
     true(( Changes == Again, Changes \== Others ))) :-
    history(random_links, grid(6, 10), 3, 60, _, _, Changes),
    history(random_links, grid(6, 10), 3, 60, _, _, Again),
    history(random_links, grid(6, 10), 4, 60, _, _, Others).
test(order_of_listed_links_does_not_matter,
     [ forall(member(Model, [ toggle(uniform(1, 2), 0.5, 0.5),
                              links(uniform(1, 2), 0.5, 0.5) ])),
       Changes == Others ]) :-
    history(Model, edges([1-2,3-4,2-3,2-4]), 3, 60, _, _, Changes),
    history(Model, edges([1-2,3-4,2-4,2-3]), 3, 60, _, _, Others).
test(changes_lead_to_the_current_links,
     [ forall(member(M, [random_links, thesis_4_4_7, dynamic_1, dynamic_2])),
       true(Links == Last) ]) :-
    network_history(grid(6, 10), [dynamic(M), seed(1)], 100,
                    shape(_, First, Last), Changes),
    foldl(apply_change, Changes, First, Links0),
    sort(Links0, Links),
    pairs_keys(Changes, Times),
    assertion(msort(Times, Times)).
test(every_host_acts_every_ten_to_twenty_seconds) :-
    history(toggle(uniform(10,20), 1, 1), ring(50), 1, 300, _, _, Changes),
    length(Changes, Count),             % 50 hosts, 20 changes each
    abs(Count - 1000) < 50,
    Changes = [First-_|_],
    First >= 10, First =< 20.
test(probabilities_of_section_4_4_7) :-
    history(random_links, ring(50), 1, 600, _, _, Changes),
    Acts is 50*600/15,
    count_changes(Changes, unlink, Dropped),
    count_changes(Changes, link, Made),
    abs(Dropped / Acts - 0.3) < 0.041,
    abs(Made / Acts - 0.5) < 0.045.
test(degrees_of_section_4_4_7) :-      % the thesis: 0 to 27, after the mesh
    network_history(mesh(50), [dynamic(thesis_4_4_7), seed(1)], 60,
                    shape(N, _, Links), _),
    degrees(N, Links, Degrees),
    min_list(Degrees, Min),
    max_list(Degrees, Max),
    Min =< 2,
    Max =< 27.
test(one_at_a_time_keeps_a_mesh_dense) :-
    network_history(mesh(50), [dynamic(random_links), seed(1)], 300,
                    shape(N, _, Links), _),
    degrees(N, Links, Degrees),
    min_list(Degrees, Min),
    Min > 40.
test(dynamic_1_uses_only_the_links_of_the_network) :-
    history(dynamic_1, grid(6, 10), 1, 300, _, Edges, Changes),
    forall(member(_-Change, Changes),
           ( Change =.. [_, I, J], memberchk(I-J, Edges) )).
test(dynamic_1_settles_at_seven_twelfths) :-
    findall(Share,
            ( between(1, 4, Seed),
              network_history(grid(6, 10), [dynamic(dynamic_1), seed(Seed)],
                              300, shape(_, _, Links), _),
              length(Links, L),
              Share is L / 104 ),
            Shares),
    sum_list(Shares, Sum),
    abs(Sum / 4 - 0.7 / 1.2) < 0.07.
test(dynamic_2_exceeds_the_degrees_of_the_grid) :-
    network_history(grid(6, 10), [dynamic(dynamic_2), seed(1)], 300,
                    shape(N, _, Links), Changes),
    degrees(N, Links, Degrees),
    max_list(Degrees, Max),
    Max > 4,
    Acts is 60*300/15,
    count_changes(Changes, unlink, Dropped),
    count_changes(Changes, link, Made),
    abs(Dropped / Acts - 0.5) < 0.06,
    abs(Made / Acts - 0.7) < 0.06.
test(certain_toggle_undoes_itself, First == Last) :-
    network_history(ring(2), [dynamic(toggle(uniform(1, 1), 1, 1)), seed(1)],
                    2.5, shape(_, First, Last), [_|_]).
test(single_host, Changes == []) :-
    history(random_links, ring(1), 1, 100, _, _, Changes).

:- end_tests(link_dynamics).

:- begin_tests(link_dynamics_in_real_time).

test(changes_occur_in_order_and_not_too_early) :-
    network_history(grid(6, 10), [dynamic(random_links), seed(1)], 40,
                    shape(_, First, _), Virtual),
    length(First, Made),
    length(Virtual, Count),
    Logged is Made + Count,
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'links.pl', File),
          with_network(grid(6, 10),
                       [ clock(100), dynamic(random_links), seed(1),
                         log(File, [links]) ], _, Hosts,
              ( wait_until(( changed(File, Hosts, Real), length(Real, N),
                             N >= Logged ), 60) )) )),
    length(Links, Made),
    append(Links, Changes, Real),
    length(Begun, Count),
    append(Begun, _, Changes),
    forall(nth1(I, Begun, Time-Change),
           ( nth1(I, Virtual, Due-Change),
             assertion(Time >= Due) )).

test(changes_go_on_beside_dead_processes_without_warnings, Others == []) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'links.pl', File),
          capturing(with_network(ring(6),
                                 [ processes(6), clock(5000), seed(1),
                                   dynamic(random_links), log(File, [links]) ],
                                 Network, Hosts,
                                 goes_on(Network, File, Hosts)),
                    Messages) )),
    exclude(subsumes_term(_-typhon(node_down(_, _, _, _, _))), Messages, Others).

goes_on(Network, File, Hosts) :-
    network_property(Network, processes([_, _|Pids])),
    forall(member(Pid, Pids),
           ( process_kill(Pid, kill),
             wait_until(was_printed(_, typhon(node_down(Network, Pid, _, _, _))),
                        10) )),
    changed(File, Hosts, Before),
    length(Before, Count),
    wait_until(( changed(File, Hosts, Changes), length(Changes, Now),
                 Now >= Count+20 ), 60).

%   The initial links come first, on a slow machine after some time.

changed(File, Hosts, Changes) :-
    log_events(File, Events),
    findall(Time-Change,
            ( member(event(Time, Host, none, What), Events),
              What =.. [Name, Other],
              nth1(I, Hosts, Host),
              nth1(J, Hosts, Other),
              I < J,
              Change =.. [Name, I, J] ),
            Changes).

:- end_tests(link_dynamics_in_real_time).
