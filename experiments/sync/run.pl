:- module(sync_run,
          [ sync_run/3,                 % +Options, +Directory, -Result
            sync_result/4               % +Options, +Events, +Hosts, -Result
          ]).
:- use_module('../../prolog/typhon',
              [ agent_join/3, log_events/2, network_property/2,
                network_start/3, network_stop/1
              ]).
:- use_module('../../prolog/typhon/base/chance', [chance_sample/5, chance_seed/2]).
:- use_module('../../agents/sync/operator',
              [sequence_start/5, task_fail/4, tasks_fail/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module('../engine/follow', [new_lines/4]).
:- use_module(healing, [failures/2, healing/4, phases/4]).
:- use_module(metrics,
              [ executions/2, from_start/2, marks/3, required/5, task_rows/2,
                tau/2
              ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, foldl/6, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/2, last/2, member/2, numlist/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(thread), [concurrent_forall/3]).

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
%   All of these Options are required:
%
%     - topology(T), processes(P), hop_time(Min-Max), clock(Rate), seed(S)
%       Of network_start/3.
%     - dynamic(Model)
%       Of network_start/3, or `none`.
%     - agents(N), delta(D)
%       Travellers, and their penalty bias.
%     - tasks(M), task_time(Time)
%       The sequence is 1 .. M.  Time is a number of seconds, or Min-Max,
%       from which each host draws each time, or a list of these, one for
%       each task.
%     - failure(Failure)
%       atomic(Task, N, During): N hosts, drawn by the seed, lose Task as
%       soon as the log tells that task During has begun.
%       cascaded(Task, N, During): and with it all later ones.  Or `none`.
%     - limit(Real)
%       Real seconds after which the agents are no longer waited for.
%
%   The event log is Directory/events.pl.  Result is that of sync_result/4
%   and, before it,
%
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
    sync_result(Options, Events, Hosts, Result0),
    Result = [outcomes(Outcomes), wall(Wall)|Result0].

fresh(File) :-
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate)
                | More
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    findall(Option, more_option(Options, Option), More).

more_option(Options, hop_time(uniform(Min, Max))) :-
    option(hop_time(Min-Max), Options),
    Max > 0.
more_option(Options, dynamic(Model)) :-
    option(dynamic(Model), Options),
    Model \== none.

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
    option(task_time(Time), Options),
    numlist(1, Count, Names),
    length(Times, Count),
    (   is_list(Time)
    ->  append([Times, _], Time)
    ;   maplist(=(Time), Times)
    ),
    maplist(task, Names, Times, Tasks).

task(Name, Min-Max, Name-Goal) :-
    !,
    Goal = ( random(X), Seconds is Min + (Max - Min)*X, sleep(Seconds) ).
task(Name, Seconds, Name-sleep(Seconds)).

                /*******************************
                *            FAILURE           *
                *******************************/

%   inject(+Failure0, +Begun, +Hosts, +Options, -Failure): the failure that
%   is waited for, when task Begun has begun.

inject(none, _, _, _, none) :-
    !.
inject(Failure, Begun, Hosts, Options, none) :-
    arg(3, Failure, During),
    Begun >= During,
    !,
    Failure =.. [Kind, Task, Count, _],
    option(seed(Seed), Options),
    chance_seed(Seed, Chance),
    length(Hosts, All),
    Most is min(Count, All),
    chance_sample(Most, Hosts, Drawn, Chance, _),
    fail_at(Kind, Task, Drawn).
inject(Failure, _, _, _, Failure).

%   All at nearly the same time: while one host after the other fails, the
%   agents would already be healing.

fail_at(Kind, Task, Hosts) :-
    concurrent_forall(member(Host, Hosts), fail_host(Kind, Task, Host),
                      [threads(8)]).

fail_host(atomic, Task, Host) :-
    task_fail(main, Task, [Host], _).
fail_host(cascaded, Task, Host) :-
    tasks_fail(main, Task, [Host], _).

                /*******************************
                *            WAITING           *
                *******************************/

%   Waits for the end of all agents, showing how many executions have been
%   completed.  What was seen of the log is seen(Position, Done, Begun,
%   Failure): Begun is the last task that has begun, Failure what is still
%   to be injected.

await_all(Agents, Log, Hosts, Options, Outcomes) :-
    option(limit(Limit), Options),
    option(failure(Failure), Options),
    get_time(Now),
    Deadline is Now + Limit,
    call_cleanup(
        foldl(await(watch(Log, Hosts, Options), Deadline), Agents, Outcomes,
              seen(0, 0, 1, Failure), _),
        progress_done(user_error)).

await(Watch, Deadline, Agent, Outcome, Seen0, Seen) :-
    get_time(Now),
    Left is max(0, min(0.1, Deadline - Now)),
    agent_join(Agent, Outcome0, Left),
    look(Watch, Seen0, Seen1),
    (   Outcome0 == timeout,
        Now < Deadline
    ->  await(Watch, Deadline, Agent, Outcome, Seen1, Seen)
    ;   Outcome = Outcome0,
        Seen = Seen1
    ).

look(watch(Log, Hosts, Options), seen(Position0, Done0, Begun0, Failure0),
     seen(Position, Done, Begun, Failure)) :-
    new_lines(Log, Position0, Position, Lines),
    foldl(look_at, Lines, Done0-Begun0, Done-Begun),
    inject(Failure0, Begun, Hosts, Options, Failure),
    option(tasks(Tasks), Options),
    length(Hosts, HostCount),
    Total is HostCount * Tasks,
    Shown is min(Done, Total),
    format(atom(Note), 'executions, T~w', [Begun]),
    progress(user_error, Shown, Total, Note).

look_at(Line, Done0-Begun0, Done-Begun) :-
    (   sub_string(Line, _, _, _, "completed(main,")
    ->  Done is Done0 + 1,
        Begun = Begun0
    ;   sub_string(Line, Before, Length, _, "executing(main,")
    ->  Done = Done0,
        Start is Before + Length,
        sub_string(Line, Start, _, 0, Rest),
        split_string(Rest, ")", "", [Number|_]),
        number_string(Task, Number),
        Begun is max(Begun0, Task)
    ;   Done-Begun = Done0-Begun0
    ).

                /*******************************
                *          EVALUATION          *
                *******************************/

%!  sync_result(+Options, +Events, +Hosts, -Result) is det.
%
%   What the log of a run with Options on Hosts says, as a list:
%
%     - events(List), hosts(List), tasks(List)
%     - executions(List), rows(List), segments(List), steps(List): see
%       sync_metrics
%     - end(Time): of the last execution
%     - failure(Failure): as in Options
%     - phases(List), healing(List): see sync_healing

sync_result(Options, Events0, Hosts, Result) :-
    option(tasks(Count), Options),
    option(failure(Failure), Options),
    numlist(1, Count, Tasks),
    from_start(Events0, Events),
    executions(Events, Executions),
    failures(Events, Failures),
    phases(Failure, Executions, Failures, Phases),
    maplist(task_rows, Phases, RowLists),
    append(RowLists, Rows),
    end(Executions, Events, End),
    marks(Executions, Failures, Marks),
    required(Hosts, Tasks, Marks, End, Segments),
    tau(Segments, Steps),
    healing(Executions, Failures, Steps, Healing),
    Result = [ events(Events), hosts(Hosts), tasks(Tasks),
               executions(Executions), rows(Rows), segments(Segments),
               steps(Steps), end(End), failure(Failure), phases(Phases),
               healing(Healing)
             ].

%   Where nothing was executed the run ends with its last event.

end(Executions, _, End) :-
    aggregate_all(max(E), member(execution(_, _, _, E), Executions), End),
    !.
end(_, Events, End) :-
    last([event(0, _, _, _)|Events], event(End, _, _, _)).
