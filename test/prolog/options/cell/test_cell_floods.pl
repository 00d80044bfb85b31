:- module(test_cell_floods, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/cell), [cells_list/1]).

/** <module> Floods, repetitions and late frames of an agent that has all rights
inside its cell

*Threading*: one test at a time.
*/

:- begin_tests(cell_floods).

test(endless_frames_exceed_the_quota_of_seconds, Through == []) :-
    Over = ended(raised(error(resource_error(seconds), _))),
    findall(What-test_send(What)-Over, endless(What), Checks),
    with_inmates([], [seconds(1)],
                 through([beside-true-yes(true)|Checks], Through)).
test(host_stops_during_a_flood,
     [forall(endless(What)), Stopped == true]) :-
    with_inmates(stopped_beside(What, Stopped)).
test(refused_requests_do_not_fill_the_audit,
     [Outcome,Lines] = [ended(lost(cell(violation(refused)))),102]) :-
    with_inmates(refused_again_and_again(Outcome, Lines)).
test(refused_agents_do_not_fill_the_audit,
     [Outcome,Lines,Agents] = [ended(lost(cell(violation(refused)))),102,4]) :-
    with_inmates([], [seconds(20), clones(100 000), owner(agents(5))],
                 created_again_and_again(Outcome, Lines, Agents)).
test(new_functors_are_charged_to_the_owner_until_its_turns_end,
     [First,Next,Before,After,Lines] =
     [ ended(lost(cell(violation(functors)))),
       ended(lost(cell(violation(functors)))), true, true, 2 ]) :-
    with_settings([typhon_cells:functors=30 000],
                  with_inmates(capturing(functors_charged([First,Next], Before,
                                                          After, Lines), _))).
test(quota_exceeded_in_a_cell_is_audited,
     Outcome = ended(raised(error(resource_error(state), _)))) :-
    with_inmates(attempt(test_send(over(state)), Outcome)).
test(error_raised_in_a_cell_is_no_exceeded_quota, Over == []) :-
    with_inmates(( attempt(throw(error(resource_error(stack), _)), _),
                   findall(What, audited(over(_, What)), Over) )).
test(resent_outcome_makes_no_second_clone, Agents == 2) :-
    with_inmates(sent_again(Agents)).
test(outdated_image_is_refused,
     [Outcome,There] = [ended(lost(cell(violation(frame)))),1]) :-
    with_hosts([t], with_inmates(sent_late(Outcome, There))).
test(request_of_an_ended_cell_is_dropped,
     [Outcome,Beside] = [ended(lost(cell(exit(0)))),yes(true)]) :-
    with_inmates(( attempt(test_send(last_words), Outcome),
                   attempt(true, Beside) )).
test(answer_to_a_killed_cell_is_dropped,
     [Outcome,Beside] = [ended(lost(cell(killed(9)))),yes(true)]) :-
    with_tmp_dir(killed_while_served(Outcome, Beside)).

:- end_tests(cell_floods).

%   Frames that an inmate writes without end.

endless(endless(told)).
endless(endless(requests)).
endless(endless(asked)).
endless(unfinished).

%   The host is stopped while frames arrive, and nothing of it is left.

stopped_beside(What, Stopped) :-
    inmate(true, test_send(What), Clauses),
    agent_create(clauses(Clauses), A, [host(c)]),
    wait_state(A, running),
    host_stop(c),
    agent_join(A, Outcome, 30),
    ( Outcome == disposed -> Stopped = true ; Stopped = Outcome ).

%   Each frame is large.

refused_again_and_again(Outcome, Lines) :-
    attempt(test_send(refused(150, 600)), Outcome),
    aggregate_all(count, audited(_), Lines),
    target(audit, Audit),
    size_file(Audit, Size),
    assertion(Size < 100 000).

created_again_and_again(Outcome, Lines, Agents) :-
    attempt(test_send(created(150)), Outcome),
    aggregate_all(count, audited(_), Lines),
    standing(c, Agents).

%   The cell writes frames of 5,000 new functors until it is ended; an agent of
%   the same owner gets no turn then. Before: not all frames arrived; After:
%   the process has few more functors.

functors_charged([First,Next], Before, After, Lines) :-
    statistics(functors, Count0),
    attempt(test_send(functors(20, 5 000)), First),
    statistics(functors, Count1),
    ( Count1-Count0 < 50 000 -> Before = true ; Before = Count1-Count0 ),
    attempt(true, Next),
    statistics(functors, Count2),
    ( Count2-Count1 < 1000 -> After = true ; After = Count2-Count1 ),
    aggregate_all(count, audited(cell(_, violation(functors))), Lines).

%   The same outcome twice: the second one arrives in a turn of the agent or of
%   its clone, which is lost.

sent_again(Agents) :-
    inmate(true, test_send(clones), Clauses),
    agent_create(clauses(Clauses), _, [host(c)]),
    wait_until(audited(cell(_, violation(frame))), 30),
    wait_until(( standing(c, Agents), Agents < 3 ), 10).

standing(Host, Count) :-
    aggregate_all(count, agent_property(_, host(Host)), Count).

%   After the agent has moved to the host t, another agent in its cell sends
%   the outcome of an earlier turn of it.

sent_late(Outcome, There) :-
    inmate(true, test_send(kept), Clauses),
    agent_create(clauses([on_message(_, _)|Clauses]), A, [host(c)]),
    wait_state(A, resident),
    agent_move(A, t),
    wait_until(standing(t, 1), 10),
    attempt(test_send(late), Outcome),
    wait_state(A, resident),
    standing(t, There),
    wait_until(standing(c, 1), 10).

killed_while_served(Outcome, Beside, Dir) :-
    directory_file_path(Dir, place, File),
    write_file(File, ":- service(slow/0).~n\c
                      slow :- thread_send_message(test_cell_slow, begun), \c
                              thread_get_message(test_cell_slow, go).~n", []),
    setup_call_cleanup(
        message_queue_create(Queue, [alias(test_cell_slow)]),
        with_inmates([consult(File)], [seconds(20)],
                     killed_in_service(Queue, Outcome, Beside)),
        message_queue_destroy(Queue)).

killed_in_service(Queue, Outcome, Beside) :-
    inmate(true, test_ask(slow, _), Clauses),
    agent_create(clauses(Clauses), A, [host(c)]),
    thread_get_message(Queue, begun),
    cells_list(Cells),
    once(( member(cell(_, Pid, Key), Cells), Key \== spare )),
    started_by(Pid, Inside),
    process_kill(Pid, kill),
    wait_until(forall(member(P, Inside), is_dead(P)), 30),
    thread_send_message(Queue, go),
    agent_join(A, Outcome0, 30),
    Outcome = ended(Outcome0),
    attempt(true, Beside).

%   The system kills these when Pid has been killed.

started_by(Pid, Pids) :-
    format(atom(File), '/proc/~w/task/~w/children', [Pid, Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, " ", " ", Parts),
    findall(P, ( member(Part, Parts), number_string(P, Part) ), Pids).
