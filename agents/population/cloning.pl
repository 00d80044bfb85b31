/*  The stigmergic cloning controller: a room for agents whose number is to
    follow the demand for them (thesis section 6.2).  To be included.

    An agent lives by going from queue to queue.  On its turn it does what
    its program says, is charged, and moves on after a tick.  After a reward
    it clones itself into the free slots of the queue if it can afford it.
    Clones die when their lifetime is over, which falls by one with each
    tick in a queue; the agent that was created, not cloned, never dies.

    The program that includes this room calls live/0 and says two things:

        visit(-Reward)      what it does on its turn at a host; Reward is 1
                            if that was a service, else 0
        fertile             true while it may clone

    The names of the parameters are those of the thesis; facts
    setting(Name, Value) replace the defaults.
*/

:- include(resource).
:- use_module(library(lists)).
:- dynamic setting/2, resource/1, lifetime/1, arrival/1.
:- discontiguous default/2.

default(q_th, 4).               % slots of a queue
default(cr_min, 10).            % conferred on a clone
default(cr_max, 100).
default(cr_start, 10).          % of an agent that is no clone
default(alpha_c, 0.1).          % inherent charging
default(alpha_r, 15).           % charging by a reward
default(c_l, 7).                % lifetime for a reward
default(lifetime, 10).          % of a clone
default(rounding, round).       % or `floor`
default(replication, rewarded). % or `always`: also without a reward
default(tick, 1).               % seconds: the step of time
default(strategy, conscientious).

parameter(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value)
    ).

live :-
    parameter(cr_start, Resource),
    keep_resource(Resource),
    keep_lifetime(inf),
    stay.

stay :-
    now(Now),
    retractall(arrival(_)),
    assertz(arrival(Now)),
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

%   At a host without a queue it is always an agent's turn.

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

%   The turn lasts a tick.  Fails where the agent has to stay: then it has
%   left the queue, and joins it again at the tail.

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

%   left(-Seconds): until the lifetime is over, in a queue.

left(inf) :-
    lifetime(inf),
    !.
left(Seconds) :-
    lifetime(Lifetime),
    parameter(tick, Tick),
    Seconds is Lifetime * Tick.

age(_) :-
    lifetime(inf),
    !.
age(Since) :-
    now(Now),
    parameter(tick, Tick),
    lifetime(Lifetime0),
    Lifetime is Lifetime0 - (Now - Since)/Tick,
    keep_lifetime(Lifetime),
    (   Lifetime > 0
    ->  true
    ;   die
    ).

%   A turn may be on its way to who is about to die; what the queue answers
%   comes behind it.

die :-
    log(state(death)),
    (   sense(queue(Queue))
    ->  send(Queue, quit),
        parameter(tick, Tick),
        ignore(receive(Queue-gone, Tick))
    ;   true
    ),
    dispose.

                /*******************************
                *       REWARDS, CLONING       *
                *******************************/

gain(Reward, Length) :-
    parameter(q_th, Capacity),
    parameter(alpha_c, Inherent),
    parameter(alpha_r, Bonus),
    parameter(cr_max, Maximum),
    parameter(c_l, Extension),
    pressure(Capacity, Length, Pressure),
    resource(Resource0),
    recharged(Resource0, Pressure, Reward, charge(Inherent, Bonus, Maximum),
              Resource),
    keep_resource(Resource),
    lifetime(Lifetime0),
    prolonged(Lifetime0, Reward, Extension, Lifetime),
    keep_lifetime(Lifetime),
    (   Reward =:= 1
    ->  log(resource(Resource))
    ;   true
    ).

%   Role is `clone` in the clones, which wait for their turn at this host,
%   and `parent` in the agent that made them, if it made any.

replicate(Reward, Length, Role) :-
    fertile,
    (   Reward =:= 1
    ->  true
    ;   parameter(replication, always)
    ),
    !,
    affordable(Length, Count),
    multiply(Count, Role).
replicate(_, _, parent).

affordable(Length, Count) :-
    parameter(q_th, Capacity),
    parameter(rounding, Rounding),
    parameter(cr_max, Maximum),
    parameter(cr_min, Minimum),
    pressure(Capacity, Length, Pressure),
    resource(Resource),
    clones(Rounding, Pressure, Resource, Maximum, Count0),
    conferred(Resource, Count0, Minimum, _, Count).

%   What is conferred is taken clone by clone: where agents that are about
%   to join the queue have taken a slot, fewer are made.

multiply(0, Role) :-
    !,
    Role = parent.
multiply(Count, Role) :-
    log(state(replicate)),
    catch(clone(Who), error(move_refused(_, _), _), Who = refused),
    multiplied(Who, Count, Role).

multiplied(refused, _, parent).
multiplied(clone(_), _, clone) :-
    newborn.
multiplied(parent(_), Count0, Role) :-
    parameter(cr_min, Minimum),
    resource(Resource0),
    Resource is Resource0 - Minimum,
    keep_resource(Resource),
    log(resource(Resource)),
    Count is Count0 - 1,
    multiply(Count, Role).

%   A clone has been nowhere else, and chooses its ways by itself.

newborn :-
    log(cloned),
    parameter(cr_min, Resource),
    keep_resource(Resource),
    parameter(lifetime, Lifetime),
    keep_lifetime(Lifetime),
    retractall('$memory'(_)).

keep_resource(Resource) :-
    retractall(resource(_)),
    assertz(resource(Resource)).

keep_lifetime(Lifetime) :-
    retractall(lifetime(_)),
    assertz(lifetime(Lifetime)).
