:- module(typhon_wiring,
          [ wire_hosts/4,               % +Network, +P, +How, +Hosts
            wire_links/3,               % +Network, +P, +Links
            wire_goals/3,               % +Network, +P, +Goals
            wire_change/2,              % +Network, +Change
            wire_again/5,               % +Network, +P, +Hosts, +Links, +Goals
            wire_instead/3,             % +Network, +P, +Links
            wire_go_on/2,               % +Network, +P
            wire_stop_own/1,            % +Network
            wire_resting_own/2,         % +Network, :Goal
            wire_forget/1,              % +Network
            wired_host/3,               % +Network, +P, -Name
            wired_hosts/2,              % +Network, -Addresses
            wired_edges/2,              % +Network, -Edges
            wired_agents/2,             % +Network, -Agents
            wired_ended/3,              % +Network, +Name, -Agents
            wired/2                     % +Network, -Hosts
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(pairs), [pairs_keys_values/3, pairs_values/2]).
:- use_module(library(settings), [setting/2]).
:- use_module('../kernel/host', [time_kind/1]).
:- use_module('../kernel/agent', [agent_home/2]).
:- use_module(nodes, [node/3, node/4, node_order/4]).
:- use_module(restarts, [restarts_back/1]).

/** <module> The hosts of a network and the links between them

The module records for each host its number, name, address and process, and
gives the processes orders about hosts and links.

*Threading*: wire_change/2 runs in the worker that applies the dynamics,
concurrently with callers that query properties; wire_again/5 runs in the server
of module `restarts`.  A mutex excludes changes while wire_again/5 makes links.
*/

:- meta_predicate wire_resting_own(+, 0).

:- multifile
    typhon_hosts:elsewhere/2,
    typhon_names:known/2.

:- dynamic
    host/5,                     % Network, I, Name, P, Address
    changed/4.                  % Network, I, J, Change: the last of this pair

typhon_hosts:elsewhere(Name, Address) :-
    host(_, _, Name, _, Address).

typhon_names:known(host, Address) :-
    current_prolog_flag(pid, Pid),
    node(Network, P, Other),
    Other \== Pid,
    host(Network, _, _, P, Address).

%!  wire_hosts(+Network, +P, +How, +Hosts) is det.
%
%   Start Hosts, terms host(At, I, Name, Options), where At is one of the
%   processes 1..P. Each process gets one order, named How: `hosts`, or `again`
%   for hosts that existed before.
%
%   @error as node_order/4

wire_hosts(Network, P, How, Hosts) :-
    forall(between(1, P, At), start_hosts(Network, At, How, Hosts)).

start_hosts(Network, P, How, Hosts) :-
    findall(I-Name, member(host(P, I, Name, _), Hosts), Numbered),
    order_hosts(Network, P, How, Hosts, Addresses),
    pairs_keys_values(Pairs, Numbered, Addresses),
    forall(member((I-Name)-Address, Pairs),
           assertz(host(Network, I, Name, P, Address))).

order_hosts(Network, P, How, Hosts, Addresses) :-
    findall(Name-Options, member(host(P, _, Name, Options), Hosts), Specs),
    Order =.. [How, Specs],
    node_order(Network, P, Order, Addresses).

%!  wire_links(+Network, +P, +Links) is det.
%
%   Make Links, terms link(I, J, Cost). Each of the processes 1..P gets one
%   order for all ends of links at its hosts.

wire_links(Network, P, Links) :-
    order_links(Network, P, link, Links).

%!  wire_instead(+Network, +P, +Links) is det.
%
%   As wire_links/3, but also remove all other links.

wire_instead(Network, P, Links) :-
    numbered_edges(Network, Edges),
    findall(unlink(I, J, same),
            ( member(I-J, Edges), \+ memberchk(link(I, J, _), Links) ),
            Unlinks),
    order_links(Network, P, unlink, Unlinks),
    order_links(Network, P, link, Links).

order_links(Network, P, Action, Links) :-
    findall(At-Half,
            ( member(Link, Links), half_link(Network, Link, At, Half) ),
            Halves),
    forall(between(1, P, At),
           ( findall(Half, member(At-Half, Halves), Mine),
             order_halves(Network, At, Action, Mine) )).

order_halves(Network, P, Action, Halves) :-
    Order =.. [Action, Halves],
    node_order(Network, P, Order, ok).

%!  wire_go_on(+Network, +P) is det.
%
%   Resume the contents of the journals of the processes 1..P.

wire_go_on(Network, P) :-
    forall(between(1, P, At), node_order(Network, At, go_on, ok)).

%!  wire_goals(+Network, +P, +Goals) is det.
%
%   Call each Goal of Goals, pairs I-Goal, in the place of host I.
%
%   @error as node_order/4

wire_goals(Network, P, Goals) :-
    forall(between(1, P, At), order_goals(Network, At, Goals)).

order_goals(Network, P, Goals) :-
    findall(Name-Goal,
            ( host(Network, I, Name, P, _), member(I-Goal, Goals) ),
            Mine),
    (   Mine == []
    ->  true
    ;   node_order(Network, P, places(Mine), ok)
    ).

%!  wire_again(+Network, +P, +Hosts, +Links, +Goals) is det.
%
%   Process P was restarted: start those of Hosts that belong to P, make its
%   links, and call those of Goals that belong to P. Links are the initial
%   links; later changes apply to them.
%
%   @error as node_order/4

wire_again(Network, P, Hosts, Links, Goals) :-
    order_hosts(Network, P, hosts, Hosts, _),
    with_mutex(typhon_wiring, links_again(Network, P, Links)),
    order_goals(Network, P, Goals).

links_again(Network, P, Links) :-
    findall(Half,
            ( member(Link, Links),
              Link = link(I, J, _),
              \+ changed(Network, I, J, _),
              half_link(Network, Link, P, Half)
            ; changed(Network, _, _, link(I, J, Cost)),
              half_link(Network, link(I, J, Cost), P, Half) ),
            Made),
    findall(Half,
            ( changed(Network, _, _, unlink(I, J, Cost)),
              half_link(Network, unlink(I, J, Cost), P, Half) ),
            Gone),
    order_halves(Network, P, link, Made),
    order_halves(Network, P, unlink, Gone).

half_link(Network, Link, P, half(Name, Address, Cost)) :-
    Link =.. [_, A, B, Cost],
    ( I-J = A-B ; I-J = B-A ),
    host(Network, I, Name, P, _),
    host(Network, J, _, _, Address).

%!  wire_change(+Network, +Change) is det.
%
%   Change a link of Network. Change is link(I, J, Cost) or unlink(I, J, _). A
%   process that is down is skipped without a warning: its end was reported.

wire_change(Network, Change) :-
    with_mutex(typhon_wiring, change(Network, Change)).

change(Network, Change) :-
    Change =.. [Action, I, J, _],
    retractall(changed(Network, I, J, _)),
    assertz(changed(Network, I, J, Change)),
    forall(half_link(Network, Change, P, Half),
           ( Order =.. [Action, [Half]],
             alive_order(Network, P, Order, _) )).

alive_order(Network, P, Order, Answer) :-
    node(Network, P, _),
    catch(node_order(Network, P, Order, Answer),
          error(existence_error(carrier, _), _), fail),
    !.
alive_order(_, _, _, none).

%   present_order(+Network, +P, +Order, -Answer): fails for a process that is
%   not restarted. A process that dies while it has the order gets a second
%   chance, as it may be restarted.

present_order(Network, P, Order, Answer) :-
    between(1, 2, _),
    restarts_back(Network),
    alive_order(Network, P, Order, Answer),
    Answer \== none,
    !.

one_node(Network, P) :-
    findall(P0, host(Network, _, _, P0, _), Ps0),
    sort(Ps0, Ps),
    member(P, Ps).

%!  wire_stop_own(+Network) is det.
%
%   Stop the hosts in this process.  The hosts of children end with their
%   processes.

wire_stop_own(Network) :-
    current_prolog_flag(pid, Pid),
    (   node(Network, P, Pid)
    ->  findall(Name, host(Network, _, Name, P, _), Names),
        node_order(Network, P, stop(Names), ok)
    ;   true
    ).

%!  wire_resting_own(+Network, :Goal) is semidet.
%
%   Call once(Goal), which stops the hosts in this process, if there are any.
%   Meanwhile no agent runs here, so that no agent observes that others are
%   gone. In virtual time no agent runs then anyway.

wire_resting_own(Network, Goal) :-
    current_prolog_flag(pid, Pid),
    (   node(Network, P, Pid),
        time_kind(real)
    ->  setup_call_cleanup(node_order(Network, P, hold(0), ok),
                           ( rest(Network, P), once(Goal) ),
                           node_order(Network, P, let_go, ok))
    ;   once(Goal)
    ).

rest(Network, P) :-
    setting(typhon_node_process:rest_seconds, Seconds),
    node_order(Network, P, rest(Seconds, []), _).

%!  wire_forget(+Network) is det.

wire_forget(Network) :-
    retractall(host(Network, _, _, _, _)),
    retractall(changed(Network, _, _, _)).

%!  wired(+Network, -Hosts) is det.
%
%   Hosts are terms host(P, I, Name, Address), in the order of I.

wired(Network, Hosts) :-
    findall(I-host(P, I, Name, Address), host(Network, I, Name, P, Address),
            Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Hosts).

%!  wired_host(+Network, +P, -Name) is nondet.

wired_host(Network, P, Name) :-
    host(Network, _, Name, P, _).

%!  wired_hosts(+Network, -Addresses) is det.
%
%   Addresses are those of the hosts, in the order of their numbers.

wired_hosts(Network, Addresses) :-
    findall(I-Address, host(Network, I, _, _, Address), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Addresses).

%!  wired_edges(+Network, -Edges) is det.
%
%   Edges are the present links between hosts of Network: pairs of addresses, in
%   the order of the numbers. Links between hosts whose processes are down are
%   missing.

wired_edges(Network, Edges) :-
    numbered_edges(Network, Numbered),
    findall(A-B,
            ( member(I-J, Numbered),
              host(Network, I, _, _, A),
              host(Network, J, _, _, B) ),
            Edges).

numbered_edges(Network, Numbered) :-
    findall(Half, half_edge(Network, Half), Numbered0),
    sort(Numbered0, Numbered).

half_edge(Network, I-J) :-
    one_node(Network, P),
    findall(A-Name, host(Network, A, Name, P, _), Pairs),
    pairs_keys_values(Pairs, Numbers, Names),
    present_order(Network, P, neighbours(Names), Lists),
    nth1(At, Numbers, A),
    nth1(At, Lists, Addresses),
    member(Address, Addresses),
    host(Network, B, _, _, Address),
    I is min(A, B),
    J is max(A, B).

%!  wired_agents(+Network, -Agents) is det.
%
%   Agents were created on hosts of Network and have not ended. Agents created
%   in a process that is down are missing.

wired_agents(Network, Agents) :-
    findall(Agent,
            ( one_node(Network, P),
              present_order(Network, P, agents, Born),
              member(Agent, Born),
              agent_home(Agent, Home),
              host(Network, _, _, P, Home) ),
            Agents).

%!  wired_ended(+Network, +Name, -Agents) is det.
%
%   Agents are the ended agents named Name that were created on hosts of Network
%   in other processes, as far as these processes remember them.

wired_ended(Network, Name, Agents) :-
    findall(Agent,
            ( one_node(Network, P),
              node(Network, P, _, Where),
              Where \== local,
              present_order(Network, P, ended(Name), Ended),
              member(Agent, Ended) ),
            Agents).
