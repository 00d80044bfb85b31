:- use_module('../../lib/common').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/population/mesh').
:- use_module('../../../experiments/population/metrics').

/** <module> Populations in event logs made by hand, and meshes
*/

%   Two hosts, two tasks; the second kind has a clone that dies.

small_log([ event(-2, a, 'agent1.x.1@a', created),
            event(-1, b, 'agent2.x.2@b', created),
            event(-1, b, 'worker.x.3@b', created),
            event(0, a, 'agent1.x.1@a', begun),
            event(1, a, w, executing(s, 1)), event(2, a, w, completed(s, 1)),
            event(2, b, w, executing(s, 1)), event(3, b, w, completed(s, 1)),
            event(5, b, w, executing(s, 2)),
            event(5, b, 'agent2.x.4@b', created),
            event(6, b, w, completed(s, 2)),
            event(6, a, w, executing(s, 2)), event(7, a, w, completed(s, 2)),
            event(8, b, 'agent2.x.4@b', ended(disposed)),
            event(9, a, 'agent1.x.1@a', ended(disposed))
          ]).

:- begin_tests(measures).

test(kind, Kind == 12) :-
    agent_kind('agent12.mark.3@n1@127.0.0.1:1', Kind).
test(agent_of_no_kind, [fail]) :-
    agent_kind('worker.mark.3@n1@127.0.0.1:1', _).
test(populations, Steps == [ step(0, [1, 1], 2), step(5, [1, 2], 3),
                             step(8, [1, 1], 2) ]) :-
    small_log(Events0),
    until_settled(Events0, [1, 2], 2, Events),
    populations(Events, [1, 2], Steps).
test(continues_until_settled, Last == event(8, b, 'agent2.x.4@b',
                                            ended(disposed))) :-
    small_log(Events0),
    until_settled(Events0, [1, 2], 2, Events),
    last(Events, Last).
test(never_settled, Count == 15) :-
    small_log(Events0),
    until_settled(Events0, [1, 2], 3, Events),
    length(Events, Count).
test(lost_task_is_not_done, Count == 1) :-
    track_start([1, 2], State0),
    foldl(track, [ event(1, a, w, completed(s, 1)),
                   event(1, b, w, completed(s, 1)),
                   event(2, a, w, failed(s, 1)) ], State0, State),
    track_done(State, 1, Count).
test(peak, Peak == 5-2) :-
    peak(2, [ step(0, [1, 1], 2), step(5, [1, 2], 3), step(6, [0, 2], 2),
              step(8, [1, 1], 2) ], Peak).
test(later_peak, Peak == 6-2) :-
    peak(total, 5.5, [ step(0, [1, 4], 5), step(5, [0, 1], 1),
                       step(6, [0, 2], 2) ], Peak).
test(peak_includes_the_initial_population, Peak == 5.5-5) :-
    peak(total, 5.5, [step(0, [1, 4], 5), step(6, [0, 2], 2)], Peak).
test(population_at, Counts == [1, 2]) :-
    population_at(7, [step(0, [1, 1], 2), step(5, [1, 2], 3)], Counts).
test(again, First-Again == [E1, E2]-[E3]) :-
    E1 = execution(1, a, 0, 1),
    E2 = execution(1, b, 0, 1),
    E3 = execution(1, a, 5, 6),
    again([E1, E2, E3], First, Again).

test(spans_and_gaps, Spans-Gaps == [31, 31]-[-5]) :-
    Rows = [ task(1, 10, 40, 41, 2, 0), task(2, 36, 60, 67, 2, none) ],
    spans(Rows, Spans),
    gaps(Rows, Gaps).

:- end_tests(measures).

:- begin_tests(mesh).

test(mesh_is_connected, [ forall(member(Seed, [1, 2, 3])),
                          Reached == 30 ]) :-
    mesh(rings, 30, 4, Seed, edges(Edges)),
    reach([1], Edges, [1], All),
    length(All, Reached).
test(mesh_degree) :-
    mesh(rings, 40, 10, 7, edges(Edges)),
    length(Edges, Count),
    Count =< 200,                       % five rings of forty
    Count >= 160,
    forall(between(1, 40, Host),
           ( aggregate_all(count, ( member(I-J, Edges),
                                    ( I == Host ; J == Host ) ), Degree),
             Degree =< 10, Degree >= 2 )).
test(mesh_repeats, Edges1 == Edges2) :-
    mesh(rings, 20, 6, 5, Edges1),
    mesh(rings, 20, 6, 5, Edges2).
test(mesh_differs) :-
    mesh(rings, 20, 6, 5, Edges1),
    mesh(rings, 20, 6, 6, Edges2),
    Edges1 \== Edges2.
test(random_mesh, Topology == random(21, 0.2)) :-
    mesh(random, 21, 4, 1, Topology).
test(smallest_mesh, Edges == [1-2]) :-
    mesh(rings, 2, 10, 1, edges(Edges)).

reach([], _, All, All).
reach([Host|Hosts], Edges, Seen, All) :-
    findall(Other,
            ( member(I-J, Edges),
              ( I == Host, Other = J ; J == Host, Other = I ),
              \+ memberchk(Other, Seen)
            ),
            Others0),
    sort(Others0, Others),
    append(Others, Seen, Seen1),
    append(Others, Hosts, Next),
    reach(Next, Edges, Seen1, All).

:- end_tests(mesh).
