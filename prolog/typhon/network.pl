:- module(typhon_network,
          [ network_start/3,            % +Topology, -Network, +Options
            network_stop/1,             % +Network
            network_property/2,         % ?Network, ?Property
            network_hosts/2,            % ?Network, -Addresses
            network_advance/2,          % +Network, +Seconds
            network_at/3,               % +Network, +Time, :Goal
            network_save/2,             % +Network, +File
            network_load/3,             % +File, -Network, +Options
            log_server_start/2,         % +Options, -Address
            log_server_stop/1,          % +Address
            log_events/2                % +File, -Events
          ]).
:- autoload('network/loading', [load_network/3]).
:- autoload('network/log', [log_serve/2, log_serve_end/1]).
:- autoload('network/log_file', [log_read/2]).
:- autoload('network/networks',
              [ appointments_at/3, appointments_wait/2, networks_property/2,
                networks_start/3, networks_stop/1 ]).
:- autoload('network/saving', [save_network/2]).

/** <module> Networks

Many hosts in one or more processes, their links, and their log.  This is the
interface of the layer; its modules are loaded when they are first used.

*Threading*: any thread.
*/

:- meta_predicate network_at(+, +, 0).

%!  network_start(+Topology, -Network, +Options) is det.
%
%   Start a network of the shape Topology, see topology_edges/4.  Options:
%
%     - processes(P): default 1: the hosts are in this process.  Otherwise they
%       are in so many child processes, in blocks of consecutive hosts, at most
%       one process for each host
%     - start(How): where the children run: `local`; ssh(Machines), in blocks as
%       well, by default one on each, where a machine is a target of ssh or a term
%       of child_start/6; or slurm(Options) on the nodes of an allocation, by
%       default one on each, with options nodes(N) (default 1), partition(P),
%       time(T) as salloc takes it, more(Args) for salloc, swipl(Program) and
%       node(File).  bind(Interface) must name an interface that they can reach
%     - fleet(Fleet): the processes join Fleet as this process has, and its hosts
%       belong to it.  Files of keys have the same names on all machines
%     - machines(Machines): as start(ssh(Machines)), and a machine may be `local`
%     - bind(Interface): of the endpoints on this machine; default `localhost`
%     - advertise(Address): of the endpoints on this machine, as of host_start/2,
%       but without a port
%     - tls(Directory): the keys of this process, as of host_start/2, and of the
%       children; other machines have them in a directory of the same name
%     - hosts(Options): options of host_start/2 for each of the hosts
%     - places(Places): files for the places of hosts, and goals that are called
%       there, see typhon_host_setup
%     - hop_time(uniform(Min, Max)): emulated delay in host seconds of each hop
%     - clock(Rate): host seconds per second; default 1.  With clock(virtual)
%       nothing waits, and the same Seed gives the same events: time runs while
%       a caller waits, in agent_join/3 and network_advance/2, and jumps to the
%       next event.  One process
%     - log(File), log(File, Kinds): a log server writes the events of all hosts
%       to File, which it replaces: begins and ends of agents, what they log,
%       and events of Kinds, a list of `hops`, `messages`, `facts`, `faults`,
%       `links` and `hosts`.  With messages(content) in place of `messages` the
%       events hold the messages, those of more than 200 characters (the setting
%       `typhon_host_log:content_characters`) cut, as a string
%     - dynamic(Model): links change, see dynamics_model/2
%     - cost(Cost): of each link: a number, or uniform(Min, Max), drawn for each
%       pair of hosts.  A cost in edges(List) overrides it
%     - seed(Seed): an integer, which determines all random choices; by default
%       it is drawn, and network_property/2 returns it
%     - journal(Directory), sync(How): the network outlives its processes, each
%       of which has its journal, as of host_start/2, below Directory.  When the
%       network is started again with the same Directory it is restored, agents
%       go on, and options that are not given keep their values.  If its hosts
%       are in this process, it must be started before any other host
%     - restart(Boolean): restart child processes that die, with their ports, up
%       to 10 times in a minute each (settings of typhon_restarts).  Without a
%       journal their hosts begin anew, and their agents and facts are lost.
%       Default `false`
%
%   @error uninstantiation_error(Network)
%   @error domain_error(network_option, Option), domain_error(topology, T),
%   existence_error(fleet, Fleet), domain_error(start, How), timeout_error(start, Network),
%   system_error(process_ended(Status)), resource_error(nodes(N)) of Slurm,
%   and the errors of host_start/2; journal_of_another(Directory, Was, Is) if
%   the journal is that of another network

network_start(Topology, Network, Options) :-
    networks_start(Topology, Network, Options).

