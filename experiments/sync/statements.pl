:- module(sync_statements,
          [ statements/3                % +Figure, +Data, -Claims
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(scenarios, [topology/4]).
:- use_module(library(apply), [include/3, maplist/3]).
:- use_module(library(lists),
              [ last/2, max_list/2, member/2, memberchk/2, min_list/2, nth1/3,
                reverse/2, subtract/3
              ]).
:- use_module(library(pairs), [pairs_keys/2, pairs_keys_values/3]).

/** <module> What the thesis says of its figures, checked

Every statement of the text of chapter 5 about a figure is a line that
holds or does not.  Where the thesis prints a number of seconds, the line
says how near to it is near enough: seconds depend on how long a hop
takes, which the thesis does not tell.

*Threading*: pure.
*/

:- meta_predicate
    in_runs(+, 1, -, -),
    truth(0, -).

:- discontiguous
    statement/5.

%!  statements(+Figure, +Data, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found).  Data is a list of pairs
%   Key-Runs, Key as in figure_cases/2; Runs are lists of measures, one for
%   each seed (see measures/2), and with them claims(List), what was found
%   about the run by itself.  For Figure 5.2 Data is a list of
%   curve(Delta, Rewards, Steps).

statements(Figure, Data, Claims) :-
    findall(claim(Text, Held, Found),
            statement(Figure, Data, Text, Held, Found),
            Claims).

                /*******************************
                *          FIGURE 5.2          *
                *******************************/

statement('5.2', Curves,
          'the larger delta, the sooner a potential is zero', Held, Found) :-
    findall(N, ( member(curve(_, _, Steps), Curves),
                 last(Steps, step(N, _, _)) ), Ns),
    truth(falling(Ns), Held),
    text('~w visits', [Ns], Found).
statement('5.2', Curves, 'it falls fast first, and slowly at the end',
          Held, Found) :-
    findall(First-Last, ( member(curve(_, _, Steps), Curves),
                          ends(Steps, First, Last) ), Ends),
    truth(forall(member(First-Last, Ends), First > Last), Held),
    maplist([F-L, T]>>text('~2f and ~2f', [F, L], T), Ends, Texts),
    text('penalties, first and last: ~w', [Texts], Found).
statement('5.2', Curves, 'a reward raises it for a while', Held, Found) :-
    findall(N, raised(Curves, N), Raised),
    findall(N, rewarded_below(Curves, N), All),
    length(Raised, Count),
    length(All, AllCount),
    truth(( AllCount > 0, Count =:= AllCount ), Held),
    text('~d of ~d rewards', [Count, AllCount], Found).
statement('5.2', Curves,
          'the curves of theta differ at first, and meet at the end',
          Held, Found) :-
    findall(N, ( member(curve(_, _, Steps), Curves),
                 last(Steps, step(N, _, _)) ), Ns),
    min_list(Ns, End),
    Half is End // 2,
    findall(Spread, ( between(1, Half, I), spread(Curves, I, Spread) ),
            Spreads),
    max_list(Spreads, Most),
    spread(Curves, End, Least),
    truth(Least < Most, Held),
    text('~2f apart at most up to visit ~d, ~2f at visit ~d',
         [Most, Half, Least, End], Found).
statement('5.2', Curves, 'the larger delta, the larger theta at the end',
          Held, Found) :-
    findall(Theta, ( member(curve(_, _, Steps), Curves),
                     last(Steps, step(_, _, Theta)) ), Thetas),
    reverse(Thetas, Reversed),
    truth(falling(Reversed), Held),
    maplist([X, T]>>text('~2f', [X], T), Thetas, Texts),
    text('~w', [Texts], Found).

ends(Steps, First, Last) :-
    findall(Theta, penalty(Steps, Theta), Thetas),
    Thetas = [First|_],
    last(Thetas, Last).

penalty(Steps, Theta) :-
    nth1(I, Steps, step(_, P0, _)),
    I1 is I + 1,
    nth1(I1, Steps, step(_, P, Theta)),
    P < P0.

%   A reward where there was room for it.

rewarded_below(Curves, N) :-
    member(curve(_, Rewards, Steps), Curves),
    member(N, Rewards),
    N0 is N - 1,
    memberchk(step(N0, P0, _), Steps),
    P0 < 100.

raised(Curves, N) :-
    member(curve(_, Rewards, Steps), Curves),
    member(N, Rewards),
    N0 is N - 1,
    memberchk(step(N0, P0, _), Steps),
    P0 < 100,
    memberchk(step(N, P, _), Steps),
    P > P0.

spread(Curves, N, Spread) :-
    findall(Theta, ( member(curve(_, _, Steps), Curves),
                     memberchk(step(N, _, Theta), Steps) ), Thetas),
    min_list(Thetas, Least),
    max_list(Thetas, Most),
    Spread is Most - Least.

                /*******************************
                *          ALL OTHERS          *
                *******************************/

statement(Figure, Data, 'all agents end by themselves', Held, Found) :-
    Figure \== '5.2',
    findall(Run, ( member(_-Runs, Data), member(Run, Runs) ), Runs),
    in_runs(Runs, [Run]>>( memberchk(agents(N), Run),
                           memberchk(ended(N), Run) ), Held, Found).

                /*******************************
                *    FIGURE 5.5, TABLE 5.1     *
                *******************************/

statement('5.5', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    memberchk(Name-Runs, Data),
    in_step(Said, Test),
    text('~w: ~w', [Title, Said], Text),
    in_runs(Runs, Test, Held, Found).
statement('5.5', Data, Text, Held, Found) :-
    printed_idle(Name, Printed),
    memberchk(Name-Runs, Data),
    topology(Name, Title, _, _),
    text('~w: ~w s idle in all (within a factor of two)', [Title, Printed],
         Text),
    medians([Name-Runs], idle, [Idle]),
    truth(near(Idle, Printed), Held),
    text('~1f s', [Idle], Found).
statement('5.5', Data, 'idle longest on tree, then star-bus, ring, grid',
          Held, Found) :-
    findall(Name-Runs, ( member(Name, [tree, star_bus, ring, grid]),
                         memberchk(Name-Runs, Data) ), Pairs),
    Pairs = [_, _, _, _],
    medians(Pairs, idle, Idles),
    truth(falling(Idles), Held),
    seconds(Idles, Found).
statement('5.5', Data,
          'Star-bus: more hosts begin T1 in the first second than there are \c
agents (19, with 10)', Held, Found) :-
    memberchk(star_bus-Runs, Data),
    findall(N, ( member(Run, Runs), memberchk(bursts([N|_]), Run) ), Ns),
    in_runs(Runs, [Run]>>( memberchk(bursts([N|_]), Run),
                           memberchk(agents(Agents), Run),
                           N > Agents ), Held, Text),
    text('~w: ~w', [Text, Ns], Found).
statement('5.5', Data, 'Star-bus: T1 begins everywhere by the 9th second',
          Held, Found) :-
    memberchk(star_bus-Runs, Data),
    maplist([Run, T]>>memberchk(last_starts([T|_]), Run), Runs, Times),
    in_runs(Runs, [Run]>>( memberchk(last_starts([T|_]), Run), T =< 9 ),
            Held, Text),
    seconds(Times, Found0),
    text('~w: ~w', [Text, Found0], Found).
statement('5.5', Data,
          'Star-bus: T2 begins at the 37th second (within a factor of two)',
          Held, Found) :-
    memberchk(star_bus-Runs, Data),
    maplist([Run, T]>>memberchk(starts([_, T|_]), Run), Runs, Times),
    median(Times, Time),
    truth(near(Time, 37), Held),
    text('~1f s', [Time], Found).

printed_idle(star_bus, 66).
printed_idle(ring, 32).
printed_idle(tree, 142).
printed_idle(grid, 25).

%   in_step(-Text, -Test): what can be said of any run that keeps in step.

in_step('two distinct tasks are required at most (tau)',
        [Run]>>( memberchk(tau(Tau), Run), Tau =< 2 )).
in_step('no overlapped executions',
        [Run]>>memberchk(overlaps(0), Run)).
in_step('every host executes every task once, in order',
        [Run]>>( held(Run, 'every host executes every task exactly once'),
                 memberchk(out_of_order(0), Run) )).
in_step('idle between any two tasks',
        [Run]>>( memberchk(gaps(Gaps), Run),
                 forall(member(Gap, Gaps), Gap > 0) )).
in_step('the first burst is the largest',
        [Run]>>( memberchk(bursts([First|Later]), Run),
                 max_list(Later, Most), First > Most )).

                /*******************************
                *          FIGURE 5.6          *
                *******************************/

statement('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    text('~w: idle time falls as delta grows', [Title], Text),
    medians(Pairs, idle, Idles),
    truth(not_rising(Idles), Held),
    seconds(Idles, Found).
statement('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, Best),
    line(Data, Name, Pairs),
    findall(Run, ( member(Delta-Runs, Pairs), Delta =< Best,
                   member(Run, Runs) ), Runs),
    text('~w: no overlaps up to delta = ~w', [Title, Best], Text),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Found).
statement('5.6', Data, Text, Held, Found) :-
    topology(Name, Title, _, Best),
    Name \== ring,
    line(Data, Name, Pairs),
    findall(Delta-Runs, ( member(Delta-Runs, Pairs), Delta > Best ), Beyond),
    medians(Beyond, overlaps, Overlaps),
    text('~w: overlaps beyond it, more as delta grows', [Title], Text),
    reverse(Overlaps, Reversed),
    truth(( not_rising(Reversed), last(Overlaps, Most), Most > 0 ), Held),
    text('~w', [Overlaps], Found).
statement('5.6', Data, 'Ring: no overlaps up to delta = 1.0', Held, Found) :-
    line(Data, ring, Pairs),
    findall(Run, ( member(_-Runs, Pairs), member(Run, Runs) ), Runs),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Text),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Text, Overlaps], Found).
statement('5.6', Data,
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
statement('5.6', Data,
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
                *       FIGURES 5.7, 5.8       *
                *******************************/

statement('5.7a', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    findall(Run, ( member(_-Runs, Pairs), member(Run, Runs) ), Runs),
    text('~w: 8 overlapped executions of 360 at most', [Title], Text),
    in_runs(Runs, [Run]>>( memberchk(overlaps(N), Run), N =< 8 ), Held,
            Found0),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Found0, Overlaps], Found).
statement('5.7a', Data, Text, Held, Found) :-
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
statement('5.7a', Data, Text, Held, Found) :-
    member(Agents-Printed, [5-98, 10-48, 20-116]),
    line(Data, tree, Pairs),
    memberchk(Agents-Runs, Pairs),
    text('Tree: ~d s idle with ~d agents (within a factor of two)',
         [Printed, Agents], Text),
    medians([Agents-Runs], idle, [Idle]),
    truth(near(Idle, Printed), Held),
    text('~1f s', [Idle], Found).
statement('5.7b', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    line(Data, Name, Pairs),
    findall(Run, ( member(_-Runs, Pairs), member(Run, Runs) ), Runs),
    text('~w: no overlapped executions with 30 to 60 hosts', [Title], Text),
    in_runs(Runs, [Run]>>memberchk(overlaps(0), Run), Held, Found0),
    medians(Pairs, overlaps, Overlaps),
    text('~w; medians ~w', [Found0, Overlaps], Found).
statement('5.8', [_-Runs], Text, Held, Found) :-
    in_step(Text, Test),
    Text \== 'the first burst is the largest',
    in_runs(Runs, Test, Held, Found).

                /*******************************
                *      FIGURES 5.9, 5.10       *
                *******************************/

statement('5.9', Data, Text, Held, Found) :-
    model(Model, Title),
    line(Data, Model, Pairs),
    findall(Run, ( member(_-Runs, Pairs), member(Run, Runs) ), Runs),
    member(Said-Test, [ 'no overlapped executions'-overlaps(0),
                        'two distinct tasks at most (tau)'-tau(2) ]),
    text('~w: ~w', [Title, Said], Text),
    Test =.. [Measure, Most],
    in_runs(Runs, at_most(Measure, Most), Held, Found0),
    measured(Pairs, Measure, Values),
    text('~w; ~w', [Found0, Values], Found).
statement('5.9', Data, Text, Held, Found) :-
    model(Model, Title),
    line(Data, Model, Pairs),
    text('~w: idle time grows with the number of agents', [Title], Text),
    medians(Pairs, idle, Idles),
    reverse(Idles, Reversed),
    truth(not_rising(Reversed), Held),
    seconds(Idles, Found).
statement('5.10', Data, 'Dynamic II takes longer than Dynamic I', Held,
          Found) :-
    ratios(Data, Ratios),
    truth(forall(member(Ratio, Ratios), Ratio > 1), Held),
    maplist([R, T]>>text('~2f', [R], T), Ratios, Texts),
    text('times as long: ~w', [Texts], Found).
statement('5.10', Data,
          'Dynamic II takes nearly twice as long (1.5 to 2.5 times)', Held,
          Found) :-
    ratios(Data, Ratios),
    truth(forall(member(Ratio, Ratios), ( Ratio >= 1.5, Ratio =< 2.5 )),
          Held),
    maplist([R, T]>>text('~2f', [R], T), Ratios, Texts),
    text('~w', [Texts], Found).

model(dynamic_1, 'Dynamic I').
model(dynamic_2, 'Dynamic II').

ratios(Data, Ratios) :-
    line(Data, dynamic_1, Pairs1),
    line(Data, dynamic_2, Pairs2),
    medians(Pairs1, total, Totals1),
    medians(Pairs2, total, Totals2),
    maplist([A, B, R]>>(R is B / A), Totals1, Totals2, Ratios).

                /*******************************
                *      FIGURES 5.11, 5.12      *
                *******************************/

statement('5.11', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    memberchk(Name-Runs, Data),
    healing(Said, Test),
    text('~w: ~w', [Title, Said], Text),
    in_runs(Runs, Test, Held, Found).
statement('5.12', Data, Text, Held, Found) :-
    member(Name-Title, [grid-'Grid', dynamic_2-'Dynamic II']),
    memberchk(Name-Runs, Data),
    healing_all(Said, Test),
    text('~w: ~w', [Title, Said], Text),
    in_runs(Runs, Test, Held, Found).

healing('20 hosts lose T2, and each executes it again',
        [Run]>>( memberchk(lost(20), Run), memberchk(redone(20), Run) )).
healing('three distinct tasks are required while healing (tau)',
        [Run]>>memberchk(healing_tau(3), Run)).
healing('other agents go on meanwhile',
        [Run]>>( memberchk(meanwhile(N), Run), N > 0 )).
healing('then T5 and T6 are finished everywhere, nothing else is repeated',
        [Run]>>( memberchk(agents(N), Run), memberchk(ended(N), Run),
                 memberchk(executions(380), Run) )).
healing('two distinct tasks at most after healing (tau)',
        [Run]>>( memberchk(later_tau(N), Run), N =< 2 )).

healing_all('every host executes T2 and what followed again',
        [Run]>>( memberchk(lost_hosts(60), Run), memberchk(lost(N), Run),
                 memberchk(redone(N), Run) )).
healing_all('and in order',
        [Run]>>held(Run, 'no host executes a task before the earlier ones')).
healing_all('no overlapped executions before or after the failure',
        [Run]>>memberchk(overlaps(0), Run)).
healing_all('two distinct tasks at most while healing and after (tau)',
        [Run]>>( memberchk(healing_tau(A), Run), A =< 2,
                 memberchk(later_tau(B), Run), B =< 2 )).

                /*******************************
                *            COMMON            *
                *******************************/

%   line(+Data, +Name, -Pairs): X-Runs of the line Name, in order; fails
%   where there are none.

line(Data, Name, Pairs) :-
    findall(X-Runs, member(Name-X-Runs, Data), Pairs),
    Pairs = [_|_].

measured(Pairs, Measure, Values) :-
    Term =.. [Measure, Value],
    findall(Value, ( member(_-Runs, Pairs), member(Run, Runs),
                     memberchk(Term, Run) ), Values).

medians(Pairs, Measure, Medians) :-
    maplist(median_of(Measure), Pairs, Medians).

median_of(Measure, Pair, Median) :-
    measured([Pair], Measure, Values),
    median(Values, Median).

at_most(Measure, Most, Run) :-
    Term =.. [Measure, Value],
    memberchk(Term, Run),
    Value =< Most.

held(Run, Text) :-
    memberchk(claims(Claims), Run),
    memberchk(claim(Text, true, _), Claims).

%   in_runs(+Runs, :Test, -Held, -Found): Test is true of every one.

in_runs(Runs, Test, Held, Found) :-
    include(Test, Runs, Good),
    length(Runs, Count),
    length(Good, GoodCount),
    truth(GoodCount =:= Count, Held),
    text('in ~d of ~d runs', [GoodCount, Count], Found).

falling([_]).
falling([A, B|Rest]) :-
    A > B,
    falling([B|Rest]).

not_rising([_]).
not_rising([A, B|Rest]) :-
    A >= B,
    not_rising([B|Rest]).

near(X, Printed) :-
    X >= Printed / 2,
    X =< Printed * 2.

seconds(Numbers, Text) :-
    maplist([N, T]>>text('~1f', [N], T), Numbers, Texts),
    atomic_list_concat(Texts, ', ', Joined),
    text('~w s', [Joined], Text).

text(Format, Args, Text) :-
    format(atom(Text), Format, Args).

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).
