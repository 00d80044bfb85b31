:- module(test_allocation_network, []).
:- use_module(common).
:- use_module(event_log).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).
:- use_module('../agents/allocation/faults').
:- use_module('../agents/allocation/operator').

/** <module> Allocation on small networks

Every test ends with all robots free, and looks in the log for any that was
reserved twice.  A process is killed with whatever is in it.
*/

%   allocation(+Topology, +Options, +Settings, :Goal): Goal(Hosts, File),
%   with robots that push on all hosts.

:- meta_predicate allocation(+, +, +, 2).

allocation(Topology, Options, Settings, Goal) :-
    no_leaks(with_tmp_dir(allocation_in(Topology, Options, Settings, Goal))).

allocation_in(Topology, Options, Settings, Goal, Dir) :-
    atom_concat(Dir, '/events.pl', File),
    setup_call_cleanup(
        network_start(Topology, Network,
                      [clock(20), seed(1), log(File)|Options]),
        ( network_property(Network, hosts(Hosts)),
          maplist(push_robot(Settings), Hosts),
          maplist(push_robot(Settings), Hosts),     % no second one
          once(call(Goal, Hosts, File)) ),
        network_stop(Network)),
    log_events(File, Events),
    reservation_faults(Events, Faults),
    exclude(died(Events), Faults, []).

push_robot(Settings, Host) :-
    robot_start(Host, [push], [settings(Settings)]).

%   Goals of tests log the hosts that they kill.

:- dynamic killed/1.

died(_, held(Robot, _, _)) :-
    killed(Robot).

%   push(+Name, +Count, +Details, +Host, +Settings, -Agent)

push(Name, Count, Details, Host, Settings, Agent) :-
    task_allocate(task(Name, [Count-[push]], Details), Host,
                  [settings([seed-1|Settings])], Agent).

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

count(File, What, Count) :-
    so_far(File, Whats),
    aggregate_all(count, ( member(Other, Whats), subsumes_term(What, Other) ),
                  Count).

ends(Agent) :-
    agent_join(Agent, Outcome, 60),
    (   Outcome == done
    ->  true
    ;   throw(error(ended(Agent, Outcome), _))
    ).

executing(Agent, Robots) :-
    wait_until(allocation_stage(Agent, executing, Robots), 40).

:- begin_tests(allocation_network).

test(two_that_need_all_robots) :-
    allocation(ring(5), [hop_time(uniform(0.2, 0.4))], [], both_all).

both_all(Hosts, File) :-
    Hosts = [A, _, B|_],
    maplist([Name-Host, Agent]>>push(Name, 5, [], Host, [], Agent),
            [a-A, b-B], Agents),
    maplist(ends, Agents),
    all_free(Hosts),
    forall(member(Name, [a, b]),
           ( memberchk_log(File, completed(Name)),
             count(File, executed(_, _, Name), 5) )),
    so_far(File, Whats),
    forall(member(Kind, [migration, child, message]),
           memberchk(communications(Kind, _), Whats)).

memberchk_log(File, What) :-
    so_far(File, Whats),
    memberchk(What, Whats).

test(four_with_constant_back_off) :-
    allocation(random(8, 0.4), [hop_time(uniform(0.1, 0.2))], [], four).

four(Hosts, File) :-
    append(First, [_, _, _, _], Hosts),
    findall(Agent,
            ( nth1(Name, First, Host),
              push(Name, 6, [duration(1)], Host,
                   [backoff-constant, bi_min-2, children-2], Agent) ),
            Agents),
    maplist(ends, Agents),
    all_free(Hosts),
    count(File, completed(_), 4),
    count(File, executed(_, _, _), 24).

test(deadline_while_searching) :-
    allocation(ring(3), [], [], too_many).

too_many(Hosts, File) :-
    Hosts = [Host|_],
    push(t, 4, [deadline(10)], Host, [], Agent),
    ends(Agent),
    all_free(Hosts),
    memberchk_log(File, missed(t, 10)),
    count(File, completed(_), 0).

test(deadline_while_executing) :-
    allocation(ring(3), [], [], too_long).

too_long(Hosts, File) :-
    Hosts = [Host|_],
    push(t, 3, [deadline(15), duration(1000)], Host, [], Agent),
    ends(Agent),
    all_free(Hosts),
    memberchk_log(File, missed(t, 15)),
    memberchk_log(File, allocated(t, _)),
    count(File, executed(_, _, _), 0),
    wait_until(maplist([H]>>remote(H, host_load(1)), Hosts), 20).

%   A robot is out of order until the urgent task is done, so the first one
%   cannot be.

test(urgent_task_is_served_first) :-
    allocation(ring(3), [hop_time(uniform(0.1, 0.2))], [], urgent).

urgent(Hosts, File) :-
    Hosts = [First, _, Last],
    robot_fail(Last),
    push(a, 3, [], First, [chi-1.0e30], A),
    wait_until(( allocation_stage(A, _, Held), length(Held, 2) ), 40),
    push(b, 2, [priority(1)], First, [], B),
    ends(B),
    count(File, completed(a), 0),
    robot_repair(Last),
    ends(A),
    all_free(Hosts),
    so_far(File, Whats),
    append(_, [begun(a)|Later], Whats),
    append(_, [begun(b)|Later1], Later),
    append(_, [completed(b)|Later2], Later1),
    memberchk(completed(a), Later2).

test(robot_fails_while_reserved) :-
    allocation(ring(3), [], [], fails_reserved).

