:- module(algorithms_claims,
          [ algorithms_claims/3         % +Figure, +CaseRuns, -Claims
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(cases, [case_name/2]).
:- use_module(metrics, [measure/3]).
:- use_module(printers, [shortfalls/2]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> What was expected, before the runs were made

*Threading*: as shortfalls/2.
*/

%!  algorithms_claims(+Figure, +CaseRuns, -Claims) is det.
%
%   Claims are for print_claims/2.  CaseRuns are pairs Case-Runs, Runs pairs
%   Seed-Result.  Measures are compared by their medians.

algorithms_claims(Figure, CaseRuns, Claims) :-
    findall(claim(Text, Held, Found),
            ( expected(Figure, Text, Test),
              judged(Test, CaseRuns, Held, Found) ),
            Claims).

expected(settings, 'with climb all agents reach the goal', all(climb)).
expected(settings, 'climb takes less than half the pages of random search',
         less(pages, climb, 0.5, lottery)).
expected(settings, 'sharing saves climb a third of the pages',
         less(pages, climb, 0.67, climb_alone)).
expected(settings, 'sharing saves random search pages, too',
         less(pages, lottery, 1, lottery_alone)).
expected(settings, 'without noise the settings found are at most 0.05 short \c
of good, on the printer they were found at', near(climb, 0.05)).
expected(islands, 'all agents of the islands reach the goal', all(islands)).
expected(islands, 'sharing saves pages', less(pages, islands, 1,
                                              islands_alone)).
expected(islands, 'an agent of six that share needs fewer executions than \c
one population alone', less(mean, islands, 1, one_population)).
expected(mixed, 'greedy and scout together always reach the light',
         all(trap_both)).
expected(mixed, 'greedy alone does not always', not_all(trap_greedy)).
expected(mixed, 'together they need fewer executions than scouts alone',
         less(executions, trap_both, 1, trap_scout)).
expected(mixed, 'climb and genetic together need no more pages than genetic \c
alone', less(pages, print_both, 1, print_genetic)).
expected(exchange, 'more agents reach the light when one takes up another \c
algorithm', more(reached, changed, unchanged)).
expected(cloning, 'agents that clone need fewer executions each than as \c
many that do not', less(mean, breeding, 1, barren)).
expected(cloning, 'but more in all', more(executions, breeding, barren)).
expected(cloning, 'the controller keeps their number below 20',
         below(most, breeding, 20)).

%   judged(+Test, +CaseRuns, -Held, -Found)

judged(Test, CaseRuns, Held, Found) :-
    tried(Test, CaseRuns, Goal, Found),
    (   call(Goal)
    ->  Held = true
    ;   Held = false
    ).

tried(all(Case), CaseRuns, Some =:= Count, Found) :-
    complete(Case, CaseRuns, Some, Count, Found).
tried(not_all(Case), CaseRuns, Some < Count, Found) :-
    complete(Case, CaseRuns, Some, Count, Found).
tried(less(What, Case, Factor, Other), CaseRuns, Less, Found) :-
    compared(What, Case, Other, CaseRuns, A, B, Found),
    (   number(A)
    ->  Less = ( B == none ; A < Factor*B )
    ;   Less = fail
    ).
tried(more(What, Case, Other), CaseRuns, A > B, Found) :-
    compared(What, Case, Other, CaseRuns, A, B, Found).
tried(below(What, Case, Most), CaseRuns, \+ ( member(V, Values), V >= Most ),
      Found) :-
    values(What, Case, CaseRuns, Values),
    format(atom(Found), '~w', [Values]).
tried(near(Case, Most), CaseRuns, \+ ( member(V, Values), V > Most ),
      Found) :-
    memberchk(Case-Runs, CaseRuns),
    shortfalls(Runs, Values),
    Values = [_|_],
    median(Values, Median),
    length(Values, Count),
    aggregate_over(Most, Values, Over),
    format(atom(Found), 'median ~2f, ~d of ~d above', [Median, Over, Count]).

aggregate_over(Most, Values, Over) :-
    findall(V, ( member(V, Values), V > Most ), Above),
    length(Above, Over).

complete(Case, CaseRuns, Some, Count, Found) :-
    values(reached, Case, CaseRuns, Values),
    length(Values, Count),
    findall(V, ( member(V, Values), V =:= 100 ), All),
    length(All, Some),
    format(atom(Found), 'in ~d of ~d runs', [Some, Count]).

compared(What, Case, Other, CaseRuns, A, B, Found) :-
    middle(What, Case, CaseRuns, A),
    middle(What, Other, CaseRuns, B),
    case_name(Case, Name),
    case_name(Other, OtherName),
    format(atom(Found), '~w ~w: ~w, ~w: ~w', [What, Name, A, OtherName, B]).

middle(What, Case, CaseRuns, Middle) :-
    values(What, Case, CaseRuns, Values),
    (   median(Values, Middle0)
    ->  Middle = Middle0
    ;   Middle = none
    ).

values(What, Case, CaseRuns, Values) :-
    memberchk(Case-Runs, CaseRuns),
    findall(V, ( member(_-Result, Runs), measure(What, Result, V) ), Values).
