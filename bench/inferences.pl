:- use_module(common).
:- use_module(traveller, [travelled/4]).
:- use_module(library(typhon)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).

/*  Inferences of hops and messages in all threads of this process, which
    hardly depend on other load of the machine. For hops between processes
    they are the inferences of one side, which sends half of the hops and
    receives the other half.

    swipl bench/inferences.pl -- 4000 */

:- initialization(main, main).

:- meta_predicate report(+, +, 0).

main([Argument]) :-
    atom_number(Argument, Count),
    within(Count),
    host_start(here),
    message_to(here, 'a message within a process', Count),
    report('an agent of a known program created, with its end', Count,
           created(Count)),
    with_peer([env], outwards(Count)),
    host_stop(here).

%   On a ring of three processes every third hop leaves this process, and every
%   third hop arrives in it.

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
    report('a clone sent to another process, with its end', Count,
           cloned(Peer, Count)),
    message_to(Peer, 'a message to another process, here', Count),
    with_peer([env], around(Peer, Count)).

around(Peer, Count, Other) :-
    report('a hop of one agent round three processes', Count*2/3,
           ring([Peer,Other], Count)).

hops(Name, Agents, Count, Peer) :-
    report(Name, Count, travelled(Agents, Count, Peer, _)).

message_to(Host, Name, Count) :-
    report(Name, Count, counted(Host, Count)).

created(Count) :-
    Program = clauses([(:- agent(known, [])), on_message(_, _)]),
    findall(Agent,
            ( between(1, Count, _), agent_create(Program, Agent) ),
            Agents),
    forall(member(Agent, Agents), agent_dispose(Agent)).

cloned(Peer, Count) :-
    agent_create(clauses([ (:- agent(spreader, [state([left/1])])),
                           (main :- left(N), spread(N)),
                           (spread(0) :- !),
                           (spread(N) :- clone(Peer, Branch),
                                         ( Branch = clone(_) -> true
                                         ; N1 is N-1, spread(N1) )) ]),
                 Agent, [facts([left(Count)])]),
    agent_join(Agent, done, 300).

ring(Others, Count) :-
    Rounds is Count//3,
    agent_create(clauses([ (:- agent(walker, [state([left/1,way/1])])),
                           (main :- left(N), way(Way), rounds(N, Way)),
                           (rounds(0, _) :- !),
                           (rounds(N, Way) :- round(Way), home(H), move(H),
                                              N1 is N-1, rounds(N1, Way)),
                           round([]),
                           (round([P|Ps]) :- move(P), round(Ps)) ]),
                 Agent, [facts([left(Rounds), way(Others)])]),
    agent_join(Agent, done, 300).

counted(Host, Count) :-
    agent_create(clauses([ (:- agent(counter, [state([left/1])])),
                           (main :- left(N), count(N)),
                           (count(0) :- !),
                           (count(N) :- receive(_), N1 is N-1, count(N1)) ]),
                 Agent, [host(Host), facts([left(Count)])]),
    forall(between(1, Count, I), agent_send(Agent, message(I))),
    agent_join(Agent, done, 300).

report(Name, Count, Goal) :-
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
