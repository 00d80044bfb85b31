:- module(test_sync_metrics, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fixtures', [with_hosts/2]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/sync/healing').
:- use_module('../../../experiments/sync/metrics').
:- use_module('../../../experiments/sync/orderly', []).
:- use_module(library(typhon)).

/** <module> Metrics of tasks in step, on event logs made by hand
*/

%   Two hosts, three tasks.  T1: a 0-1, b 2-3.  T2: a 5-6, b 6-7.  T3: b
%   starts at 8, a at 9.

in_step([ event(10, a, t, begun),
          event(10, a, w, executing(s, 1)), event(11, a, w, completed(s, 1)),
          event(12, b, w, executing(s, 1)), event(13, b, w, completed(s, 1)),
          event(15, a, w, executing(s, 2)), event(16, a, w, completed(s, 2)),
          event(16, b, w, executing(s, 2)), event(17, b, w, completed(s, 2)),
          event(18, b, w, executing(s, 3)), event(19, b, w, completed(s, 3)),
          event(19, a, w, executing(s, 3)), event(20, a, w, completed(s, 3))
        ]).

%   a runs ahead: it executes T2 before b is serviced for T1, and T3 before
%   b is serviced for T2.

ahead([ event(0, a, t, begun),
        event(0, a, w, executing(s, 1)), event(1, a, w, completed(s, 1)),
        event(2, a, w, executing(s, 2)), event(3, a, w, completed(s, 2)),
        event(4, a, w, executing(s, 3)), event(5, a, w, completed(s, 3)),
        event(6, b, w, executing(s, 1)), event(7, b, w, completed(s, 1)),
        event(8, b, w, executing(s, 2)), event(9, b, w, completed(s, 2)),
        event(9, b, w, executing(s, 3)), event(10, b, w, completed(s, 3))
      ]).

measured(Log, Executions) :-
    call(Log, Events0),
    from_start(Events0, Events),
    executions(Events, Executions).

%   T1 begins everywhere by 3, and ends by 4; T2 begins by 4, and ends by 6.

nearly_in_step([ execution(1, a, 0, 1), execution(1, c, 1, 2),
                 execution(1, b, 3, 4), execution(2, a, 2.9, 5),
                 execution(2, b, 3, 6), execution(2, c, 3.9, 5),
                 execution(2, d, 4, 5), execution(3, a, 5.9, 7),
                 execution(3, b, 6, 7) ]).

:- begin_tests(measures).

test(time_begins_with_the_agents, Es == [event(-1, a, w, x),
                                         event(0, b, t, begun),
                                         event(2, a, w, y)]) :-
    from_start([ event(5, b, t, begun), event(4, a, w, x),
                 event(7, a, w, y) ], Es).
test(executions, Es == [ execution(1, a, 0, 1), execution(1, b, 2, 3),
                         execution(2, a, 5, 6), execution(2, b, 6, 7),
                         execution(3, b, 8, 9), execution(3, a, 9, 10) ]) :-
    measured(in_step, Es).
test(unfinished_execution_does_not_count, Es == []) :-
    executions([ event(0, a, w, executing(s, 1)),
                 event(1, a, w, failed(s, 1))
               ], Es).
test(execution_again,
     Es == [execution(1, a, 0, 1), execution(1, a, 3, 5)]) :-
    executions([ event(0, a, w, executing(s, 1)),
                 event(1, a, w, completed(s, 1)),
                 event(3, a, w, executing(s, 1)),
                 event(5, a, w, completed(s, 1))
               ], Es).
test(rows, Rows == [ task(1, 0, 2, 3, 2, 2), task(2, 5, 6, 7, 2, 1),
                     task(3, 8, 9, 10, 2, none) ]) :-
    measured(in_step, Es),
    task_rows(Es, Rows).
test(idle, Idle == 3) :-
    measured(in_step, Es),
    task_rows(Es, Rows),
    idle_time(Rows, Idle).
