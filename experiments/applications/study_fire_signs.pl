%   Exit signs that follow a gradient, compared with fixed ones.

:- use_module('../../examples/applications/fire/scene',
              [scene_counts/3, scene_network/3, scene_start/2, scene_stop/0]).
:- use_module('../../prolog/typhon', [network_advance/2, remote/2]).
:- use_module(library(lists), [max_list/2, member/2, sum_list/2]).

study(fire_signs, "Evacuation of a building on fire").
text("A room burns; detectors raise alarms by gossip. Exit signs point to the \c
nearest exit on the plan (fixed), or to the nearest one with the smoke on the \c
way as a cost (gradient). People leave a quarter of a minute to more than a \c
minute after an alarm, as in an office, or up to six minutes, as where they \c
sleep. examples/applications/fire/building.pl and scene.pl define the world, \c
its equations and assumptions.").

vary(signs, [fixed, gradient]).
vary(growth, [0.0117, 0.0469]).
vary(delay, [15-75, 60-360]).
fixed(people, 3, assumed("in each room")).
fixed(puffs, 0.1, assumed("faulty readings of a detector in an hour")).
fixed(dead, 0.05, assumed("share of detectors that read nothing")).
fixed(begin, 60, assumed("seconds until the fire: signs are set by then")).
fixed(limit, 600, assumed("seconds from the fire on")).

network(_, Topology, Options) :-
    scene_network([], Topology, Options).

run(Case, Network) :-
    Begin = Case.begin,
    call_cleanup(
        ( scene_start(Network,
                      [ seed(Case.seed), people(Case.people), fire(Begin),
                        signs(Case.signs), growth(Case.growth), delay(Case.delay),
                        puffs(Case.puffs), dead(Case.dead) ]),
          Seconds is Begin + Case.limit,
          network_advance(Network, Seconds),
          scene_counts(Out, Caught, Inside),
          remote(r2c1, log(people(Out, Caught, Inside))) ),
        scene_stop).

label(time, "Mean time from the fire until a person is out (s)").
label(last, "Time until the last person is out (s)").
label(smoke, "Mean smoke on the way (minutes at 1 per metre)").
label(lost, "Share of people that did not get out").

%   The time of people that do not get out counts as `limit`.

measure(time, Log, Mean) :-
    findall(Time, out(Log, Time, _), Times),
    people(Log, Out, All),
    sum_list(Times, Sum),
    Mean is (Sum + (All-Out)*Log.case.limit)/All.
measure(last, Log, Last) :-
    findall(Time, out(Log, Time, _), Times),
    people(Log, Out, All),
    ( Out < All -> Last = Log.case.limit ; max_list(Times, Last) ).
measure(smoke, Log, Mean) :-
    findall(Smoke, out(Log, _, Smoke), Amounts),
    sum_list(Amounts, Sum),
    length(Amounts, Count),
    Mean is Sum/Count.
measure(lost, Log, Share) :-
    people(Log, Out, All),
    Share is 1 - Out/All.

out(Log, Time, Smoke) :-
    member(event(At, _, _, out(_, Smoke)), Log.events),
    Time is At-Log.case.begin.

people(Log, Out, All) :-
    member(event(_, _, _, people(Out, Caught, Inside)), Log.events),
    !,
    All is Out+Caught+Inside.

claim("with gradients people get out sooner on average", [],
      least(time, signs=gradient)).
claim("with gradients the last person gets out sooner",
      [], least(last, signs=gradient)).
claim("with gradients people pass less smoke", [],
      least(smoke, signs=gradient)).
claim("if people leave late they pass less smoke with gradients", [],
      at([delay=60-360], least(smoke, signs=gradient))).
claim("with gradients no more people are lost", [],
      at([signs=gradient], lost) =< at([signs=fixed], lost)).

plot(fire_signs, "Smoke on the way, and time, by signs",
     lines([x(signs), y([smoke, time, last, lost]), line(delay),
            where([growth=0.0469])])).
