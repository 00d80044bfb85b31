/* The processes of test_several_machines.pl.
*/

:- use_module(common).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/network)).

%   The interfaces over which a network of two hosts for each of Machines is
%   spread, and the number of hosts that an agent visits on its round.

network_over(Machines) :-
    getenv('TYPHON_BIND', Here),
    length(Machines, Count),
    N is 2*Count,
    network_start(ring(N), Network, [bind(Here), machines(Machines)]),
    network_property(Network, hosts(Hosts)),
    findall(Interface,
            ( member(Host, Hosts), interface(Host, Interface) ), Interfaces),
    Hosts = [First|_],
    agent_create(clauses([ (:- agent(rounder, [state([at/1])])),
                           ( main :- here(H), assertz(at(H)), step(N) ),
                           ( step(0) :- !, findall(H, at(H), Hs),
                                        sort(Hs, Set), length(Set, Seen),
                                        leave(round(Seen)) ),
                           ( step(I) :- next(H), move(H),
                                        assertz(at(H)), I1 is I - 1,
                                        step(I1) ),
                           ( next(H) :- neighbours(Hs), member(H, Hs),
                                        \+ at(H), ! ),
                           ( next(H) :- home(H) ) ]),
                 Agent, [host(First)]),
    agent_join(Agent, Outcome, 30),
    remote(First, take(round(Seen))),
    network_stop(Network),
    say(network(Interfaces, Outcome, Seen)).

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

%   The process that Command starts has a host; an agent goes there and back.

visit(Command) :-
    getenv('TYPHON_BIND', Here),
    getenv('TYPHON_MACHINES', Machine),
    process_create(path(ssh), [Machine, Command],
                   [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
    read(Out, Far),
    host_start(near, [bind(Here)]),
    catch(visit_at(Far), error(Formal, _), say(error(Formal))),
    host_stop(near),
    close(In),
    process_wait(Pid, _).

visit_at(Far) :-
    link(near, Far),
    agent_create(clauses([ (:- agent(visitor, [])),
                           ( main :- neighbours([H]), move(H), here(There),
                                     home(Home), move(Home),
                                     leave(seen(There)) ) ]),
                 Agent, [host(near)]),
    agent_join(Agent, Outcome, 20),
    remote(near, take(seen(There))),
    say(visited(Outcome, Far, There)).

say(Term) :-
    format("~q.~n", [Term]),
    flush_output.
