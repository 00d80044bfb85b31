:- module(test_sync_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [file_lines/2]).
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists),
              [ append/2, append/3, max_list/2, member/2, min_list/2,
                numlist/3 ]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module('../../../agents/sync/operator').
:- use_module('../../../agents/sync/several').

/** <module> Synchronised execution on small networks

Six hosts in two processes, on which each test runs a sequence of its own.
Tests that act in the middle of a sequence have a task `gate`, which lasts
until they open it.
*/

:- dynamic
    world/3.                            % Network, Hosts, log File

world_start :-
    world_start(ring(6), [processes(2), hop_time(uniform(0.1, 0.2))]).

world_start(Topology, Options) :-
    tmp_file(events, File),
    network_start(Topology, Network,
                  [clock(20), seed(1), log(File)|Options]),
    network_property(Network, hosts(Hosts)),
    assertz(world(Network, Hosts, File)).

world_end :-
    retract(world(Network, _, File)),
    network_stop(Network),
    delete_file(File).

hosts(Hosts) :-
    world(_, Hosts, _).

                /*******************************
                *           SEQUENCES          *
                *******************************/

%   start(+Sequence, +Tasks, -Agents): two of them, on all hosts.

start(Sequence, Tasks, Agents) :-
    hosts(Hosts),
    start(Sequence, Hosts, Tasks, Agents).

start(Sequence, Hosts, Tasks, Agents) :-
    sequence_start(Sequence, Hosts, Tasks, [agents(2), seed(1)], Agents).

tasks(Names, Tasks) :-
    maplist(task, Names, Tasks).

task(gate, gate-( self(Me), leave(gate(Me)), receive(_-open) )) :-
    !.
task(Name, Name-sleep(0.5)).

all_end(Agents) :-
    forall(member(Agent, Agents), agent_join(Agent, done, 30)).

start_with_gate(Sequence, Names, Agents) :-
    tasks(Names, Tasks),
    start(Sequence, Tasks, Agents),
    all_at_gate.

all_at_gate :-
    hosts(Hosts),
    wait_until(maplist(at_gate, Hosts), 20).

at_gate(Host) :-
    remote(Host, sense(gate(_))).

open_gates :-
    hosts(Hosts),
    forall(member(Host, Hosts),
           ( remote(Host, take(gate(Worker))),
             agent_send(Worker, open) )).

has(Sequence, Task, Status, Host) :-
    remote(Host, sense(task(Sequence, Task, Status, _))).

all_have(Sequence, Task, Status) :-
    hosts(Hosts),
    maplist(has(Sequence, Task, Status), Hosts).

                /*******************************
                *            HISTORY           *
                *******************************/

%   histories(+Sequence, +Length, -Histories): for each host the events of its
%   tasks in order: r(Task) began, c(Task) completed, f(Task) failed. Waits
%   until there are Length events in all.

histories(Sequence, Length, Histories) :-
    hosts(Hosts),
    wait_until(logged(Sequence, Length, Events), 20),
    maplist(history(Events), Hosts, Histories).

history(Events, Host, History) :-
    findall(What, member(event(_, Host, What), Events), History).

logged(Sequence, Length, Events) :-
    world(_, _, File),
    file_lines(File, Lines0),
    append(Lines, [_], Lines0),         % what is just being written
    !,
    findall(Event,
            ( member(Line, Lines), task_event(Line, Sequence, Event) ),
            Events),
    length(Events, Length0),
    Length0 >= Length.

task_event(Line, Sequence, event(Time, Host, What)) :-
    atom_string(Sequence, Name),
    sub_string(Line, _, _, _, Name),
    term_string(event(Time, Host, _, Told), Line),
    logged_task(Told, Sequence, What).

logged_task(executing(Sequence, Task), Sequence, r(Task)).
logged_task(completed(Sequence, Task), Sequence, c(Task)).
logged_task(failed(Sequence, Task), Sequence, f(Task)).

%   all_executed(+Sequence, +Names): each host did them in order, once.

all_executed(Sequence, Names) :-
    hosts(Hosts),
    length(Hosts, Count),
    executed(Names, History),
    length(History, Length),
    Total is Count*Length,
    histories(Sequence, Total, Histories),
    maplist(==(History), Histories).

%   executed(+Names, -History): of a host that executed them in order.

executed(Names, History) :-
    findall(What, ( member(T, Names), member(What, [r(T), c(T)]) ), History).

%   overlap(+Events, +Names): a task began before the last host began the
%   one before.

