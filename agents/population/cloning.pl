% Expects: visit/1, fertile/0 of the program.
% Gives: live/0; also parameters, keep and clones of lib, and replication.

/*  The stigmergic cloning controller: it adapts the number of agents to the
    demand for them (thesis section 6.2).

    An agent moves from queue to queue. On its turn it runs visit/1 of its
    program, its resource is charged, and it moves on after a tick. After a
    reward it clones itself into the free slots of the queue if its resource
    suffices. Clones die when their lifetime is over, which decreases by one
    with each tick in a queue; an agent that was created, not cloned, never
    dies.

    The program that includes this file calls live/0 and defines:

        visit(-Reward)      the action of the agent on its turn at a host;
                            Reward is 1 if that was a service, else 0
        fertile             true while the agent may clone

    The names of the parameters are those of the thesis; facts
    setting(Name, Value) replace the defaults.
*/

:- discontiguous default/4.
:- include('../lib/parameters').
:- include('../lib/keep').
:- include('../lib/clones').
:- include(replication).
:- use_module(library(lists)).
:- dynamic arrival/1.

default(tick, 1, range(0.1, 10, 0.1), "seconds: the step of time").
default(strategy, conscientious, ground, "of migration, see next_host/2").

live :-
    endowed,
    stay.

stay :-
    now(Now),
    keep(arrival(Now)),
    turns.

turns :-
    await_turn(Length),
    visit(Reward),
    gain(Reward, Length),
    replicate(Reward, Length, Role),
    (   Role == parent,
        depart
    ->  stay
    ;   turns
    ).

                /*******************************
                *           THE QUEUE          *
                *******************************/

%   At a host without a queue the agent never waits for its turn.

await_turn(Length) :-
    sense(queue(Queue)),
    !,
    now(Since),
    send(Queue, join),
    left(Seconds),
    (   receive(Queue-turn(Length0), Seconds)
    ->  Length = Length0,
        age(Since)
    ;   die
    ).
await_turn(Length) :-
    host_load(Length).

%   The turn lasts a tick.  Fails if the agent cannot move: then it has left
%   the queue, and joins it again at the tail.

depart :-
    now(Since),
    parameter(tick, Tick),
    left(Left),
    (   Left == inf
    ->  sleep(Tick)
    ;   Seconds is min(Tick, Left),
        sleep(Seconds)
    ),
    age(Since),
    leave_queue,
    parameter(strategy, Strategy),
    next_host(Strategy, Host),
    catch(move(Host), error(_, _), fail).

leave_queue :-
    sense(queue(Queue)),
    !,
    send(Queue, leave).
leave_queue.

                /*******************************
                *           LIFETIME           *
                *******************************/

%   left(-Seconds): time until the lifetime is over, in a queue.

left(inf) :-
    lifetime(inf),
    !.
left(Seconds) :-
    lifetime(Lifetime),
    parameter(tick, Tick),
    Seconds is Lifetime * Tick.

age(Since) :-
    now(Now),
    parameter(tick, Tick),
    Ticks is (Now - Since)/Tick,
    older(Ticks).

%   The queue may have sent a turn to an agent that is about to die; the
%   answer `gone` arrives after that turn.

die :-
    log(state(death)),
    (   sense(queue(Queue))
    ->  send(Queue, quit),
        parameter(tick, Tick),
        ignore(receive(Queue-gone, Tick))
    ;   true
    ),
    dispose.
