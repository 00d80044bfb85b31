:- module(typhon_networks,
          [ network_start/3,            % +Topology, -Network, +Options
            network_stop/1,             % +Network
            network_property/2,         % ?Network, ?Property
            network_clock/2,            % +Network, -Clock
            network_begin/4,            % ?Name, +Plan, :Build, -Network
            network_goes_on/2,          % +Network, +Clock
            network_standing/2,         % +Network, -Standing
            network_change/2            % +Network, +Change
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/base/erased', [forget_erased/0]).
:- use_module('../kernel/base/options', [check_name/2]).
:- use_module('../kernel/base/own_thread', [in_own_thread/1]).
:- use_module(building,
              [ dynamics_end/1, endpoint_end/1, equipment_forget/1,
                log_end/1, network_build/5, part/2 ]).
:- use_module(carriers, [carrier/3]).
:- use_module(lasting, [kept_plan/4, lasting_over/1, lasting_rests/1]).
:- use_module(plan, [plan_change/3, plan_option/2]).
:- use_module(processes, [carriers_stop/1]).
:- use_module(restarts, [restarts_back/1]).
:- use_module(wiring,
              [ wire_change/2, wire_forget/1, wire_resting_own/2,
                wire_stop_own/1,
                wired_agents/2, wired_edges/2, wired_ended/3,
                wired_hosts/2 ]).

/** <module> Networks of hosts

A network is a number of hosts and the links between them, started and
stopped by one call. Its hosts live in this process, or in child processes
on this machine and others. They share a clock, which shows 0 when the
hosts are about to start.

Starting is all or nothing: what was started is stopped again when
something fails. Stopping ends what starting began, also when a child hangs
or has died.

*Threading*: any thread may call. A network belongs to the process that
started it. It has the threads of modules `children`, `dynamics` and `log`, and
none of its own.
*/

:- meta_predicate network_begin(?, +, 1, -).

:- multifile
    prolog:message//1,
    typhon_named:elsewhere/1,
    typhon_named:ended_elsewhere/2,
    typhon_names:known/2,
    ended/1.                    % Network

:- dynamic
    ended/1,
    clock_of/2,                 % Network, clock(Epoch, Rate)
    network/2,                  % Network, Plan
    running/1.                  % Network

%!  network_start(+Topology, -Network, +Options) is det.
%
%   Starts a network of the shape Topology (see topology_edges/4). Options:
%
%     - processes(P)
%       1 (default): the hosts are in this process. More: they are in so
%       many child processes, in blocks of consecutive hosts, at most one
%       process per host.
%     - machines(Machines)
%       Children are started through ssh, on Machines in turn, in blocks as
%       well; by default one on each. A machine is a target of ssh, or as
%       described at child_start/5. bind(Interface) must name an interface
%       that they can reach.
%     - bind(Interface)
%       Of the endpoints on this machine; default `localhost`.
%     - tls(Directory)
%       The keys of this process, as of host_start/2, and of the children; on
%       other machines they are in a directory of the same name.
%     - hosts(Options)
%       Options for host_start/2, for each of the hosts.
%     - places(Places)
%       Files for the places of hosts, goals called there; see module `host_setup`.
%     - hop_time(uniform(Min, Max))
%       An emulated link delay in host seconds, added to every hop.
%     - clock(Rate)
%       Host seconds per second; default 1. With clock(virtual) nothing
%       waits, and the same Seed gives the same events: time runs while
%       a caller waits, in agent_join/3 and network_advance/2, and jumps to
%       what is due next. One process.
%     - log(File), log(File, Kinds)
%       A log server writes the events of all hosts to File, begun anew:
%       when agents begin and end, what they log, and, of Kinds, a list out
%       of `hops`, `messages`, `facts`, `faults`, `links` and `hosts`,
%       where they went, senders and receivers, what they left and took,
%       their errors, and which links and hosts came and went.
%       With messages(content) for `messages` it has what the messages say,
%       too; of more than 200 characters (the setting
%       `typhon_event_shown:content_characters`) the beginning, as a string.
%     - dynamic(Model)
%       Links come and go: see dynamics_model/2.
%     - cost(Cost)
%       What each link costs: a number, or uniform(Min, Max), drawn for each
%       pair of hosts. What edges(List) says comes first.
%     - seed(Seed)
%       An integer, from which all that is random follows; drawn when not
%       given, and told by network_property/2.
%     - journal(Directory), sync(How)
%       What happens in the network outlives its processes, each of which has
%       its journal, as of host_start/2, below Directory. Started again with
%       the same Directory the network is what it was, agents go on, and what
%       options leave open is as before. If its hosts are in this process, it
%       must be started before any other host.
%     - restart(Boolean)
%       Child processes that die are started again, with the ports that they
%       had, up to 10 times in a minute each (settings of module `restarts`).
%       Without a journal their hosts are then as they were when they began:
%       their agents, and what was left there, are lost. Default `false`.
%
%   @error uninstantiation_error(Network): the name is made here
%   @error domain_error(network_option, Option), domain_error(topology, T),
%   timeout_error(start, Network), system_error(process_ended(Status)),
%   and what host_start/2 throws; journal_of_another(Directory, Was, Is) if
%   the journal is that of a network that was started otherwise

network_start(Topology, Network, Options) :-
    must_be(var, Network),
    kept_plan(Topology, Options, Plan, Kept),
    network_begin(_, Plan, started(Plan, Kept), Network).

started(Plan, Kept, Network) :-
    network_build(Network, Plan, Kept, network_change(Network), Clock),
    network_goes_on(Network, Clock).

%!  network_begin(?Name, +Plan, :Build, -Network) is det.
%
%   Build a network by call(Build, Network), or leave nothing behind.  It has
%   that Name, if it is given and free.

network_begin(Name, Plan, Build, Network) :-
    (   atom(Name),
        \+ network(Name, _)
    ->  Network = Name
    ;   new_name(Network)
    ),
    once(
        setup_call_catcher_cleanup(
            assertz(network(Network, Plan)),
            call(Build, Network),
            Catcher,
            unless_built(Catcher, Network))),
    forget_erased.

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
%
%   It is built.

network_goes_on(Network, Clock) :-
    assertz(clock_of(Network, Clock)),
    assertz(running(Network)).

%!  network_change(+Network, +Change) is det.
%
%   Change is link(I, J) or unlink(I, J).

network_change(Network, Change0) :-
    network(Network, Plan),
    plan_change(Plan, Change0, Change),
    wire_change(Network, Change).

                /*******************************
                *             STOP             *
                *******************************/

%!  network_stop(+Network) is det.
%
%   Ends what network_start/3 started, in order: the changes of links, what
%   agents do, the hosts, the processes that carry them, the log, when all that
%   was said to it is written. Takes seconds at the most, also when a process
%   hangs. Where hosts are in this process its other agents pause meanwhile.
%
%   @error existence_error(network, Network)

network_stop(Network) :-
    must_be(atom, Network),
    (   retract(running(Network))
    ->  in_own_thread(end(Network))
    ;   existence_error(network, Network)
    ).

end(Network) :-
    step(dynamics_end(Network)),
    step(wire_resting_own(Network, stop_own(Network))),
    step(carriers_stop(Network)),
    step(log_end(Network)),
    step(endpoint_end(Network)),
    wire_forget(Network),
    debug(typhon(network), '~w has ended', [Network]),
    equipment_forget(Network),
    retractall(clock_of(Network, _)),
    forall(ended(Network), true),
    retractall(network(Network, _)).

%   What rests in a journal is there when it is started again.

stop_own(Network) :-
    network(Network, Plan),
    (   lasting_rests(Plan)
    ->  true
    ;   wire_stop_own(Network),
        lasting_over(Plan)
    ).

%   What goes wrong in one step must not leave the others undone.

step(Goal) :-
    catch(Goal, error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    !.
step(Goal) :-
    print_message(warning, typhon(network_step(Goal))).

                /*******************************
                *          PROPERTIES          *
                *******************************/

%!  network_clock(+Network, -Clock) is det.
%
%   Clock is clock(Epoch, Rate).
%
%   @error existence_error(network, Network)

network_clock(Network, Clock) :-
    must_be(atom, Network),
    (   running(Network)
    ->  clock_of(Network, Clock)
    ;   existence_error(network, Network)
    ).

%!  network_standing(+Network, -Standing) is det.
%
%   Standing is standing(Plan, Clock, Log, Dynamics), with log(Address, File)
%   or `none`, and `none` where there are no dynamics.
%
%   @error existence_error(network, Network)

network_standing(Network, standing(Plan, Clock, Log, Dynamics)) :-
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

%!  network_property(?Network, ?Property) is nondet.
%
%   Property is one of
%
%     - hosts(Addresses)
%       In the order of the topology.
%     - edges(Edges)
%       The links between hosts of the network at this moment, pairs A-B
%       of addresses. Asks each process.
%     - agents(Agents)
%       Those that were born on its hosts and have not ended, wherever they
%       are, in no order. Asks each process.
%     - processes(Pids)
%       The processes that carry hosts and are alive.
%     - log(File), seed(Seed)
%
%   @error type_error(atom, Network), and existence_error(network, Network)
%   when it is bound and not running, domain_error(network_property, Property)

network_property(Network, Property) :-
    check_name(network_property, Property),
    (   var(Network)
    ->  running(Network)
    ;   must_be(atom, Network),
        running(Network)
    ->  true
    ;   existence_error(network, Network)
    ),
    property(Property, Network).

typhon_names:known(network_property, Property) :-
    clause(property(Property, _), _).
typhon_names:known(network, Network) :-
    running(Network).

typhon_named:elsewhere(Agent) :-
    running(Network),
    wired_agents(Network, Agents),
    member(Agent, Agents).

typhon_named:ended_elsewhere(Name, Agent) :-
    running(Network),
    wired_ended(Network, Name, Agents),
    last(Agents, Agent).

property(hosts(Addresses), Network) :-
    wired_hosts(Network, Addresses).
property(edges(Edges), Network) :-
    wired_edges(Network, Edges).
property(agents(Agents), Network) :-
    wired_agents(Network, Agents).
property(processes(Pids), Network) :-
    restarts_back(Network),
    findall(P-Pid, carrier(Network, P, Pid), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Pids).
property(log(File), Network) :-
    part(Network, log(_, File)).
property(seed(Seed), Network) :-
    network(Network, Plan),
    plan_option(Plan, seed(Seed)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(network_step(Goal))) -->
    [ 'Ending the network: ~p failed'-[Goal] ].
