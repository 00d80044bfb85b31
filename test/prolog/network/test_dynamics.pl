:- module(test_dynamics, []).
:- use_module('../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists),
              [ append/3, max_list/2, member/2, min_list/2,
                same_length/2, subtract/3, sum_list/2
              ]).
:- use_module(library(yall)).
:- use_module(library(typhon/kernel/host), [runtime_acquire/2, runtime_release/1]).
:- use_module(library(typhon/network/changes)).
:- use_module(library(typhon/network/dynamics)).
:- use_module(library(typhon/network/topology)).

%   history(+Spec, +Topology, +Seed, +Until, -N, -Edges, -Events): the
%   Events, Time-Changes, before Until.

history(Spec, Topology, Seed, Until, N, Edges, Events) :-
    dynamics_model(Spec, Model),
    topology_edges(Topology, 1, N, Edges),
    dynamics_state(Model, N, Edges, Seed, State),
    events(State, Until, Events).

events(State0, Until, Events) :-
    dynamics_event(State0, Time, Changes, State),
    (   Time < Until
    ->  Events = [Time-Changes|Rest],
        events(State, Until, Rest)
    ;   Events = []
    ).

links_after(Edges, Events, Links) :-
    foldl([_-Changes, L0, L]>>foldl(apply_change, Changes, L0, L),
          Events, Edges, Links).

apply_change(link(I, J), L0, [E|L0]) :-
    edge(I, J, E),
    assertion(\+ memberchk(E, L0)).
apply_change(unlink(I, J), L0, L) :-
    edge(I, J, E),
    assertion(memberchk(E, L0)),
    subtract(L0, [E], L).

edge(I, J, A-B) :-
    A is min(I, J),
    B is max(I, J).

degrees(N, Links, Degrees) :-
    findall(D,
            ( between(1, N, Host),
              aggregate_all(count,
                            ( member(A-B, Links), ( A == Host ; B == Host ) ),
                            D) ),
            Degrees).

count_changes(Events, Functor, Count) :-
    aggregate_all(count,
                  ( member(_-Changes, Events),
                    member(Change, Changes),
                    functor(Change, Functor, 2) ),
                  Count).

:- begin_tests(link_dynamics).

test(named_models, forall(member(M, [random_links, thesis_4_4_7, dynamic_1,
                                     dynamic_2]))) :-
    dynamics_model(M, General),
    dynamics_model(General, General).
test(unknown_model,
     [ forall(member(M, [chaos, links(5, 0.1, 0.1),
                         links(uniform(0, 1), 0.1, 0.1),
                         links(uniform(2, 1), 0.1, 0.1),
                         toggle(uniform(1, 2), 1.5, 0)])),
       error(domain_error(dynamic_model, M)) ]) :-
    dynamics_model(M, _).
test(unbound_model, error(instantiation_error)) :-
    dynamics_model(_, _).
test(repeatable, Events == Again) :-
    history(random_links, grid(6, 10), 3, 300, _, _, Events),
    history(random_links, grid(6, 10), 3, 300, _, _, Again).
test(seed_matters, true(Events \== Others)) :-
    history(random_links, grid(6, 10), 3, 300, _, _, Events),
    history(random_links, grid(6, 10), 4, 300, _, _, Others).
test(changes_fit_the_links_there_are,
     forall(member(M, [random_links, thesis_4_4_7, dynamic_1, dynamic_2]))) :-
    history(M, grid(6, 10), 1, 400, _, Edges, Events),
    links_after(Edges, Events, Links),
    sort(Links, Sorted),
    same_length(Links, Sorted).
test(times_ascend, Times == Sorted) :-
    history(random_links, grid(6, 10), 1, 400, _, _, Events),
    findall(T, member(T-_, Events), Times),
    msort(Times, Sorted).
test(every_host_acts_every_ten_to_twenty_seconds) :-
    history(random_links, ring(50), 1, 1500, _, _, Events),
    length(Events, Count),              % 50 hosts, 100 times each
    abs(Count - 5000) < 100,
    Events = [First-_|_],
    First >= 10, First =< 20.
test(probabilities_of_section_4_4_7) :-
    history(random_links, ring(50), 1, 600, _, _, Events),
    length(Events, Count),
    count_changes(Events, unlink, Dropped),
    count_changes(Events, link, Made),
    abs(Dropped / Count - 0.3) < 0.041,
    abs(Made / Count - 0.5) < 0.045.
test(degrees_of_section_4_4_7) :-      % the thesis: 0 to 27, after the mesh
    history(thesis_4_4_7, mesh(50), 1, 60, N, Edges, Events),
    links_after(Edges, Events, Links),
    degrees(N, Links, Degrees),
    min_list(Degrees, Min),
    max_list(Degrees, Max),
    Min =< 2,
    Max =< 27.
