:- use_module('../lib/common', [with_tmp_dir/1]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../experiments/engine/follow').
:- use_module('../../experiments/lib/progress').
:- use_module('../../experiments/lib/report').
:- use_module('../../experiments/sync/claims').
:- use_module('../../experiments/sync/figure').
:- use_module('../../experiments/sync/metrics').

/** <module> What is told of an experiment: measures, claims, files

On event logs made by hand.
*/

                /*******************************
                *           MEASURES           *
                *******************************/

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
test(no_idle_time_in_overlaps, Idle == 0) :-
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
test(in_order, OutOfOrder == []) :-
    measured(ahead, Es),
    out_of_order(Es, OutOfOrder).
test(out_of_order, OutOfOrder == [execution(2, a, 0, 1),
                                  execution(2, b, 1, 2)]) :-
    out_of_order([ execution(2, a, 0, 1), execution(2, b, 1, 2),
                   execution(1, a, 2, 3) ], OutOfOrder).
test(required,
     Segments == [ segment(a, 1, 0, 1), segment(a, 2, 1, 6),
                   segment(a, 3, 6, 10),
                   segment(b, 1, 0, 3), segment(b, 2, 3, 7),
                   segment(b, 3, 7, 9) ]) :-
    measured(in_step, Es),
    marks(Es, [], Marks),
    required([a, b], [1, 2, 3], Marks, 10, Segments).
test(required_and_never_executed,
     Segments == [segment(a, 1, 0, 2), segment(a, 2, 2, 9)]) :-
    required([a], [1, 2], [mark(2, a, 1, completed)], 9, Segments).
test(required_again,
     Segments == [ segment(a, 1, 0, 2), segment(a, 2, 2, 4),
                   segment(a, 1, 5, 7) ]) :-
    marks([ execution(1, a, 1, 2), execution(2, a, 3, 4),
            execution(1, a, 6, 7) ], [failure(5, a, 1)], Marks),
    required([a], [1, 2], Marks, 9, Segments).
test(tau, Steps == [0-1, 1-2, 3-1, 6-2, 7-1, 10-0]) :-
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
test(tau_of_three_hosts_apart, Tau == 3) :-
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
                *        CLAIMS, REPORTS       *
                *******************************/

result(Log, [ outcomes([done, done]), hosts([a, b]), tasks([1, 2, 3]),
              executions(Es), rows(Rows), segments(Segments), steps(Steps),
              end(10), wall(1), failure(none), phases([Es]), healing([]),
              title('A title'), subtitle('and more')
            ]) :-
    measured(Log, Es),
    task_rows(Es, Rows),
    marks(Es, [], Marks),
    required([a, b], [1, 2, 3], Marks, 10, Segments),
    tau(Segments, Steps).

verdicts(Log, Verdicts) :-
    result(Log, Result),
    sync_claims(Result, Claims),
    findall(Held, member(claim(_, Held, _), Claims), Verdicts).

%   T1 was lost at b and executed again at 11; Tau tasks were required
%   meanwhile.

healed_claims(Tau, Verdicts) :-
    result(in_step, Result0),
    measured(in_step, Es0),
    Again = [execution(1, b, 11, 12)],
    append(Es0, Again, Es),
    Changed = [ executions(Es), phases([Es0, Again]),
                failure(atomic(1, 1, 3)),
                healing([ lost(1), redone(1), healing_tau(Tau),
                          later_tau(2) ]) ],
    append(Changed, Result0, Result),
    sync_claims(Result, Claims),
    findall(Held, member(claim(_, Held, _), Claims), Verdicts).

:- begin_tests(claims).

test(held, Verdicts == [true, true, true, true, true, true, false]) :-
    verdicts(in_step, Verdicts).
test(not_held, Verdicts == [true, true, true, true, false, false, false]) :-
    verdicts(ahead, Verdicts).
test(agents_that_did_not_end, Found == '1 of 2; others: [timeout]') :-
    result(in_step, [_|Rest]),
    sync_claims([outcomes([done, timeout])|Rest], [claim(_, false, Found)|_]).
test(a_task_missing) :-
    result(in_step, Result0),
    selectchk(executions(Es0), Result0, executions(Es), Result),
    once(append(Es, [_], Es0)),
    sync_claims(Result, [_, claim(_, Held, Found)|_]),
    Held == false,
    Found == '5 executions, 5 of 6 pairs of host and task'.
test(healed, Verdicts == [true, true, true, true, true, true]) :-
    healed_claims(3, Verdicts).
test(not_healed, Verdicts == [true, true, true, true, false, true]) :-
    healed_claims(4, Verdicts).
test(sentence_held, S == 'All 2 claims held.') :-
    claims_sentence([claim(a, true, x), claim(b, true, x)], S).
test(sentence_not_held, S == '1 of 2 claims did not hold: b.') :-
    claims_sentence([claim(a, true, x), claim(b, false, x)], S).

:- end_tests(claims).

:- begin_tests(reports).

test(table, Text == "  task  idle\n     1  0.50\n     2     -\n") :-
    with_output_to(string(Text),
                   ( current_output(Out),
                     print_table(Out, [task, idle], [[1, 0.5], [2, -]]) )).
test(csv, Text == "a,b\r\n1,\"x,y\"\r\n") :-
    with_tmp_dir(saved_csv(Text)).
test(facts, Terms == [a('B', "c"), d]) :-
    with_tmp_dir(saved_facts(Terms)).
test(sparse_lines_without_a_terminal,
     Text == "0/20 a\n3/20 c\n20/20 d\n") :-
    with_output_to(string(Text),
                   ( current_output(Out),
                     progress(Out, 0, 20, a),
                     progress(Out, 1, 20, b),
                     progress(Out, 3, 20, c),
                     progress(Out, 20, 20, d),
                     progress_done(Out) )).
test(growing_file, Lines == ["one", "two"]-["three"]) :-
    with_tmp_dir(growing(Lines)).
test(no_file_yet, Lines == []) :-
    new_lines('/nonexistent/file', 0, 0, Lines).
test(figure, [condition(absolute_file_name(path(gnuplot), _,
                                           [ access(execute),
                                             file_errors(fail) ]))]) :-
    with_tmp_dir(figure_drawn).

saved_csv(Text, Dir) :-
    atom_concat(Dir, '/t.csv', File),
    save_csv(File, [a, b], [[1, 'x,y']]),
    read_file_to_string(File, Text, []).

saved_facts(Terms, Dir) :-
    atom_concat(Dir, '/t.pl', File),
    save_facts(File, [a('B', "c"), d]),
    read_file_to_terms(File, Terms, []).

growing(Lines1-Lines2, Dir) :-
    atom_concat(Dir, '/log', File),
    append_text(File, 'one\ntwo\nthr'),
    new_lines(File, 0, Position, Lines1),
    append_text(File, 'ee\n'),
    new_lines(File, Position, _, Lines2).

append_text(File, Text) :-
    setup_call_cleanup(open(File, append, Out), write(Out, Text), close(Out)).

figure_drawn(Dir) :-
    result(in_step, Result),
    draw_figure(Dir, synchronisation, Result),
    forall(member(Name, ['synchronisation.png', 'synchronisation.svg']),
           ( atomic_list_concat([Dir, /, Name], File),
             size_file(File, Size),
             Size > 2000 )).

:- end_tests(reports).
