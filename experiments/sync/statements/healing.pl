:- module(sync_statements_healing,
          [ healing_statement/5         % +Figure, +Data, -Text, -Held, -Found
          ]).
:- use_module(saying).
:- use_module('../scenarios', [topology/4]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> What the thesis says of self-healing: Figures 5.11 and 5.12

*Threading*: pure.
*/

%!  healing_statement(+Figure, +Data, -Text, -Held, -Found) is nondet.

healing_statement('5.11', Data, Text, Held, Found) :-
    topology(Name, Title, _, _),
    memberchk(Name-Runs, Data),
    healing(Said, Test, Measure),
    text('~w: ~w', [Title, Said], Text),
    in_runs(Runs, Test, Held, Found0),
    measured([Name-Runs], Measure, Values),
    text('~w; ~w', [Found0, Values], Found).
healing_statement('5.12', Data, Text, Held, Found) :-
    member(Name-Title, [grid-'Grid', dynamic_2-'Dynamic II']),
    memberchk(Name-Runs, Data),
    healing_all(Said, Test, Measure),
    text('~w: ~w', [Title, Said], Text),
    in_runs(Runs, Test, Held, Found0),
    measured([Name-Runs], Measure, Values),
    text('~w; ~w', [Found0, Values], Found).

healing('20 hosts lose T2, and each executes it again',
        [Run]>>( memberchk(lost(20), Run), memberchk(redone(20), Run) ),
        redone).
healing('three distinct tasks are required while healing (tau)',
        [Run]>>memberchk(healing_tau(3), Run), healing_tau).
healing('other agents go on meanwhile',
        [Run]>>( memberchk(meanwhile(N), Run), N > 0 ), meanwhile).
healing('then T5 and T6 are finished everywhere, nothing else is repeated',
        [Run]>>( memberchk(agents(N), Run), memberchk(ended(N), Run),
                 memberchk(executions(380), Run) ), executions).
healing('two distinct tasks at most after healing (tau)',
        [Run]>>( memberchk(later_tau(N), Run), N =< 2 ), later_tau).

healing_all('every host executes T2 and what followed again',
        [Run]>>( memberchk(lost_hosts(60), Run), memberchk(lost(N), Run),
                 memberchk(redone(N), Run) ), redone).
healing_all('and in order',
        [Run]>>claim_held(Run,
                          'no host executes a task before the earlier ones'),
        out_of_order).
healing_all('no overlapped executions before or after the failure',
        [Run]>>memberchk(overlaps(0), Run), overlaps).
healing_all('two distinct tasks at most while healing and after (tau)',
        [Run]>>( memberchk(healing_tau(A), Run), A =< 2,
                 memberchk(later_tau(B), Run), B =< 2 ), healing_tau).

