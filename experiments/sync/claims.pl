:- module(sync_claims,
          [ sync_claims/2               % +Result, -Claims
          ]).
:- use_module(metrics,
              [burst/4, out_of_order/2, overlaps/2, tau_max/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, min_list/2]).

:- meta_predicate
    truth(0, -).

/** <module> What the thesis says of synchronised execution, checked

*Threading*: pure.
*/

%!  sync_claims(+Result, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found) about the Result of
%   sync_run/3.

sync_claims(Result, Claims) :-
    findall(claim(Text, Held, Found),
            ( claim(Name, Text),
              check(Name, Result, Held, Found)
            ),
            Claims).

claim(ended,    'all agents end by themselves').
claim(once,     'every host executes every task exactly once').
claim(order,    'no host executes a task before the earlier ones').
claim(tau,      'never more than two distinct tasks are required (tau)').
claim(overlaps, 'no task begins before all hosts had the previous one').
claim(idle,     'the agents are idle between any two tasks').
claim(burst,    'the first task begins with the largest burst').

check(ended, Result, Held, Found) :-
    memberchk(outcomes(Outcomes), Result),
    length(Outcomes, Count),
    exclude(==(done), Outcomes, Others),
    length(Others, OtherCount),
    Done is Count - OtherCount,
    truth(Others == [], Held),
    (   Held == true
    ->  format(atom(Found), '~d of ~d', [Done, Count])
    ;   format(atom(Found), '~d of ~d; others: ~q', [Done, Count, Others])
    ).
check(once, Result, Held, Found) :-
    memberchk(hosts(Hosts), Result),
    memberchk(tasks(Tasks), Result),
    memberchk(executions(Executions), Result),
    aggregate_all(count, ( member(_, Hosts), member(_, Tasks) ), Expected),
    length(Executions, Count),
    findall(H-T, member(execution(T, H, _, _), Executions), Pairs),
    sort(Pairs, Distinct),
    length(Distinct, DistinctCount),
    truth((Count =:= Expected, DistinctCount =:= Expected), Held),
    format(atom(Found), '~d executions, ~d of ~d pairs of host and task',
           [Count, DistinctCount, Expected]).
check(order, Result, Held, Found) :-
    memberchk(executions(Executions), Result),
    out_of_order(Executions, OutOfOrder),
    length(OutOfOrder, Count),
    truth(Count =:= 0, Held),
    format(atom(Found), '~d executions out of order', [Count]).
check(tau, Result, Held, Found) :-
    memberchk(steps(Steps), Result),
    tau_max(Steps, Tau),
    truth(Tau =< 2, Held),
    format(atom(Found), 'at most ~d', [Tau]).
check(overlaps, Result, Held, Found) :-
    memberchk(executions(Executions), Result),
    overlaps(Executions, Overlapping),
    length(Overlapping, Count),
    truth(Count =:= 0, Held),
    format(atom(Found), '~d overlapped executions', [Count]).
check(idle, Result, Held, Found) :-
    memberchk(rows(Rows), Result),
    findall(Idle, ( member(task(_, _, _, _, _, Idle), Rows), Idle \== none ),
            Gaps),
    Gaps = [_|_],
    min_list(Gaps, Least),
    truth(Least > 0, Held),
    format(atom(Found), 'at least ~2f s', [Least]).
check(burst, Result, Held, Found) :-
    memberchk(executions(Executions), Result),
    memberchk(tasks([First|Later]), Result),
    Later = [_|_],
    burst(First, 1, Executions, Count),
    maplist(later_burst(Executions), Later, Counts),
    max_list(Counts, Most),
    truth(Count > Most, Held),
    format(atom(Found), '~d hosts in its first second, later at most ~d',
           [Count, Most]).

later_burst(Executions, Task, Count) :-
    burst(Task, 1, Executions, Count).

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).
