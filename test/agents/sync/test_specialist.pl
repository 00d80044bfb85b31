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
:- use_module('../../../experiments/sync/metrics',
              [executions/2, out_of_order/2]).
:- include('../../../agents/sync/stimulation').

/** <module> Specialists: equations, decisions, a small network
*/

                /*******************************
                *           EQUATIONS          *
                *******************************/

%   equation(Name, Goal, Value, Expected): Value is of Goal.

equation(equation_6_7, remembered(5, H0, D, H), H, Is) :-
    member(H0-D-Is, [[]-7-[7], [7]-8-[7, 8], [7, 8]-3-[7, 8], [7, 8]-8-[7, 8]]).
equation(window_slides, remembered(Window, H0, 4, H), H, Is) :-
    member(Window-H0-Is, [3-[1, 2, 3]-[2, 3, 4], 1-[1]-[4], 0-[]-[]]).
equation(equation_6_8, normalised([4, 6, 12], Values), Values, [0, 0.25, 1]).
equation(no_dispersion, dispersion(1, History, S), S, 0) :-
    member(History, [[], [3], [3, 5, 3]]). % equal ends
equation(two_values, dispersion(Kappa, [3, 9], S), S, Is) :-
    member(Kappa-Is, [1-0.5, 3-1.5]).
equation(equation_6_9_and_6_10, dispersion(1, [1, 2, 3, 4, 5], S), S, Is) :-
    Is is sqrt(1/8).                    % of 0, 1/4, 1/2, 3/4, 1
equation(three_values_by_hand, dispersion(1, [4, 6, 12], S), S, Is) :-
    Is is sqrt(13/72).                  % mean 5/12
equation(equation_6_6, stimulated(Sign, 100, 0.5, 0, Psi), Psi, Is) :-
    P is 100*exp(-0.5),
    N is 200 - P,
    member(Sign-Is, [positive-P, negative-N]).
equation(no_dispersion_no_change, stimulated(Sign, 80, 0, 0.01, P), P, 80) :-
    member(Sign, [positive, negative]).
equation(stimulation_below_the_threshold_is_zero,
         stimulated(positive, 0.012, 0.5, 0.01, Psi), Psi, 0).
equation(stimulation_at_the_threshold_is_kept,
         stimulated(positive, 0.01, 0, 0.01, Psi), Psi, 0.01).
equation(steps_to_the_threshold, steps(100, 0, N), N, 27).

%   With a dispersion of sqrt(1/8): ln(100/0.01) / 0.35355 = 26.05.

steps(0, N, N) :-
    !.
steps(Psi0, N0, N) :-
    stimulated(positive, Psi0, 0.3535533906, 0.01, Psi),
    N1 is N0 + 1,
    steps(Psi, N1, N).

:- begin_tests(stimulation).

