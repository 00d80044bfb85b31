:- module(learning_run,
          [ learning_run/3              % +Options, +Directory, -Result
          ]).
:- use_module('../../agents/learning/operator', [learning_start/5]).
:- use_module('../../prolog/typhon',
              [ log_events/2, network_property/2, network_start/3,
                network_stop/1, remote/2
              ]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module(links, [degrees/5]).
:- use_module(metrics, [learning_result/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/2]).

/** <module> One run of agents that learn the way through the maze

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

%!  learning_run(+Options, +Directory, -Result) is det.
%
%   All of these Options are required:
%
%     - nodes(N), agents(K)
%       A mesh of N hosts, where K agents start at hosts drawn by the seed.
%     - queue(Length)
%       Agents that a host admits beside its trainer.
%     - processes(P), hop_time(Min-Max), clock(Rate), dynamic(Model), seed(S)
%       Of network_start/3; hop_time and dynamic may be `none`.
%     - settings(Pairs)
%       Of the agents, see parameters.pl and the maze.
%     - limit(HostSeconds)
%       After which agents that have not converged are waited for no longer.
%
%   The event log is Directory/events.pl.  Result is that of
%   learning_result/2 and, before it,
%
%     - nodes(N), agents(K), clock(Rate), settings(Pairs), seed(S)
%     - degrees(Least-Most): of hosts; `none` where links do not change
%     - real_time(Seconds): from start to stop of the network

learning_run(Options, Directory, Result) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    option(nodes(Nodes), Options),
    network_options(Options, Log, NetworkOptions),
    get_time(T0),
    setup_call_cleanup(
        network_start(mesh(Nodes), Network, NetworkOptions),
        perform(Network, Log, Options, End),
        network_stop(Network)),
    get_time(T1),
    RealTime is T1 - T0,
    log_events(Log, Events),
    learning_result(Events, Result0),
    option(dynamic(Model), Options),
    option(seed(Seed), Options),
    degrees(Model, Nodes, Seed, End, Degrees),
    findall(Option, told_option(Options, Option), Told),
    append(Told, [degrees(Degrees), real_time(RealTime)|Result0], Result).

told_option(Options, Option) :-
    member(Name, [nodes, agents, clock, settings, seed]),
    functor(Option, Name, 1),
    option(Option, Options).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate),
                  hosts([capacity(Capacity)])
                | More
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(queue(Length), Options),
    Capacity is Length + 1,
    findall(Option, more_option(Options, Option), More).

more_option(Options, hop_time(uniform(Min, Max))) :-
    option(hop_time(Min-Max), Options).
more_option(Options, dynamic(Model)) :-
    option(dynamic(Model), Options),
    Model \== none.

%   End is the time of the hosts when it was over.

perform(Network, Log, Options, End) :-
    network_property(Network, hosts(Hosts)),
    option(agents(Count), Options),
    option(seed(Seed), Options),
    option(settings(Settings), Options),
    learning_start(Hosts, payloads(learning/maze),
                   [payloads(learning/greedy)],
                   [agents(Count), seed(Seed), settings(Settings)], Agents),
    look_on(Log, Agents, Options),
    Hosts = [First|_],
    remote(First, now(End)).

                /*******************************
                *           WAITING            *
                *******************************/

%   An agent that has ended will not converge any more.

look_on(Log, Agents, Options) :-
    option(limit(Limit), Options),
    option(clock(Rate), Options),
    get_time(Now),
    Deadline is Now + Limit/Rate,
    length(Agents, Total),
    call_cleanup(follow(Log, Agents, Deadline, 0, 0-Total),
                 progress_done(user_error)).

follow(Log, Agents, Deadline, Position0, Done0-Total) :-
    new_lines(Log, Position0, Position, Lines),
    aggregate_all(count, ( member(Line, Lines), ends(Line, Agents) ), Count),
    Done is Done0 + Count,
    progress(user_error, Done, Total, 'agents have converged'),
    get_time(Now),
    (   ( Done >= Total ; Now > Deadline )
    ->  true
    ;   sleep(0.2),
        follow(Log, Agents, Deadline, Position, Done-Total)
    ).

ends(Line, Agents) :-
    sub_string(Line, _, _, _, "ended("),
    term_string(event(_, _, Agent, ended(_)), Line),
    memberchk(Agent, Agents).
