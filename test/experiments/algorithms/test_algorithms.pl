:- module(test_algorithms, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/algorithms_bench').
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/project_studies', [project_study/2]).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module('../../../agents/learning/operator').
:- use_module('../../../experiments/algorithms/metrics').
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/algorithms/printers').

/** <module> Two algorithms in one population, exchange, cloning, measures
*/

                /*******************************
                *             SCOUT            *
                *******************************/

%   Two branches from the start: a, b, c and d.

branches([ unit(sv(1,0,up,1), [a], sv(2,0,up,2))-1,
           unit(sv(1,0,up,1), [d], sv(3,0,up,5))-2,
           unit(sv(2,0,up,2), [b], sv(3,0,up,3))-1,
           unit(sv(3,0,up,3), [c], sv(4,0,up,4))-1 ]).

:- begin_tests(scout, [setup(algorithm(scout, payloads(learning/scout),
                                       []))]).

test(scout_takes_any_branch, Plans == [[a,b,c], [d]]) :-
    branches(Units),
    findall(Plan, ( between(1, 30, _), scout:plan(sv(1,0,up,1), Units, Plan) ),
            All),
    sort(All, Plans).
test(greedy_takes_the_longest_branch,
     [setup(algorithm(greedy, payloads(learning/greedy), [])),
      Plan == [a,b,c]]) :-
    branches(Units),
    greedy:plan(sv(1,0,up,1), Units, Plan).
test(unknown_start_begins_at_the_least_light) :-
    branches(Units),
    scout:plan(sv(0,0,up,9), Units, Plan),
    memberchk(Plan, [[a,b,c], [d]]).
test(path_with_most_links, Plans == [[a,b,c]]) :-
    findall(Plan,
            ( between(1, 10, _),
              scout:plan(sv(1,0,up,1),
                         [ unit(sv(1,0,up,1), [a], sv(2,0,up,2))-1,
                           unit(sv(1,0,up,1), [x], sv(4,0,up,4))-3,
                           unit(sv(2,0,up,2), [b], sv(3,0,up,3))-1,
                           unit(sv(3,0,up,3), [c], sv(4,0,up,4))-1 ], Plan) ),
            All),
    sort(All, Plans).

:- end_tests(scout).

                /*******************************
                *           THE TRAP           *
                *******************************/

%   The corner of the figures. The seeds make the result repeatable.

trap(size-16).
trap(obstacles-[(6,6)-(6,11),(6,11)-(12,11)]).

trap :-
    findall(setting(Name, Value), trap(Name-Value), Settings),
    problem(payloads(learning/maze), Settings).

robots(Kinds, Modules) :-
    findall(Name,
            ( nth1(I, Kinds, Kind),
              atom_concat(robot, I, Name),
              algorithm(Name, payloads(learning/Kind), []) ),
            Modules).

runs_at_the_light(Kinds, Most, Count) :-
    robots(Kinds, Modules),
    aggregate_all(count,
                  ( between(1, 4, Seed),
                    group(Seed, Modules, [here], Most, Reached),
                    Reached = [_,_,_,_] ),
                  Count).

:- begin_tests(trap, [setup(trap)]).

test(scout_leads_out_of_the_trap_of_greedy) :-
    runs_at_the_light([greedy,greedy,greedy,greedy], 250, Greedy),
    runs_at_the_light([greedy,greedy,greedy,scout], 250, Both),
    Greedy < 4,
    Both > Greedy.
test(studies_have_this_trap, [ forall(member(Study, [mixed, exchange])),
                               true(Settings == Trap) ]) :-
    atom_concat('algorithms/beyond_', Study, Name),
    project_study(Name, Module),
    study_cases(Module, [], [Case|_]),
    Settings = Case.settings,
    findall(Setting, trap(Setting), Trap).

:- end_tests(trap).

                /*******************************
                *            CLONING           *
                *******************************/

learner(Facts) :-
    append([resource(10), lifetime(inf)], Facts, All0),
    append([count(7)], All0, All),
    fake_agent('agents/learning/learner.pl', All, []).

:- begin_tests(breeding).

test(no_cloning_unless_configured, Acts-Tuples == []-[]) :-
    learner([]),
    fake_agent:bred(unreached, 5),
    did(Acts),
    tuples(Tuples).
test(progress_is_rewarded, Tuples == [progress(5)]) :-
    learner([setting(cloning, true)]),
    fake_agent:bred(unreached, 5),
    did(Acts),
    memberchk(log(state(replicate)), Acts),
    fake_agent:resource(Resource),
    Resource < 25,                      % a clone was paid for
    tuples(Tuples).
test(no_reward_without_progress, Acts-Tuples == []-[progress(5)]) :-
    learner([setting(cloning, true)]),
    leave_progress(5),
    fake_agent:bred(unreached, 5),
    did(Acts),
    tuples(Tuples).
test(clone_starts_new_counters, Count-Lifetime == 0-10) :-
    learner([setting(cloning, true)]),
    fake_clone(clone(me)),
    fake_agent:bred(unreached, 5),
    fake_agent:count(Count),
    fake_agent:lifetime(Lifetime).
test(execution_costs_a_step_of_life, Lifetime =:= 2) :-
    learner([]),
    leave_progress(9),
    grow_old(3),
    fake_agent:bred(unreached, 5),
    fake_agent:lifetime(Lifetime).
test(progress_prolongs_life, Lifetime =:= 9) :-
    learner([]),
    grow_old(3),
    fake_agent:progress(1, 1),
    fake_agent:older(1),
    fake_agent:gain(1, 1),
    fake_agent:lifetime(Lifetime).
test(agent_dies_when_its_life_is_used_up, Acts == [log(state(death))]) :-
    learner([]),
    leave_progress(9),
    grow_old(1),
    catch(fake_agent:bred(unreached, 5), disposed, true),
    did(Acts).
test(no_clones_after_the_goal, Acts == []) :-
    learner([setting(cloning, true)]),
    fake_agent:bred(reached([]), 5),
    did(Acts).

leave_progress(Length) :-
    fake_host:leave(progress(Length)).

grow_old(Lifetime) :-
    assertz(fake_agent:setting(cloning, true)),
    retractall(fake_agent:lifetime(_)),
    assertz(fake_agent:lifetime(Lifetime)).

:- end_tests(breeding).

                /*******************************
                *            NETWORK           *
                *******************************/

:- meta_predicate on_network(+, -, -, 0).

on_network(Options, Hosts, Log, Goal) :-
    with_logged_network(ring(3), [clock(20), seed(1)|Options],
                        Hosts, Log, Goal, _).

logged(Log, What, Count) :-
    exists_file(Log),
    log_events(Log, Events),
    aggregate_all(count, member(event(_, _, _, What), Events), Count).

at_least(Log, What, Least) :-
    logged(Log, What, Count),
    Count >= Least.

:- begin_tests(algorithms_network).

%   No printer can be good enough, so no agent ends.

test(algorithm_is_changed_at_run_time) :-
    on_network([], Hosts, Log,
        ( learning_start(Hosts, payloads(learning/settings),
                         [payloads(learning/lottery)],
                         [ agents(2), seed(1),
                           settings([good-2, rho_max-2]) ], Agents),
          wait_until(at_least(Log, executed(_, _, _, _), 4), 30),
          maplist([Agent]>>has(Agent, plans(_)), Agents),
          learning_exchange(Agents, lottery, payloads(learning/climb)),
          maplist([Agent]>>( \+ has(Agent, plans(_)) ), Agents),
          logged(Log, executed(_, _, _, _), Count),
          Wanted is Count + 6,
          wait_until(at_least(Log, executed(_, _, _, _), Wanted), 30),
          maplist([Agent]>>has(Agent, count(_)), Agents) )).

has(Agent, Fact) :-
    agent_property(Agent, facts(Facts)),
    memberchk(Fact, Facts).

test(printers_in_two_processes) :-
    on_network([processes(2)], Hosts, Log,
        ( learning_start(Hosts, payloads(learning/settings),
                         [payloads(learning/climb), payloads(learning/genetic)],
                         [ agents(4), seed(2),
                           settings([good-0.75, rho_max-2]) ], Agents),
          forall(member(Agent, Agents), agent_join(Agent, done, 60)),
          log_events(Log, Events),
          algorithms_result(Events, Agents, Result),
          result_number(reached, Result, 100),
          result_number(clones, Result, 0),
          result_number(pages, Result, Pages),
          Pages > 0 )).

%   Three hosts have capacity seven each, and agents live for two executions.

%   If all hosts are full no agent can move: with capacity three this happened
%   before the second death in three of a hundred runs.

test(clones_come_and_go) :-
    on_network([hosts([capacity(8)])], Hosts, Log, clones(Hosts, Log)).

clones(Hosts, Log) :-
    learning_start(Hosts, payloads(learning/maze),
                   [payloads(learning/greedy)],
                   [ agents(2), seed(3),
                     settings([ cloning-true, lifetime-2, c_l-1, rho_max-2,
                                size-40 ]) ], Agents),
    wait_until(( at_least(Log, cloned, 2),
                 at_least(Log, state(death), 2) ), 40),
    log_events(Log, Events),
    algorithms_result(Events, Agents, Result),
    result_number(most, Result, Most),
    Most > 2,
    Most =< 21.

:- end_tests(algorithms_network).

                /*******************************
                *            FIGURES           *
                *******************************/

events([ event(1, h, l1, executed(1, 0, 4, unreached)),
         event(2, h, l2, executed(1, 0, 3, unreached)),
         event(3, h, l1, cloned),
         event(4, h, c1, executed(1, 2, 6, unreached)),
         event(5, h, l1, shared(l2, 3)),
         event(6, k, l1, executed(2, 2, 9, reached)),
         event(7, k, l1, reached(2)),
         event(8, k, 'learner.c1', ended(disposed)),
         event(9, h, l2, executed(2, 2, 8, reached)),
         event(10, h, l2, executed(3, 2, 12, unreached)),
         event(11, h, l1, converged(2, 7, [a])) ]).

:- begin_tests(algorithms_figures).

test(result, Result == [ agents(2), reached([first(l1, 6, 2),
                                             first(l2, 9, 2)]),
                         executions(5), first(4), pages(23), shared(1),
                         time(9), clones(1), most(3), solutions([k-[a]]) ]) :-
    events(Events),
    algorithms_result(Events, [l1, l2], Result).
test(not_all_agents_have_reached_it, Time-Count-Mean == 11-6-2) :-
    events(Events),
    algorithms_result(Events, [l1, l2, l3], Result),
    result_number(time, Result, Time),
    result_number(executions, Result, Count),
    result_number(mean, Result, Mean0),
    Mean is truncate(Mean0).
test(no_agent_has_reached_it, [Reached, First] == [0, none]) :-
    algorithms_result([event(1, h, l1, executed(1, 0, 4, unreached))], [l1],
                      Result),
    result_number(reached, Result, Reached),
    \+ result_number(mean, Result, _),
    \+ result_number(first, Result, _),
    memberchk(first(First), Result).
test(shortfalls, [S1, S2] == [0, 1]) :-
    shortfalls(1, [ 'n1@x:1'-[use([3,photo,glossy,6,6,2]),again],
                    'n1@x:1'-[set(1,1)] ], [A, B]),
    S1 is ceiling(A),
    ( B > 0.2 -> S2 = 1 ; S2 = 0 ).

:- end_tests(algorithms_figures).
