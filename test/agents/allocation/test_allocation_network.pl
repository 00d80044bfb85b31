:- module(test_allocation_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/event_log').
:- use_module('../../lib/networks').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).
:- use_module('../../../agents/allocation/reservations').
:- use_module('../../../agents/allocation/operator').
:- use_module('../../../agents/allocation/sequence').

/** <module> Allocation on small networks

At the end of every test all robots must be free, and the log must not show
any robot that was reserved twice. A process is killed with all its hosts and
agents.
*/

%   allocation(+Topology, +Options, +Settings, -Hosts, -File, :Goal): with
%   robots that push on all Hosts.

:- meta_predicate allocation(+, +, +, -, -, 0).

allocation(Topology, Options, Settings, Hosts, File, Goal) :-
    with_logged_network(
        Topology, [clock(40), seed(1)|Options], Hosts, File,
        ( maplist(push_robot(Settings), Hosts),
          maplist(push_robot(Settings), Hosts), % no second robot
          Goal ), Events),
    reservation_faults(Events, Faults),
    exclude(died(Events), Faults, []).

push_robot(Settings, Host) :-
    append(Settings, [watch-1000, patience-1000], All),
    robot_start(Host, [push], [settings(All)]).

%   Goals of tests log the hosts that they kill.

:- dynamic killed/1.

died(_, held(Robot, _, _)) :-
    killed(Robot).

%   push(+Name, +Count, +Details, +Host, +Settings, -Agent)

push(Name, Count, Details, Host, Settings, Agent) :-
    append(Settings, [seed-1, patience-200, monitor-100], All),
    task_allocate(task(Name, [Count-[push]], Details), Host,
                  [settings(All)], Agent).

all_free(Hosts) :-
    wait_until(maplist(free, Hosts), 40).

free(Host) :-
    robot_status(Host, free).

happened(File, What) :-
    wait_until(( logged(File, Events), memberchk(event(_, _, _, What), Events)
               ), 40).

so_far(File, Whats) :-
    logged(File, Events),
    findall(What, member(event(_, _, _, What), Events), Whats).

%   count(+File, +What, +Count): What is logged Count times; the log may lag.

count(File, What, Count) :-
    wait_until(( so_far(File, Whats),
                 aggregate_all(count,
                               ( member(Other, Whats),
                                 subsumes_term(What, Other) ),
                               Count) ), 40).

ends(Agent) :-
    agent_join(Agent, Outcome, 60),
    (   Outcome == done
    ->  true
    ;   throw(error(ended(Agent, Outcome), _))
    ).

executing(Agent, Robots) :-
    wait_until(allocation_stage(Agent, executing, Robots), 40).

:- begin_tests(allocation_network).

test(two_allocators_that_need_all_robots) :-
    allocation(ring(5), [hop_time(uniform(0.2, 0.4))], [], Hosts, File,
        ( Hosts = [A, _, B|_],
          maplist([Name-Host, Agent]>>push(Name, 5, [], Host, [], Agent),
                  [a-A, b-B], Agents),
          maplist(ends, Agents),
          all_free(Hosts),
          forall(member(Name, [a, b]),
                 ( happened(File, completed(Name)),
                   count(File, executed(_, _, Name), 5) )),
          forall(member(Kind, [migration, child, message]),
                 happened(File, communications(Kind, _))) )).
test(four_allocators_with_constant_back_off) :-
    allocation(random(8, 0.4), [hop_time(uniform(0.1, 0.2))], [], Hosts, File,
        ( append(First, [_, _, _, _], Hosts),
          findall(Agent,
                  ( nth1(Name, First, Host),
                    push(Name, 6, [duration(1)], Host,
                         [backoff-constant, bi_min-2, children-2], Agent) ),
                  Agents),
          maplist(ends, Agents),
          all_free(Hosts),
          count(File, completed(_), 4),
          count(File, executed(_, _, _), 24) )).

%   Four robots found, and hops that take a second: equation 7.6.

test(back_off_is_measured_in_hop_times) :-
    allocation(ring(4), [hop_time(uniform(1, 1))],
               [watch-10, patience-10], Hosts, File,
        ( Hosts = [Host|_],
          push(t, 5, [], Host, [chi-0.05], Agent),
          happened(File, backoff(_)),
          so_far(File, Whats),
          memberchk(backoff(Interval), Whats),
          Interval >= 4,
          wait_until(allocation_stage(Agent, resting, []), 20),
          agent_dispose(Agent),
          all_free(Hosts) )).
test(deadline_while_searching) :-
    allocation(ring(3), [], [], Hosts, File,
        ( Hosts = [Host|_],
          push(t, 4, [deadline(10)], Host, [], Agent),
          ends(Agent),
          all_free(Hosts),
          happened(File, missed(t, 10)),
          count(File, completed(_), 0) )).
