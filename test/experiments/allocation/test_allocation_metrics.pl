:- use_module('../../lib/common').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/allocation/faults').
:- use_module('../../../experiments/allocation/metrics').
:- use_module('../../../experiments/allocation/timetable').

/** <module> Metrics of allocations, on logs made by hand
*/

%   Two tasks; a backs off twice, b once; b is completed first.

log_events(Events) :-
    events([ e(5, h1, a1, begun(a)),
             e(5.5, h2, b1, begun(b)),
             e(6, r1, robot, reserved(r1, a1, a)),
             e(7, h1, a1, backoff(2)),
             e(7, r1, robot, released(r1, a1, a)),
             e(8, r1, robot, reserved(r1, b1, b)),
             e(9, h2, b1, backoff(4)),
             e(10, h1, a1, backoff(9)),
             e(11, h2, b1, allocated(b, [r1])),
             e(12, r1, robot, executed(r1, b1, b)),
             e(13, h2, b1, completed(b)),
             e(13, r1, robot, released(r1, b1, b)),
             e(13, h2, b1, communications(migration, 7)),
             e(14, h2, c1, communications(child, 2)),
             e(14.5, r1, robot, reserved(r1, a1, a)),
             e(15, h1, a1, completed(a)),
             e(15, h1, a1, communications(migration, 30)),
             e(15, r1, robot, released(r1, a1, a))
           ], Events).

events(Es, Events) :-
    maplist([e(T, H, A, W), event(T, H, A, W)]>>true, Es, Events).

:- begin_tests(allocation_metrics).

test(communications, Sum == 39) :-
    log_events(Events),
    communications(Events, Sum).
test(kinds, Kinds == [child-2, migration-37]) :-
    log_events(Events),
    kind_sums(Events, Kinds).
test(completed, Completed == [b-8, a-10]) :-
    log_events(Events),
    completed(Events, Completed).
test(backoffs, Seconds == [2, 4, 9]) :-
    log_events(Events),
    backoffs(Events, Seconds).
test(lasted, All == [b-7.5, a-10]) :-
    log_events(Events),
    findall(Task-Seconds, lasted(Events, Task, Seconds), All).
test(overdue, Overdue == [0.5-3]) :-
    events([ e(0, h, x, begun(a)), e(2, h, z, begun(c)),
             e(7, h, x, completed(a)), e(12.5, h, z, missed(c, 10)),
             e(15, r, r, released(r, z, c)) ],
           Events),
    findall(Reported-Free, overdue(Events, Reported, Free), Overdue).
test(nothing_happened, Sum-Kinds-Completed-Seconds == 0-[]-[]-[]) :-
    communications([], Sum),
    kind_sums([], Kinds),
    completed([], Completed),
    backoffs([], Seconds).
test(time_begins_with_the_first, Time == 0) :-
    log_events(Events0),
    from_first([event(1, h, x, created)|Events0], [_, event(Time, _, _, _)|_]).

:- end_tests(allocation_metrics).

:- begin_tests(allocation_faults).

test(none) :-
    log_events(Events),
    no_reservation_faults(Events).
test(left_reserved, error(reservation_faults([held(r1, a1, a)]))) :-
    log_events(Events0),
    append(Events, [_], Events0),
    no_reservation_faults(Events).
test(reserved_twice, error(reservation_faults([twice(r, a, b, 2)|_]))) :-
    events([e(1, r, r, reserved(r, a, x)), e(2, r, r, reserved(r, b, y))],
           Events),
    no_reservation_faults(Events).

:- end_tests(allocation_faults).

                /*******************************
                *          TIMETABLES          *
                *******************************/

%   A sequence of two tasks, allocated to r1 and r2; Where executes the
%   second one when r1 does.

sequence(Where, Timetable) :-
    events([ e(1, h, x, begun(s)), e(3, h, x, allocated(s, [r1, r2])),
             e(4, r1, w, executing(s, 1)), e(5, r1, w, completed(s, 1)),
             e(4, r2, w, executing(s, 1)), e(6, r2, w, completed(s, 1)),
             e(7, r1, w, executing(s, 2)), e(8, r1, w, completed(s, 2)),
             e(7, Where, w, executing(s, 2)),
             e(9, Where, w, completed(s, 2)),
             e(10, h, x, completed(s)),
             e(10, h, x, communications(migration, 4)) ],
           Events),
    timetable(Events, [s], 2, Timetable).

measures(Timetable, Names, Values) :-
    maplist(measure(Timetable), Names, Values).

measure(Timetable, Name, Value) :-
    timetable_measure(Name, Timetable, Value).

faults([faulty, strangers, overlaps, disorder, both]).

:- begin_tests(timetables).

test(correct_timetable, Values == [0, 0, 0, 0, 0]) :-
    sequence(r2, Timetable),
    faults(Names),
    measures(Timetable, Names, Values).
test(times, Values == [2, 9, 4]) :-
    sequence(r2, Timetable),
    measures(Timetable, [found, completed, communications], Values).
test(unknown_robot, Values == [1, 1, 0, 1, 0]) :-
    sequence(r3, Timetable),
    faults(Names),
    measures(Timetable, Names, Values).
test(too_early, Values == [0, 0, 1, 0, 0]) :-
    faults(Names),
    executed([ execution(1, r1, 1, 2), execution(1, r2, 3, 4),
               execution(2, r1, 2, 5), execution(2, r2, 5, 6) ], Sequence),
    measures(timetable(2, [Sequence], 0), Names, Values).
test(robot_at_two_jobs_at_once, Count == 2) :-
    executed([execution(1, r1, 1, 2), execution(1, r2, 3, 4)],
             sequence(s, Its, Times, Executions)),
    timetable_measure(both,
                      timetable(1, [ sequence(s, Its, Times, Executions),
                                     sequence(t, Its, Times, Executions) ],
                                0),
                      Count).
test(rows, Held-Executed == [[1, 2, 9, 0], [2, 2, 9, 0]]-4) :-
    sequence(r2, Timetable),
    Runs = [run(case{}, 1, measures{timetable:Timetable})],
    held_rows(Runs, Held),
    executed_rows(Runs, Rows),
    length(Rows, Executed),
    timetable_extent(Runs, [robots-2, 'END'-9]).

executed(Executions, sequence(s, [r1, r2], times(0, 9), Executions)).

:- end_tests(timetables).