test(one_at_a_time_keeps_a_mesh_dense) :-
    history(random_links, mesh(50), 1, 1000, N, Edges, Events),
    links_after(Edges, Events, Links),
    degrees(N, Links, Degrees),
    min_list(Degrees, Min),
    Min > 40.
test(dynamic_1_uses_only_the_links_of_the_network) :-
    history(dynamic_1, grid(6, 10), 1, 2000, _, Edges, Events),
    forall(( member(_-Changes, Events), member(Change, Changes) ),
           ( Change =.. [_, I, J], edge(I, J, E), memberchk(E, Edges) )).
test(dynamic_1_settles_at_seven_twelfths) :-
    findall(Share,
            ( between(1, 10, Seed),
              history(dynamic_1, grid(6, 10), Seed, 300, _, Edges, Events),
              links_after(Edges, Events, Links),
              length(Links, L),
              Share is L / 104 ),
            Shares),
    sum_list(Shares, Sum),
    abs(Sum / 10 - 0.7 / 1.2) < 0.07.
test(dynamic_2_exceeds_the_degrees_of_the_grid) :-
    history(dynamic_2, grid(6, 10), 1, 300, N, Edges, Events),
    links_after(Edges, Events, Links),
    degrees(N, Links, Degrees),
    max_list(Degrees, Max),
    Max > 4,
    length(Events, Count),
    count_changes(Events, unlink, Dropped),
    count_changes(Events, link, Made),
    abs(Dropped / Count - 0.5) < 0.06,
    abs(Made / Count - 0.7) < 0.06.
test(certain_toggle_undoes_itself, Edges == Links) :-
    history(toggle(uniform(1, 1), 1, 1), ring(2), 1, 2.5, _, Edges, Events),
    links_after(Edges, Events, Links).
test(single_host, Changes == []) :-
    history(random_links, ring(1), 1, 100, _, _, Events),
    findall(C, ( member(_-Cs, Events), member(C, Cs) ), Changes).

:- end_tests(link_dynamics).

:- begin_tests(link_dynamics_running).

start(Spec, Rate, OnChange, Dynamics) :-
    dynamics_model(Spec, Model),
    topology_edges(grid(6, 10), 1, N, Edges),
    dynamics_state(Model, N, Edges, 1, State),
    runtime_acquire(test_dynamics, []),
    get_time(Now),
    dynamics_start(State, clock(Now, Rate), OnChange, Dynamics).

stop(Dynamics) :-
    dynamics_stop(Dynamics),
    runtime_release(test_dynamics).

test(changes_come_in_order_at_the_pace_of_the_clock, Got == Expected) :-
    no_leaks(( message_queue_create(Queue),
               get_time(T0),
               start(random_links, 100, thread_send_message(Queue), Dynamics),
               findall(Change,
                       ( between(1, 200, _),    % about 60 host seconds
                         thread_get_message(Queue, Change, [timeout(20)]) ),
                       Got),
               get_time(T1),
               stop(Dynamics),
               message_queue_destroy(Queue) )),
    history(random_links, grid(6, 10), 1, 200, _, _, Events),
    findall(C, ( member(_-Cs, Events), member(C, Cs) ), All),
    append(Expected, Rest, All),
    length(Expected, 200),
    !,
    nonvar(Rest),
    due(200, Events, Due),
    Late is T1 - T0 - Due / 100,
    Late > -0.1,
    Late < 5.
test(stops_at_once, true(Took < 5)) :-
    no_leaks(( start(random_links, 1, nothing, Dynamics),
               get_time(T0),
               stop(Dynamics),
               get_time(T1),
               Took is T1 - T0 )).
test(stops_when_a_change_hangs, true(Took < 10)) :-
    no_leaks(( message_queue_create(Queue),
               start(links(uniform(1, 1), 1, 1), 1000, hang(Queue), Dynamics),
               thread_get_message(Queue, hanging, [timeout(5)]),
               get_time(T0),
               stop(Dynamics),
               get_time(T1),
               Took is T1 - T0,
               message_queue_destroy(Queue) )).
test(an_error_does_not_end_it) :-
    no_leaks(( message_queue_create(Queue),
               start(links(uniform(1, 1), 1, 1), 1000, fault(Queue), Dynamics),
               forall(between(1, 5, _),
                      thread_get_message(Queue, _, [timeout(5)])),
               stop(Dynamics),
               message_queue_destroy(Queue) )).

due(N, [Time-Changes|Events], Due) :-
    length(Changes, L),
    (   N =< L
    ->  Due = Time
    ;   N1 is N - L,
        due(N1, Events, Due)
    ).

nothing(_).

hang(Queue, _) :-
    thread_send_message(Queue, hanging),
    thread_self(Me),
    thread_get_message(Me, never).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(error(domain_error(test_dynamics, _), _), warning, _).

fault(Queue, Change) :-
    thread_send_message(Queue, Change),
    domain_error(test_dynamics, Change).

:- end_tests(link_dynamics_running).
