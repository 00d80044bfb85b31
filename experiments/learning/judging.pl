:- module(learning_judging,
          [ judged/4                    % +Test, +Data, -Held, -Found
          ]).
:- use_module(measures,
              [distance/4, learner/2, looked/4, measured/4, path/2,
               truth/2, value/3]).
:- use_module(metrics, [mean/2, spread/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [append/3, last/2, max_list/2, member/2, memberchk/2,
               min_list/2, sum_list/2]).

/** <module> Whether what the thesis says of runs held

*Threading*: any thread; no state.
*/

%!  judged(+Test, +Data, -Held, -Found) is semidet.
%
%   Held is `true` or `false`, Found says what was found.  Data are pairs
%   Case-Results, the cases of a figure.  Fails if Data has no runs that
%   Test could be applied to.  Kinds are those of cases, Key is Kind-Hosts;
%   Measure is `executions` or `sharing` (see learning_metrics), `total` of
%   all agents, or `overlaps` of paths.  Test is
%
%     - in_runs(Kind, What)
%       Each run is `distinct`, `same` or `overlapped` in its paths, or
%       `falling` in its sharing events.  Paths are the same if they lead
%       through the same cells.
%     - near(Measure, Kind, Wanted), near_at(Measure, Case, Wanted)
%       Within a tenth of Wanted.
%     - none_at(Measure, Case)
%       It is 0.
%     - smaller(Measure, Kind1, Kind2), less_than_half(M, Kind1, Kind2)
%       The first one is smaller; the second less than half of the first.
%     - together(Kind1, Kind2)
%       Plans differ less, by their length, in the first.
%     - falls(Measure, Key), rises(Measure, Key)
%       From density to density, never up, or always up.
%     - largest_step(Measure, Key)
%       It falls most from the first density to the second.
%     - steady(Measure, Key, Most)
%       The last two densities differ by less.
%     - early_gain(Measure)
%       It rises more at the first step than at all later ones.
%     - alike(Measure, D, Most)
%       Networks differ at this density by Most of their mean, or less.
%     - above(Measure)
%       It is greater with an obstacle, at every density.
%     - run_lengths(Least, Most), converged, degrees(Most)
%       Of all runs; Most within a tenth.
%     - aside(Kind, Line, Most)
%       Final paths are so many cells from the `diagonal`, or the `wall`.

judged(Test, Data, Held, Found) :-
    test(Test, Data, Goal, Found),
    truth(Goal, Held).

%   test(+Test, +Data, -Goal, -Found): Found is what was found; the test
%   holds if Goal does.

test(in_runs(Kind, What), Data, Held =:= Count, Found) :-
    memberchk(case(Kind, _, _)-Results, Data),
    findall(Verdict-Note,
            ( member(Result, Results), looked(What, Result, Verdict, Note) ),
            Pairs),
    length(Pairs, Count),
    aggregate_all(count, member(true-_, Pairs), Held),
    findall(Note, member(_-Note, Pairs), Notes),
    atomic_list_concat(Notes, ', ', Text),
    format(atom(Found), 'in ~d of ~d runs (~w)', [Held, Count, Text]).
test(near(Measure, Kind, Wanted), Data, Goal, Found) :-
    memberchk(case(Kind, _, _)-Results, Data),
    near(Measure, Results, Wanted, Goal, Found).
test(near_at(Measure, Case, Wanted), Data, Goal, Found) :-
    memberchk(Case-Results, Data),
    near(Measure, Results, Wanted, Goal, Found).
test(none_at(Measure, Case), Data, Value =:= 0, Value) :-
    memberchk(Case-Results, Data),
    value(Measure, Results, Value).
test(less_than_half(Measure, Kind1, Kind2), Data, V2 < V1/2, Found) :-
    two(Measure, Kind1, Kind2, Data, V1, V2),
    Share is V2/max(1, V1),
    format(atom(Found), '~1f of ~1f, ~2f', [V2, V1, Share]).
test(smaller(Measure, Kind1, Kind2), Data, V1 < V2, Found) :-
    two(Measure, Kind1, Kind2, Data, V1, V2),
    format(atom(Found), '~2f, ~2f', [V1, V2]).
test(together(Kind1, Kind2), Data, V1 < V2, Found) :-
    memberchk(case(Kind1, _, _)-Results1, Data),
    memberchk(case(Kind2, _, _)-Results2, Data),
    spread(Results1, Actions1, V1),
    spread(Results2, Actions2, V2),
    format(atom(Found), '~3f, ~3f (~1f, ~1f actions)',
           [V1, V2, Actions1, Actions2]).
test(falls(Measure, Key), Data, \+ next_to(Values, A, B, B > A), Found) :-
    series(Measure, Key, Data, Values, Found).
test(rises(Measure, Key), Data, \+ next_to(Values, A, B, B =< A), Found) :-
    series(Measure, Key, Data, Values, Found).
test(largest_step(Measure, Key), Data, Goal, Found) :-
    series(Measure, Key, Data, Values, Found),
    findall(Drop, next_to(Values, A, B, Drop is A - B), [First|Others]),
    Goal = ( \+ ( member(Other, Others), Other >= First ) ).
test(steady(Measure, Key, Most), Data, Difference < Most, Found) :-
    series(Measure, Key, Data, Values, _),
    append(_, [Before,After], Values),
    Difference is abs(After - Before),
    format(atom(Found), '~2f, ~2f', [Before, After]).
test(alike(Measure, D, Most), Data, Share =< Most, Found) :-
    findall(Results, member(case(sharing, _, D)-Results, Data), All),
    measured(Measure, All, Values, Text),
    mean(Values, Mean),
    min_list(Values, Least),
    max_list(Values, Greatest),
    Share is (Greatest - Least)/Mean,
    format(atom(Found), '~w: ~2f of the mean', [Text, Share]).
test(above(Measure), Data, \+ ( member(A-B, Pairs), B =< A ), Found) :-
    findall(Plain-Value,
            ( member(case(obstacle, N, D)-Results, Data),
              memberchk(case(sharing, N, D)-Others, Data),
              value(Measure, Results, Value),
              value(Measure, Others, Plain) ),
            Pairs),
    findall(Text,
            ( member(A-B, Pairs), format(atom(Text), '~2f and ~2f', [B, A]) ),
            Texts),
    atomic_list_concat(Texts, ', ', Found).
test(early_gain(Measure), Data, B - A > C - B, Found) :-
    Data = [case(Kind, N, _)-_|_],
    series(Measure, Kind-N, Data, [A,B|Values], Found),
    last([B|Values], C).
test(run_lengths(Least, Most), Data, Within =:= Count, Found) :-
    results(Data, Results),
    findall(T, ( member(R, Results), memberchk(duration(T), R) ), Times),
    length(Times, Count),
    aggregate_all(count, ( member(T, Times), T >= Least, T =< Most ),
                  Within),
    min_list(Times, Shortest),
    max_list(Times, Longest),
    format(atom(Found), '~d of ~d runs; ~0f to ~0f host seconds',
           [Within, Count, Shortest, Longest]).
test(converged, Data, Converged =:= All, Found) :-
    results(Data, Results),
    findall(N, ( member(R, Results), memberchk(agents(N), R) ), Ns),
    sum_list(Ns, All),
    aggregate_all(count, learner(Results, learner(_, _, converged(_, _, _))),
                  Converged),
    format(atom(Found), '~d of ~d', [Converged, All]).
test(aside(Kind, Line, Most), Data, Distance =< Most, Found) :-
    memberchk(case(Kind, _, _)-Results, Data),
    findall(D, ( member(Result, Results), path(Result, Cells),
                 distance(Line, Result, Cells, D) ), Ds),
    mean(Ds, Distance),
    format(atom(Found), '~1f cells', [Distance]).
test(degrees(Wanted), Data, Goal, Found) :-
    results(Data, Results),
    findall(A-B, ( member(R, Results), memberchk(degrees(A-B), R) ),
            Ranges),
    findall(A, member(A-_, Ranges), As),
    findall(B, member(_-B, Ranges), Bs),
    min_list(As, Least),
    max_list(Bs, Most),
    Goal = ( Least =:= 0, within_a_tenth(Most, Wanted) ),
    format(atom(Found), '~d to ~d', [Least, Most]).

:- meta_predicate next_to(+, ?, ?, 0).

%   next_to(+Values, -A, -B, :Goal): A and B follow each other, and Goal.

next_to(Values, A, B, Goal) :-
    append(_, [A,B|_], Values),
    call(Goal).

near(Measure, Results, Wanted, within_a_tenth(Value, Wanted), Found) :-
    value(Measure, Results, Value),
    format(atom(Found), '~1f', [Value]).

within_a_tenth(Value, Wanted) :-
    abs(Value - Wanted) =< Wanted/10.

two(Measure, Kind1, Kind2, Data, V1, V2) :-
    memberchk(case(Kind1, _, _)-Results1, Data),
    memberchk(case(Kind2, _, _)-Results2, Data),
    value(Measure, Results1, V1),
    value(Measure, Results2, V2).

%   series(+Measure, +Key, +Data, -Values, -Found): in the order of the
%   densities.  Found has the standard errors, too, where there are several
%   runs.

series(Measure, Kind-N, Data, Values, Found) :-
    findall(Results, member(case(Kind, N, _)-Results, Data), All),
    measured(Measure, All, Values, Found).

results(Data, Results) :-
    findall(Result, ( member(_-Some, Data), member(Result, Some) ), Results).

