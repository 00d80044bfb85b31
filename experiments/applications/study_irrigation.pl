%   Irrigation by agents that carry a model to the field, compared with others.

:- use_module('../../examples/applications/irrigation/scene',
              [scene_network/3, scene_start/2, scene_stop/0, scene_totals/2]).
:- use_module('../../prolog/typhon', [network_advance/2, remote/2]).
:- use_module(library(lists), [member/2, sum_list/2]).

study(irrigation, "Irrigation of fields, and stress of crops").
text("Six fields, ninety days. A timer gives water every three days: the need \c
of the crop by the table (20 mm), or that less the mean rain (16 mm). A model \c
of the water in the soil, corrected by readings, decides at the office \c
(central), where it needs the link to a field for readings and orders, or at \c
the field (carried). examples/applications/irrigation/fields.pl and scene.pl \c
define the world, its equations and assumptions.").

vary(strategy, [timer, timer_less, central, carried]).
vary(down, [0, 0.3, 0.7]).
fixed(days, 90, assumed("a season")).

network(_, Topology, Options) :-
    scene_network([], Topology, Options).

run(Case, Network) :-
    call_cleanup(
        ( scene_start(Network, [ seed(Case.seed), strategy(Case.strategy),
                                 down(Case.down) ]),
          Seconds is 86400*Case.days,
          network_advance(Network, Seconds),
          scene_totals(_, Totals),
          remote(office, log(totals(Totals))) ),
        scene_stop).

label(water, "Water given (mm)").
label(stress, "Days of stress").
label(drained, "Water drained (mm)").

measure(water, Log, Mean) :-
    mean(Log, Mm, totals(Mm, _, _), Mean).
measure(drained, Log, Mean) :-
    mean(Log, Mm, totals(_, Mm, _), Mean).
measure(stress, Log, Mean) :-
    mean(Log, Hours, totals(_, _, Hours), Mean0),
    Mean is Mean0/24.

mean(Log, X, Sums, Mean) :-
    member(event(_, _, _, totals(Totals)), Log.events),
    !,
    findall(X, member(_-Sums, Totals), Xs),
    sum_list(Xs, Sum),
    length(Xs, Count),
    Mean is Sum/Count.

claim("carried models give less water than a timer by the table", [],
      at([strategy=carried], water) < at([strategy=timer], water)).
claim("carried models cause less stress than a timer that expects rain", [],
      at([strategy=carried], stress) < at([strategy=timer_less], stress)).
claim("with all links up the place of the model changes water by at most 5 mm",
      [],
      at([down=0], near(at([strategy=carried], water),
                        at([strategy=central], water), 5))).
claim("with links down for 30 % carried models cause less stress", [],
      at([down=0.3], at([strategy=carried], stress)
                     < at([strategy=central], stress))).
claim("with links down for 70 % carried models cause less stress", [],
      at([down=0.7], at([strategy=carried], stress)
                     < at([strategy=central], stress))).
claim("with carried models the link costs half a day of stress at most", [],
      at([strategy=carried], at([down=0.7], stress) =< at([down=0], stress)+0.5)).

plot(irrigation,
     "Water given, and days of stress, by the share of time without a \c
link",
     lines([x(down), y([water, stress, drained]), line(strategy)])).
