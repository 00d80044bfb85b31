:- module(sync_claims,
          [ sync_claims/2               % +Result, -Claims
          ]).
:- use_module(metrics,
              [burst/4, out_of_order/2, overlaps/2, tau_max/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists),
              [append/2, max_list/2, member/2, memberchk/2, min_list/2]).

:- meta_predicate
    truth(0, -).

/** <module> What the thesis says of synchronised execution, checked

*Threading*: pure.
*/

%!  sync_claims(+Result, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found) about the Result of
%   sync_run/3.  Where nothing was lost there are none about healing, and
%   where something was, none about what holds undisturbed.

sync_claims(Result, Claims) :-
    memberchk(healing(Healing), Result),
    memberchk(failure(Failure), Result),
    kinds(Healing, Failure, Kinds),
    findall(claim(Text, Held, Found),
            ( claim(Name, Kind, Text),
              memberchk(Kind, Kinds),
              check(Name, Result, Held, Found)
            ),
            Claims).

kinds([], _, [any, calm]) :-
    !.
kinds(_, Failure, [any, healing, Kind]) :-
    functor(Failure, Kind, _).

claim(ended, any,  'all agents end by themselves').
claim(once, calm,  'every host executes every task exactly once').
claim(again, healing,
      'every host executes every task once, and once more what it lost').
claim(order, any,  'no host executes a task before the earlier ones').
claim(tau, calm,   'never more than two distinct tasks are required (tau)').
claim(overlaps, any,
      'no task begins before all hosts had the previous one').
claim(idle, calm,  'the agents are idle between any two tasks').
claim(burst, calm, 'the first task begins with the largest burst').
claim(healing_tau, atomic,
      'three distinct tasks are required while healing (tau)').
claim(later_tau, healing, 'afterwards two at most').

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
    counts(Result, Expected, Count, Distinct),
    truth((Count =:= Expected, Distinct =:= Expected), Held),
    format(atom(Found), '~d executions, ~d of ~d pairs of host and task',
           [Count, Distinct, Expected]).
check(again, Result, Held, Found) :-
    counts(Result, Expected, Count, Distinct),
    memberchk(healing(Healing), Result),
    memberchk(lost(Lost), Healing),
    memberchk(redone(Redone), Healing),
    truth(( Distinct =:= Expected,
            Redone =:= Lost,
            Count =:= Expected + Lost ), Held),
    format(atom(Found), '~d executions, ~d of ~d pairs of host and task, \c
~d of ~d lost ones again', [Count, Distinct, Expected, Redone, Lost]).
check(order, Result, Held, Found) :-
    memberchk(phases(Phases), Result),
    memberchk(executions(Executions), Result),
    (   Phases = [_, After],
        memberchk(failure(cascaded(_, _, _)), Result)
    ->  out_of_order(After, OutOfOrder)
    ;   out_of_order(Executions, OutOfOrder)
    ),
    length(OutOfOrder, Count),
    truth(Count =:= 0, Held),
    format(atom(Found), '~d executions out of order', [Count]).
check(tau, Result, Held, Found) :-
    memberchk(steps(Steps), Result),
    tau_max(Steps, Tau),
    truth(Tau =< 2, Held),
    format(atom(Found), 'at most ~d', [Tau]).
check(overlaps, Result, Held, Found) :-
    memberchk(phases(Phases), Result),
    maplist(overlaps, Phases, Lists),
    append(Lists, Overlapping),
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
check(healing_tau, Result, Held, Found) :-
    memberchk(healing(Healing), Result),
    memberchk(healing_tau(Tau), Healing),
    truth(Tau =:= 3, Held),
    format(atom(Found), 'at most ~d', [Tau]).
check(later_tau, Result, Held, Found) :-
    memberchk(healing(Healing), Result),
    memberchk(later_tau(Tau), Healing),
    truth(Tau =< 2, Held),
    format(atom(Found), 'at most ~d', [Tau]).

%   counts(+Result, -Expected, -Count, -Distinct): pairs of host and task,
%   executions, and pairs among these.

counts(Result, Expected, Count, Distinct) :-
    memberchk(hosts(Hosts), Result),
    memberchk(tasks(Tasks), Result),
    memberchk(executions(Executions), Result),
    aggregate_all(count, ( member(_, Hosts), member(_, Tasks) ), Expected),
    length(Executions, Count),
    findall(H-T, member(execution(T, H, _, _), Executions), Pairs),
    sort(Pairs, DistinctPairs),
    length(DistinctPairs, Distinct).

later_burst(Executions, Task, Count) :-
    burst(Task, 1, Executions, Count).

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).
