%   A fire alarm: detectors that ask their neighbours, compared with others.

:- use_module('../../examples/applications/fire/scene',
              [scene_network/3, scene_start/2, scene_stop/0]).
:- use_module('../../prolog/typhon', [network_advance/2]).
:- use_module(library(lists), [member/2]).

study(fire_alarm, "False alarms and the time to an alarm").
text("Forty cells of a building, each with a detector. For half an hour there \c
is no fire, but dust and steam at single detectors; then a room burns. A \c
detector raises an alarm at once (single), after half a minute above the \c
threshold (verified), or if a neighbour reads some smoke, too (gossip). \c
examples/applications/fire/building.pl and scene.pl define the world, its \c
equations and assumptions.").

vary(rule, [single, verified, gossip]).
vary(puffs, [0.1, 0.5, 2]).
fixed(quiet, 1800, assumed("seconds without a fire")).
fixed(growth, 0.0117, assumed("kW/s2: a fire of medium growth, NFPA 72")).
fixed(dead, 0.05, assumed("share of detectors that read nothing")).
fixed(limit, 300, assumed("seconds from the fire on")).

network(_, Topology, Options) :-
    scene_network([], Topology, Options).

run(Case, Network) :-
    Begin = Case.quiet,
    call_cleanup(
        ( scene_start(Network,
                      [ seed(Case.seed), people(0), fire(Begin),
                        rule(Case.rule), puffs(Case.puffs),
                        growth(Case.growth), dead(Case.dead) ]),
          Seconds is Begin + Case.limit,
          network_advance(Network, Seconds) ),
        scene_stop).

label(false_alarms, "False alarms in half an hour").
label(delay, "Seconds from the fire to the alarm").

%   Alarms within two minutes, the time until a reset, count as one.

measure(false_alarms, Log, Count) :-
    findall(Time, ( member(event(Time, _, _, alarm(_)), Log.events),
                    Time < Log.case.quiet ),
            Times),
    alarms(Times, -1000, 0, Count).
measure(delay, Log, Delay) :-
    Begin = Log.case.quiet,
    findall(Time, ( member(event(Time, _, _, alarm(_)), Log.events),
                    Time >= Begin ),
            [First|_]),
    Delay is First-Begin.

alarms([], _, Count, Count).
alarms([Time|Times], Last, Count0, Count) :-
    (   Time-Last < 115
    ->  alarms(Times, Last, Count0, Count)
    ;   Count1 is Count0+1,
        alarms(Times, Time, Count1, Count)
    ).

claim("gossip has fewer false alarms than a single detector", [],
      at([rule=single], false_alarms) > at([rule=gossip], false_alarms)).
claim("gossip has fewer false alarms than half a minute of verification", [],
      at([rule=verified], false_alarms) > at([rule=gossip], false_alarms)).
claim("with one puff at a detector in ten hours gossip has no false alarm", [],
      at([rule=gossip, puffs=0.1], false_alarms =:= 0)).
claim("gossip is at most 15 s later than a single detector", [],
      at([rule=gossip], delay) =< at([rule=single], delay)+15).
claim("gossip is sooner than verification", [],
      at([rule=gossip], delay) < at([rule=verified], delay)).

plot(fire_alarm, "False alarms, and seconds to an alarm",
     lines([x(puffs), y([false_alarms, delay]), line(rule),
            xlabel("Puffs of dust or steam at a detector in an hour")])).
