:- module(sync_statements,
          [ statements/3                % +Figure, +Data, -Claims
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(scenarios, [topology/4]).
:- use_module(statements/comparison, [comparison/5]).
:- use_module(statements/healing, [healing_statement/5]).
:- use_module(statements/potentials, [potential_statement/4]).
:- use_module(statements/saying).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2]).

/** <module> What the thesis says of its figures, checked

Every statement of the text of chapter 5 about a figure is a line that
holds or does not.  Where the thesis prints a number of seconds, the line
says how near to it is near enough: seconds depend on how long a hop
takes, which the thesis does not tell.

*Threading*: pure.
*/

%!  statements(+Figure, +Data, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found).  Data is a list of pairs
%   Key-Runs, Key as in figure_cases/2; Runs are lists of measures, one for
%   each seed (see measures/2), and with them claims(List), what was found
%   about the run by itself.  For Figure 5.2 Data is a list of
%   curve(Delta, Rewards, Steps).

statements(Figure, Data, Claims) :-
    findall(claim(Text, Held, Found),
            any_statement(Figure, Data, Text, Held, Found),
            Claims).

any_statement('5.2', Curves, Text, Held, Found) :-
    !,
    potential_statement(Curves, Text, Held, Found).
any_statement(Figure, Data, Text, Held, Found) :-
    (   statement(Figure, Data, Text, Held, Found)
    ;   comparison(Figure, Data, Text, Held, Found)
    ;   healing_statement(Figure, Data, Text, Held, Found)
    ).

statement(_, Data, 'all agents end by themselves', Held, Found) :-
    all_runs(Data, Runs),
    in_runs(Runs, [Run]>>( memberchk(agents(N), Run),
                           memberchk(ended(N), Run) ), Held, Found).


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

statement('5.8', [_-Runs], Text, Held, Found) :-
    in_step(Text, Test),
    Text \== 'the first burst is the largest',
    in_runs(Runs, Test, Held, Found).

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
        [Run]>>( claim_held(Run, 'every host executes every task exactly once'),
                 memberchk(out_of_order(0), Run) )).
in_step('idle between any two tasks',
        [Run]>>( memberchk(gaps(Gaps), Run),
                 forall(member(Gap, Gaps), Gap > 0) )).
in_step('the first burst is the largest',
        [Run]>>( memberchk(bursts([First|Later]), Run),
                 max_list(Later, Most), First > Most )).
