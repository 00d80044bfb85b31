:- module(test_study_claims, []).

/** <module> Claims of studies, in two worlds that are made up

In the one all claims hold, in the other none does. Most values are at the
bounds of the claims, or just beyond. The claims of other studies are tested in the
suites of their folders.
*/

:- use_module('../lib/project_studies', [project_study/2, verdicts/3]).
:- use_module('../../experiments/engine/cases', [study_cases/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).

%   made(Name, Where, Measures): in the cases of the study in file Name that
%   have the values Where; Measures are Measure-Good/Bad.

:- discontiguous made/3.

                /*******************************
                *         APPLICATIONS         *
                *******************************/

made('applications/study_fire_alarm', [rule=single],
     [false_alarms-1/0, delay-10/10]).
made('applications/study_fire_alarm', [rule=verified],
     [false_alarms-1/1, delay-26/26]).
made('applications/study_fire_alarm', [rule=gossip],
     [false_alarms-0/1, delay-25/26]).

made('applications/study_fire_signs', [signs=fixed],
     [time-10/10, last-10/10, smoke-10/10, lost-0.1/0.1]).
made('applications/study_fire_signs', [signs=gradient],
     [time-9.9/10.1, last-9.9/10.1, smoke-9.9/10.1, lost-0.1/0.2]).

made('applications/study_irrigation', [strategy=timer],
     [water-101/100, stress-9/9]).
made('applications/study_irrigation', [strategy=timer_less],
     [water-9/9, stress-4/3]).
made('applications/study_irrigation', [strategy=carried, down=Down],
     [water-100/100, stress-Stress]) :-
    member(Down-Stress, [0-3/3, 0.3-3/4, 0.7-3.5/4]).
made('applications/study_irrigation', [strategy=central],
     [water-105/106, stress-3.6/4]).

made('applications/study_solar', [strategy=auction, capacity=Capacity],
     [ bought-Bought/10, wasted-9.9/10, fairness-0.6/0.5, reward-0.1/0,
       crossings-9.9/10 ]) :-
    member(Capacity-Bought, [15-9.9, 30-9.8, 60-9.7]).
made('applications/study_solar', [strategy=Strategy],
     [ bought-10/10, wasted-10/10, fairness-0.5/0.5, reward-0/0.1,
       crossings-10/10 ]) :-
    member(Strategy, [none, first, drawn, waiting]).

made('applications/study_warehouse', [way=in_step, robots=N, delta=Delta],
     [ held-0/1, early-Early/1, falls-0/1, delivered-9/8, time-Time/500 ]) :-
    member(N, [4, 6, 8]),
    member(Delta-Early, [0.5-0, 2-0, 8-0, 32-1]),
    Time is 1000 - N - Delta.
made('applications/study_warehouse', [way=alone, robots=N],
     [held-0/1, early-1/0, falls-1/0, delivered-5/5, time-Time/500]) :-
    member(N, [4, 6, 8]),
    Time is 999 - N.

made('fleet/study_away', [way=again],
     [done-40/40, time-10/10, tries-10/10, twice-0/1]).
made('fleet/study_away', [way=wait],
     [done-40/39, time-10/10.1, tries-4.9/5, twice-0/1]).
made('fleet/study_away', [way=others],
     [done-40/40, time-9.9/10.1, tries-8/8, twice-0/1]).
made('fleet/study_away', [way=both],
     [done-40/40, time-9.9/10.2, tries-7.9/8, twice-0/1]).

                /*******************************
                *           LEARNING           *
                *******************************/

made('algorithms/beyond_cloning', [group=three],
     [mean-10/10, executions-30/30, most-3/3]).
made('algorithms/beyond_cloning', [group=three_cloning],
     [mean-9.9/10, executions-31/30, most-19/20]).
made('algorithms/beyond_cloning', [group=eight],
     [mean-1/20, executions-99/1, most-99/1]).

made('algorithms/beyond_contest', [],
     [chosen-0.95/0.9, mean-0.94/0.9, best-0.96/0.92, share-51/50]).

made('algorithms/beyond_islands', [population=islands],
     [reached-100/99, pages-9.9/10, mean-9.9/10]).
made('algorithms/beyond_islands', [population=apart],
     [reached-0/100, pages-10/10, mean-1/99]).
made('algorithms/beyond_islands', [population=one],
     [reached-0/100, pages-1/99, mean-10/10]).

made('algorithms/beyond_exchange', [exchange=none], [reached-50/50]).
made('algorithms/beyond_exchange', [exchange=at(500, greedy, scout)],
     [reached-75/50]).

made('algorithms/beyond_mixed', [crew=Crew], Measures) :-
    member(Crew-Measures,
           [ greedy_scout-[reached-100/99, executions-9.9/10],
             greedy-[reached-99/100, executions-1/99],
             scout-[reached-0/100, executions-10/10],
             climb_genetic-[pages-10/10.1], genetic-[pages-10/10],
             climb-[pages-1/99] ]).

made('algorithms/beyond_settings', [algorithm=Algorithm, sharing=Sharing],
     Measures) :-
    member(Algorithm/Sharing-Measures,
           [ climb/true-[reached-100/99, pages-9.9/10, most_short-0.05/0.06],
             climb/false-[reached-0/100, pages-15/15, most_short-1/0],
             lottery/true-[reached-0/100, pages-20/20, most_short-1/0],
             lottery/false-[reached-0/100, pages-20.1/20, most_short-1/0] ]).

made('learning/study_light', [network=Network, density=D, light=Light],
     [executions-Executions, sharing-Sharing/0.5, duration-Duration]) :-
    member(Network/D-Executions-Duration,
           [ 10/0.1-(214/215)-(300/3001), 10/0.2-(121/122)-(3000/3001),
             10/0.5-(114/116)-(300/3001), 50/0.1-(101/102)-(300/3001),
             50/0.2-(1/1)-(300/3001), 50/0.5-(100/100)-(300/3001) ]),
    member(Light-Sharing, [10-0.6, 100-0.5]).

                /*******************************
                *            WORLDS            *
                *******************************/

%   point(+Name, +World, +Case, -Point)

point(Name, World, Case, Case-Measures) :-
    findall(Measure-Value,
            ( made(Name, Where, All),
              forall(member(P=V, Where), ( get_dict(P, Case, W), V == W )),
              member(Measure-Pair, All),
              value(World, Pair, Value) ),
            Pairs),
    dict_create(Measures, measures, Pairs).

value(good, Good/_, Good).
value(bad, _/Bad, Bad).

%   others(+Name, +World, -Texts): the claims that do not hold in the good
%   world, or that do in the bad one.

others(Name, World, Texts) :-
    project_study(Name, Study),
    study_cases(Study, [], Cases),
    findall(Point, ( member(Case, Cases), point(Name, World, Case, Point) ),
            Points),
    verdicts(Study, Points, Verdicts),
    memberchk(World-Other, [good-false, bad-true]),
    findall(Text, member(Text-Other, Verdicts), Texts).

name(Name) :-
    setof(N, Where^Measures^made(N, Where, Measures), Names),
    member(Name, Names).

:- begin_tests(study_claims).

test(claims_can_hold_and_can_fail,
     [ forall(( name(Name), member(World, [good, bad]) )),
       true(Others == []) ]) :-
    others(Name, World, Others).

:- end_tests(study_claims).
