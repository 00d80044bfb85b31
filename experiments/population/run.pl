:- module(population_run,
          [ population_run/3            % +Options, +Directory, -Result
          ]).
:- use_module('../../agents/population/operator', [population_start/5]).
:- use_module('../../agents/sync/operator', [task_fail/4]).
:- use_module('../../prolog/typhon',
              [ agent_dispose/1, log_events/2, network_property/2,
                network_start/3, network_stop/1
              ]).
:- use_module('../../prolog/typhon/base/chance', [chance_sample/5, chance_seed/2]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module('../sync/metrics',
              [executions/2, from_start/2, task_rows/2]).
:- use_module(mesh, [mesh/5]).
:- use_module(metrics, [again/3, populations/3, until_settled/4]).
:- use_module(track,
              [ track/3, track_alive/2, track_done/2, track_done/3,
                track_settled/2, track_start/2
              ]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [last/2, member/2, numlist/3]).
:- use_module(library(option), [option/2]).

/** <module> One run of a population of specialists

Starts a mesh network, lets one kind of agent for each task execute the
sequence on all hosts (thesis chapter 6), and stops it when everything is
completed and only the first agents of each kind are left, or at a limit.

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

%!  population_run(+Options, +Directory, -Result) is det.
%
%   Options are nodes(N), mesh(Kind), degree(D), processes(P), tasks(M),
%   task_time(S), hop_time(Min-Max), clock(Rate), seed(S),
%   limit(HostSeconds), settings(List), q_th(N) and crash(Count): so many
%   hosts lose task 2 while task 4 is executed, none if 0.  All are required.  The event log
%   is Directory/events.pl.  Result is a list:
%
%     - nodes(N), seed(S), tasks(List), crash(Count)
%     - executions(List): of every task at every host the first one, rows
%       of the tasks being rows(List), see sync_metrics
%     - again(List): all other executions
%     - failures(List): pairs Time-Host, of the crash
%     - steps(List): of the populations, see population_metrics
%     - end(Time): when the run had come to its end
%     - settled(Bool): whether it came there before the limit
%     - wall(Seconds): real time from start to stop of the network

population_run(Options, Directory, Result) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    fresh(Log),
    option(nodes(Nodes), Options),
    option(degree(Degree), Options),
    option(seed(Seed), Options),
    option(mesh(Kind), Options),
    mesh(Kind, Nodes, Degree, Seed, Topology),
    network_options(Options, Log, NetworkOptions),
    get_time(T0),
    setup_call_cleanup(
        network_start(Topology, Network, NetworkOptions),
        perform(Network, Log, Options, Settled),
        network_stop(Network)),
    get_time(T1),
    Wall is T1 - T0,
    log_events(Log, Events),
    evaluate(Options, Events, Result0),
    Result = [settled(Settled), wall(Wall)|Result0].

fresh(File) :-
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

%   Beside the agents of the queue a host has the queue and a worker.

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate),
                  hosts([capacity(Capacity)]), hop_time(uniform(Min, Max))
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    option(q_th(Slots), Options),
    Capacity is Slots + 2.

perform(Network, Log, Options, Settled) :-
    network_property(Network, hosts(Hosts)),
    option(tasks(Count), Options),
    option(task_time(Seconds), Options),
    option(seed(Seed), Options),
    option(settings(Settings), Options),
    option(q_th(Slots), Options),
    findall(Task-sleep(Seconds), between(1, Count, Task), Tasks),
    population_start(main, Hosts, Tasks,
                     [seed(Seed), settings([q_th-Slots|Settings])], Agents),
    look_on(Log, Hosts, Options, Settled),
    maplist(agent_dispose, Agents).

                /*******************************
                *           WAITING            *
                *******************************/

%   Follows the log.  What was seen of it is seen(Position, State, Crash),
%   Crash being `due` as long as the failures are still to come.

look_on(Log, Hosts, Options, Settled) :-
    option(tasks(Count), Options),
    option(limit(Limit), Options),
    option(clock(Rate), Options),
    option(crash(Crash), Options),
    numlist(1, Count, Tasks),
    track_start(Tasks, State),
    get_time(Now),
    Deadline is Now + Limit/Rate,
    (   Crash > 0
    ->  Due = due
    ;   Due = done
    ),
    call_cleanup(
        follow(Log, Hosts, Options, Deadline, seen(0, State, Due), Settled),
        progress_done(user_error)).

follow(Log, Hosts, Options, Deadline, Seen0, Settled) :-
    look(Log, Seen0, seen(Position, State, Due0)),
    length(Hosts, Count),
    show(State, Count, Options),
    crash(Due0, State, Hosts, Options, Due),
    get_time(Now),
    (   track_settled(State, Count)
    ->  Settled = true
    ;   Now > Deadline
    ->  Settled = false
    ;   sleep(0.1),
        follow(Log, Hosts, Options, Deadline, seen(Position, State, Due),
               Settled)
    ).

look(Log, seen(Position0, State0, Due), seen(Position, State, Due)) :-
    new_lines(Log, Position0, Position, Lines),
    foldl(look_at, Lines, State0, State).

look_at(Line, State0, State) :-
    term_string(Event, Line),
    track(Event, State0, State).

show(State, Count, Options) :-
    option(tasks(Tasks), Options),
    track_done(State, Done),
    track_alive(State, Alive),
    Total is Count * Tasks,
    format(atom(Note), 'executions, ~d agents', [Alive]),
    progress(user_error, Done, Total, Note).

%   Task 4 is in progress when a fifth of the hosts have it.

crash(due, State, Hosts, Options, done) :-
    track_done(State, 4, Done),
    length(Hosts, Count),
    5*Done >= Count,
    !,
    option(crash(Size), Options),
    option(seed(Seed), Options),
    chance_seed(Seed, Chance),
    chance_sample(Size, Hosts, Victims, Chance, _),
    task_fail(main, 2, Victims, _).
crash(Due, _, _, _, Due).

                /*******************************
                *          EVALUATION          *
                *******************************/

evaluate(Options, Events0, Result) :-
    option(nodes(Nodes), Options),
    option(seed(Seed), Options),
    option(tasks(Count), Options),
    option(crash(Crash), Options),
    numlist(1, Count, Tasks),
    from_start(Events0, Events1),
    until_settled(Events1, Tasks, Nodes, Events),
    executions(Events, All),
    again(All, Executions, Again),
    task_rows(Executions, Rows),
    findall(Time-Host, member(event(Time, Host, _, failed(_, 2)), Events),
            Failures),
    populations(Events, Tasks, Steps),
    last(Events, event(End, _, _, _)),
    Result = [ nodes(Nodes), seed(Seed), tasks(Tasks), crash(Crash),
               executions(Executions), rows(Rows), again(Again),
               failures(Failures), steps(Steps), end(End)
             ].