test(deadline_while_executing) :-
    allocation(ring(3), [], [], Hosts, File,
        ( Hosts = [Host|_],
          push(t, 3, [deadline(60), duration(1000)], Host, [], Agent),
          ends(Agent),
          all_free(Hosts),
          happened(File, missed(t, 60)),
          happened(File, allocated(t, _)),
          count(File, executed(_, _, _), 0),
          wait_until(maplist([H]>>remote(H, host_load(1)), Hosts), 20) )).

%   A robot is out of order until the urgent task is done, so the first task
%   cannot be done before.

test(urgent_task_is_served_first) :-
    allocation(ring(3), [hop_time(uniform(0.1, 0.2))], [], Hosts, File,
        ( Hosts = [First, _, Last],
          robot_fail(Last),
          push(a, 3, [], First, [chi-1.0e30], A),
          wait_until(( allocation_stage(A, _, Held), length(Held, 2) ), 40),
          push(b, 2, [priority(1)], First, [], B),
          ends(B),
          count(File, completed(a), 0),
          robot_repair(Last),
          ends(A),
          all_free(Hosts),
          happened(File, completed(a)),
          so_far(File, Whats),
          append(_, [begun(a)|Later], Whats),
          append(_, [begun(b)|Later1], Later),
          append(_, [completed(b)|Later2], Later1),
          memberchk(completed(a), Later2) )).
test(robot_fails_while_reserved) :-
    allocation(ring(3), [], [], Hosts, File,
        ( Hosts = [First, Second, Third],
          robot_fail(Third),
          push(t, 3, [], First, [chi-1.0e30], Agent),
          wait_until(( allocation_stage(Agent, _, Held), length(Held, 2) ), 40),
          robot_fail(Second),
          happened(File, lost(Second, failed)),
          maplist(robot_repair, [Second, Third]),
          ends(Agent),
          all_free(Hosts),
          count(File, executed(_, _, t), 3) )).
test(robot_fails_while_executing) :-
    allocation(ring(4), [], [], Hosts, File, fails_executing(Hosts, File)).

fails_executing(Hosts, File) :-
    Hosts = [First|_],
    push(t, 3, [goal(receive(_-go, 200) -> true ; true)], First, [], Agent),
    executing(Agent, [Robot|_]),
    wait_until(robot_status(Robot, executing(Agent, t)), 20),
    robot_fail(Robot),
    ends(Agent),
    all_of_others(Hosts, Robot),
    happened(File, lost(Robot, failed)),
    count(File, executed(_, _, t), 3),
    count(File, executed(Robot, _, t), 0).

all_of_others(Hosts, Robot) :-
    exclude(==(Robot), Hosts, Others),
    all_free(Others),
    robot_status(Robot, failed).

%   Otherwise one robot is reserved repeatedly, with a reward each time.

test(failed_robots_are_asked_again_after_a_back_off) :-
    allocation(ring(3), [hop_time(uniform(0.2, 0.4))], [], Hosts, File,
        ( Hosts = [First|_],
          push(t, 2, [goal(fail), deadline(100)], First, [], Agent),
          ends(Agent),
          all_free(Hosts),
          happened(File, missed(t, 100)),
          so_far(File, Whats),
          aggregate_all(count, member(lost(_, failed), Whats), Lost),
          aggregate_all(count, member(backoff(_), Whats), Rests),
          Lost > Rests,
          Rests > 0,
          Lost =< 3*(Rests + 1) )).

%   An order to dispose of an allocator does not dispose of its reservations.

test(allocator_is_disposed_of) :-
    allocation(ring(3), [], [watch-5, patience-50], Hosts, _,
        ( Hosts = [First|_],
          push(t, 4, [], First, [chi-1.0e30], Agent),
          wait_until(( allocation_stage(Agent, _, Held), length(Held, 3) ), 40),
          agent_dispose(Agent),
          all_free(Hosts) )).
test(allocator_is_disposed_of_while_executing) :-
    allocation(ring(3), [], [watch-5, patience-50], Hosts, File,
        ( Hosts = [First|_],
          push(t, 3, [duration(1000)], First, [], Agent),
          executing(Agent, _),
          wait_until(robot_status(First, executing(Agent, t)), 20),
          agent_dispose(Agent),
          all_free(Hosts),
          count(File, executed(_, _, _), 0) )).

%   Robots that are not reached are notified by the allocator that rests; they
%   get no message from one that has ended.

