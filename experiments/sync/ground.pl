%   Chapter 5: a sequence of tasks, executed in step on all hosts.
%
%   Expects of the study that includes this: the parameters `topology` and
%   `delta`, or best_delta/2 derived from the topology, and its other
%   definitions.  Gives: network/3, run/2, view/2 and the measures of one run.

:- use_module('../../prolog/typhon', [agent_join/3, network_property/2]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- include(failure).
:- use_module(healing).
:- use_module(metrics).
:- use_module(orderly, []).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(assoc)).
:- use_module(library(lists)).
:- use_module(library(pairs)).

fixed(agents, 10, printed("section 5.6.1")).
fixed(hosts, 60, printed("section 5.6.1")).
fixed(tasks, 6, printed("section 5.5")).
fixed(task_time, 3, assumed("read off: T1 is required up to 6 s and executed \c
up to 9 s (section 5.6.1)")).
fixed(hop_time, 0.27-0.53,
      assumed("fits three of four idle times of Table 5.1")).
fixed(starts, of_topology, tuned("drawn by the seed; on the ring at even \c
distances, as it is called symmetric")).
fixed(choices, of_topology, tuned("by chance among hosts never visited; on \c
the ring in order, as no decision is made by chance (section 5.4.1)")).
fixed(links, none, printed("static unless said otherwise")).
fixed(failure, none, printed("none unless said otherwise")).
fixed(limit, 2000, assumed("host seconds; runs end long before")).

label(idle, "Idle time between the tasks, in all (s)").
label(overlaps, "Overlapped executions").
label(premature, "Overlaps before all had begun the previous task").
label(tau, "Distinct tasks required at a time, at most (τ)").
label(total, "Time until all tasks are completed everywhere (s)").
label(topology, "topology").
label(star_bus, "Star-bus").
label(ring, "Ring").
label(tree, "Tree").
label(grid, "Grid").
label(delta, "penalty bias δ").

%   best_delta(?Topology, ?Delta): the best value of the thesis for each
%   (section 5.6.1).

best_delta(star_bus, 0.2).
best_delta(ring,     0.8).
best_delta(tree,     0.2).
best_delta(grid,     0.5).

                /*******************************
                *            NETWORK           *
                *******************************/

network(Case, Topology, Options) :-
    shape(Case.topology, Case.hosts, Topology),
    Min-Max = Case.hop_time,
    findall(dynamic(Model), model(Case, Model), More),
    Options = [hop_time(uniform(Min, Max))|More].

%   A study may define names of `links`.

:- discontiguous model/2.

model(Case, Case.links) :-
    Case.links \== none,
    \+ get_dict(interval, Case, _).

%   The networks of Figure 5.4.

shape(star_bus, N, star_bus(Arms, 10)) :- Arms is N // 10.
shape(ring, N, ring(N)).
shape(tree, N, tree(N)).
shape(grid, N, grid(Rows, 10)) :- Rows is N // 10.
shape(Topology, _, Topology) :- compound(Topology).

                /*******************************
                *              RUN             *
                *******************************/

%   All agents must end by themselves.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(Task-Goal, task(Case, Task, Goal), Tasks),
    placed(Case, Hosts, Placed),
    strategy(Case, Strategy),
    findall(Setting, potential(Case, Setting), Settings),
    sequence_start(main, Hosts, Tasks,
                   [ agents(Case.agents),
                     settings([strategy-Strategy|Settings])
                   | Placed ],
                   Agents),
    prepare_failure(Case, Network, Hosts),
    forall(member(Agent, Agents), agent_join(Agent, done, Case.limit)).

%   A study may define potentials, or leave them to the agents.

potential(Case, Name-Value) :-
    member(Name, [delta, theta, maximum, window]),
    get_dict(Name, Case, Value).

%   A time for all tasks, or a list with one for each; drawn at each host
%   where it is a range.

task(Case, Task, Goal) :-
    between(1, Case.tasks, Task),
    (   is_list(Case.task_time)
    ->  nth1(Task, Case.task_time, Time)
    ;   Time = Case.task_time
    ),
    task_goal(Time, Goal).

task_goal(Min-Max, Goal) :-
    !,
    Goal = ( random(X), Seconds is Min + (Max - Min)*X, sleep(Seconds) ).
task_goal(Seconds, sleep(Seconds)).

placed(Case, Hosts, [starts(Starts)]) :-
    ( Case.starts == even ; Case.starts == of_topology, Case.topology == ring ),
    !,
    length(Hosts, N),
    Step is max(1, N // Case.agents),
    findall(Host, ( nth0(I, Hosts, Host), I mod Step =:= 0 ), Starts).
placed(Case, _, [seed(Case.seed)]).

strategy(Case, orderly) :-
    ( Case.choices == in_order
    ; Case.choices == of_topology, Case.topology == ring ),
    !.
strategy(_, conscientious).

                /*******************************
                *           MEASURES           *
                *******************************/

view(Log, view{ hosts:(Log.hosts), tasks:Tasks, executions:Executions,
                rows:Rows, segments:Segments, steps:Steps, phases:Phases,
                failures:Failures, healing:Healing, kind:Kind }) :-
    functor(Log.case.failure, Kind, _),
    numlist(1, Log.case.tasks, Tasks),
    from_start(Log.events, Events),
    executions(Events, Executions),
    failures(Events, Failures),
    phases(Log.case.failure, Executions, Failures, Phases),
    maplist(task_rows, Phases, RowLists),
    append(RowLists, Rows),
    marks(Executions, Failures, Marks),
    aggregate_all(max(End), member(execution(_, _, _, End), Executions), Last),
    required(Log.hosts, Tasks, Marks, Last, Segments),
    tau(Segments, Steps),
    healing(Executions, Failures, Steps, Healing).

measure(idle, View, Idle) :-
    idle_time(View.rows, Idle).
measure(least_gap, View, Gap) :-
    aggregate_all(min(Idle), ( member(task(_, _, _, _, _, Idle), View.rows),
                               number(Idle) ), Gap).
measure(Name, View, Count) :-
    member(Name, [overlaps, premature]),
    maplist(Name, View.phases, Lists),
    append(Lists, Executions),
    length(Executions, Count).
measure(tau, View, Tau) :-
    tau_max(View.steps, Tau).
measure(total, View, Total) :-
    aggregate_all(max(End), member(execution(_, _, _, End), View.executions),
                  Total).
measure(healing_time, View, Time) :-
    memberchk(failed_at(From), View.healing),
    memberchk(healed_at(To), View.healing),
    Time is To - From.
measure(burst, View, Count) :-
    burst(1, 1, View.executions, Count).
measure(later_burst, View, Most) :-
    aggregate_all(max(Count),
                  ( member(T, View.tasks), T > 1,
                    burst(T, 1, View.executions, Count) ),
                  Most).
measure(executions, View, Count) :-
    length(View.executions, Count).
measure(missing, View, Missing) :-
    findall(H-T, member(execution(T, H, _, _), View.executions), Pairs0),
    sort(Pairs0, Pairs),
    maplist(length, [View.hosts, View.tasks, Pairs], [Hosts, Tasks, Found]),
    Missing is Hosts*Tasks - Found.
measure(out_of_order, View, Count) :-
    ordered_part(View, Executions),
    out_of_order(Executions, OutOfOrder),
    length(OutOfOrder, Count).
measure(Name, View, Value) :-
    member(Measure, View.healing),
    Measure =.. [Name, Value].

%   After a cascaded failure the tasks begin again.

ordered_part(View, After) :-
    View.kind == cascaded,
    View.phases = [_, After],
    !.
ordered_part(View, View.executions).
