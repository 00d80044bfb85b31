:- module(typhon_networks,
          [ networks_start/3,           % +Topology, -Network, +Options
            networks_stop/1,            % +Network
            networks_property/2,        % ?Network, ?Property
            network_begin/4,            % ?Name, +Plan, :Build, -Network
            network_goes_on/2,          % +Network, +Clock
            network_state/2,            % +Network, -State
            network_change/2,           % +Network, +Change
            appointments_wait/2,        % +Network, +Seconds
            appointments_at/3,          % +Network, +Time, :Goal
            appointments/2,             % +Network, -Due
            appointments_again/2        % +Network, +Due
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/base/prolog_faults', [forget_erased/0]).
:- use_module('../kernel/base/options', [check_name/2]).
:- use_module('../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../kernel/host',
              [ alarm_set/3, runtime_release/1, scheduler_call/1, time_now/1,
                time_wait/3 ]).
:- use_module(building,
              [dynamics_end/1, log_end/1, network_build/5, part/2]).
:- use_module(lasting, [kept_plan/4, lasting_over/1, lasting_rests/1]).
:- use_module(nodes, [node/3]).
:- use_module(plan, [plan_change/3, plan_costs/2, plan_option/2]).
:- use_module(processes, [nodes_stop/1]).
:- use_module(restarts, [restarts_back/1]).
:- use_module(wiring,
              [ wire_change/2, wire_forget/1, wire_resting_own/2,
                wire_stop_own/1, wired_agents/2, wired_edges/2,
                wired_ended/3, wired_hosts/2 ]).

/** <module> Networks of hosts

A network is a set of hosts and the links between them, started and stopped by
one call. Its hosts run in this process, or in child processes on this machine
and others. They share a clock, which starts at 0 when the hosts start.

Starting is all or nothing: after an error the parts that were started are
stopped. Stopping works also if a child hangs or has died.

*Threading*: any thread may call. A network belongs to the process that started
it. It uses the threads of modules `children` and `log`, and has none of its
own.
*/

:- multifile
    prolog:message//1,
    typhon_questions:elsewhere/1,
    typhon_questions:ended_elsewhere/2,
    typhon_names:known/2,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- meta_predicate network_begin(?, +, 1, -).

:- dynamic
    network/2,                  % Network, Plan
    costs/2,                    % Network, Costs: of its links
    running/2.                  % Network, clock(Epoch, Rate)

%!  networks_start(+Topology, -Network, +Options) is det.
%
%   See network_start/3.

networks_start(Topology, Network, Options) :-
    must_be(var, Network),
    kept_plan(Topology, Options, Plan, Kept),
    network_begin(_, Plan, started(Plan, Kept), Network).

started(Plan, Kept, Network) :-
    network_build(Network, Plan, Kept, network_change(Network), Clock),
    network_goes_on(Network, Clock).

%!  network_begin(?Name, +Plan, :Build, -Network) is det.
%
%   Build a network by call(Build, Network); stop all its parts if that fails.
%   The network gets Name if that is bound and unused.

network_begin(Name, Plan, Build, Network) :-
    (   atom(Name),
        \+ network(Name, _)
    ->  Network = Name
    ;   new_name(Network)
    ),
    once(
        setup_call_catcher_cleanup(
            record_network(Network, Plan),
            call(Build, Network),
            Catcher,
            unless_built(Catcher, Network))),
    forget_erased.

record_network(Network, Plan) :-
    plan_costs(Plan, Costs),
    assertz(costs(Network, Costs)),
    assertz(network(Network, Plan)).

new_name(Network) :-
    repeat,
    flag(typhon_networks, Id, Id + 1),
    atom_concat(network, Id, Network),
    \+ network(Network, _),
    !.

unless_built(exit, _) :-
    !.
unless_built(_, Network) :-
    in_own_thread(end(Network)).

%!  network_goes_on(+Network, +Clock) is det.

network_goes_on(Network, Clock) :-
    assertz(running(Network, Clock)).

%!  network_change(+Network, +Change) is det.
%
%   Change a link of Network. Change is link(I, J) or unlink(I, J), where I and
%   J are numbers of hosts.

network_change(Network, Change0) :-
    costs(Network, Costs),
    plan_change(Costs, Change0, Change),
    wire_change(Network, Change).

%!  networks_stop(+Network) is det.
%
%   See network_stop/1.

networks_stop(Network) :-
    must_be(atom, Network),
    (   retract(running(Network, _))
    ->  in_own_thread(end(Network))
    ;   existence_error(network, Network)
    ).

end(Network) :-
    step(dynamics_end(Network)),
    step(wire_resting_own(Network, stop_own(Network))),
    step(nodes_stop(Network)),
    step(log_end(Network)),
    step(runtime_release(network(Network))),
    wire_forget(Network),
    debug(typhon(network), '~w has ended', [Network]),
    retractall(due(Network, _, _)),
    retractall(network(Network, _)),
    retractall(costs(Network, _)).

%   A journal keeps its contents, which the next start of the network restores.

stop_own(Network) :-
    network(Network, Plan),
    (   lasting_rests(Plan)
    ->  true
    ;   wire_stop_own(Network),
        lasting_over(Plan)
    ).

%   An error in one step must not prevent the others.

step(Goal) :-
    catch(Goal, error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    !.
step(Goal) :-
    print_message(warning, typhon(network_step(Goal))).

                /*******************************
                *          PROPERTIES          *
                *******************************/

%   network_clock(+Network, -Clock) is det.
%
%   Clock is clock(Epoch, Rate).
%
%   @error existence_error(network, Network)

network_clock(Network, Clock) :-
    must_be(atom, Network),
    (   running(Network, Clock0)
    ->  Clock = Clock0
    ;   existence_error(network, Network)
    ).

%!  network_state(+Network, -State) is det.
%
%   State is state(Plan, Clock, Log, Dynamics). Log is log(Address, File)
%   or `none`; Dynamics is the handle of the dynamics, or `none`.
%
%   @error existence_error(network, Network)

network_state(Network, state(Plan, Clock, Log, Dynamics)) :-
    network_clock(Network, Clock),
    network(Network, Plan),
    (   part(Network, log(Address, File))
    ->  Log = log(Address, File)
    ;   Log = none
    ),
    (   part(Network, dynamics(Dynamics0))
    ->  Dynamics = Dynamics0
    ;   Dynamics = none
    ).

%!  networks_property(?Network, ?Property) is nondet.
%
%   See network_property/2.

networks_property(Network, Property) :-
    check_name(network_property, Property),
    (   var(Network)
    ->  running(Network, _)
    ;   must_be(atom, Network),
        running(Network, _)
    ->  true
    ;   existence_error(network, Network)
    ),
    property(Property, Network).

typhon_names:known(network_property, Property) :-
    clause(property(Property, _), _).
typhon_names:known(network, Network) :-
    running(Network, _).

typhon_questions:elsewhere(Agent) :-
    running(Network, _),
    wired_agents(Network, Agents),
    member(Agent, Agents).

typhon_questions:ended_elsewhere(Name, Agent) :-
    running(Network, _),
    wired_ended(Network, Name, Agents),
    last(Agents, Agent).

:- '$clausable'(property/2).

property(hosts(Addresses), Network) :-
    wired_hosts(Network, Addresses).
property(edges(Edges), Network) :-
    wired_edges(Network, Edges).
property(agents(Agents), Network) :-
    wired_agents(Network, Agents).
property(processes(Pids), Network) :-
    restarts_back(Network),
    findall(P-Pid, node(Network, P, Pid), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Pids).
property(log(File), Network) :-
    part(Network, log(_, File)).
property(seed(Seed), Network) :-
    network(Network, Plan),
    plan_option(Plan, seed(Seed)).

prolog:message(typhon(network_step(Goal))) -->
    [ 'Ending the network: ~p failed'-[Goal] ].

                /*******************************
                *         APPOINTMENTS         *
                *******************************/

:- meta_predicate appointments_at(+, +, 0).

:- dynamic
    due/3.                      % Network, Number, Goal

%!  appointments_wait(+Network, +Seconds) is det.
%
%   See network_advance/2.

appointments_wait(Network, Seconds) :-
    must_be(number, Seconds),
    network_clock(Network, clock(_, Rate)),
    time_now(Now),
    Stamp is Now+Seconds/Rate,
    setup_call_cleanup(
        message_queue_create(Queue),
        \+ time_wait(Queue, _, Stamp),
        message_queue_destroy(Queue)).

%!  appointments_at(+Network, +Time, :Goal) is det.
%
%   See network_at/3.

appointments_at(Network, Time, Goal) :-
    must_be(number, Time),
    strip_module(Goal, _, Plain),
    must_be(callable, Plain),
    network_clock(Network, clock(Epoch, Rate)),
    flag(typhon_network_at, N, N+1),
    assertz(due(Network, N, Goal)),
    Stamp is Epoch+Time/Rate,
    alarm_set(Stamp, Network, at(N)).

%!  appointments(+Network, -Due:list) is det.
%
%   Due are the pending goals of network_at/3: pairs N-Goal.

appointments(Network, Due) :-
    findall(N-Goal, due(Network, N, Goal), Due).

%!  appointments_again(+Network, +Due:list) is det.
%
%   Restore Due, see appointments/2. The caller sets their alarms at(N).

appointments_again(Network, Due) :-
    forall(member(N-Goal, Due),
           ( assertz(due(Network, N, Goal)),
             flag(typhon_network_at, N0, max(N0, N+1)) )).

typhon_scheduler:fire(Network, at(N)) :-
    !,
    (   retract(due(Network, N, Goal))
    ->  scheduler_call(Goal)
    ;   true
    ).

typhon_scheduler:over(Network, at(N)) :-
    \+ due(Network, N, _).
