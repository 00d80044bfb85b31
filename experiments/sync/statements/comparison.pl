:- module(sync_statements_comparison,
          [ comparison/5                % +Figure, +Data, -Text, -Held, -Found
          ]).
:- use_module(saying).
:- use_module('../scenarios', [topology/4]).
:- use_module(library(apply), [maplist/4]).
:- use_module(library(lists),
              [last/2, max_list/2, member/2, memberchk/2, reverse/2]).
:- use_module(library(pairs), [pairs_keys/2, pairs_keys_values/3]).

/** <module> What the thesis says of its curves: Figures 5.6 to 5.10

*Threading*: pure.
*/

:- discontiguous
    comparison/5.

%!  comparison(+Figure, +Data, -Text, -Held, -Found) is nondet.

                /*******************************
                *          FIGURE 5.6          *
                *******************************/

comparison('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    text('~w: idle time falls as delta grows', [Title], Text),
    medians(Pairs, idle, Idles),
    truth(not_rising(Idles), Held),
    seconds(Idles, Found).
comparison('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, Best),
    line(Data, Name, Pairs),
    findall(Run, ( member(Delta-Runs, Pairs), Delta =< Best,
                   member(Run, Runs) ), Runs),
    text('~w: no overlaps up to delta = ~w', [Title, Best], Text),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Found).
comparison('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, Best),
    Name \== ring,
    line(Data, Name, Pairs),
    findall(Delta-Runs, ( member(Delta-Runs, Pairs), Delta > Best ), Beyond),
    medians(Beyond, overlaps, Overlaps),
    text('~w: overlaps beyond it, more as delta grows', [Title], Text),
    reverse(Overlaps, Reversed),
    truth(( not_rising(Reversed), last(Overlaps, Most), Most > 0 ), Held),
    text('~w', [Overlaps], Found).
comparison('5.6', Data, 'Ring: no overlaps up to delta = 1.0', Held, Found) :-
    line(Data, ring, Pairs),
    all_runs(Pairs, Runs),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Text),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Text, Overlaps], Found).
comparison('5.6', Data,
          'overlaps begin at a smaller delta on star-bus and tree than on \c
grid and ring', Held, Found) :-
    findall(Name-Onset, ( topology(Name, _, _, _), onset(Data, Name, Onset) ),
            Onsets),
    memberchk(star_bus-Star, Onsets),
    memberchk(tree-Tree, Onsets),
    memberchk(grid-Grid, Onsets),
    memberchk(ring-Ring, Onsets),
    truth(max(Star, Tree) < min(Grid, Ring), Held),
    text('median above 0 from ~w', [Onsets], Found).
comparison('5.6', Data,
          'where executions overlap three distinct tasks are required (tau)',
          Held, Found) :-
    findall(Run, ( member(_-Runs, Data), member(Run, Runs),
                   \+ memberchk(overlaps(0), Run) ), Runs),
    in_runs(Runs, [Run]>>( memberchk(tau(Tau), Run), Tau =:= 3 ), Held,
            Text),
    findall(Tau, ( member(Run, Runs), memberchk(tau(Tau), Run) ), Taus),
    max_list([0|Taus], Most),
    text('~w that overlap, tau at most ~d', [Text, Most], Found).

onset(Data, Name, Onset) :-
    line(Data, Name, Pairs),
    (   member(Delta-Runs, Pairs),
        medians([Delta-Runs], overlaps, [Overlaps]),
        Overlaps > 0
    ->  Onset = Delta
    ;   Onset = inf
    ).

                /*******************************
                *          FIGURE 5.7          *
                *******************************/

comparison('5.7a', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    all_runs(Pairs, Runs),
    text('~w: 8 overlapped executions of 360 at most', [Title], Text),
    in_runs(Runs, [Run]>>( memberchk(overlaps(N), Run), N =< 8 ), Held,
            Found0),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Found0, Overlaps], Found).
comparison('5.7a', Data, Text, Held, Found) :-
    member(Name-Best, [tree-10, star_bus-10, grid-10, ring-5]),
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    text('~w: idle shortest with ~d agents', [Title, Best], Text),
    medians(Pairs, idle, Idles),
    pairs_keys(Pairs, Agents),
    pairs_keys_values(ByIdle0, Idles, Agents),
    keysort(ByIdle0, [_-Found0|_]),
    truth(Found0 =:= Best, Held),
    seconds(Idles, Seconds),
    text('~d agents: ~w with ~w', [Found0, Seconds, Agents], Found).
comparison('5.7a', Data, Text, Held, Found) :-
    member(Agents-Printed, [5-98, 10-48, 20-116]),
    line(Data, tree, Pairs),
    memberchk(Agents-Runs, Pairs),
    text('Tree: ~d s idle with ~d agents (within a factor of two)',
         [Printed, Agents], Text),
    medians([Agents-Runs], idle, [Idle]),
    truth(near(Idle, Printed), Held),
    text('~1f s', [Idle], Found).
comparison('5.7b', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    all_runs(Pairs, Runs),
    text('~w: no overlapped executions with 30 to 60 hosts', [Title], Text),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Found0),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Found0, Overlaps], Found).
                /*******************************
                *      FIGURES 5.9, 5.10       *
                *******************************/

comparison('5.9', Data, Text, Held, Found) :-
    model(Model, Title),
    line(Data, Model, Pairs),
    all_runs(Pairs, Runs),
    member(Said-Test, [ 'no overlapped executions'-overlaps(0),
                        'two distinct tasks at most (tau)'-tau(2) ]),
    text('~w: ~w', [Title, Said], Text),
    Test =.. [Measure, Most],
    in_runs(Runs, at_most(Measure, Most), Held, Found0),
    measured(Pairs, Measure, Values),
    text('~w; ~w', [Found0, Values], Found).
comparison('5.9', Data, Text, Held, Found) :-
    model(Model, Title),
    line(Data, Model, Pairs),
    text('~w: idle time grows with the number of agents', [Title], Text),
    medians(Pairs, idle, Idles),
    reverse(Idles, Reversed),
    truth(not_rising(Reversed), Held),
    seconds(Idles, Found).
comparison('5.10', Data, 'Dynamic II takes longer than Dynamic I', Held,
          Found) :-
    ratios(Data, Ratios),
    truth(forall(member(Ratio, Ratios), Ratio > 1), Held),
    decimals(Ratios, Texts),
    text('times as long: ~w', [Texts], Found).
comparison('5.10', Data,
          'Dynamic II takes nearly twice as long (1.5 to 2.5 times)', Held,
          Found) :-
    ratios(Data, Ratios),
    truth(forall(member(Ratio, Ratios), ( Ratio >= 1.5, Ratio =< 2.5 )),
          Held),
    decimals(Ratios, Texts),
    text('~w', [Texts], Found).

model(dynamic_1, 'Dynamic I').
model(dynamic_2, 'Dynamic II').

ratios(Data, Ratios) :-
    line(Data, dynamic_1, Pairs1),
    line(Data, dynamic_2, Pairs2),
    medians(Pairs1, total, Totals1),
    medians(Pairs2, total, Totals2),
    maplist([A, B, R]>>(R is B / A), Totals1, Totals2, Ratios).