test(overlap_leaves_no_idle_time, Idle == 0) :-
    measured(ahead, Es),
    task_rows(Es, Rows),
    idle_time(Rows, Idle).
test(no_overlaps, Overlaps == []) :-
    measured(in_step, Es),
    overlaps(Es, Overlaps).
test(overlaps,
     Overlaps == [execution(2, a, 2, 3), execution(3, a, 4, 5)]) :-
    measured(ahead, Es),
    overlaps(Es, Overlaps).
test(premature, Premature == [execution(2, a, 2, 3), execution(3, a, 4, 5)]) :-
    measured(ahead, Es),
    premature(Es, Premature).
test(overlaps_until_the_last_host_has_finished,
     Overlaps == [ execution(2, a, 2.9, 5), execution(2, b, 3, 6),
                   execution(2, c, 3.9, 5), execution(3, a, 5.9, 7) ]) :-
    nearly_in_step(Es),
    overlaps(Es, Overlaps).
test(premature_until_the_last_host_has_begun,
     Premature == [execution(2, a, 2.9, 5)]) :-
    nearly_in_step(Es),
    premature(Es, Premature).
test(in_order, OutOfOrder == []) :-
    measured(ahead, Es),
    out_of_order(Es, OutOfOrder).
test(out_of_order, OutOfOrder == [execution(2, a, 0, 1),
                                  execution(2, b, 1, 2)]) :-
    out_of_order([ execution(2, a, 0, 1), execution(2, b, 1, 2),
                   execution(1, a, 2, 3) ], OutOfOrder).
test(required,
     Segments == [ segment(a, 2, 1, 5), segment(a, 3, 6, 9),
                   segment(b, 1, 0, 2), segment(b, 2, 3, 6),
                   segment(b, 3, 7, 8) ]) :-
    measured(in_step, Es),
    marks(Es, [], Marks),
    required([a, b], [1, 2, 3], Marks, 10, Segments).
test(required_and_never_executed,
     Segments == [segment(a, 1, 0, 2), segment(a, 2, 2, 9)]) :-
    required([a], [1, 2], [mark(2, a, 1, completed)], 9, Segments).
test(required_again,
     Segments == [ segment(a, 1, 0, 1), segment(a, 2, 2, 3),
                   segment(a, 1, 5, 6) ]) :-
    marks([ execution(1, a, 1, 2), execution(2, a, 3, 4),
            execution(1, a, 6, 7) ], [failure(5, a, 1)], Marks),
    required([a], [1, 2], Marks, 9, Segments).
test(nothing_required_while_all_execute, Steps == [0-1, 1-0, 3-1, 4-0]) :-
    marks([ execution(1, a, 1, 3), execution(1, b, 1, 3),
            execution(2, a, 4, 5), execution(2, b, 4, 5) ], [], Marks),
    required([a, b], [1, 2], Marks, 5, Segments),
    tau(Segments, Steps).
test(task_lost_during_another_execution,
     Segments == [segment(a, 1, 0, 1), segment(a, 2, 2, 3),
                  segment(a, 1, 5, 6)]) :-
    marks([ execution(1, a, 1, 2), execution(2, a, 3, 5),
            execution(1, a, 6, 7) ], [failure(4, a, 1)], Marks),
    required([a], [1, 2], Marks, 7, Segments).
test(tau, Steps == [0-1, 1-2, 2-1, 9-0]) :-
    measured(in_step, Es),
    marks(Es, [], Marks),
    required([a, b], [1, 2, 3], Marks, 10, Segments),
    tau(Segments, Steps).
test(tau_max, Tau == 2) :-
    measured(in_step, Es),
    marks(Es, [], Marks),
    required([a, b], [1, 2, 3], Marks, 10, Segments),
    tau(Segments, Steps),
    tau_max(Steps, Tau).
test(tau_of_three_independent_hosts, Tau == 3) :-
    marks([ execution(1, a, 0, 1), execution(2, a, 1, 2),
            execution(1, b, 0, 1) ], [], Marks),
    required([a, b, c], [1, 2, 3], Marks, 5, Segments),
    tau(Segments, Steps),
    tau_max(Steps, Tau).
