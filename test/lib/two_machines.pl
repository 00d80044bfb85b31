/* The processes of test_two_machines.pl, each in its own network namespace.
*/

:- use_module(common).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/network)).

%   The interfaces over which a network of six hosts is spread, and the facts
%   that an agent collects on all of them.

network_over(Here, There, Rsh) :-
    set_setting(typhon_children:ssh, Rsh),
    network_start(ring(6), Network,
                  [ bind(Here), machines([local, There]) ]),
    network_property(Network, hosts(Hosts)),
    findall(Interface,
            ( member(Host, Hosts), interface(Host, Interface) ), Interfaces),
    Hosts = [First|_],
    agent_create(clauses([ (:- agent(rounder, [state([at/1])])),
                           ( main :- here(H), assertz(at(H)), step(6) ),
                           ( step(0) :- !, findall(H, at(H), Hs),
                                        sort(Hs, Set), length(Set, N),
                                        leave(round(N)) ),
                           ( step(N) :- next(H), move(H),
                                        assertz(at(H)), N1 is N - 1,
                                        step(N1) ),
                           ( next(H) :- neighbours(Hs), member(H, Hs),
                                        \+ at(H), ! ),
                           ( next(H) :- home(H) ) ]),
                 Agent, [host(First)]),
    agent_join(Agent, Outcome, 30),
    remote(First, take(round(Count))),
    network_stop(Network),
    say(network(Interfaces, Outcome, Count)).

interface(Host, Interface) :-
    atomic_list_concat([_, Endpoint], @, Host),
    atomic_list_concat([Interface, _], :, Endpoint).

%   A host by itself, until standard input ends.

host_at(Name, Interface) :-
    host_start(Name, [bind(Interface)]),
    host_property(Name, address(Address)),
    say(Address),
    read(user_input, _),
    host_stop(Name).

%   An agent goes from a host here to Far and back.

visit(Interface, Far) :-
    host_start(near, [bind(Interface)]),
    catch(visit(Far), error(Formal, _), say(error(Formal))),
    host_stop(near).

visit(Far) :-
    link(near, Far),
    agent_create(clauses([ (:- agent(visitor, [])),
                           ( main :- neighbours([H]), move(H), here(There),
                                     home(Home), move(Home),
                                     leave(seen(There)) ) ]),
                 Agent, [host(near)]),
    agent_join(Agent, Outcome, 20),
    remote(near, take(seen(There))),
    say(visited(Outcome, There)).

say(Term) :-
    format("~q.~n", [Term]),
    flush_output.
