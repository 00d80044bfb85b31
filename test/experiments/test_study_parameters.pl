:- module(test_study_parameters, []).
:- use_module('../lib/project_studies').
:- use_module('../../experiments/engine/cases').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).

/** <module> With which parameters each study runs

*Threading*: pure.
*/

%   runs(Study, Parameters): a case of Study has Parameters, pairs; the names are
%   the same for all cases.

runs('sync/figure_5_5', [topology-T, delta-D]) :- best(T, D).
runs('sync/figure_5_7', [topology-T, delta-D, agents-A, hosts-H]) :-
    best(T, D),
    member(A-Hs, [5-[60], 10-[60,50,40,30], 15-[60], 20-[60]]),
    member(H, Hs).
runs('sync/figure_5_11', [topology-T, delta-D]) :- best(T, D).
runs('sync/figure_5_12', [links-L, delta-D, topology-grid]) :-
    member(L-D, [none-0.5, dynamic_2-0.2]).
runs('sync/study_choices', [topology-T, delta-D, starts-S, choices-C]) :-
    best(T, D),
    member(S, [drawn, even]),
    member(C, [by_chance, in_order]).
runs('sync/beyond_several', [dependent-D, hosts-H, agents-A]) :-
    member(D, [false, true]),
    member(H-A, [60-10, 200-33]).
runs('hierarchy/beyond_lead', [control-C, delta-D]) :-
    member(C-D, [bold-0.5, cautious-0.1, leaders-0.5, observer-0.5]).
runs('allocation/figure_7_5', [mechanism-M, hosts-H, eligible-E, required-R]) :-
    member(M-Hs, [ proposed-[50,100,150,200], murdoch-[100], anta-[100] ]),
    member(H, Hs),
    memberchk(H-E/R, [50-10/5, 100-20/10, 150-30/15, 200-40/20]).
runs('allocation/beyond_sharing',
     [ sharing-S, allocators-A, hosts-H, eligible-E, required-R,
       probability-P ]) :-
    member(H-E/R/P, [100-15/10/0.06, 200-30/20/0.03]),
    member(S, [none, own, shared]),
    member(A, [1, 3, 5]),
    ( H =:= 100 -> true ; A =:= 3, S \== own ).
runs('allocation/beyond_replacement',
     [ hosts-H, failing-F, eligible-E, required-R, failures-N, probability-P,
       links-(dynamic) ]) :-
    member(H-E/R/P-Failures, [ 30-15/10/0.2-[0-0, 0.1-1, 0.3-3],
                               100-50/33/0.06-[0-0, 0.3-10] ]),
    member(F-N, Failures).
runs('allocation/beyond_integrated',
     [sequences-2, allocators-2, length-3, hosts-30, probability-0.2]).
runs('algorithms/beyond_cloning', [group-G, agents-A, cloning-C]) :-
    member(G-A/C, [three-3/false, three_cloning-3/true, eight-8/false]).
runs('algorithms/beyond_islands', [population-P, agents-A, sharing-S]) :-
    member(P-A/S, [islands-6/true, apart-6/false, one-1/true]).
runs('algorithms/beyond_settings', [algorithm-A, sharing-S, algorithms-[A]]) :-
    member(A, [climb, lottery]),
    member(S, [true, false]).

runs('algorithms/beyond_exchange', [exchange-E, settings-S]) :-
    trap(S),
    member(E, [none, at(500, greedy, scout)]).
runs('algorithms/beyond_mixed',
     [crew-C, problem-P, algorithms-As, settings-S]) :-
    trap(Trap),
    member(C-P/As/S,
           [ greedy-maze/[greedy]/Trap, scout-maze/[scout]/Trap,
             greedy_scout-maze/[greedy,greedy,greedy,scout]/Trap,
             climb-settings/[climb]/[], genetic-settings/[genetic]/[],
             climb_genetic-settings/[climb,genetic]/[] ]).
runs('algorithms/beyond_crews',
     [maze-M, crew-C, algorithms-As, sharing-S, settings-Settings]) :-
    member(M-Walls,
           [ open-[], near_start-[(18,2)-(18,6), (18,6)-(22,6)],
             near_light-[(2,18)-(2,22), (2,22)-(6,22)] ]),
    Settings = [size-24,obstacles-Walls],
    member(C-As/S, [ greedy-[greedy]/true, scout-[scout]/true,
                     scout_apart-[scout]/false,
                     both-[greedy,scout]/true ]).

%   A maze with the light behind a corner.

trap([size-16, obstacles-[(6,6)-(6,11),(6,11)-(12,11)]]).

%   The values of delta in table 5.1 of the thesis.

best(star_bus, 0.2).
best(ring, 0.8).
best(tree, 0.2).
best(grid, 0.5).

:- begin_tests(study_parameters).

test(cases, [forall(study(Name)), Found == Expected]) :-
    findall(Parameters, runs(Name, Parameters), Expected0),
    Expected0 = [First|_],
    project_study(Name, Study),
    study_cases(Study, [], Cases),
    maplist(parameters(First), Cases, Found0),
    maplist(msort, [Expected0,Found0], [Expected,Found]).

study(Name) :-
    setof(Study, Parameters^runs(Study, Parameters), Names),
    member(Name, Names).

parameters(Pairs, Case, Found) :-
    findall(Key-Value,
            ( member(Key-_, Pairs), get_dict(Key, Case, Value) ),
            Found).

:- end_tests(study_parameters).