test(equation, [ forall(equation(_, Goal, Value, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal).
test(never_zero_without_threshold) :-
    numlist(1, 500, Steps),
    foldl([_, P0, P]>>stimulated(positive, P0, 0.5, 0, P), Steps, 100, Psi),
    Psi > 0.
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

%   visits(Name, Mood, Facts, Tuples, Reward, Checks): the specialist of the
%   second of the tasks of a house, floor, walls and ceiling, in a Mood (see
%   mood/2), visits a host with Tuples; see fake_run/4. S1 to S4 are statements
%   of the thesis.

mood(dormant, [mood(dormant), psi(100), history([]), arrival(0)]).
mood(excited(History), [ mood(excited), psi(100), history(History),
                         arrival(20) ]).
mood(active, [mood(active), psi(0), history([1, 2]), arrival(20)]).

done(Task, Time, task(house, Task, completed, Time)).

visits(dormant_specialist_passes, dormant, [], [worker(house, w)], 0, % S1
       [did=[], mood=dormant, psi=100, history=[]]).
visits(first_stimulus_excites, dormant, [arrival(8)], % S2
       [worker(house, w), Floor], 0,
       [ mood=excited, history=[8], psi=100, % one value: no dispersion yet
         did=[log(state(excited)), log(psi(100))] ]) :-
    done(floor, 0, Floor).
visits(positive, excited([3]), [], [worker(house, w), Floor], 0, % S2
       [mood=excited, history=[3, 12], psi=Psi]) :-
    done(floor, 8, Floor),
    Psi is 100*exp(-0.5).
visits(negative, excited([3, 12]), [], [worker(house, w)], 0, % S3
       [mood=excited, history=[3, 12], psi=Psi]) :-
    Psi is 200 - 100*exp(-0.5).
visits(previous_task_executing_is_not_done, excited([3, 12]), [],
       [task(house, floor, executing, 2)], 0,
       [mood=excited, ( psi(Psi), Psi > 100 )]).
visits(two_completed_tasks_are_no_stimulus, excited([3, 12]), [],
       [worker(house, w), Floor, Walls], 0,
       [mood=excited, psi=100, history=[3, 12], did=[]]) :-
    done(floor, 1, Floor),
    done(walls, 2, Walls).
visits(becomes_active_at_the_threshold, excited([3]), [psi(0.016)],
       [worker(house, w), Floor], 0, [mood=active, psi=0]) :-
    done(floor, 8, Floor).
visits(threshold_is_configurable, excited([3]),
       [psi(0.016), setting(threshold, 0.001)], [worker(house, w), Floor], 0,
       [mood=excited]) :-
    done(floor, 8, Floor).
visits(active_specialist_executes, active, [], % S4
       [worker(house, w), Floor], 1,
       [ tuples=[Floor, task(house, walls, executing, 9)],
         did=[send(w, execute(walls, build))] ]) :-
    done(floor, 1, Floor).
visits(failed_task_is_executed_again, active, [],
       [worker(house, w), Floor, task(house, walls, failed(atomic), 3)], 1,
       [tuples=[Floor, task(house, walls, executing, 9)]]) :-
    done(floor, 1, Floor).
visits(nothing_to_execute, active, [], Tuples, 0, [did=[], tuples=Tuples]) :-
    done(floor, 1, Floor),
    done(walls, 2, Walls),
    member(Tuples, [ [worker(house, w)], % waits for the previous task
                     [Floor, Walls, worker(house, w)],
                     [Floor, task(house, walls, executing, 3)] ]).
visits(later_tasks_do_not_matter, active, [],
       [worker(house, w), Floor, Ceiling], 1, []) :-
    done(floor, 1, Floor),
    done(ceiling, 2, Ceiling).
visits(host_without_part, excited([3, 12]), [],
       [worker(boat, w), task(boat, floor, completed, 1)], 0,
       [mood=excited, psi=100]).
visits(first_task_is_stimulated_everywhere, dormant,
       [task(floor, build), previous(none), start(3), arrival(4)],
       [worker(house, w)], 0, [mood=excited, psi=100, history=[1]]).
visits(first_task_is_executed, active,
       [task(floor, build), previous(none), start(3), arrival(4)],
       [worker(house, w)], 1, []).

:- begin_tests(statements).

test(specialist_visits_a_host,
     [ forall(visits(_, Mood, Facts, Tuples, Reward, Checks)),
       Wrong-Rewarded == []-Reward ]) :-
    mood(Mood, Own),
    fake_agent('agents/sync/specialist.pl',
               [sequence(house), task(walls, build), previous(floor)|Own],
               Tuples),
    maplist(fake_fact, Facts),
    fake_run([fake_at(9)], visit(Rewarded), Checks, Wrong).
test(only_active_specialists_clone, Moods == [active]) :-
    findall(Mood,
            ( member(Mood, [dormant, excited, active]),
              fake_agent('agents/sync/specialist.pl', [mood(Mood)], []),
              fake_agent:fertile ),
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