overlap(Events, Names) :-
    append(_, [Task, Next|_], Names),
    times(Events, r(Task), Times),
    times(Events, r(Next), NextTimes),
    max_list(Times, Last),
    min_list(NextTimes, First),
    First < Last.

times(Events, What, Times) :-
    findall(Time, member(event(Time, _, What), Events), Times).

%   Nothing is executing, no mark of a failure is left.

settled(Sequence) :-
    hosts(Hosts),
    forall(( member(Host, Hosts),
             member(Status, [executing, failed(_)]) ),
           \+ has(Sequence, _, Status, Host)).

                /*******************************
                *             TESTS            *
                *******************************/

%   Two sequences of two tasks, and the tasks for which these wait.

circle(AfterA, AfterB,
       [ sequence(a, [], [1-true, 2-true], [after(AfterA)]),
         sequence(b, [], [1-true, 2-true], [after(AfterB)])
       ]).

%   wrong(?What, +Hosts, -Goal, -Formal): the error that Goal raises.

wrong(tasks_that_wait_in_a_circle, _, sequences_start(Sequences, [], _),
      domain_error(order_of_tasks, [a:1, a:2, b:1])) :-
    circle([2-(b:1)], [1-(a:2)], Sequences).
wrong(no_such_task_to_wait_for, _, sequences_start(Sequences, [], _),
      existence_error(task, b:7)) :-
    circle([2-(b:7)], [], Sequences).
wrong(unknown_sequence, Hosts, sequence_change(nothing, Hosts, [1-true]),
      existence_error(sequence, nothing)).
wrong(two_tasks_of_one_name, Hosts,
      sequence_start(twice, Hosts, [1-true, 1-fail], [], _),
      domain_error(distinct_tasks, [1, 1])).
wrong(Setting, Hosts,
      sequence_start(odd, Hosts, [1-true], [settings([Setting])], _),
      domain_error(setting, Setting)) :-
    member(Setting, [delta-0, strategy-_, hurry-1]).

:- begin_tests(sync_network, [ setup(world_start), cleanup(world_end) ]).

test(in_order_and_in_step) :-
    tasks([1, 2, 3], Tasks),
    start(plain, Tasks, Agents),
    all_end(Agents),
    all_executed(plain, [1, 2, 3]),
    logged(plain, 36, Events),
    \+ overlap(Events, [1, 2, 3]).
test(only_on_the_hosts_named) :-
    hosts([A, B, C, D, E, F]),
    tasks([1, 2], Tasks),
    start(subset, [A, B, D], Tasks, Agents),
    all_end(Agents),
    histories(subset, 12, Histories),
    executed([1, 2], H),
    Histories == [H, H, [], H, [], []],
    forall(member(Host, [C, E, F]),
           \+ remote(Host, ( sense(T), arg(1, T, subset) ))).
test(two_sequences_at_once) :-
    start_with_gate(slow, [1, gate], Agents1),
    tasks([a, b, c], Tasks),
    start(fast, Tasks, Agents2),
    all_end(Agents2),                   % while `slow` holds its workers
    all_executed(fast, [a, b, c]),
    all_have(slow, gate, executing),
    open_gates,
    all_end(Agents1),
    all_executed(slow, [1, gate]).
test(busy_worker_of_a_pool_is_not_doubled, Before == After) :-
    hosts([A|_]),
    sequence_start(first, [A], [1-true], [agents(0), pool(crew)], []),
    wait_until(remote(A, sense(worker(crew, _))), 10),
    remote(A, ( take(worker(crew, Worker)), host_load(Before) )),
    sequence_start(second, [A], [1-true], [agents(0), pool(crew)], []),
    remote(A, ( host_load(After), leave(worker(crew, Worker)) )).
test(atomic_failures_from_another_process_are_healed) :-
    start_with_gate(atomic, [1, 2, gate], Agents),
    hosts(Hosts),
    Hosts = [A, _, _, B|_],
    elsewhere(task_fail(atomic, 1, [A, B], Failed), Failed),
    Failed == [A, B],
    has(atomic, 1, failed(atomic), A),
    open_gates,
    all_end(Agents),
    histories(atomic, 42, [HA, H, H, HB, H, H]),
    executed([1, 2, gate], H),
    maplist(healed_atomic, [HA, HB]),
    settled(atomic).
test(cascaded_failures_are_healed_in_order) :-
    start_with_gate(cascade, [1, 2, gate], Agents),
    hosts(Hosts),
    tasks_fail(cascade, 2, Hosts, Failed),
    Failed == Hosts,
    open_gates,
    all_at_gate,
    open_gates,
    all_end(Agents),
    histories(cascade, 66, Histories),
    executed([1, 2], Before),
    executed([2, gate], After),
    append([Before, [r(gate), f(2), f(gate)], After], History),
    maplist(==(History), Histories),
    settled(cascade).
