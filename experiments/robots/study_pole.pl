%   Four robots carry a pole: section 5.7, Figure 5.14.

:- include(ground).
:- use_module('../../prolog/typhon',
              [ agent_create/3, agent_join/3, agent_send/2,
                network_property/2 ]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../../prolog/typhon/bridges/json', [json_dict/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../sync/metrics',
              [ executions/2, from_start/2, idle_time/2, marks/3,
                out_of_order/2, overlaps/2, premature/2, required/5,
                task_rows/2, tau/2, tau_max/2 ]).
:- use_module(crew, [crew_join/2, crew_task/3]).
:- use_module(pole_metrics).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists),
              [append/2, last/2, member/2, memberchk/2, nth1/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(solution_sequences), [distinct/2]).

study(pole, "Four robots carry a pole").
text("In step, agents that travel have the robots drive up to the pole, lift \c
it, carry it, and put it down. Alone, each robot does so without waiting for \c
others.").

vary(way, [in_step, alone]).
fixed(agents, 2, printed("section 5.7")).
fixed(delta, 0.5, assumed("the best for 60 hosts in a grid; none \c
is printed")).
fixed(every, 0.1, assumed("often enough to see how the pole tilts")).

%   The sequence of the thesis.

pole_tasks([approach, lift, carry, release]).

                /*******************************
                *              RUN             *
                *******************************/

network(Case, ring(4), Options) :-
    robot_options(Case, Options).

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    in_arena(Case, Network, pole, carry(Case, Hosts)).

%   Section 5.7: four separate computers.

real([way=in_step], [clock=5, processes=4]).

carry(Case, Hosts, Arena, Bricks) :-
    pairs_values(Bricks, Ports),
    crew_join(Hosts, Ports),
    pole_tasks(Payloads),
    findall(Task, ( nth1(N, Payloads, Payload),
                    crew_task(N, payloads(robots/Payload), Task) ), Tasks),
    begin(Case.way, Case, Hosts, Tasks, Agents),
    Hosts = [Host|_],
    host_rate(Case, Rate),
    foldl(await(Rate, note_clocks(Arena, Host)), Agents, Case.limit, _).

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

%   Logs both clocks every host second.

await(Rate, Note, Agent, Left0, Left) :-
    call(Note),
    Left0 > 0,
    Second is 1/Rate,
    agent_join(Agent, Outcome, Second),
    Left1 is Left0 - 1,
    (   Outcome == timeout
    ->  await(Rate, Note, Agent, Left1, Left)
    ;   Outcome == done,
        Left = Left1
    ).

                /*******************************
                *           MEASURES           *
                *******************************/

%   Time begins with the first agent.

view(Log, view{ hosts:(Log.hosts), executions:Executions, rows:Rows,
                segments:Segments, steps:Steps, states:States, end:Last }) :-
    from_start(Log.events, Events),
    executions(Events, Executions),
    task_rows(Executions, Rows),
    marks(Executions, [], Marks),
    aggregate_all(max(End), member(execution(_, _, _, End), Executions), Last),
    required(Log.hosts, [1, 2, 3, 4], Marks, Last, Segments),
    tau(Segments, Steps),
    findall(ArenaTime-Time,
            member(event(Time, _, _, arena_time(ArenaTime)), Events), Moments),
    arena_terms(Log, Terms),
    pole_states(Terms, Moments, States).

label(way, "robots").
label(second, "The first robot begins to lift (s)").
label(third, "The first robot begins to carry (s)").
label(fourth, "The first robot begins to put down (s)").
label(end, "The last robot has ended (s)").
label(idle, "Idle time between the tasks, in all (s)").
label(overlaps, "Executions before the previous task had ended").
label(premature, "Executions before all had begun the previous task").
label(apart, "Greatest time between starts of a task (s)").
label(tau, "Distinct tasks required at a time, at most (τ)").
label(tilt, "Greatest tilt of the pole (degrees)").
label(over, "Time beyond the limit of tilt (s)").
label(carried, "Distance carried (m)").

measure(Name, View, First) :-
    nth1(Task, [first, second, third, fourth], Name),
    memberchk(task(Task, First, _, _, _, _), View.rows).
measure(end, View, View.end).
measure(idle, View, Idle) :-
    idle_time(View.rows, Idle).
measure(Name, View, Count) :-
    member(Name, [overlaps, premature]),
    call(Name, View.executions, Executions),
    length(Executions, Count).
measure(tau, View, Tau) :-
    tau_max(View.steps, Tau).
measure(executions, View, Count) :-
    length(View.executions, Count).
measure(pairs, View, Count) :-
    aggregate_all(count, distinct(T-H, member(execution(T, H, _, _),
                                              View.executions)), Count).
measure(out_of_order, View, Count) :-
    out_of_order(View.executions, Wrong),
    length(Wrong, Count).
measure(started_within, View, Seconds) :-
    starts_apart(View.executions, 1, Seconds).
measure(apart, View, Most) :-
    aggregate_all(max(S), starts_apart(View.executions, _, S), Most).
measure(quickest, View, Least) :-
    aggregate_all(min(S), approach_time(View, S), Least).
measure(slowest, View, Most) :-
    aggregate_all(max(S), approach_time(View, S), Most).
measure(tilt, View, Most) :-
    aggregate_all(max(T), tilt(View, _, T), Most).
measure(tilt_limit, _, Limit) :-
    scene_file(pole, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    json_dict(Text, Scene),
    Limit = Scene.pole.limit.
measure(over, View, Seconds) :-
    measure(tilt_limit, View, Limit),
    findall(Time-Tilt, tilt(View, Time, Tilt), Tilts),
    over_limit(Tilts, Limit, Seconds).
measure(carried, View, Metres) :-
    View.states = [state(_, pole(X0, Y0, _, _, _, _, _, _, _))|_],
    last(View.states, state(_, pole(X, Y, _, _, _, _, _, _, _))),
    Metres is sqrt((X - X0)**2 + (Y - Y0)**2).
measure(lying, View, Lying) :-
    last(View.states, state(_, pole(_, _, _, _, _, _, _, _, Phase))),
    ( Phase == lying -> Lying = 1 ; Lying = 0 ).

approach_time(View, Seconds) :-
    member(execution(1, _, Start, End), View.executions),
    Seconds is End - Start.

tilt(View, Time, Tilt) :-
    member(state(Time, pole(_, _, _, _, _, Tilt, _, _, _)), View.states).

%   Rows for the pictures.  bars: robot, task, from, to, executed (1) or
%   required (0); starts: second, task, number of earlier starts in that second;
%   tilts, taus: time, degrees or τ; tasks: task, first start, last end, idle
%   time after it.

measure(bars, View, Rows) :-
    findall(Row, bar(View, Row), Rows).
measure(starts, View, Rows) :-
    start_rows(View.executions, Rows).
measure(tilts, View, Rows) :-
    findall([Time, Tilt], tilt(View, Time, Tilt), Rows).
measure(taus, View, Rows) :-
    findall([Time, Tau], member(Time-Tau, View.steps), Rows0),
    (   Rows0 == []                     % no task is ever required
    ->  Rows = [[0, 0], [View.end, 0]]
    ;   Rows = Rows0
    ).
measure(tasks, View, Rows) :-
    findall([Task, First, End, Idle],
            member(task(Task, First, _, End, _, Idle), View.rows), Rows).

bar(View, [I, Task, From, To, 0]) :-
    member(segment(Host, Task, From, To), View.segments),
    nth1(I, View.hosts, Host).
bar(View, [I, Task, From, To, 1]) :-
    member(execution(Task, Host, From, To), View.executions),
    nth1(I, View.hosts, Host).

printed(second, [way=in_step], 27).
printed(third, [way=in_step], 54).

claim("every robot executes the four tasks once, in order", [line(3695)],
      at([way=in_step],
         ( executions =:= 16, pairs =:= 16, out_of_order =:= 0 ))).
claim("all robots begin the first task at the same time (within 3 s)",
      [line(3705)],
      at([way=in_step], started_within =< 3)).
claim("the robots take different times to reach the pole", [line(3707)],
      at([way=in_step], slowest > 1.5*quickest)).
claim("robots begin to lift at the 27th second (within 5 s)", [line(3709)],
      at([way=in_step], near(second, 27, 5))).
claim("robots begin to carry around the 54th second (within 5 s)",
      [line(3709), why("how long lifting took is not printed; with the 6 s here 46 s \c
follow")],
      at([way=in_step], near(third, 54, 5))).
claim("no robot begins a task before all have ended the previous one",
      [line(3700)],
      at([way=in_step], overlaps =:= 0)).
claim("never more than two distinct tasks are required (τ)", [line(3211)],
      at([way=in_step], tau =< 2)).
claim("the pole is carried 1.2 m (within 5 cm), and put down", [line(3697)],
      at([way=in_step], ( near(carried, 1.2, 0.05), lying =:= 1 ))).
claim("the pole never tilts beyond the limit", [ours],
      at([way=in_step], tilt =< tilt_limit)).
claim("in step the robots begin each task closer together than alone", [ours],
      least(apart, way=in_step)).
claim("alone, robots begin tasks before others are ready", [ours],
      at([way=alone], overlaps > 0)).
claim("alone, the pole tilts beyond the limit", [ours],
      at([way=alone], tilt > tilt_limit)).

plot('5.14', "Four robots carry a pole",
     script('pole.gp',
            [ starts-blocks(starts), hosts-blocks(bars), tasks-blocks(tasks),
              tilt-blocks(tilts), tau-blocks(taus) ],
            [seed(first), size(1200, 1300), variables(variables)])).
plot(in_step, "The run in step", file('arena.svg', [way=in_step])).
plot(alone, "Each robot alone", file('arena.svg', [way=alone])).

%   Files have a block for each value of `way`, and two empty lines after it.

blocks(Measure, Runs, Rows) :-
    findall([Block, [gap, gap]],
            ( member(run(_, _, Measures), Runs),
              get_dict(Measure, Measures, Block) ),
            Blocks),
    append(Blocks, Parts),
    append(Parts, Rows).

variables(Runs, ['SUBTITLE'-Text, 'END'-End, 'LIMIT'-Limit]) :-
    Runs = [run(Case, Seed, Measures)|_],
    Limit = Measures.tilt_limit,
    about(Case, Seed, About),
    format(atom(Text), '~d agents, δ = ~w, ~w',
           [Case.agents, Case.delta, About]),
    aggregate_all(max(E), ( member(run(_, _, Ms), Runs),
                            get_dict(end, Ms, E) ), End).
