:- module(typhon_watched_hosts,
          [ watched_places/2,           % +Hosts, -Places
            ask_processes/5,            % +Places, +Question, +Seconds,
                                        % -Answers, -Silent
            processes_overview/3        % +Hosts, -Processes, -Silent
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_ask_all/6, endpoint_reply/2 ]).
:- use_module('../../kernel/host',
              [ address_parts/3, as_guest/1, host/3, host_link_cost/3,
                host_listed/2, host_load/2, host_neighbours/2, host_option/2,
                host_resolve/2, host_time/2, scheduler_call/1 ]).
:- use_module('../../network', [network_hosts/2]).
:- use_module('../../kernel/program', [code_program/2]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3, life_hops/2]).
:- use_module('../../tools/administration', [status_shown/2]).

/** <module> Watched hosts, and questions to their processes

Modules that ask all processes of a watch define the hook answer/2.

A caller knows the state of hosts exactly if it begins to watch, then requests
the overview, and then handles the events.  The overview contains each event
whose time is not after that of its host in the overview, and may contain later
ones.  So it states where an agent is, which a repeated event does not change,
and has no counts.

*Threading*: any thread that may wait, but not those of the endpoint.  Workers
answer, since an answer may be long.
*/

:- multifile
    answer/2,                   % Question, Answer
    typhon_endpoint:requested/4.

%!  watched_places(+Hosts, -Places) is det.
%
%   Hosts is the name or the address of a host, a network, or a list of hosts
%   and networks.  Places are place(Endpoint, Wanted, Whose): Wanted is `all` if
%   the process belongs to a network, otherwise a list of names of hosts.  Whose
%   is asked(Hosts), pairs Name-Host for the hosts in the process that the
%   caller has named, which must exist, or carried(Addresses), the hosts of a
%   network.
%
%   @error existence_error(host, Host), ambiguous_host(Name, Addresses)

watched_places(Hosts, Places) :-
    host_listed(Hosts, List),
    findall(Endpoint-What,
            ( member(One, List), host_process(One, Endpoint, What) ),
            Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(place(Endpoint, Wanted, Whose),
            ( member(Endpoint-Whats, Groups),
              wanted(Whats, Wanted),
              whose(Whats, Whose) ),
            Places).

host_process(One, Endpoint, What) :-
    must_be(atom, One),
    (   hosts_of_network(One, Addresses)
    ->  member(Address, Addresses),
        address_parts(Address, Name, Endpoint),
        (   endpoint_address(Endpoint)
        ->  What = part(Name)
        ;   What = carried(Address)
        )
    ;   host_resolve(One, Where),
        process_of(Where, One, Endpoint, What)
    ).

hosts_of_network(Network, Addresses) :-
    catch(network_hosts(Network, Addresses),
          error(existence_error(network, _), _),
          fail).

process_of(local(Name), One, Endpoint, host(Name, One)) :-
    endpoint_address(Endpoint),
    !.
process_of(remote(Address, Name, Endpoint), _, Endpoint, host(Name, Address)).

wanted(Whats, Wanted) :-
    (   memberchk(carried(_), Whats)
    ->  Wanted = all
    ;   findall(Name,
                ( member(host(Name, _), Whats)
                ; member(part(Name), Whats) ),
                Names),
        sort(Names, Wanted)
    ).

whose(Whats, Whose) :-
    findall(Name-Host, member(host(Name, Host), Whats), Asked),
    (   Asked == []
    ->  findall(Address, member(carried(Address), Whats), Addresses),
        Whose = carried(Addresses)
    ;   Whose = asked(Asked)
    ).

                /*******************************
                *  QUESTIONS TO ALL PROCESSES  *
                *******************************/

%!  ask_processes(+Places, +Question, +Seconds, -Answers, -Silent) is det.
%
%   Send Question to the processes of Places, see watched_places/2, in which the
%   hook answer(Question, Answer) gives the answer.  Answers are pairs
%   Place-Answer for those that have answered within Seconds; Silent are the
%   endpoints of the others.

ask_processes(Places, Question, Seconds, Answers, Silent) :-
    partition(is_here, Places, Here, There),
    findall(Place-Answer,
            ( member(Place, Here), answer_to(Question, Answer) ), Own),
    ask(There, Question, Seconds, Results),
    findall(Place-Answer,
            ( member(Place, There),
              Place = place(Endpoint, _, _),
              memberchk(Endpoint-answer(Answer), Results) ),
            Others),
    append(Own, Others, Answers),
    findall(Endpoint,
            ( member(Endpoint-Result, Results), Result \= answer(_) ),
            Silent).

is_here(place(Endpoint, _, _)) :-
    endpoint_address(Endpoint).

ask([], _, _, []) :-
    !.
ask(Places, Question, Seconds, Results) :-
    findall(Endpoint, member(place(Endpoint, _, _), Places), Endpoints),
    as_guest(endpoint_ask_all(Endpoints, everywhere, Question,
                              typhon_watched_hosts:no_forward, Seconds,
                              Results)).

:- public
    no_forward/2,
    answer_request/2.           % goal of a worker

no_forward(_, []).

typhon_endpoint:requested(everywhere, Question, _, ReplyTo) :-
    scheduler_call(typhon_watched_hosts:answer_request(Question, ReplyTo)).

answer_request(Question, ReplyTo) :-
    answer_to(Question, Answer),
    endpoint_reply(ReplyTo, Answer).

answer_to(Question, Answer) :-
    once(answer(Question, Answer)).

                /*******************************
                *           OVERVIEW           *
                *******************************/

%!  processes_overview(+Hosts, -Processes, -Silent) is det.
%
%   See overview/3.

processes_overview(Hosts, Processes, Silent) :-
    watched_places(Hosts, Places),
    ask_processes(Places, overview, 5, Answers, Silent),
    findall(Process,
            ( member(place(_, Wanted, _)-Answer, Answers),
              wanted_part(Wanted, Answer, Process) ),
            Processes).

wanted_part(all, Process, Process) :-
    !.
wanted_part(Names, process(Endpoint, Pid, Hosts0, Agents0),
            process(Endpoint, Pid, Hosts, Agents)) :-
    findall(Host,
            ( member(Host, Hosts0), arg(1, Host, Address),
              address_parts(Address, Name, _), memberchk(Name, Names) ),
            Hosts),
    findall(Agent,
            ( member(Agent, Agents0), arg(2, Agent, Address),
              memberchk(host(Address, _, _, _, _), Hosts) ),
            Agents).

answer(overview, process(Endpoint, Pid, Hosts, Agents)) :-
    endpoint_address(Endpoint),
    current_prolog_flag(pid, Pid),
    findall(Host, host_state(Host), Hosts),
    findall(Agent, agent_state(Agent), Agents).

host_state(host(Address, Time, Load, Options, Links)) :-
    host(Name, Address, _),
    host_time(Name, Time),
    host_load(Name, Load),
    findall(Option,
            ( host_option(Name, Option), \+ Option = tokens(_) ), Options),
    host_neighbours(Name, Neighbours),
    findall(To-Cost,
            ( member(To, Neighbours), host_link_cost(Name, To, Cost) ),
            Links).

agent_state(agent(Id, Address, Program, State, Hops)) :-
    agent(Id, Host, _, Hash, Life),
    host(Host, Address, _),
    code_program(Hash, program(Program, _, _, _)),
    once(agent_status(Id, Status, _)),
    once(status_shown(Status, Shown)),
    functor(Shown, State, _),
    life_hops(Life, Hops).
