:- module(typhon_wiring,
          [ wire_hosts/3,               % +Network, +P, +Hosts
            wire_links/3,               % +Network, +P, +Links
            wire_goals/3,               % +Network, +P, +Goals
            wire_change/2,              % +Network, +Change
            wire_stop_own/1,            % +Network
            wire_forget/1,              % +Network
            wired_hosts/2,              % +Network, -Addresses
            wired_edges/2,              % +Network, -Edges
            wired_agents/2              % +Network, -Agents
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(pairs), [pairs_keys_values/3, pairs_values/2]).
:- use_module('../agent', [agent_home/2]).
:- use_module(carriers, [carrier/3, carrier_order/4]).

/** <module> The hosts of a network and the links between them

Knows which host, by number, name and address, is in which process, and
gives the carriers their orders about hosts and links.

*Threading*: wire_change/2 runs in the thread of the dynamics, beside
whoever asks for properties.
*/

:- multifile typhon_names:known/2.

:- dynamic
    host/5.                     % Network, I, Name, P, Address

typhon_names:known(host, Address) :-
    current_prolog_flag(pid, Pid),
    carrier(Network, P, Other),
    Other \== Pid,
    host(Network, _, _, P, Address).

%!  wire_hosts(+Network, +P, +Hosts) is det.
%
%   Starts Hosts, terms host(At, I, Name, Options), At one of the carriers
%   1..P. Each carrier gets one order.
%
%   @error as carrier_order/4

wire_hosts(Network, P, Hosts) :-
    forall(between(1, P, At), start_hosts(Network, At, Hosts)).

start_hosts(Network, P, Hosts) :-
    findall(I-Name, member(host(P, I, Name, _), Hosts), Numbered),
    findall(Name-Options, member(host(P, _, Name, Options), Hosts), Specs),
    carrier_order(Network, P, hosts(Specs), Addresses),
    pairs_keys_values(Pairs, Numbered, Addresses),
    forall(member((I-Name)-Address, Pairs),
           assertz(host(Network, I, Name, P, Address))).

%!  wire_links(+Network, +P, +Links) is det.
%
%   Makes Links, terms link(I, J, Cost). Each of the carriers 1..P hears in
%   one order of all the ends of links in it.

wire_links(Network, P, Links) :-
    findall(At-Half,
            ( member(Link, Links), half_link(Network, Link, At, Half) ),
            Halves),
    forall(between(1, P, At),
           ( findall(Half, member(At-Half, Halves), Mine),
             carrier_order(Network, At, link(Mine), ok) )).

%!  wire_goals(+Network, +P, +Goals) is det.
%
%   Calls Goals, pairs I-Goal, in the places of hosts I.
%
%   @error as carrier_order/4

wire_goals(Network, P, Goals) :-
    findall(At-(Name-Goal),
            ( member(I-Goal, Goals), host(Network, I, Name, At, _) ),
            All),
    forall(( between(1, P, At), memberchk(At-_, All) ),
           ( findall(Pair, member(At-Pair, All), Mine),
             carrier_order(Network, At, places(Mine), ok) )).

half_link(Network, Link, P, half(Name, Address, Cost)) :-
    Link =.. [_, A, B, Cost],
    ( I-J = A-B ; I-J = B-A ),
    host(Network, I, Name, P, _),
    host(Network, J, _, _, Address).

%!  wire_change(+Network, +Change) is det.
%
%   Change is link(I, J, Cost) or unlink(I, J, _). A process that is down was
%   reported when it went down, and is left alone.

wire_change(Network, Change) :-
    functor(Change, Action, _),
    forall(half_link(Network, Change, P, Half),
           ( Order =.. [Action, [Half]],
             alive_order(Network, P, Order, _) )).

alive_order(Network, P, Order, Answer) :-
    carrier(Network, P, _),
    catch(carrier_order(Network, P, Order, Answer),
          error(existence_error(carrier, _), _), fail),
    !.
alive_order(_, _, _, none).

%!  wire_stop_own(+Network) is det.
%
%   Stops the hosts in this process; those of children end with them.

wire_stop_own(Network) :-
    current_prolog_flag(pid, Pid),
    (   carrier(Network, P, Pid)
    ->  findall(Name, host(Network, _, Name, P, _), Names),
        carrier_order(Network, P, stop(Names), ok)
    ;   true
    ).

%!  wire_forget(+Network) is det.

wire_forget(Network) :-
    retractall(host(Network, _, _, _, _)).

%!  wired_hosts(+Network, -Addresses) is det.
%
%   In the order of their numbers.

wired_hosts(Network, Addresses) :-
    findall(I-Address, host(Network, I, _, _, Address), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Addresses).

%!  wired_edges(+Network, -Edges) is det.
%
%   The links of this moment between hosts of Network, pairs of addresses,
%   by number. Those that only hosts in a process that is down would know
%   are missing.

wired_edges(Network, Edges) :-
    findall(Half, half_edge(Network, Half), Numbered0),
    sort(Numbered0, Numbered),
    findall(A-B,
            ( member(I-J, Numbered),
              host(Network, I, _, _, A),
              host(Network, J, _, _, B) ),
            Edges).

half_edge(Network, I-J) :-
    carrier(Network, P, _),
    findall(A-Name, host(Network, A, Name, P, _), Pairs),
    pairs_keys_values(Pairs, Numbers, Names),
    alive_order(Network, P, neighbours(Names), Lists),
    Lists \== none,
    nth1(At, Numbers, A),
    nth1(At, Lists, Addresses),
    member(Address, Addresses),
    host(Network, B, _, _, Address),
    I is min(A, B),
    J is max(A, B).

%!  wired_agents(+Network, -Agents) is det.
%
%   Agents that were born on hosts of Network and have not ended. Those born
%   in a process that is down are missing.

wired_agents(Network, Agents) :-
    findall(Agent,
            ( carrier(Network, P, _),
              alive_order(Network, P, agents, Born),
              Born \== none,
              member(Agent, Born),
              agent_home(Agent, Home),
              host(Network, _, _, P, Home) ),
            Agents).