test(children_reach_no_robot) :-
    allocation(ring(4), [hop_time(uniform(0.1, 0.2))],
               [watch-5, patience-5], Hosts, File,
        ( Hosts = [First|_],
          push(t, 5, [deadline(60)], First, [chi-0.05, child_life-0], Agent),
          happened(File, not_reached(_)),
          happened(File, released(_, _, _)),
          push(u, 4, [], First, [child_life-0], Other),
          ends(Other),
          ends(Agent),
          all_free(Hosts) )).

%   Allocation finds the robots, and the sequence is executed on these.

test(sequence_on_the_robots_found) :-
    allocation(random(6, 0.6), [hop_time(uniform(0.1, 0.2))], [], Hosts, File,
        ( Hosts = [Out, First|_],
          robot_fail(Out),
          Tasks = [floor-sleep(0.5), walls-sleep(0.5), roof-sleep(0.5)],
          sequence_allocate(house, [3-[push]], First, Tasks,
                            [ allocation([settings([seed-1])]),
                              population([ seed(1),
                                           settings([threshold-20, tick-0.5]) ])
                            ],
                            Robots, Outcome),
          Outcome == completed,
          Hosts = [_|Others],
          all_free(Others),
          happened(File, completed(house)),
          logged(File, Events),
          forall(member(Task-_, Tasks),
                 ( findall(Host,
                           member(event(_, Host, _, completed(house, Task)),
                                  Events),
                           Where),
                   msort(Where, Sorted),
                   msort(Robots, Sorted) )),
          length(Robots, 3),
          \+ memberchk(Out, Robots) )).
test(sequence_is_missed) :-
    allocation(ring(2), [], [], Hosts, File, sequence_missed(Hosts, File)).

sequence_missed(Hosts, File) :-
    Hosts = [First|_],
    sequence_allocate(house, [3-[push]], First, [floor-true], [deadline(20)],
                      Robots, Outcome),
    Robots-Outcome == []-missed,
    happened(File, missed(house, 20)),
    all_free(Hosts).

:- end_tests(allocation_network).

                /*******************************
                *         KILLED HOSTS         *
                *******************************/

%   blocks(+Hosts, -Blocks): Pid-Hosts for each process.

blocks(Hosts, Blocks) :-
    network_property(_, processes(Pids)),
    length(Hosts, Count),
    length(Pids, Processes),
    Size is Count//Processes,
    blocks(Pids, Size, Hosts, Blocks).

blocks([], _, [], []).
blocks([Pid|Pids], Size, Hosts, [Pid-Block|Blocks]) :-
    length(Block, Size),
    append(Block, Rest, Hosts),
    blocks(Pids, Size, Rest, Blocks).

kill(Pid-Hosts) :-
    forall(member(Host, Hosts), assertz(killed(Host))),
    process_kill(Pid, kill).

%   part(+Agent, +Blocks, -Block, -Others): Block is that of the process in
%   which Agent is.

part(Agent, Blocks, Pid-Block, Others) :-
    agent_property(Agent, host(Host)),
    select(Pid-Block, Blocks, Others),
    memberchk(Host, Block),
    !.

:- begin_tests(allocation_killed, [cleanup(retractall(killed(_)))]).

%   Stopping a network with dead processes takes some seconds, so the processes
%   die one after the other in one network.

test(killed_processes) :-
    allocation(random(9, 1.0), [processes(3)], [watch-10, patience-100],
               Hosts, File, killed(Hosts, File)).

killed(Hosts, File) :-
    blocks(Hosts, Blocks),
    allocator_killed(Hosts, Blocks, Left),
    robots_killed(Left, File).

%   The allocator waits for a tenth robot.

allocator_killed([Host|_], Blocks, Left) :-
    push(t, 10, [], Host, [chi-1.0e30], Agent),
    wait_until(( allocation_stage(Agent, _, Held), length(Held, 9) ), 40),
    part(Agent, Blocks, Block, Left),
    kill(Block),
    forall(member(_-Others, Left), all_free(Others)).

%   Two robots of six are in order, one in each process. When the process dies
%   in which the allocator is not, and to which it is not moving, other robots
%   are repaired.

robots_killed(Blocks, File) :-
    Blocks = [_-[_|Out1], _-[Host|Out2]],
    append(Out1, Out2, Out),
    maplist(robot_fail, Out),
    push(u, 2, [duration(100)], Host, [monitor-40], Agent),
    executing(Agent, Robots),
    length(Robots, 2),
    wait_until(( part(Agent, Blocks, _-Living, [Other]),
                 agent_property(Agent, state(waiting)) ), 10),
    kill(Other),
    happened(File, lost(_, _)),
    intersection(Out, Living, Idle),
    maplist(robot_repair, Idle),
    happened(File, completed(u)),
    all_free(Living),
    count(File, executed(_, _, u), 2).

:- end_tests(allocation_killed).