fails_reserved(Hosts, File) :-
    Hosts = [First, Second, Third],
    robot_fail(Third),
    push(t, 3, [], First, [chi-1.0e30], Agent),
    wait_until(( allocation_stage(Agent, _, Held), length(Held, 2) ), 40),
    robot_fail(Second),
    happened(File, lost(Second, failed)),
    maplist(robot_repair, [Second, Third]),
    ends(Agent),
    all_free(Hosts),
    count(File, executed(_, _, t), 3).

test(robot_fails_while_executing) :-
    allocation(ring(4), [], [], fails_executing).

fails_executing(Hosts, File) :-
    Hosts = [First|_],
    push(t, 3, [goal(receive(_-go, 30) -> true ; true)], First, [], Agent),
    executing(Agent, [Robot|_]),
    wait_until(robot_status(Robot, executing(Agent, t)), 20),
    robot_fail(Robot),
    ends(Agent),
    all_of_others(Hosts, Robot),
    memberchk_log(File, lost(Robot, failed)),
    count(File, executed(_, _, t), 3),
    count(File, executed(Robot, _, t), 0).

all_of_others(Hosts, Robot) :-
    exclude(==(Robot), Hosts, Others),
    all_free(Others),
    robot_status(Robot, failed).

%   Who disposes of an allocator does not dispose of its reservations.

test(allocator_is_disposed_of) :-
    allocation(ring(3), [], [watch-3, patience-3], disposed_of).

disposed_of(Hosts, _) :-
    Hosts = [First|_],
    push(t, 4, [], First, [chi-1.0e30], Agent),
    wait_until(( allocation_stage(Agent, _, Held), length(Held, 3) ), 40),
    agent_dispose(Agent),
    all_free(Hosts).

test(allocator_is_disposed_of_while_executing) :-
    allocation(ring(3), [], [watch-3, patience-3], disposed_executing).

disposed_executing(Hosts, File) :-
    Hosts = [First|_],
    push(t, 3, [duration(1000)], First, [], Agent),
    executing(Agent, _),
    wait_until(robot_status(First, executing(Agent, t)), 20),
    agent_dispose(Agent),
    all_free(Hosts),
    count(File, executed(_, _, _), 0).

%   Robots that are not reached hear it from the allocator that rests, or
%   hear nothing of one that has ended.

test(children_reach_nobody) :-
    allocation(ring(4), [hop_time(uniform(0.1, 0.2))],
               [watch-3, patience-3], childless).

childless(Hosts, File) :-
    Hosts = [First|_],
    push(t, 5, [deadline(60)], First, [chi-0.05, child_life-0], Agent),
    happened(File, not_reached(_)),
    happened(File, released(_, _, _)),
    push(u, 4, [], First, [child_life-0], Other),
    ends(Other),
    ends(Agent),
    all_free(Hosts).

:- end_tests(allocation_network).

                /*******************************
                *         KILLED HOSTS         *
                *******************************/

%   Of two processes, each with the robots of half of the hosts.

halves(Hosts, First, Second) :-
    length(Hosts, Count),
    Half is Count//2,
    length(First, Half),
    append(First, Second, Hosts).

kill(Pid, Hosts) :-
    forall(member(Host, Hosts), assertz(killed(Host))),
    process_kill(Pid, kill).

pid(Number, Pid) :-
    network_property(_, processes(Pids)),
    nth1(Number, Pids, Pid).

:- begin_tests(allocation_killed, [cleanup(retractall(killed(_)))]).

%   It has robots in both processes, and is in the first one, where the last
%   robot it needs is not ready.

test(allocator_is_killed) :-
    allocation(ring(4), [processes(2)], [watch-5, patience-5],
               killed_allocator).

killed_allocator(Hosts, _) :-
    halves(Hosts, First, Second),
    First = [Host|_],
    push(t, 5, [], Host, [chi-1.0e30], Agent),
    wait_until(( allocation_stage(Agent, _, Held), length(Held, 4) ), 40),
    pid(1, Pid),
    wait_until(kill_with(Pid, Agent, First), 40),
    all_free(Second),
    Second = [Other|_],
    push(u, 2, [], Other, [], Next),
    ends(Next),
    all_free(Second).

%   Stopped, it cannot leave the process meanwhile.

kill_with(Pid, Agent, Hosts) :-
    agent_property(Agent, host(Here)),
    memberchk(Here, Hosts),
    kill(Pid, Hosts).

test(robots_are_killed_and_replaced) :-
    allocation(random(8, 1.0), [processes(2)], [watch-5, patience-5],
               killed_robots).

killed_robots(Hosts, File) :-
    halves(Hosts, First, Second),
    First = [Host, Out1|_],
    Second = [Out2, Out3|_],
    maplist(robot_fail, [Host, Out1, Out2, Out3]),
    push(t, 4, [duration(60)], Host, [monitor-5], Agent),
    executing(Agent, Robots),
    agent_property(Agent, host(Here)),
    (   memberchk(Here, First)
    ->  replaced(2, Second, First, [Host, Out1], File)
    ;   replaced(1, First, Second, [Out2, Out3], File)
    ),
    length(Robots, 4).

replaced(Number, Dying, Living, Idle, File) :-
    pid(Number, Pid),
    kill(Pid, Dying),
    happened(File, lost(_, _)),
    maplist(robot_repair, Idle),
    happened(File, completed(t)),
    all_free(Living),
    count(File, executed(_, _, t), Count),
    Count >= 4.

:- end_tests(allocation_killed).
