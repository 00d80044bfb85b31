%   Four robots carry a pole: section 5.7, Figure 5.14.

:- include(ground).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_join/3, agent_send/2, network_property/2]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../../prolog/typhon/nxt/json', [json_read_dict/2]).
:- use_module('../../prolog/typhon/program/paths', []).
:- use_module('../sync/metrics',
              [ executions/2, from_start/2, idle_time/2, marks/3,
                out_of_order/2, overlaps/2, required/5, task_rows/2, tau/2,
                tau_max/2 ]).
:- use_module(crew, [crew_join/2, crew_task/3]).
:- use_module(pole_metrics).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [last/2, max_list/2, memberchk/2, min_list/2, nth1/3]).
:- use_module(library(pairs), [pairs_values/2]).

study(pole, "Four robots carry a pole").
text("In step, agents that travel have the robots drive up to the pole, lift \c
it, carry it, and put it down. Alone, each robot does so without waiting for \c
anybody.").

vary(way, [in_step, alone]).
fixed(processes, 4, printed("section 5.7: four separate computers")).
fixed(agents, 2, printed("section 5.7")).
fixed(delta, 0.5, assumed("the best for the grid of 60; none is printed")).
fixed(every, 0.1, assumed("often enough to see how the pole tilts")).

%   The sequence of the thesis.

pole_task(1, payloads(robots/approach)).
pole_task(2, payloads(robots/lift)).
pole_task(3, payloads(robots/carry)).
pole_task(4, payloads(robots/release)).

                /*******************************
                *              RUN             *
                *******************************/

network(Case, ring(4), Options) :-
    robot_options(Case, Options).

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    in_arena(Case, pole, carry(Case, Hosts)).

carry(Case, Hosts, Arena, Bricks) :-
    pairs_values(Bricks, Ports),
    crew_join(Hosts, Ports),
    findall(Task, ( pole_task(N, Spec), crew_task(N, Spec, Task) ), Tasks),
    begin(Case.way, Case, Hosts, Tasks, Agents),
    get_time(Now),
    Deadline is Now + Case.limit,
    Hosts = [Host|_],
    maplist(await(Deadline, note_clocks(Arena, Host)), Agents).

begin(in_step, Case, Hosts, Tasks, Agents) :-
    sequence_start(pole, Hosts, Tasks,
                   [ agents(Case.agents), seed(Case.seed),
                     settings([delta-(Case.delta)]) ],
                   Agents).
begin(alone, _, Hosts, Tasks, Agents) :-
    maplist(create_alone(Tasks), Hosts, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

create_alone(Tasks, Host, Agent) :-
    agent_create(agents(robots/alone), Agent,
                 [host(Host), facts([tasks(pole, Tasks)]), static(true)]).

await(Deadline, Note, Agent) :-
    call(Note),
    get_time(Now),
    Now < Deadline,
    agent_join(Agent, Outcome, 0.2),
    (   Outcome == timeout
    ->  await(Deadline, Note, Agent)
    ;   Outcome == done
    ).

                /*******************************
                *           MEASURES           *
                *******************************/

%   Time begins with the first agent.

view(Log, view{ hosts:(Log.hosts), executions:Executions, rows:Rows,
                segments:Segments, steps:Steps, states:States }) :-
    from_start(Log.events, Events),
    executions(Events, Executions),
    task_rows(Executions, Rows),
    marks(Executions, [], Marks),
    findall(End, member(execution(_, _, _, End), Executions), Ends),
    max_list([0|Ends], Last),
    required(Log.hosts, [1, 2, 3, 4], Marks, Last, Segments),
    tau(Segments, Steps),
    clocks(Events, Moments),
    arena_terms(Log, Terms),
    pole_states(Terms, Moments, States).

label(way, "robots").
label(second, "The first robot begins to lift (s)").
label(third, "to carry").
label(fourth, "to put down").
label(end, "The last one has ended (s)").
label(idle, "Idle time between the tasks, in all (s)").
label(early, "Executions before all had ended the task before").
label(overlaps, "Executions before all had begun the task before").
label(tau, "Distinct tasks required at a time, at most (τ)").
label(tilt, "The pole tilts by at most (degrees)").
label(over, "Time beyond the limit (s)").
label(carried, "The pole is carried (m)").

measure(Name, View, First) :-
    nth1(Task, [first, second, third, fourth], Name),
    memberchk(task(Task, First, _, _, _, _), View.rows).
measure(end, View, End) :-
    last(View.rows, task(_, _, _, End, _, _)).
measure(idle, View, Idle) :-
    idle_time(View.rows, Idle).
measure(early, View, Count) :-
    mingled(View.executions, Mingled),
    length(Mingled, Count).
measure(overlaps, View, Count) :-
    overlaps(View.executions, Overlaps),
    length(Overlaps, Count).
measure(tau, View, Tau) :-
    tau_max(View.steps, Tau).
measure(executions, View, Count) :-
    length(View.executions, Count).
measure(pairs, View, Count) :-
    findall(T-H, member(execution(T, H, _, _), View.executions), Pairs0),
    sort(Pairs0, Pairs),
    length(Pairs, Count).
measure(out_of_order, View, Count) :-
    out_of_order(View.executions, Wrong),
    length(Wrong, Count).
measure(started_within, View, Seconds) :-
    starts_apart(View.executions, 1, Seconds).
measure(apart, View, Seconds) :-
    findall(S, ( member(T, [1, 2, 3, 4]), starts_apart(View.executions, T, S) ),
            Apart),
    max_list(Apart, Seconds).
measure(quickest, View, Seconds) :-
    durations(View.executions, 1, Durations),
    min_list(Durations, Seconds).
measure(slowest, View, Seconds) :-
    durations(View.executions, 1, Durations),
    max_list(Durations, Seconds).
measure(tilt, View, Tilt) :-
    max_tilt(View.states, Tilt).
measure(tilt_limit, _, Limit) :-
    scene_file(pole, File),
    setup_call_cleanup(open(File, read, In, [encoding(utf8)]),
                       json_read_dict(In, Scene),
                       close(In)),
    Limit = Scene.pole.limit.
measure(over, View, Seconds) :-
    measure(tilt_limit, View, Limit),
    over_limit(View.states, Limit, Seconds).
measure(carried, View, Metres) :-
    carried(View.states, Metres).
measure(lying, View, Lying) :-
    last(View.states, state(_, Pole)),
    ( arg(9, Pole, lying) -> Lying = 1 ; Lying = 0 ).

%   Rows for the pictures: robot, task, from, to, executed (1) or required (0);
%   second, task, robots that began it there before; time, degrees or τ; task,
%   first start, last end, idle time after it.

measure(bars, View, Rows) :-
    bar_rows(View.hosts, View.segments, View.executions, Rows).
measure(starts, View, Rows) :-
    start_rows(View.executions, Rows).
measure(tilts, View, Rows) :-
    findall([Time, Tilt], ( member(state(Time, Pole), View.states),
                            arg(6, Pole, Tilt) ), Rows).
measure(taus, View, Rows) :-
    findall([Time, Tau], member(Time-Tau, View.steps), Rows).
measure(tasks, View, Rows) :-
    findall([Task, First, End, Idle],
            member(task(Task, First, _, End, _, Idle), View.rows), Rows).

printed(second, [way=in_step], 27).
printed(third, [way=in_step], 54).

                /*******************************
                *            CLAIMS            *
                *******************************/

claim("every robot executes the four tasks once, in order", [line(3695)],
      at([way=in_step],
         ( executions =:= 16, pairs =:= 16, out_of_order =:= 0 ))).
claim("all robots begin the first task at the same time (within 3 s)",
      [line(3705)],
      at([way=in_step], started_within =< 3)).
claim("the robots take different times to reach the pole", [line(3707)],
      at([way=in_step], slowest > 1.5*quickest)).
claim("they begin to lift at the 27th second (within 5 s)", [line(3709)],
      at([way=in_step], near(second, 27, 5))).
claim("they begin to carry around the 54th second (within 5 s)",
      [line(3709), why("how long lifting took is not printed; here it is 6 s")],
      at([way=in_step], near(third, 54, 5))).
claim("no robot begins a task before all have ended the previous one",
      [line(3700)],
      at([way=in_step], ( early =:= 0, overlaps =:= 0 ))).
claim("never more than two distinct tasks are required (τ)", [line(3211)],
      at([way=in_step], tau =< 2)).
claim("the pole is carried 1.2 m (within 5 cm), and put down", [line(3697)],
      at([way=in_step], ( near(carried, 1.2, 0.05), lying =:= 1 ))).
claim("the pole never tilts beyond the limit", [ours],
      at([way=in_step], tilt =< tilt_limit)).
claim("in step the robots begin each task closer together than alone", [ours],
      least(apart, way=in_step)).
claim("alone, robots begin tasks before others are ready", [ours],
      at([way=alone], early > 0)).
claim("alone, the pole tilts beyond the limit", [ours],
      at([way=alone], tilt > tilt_limit)).

                /*******************************
                *           PICTURES           *
                *******************************/

plot('5.14', "Tasks executed by four robots that carry a pole",
     script('pole_tasks.gp',
            [ hosts-blocks(bars), starts-blocks(starts), tau-blocks(taus),
              tasks-blocks(tasks) ],
            [seed(first), size(1200, 1000), variables(variables)])).
plot(pole, "Four robots carry a pole",
     script('pole.gp',
            [hosts-blocks(bars), tilt-blocks(tilts), tasks-blocks(tasks)],
            [seed(first), size(1200, 900), variables(variables)])).
plot(in_step, "The run in step", file('arena.svg', [way=in_step])).
plot(alone, "Each by itself", file('arena.svg', [way=alone])).

%   Files have a block for each way, with two empty lines after it.

blocks(Measure, Runs, Rows) :-
    findall([Block, [gap, gap]],
            ( member(run(_, _, Measures), Runs),
              get_dict(Measure, Measures, Block) ),
            Blocks),
    append(Blocks, Parts),
    append(Parts, Rows).

variables([Run|Runs], ['SUBTITLE'-Text, 'END'-End, 'LIMIT'-Limit]) :-
    Run = run(Case, Seed, Measures),
    about(Case, Seed, About),
    format(atom(Text), '~d agents, δ = ~w, ~w', [Case.agents, Case.delta, About]),
    findall(E, ( member(run(_, _, Ms), [Run|Runs]), E = Ms.end ), Ends),
    max_list(Ends, End),
    Limit = Measures.tilt_limit.
