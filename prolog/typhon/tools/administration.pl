:- module(typhon_administration,
          [ host_property/2,            % ?Name, ?Property
            host_change/2,              % +Host, +Option
            link/2,                     % +HostA, +HostB
            link/3,                     % +HostA, +HostB, +Options
            unlink/2,                   % +HostA, +HostB
            remote/2,                   % +Host, +Goal
            agent_property/2,           % ?Agent, ?Property
            agent_where/2,              % +Agent, -Host
            agent_change/2,             % +Agent, +Change
            status_shown/2,             % +Status, -State
            agent_save/2,               % +Agent, +File
            agent_load/2,               % +File, -Agent
            agent_load/3                % +File, -Agent, +Options
          ]).
:- autoload('../options/remote', [run_remote/2]).
:- autoload('administration/change', [change_agent/2]).
:- autoload('administration/host_questions',
            [ change_host/2, link_hosts/2, link_hosts/3, property_of_host/2,
              unlink_hosts/2 ]).
:- autoload('administration/properties',
            [place_of_agent/2, property_of_agent/2, show_status/2]).
:- autoload('administration/restore', [load_agent/3, save_agent/2]).

/** <module> Administration: properties and changes of hosts and agents

This is the interface of the layer.  Its modules are loaded when this process
calls them, or another process sends a request.

*Threading*: any thread that may wait.
*/

%!  host_property(?Name, ?Property) is nondet.
%
%   Host Name has Property:
%
%     - address(Address), state(running), place(Module)
%     - capacity(N): maximal number of agents, or `inf`
%     - load(N): number of agents, without faulty ones
%     - neighbours(Addresses)
%     - hop_time(Direction, stats(Count,Min,Mean,Max)): duration of hops in host
%       seconds; Direction is `in` or `out`
%
%   Name is the name of a host of this process, or of another process of a
%   network that this process has started, or any address.
%
%   @error existence_error(host, Name), ambiguous_host(Name, Addresses)
%   @error domain_error(host_property, Property)

host_property(Name, Property) :-
    property_of_host(Name, Property).

%!  host_change(+Host, +Option) is det.
%
%   Change an option of a running host, in this or another process: tokens,
%   capacity, authors, concurrency, hop_time, log, audit, peer, policy, python,
%   quota, remote, seed or trail, as of host_start/2; or add services.  Agents
%   on the host stay, also if the host would no longer admit them.
%
%   @error existence_error(host, Host)
%   @error permission_error(change, host_option, Option)

host_change(Host, Option) :-
    change_host(Host, Option).

%!  link(+A, +B) is det.
%!  link(+A, +B, +Options) is det.
%!  unlink(+A, +B) is det.
%
%   Make or remove the overlay link between two hosts, in both directions.  The
%   hosts may be in other processes.  Agents get the cost of a link by
%   neighbour/2: 1, or the Number of the option cost(Number), which also changes
%   the cost of an existing link.  Removing a link discards its cost.
%
%   @error existence_error(host, Host), ambiguous_host(Name, Addresses)
%   @error domain_error(link_option, Option)

link(A, B) :-
    link_hosts(A, B).

link(A, B, Options) :-
    link_hosts(A, B, Options).

unlink(A, B) :-
    unlink_hosts(A, B).

%!  remote(+Host, +Goal) is semidet.
%
%   Call once(Goal) in the place of Host, in this or another process. Bindings,
%   failure and errors are returned. An error of another process whose message
%   would call a goal is returned as error(raised_elsewhere(Ball), _). A goal
%   M:G runs in module M instead, and has the place only as its context.
%   leave/1, sense/1 and take/1 work on the tuple space of Host.
%
%   @error permission_error(remote, host, Host) if the host refuses
%   @error host_unreachable(Host), permission_error(authenticate, host, Host)
%   @error connection_lost(Host): it is not known whether Goal ran

remote(Host, Goal) :-
    run_remote(Host, Goal).

%!  agent_property(?Agent, ?Property) is nondet.
%
%   Agent has Property:
%
%     - program(Name), hops(N), goals(List), facts(Clauses), payloads(Names),
%       mailbox(Messages)
%     - host(Address), home(Address): a query may use the name of a host in
%       place of its address, as in host(alpha)
%     - state(State): State is `running`, `sleeping`, `waiting`, `resident`,
%       `held` (see agent_step/1), `in_transit`, `in_doubt` or faulty(Error),
%       where Error is `failed` after a failure
%     - fault(fault(Error, Goal, Place, Host)): of a faulty agent; the goal that
%       failed or raised the error, its place and the host.  Place is File:Line,
%       Name/Arity:N for the N-th clause of a predicate, or `unknown`
%     - busy(Seconds): of a running agent; seconds of real time since its last
%       stop
%
%   In goals and messages, text replaces terms that cannot travel.  If Agent is
%   unbound, the agents of this process are enumerated.  Fails for the id of an
%   agent that has ended.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids) if Agent
%   is a name
%   @error domain_error(agent_property, Property) if Property is unknown

agent_property(Agent, Property) :-
    property_of_agent(Agent, Property).

%!  agent_where(+Agent, -Host) is det.
%
%   Host is the address of the host on which Agent is, or was when it was last
%   heard of, if its process does not answer.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)

agent_where(Agent, Host) :-
    place_of_agent(Agent, Host).

%!  agent_change(+Agent, +Change) is det.
%
%   Change Agent, faulty or not, at its next effect:
%
%     - facts(+Clauses): add Clauses to its state.  They are of predicates that
%       its program or a payload declares as state, or that Agent has made
%       itself
%     - program(+Spec): replace its program, see agent_create/2.  Its state and
%       its remaining goals stay: the rest of a clause is that of the old clause
%
%   @error domain_error(agent_change, Change)
%   @error permission_error(attach, procedure, PI) the program defines the
%          predicate of a fact, or the new program defines one of the state
%   @error existence_error(state, PI, Declared) the predicate of a fact is not
%          declared as state
%   @error any problem of the program
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent)

agent_change(Agent, Change) :-
    change_agent(Agent, Change).

%!  status_shown(+Status, -State) is det.
%
%   State is the name that users see for Status.

status_shown(Status, State) :-
    show_status(Status, State).

%!  agent_save(+Agent, +File) is det.
%!  agent_load(+File, -Agent) is det.
%!  agent_load(+File, -Agent, +Options) is det.
%
%   Write a restore point to File: Agent as it is at its next effect, as text.
%   agent_load/2,3 creates an agent from it, with an id of its own, which
%   continues where Agent was saved.  It is created on the first host of this
%   process, or on that of the option host(Host), which may be in another
%   process.
%
%   @error type_error(mobile_term, Culprit)
%   @error domain_error(restore_point, File)
%   @error domain_error(load_option, Option), existence_error(host, Host)
%   @error move_refused(Host, Reason), host_unreachable(Host)

agent_save(Agent, File) :-
    save_agent(Agent, File).

agent_load(File, Agent) :-
    agent_load(File, Agent, []).

agent_load(File, Agent, Options) :-
    load_agent(File, Agent, Options).
