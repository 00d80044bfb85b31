:- module(test_hierarchy, []).
:- use_module('../../lib/algorithms_bench').
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module('../../../agents/hierarchy/operator').
:- use_module('../../../agents/learning/operator').
:- use_module('../../../agents/sync/operator').

/** <module> Hierarchies of agents: decisions, leaders, observers
*/

                /*******************************
                *           DECISIONS          *
                *******************************/

%   report(+Delta, +Times, -Report): Times are those at which hosts completed
%   the tasks, one after the other.

report(Delta, Times, report([workers-1, delta-Delta], [], Facts)) :-
    findall(done(Task, Time), ( nth1(Task, Times, Some), member(Time, Some) ),
            Facts).

delta(Reports, Delta) :-
    steps:decided(Reports, none, _, Orders),
    findall(D, member(_-[delta-D], Orders), Ds),
    sort(Ds, [Delta]).

%   decision(Name, Times, Delta): Delta is decided if leaders with 0.5 report
%   Times, one list for each leader; the next task is due a spread later.

decision(fitting_step_is_kept, [[[0, 10], [20, 30]]], 0.5).
decision(halved_when_the_next_task_arrives_with_the_last_host,
         [[[0, 10], [10, 20]]], 0.25).
decision(rises_by_a_fifth_at_most, [[[0, 10], [900, 910]]], 0.6).
decision(falls_to_a_fifth_at_most, [[[0, 900], [1, 901]]], 0.1).
decision(observer_sees_a_spread_hidden_from_leaders,
         [[[0, 1], [10, 11]], [[9, 10], [19, 20]]], 0.25).
decision(one_task_changes_nothing, [[[0, 10]]], 0.5).
decision(one_host_with_one_task_at_a_time, [[[0], [10]]], 0.6).

:- begin_tests(steps, [setup(algorithm(steps, payloads(hierarchy/steps), []))]).

test(step_follows_the_spread, [ forall(decision(_, TimesOfLeaders, Expected)),
                                true(abs(Delta - Expected) < 1.0e-9) ]) :-
    findall(N-Report, ( nth1(N, TimesOfLeaders, Times),
                        report(0.5, Times, Report) ), Reports),
    delta(Reports, Delta).
test(tasks_are_in_order_of_time, true(abs(Delta - 0.5) < 1.0e-9)) :-
    Facts = [done(sow, 0), done(sow, 10), done(reap, 20), done(reap, 30)],
    delta([a-report([delta-0.5], [], Facts)], Delta).

:- end_tests(steps).

%   workers(+Parts, -Counts): of parts Count-Seconds.

workers(Parts, Counts) :-
    findall(N-report([workers-Count], [ended(1, done), ended(Seconds, done)], []),
            nth1(N, Parts, Count-Seconds), Reports),
    crews:decided(Reports, none, _, Orders),
    findall(Count, member(_-[workers-Count], Orders), Counts).

:- begin_tests(crews, [setup(algorithm(crews, payloads(hierarchy/crews), []))]).

test(shares_follow_the_work,
     [ forall(member(Parts-Shares,
                     [ [4-200, 4-100, 4-100]-[6, 3, 3],
                       [6-100, 2-100]-[6, 2],   % the work is that of all
                       [4-900, 4-10, 4-10]-[8, 2, 2], % half of an equal share
                       [4-10, 4-10, 4-900]-[2, 2, 8], [4-200]-[4] ])),
       Counts == Shares ]) :-
    workers(Parts, Counts).
test(number_of_workers_is_constant, true(Odd == [])) :-
    findall(Parts,
            ( between(1, 100, _), length(Parts, 5), maplist(any_part, Parts),
              workers(Parts, Counts),
              findall(Count, member(Count-_, Parts), Before),
              sum_list(Before, Sum),
              \+ sum_list(Counts, Sum) ),
            Odd).

any_part(Count-Seconds) :-
    random_between(1, 9, Count),
    random_between(0, 500, Seconds).