test(task_added) :-
    start_with_gate(added, [1, gate], Agents),
    tasks([1, gate, 3], Tasks),
    hosts([A|_]),
    sequence_change(added, [A], Tasks),
    open_gates,
    all_end(Agents),
    all_executed(added, [1, gate, 3]),
    logged(added, 36, Events),
    \+ overlap(Events, [1, gate, 3]).
test(task_removed) :-
    start_with_gate(removed, [1, gate, 3, 4], Agents),
    tasks([1, gate, 4], Tasks),
    hosts([_, _, _, D|_]),
    sequence_change(removed, [D], Tasks),
    wait_until(maplist(plans(3), Agents), 20),
    open_gates,
    all_end(Agents),
    all_executed(removed, [1, gate, 4]).
test(task_that_always_fails_is_taken_out) :-
    tasks([1, 3], [First, Last]),
    start(bad, [First, 2-fail, Last], Agents),
    wait_until(logged_event(bad, f(2)), 20),
    hosts([A|_]),
    sequence_change(bad, [A], [First, Last]),
    all_end(Agents),
    wait_until(all_have(bad, 3, completed), 20),
    forall(member(Task, [1, 3]), times_completed(bad, Task, 6)).
test(hosts_that_come_late) :-
    hosts([A, B, C, D, E, F]),
    tasks([1, gate], Tasks),
    start(late, [A, B, C, D], Tasks, Agents),
    wait_until(maplist(at_gate, [A, B, C, D]), 20),
    sequence_start(late, [E, F], Tasks, [agents(0)], []),
    all_at_gate,
    open_gates,
    all_end(Agents),
    all_executed(late, [1, gate]).
test(failure_after_the_end_is_healed_by_new_agents) :-
    tasks([1, 2], Tasks),
    start(again, Tasks, Agents1),
    all_end(Agents1),
    histories(again, 24, _),
    hosts([_, B|_]),
    task_fail(again, 1, [B], [B]),
    start(again, Tasks, Agents2),
    all_end(Agents2),
    histories(again, 27, Histories),
    executed([1, 2], H),
    append(H, [f(1), r(1), c(1)], Healed),
    Histories == [H, Healed, H, H, H, H],
    hosts(Hosts),
    forall(member(Host, Hosts), one_worker(again, Host)).
test(uncompleted_task_does_not_fail, Failed == []) :-
    start_with_gate(early, [1, gate, 3], Agents),
    hosts(Hosts),
    task_fail(early, 3, Hosts, Failed),
    tasks_fail(early, 3, Hosts, Failed),
    open_gates,
    all_end(Agents),
    all_executed(early, [1, gate, 3]).
test(last_change_is_the_newest, true(V0 < V1)) :-
    hosts([A, B|_]),
    sequence_start(undecided, [A, B], [1-true], [agents(0)], []),
    sequence_change(undecided, [A], [1-false]),
    sequence_change(undecided, [B], [1-true]),  % as it was there
    plan_at(A, undecided, V0),
    plan_at(B, undecided, V1).
test(tasks_of_an_older_plan_are_a_newer_one,
     [ forall(member(Body-Order, [true-(=),false-(<)])), Found == Order ]) :-
    hosts([A, B|_]),
    atom_concat(older_, Body, Name),
    sequence_start(Name, [A, B], [1-true], [agents(0)], []),
    sequence_change(Name, [A], [1-false]),
    sequence_change(Name, [B], [1-true]),
    plan_at(B, Name, Newest),
    sequence_start(Name, [A, B], [1-Body], [agents(0)], []),
    plan_at(A, Name, Version),
    plan_at(B, Name, Version),
    compare(Found, Newest, Version).
test(same_tasks_are_the_same_plan, V1 == V0) :-
    hosts([A|_]),
    Goal = sleep(_),
    sequence_start(same, [A], [1-Goal], [agents(0)], []),
    plan_at(A, same, V0),
    sequence_start(same, [A], [1-Goal], [agents(0)], []),
    plan_at(A, same, V1).
test(error, [forall(wrong(_What, Hosts, Goal, Formal))]) :-
    hosts(Hosts),
    catch(Goal, error(Raised, _), true),
    assertion(Raised =@= Formal).
