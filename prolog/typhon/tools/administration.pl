:- module(typhon_administration,
          [ host_property/2,            % ?Name, ?Property
            host_change/2,              % +Host, +Option
            link/2,                     % +HostA, +HostB
            link/3,                     % +HostA, +HostB, +Options
            unlink/2,                   % +HostA, +HostB
            agent_property/2,           % ?Agent, ?Property
            agent_change/2,             % +Agent, +Change
            status_shown/2,             % +Status, -State
            agent_save/2,               % +Agent, +File
            agent_load/2,               % +File, -Agent
            agent_load/3                % +File, -Agent, +Options
          ]).
:- autoload('administration/change', [change_agent/2]).
:- autoload('administration/host_questions',
            [ change_host/2, link_hosts/2, link_hosts/3, property_of_host/2,
              unlink_hosts/2 ]).
:- autoload('administration/properties',
            [property_of_agent/2, show_status/2]).
:- autoload('administration/restore', [load_agent/3, save_agent/2]).

/** <module> Administration: properties of hosts and agents, and changes

This is the interface of the layer.  Its modules are loaded when they are used
here, or when another process requests them.

*Threading*: any thread that may wait.
*/

%!  host_property(?Name, ?Property) is nondet.
%
%   Property is address(A), state(running), capacity(N), load(N),
%   neighbours(L), hop_time(Direction, stats(Count,Min,Mean,Max)) (host
%   seconds) or place(M).  Name may be that of a host of another process of a
%   network that this process started, or any address.
%
%   @error existence_error(host, Name), ambiguous_host(Name, Addresses)
%   @error domain_error(host_property, Property)

host_property(Name, Property) :-
    property_of_host(Name, Property).

%!  host_change(+Host, +Option) is det.
%
%   Change an option of a running host, here or elsewhere: tokens, capacity,
%   authors, concurrency, hop_time, log, audit, peer, policy, python, quota,
%   remote, seed or trail, as of host_start/2, or services, to which the given
%   ones are added.  Agents on the host stay, also if fewer are admitted from
%   now on.
%
%   @error existence_error(host, Host)
%   @error permission_error(change, host_option, Option)

host_change(Host, Option) :-
    change_host(Host, Option).

%!  link(+A, +B) is det.
%!  link(+A, +B, +Options) is det.
%!  unlink(+A, +B) is det.
%
%   Make or break the overlay link between two hosts, in both directions; either
%   may be in another process.  Agents get the cost of a link by neighbour/2: 1,
%   or the Number of the option cost(Number), which also changes the cost of an
%   existing link.  Breaking a link discards its cost.
%
%   @error existence_error(host, Host), ambiguous_host(Name, Addresses)
%   @error domain_error(link_option, Option)

link(A, B) :-
    link_hosts(A, B).

link(A, B, Options) :-
    link_hosts(A, B, Options).

unlink(A, B) :-
    unlink_hosts(A, B).

%!  agent_property(?Agent, ?Property) is nondet.
%
%   Property is host(Address), program(Name), state(State), hops(N),
%   home(Address), goals(List), facts(Clauses), payloads(Names),
%   mailbox(Messages) or fault(Fault).  State is `running`, `sleeping`,
%   `waiting`, `resident`, `held` (see agent_step/1), `in_transit`, `in_doubt`
%   or faulty(Error), where Error is `failed` after a failure.  Only a faulty
%   agent has a fault: fault(Error, Goal, Place, Host), the goal that failed or
%   raised the error, its place, as File:Line, or Name/Arity:N for the N-th
%   clause of a predicate, or `unknown`, and the host.  In goals and messages,
%   terms that cannot travel are replaced by text.  A running agent has
%   busy(Seconds): the time, by the time of day, since its last stop.  A host
%   may be given by its name, as in host(alpha).  If Agent is unbound, the
%   agents of this process are enumerated.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids) if Agent
%   is a name; fails for the id of an agent that has ended
%   @error domain_error(agent_property, Property) if Property is unknown

agent_property(Agent, Property) :-
    property_of_agent(Agent, Property).

%!  agent_change(+Agent, +Change) is det.
%
%   Change Agent, faulty or not, at its next effect:
%
%     - facts(+Clauses): are added to its state, of predicates that its
%       program or a payload declares, or that it has made itself
%     - program(+Spec): is its program from now on, see agent_create/2.  Its
%       state is unchanged, and so are its remaining goals: the rest of a
%       clause is that of the old clause.
%
%   @error domain_error(agent_change, Change)
%   @error permission_error(attach, procedure, PI) for a fact of a predicate
%          of the program, and a program that has one of the state
%   @error existence_error(state, PI, Declared) for a fact of any other
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
%   A restore point: Agent as it is at its next effect, as text.  The agent that
%   is made from it continues where the first one was, under its own id, on the
%   first host of this process or on that of the option host(Host), also in
%   another process.
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
