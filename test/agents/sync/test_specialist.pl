:- use_module('../../lib/common', [wait_until/2]).
:- use_module('../../lib/networks').
:- use_module('../../lib/fake_agent').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(process)).
:- use_module(library(random)).
:- use_module('../../../prolog/typhon').
:- use_module('../../../agents/population/operator').
:- use_module('../../../agents/sync/operator').
:- use_module('../../../experiments/population/metrics').
:- use_module('../../../experiments/sync/metrics', [executions/2, out_of_order/2]).
:- include('../../../agents/sync/stimulation').

/** <module> Specialists: equations, decisions, a small network
*/

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

                /*******************************
                *           EQUATIONS          *
                *******************************/

:- begin_tests(stimulation).

test(equation_6_7, [ forall(member(H0-D-Kept,
                                   [ []-7-[7], [7]-8-[7, 8],
                                     [7, 8]-3-[7, 8], [7, 8]-8-[7, 8] ])),
                     H == Kept ]) :-
    remembered(5, H0, D, H).
test(window_slides, H == [2, 3, 4]) :-
    remembered(3, [1, 2, 3], 4, H).
test(window_of_one, H == [4]) :-
    remembered(1, [1], 4, H).
test(window_of_none, H == []) :-
    remembered(0, [], 4, H).
test(equation_6_8) :-
    normalised([4, 6, 12], Values),
    maplist(close_to, Values, [0, 0.25, 1]).
test(no_history_no_dispersion, Sigma =:= 0) :-
    dispersion(1, [], Sigma).
test(one_value_no_dispersion, Sigma =:= 0) :-
    dispersion(1, [3], Sigma).
test(equal_ends_no_dispersion, Sigma =:= 0) :-
    dispersion(1, [3, 5, 3], Sigma).
test(two_values, Sigma =:= 0.5) :-
    dispersion(1, [3, 9], Sigma).
test(kappa_scales, Sigma =:= 1.5) :-
    dispersion(3, [3, 9], Sigma).
test(equation_6_9_and_6_10) :-          % of 0, 1/4, 1/2, 3/4, 1
    dispersion(1, [1, 2, 3, 4, 5], Sigma),
    close_to(Sigma, 0.3535533906).      % sqrt(1/8)
test(three_values_by_hand) :-           % mean 5/12
    dispersion(1, [4, 6, 12], Sigma),
    close_to(Sigma, 0.4249182927).      % sqrt(13/72)
test(equation_6_6) :-
    stimulated(positive, 100, 0.5, 0, Psi1),
    close_to(Psi1, 60.65306597),        % 100 exp(-1/2)
    stimulated(negative, 100, 0.5, 0, Psi2),
    close_to(Psi2, 139.34693403).       % 100 (2 - exp(-1/2))
test(no_dispersion_no_change, Psi1-Psi2 =:= 80-80) :-
    stimulated(positive, 80, 0, 0.01, Psi1),
    stimulated(negative, 80, 0, 0.01, Psi2).
test(stimulation_below_the_threshold_is_zero, Psi == 0) :-
    stimulated(positive, 0.012, 0.5, 0.01, Psi).
test(stimulation_at_the_threshold_is_kept) :-
    stimulated(positive, 0.01, 0, 0.01, Psi),
    Psi =:= 0.01.
test(never_zero_without_threshold) :-
    numlist(1, 500, Steps),
    foldl([_, P0, P]>>stimulated(positive, P0, 0.5, 0, P), Steps, 100, Psi),
    Psi > 0.
test(steps_to_the_threshold, N == 27) :-
    steps(100, 0, N).

%   With a dispersion of sqrt(1/8): ln(100/0.01) / 0.35355 = 26.05.

steps(0, N, N) :-
    !.
steps(Psi0, N0, N) :-
    stimulated(positive, Psi0, 0.3535533906, 0.01, Psi),
    N1 is N0 + 1,
    steps(Psi, N1, N).

test(dispersion_is_within_bounds, [ forall(between(1, 50, Seed)) ]) :-
    set_random(seed(Seed)),
    length(Steps, 5),
    maplist([S]>>( S is 0.01 + random_float ), Steps),
    foldl([S, T0-[T|H], T-H]>>( T is T0 + S ), Steps, 0-History, _-[]),
    dispersion(1, History, Sigma),
    Sigma > 0.316,                      % three in the middle
    Sigma < 0.49.                       % all at one end

:- end_tests(stimulation).

                /*******************************
                *           DECISIONS          *
                *******************************/

%   The second of the tasks of a house: floor, walls, ceiling.

second(Facts, Tuples) :-
    fake_agent('agents/sync/specialist.pl',
               [ sequence(house), task(walls, build), previous(floor)
               | Facts
               ],
               Tuples).

