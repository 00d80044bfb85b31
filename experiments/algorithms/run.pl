:- module(algorithms_run,
          [ algorithms_run/3            % +Options, +Directory, -Result
          ]).
:- use_module('../../agents/learning/operator',
              [learning_exchange/3, learning_start/5]).
:- use_module('../../prolog/typhon',
              [ agent_join/3, log_events/2, network_property/2,
                network_start/3, network_stop/1
              ]).
:- use_module(metrics, [algorithms_result/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2]).

/** <module> One run of agents that learn

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

%!  algorithms_run(+Options, +Directory, -Result) is det.
%
%   Options are those of a case, see case_options/2, and
%
%     - seed(S), processes(P), clock(Rate)
%       Of network_start/3.
%     - queue(Length)
%       Agents that a host admits beside its trainer.
%     - rho_max(R)
%       The migration resource: how far agents go between executions.
%
%   All are required.  The event log is Directory/events.pl; Result is that
%   of algorithms_result/3 and real_time(Seconds).

algorithms_run(Options, Directory, Result) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    option(nodes(Nodes), Options),
    network_options(Options, Log, NetworkOptions),
    get_time(T0),
    setup_call_cleanup(
        network_start(mesh(Nodes), Network, NetworkOptions),
        perform(Network, Options, Agents),
        network_stop(Network)),
    get_time(T1),
    RealTime is T1 - T0,
    log_events(Log, Events),
    algorithms_result(Events, Agents, Result0),
    append(Result0, [real_time(RealTime)], Result).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate),
                  hosts([capacity(Capacity)])
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(queue(Length), Options),
    Capacity is Length + 1.

%   Nobody gets lost here, so nobody is given up where the machine is busy.

perform(Network, Options, Agents) :-
    network_property(Network, hosts(Hosts)),
    option(problem(Problem), Options),
    option(algorithms(Names), Options),
    option(agents(Count), Options),
    option(seed(Seed), Options),
    option(settings(Pairs), Options),
    option(rho_max(Rho), Options),
    maplist(algorithm, Names, Algorithms),
    learning_start(Hosts, payloads(learning/Problem), Algorithms,
                   [ agents(Count), seed(Seed),
                     settings([ rho_max-Rho, printers-Seed, execution-3000,
                                answer-300
                              | Pairs ])
                   ], Agents),
    get_time(Now),
    exchange(Options, Agents),
    all_end(Options, Agents, Now).

algorithm(Name, payloads(learning/Name)).

exchange(Options, [First|_]) :-
    option(exchange(at(Seconds, Old, New)), Options),
    !,
    option(clock(Rate), Options),
    Pause is Seconds/Rate,
    sleep(Pause),
    algorithm(New, Algorithm),
    catch(learning_exchange([First], Old, Algorithm),
          error(existence_error(agent, _), _),
          true).                        % it has converged
exchange(_, _).

all_end(Options, Agents, Begin) :-
    option(limit(Limit), Options),
    option(clock(Rate), Options),
    Deadline is Begin + Limit/Rate,
    forall(member(Agent, Agents), ended(Agent, Deadline)).

ended(Agent, Deadline) :-
    get_time(Now),
    Left is max(0.01, Deadline - Now),
    agent_join(Agent, _, Left).
