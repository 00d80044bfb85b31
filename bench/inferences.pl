:- use_module(common).
:- use_module(traveller, [travelled/4]).
:- use_module(library(typhon)).
:- use_module(library(aggregate), [aggregate_all/3]).

/*  What hops and messages cost in inferences of all threads of this process:
hardly more or less where others use the machine.  Of hops between processes
those of one side, on which half of them begin and half end.

    swipl bench/inferences.pl -- 4000 */

:- initialization(main, main).

:- meta_predicate told(+, +, 0).

main([Argument]) :-
    atom_number(Argument, Count),
    within(Count),
    host_start(here),
    message_to(here, 'a message within a process', Count),
    with_peer([env], outwards(Count)),
    host_stop(here).

within(Count) :-
    host_start(here, [clock(virtual)]),
    host_start(there, [clock(virtual)]),
    host_property(there, address(There)),
    hops('a hop within a process, virtual time', 1, Count, There),
    host_stop(there),
    host_stop(here).

outwards(Count, Peer) :-
    hops('a hop of one agent between processes', 1, Count, Peer),
    hops('a hop of ten agents between processes', 10, Count, Peer),
    message_to(Peer, 'a message to another process, here', Count).

hops(Name, Agents, Count, Peer) :-
    told(Name, Count, travelled(Agents, Count, Peer, _)).

message_to(Host, Name, Count) :-
    told(Name, Count, counted(Host, Count)).

counted(Host, Count) :-
    agent_create(clauses([ (:- agent(counter, [state([left/1])])),
                           (main :- left(N), count(N)),
                           (count(0) :- !),
                           (count(N) :- receive(_), N1 is N-1, count(N1)) ]),
                 Agent, [host(Host), facts([left(Count)])]),
    forall(between(1, Count, I), agent_send(Agent, message(I))),
    agent_join(Agent, done, 300).

told(Name, Count, Goal) :-
    \+ \+ call(Goal),                   % warm up
    inferences(Before),
    \+ \+ call(Goal),
    inferences(After),
    Each is (After-Before)/Count,
    figure(Name, Each, inferences).

inferences(Sum) :-
    aggregate_all(sum(I),
                  ( thread_property(Thread, status(running)),
                    catch(thread_statistics(Thread, inferences, I),
                          error(_, _), fail) ),
                  Sum).