dormant(Tuples) :-
    second([mood(dormant), psi(100), history([]), arrival(0)], Tuples).

excited(History, Tuples) :-
    second([mood(excited), psi(100), history(History), arrival(20)],
           Tuples).

active(Tuples) :-
    second([mood(active), psi(0), history([1, 2]), arrival(20)], Tuples).

done(Task, Time, task(house, Task, completed, Time)).

mind(Mood, Psi, History) :-
    fake_agent:mood(Mood),
    fake_agent:psi(Psi),
    fake_agent:history(History).

:- begin_tests(statements).

test(dormant_specialist_passes, Acts-Mood-Reward == []-dormant-0) :-        % S1
    dormant([worker(house, w)]),
    fake_agent:visit(Reward),
    did(Acts),
    mind(Mood, 100, []).
test(first_stimulus_excites) :-                                     % S2
    done(floor, 0, Floor),
    dormant([worker(house, w), Floor]),
    retract(fake_agent:arrival(0)),
    assertz(fake_agent:arrival(8)),
    fake_agent:visit(Reward),
    Reward == 0,
    mind(Mood, Psi, History),
    Mood-History == excited-[8],
    Psi =:= 100,                        % one value: no dispersion yet
    did_just([log(state(excited)), log(psi(Psi))]).
test(positive) :-                                                   % S2
    done(floor, 8, Floor),
    excited([3], [worker(house, w), Floor]),
    fake_agent:visit(0),
    mind(excited, Psi, History),
    History == [3, 12],
    close_to(Psi, 60.65306597).
test(negative) :-                                                   % S3
    excited([3, 12], [worker(house, w)]),
    fake_agent:visit(0),
    mind(excited, Psi, History),
    History == [3, 12],
    close_to(Psi, 139.34693403).
test(previous_task_executing_is_not_done) :-
    excited([3, 12], [task(house, floor, executing, 2)]),
    fake_agent:visit(0),
    mind(excited, Psi, _),
    Psi > 100.
test(two_completed_tasks_are_no_stimulus, Psi-Acts == 100-[]) :-
    done(floor, 1, Floor),
    done(walls, 2, Walls),
    excited([3, 12], [worker(house, w), Floor, Walls]),
    fake_agent:visit(0),
    mind(excited, Psi, [3, 12]),
    did(Acts).
test(becomes_active_at_the_threshold) :-
    done(floor, 8, Floor),
    excited([3], [worker(house, w), Floor]),
    retract(fake_agent:psi(100)),
    assertz(fake_agent:psi(0.016)),
    fake_agent:visit(Reward),
    Reward == 0,
    mind(active, 0, _).
test(threshold_is_configurable, Mood == excited) :-
    done(floor, 8, Floor),
    excited([3], [worker(house, w), Floor]),
    assertz(fake_agent:setting(threshold, 0.001)),
    retract(fake_agent:psi(100)),
    assertz(fake_agent:psi(0.016)),
    fake_agent:visit(0),
    mind(Mood, _, _).
test(active_specialist_executes) :-                                         % S4
    done(floor, 1, Floor),
    active([worker(house, w), Floor]),
    fake_at(9),
    fake_agent:visit(Reward),
    Reward == 1,
    just_tuples([Floor, task(house, walls, executing, 9)]),
    did_just([send(w, execute(walls, build))]).
test(failed_task_is_executed_again) :-
    done(floor, 1, Floor),
    active([worker(house, w), Floor, task(house, walls, failed(atomic), 3)]),
    fake_agent:visit(1),
    just_tuples([Floor, task(house, walls, executing, 0)]).
test(waits_for_the_previous_task, Reward-Tuples == 0-[worker(house, w)]) :-
    active([worker(house, w)]),
    fake_agent:visit(Reward),
    tuples(Tuples).
test(skips_hosts_where_the_task_is_done, Reward == 0) :-
    done(floor, 1, Floor),
    done(walls, 2, Walls),
    active([worker(house, w), Floor, Walls]),
    fake_agent:visit(Reward).
test(busy_worker_gets_no_task, Reward == 0) :-
    done(floor, 1, Floor),
    active([Floor, task(house, walls, executing, 3)]),
    fake_agent:visit(Reward).
test(later_tasks_do_not_matter, Reward == 1) :-
    done(floor, 1, Floor),
    done(ceiling, 2, Ceiling),
    active([worker(house, w), Floor, Ceiling]),
    fake_agent:visit(Reward).
test(host_without_part, Reward-Mood-Psi == 0-excited-100) :-
    excited([3, 12], [worker(boat, w), task(boat, floor, completed, 1)]),
    fake_agent:visit(Reward),
    mind(Mood, Psi, _).
