:- module(learning_claims,
          [ learning_claims/3           % +Figure, +CaseRuns, -Claims
          ]).
:- use_module(judging, [judged/4]).
:- use_module(library(lists), [list_to_set/2, member/2, memberchk/2]).

/** <module> What thesis sections 4.4.1 to 4.4.7 say of the figures

A number of the thesis is met if what was found differs from it by a tenth
at most.  Where the thesis has a word for a size, the number that it was
taken for stands in the text of the claim.

*Threading*: any thread; no state.
*/

%!  learning_claims(+Figure, +CaseRuns, -Claims) is det.
%
%   Claims are for print_claims/2.  CaseRuns are pairs Case-Runs, Runs terms
%   run(Directory, Result).

learning_claims(Figure, CaseRuns, Claims) :-
    findall(Case-Results,
            ( member(Case-Runs, CaseRuns),
              findall(Result, member(run(_, Result), Runs), Results) ),
            Data),
    findall(claim(Text, Held, Found),
            ( statement(Figure, Data, Text, Test),
              judged(Test, Data, Held, Found)
            ),
            Claims).

                /*******************************
                *          STATEMENTS          *
                *******************************/

%   statement(?Figure, +Data, -Text, -Test)

statement('4.7', _, 'without sharing all paths are distinct',
          in_runs(alone, distinct)).
statement('4.7', _, 'with sharing all agents take the same path',
          in_runs(sharing, same)).
statement('4.7', _, 'or highly overlapped ones (0.8 or more of their cells)',
          in_runs(sharing, overlapped)).
statement('4.7', _, 'paths overlap more with sharing than without',
          smaller(overlaps, alone, sharing)).
statement('4.7', _, '195 executions per agent without sharing',
          near(executions, alone, 195)).
statement('4.7', _, '92 with sharing', near(executions, sharing, 92)).
statement('4.8', _, 'around 900 executions of all agents without sharing',
          near(total, alone, 900)).
statement('4.8', _, 'around 350 with sharing', near(total, sharing, 350)).
statement('4.8', _, 'less than half of those without sharing',
          less_than_half(total, alone, sharing)).
statement('4.8', _, 'with sharing lengths differ less, by their mean',
          together(sharing, alone)).
statement('4.9', Data, Text, falls(executions, Key)) :-
    key_text(Data, Key, 'executions do not grow with the density, ', Text).
statement('4.9', Data, Text, largest_step(executions, Key)) :-
    key_text(Data, Key, 'largest drop from D 0.1 to 0.2, ', Text).
statement('4.9', _, 'no significant difference (0.15) between networks at \c
D 0.5', alike(executions, 5, 0.15)).
statement('4.9', Data, Text, above(executions)) :-
    memberchk(case(obstacle, _, _)-_, Data),
    Text = 'more executions with an obstacle, at every density'.
statement('4.9', Data, '195 executions with 1 agent on 10 hosts',
          near_at(executions, case(sharing, 10, 1), 195)) :-
    memberchk(case(sharing, 10, 1)-_, Data).
statement('4.9', Data, '110 with 2 agents on 10 hosts',
          near_at(executions, case(sharing, 10, 2), 110)) :-
    memberchk(case(sharing, 10, 2)-_, Data).
statement('4.9', _, 'runs take 300 to 3000 s', run_lengths(300, 3000)).
statement('4.9', _, 'all agents converge in all runs', converged).
statement('4.10', Data, Text, rises(sharing, Key)) :-
    key_text(Data, Key, 'sharing grows with the density, ', Text).
statement('4.10', Data, '0 with 1 agent on 10 hosts',
          none_at(sharing, case(sharing, 10, 1))) :-
    memberchk(case(sharing, 10, 1)-_, Data).
statement('4.10', Data, Text, steady(sharing, Key, 0.05)) :-
    key_text(Data, Key, 'less than 0.05 between D 0.4 and 0.5, ', Text).
statement('4.10', Data, Text, above(sharing)) :-
    memberchk(case(obstacle, _, _)-_, Data),
    Text = 'more sharing with an obstacle, at every density'.
statement('4.11', _, 'final paths without an obstacle go along the diagonal \c
(5 cells from it at most, on average)', aside(sharing, diagonal, 5)).
statement('4.11', _, 'with an obstacle, beside the obstacle (as above)',
          aside(obstacle, wall, 5)).
statement('4.11', _, 'more executions with an obstacle',
          smaller(executions, sharing, obstacle)).
statement('4.12', _, 'sharing becomes less with time: the trend is negative',
          in_runs(sharing, falling)).
statement('4.13', Data, Text, falls(executions, Key)) :-
    key_text(Data, Key, 'executions do not grow with the density, ', Text).
statement('4.13', Data, Text, rises(sharing, Key)) :-
    key_text(Data, Key, 'sharing grows with the density, ', Text).
statement('4.13', _, 'sharing gains more from D 0.1 to 0.2 than from there \c
to 0.5', early_gain(sharing)).
statement('4.13', _, 'degrees of hosts are 0 at least and around 27 at most',
          degrees(27)).
statement('4.13', _, 'all agents converge in all runs', converged).

key_text(Data, Kind-N, Before, Text) :-
    findall(K-Hosts, member(case(K, Hosts, _)-_, Data), Keys0),
    list_to_set(Keys0, Keys),
    member(Kind-N, Keys),
    (   Kind == obstacle
    ->  format(atom(Text), '~w~d hosts, obstacle', [Before, N])
    ;   format(atom(Text), '~w~d hosts', [Before, N])
    ).