:- end_tests(crews).

                /*******************************
                *            NETWORK           *
                *******************************/

:- meta_predicate in_network(+, 1, -).

%   in_network(+Topology, :Goal, -Events): of the hosts, in virtual time.

in_network(Topology, Goal, Events) :-
    with_logged_network(Topology,
                        [clock(virtual), seed(1), hop_time(uniform(0.2, 0.4))],
                        Hosts, _, call(Goal, Hosts), Events).

%   sequences(+Level, +Limit, +Hosts): two rounds of two tasks, in two parts.

sequences(Level, Limit, Hosts) :-
    Hosts = [A, B, C, D, E, F],
    Parts = [[A, B, C], [D, E, F]],
    hierarchy_start([A, D], payloads(hierarchy/steps),
                    [ decides(Level), limit(Limit),
                      settings([workers-1, pool-robots, delta-0.5]) ],
                    Leaders),
    forall(member(Round, [one, two]),
           ( sequence_start(Round, Hosts, [1-sleep(1), 2-sleep(1)],
                            [agents(0), pool(robots)], _),
             hierarchy_serve(Leaders, Round, Parts, 1000) )).

deltas(Round, Events, Deltas) :-
    findall(Delta, ( member(event(_, _, _, leads(Round, Settings)), Events),
                     memberchk(delta-Delta, Settings) ), Deltas0),
    sort(Deltas0, Deltas).

:- begin_tests(hierarchy).

test(observer_decides_for_all_leaders, Count-First == 24-[0.5]) :-
    in_network(ring(6), sequences(observer, 500), Events),
    findall(Host-Round-Task,
            member(event(_, Host, _, completed(Round, Task)), Events), All0),
    sort(All0, All),
    length(All, Count),
    deltas(one, Events, First),
    deltas(two, Events, [Second]),
    assertion(Second =\= 0.5),
    assertion(( member(event(_, _, Agent, decided(one, _)), Events),
                sub_atom(Agent, 0, _, _, observer) )).
test(leaders_decide_for_themselves, Rounds == []) :-
    in_network(ring(6), sequences(leaders, 500), Events),
    findall(Round, member(event(_, _, _, decided(Round, _)), Events), Rounds),
    deltas(two, Events, Deltas),
    assertion(\+ memberchk(0.5, Deltas)).
test(without_a_level_nothing_is_changed, Deltas == [0.5]) :-
    in_network(ring(6), sequences(none, 500), Events),
    deltas(two, Events, Deltas).
test(late_workers_are_disposed_of, Rounds == [one, two]) :-
    in_network(ring(6), sequences(observer, 3), Events),
    findall(Round, member(event(_, _, _, served(Round)), Events), Rounds).
test(learners_are_divided, Sum == 8) :-
    in_network(edges([a-b, c-d]), learners, Events),
    findall(Count, ( member(event(_, _, _, leads(two, Settings)), Events),
                     memberchk(workers-Count, Settings) ), Counts),
    sum_list(Counts, Sum),
    max_list(Counts, Most),
    assertion(Most > 4).
test(unknown_level, throws(error(_, _))) :-
    hierarchy_start([], payloads(hierarchy/steps), [decides(king)], _).
test(unknown_option,
     throws(error(domain_error(hierarchy_option, crown(1)), _))) :-
    hierarchy_start([], payloads(hierarchy/steps), [crown(1)], _).

%   The maze of one part is larger.

learners(Hosts) :-
    Hosts = [A, B, C, D],
    learning_start([A, B], payloads(learning/maze), [],
                   [agents(0), seed(1), settings([size-2])], _),
    learning_start([C, D], payloads(learning/maze), [],
                   [agents(0), seed(1), settings([size-20])], _),
    hierarchy_start([A, C], payloads(hierarchy/crews),
                    [settings([workers-4, algorithm-greedy, seed-1])], Leaders),
    forall(member(Round, [one, two]),
           hierarchy_serve(Leaders, Round, [[A, B], [C, D]], 5000)).

:- end_tests(hierarchy).
