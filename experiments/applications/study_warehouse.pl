%   A warehouse: allocated robots execute tasks in step or alone.

:- use_module('../../examples/applications/warehouse/scene',
              [scene_network/3, scene_orders/4, scene_start/2, scene_stop/0]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).
:- use_module('../../prolog/typhon', [network_advance/2, remote/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, nextto/3]).

study(warehouse, "ROS robots that carry loads, alone and together").
text("Allocators find a robot for each of six pallets, and two or three \c
robots for each of three beams, while robots are held by others. With a beam \c
robots execute four tasks: drive to a corner, take it, carry it, and put it \c
down; in step, by agents that travel between them with the penalty bias \c
delta, or alone, each as soon as it can. A beam falls if the robots are not \c
together. examples/applications/warehouse/floor.pl and scene.pl define the \c
world and its assumptions; agents control the robots over rosbridge.").

vary(way, [in_step, alone]).
vary(robots, [4, 6, 8]).
vary(delta, [0.5, 2, 8, 32]).
skip(Case) :-
    Case.way == alone,
    Case.delta =\= 0.5.
fixed(pallets, 6, assumed("one robot each")).
fixed(beams, 3, assumed("two or three robots each")).
fixed(limit, 1500, assumed("seconds to wait for all orders")).

network(Case, Topology, Options) :-
    scene_network([robots(Case.robots)], Topology, Options).

run(Case, Network) :-
    call_cleanup(
        ( scene_start(Network,
                      [ seed(Case.seed), robots(Case.robots), way(Case.way),
                        pallets(Case.pallets), beams(Case.beams),
                        delta(Case.delta) ]),
          until_over(Network, Case.limit),
          scene_orders(Delivered, Waiting, Underway, Falls),
          Open is Waiting+Underway,
          remote(office, log(orders(Delivered, Open, Falls))) ),
        scene_stop).

until_over(Network, Left) :-
    scene_orders(_, Waiting, Underway, _),
    (   ( Waiting+Underway =:= 0 ; Left =< 0 )
    ->  true
    ;   network_advance(Network, 10),
        Left1 is Left-10,
        until_over(Network, Left1)
    ).

label(time, "Seconds until all orders are over").
label(delivered, "Loads delivered").
label(falls, "Beams that have fallen").
label(early, "Tasks begun before the previous one was completed").
label(held, "Robots held by two orders, or held at the end").
label(backoffs, "Back-offs of allocators").

measure(time, Log, Time) :-
    aggregate_all(max(At), member(event(At, _, _, completed(_)), Log.events),
                  Time).
measure(delivered, Log, Count) :-
    member(event(_, _, _, orders(Count, _, _)), Log.events).
measure(falls, Log, Count) :-
    member(event(_, _, _, orders(_, _, Count)), Log.events).
measure(early, Log, Count) :-
    aggregate_all(count, early(Log.events), Count).
measure(held, Log, Count) :-
    reservation_faults(Log.events, Faults),
    length(Faults, Count).
measure(backoffs, Log, Count) :-
    aggregate_all(count, member(event(_, _, _, backoff(_)), Log.events), Count).

early(Events) :-
    member(event(Begin, _, _, executing(Order, Task)), Events),
    nextto(Before, Task, [approach, lift, carry, lower]),
    member(event(_, Host, _, executing(Order, Before)), Events),
    \+ ( member(event(End, Host, _, completed(Order, Before)), Events),
         End =< Begin ).

claim("no robot is held by two orders, or held at the end", [], held =:= 0).
claim("in step no task begins before all robots of a beam have the one before, \c
with a bias up to 2", [],
      ( at([way=in_step, delta=0.5], early =:= 0),
        at([way=in_step, delta=2], early =:= 0) )).
claim("in step no task begins early with a bias of 8",
      [], at([way=in_step, delta=8], early =:= 0)).
claim("in step no beam falls", [], at([way=in_step], falls =:= 0)).
claim("in step all loads arrive", [],
      at([way=in_step], delivered =:= pallets+beams)).
claim("alone some beams fall", [], at([way=alone], falls > 0)).
claim("in step more robots complete all orders sooner", [],
      at([way=in_step], falls(time, along(robots)))).
claim("in step a greater bias completes all orders sooner", [],
      at([way=in_step], falls(time, along(delta)))).
claim("alone all orders are completed sooner than in step with bias 0.5", [],
      at([delta=0.5], at([way=alone], time) < at([way=in_step], time))).

plot(warehouse,
     "Time until all orders are over in step, and tasks begun too early",
     lines([x(robots), y([time, early]), line(delta), where([way=in_step])])).
