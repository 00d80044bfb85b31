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

Many hosts in one or more processes, their links, and their log.
This is the interface of the layer: higher layers import from here.  Its
modules are loaded when they are used first.

*Threading*: as the predicates say; any thread otherwise.
*/

:- meta_predicate network_at(+, +, 0).

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
%       described at child_start/6. bind(Interface) must name an interface
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
%       `typhon_host_log:content_characters`) the beginning, as a string.
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
    networks_start(Topology, Network, Options).

%!  network_stop(+Network) is det.
%
%   Ends what network_start/3 started, in order: the changes of links, what
%   agents do, the hosts, the processes that carry them, the log, when all that
%   was said to it is written. Takes seconds at the most, also when a process
%   hangs. Where hosts are in this process its other agents pause meanwhile.
%
%   @error existence_error(network, Network)

network_stop(Network) :-
    networks_stop(Network).

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
    networks_property(Network, Property).

%!  network_hosts(?Network, -Addresses) is nondet.
%
%   Addresses of the hosts of a Network of this process.  Loads nothing: as
%   long as no network was started there is none.

network_hosts(Network, Addresses) :-
    current_module(typhon_networks),
    networks_property(Network, hosts(Addresses)).

%!  network_advance(+Network, +Seconds) is det.
%
%   Let Seconds pass, by the clock of the hosts: in virtual time at once.
%
%   @error existence_error(network, Network)

network_advance(Network, Seconds) :-
    appointments_wait(Network, Seconds).

%!  network_at(+Network, +Time, :Goal) is det.
%
%   Run Goal once when the clock of the hosts shows Time, or as soon as may
%   be if that is past; never, if Network is stopped before. What Goal
%   raises is reported.
%
%   @error existence_error(network, Network), type_error(callable, Goal)

network_at(Network, Time, Goal) :-
    appointments_at(Network, Time, Goal).

%!  network_save(+Network, +File) is det.
%
%   Write all of Network to File: hosts, links, agents with their goals, state
%   and mail, facts, payloads, outcomes, clocks, and what is due.  It goes on
%   afterwards, and from File a network can be made that goes on alike, see
%   network_load/3.  What was in File is replaced when all is written.
%
%   @error existence_error(network, Network)
%   @error timeout_error(save, Network): something does not come to rest
%   @error type_error(mobile_term, Culprit): what cannot be written
%   @error permission_error(save, network, Network): an agent asks for it
%   @error permission_error(save, host, Host): which is not of Network, but has
%          the same virtual time
%   @error existence_error(carrier, Network-P), and what open/3 raises

network_save(Network, File) :-
    save_network(Network, File).

%!  network_load(+File, -Network, +Options) is det.
%
%   Network is what network_save/2 has written to File, and goes on from there:
%   in virtual time as the first one did, to the last byte of the log. It has
%   the same name, if that is free, and its agents have the same ids. Options:
%
%     - log(File)
%       Where its events are written, begun anew. By default they go on in the
%       file of the first one: what was written there since is cut off. If
%       that file is not there, or shorter, it is begun anew.
%
%   @error existence_error(source_sink, File)
%   @error network_damaged(File, Why), network_version(File, Version)
%   @error domain_error(network_load_option, Option)
%   @error permission_error(load, virtual_time, Network): this process has
%          virtual time already
%   @error what network_start/3 raises, as where a port is taken

network_load(File, Network, Options) :-
    load_network(File, Network, Options).

%!  log_server_start(+Options, -Address) is det.
%
%   Starts a log server in this process. Options:
%
%     - file(File)
%       Where events are written. Has no default.
%     - mode(Mode)
%       `write` (default): the file is begun anew; `append`: it goes on.
%     - name(Name)
%       Default `log`.
%     - bind(Interface), port(Port)
%       Of the process' endpoint, if it has to be started. Default
%       `localhost` and any.
%     - clock(Epoch, Rate)
%       Default clock(0, 1), the time of day.
%
%   Address is Name@Interface:Port, for log(Address) of host_start/2.
%
%   @error domain_error(log_server_option, Option),
%   existence_error(option, file),
%   permission_error(start, log_server, Name) when it is running,
%   existence_error(directory, Dir), permission_error(open, source_sink,
%   File)

log_server_start(Options, Address) :-
    log_serve(Options, Address).

%!  log_server_stop(+Address) is det.
%
%   Writes what has arrived, and what was posted in this process before,
%   and ends the server.
%
%   @error existence_error(log_server, Address)

log_server_stop(Address) :-
    log_serve_end(Address).

%!  log_events(+File, -Events:list) is det.
%
%   Events are the event(Time, Host, Agent, What) facts in File, in the
%   order in which they arrived. What has arrived in this process is among
%   them. A line that is no fact is reported by a warning, and the others are
%   read.
%
%   @error existence_error(source_sink, File)

log_events(File, Events) :-
    log_read(File, Events).
