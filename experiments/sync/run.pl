:- module(sync_run,
          [ sync_run/3                  % +Options, +Directory, -Result
          ]).
:- use_module('../../prolog/typhon',
              [ agent_join/3, log_events/2, network_property/2,
                network_start/3, network_stop/1
              ]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module(metrics,
              [ executions/2, from_start/2, required/5, task_rows/2, tau/2 ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, foldl/6]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [last/2, member/2, numlist/3]).
:- use_module(library(option), [option/2]).

/** <module> One run of synchronised execution of tasks

Starts a network with a worker on every host, lets travellers execute the
sequence of tasks (thesis chapter 5, Algorithm 2), waits until all their
potentials are zero, stops the network, and reads what the log server
wrote.

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

%!  sync_run(+Options, +Directory, -Result) is det.
%
%   Options are topology(T), processes(P), agents(N), tasks(M), delta(D),
%   hop_time(Min-Max), task_time(S), clock(Rate), seed(S) and limit(Real),
%   the real seconds after which the agents are no longer waited for.  All
%   are required.  The event log is Directory/events.pl.  Result is a list:
%
%     - events(List), hosts(List), tasks(List)
%     - executions(List), rows(List), segments(List), steps(List): see
%       sync_metrics
%     - end(Time): of the last execution
%     - outcomes(List): of agent_join/3, for each agent
%     - wall(Seconds): real time from start to stop of the network

sync_run(Options, Directory, Result) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    fresh(Log),
    option(topology(Topology), Options),
    network_options(Options, Log, NetworkOptions),
    get_time(T0),
    setup_call_cleanup(
        network_start(Topology, Network, NetworkOptions),
        perform(Network, Log, Options, Hosts, Outcomes),
        network_stop(Network)),
    get_time(T1),
    Wall is T1 - T0,
    log_events(Log, Events),
    evaluate(Options, Events, Hosts, Result0),
    Result = [outcomes(Outcomes), wall(Wall)|Result0].

fresh(File) :-
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate)
                | Hop
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    (   Max > 0
    ->  Hop = [hop_time(uniform(Min, Max))]
    ;   Hop = []
    ).

perform(Network, Log, Options, Hosts, Outcomes) :-
    network_property(Network, hosts(Hosts)),
    option(agents(Count), Options),
    option(seed(Seed), Options),
    option(delta(Delta), Options),
    tasks(Options, Tasks),
    sequence_start(main, Hosts, Tasks,
                   [ agents(Count), seed(Seed), settings([delta-Delta]) ],
                   Travellers),
    await_all(Travellers, Log, Hosts, Options, Outcomes).

tasks(Options, Tasks) :-
    option(tasks(Count), Options),
    option(task_time(Seconds), Options),
    findall(I-sleep(Seconds), between(1, Count, I), Tasks).

                /*******************************
                *            WAITING           *
                *******************************/

%   Waits for the end of all agents, showing how many executions have been
%   completed.  What was seen of the log is seen(Position, Done, Task).

await_all(Agents, Log, Hosts, Options, Outcomes) :-
    option(tasks(Tasks), Options),
    option(limit(Limit), Options),
    length(Hosts, HostCount),
    Total is HostCount * Tasks,
    get_time(Now),
    Deadline is Now + Limit,
    call_cleanup(
        foldl(await(Log, Total, Deadline), Agents, Outcomes,
              seen(0, 0, 1), _),
        progress_done(user_error)).

await(Log, Total, Deadline, Agent, Outcome, Seen0, Seen) :-
    get_time(Now),
    Left is max(0, min(0.2, Deadline - Now)),
    agent_join(Agent, Outcome0, Left),
    look(Log, Total, Seen0, Seen1),
    (   Outcome0 == timeout,
        Now < Deadline
    ->  await(Log, Total, Deadline, Agent, Outcome, Seen1, Seen)
    ;   Outcome = Outcome0,
        Seen = Seen1
    ).

look(Log, Total, seen(Position0, Done0, Task0), seen(Position, Done, Task)) :-
    new_lines(Log, Position0, Position, Lines),
    foldl(look_at, Lines, Done0-Task0, Done-Task),
    format(atom(Note), 'executions, T~w', [Task]),
    progress(user_error, Done, Total, Note).

look_at(Line, Done0-Task0, Done-Task) :-
    (   sub_string(Line, Before, _, _, "completed(")
    ->  Done is Done0 + 1,
        Start is Before + 10,
        sub_string(Line, Start, _, 0, Rest),
        split_string(Rest, ",)", "", [_, Number|_]),
        number_string(Task1, Number),
        Task is max(Task0, Task1)
    ;   Done = Done0,
        Task = Task0
    ).

                /*******************************
                *          EVALUATION          *
                *******************************/

evaluate(Options, Events0, Hosts, Result) :-
    option(tasks(Count), Options),
    numlist(1, Count, Tasks),
    from_start(Events0, Events),
    executions(Events, Executions),
    task_rows(Executions, Rows),
    end(Executions, Events, End),
    required(Hosts, Tasks, Executions, End, Segments),
    tau(Segments, Steps),
    Result = [ events(Events), hosts(Hosts), tasks(Tasks),
               executions(Executions), rows(Rows), segments(Segments),
               steps(Steps), end(End)
             ].

%   Where nothing was executed the run ends with its last event.

end(Executions, _, End) :-
    aggregate_all(max(E), member(execution(_, _, _, E), Executions), End),
    !.
end(_, Events, End) :-
    last([event(0, _, _, _)|Events], event(End, _, _, _)).