test(another_strategy) :-
    hosts(Hosts),
    sequence_start(random, Hosts, [1-true],
                   [ agents(2),
                     settings([delta-20, strategy-random]) ], Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 60)).

logged_event(Sequence, What) :-
    logged(Sequence, 0, Events),
    memberchk(event(_, _, What), Events).

times_completed(Sequence, Task, Count) :-
    wait_until(( logged(Sequence, 0, Events),
                 times(Events, c(Task), Times),
                 length(Times, Count) ), 20).

plan_at(Host, Sequence, Version) :-
    remote(Host, sense(plan(Sequence, Version, _))).

healed_atomic(History) :-
    executed([1, 2], Before),
    append([Before, [r(gate), f(1), c(gate)], [r(1), c(1)]], History).

plans(Count, Agent) :-
    agent_property(Agent, facts(Facts)),
    memberchk(plan(_, _, Tasks), Facts),
    length(Tasks, Count).

one_worker(Sequence, Host) :-
    remote(Host, aggregate_all(count, sense(worker(Sequence, _)), 1)).

%   elsewhere(+Goal, ?Result): Goal in a process that has nothing to do
%   with the network.

elsewhere(Goal, Result) :-
    project_file('prolog/typhon.pl', Typhon),
    project_file('agents/sync/operator.pl', Operator),
    format(atom(Text), '~q', [( host_start(desk), Goal,
                                format("~q.~n", [Result]),
                                host_stop(desk) )]),
    run_swipl([ '-g', Text, '-t', halt, '-l', Typhon, Operator ],
              [], exit(0), Out, _),
    term_string(Result, Out).

:- end_tests(sync_network).

                /*******************************
                *          REPETITIONS         *
                *******************************/

%   The smallest network, in this process, with a sequence for each run;
%   four run at a time.

:- begin_tests(sync_here).

test(no_overlap_in_twenty_runs) :-
    here([],
        ( forall(member(First, [1, 5, 9, 13, 17]), four_runs(First)),
          forall(between(1, 20, Run), run_was_in_step(Run)) )).
test(links_come_and_go, [ forall(dynamics(Model)) ]) :-
    here([dynamic(Model)],
        ( hosts(Hosts),
          tasks([1, 2, 3], Tasks),
          sequence_start(dynamic, Hosts, Tasks,
                         [ agents(2), seed(1),
                           settings([delta-0.2, patience-0.05]) ], Agents),
          all_end(Agents),
          histories(dynamic, 24, Histories),
          executed([1, 2, 3], History),
          maplist(==(History), Histories) )).

here(Options, Goal) :-
    no_leaks(setup_call_cleanup(
                 world_start(ring(4),
                             [hop_time(uniform(0.01, 0.02))|Options]),
                 once(Goal),
                 world_end)).

dynamics(toggle(uniform(0.1, 0.2), 0.5, 0.7)).
dynamics(links(uniform(0.1, 0.2), 0.5, 0.7)).

four_runs(First) :-
    Last is First+3,
    numlist(First, Last, Runs),
    maplist(small_run, Runs, Agents),
    maplist(all_end, Agents).

run_name(Run, Name) :-
    format(atom(Name), 'run~|~`0t~d~2+', [Run]).

small_run(Run, Agents) :-
    run_name(Run, Name),
    hosts(Hosts),
    findall(Task-sleep(0.02), member(Task, [1, 2, 3]), Tasks),
    sequence_start(Name, Hosts, Tasks,
                   [ agents(2), seed(Run), settings([delta-0.2]) ], Agents).

run_was_in_step(Run) :-
    run_name(Run, Name),
    all_executed(Name, [1, 2, 3]),
    logged(Name, 24, Events),
    \+ overlap(Events, [1, 2, 3]).

:- end_tests(sync_here).

:- begin_tests(sync_in_virtual_time).

virtual_log(Text) :-
    tmp_file(events, File),
    with_network(ring(4), [ clock(virtual), seed(1), hop_time(uniform(1, 2)),
                            log(File, [facts]) ], Network, Hosts,
        ( tasks([1, 2], Tasks),
          start(house, Hosts, Tasks, Agents),
          network_advance(Network, 3),
          tasks([1, 2, 3], More),
          sequence_change(house, Hosts, More),
          forall(member(Agent, Agents),
                 agent_join(Agent, done, 86400)) )),
    read_file_to_string(File, Text, []),
    delete_file(File).

test(logs_with_facts_are_identical, Again == First) :-
    virtual_log(First),
    assertion(sub_string(First, _, _, _, "plan(house,")),
    virtual_log(Again).

:- end_tests(sync_in_virtual_time).