test(burst, Count == 2) :-
    burst(1, 1, [ execution(1, a, 3, 4), execution(1, b, 3.5, 4.5),
                  execution(1, c, 4, 5), execution(2, a, 3, 4) ], Count).

:- end_tests(measures).

                /*******************************
                *            HEALING           *
                *******************************/

%   T1, T2, T3 on a and b; b loses T1 at 7, while T3 has begun, and is
%   healed; what was executed again ends at 9.

wounded([ execution(1, a, 0, 1), execution(1, b, 0, 1),
          execution(2, a, 3, 4), execution(2, b, 3, 4),
          execution(3, a, 6, 8), execution(1, b, 8, 9),
          execution(3, b, 10, 11) ]).

:- begin_tests(healing).

test(failures, Fs == [failure(3, b, 1), failure(5, a, 2)]) :-
    failures([ event(5, a, w, failed(main, 2)), event(4, a, w, other),
               event(3, b, w, failed(main, 1)) ], Fs).
test(no_failure_one_phase, Phases == [Es]) :-
    wounded(Es),
    phases(none, Es, [], Phases).
test(atomic, Redone == [execution(1, b, 8, 9)]) :-
    wounded(Es),
    phases(atomic(1, 1, 3), Es, [failure(7, b, 1)], [Others, Redone]),
    length(Others, 6).
test(cascaded, After == [execution(1, a, 9, 10), execution(1, b, 9, 10)]) :-
    phases(cascaded(1, 2, 1),
           [ execution(1, a, 0, 1), execution(2, b, 7.5, 8),
             execution(1, a, 9, 10), execution(1, b, 9, 10) ],
           [failure(7, a, 1), failure(8, b, 1)], [_, After]).
test(measures, Measures == [ failed_at(7), failed_by(7), lost(1),
                             lost_hosts(1), redone(1), healed_at(9),
                             meanwhile(0), healing_tau(3),
                             later_tau(2) ]) :-
    wounded(Es),
    healing(Es, [failure(7, b, 1)], [0-1, 7-3, 9-2], Measures).
test(not_healed, Redone == 0) :-
    healing([execution(1, a, 0, 1)], [failure(2, a, 1)], [0-1], Measures),
    memberchk(redone(Redone), Measures).
test(failure_before_completion, Lost == 0) :-
    healing([execution(1, a, 3, 4)], [failure(2, a, 1)], [0-1], Measures),
    memberchk(lost(Lost), Measures).

:- end_tests(healing).

                /*******************************
                *         IN GOOD ORDER        *
                *******************************/

:- begin_tests(orderly).

%   walk(+Links, +From, +Steps, -Names): the hosts to which an agent goes.

walk(Links, From, Steps, Names) :-
    setof(Host, A^B^( member(A-B, Links), member(Host, [A, B]) ), Hosts),
    with_hosts(Hosts,
               ( forall(member(A-B, Links), link(A, B)),
                 agent_create(clauses([ (:- agent(walker, [])),
                                        (main :- walk(Steps, Path),
                                                 result(Path)),
                                        (walk(0, []) :- !),
                                        (walk(K, [Next|Path]) :-
                                             next_host(orderly, Next),
                                             move(Next),
                                             K1 is K-1,
                                             walk(K1, Path)) ]),
                              Agent, [host(From)]),
                 agent_result(Agent, Addresses, 20) )),
    findall(Name, ( member(Address, Addresses),
                    atomic_list_concat([Name|_], @, Address) ),
            Names).

test(next_higher_then_never_visited_then_longest_ago,
     Path == [n10, n9, n2, n9, n10]) :-
    walk([n9-n10, n9-n2], n9, 5, Path).
test(the_lowest_after_the_highest, Path == [n1]) :-
    walk([n1-n10, n9-n10], n10, 1, Path).

:- end_tests(orderly).
