:- module(typhon_networks,
          [ network_start/3,            % +Topology, -Network, +Options
            network_stop/1,             % +Network
            network_property/2          % ?Network, ?Property
          ]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(error), [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists), [append/3, nth1/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(random), [random_between/3]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module('../host', [runtime_acquire/2, runtime_release/1]).
:- use_module(dynamics,
              [ dynamics_model/2, dynamics_start/4, dynamics_state/5,
                dynamics_stop/1 ]).
:- use_module(log, [log_server_start/2, log_server_stop/1]).
:- use_module(processes, [carrier/3, carriers_start/4, carriers_stop/1]).
:- use_module(topology, [topology_edges/4, topology_names/2]).
:- use_module(wiring,
              [ wire_change/2, wire_forget/1, wire_hosts/3, wire_links/3,
                wire_stop_own/1, wired_edges/2, wired_hosts/2 ]).

/** <module> Networks of hosts

A network is a number of hosts and the links between them, started and
stopped by one call. Its hosts live in this process, or in child processes
on this machine and others. They share a clock, which shows 0 when the
hosts are about to start.

Starting is all or nothing: what was started is stopped again when
something fails. Stopping ends what starting began, also when a child hangs
or has died.

*Threading*: any thread may call. A network belongs to the process that
started it. It has the threads of rooms `children`, `dynamics` and `log`, and
none of its own.
*/

:- multifile
    prolog:message//1.

:- dynamic
    network/2,                  % Network, Options
    running/1,                  % Network
    part/2.                     % Network, log(Address, File),
                                % or dynamics(Dynamics)

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
%     - hosts(Options)
%       Options for host_start/2, for each of the hosts.
%     - hop_time(uniform(Min, Max))
%       An emulated link delay in host seconds, added to every hop.
%     - clock(Rate)
%       Host seconds per second; default 1.
%     - log(File)
%       A log server writes the events of all hosts to File, begun anew.
%     - dynamic(Model)
%       Links come and go: see dynamics_model/2.
%     - seed(Seed)
%       An integer, from which all that is random follows; drawn when not
%       given, and told by network_property/2.
%
%   @error domain_error(network_option, Option), domain_error(topology, T),
%   timeout_error(start, Network), system_error(process_ended(Status)),
%   and what host_start/2 throws

network_start(Topology, Network, Options0) :-
    must_be(list, Options0),
    maplist(check_option, Options0),
    seeded(Options0, Seed, Options),
    topology_edges(Topology, Seed, N, Edges),
    topology_names(Topology, Names),
    flag(typhon_networks, Id, Id + 1),
    atom_concat(network, Id, Network),
    setup_call_catcher_cleanup(
        assertz(network(Network, Options)),
        build(Network, plan(N, Names, Edges, Seed, Options)),
        Catcher,
        unless_built(Catcher, Network)).

check_option(Option) :-
    must_be(nonvar, Option),
    (   option_check(Option, Check)
    ->  call(Check)
    ;   domain_error(network_option, Option)
    ).

option_check(processes(P), must_be(positive_integer, P)).
option_check(machines(Machines), must_be(list, Machines)).
option_check(bind(Interface), must_be(atom, Interface)).
option_check(hosts(Options), must_be(list, Options)).
option_check(hop_time(Time), check_hop_time(Time)).
option_check(clock(Rate), check_rate(Rate)).
option_check(log(File), must_be(ground, File)).
option_check(dynamic(Model), dynamics_model(Model, _)).
option_check(seed(Seed), must_be(integer, Seed)).

check_hop_time(Time) :-
    (   Time = uniform(Min, Max),
        number(Min), number(Max),
        0 =< Min, Min =< Max
    ->  true
    ;   domain_error(hop_time, Time)
    ).

check_rate(Rate) :-
    must_be(number, Rate),
    (   Rate > 0
    ->  true
    ;   domain_error(clock_rate, Rate)
    ).

seeded(Options, Seed, Options) :-
    option(seed(Seed), Options),
    !.
seeded(Options, Seed, [seed(Seed)|Options]) :-
    random_between(1, 0x3fffffff, Seed).

unless_built(exit, _) :-
    !.
unless_built(_, Network) :-
    in_own_thread(end(Network)).

                /*******************************
                *            BUILD             *
                *******************************/

build(Network, plan(N, Names, Edges, Seed, Options)) :-
    listen(Network, Options),
    start_carriers(Network, N, P, Options),
    get_time(Epoch),
    option(clock(Rate), Options, 1),
    Clock = clock(Epoch, Rate),
    start_log(Network, Clock, Options),
    start_hosts(Network, Names, P, [Clock, seed(Seed)], Options),
    wire_links(Network, P, Edges),
    start_dynamics(Network, plan(N, Edges, Seed), Clock, Options),
    assertz(running(Network)).

listen(Network, Options) :-
    (   option(bind(Interface), Options)
    ->  runtime_acquire(network(Network), [bind(Interface)])
    ;   runtime_acquire(network(Network), [])
    ).

start_carriers(Network, N, P, Options) :-
    (   option(machines([Machine|Rest]), Options)
    ->  Machines = [Machine|Rest]
    ;   Machines = [local]
    ),
    length(Machines, M),
    option(processes(P0), Options, M),
    P is min(P0, N),
    option(bind(Interface), Options, localhost),
    carriers_start(Network, P, Machines, Interface).

start_log(Network, clock(Epoch, Rate), Options) :-
    (   option(log(Spec), Options)
    ->  absolute_file_name(Spec, File),
        atom_concat(Network, '_log', Name),
        log_server_start([file(File), name(Name), clock(Epoch, Rate)],
                         Address),
        assertz(part(Network, log(Address, File)))
    ;   true
    ).

%   Host I of N is in process (I-1)*P//N + 1: blocks of nearly one size.

start_hosts(Network, Names, P, Common, Options) :-
    length(Names, N),
    findall(host(At, I, Name, HostOptions),
            ( nth1(I, Names, Name),
              At is (I - 1) * P // N + 1,
              host_options(Network, I, Common, Options, HostOptions) ),
            Hosts),
    wire_hosts(Network, P, Hosts).

%   What hosts(Own) says comes before what the network says.

host_options(Network, I, [Clock, seed(Seed)], Options, HostOptions) :-
    HostSeed is Seed * 65536 + I,
    findall(Option, given(Network, Options, Option), Given),
    option(hosts(Own), Options, []),
    exclude(overridden(Own), [Clock, seed(HostSeed)|Given], Ours),
    append(Own, Ours, HostOptions).

given(Network, _, log(Address)) :-
    part(Network, log(Address, _)).
given(_, Options, hop_time(Time)) :-
    option(hop_time(Time), Options).

overridden(Own, Option) :-
    functor(Option, Name, Arity),
    functor(General, Name, Arity),
    memberchk(General, Own).

start_dynamics(Network, plan(N, Edges, Seed), Clock, Options) :-
    (   option(dynamic(Spec), Options)
    ->  dynamics_model(Spec, Model),
        dynamics_state(Model, N, Edges, Seed, State),
        dynamics_start(State, Clock, wire_change(Network), Dynamics),
        assertz(part(Network, dynamics(Dynamics)))
    ;   true
    ).

                /*******************************
                *             STOP             *
                *******************************/

%!  network_stop(+Network) is det.
%
%   Ends what network_start/3 started, in order: the changes of links, the
%   hosts, the processes that carry them, the log, when all that was said
%   to it is written. Takes seconds at the most, also when a process hangs.
%
%   @error existence_error(network, Network)

network_stop(Network) :-
    must_be(atom, Network),
    (   retract(running(Network))
    ->  in_own_thread(end(Network))
    ;   existence_error(network, Network)
    ).

end(Network) :-
    (   retract(part(Network, dynamics(Dynamics)))
    ->  step(dynamics_stop(Dynamics))
    ;   true
    ),
    step(wire_stop_own(Network)),
    step(carriers_stop(Network)),
    (   retract(part(Network, log(Address, _)))
    ->  step(log_server_stop(Address))
    ;   true
    ),
    step(runtime_release(network(Network))),
    wire_forget(Network),
    retractall(part(Network, _)),
    retractall(network(Network, _)).

%   What goes wrong in one step must not leave the others undone.

step(Goal) :-
    catch(Goal, error(Formal, Context),
          print_message(warning, error(Formal, Context))),
    !.
step(Goal) :-
    print_message(warning, typhon(network_step(Goal))).

                /*******************************
                *          PROPERTIES          *
                *******************************/

%!  network_property(?Network, ?Property) is nondet.
%
%   Property is one of
%
%     - hosts(Addresses)
%       In the order of the topology.
%     - edges(Edges)
%       The links between hosts of the network at this moment, pairs A-B
%       of addresses. Asks each process.
%     - processes(Pids)
%       The processes that carry hosts and are alive.
%     - log(File), seed(Seed)
%
%   @error type_error(atom, Network), and existence_error(network, Network)
%   when it is bound and not running

network_property(Network, Property) :-
    (   var(Network)
    ->  running(Network)
    ;   must_be(atom, Network),
        running(Network)
    ->  true
    ;   existence_error(network, Network)
    ),
    property(Property, Network).

property(hosts(Addresses), Network) :-
    wired_hosts(Network, Addresses).
property(edges(Edges), Network) :-
    wired_edges(Network, Edges).
property(processes(Pids), Network) :-
    findall(P-Pid, carrier(Network, P, Pid), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Pids).
property(log(File), Network) :-
    part(Network, log(_, File)).
property(seed(Seed), Network) :-
    network(Network, Options),
    option(seed(Seed), Options).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(network_step(Goal))) -->
    [ 'Ending the network: ~p failed'-[Goal] ].
