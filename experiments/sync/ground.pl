%   Chapter 5: a sequence of tasks, executed in step on all hosts.
%
%   Expects of the study that includes this: the parameters `topology`,
%   `delta`, `agents`, and what it says of others.  Gives: network/3, run/2,
%   view/2 and the measures of one run.

:- use_module('../../prolog/typhon',
              [agent_join/3, network_property/2]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module(metrics).

fixed(hosts, 60, printed("section 5.6")).
fixed(tasks, 6, printed("section 5.6")).
fixed(task_time, 3, printed("lines 3361, 3381-3384: read off")).
fixed(hop_time, 0.27-0.53, assumed("fits three of four idle times of Table 5.1")).
fixed(dynamic, none, printed("static unless said otherwise")).
fixed(limit, 1000, assumed("host seconds; runs end long before")).

label(idle, "Idle time between the tasks, in all (s)").
label(overlaps, "Overlapped executions").
label(tau, "Distinct tasks required at a time, at most (τ)").
label(total, "Time until all tasks are completed everywhere (s)").

network(Case, Topology, Options) :-
    shape(Case.topology, Case.hosts, Topology),
    Min-Max = Case.hop_time,
    findall(dynamic(Model), ( get_dict(dynamic, Case, Model), Model \== none ), More),
    Options = [hop_time(uniform(Min, Max))|More].

shape(star_bus, N, star_bus(Arms, 10)) :- Arms is N // 10.
shape(ring, N, ring(N)).
shape(tree, N, tree(N)).
shape(grid, N, grid(Rows, 10)) :- Rows is N // 10.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(T-sleep(Case.task_time), between(1, Case.tasks, T), Tasks),
    sequence_start(main, Hosts, Tasks,
                   [ agents(Case.agents), seed(Case.seed),
                     settings([delta-(Case.delta)]) ],
                   Agents),
    forall(member(Agent, Agents), agent_join(Agent, _, Case.limit)).

view(Log, view{executions:Executions, rows:Rows, steps:Steps}) :-
    numlist(1, Log.case.tasks, Tasks),
    from_start(Log.events, Events),
    executions(Events, Executions),
    task_rows(Executions, Rows),
    marks(Executions, [], Marks),
    last(Executions, execution(_, _, _, End)),
    required(Log.hosts, Tasks, Marks, End, Segments),
    tau(Segments, Steps).

measure(idle, View, Idle) :-
    idle_time(View.rows, Idle).
measure(overlaps, View, Count) :-
    overlaps(View.executions, Overlapping),
    length(Overlapping, Count).
measure(tau, View, Tau) :-
    tau_max(View.steps, Tau).
measure(total, View, Total) :-
    aggregate_all(max(End), member(execution(_, _, _, End), View.executions),
                  Total).
