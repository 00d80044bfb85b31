:- module(typhon_overview,
          [ processes_overview/3        % +Hosts, -Processes, -Silent
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/program', [code_program/2]).
:- use_module('../../kernel/wire', [endpoint_address/1]).
:- use_module('../../kernel/host',
              [ address_parts/3, host/3, host_link_cost/3, host_load/2,
                host_neighbours/2, host_option/2, host_time/2 ]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3, life_hops/2]).
:- use_module('../../kernel/lifecycle', [status_shown/2]).
:- use_module(everywhere, [everywhere/5]).
:- use_module(watched, [watched_places/2]).

/** <module> The state before the first event

To know the state before, begin to watch, ask, and then take the
events.  An event whose Time is not after that which
its host showed is contained in what he was told; others may be.  So he says
of an agent where it is, and not that it is one more.

*Threading*: any thread that may wait.
*/

:- multifile typhon_everywhere:answer/2.

%!  processes_overview(+Hosts, -Processes, -Silent) is det.
%
%   See overview/3.

processes_overview(Hosts, Processes, Silent) :-
    watched_places(Hosts, Places),
    everywhere(Places, overview, 5, Answers, Silent),
    findall(Process,
            ( member(place(_, Wanted, _)-Answer, Answers),
              only(Wanted, Answer, Process) ),
            Processes).

only(all, Process, Process) :-
    !.
only(Names, process(Endpoint, Pid, Hosts0, Agents0),
     process(Endpoint, Pid, Hosts, Agents)) :-
    findall(Host,
            ( member(Host, Hosts0), arg(1, Host, Address),
              address_parts(Address, Name, _), memberchk(Name, Names) ),
            Hosts),
    findall(Agent,
            ( member(Agent, Agents0), arg(2, Agent, Address),
              memberchk(host(Address, _, _, _, _), Hosts) ),
            Agents).

typhon_everywhere:answer(overview, process(Endpoint, Pid, Hosts, Agents)) :-
    endpoint_address(Endpoint),
    current_prolog_flag(pid, Pid),
    findall(Host, host_seen(Host), Hosts),
    findall(Agent, agent_seen(Agent), Agents).

host_seen(host(Address, Time, Load, Options, Links)) :-
    host(Name, Address, _),
    host_time(Name, Time),
    host_load(Name, Load),
    findall(Option,
            ( host_option(Name, Option), \+ Option = tokens(_) ), Options),
    host_neighbours(Name, Neighbours),
    findall(To-Cost,
            ( member(To, Neighbours), host_link_cost(Name, To, Cost) ),
            Links).

agent_seen(agent(Id, Address, Program, State, Hops)) :-
    agent(Id, Host, _, Hash, Life),
    host(Host, Address, _),
    code_program(Hash, program(Program, _, _, _)),
    once(agent_status(Id, Status, _)),
    once(status_shown(Status, Shown)),
    functor(Shown, State, _),
    life_hops(Life, Hops).
