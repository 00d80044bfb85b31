:- module(robots_pole_claims,
          [ pole_claims/3               % +Synchronised, +Alone, -Claims
          ]).
:- use_module('../sync/metrics', [out_of_order/2, overlaps/2, tau_max/2]).
:- use_module(pole_metrics,
              [ carried/2, durations/3, max_tilt/2, mingled/2, over_limit/3,
                starts_apart/3
              ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists),
              [last/2, max_list/2, member/2, memberchk/2, min_list/2]).

:- meta_predicate
    truth(0, -).

/** <module> What the thesis says of robots that carry a pole, checked

*Threading*: pure.
*/

%!  pole_claims(+Synchronised, +Alone, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found) about two results of
%   pole_run/4, with and without synchronisation.

pole_claims(Synchronised, Alone, Claims) :-
    findall(claim(Text, Held, Found),
            ( claim(Name, Case, Text),
              result(Case, Synchronised, Alone, Result),
              check(Name, Result, Held, Found)
            ),
            Claims).

result(synchronised, Result, _, Result).
result(alone, _, Result, Result).

claim(ended, synchronised,   'all agents end by themselves').
claim(once, synchronised,
      'every robot executes the four tasks once, in order').
claim(start, synchronised,
      'all robots begin the first task at the same time (within 3 s)').
claim(different, synchronised,
      'the robots take different times to reach the pole').
claim(apart, synchronised,
      'no robot begins a task before all have ended the previous one').
claim(tau, synchronised,
      'never more than two distinct tasks are required (tau)').
claim(level, synchronised,   'the pole never tilts beyond the limit').
claim(carried, synchronised,
      'the pole is carried 1.2 m (within 5 cm), and put down').
claim(mingled, alone,
      'without synchronisation robots begin tasks before others are ready').
claim(tilted, alone,
      'without synchronisation the pole tilts beyond the limit').

check(ended, Result, Held, Found) :-
    memberchk(outcomes(Outcomes), Result),
    length(Outcomes, Count),
    exclude(==(done), Outcomes, Others),
    length(Others, OtherCount),
    Done is Count - OtherCount,
    truth(Others == [], Held),
    format(atom(Found), '~d of ~d', [Done, Count]).
check(once, Result, Held, Found) :-
    executions(Result, Executions),
    memberchk(hosts(Hosts), Result),
    memberchk(tasks(Tasks), Result),
    aggregate_all(count, ( member(_, Hosts), member(_, Tasks) ), Expected),
    length(Executions, Count),
    findall(H-T, member(execution(T, H, _, _), Executions), Pairs),
    sort(Pairs, Distinct),
    length(Distinct, Different),
    out_of_order(Executions, Wrong),
    length(Wrong, WrongCount),
    truth(( Count =:= Expected, Different =:= Expected, Wrong == [] ), Held),
    format(atom(Found), '~d executions, ~d of ~d pairs of robot and task, \c
~d out of order', [Count, Different, Expected, WrongCount]).
check(start, Result, Held, Found) :-
    executions(Result, Executions),
    starts_apart(Executions, 1, Seconds),
    truth(Seconds =< 3, Held),
    format(atom(Found), 'within ~1f s', [Seconds]).
check(different, Result, Held, Found) :-
    executions(Result, Executions),
    durations(Executions, 1, Durations),
    Durations = [_, _|_],
    min_list(Durations, Least),
    max_list(Durations, Most),
    truth(Most > 1.5 * Least, Held),
    format(atom(Found), '~1f to ~1f s', [Least, Most]).
check(apart, Result, Held, Found) :-
    mingled_counts(Result, Mingled, Overlapping),
    memberchk(rows(Rows), Result),
    findall(Idle, ( member(task(_, _, _, _, _, Idle), Rows), Idle \== none ),
            Gaps),
    Gaps = [_|_],
    min_list(Gaps, Least),
    truth(( Mingled =:= 0, Overlapping =:= 0 ), Held),
    format(atom(Found), '~d such executions; at least ~1f s between two \c
tasks', [Mingled, Least]).
check(tau, Result, Held, Found) :-
    memberchk(steps(Steps), Result),
    tau_max(Steps, Tau),
    truth(Tau =< 2, Held),
    format(atom(Found), 'at most ~d', [Tau]).
check(level, Result, Held, Found) :-
    tilt(Result, Limit, Tilt, _),
    truth(Tilt =< Limit, Held),
    format(atom(Found), 'at most ~1f of ~1f degrees', [Tilt, Limit]).
check(carried, Result, Held, Found) :-
    memberchk(states(States), Result),
    carried(States, Metres),
    phase(States, Phase),
    truth(( abs(Metres - 1.2) =< 0.05, Phase == lying ), Held),
    format(atom(Found), '~2f m, ~w', [Metres, Phase]).
check(mingled, Result, Held, Found) :-
    mingled_counts(Result, Mingled, Overlapping),
    truth(Mingled > 0, Held),
    format(atom(Found), '~d executions before all had ended the previous \c
task, ~d before all had begun it', [Mingled, Overlapping]).
check(tilted, Result, Held, Found) :-
    tilt(Result, Limit, Tilt, Seconds),
    truth(Tilt > Limit, Held),
    format(atom(Found), 'up to ~1f of ~1f degrees, beyond it for ~1f s',
           [Tilt, Limit, Seconds]).

executions(Result, Executions) :-
    memberchk(executions(Executions), Result).

mingled_counts(Result, Mingled, Overlapping) :-
    executions(Result, Executions),
    mingled(Executions, Early),
    length(Early, Mingled),
    overlaps(Executions, Overlaps),
    length(Overlaps, Overlapping).

tilt(Result, Limit, Tilt, Seconds) :-
    memberchk(states(States), Result),
    memberchk(tilt_limit(Limit), Result),
    max_tilt(States, Tilt),
    over_limit(States, Limit, Seconds).

phase(States, Phase) :-
    last(States, state(_, Pole)),
    arg(9, Pole, Phase).

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).