%!  network_stop(+Network) is det.
%
%   Stop, in this order, the changes of links, the turns of agents, the hosts,
%   their processes, and the log, when all events posted to it are written.
%   Takes seconds at most, also if a process hangs.  If hosts are in this
%   process, its other agents pause meanwhile.
%
%   @error existence_error(network, Network)

network_stop(Network) :-
    networks_stop(Network).

%!  network_property(?Network, ?Property) is nondet.
%
%   Property is one of
%
%     - hosts(Addresses): in the order of the topology
%     - edges(Edges): the present links between hosts of the network, pairs A-B
%       of addresses.  Asks each process
%     - agents(Agents): those that were created on its hosts and have not ended,
%       wherever they are, in any order.  Asks each process
%     - processes(Pids): the processes that run hosts
%     - log(File), seed(Seed)
%
%   @error type_error(atom, Network), existence_error(network, Network) if it is
%   bound and not running, domain_error(network_property, Property)

network_property(Network, Property) :-
    networks_property(Network, Property).

%!  network_hosts(?Network, -Addresses) is nondet.
%
%   Addresses are those of the hosts of Network, which this process has started.
%   Loads nothing: before the first start there is no network.

network_hosts(Network, Addresses) :-
    current_module(typhon_networks),
    networks_property(Network, hosts(Addresses)).

%!  network_advance(+Network, +Seconds) is det.
%
%   Let Seconds pass, by the clock of the hosts; in virtual time at once.
%
%   @error existence_error(network, Network)

network_advance(Network, Seconds) :-
    appointments_wait(Network, Seconds).

%!  network_at(+Network, +Time, :Goal) is det.
%
%   Run Goal once when the clock of the hosts shows Time, soon if that is past,
%   and not at all if Network is stopped before.  An exception of Goal is
%   reported.
%
%   @error existence_error(network, Network), type_error(callable, Goal)

network_at(Network, Time, Goal) :-
    appointments_at(Network, Time, Goal).

%!  network_save(+Network, +File) is det.
%
%   Write all of Network to File: hosts, links, agents with their goals, state
%   and mail, facts, payloads, outcomes, clocks and pending events.  Network
%   goes on afterwards, and network_load/3 makes a network from File that goes
%   on alike.  An old File is replaced when all is written.
%
%   @error existence_error(network, Network)
%   @error timeout_error(save, Network): it does not come to rest
%   @error type_error(mobile_term, Culprit): Culprit cannot be written
%   @error permission_error(save, network, Network): the caller is an agent
%   @error permission_error(save, host, Host): Host is not in Network, but has
%          the same virtual time
%   @error existence_error(carrier, Network-P), and the errors of open/3

network_save(Network, File) :-
    save_network(Network, File).

%!  network_load(+File, -Network, +Options) is det.
%
%   Network goes on from the state that network_save/2 has written to File, in
%   virtual time with the same events, to the last byte of the log.  It has the
%   same name, if that is free, and its agents have the same ids.  Option:
%
%     - log(File): write its events to File, which is replaced.  By default they
%       follow those in the log of the saved network, which is cut to its length
%       at that time, or begun anew if it is missing or shorter
%
%   @error existence_error(source_sink, File)
%   @error network_damaged(File, Why), network_version(File, Version)
%   @error domain_error(network_load_option, Option)
%   @error permission_error(load, virtual_time, Network): this process has
%          virtual time already
%   @error the errors of network_start/3, for example if a port is in use

network_load(File, Network, Options) :-
    load_network(File, Network, Options).

%!  log_server_start(+Options, -Address) is det.
%
%   Start a log server in this process.  Options:
%
%     - file(File): where it writes events; required
%     - mode(Mode): `write` (default) replaces the file, `append` extends it
%     - name(Name): default `log`
%     - bind(Interface), port(Port), advertise(Address): of the endpoint of the
%       process, if it must be started; default `localhost`, and any port
%     - clock(Epoch, Rate): default clock(0, 1), the time of day
%
%   Address is Name@Interface:Port, for log(Address) of host_start/2.
%
%   @error domain_error(log_server_option, Option),
%   existence_error(option, file), permission_error(start, log_server, Name) if
%   it runs already, existence_error(directory, Dir), permission_error(open,
%   source_sink, File)

log_server_start(Options, Address) :-
    log_serve(Options, Address).

%!  log_server_stop(+Address) is det.
%
%   Stop the server when all events that have arrived, or that this process has
%   posted before, are written.
%
%   @error existence_error(log_server, Address)

log_server_stop(Address) :-
    log_serve_end(Address).

%!  log_events(+File, -Events:list) is det.
%
%   Events are the facts event(Time, Host, Agent, What) in File, in the order of
%   their arrival, including all that have arrived in this process.  Other lines
%   are skipped with a warning.
%
%   @error existence_error(source_sink, File)

log_events(File, Events) :-
    log_read(File, Events).