test(first_task_is_stimulated_everywhere) :-
    fake_agent('agents/sync/specialist.pl',
               [ sequence(house), task(floor, build), previous(none),
                 mood(dormant), psi(100), history([]), start(3), arrival(4)
               ], [worker(house, w)]),
    fake_agent:visit(0),
    mind(excited, 100.0, [1]).
test(first_task_is_executed, Reward == 1) :-
    fake_agent('agents/sync/specialist.pl',
               [ sequence(house), task(floor, build), previous(none),
                 mood(active), psi(0), history([1, 2]), start(3), arrival(4)
               ], [worker(house, w)]),
    fake_agent:visit(Reward).
test(only_active_specialists_clone, Moods == [active]) :-
    findall(Mood,
            ( member(Mood, [dormant, excited, active]),
              second([mood(Mood)], []),
              fake_agent:fertile
            ),
            Moods).

:- end_tests(statements).

                /*******************************
                *            NETWORK           *
                *******************************/

state(Log, State) :-
    exists_file(Log),
    log_events(Log, Events),
    track_start([1, 2, 3], State0),
    foldl(track, Events, State0, State).

settled(Log, Hosts) :-
    state(Log, State),
    track_settled(State, Hosts).

in_progress(Log, Task) :-
    state(Log, State),
    track_done(State, Task, Count),
    Count > 0.

%   Three hosts in this process.

furnished(Hosts, Goal) :-
    with_network(ring(3), [clock(20), log('/dev/null')], _, Hosts, Goal).

loads(Hosts, Loads) :-
    findall(Load, ( member(Host, Hosts), remote(Host, host_load(Load)) ),
            Loads).

born(Agent, Hosts, Name, Place) :-
    agent_property(Agent, home(Home)),
    nth1(Place, Hosts, Home),
    sub_atom(Agent, Dot, _, _, '.'),
    !,
    sub_atom(Agent, 0, Dot, _, Name).

:- begin_tests(population).

%   A queue for all, a worker for each sequence.

test(one_queue_and_one_worker_per_host, Loads == [3, 2, 2]) :-
    furnished(Hosts,
        ( Hosts = [Host|_],
          population_start(house, Hosts, [], [], []),
          population_start(boat, [Host], [], [], []),
          population_start(house, Hosts, [], [], []),
          loads(Hosts, Loads) )).
test(start_on_given_hosts, Places == [agent1-3, agent2-1, agent3-3]) :-
    furnished(Hosts,
        ( Hosts = [A, _, C],
          population_start(house, Hosts, [floor-true, walls-true, roof-true],
                           [starts([C, A])], Agents),
          findall(Name-Place, ( member(Agent, Agents),
                                born(Agent, Hosts, Name, Place) ),
                  Places),
          maplist(agent_dispose, Agents) )).
test(no_tasks, error(type_error(pair, floor))) :-
    population_start(house, [], [floor], [], _).
test(nowhere_to_start, error(domain_error(hosts, []))) :-
    population_start(house, [], [floor-true], [], _).

%   Ten hosts in two processes, three tasks. Two hosts lose their first task
%   when the others have the third. The log is checked.

test(specialists_live_and_heal) :-
    findall(I-J, ( between(1, 10, I), member(D, [1, 3]),
                   J is (I + D - 1) mod 10 + 1 ), Edges),
    with_logged_network(
        edges(Edges),
        [ processes(2), seed(3), clock(15), hosts([capacity(6)]),
          hop_time(uniform(0.1, 0.3)) ],
        Hosts, Log, two_lose_their_first(Hosts, Log), Events),
    executions(Events, All),
    again(All, First, Again),
    length(First, 30),
    out_of_order(First, []),
    maplist([execution(1, _, _, _)]>>true, Again),
    length(Again, 2),
    clones_live_and_die(Events).

two_lose_their_first(Hosts, Log) :-
    population_start(main, Hosts, [1-sleep(1), 2-sleep(1), 3-sleep(1)],
                     [ seed(3),
                       settings([threshold-5, rounding-floor, tick-0.5]) ],
                     Agents),
    length(Agents, 3),
    wait_until(in_progress(Log, 3), 30),
    Hosts = [A,B|_],
    task_fail(main, 1, [A, B], Failed),
    Failed == [A, B],
    wait_until(settled(Log, 10), 30).

clones_live_and_die(Events) :-
    populations(Events, [1, 2, 3], Steps),
    peak(total, Steps, _-Most),
    Most > 3,                           % there were clones
    Most =< 40,                         % of four in each of ten queues
    aggregate_all(count, member(event(_, _, _, state(death)), Events), Dead),
    aggregate_all(count, member(event(_, _, _, cloned), Events), Dead).

:- end_tests(population).
