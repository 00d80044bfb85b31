:- module(fire, []).

/** <module> A building on fire: an alarm by gossip, and exit signs by gradients

    swipl examples/applications/fire.pl [--signs=fixed] [--rule=single]
        [--growth=0.0117] [--people=3] [--speed=5] [--port=8080] [--seed=1]

A room burns after 20 s.  Detectors ask their neighbours before they raise an
alarm; signs lead round the smoke.  fire/building.pl is the world,
fire/room.pl the agent of each cell; see doc/applications.md.
*/

:- use_module(fire/scene).
:- use_module(stage, [stage/3, stage_option/3, stage_story/3]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- public main/1, play/2.

opt_type(signs, signs, oneof([gradient,fixed])).
opt_type(rule, rule, oneof([gossip,single,verified])).
opt_type(growth, growth, number).
opt_type(people, people, nonneg).
opt_type(Name, Name, Type) :-
    stage_option(Name, Type, _).

opt_help(signs, "Which exit the signs point to [gradient]").
opt_help(rule, "When a detector raises an alarm [gossip]").
opt_help(growth, "Growth of the fire, in kW/s2 [0.0469]").
opt_help(people, "Number of people in each room [3]").
opt_help(Name, Help) :-
    stage_option(Name, _, Help).

main(Argv) :-
    stage(Argv, fire_scene, play).

play(Network, Options) :-
    scene_start(Network, [fire(20), puffs(0.1)|Options]),
    stage_story(Network, 20, say).

say(Time, Ends) :-
    scene_counts(Out, Caught, Inside),
    scene_alarms(Alarms),
    format('~|~t~d~4| s: ~w; ~d people inside, ~d out, ~d caught by the fire~n',
           [Time, Alarms, Inside, Out, Caught]),
    ( ( Inside =:= 0 ; Time >= 600 ) -> Ends = true ; Ends = false ).
