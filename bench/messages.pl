:- use_module(common).
:- use_module(library(typhon)).

/*  Messages per second, from a sender in one process to an agent that
counts them in the same process or in another. */

:- initialization(main, main).

main([_]) :-
    host_start(here),
    counter(Program),
    counted(here, Program, 5000, _),    % warm up
    counted(here, Program, 100000, Local),
    figure('messages per second, one process', Local, '1/s'),
    with_peer([env], remote_messages(Program)),
    host_stop(here).

remote_messages(Program, Peer) :-
    counted(Peer, Program, 5000, _),
    counted(Peer, Program, 50000, Remote),
    figure('messages per second, two processes', Remote, '1/s').

counter(clauses([ (:- agent(counter, [state([left/1])])),
                  (main :- left(N), count(N)),
                  (count(0) :- !),
                  (count(N) :- receive(_), N1 is N-1, count(N1)) ])).

counted(Host, Program, Count, Rate) :-
    agent_create(Program, Agent, [host(Host), facts([left(Count)])]),
    seconds(( forall(between(1, Count, I), agent_send(Agent, message(I))),
              agent_join(Agent, done, 300)
            ),
            Seconds),
    Rate is Count/Seconds.
