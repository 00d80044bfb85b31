:- module(sync_healing,
          [ failures/2,                 % +Events, -Failures
            phases/4,                   % +Kind, +Executions, +Failures,
                                        % -Phases
            healing/4                   % +Executions, +Failures, +Steps,
                                        % -Measures
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3, partition/4]).
:- use_module(library(lists),
              [last/2, max_list/2, max_member/2, member/2, memberchk/2]).

/** <module> Measures of self-healing, from an event log

The measures of thesis section 5.6.6, pure like those of sync_metrics.  A
failure is a term failure(Time, Host, Task).

*Threading*: pure.
*/

%!  failures(+Events, -Failures) is det.
%
%   The losses in the log, in order of time.

failures(Events, Failures) :-
    findall(failure(Time, Host, Task),
            member(event(Time, Host, _, failed(_, Task)), Events),
            Failures0),
    sort(1, @=<, Failures0, Failures).

%!  phases(+Kind, +Executions, +Failures, -Phases) is det.
%
%   Phases are lists of executions, each of which is a sequence of tasks in
%   step.  After an atomic failure (Kind is atomic(_,_,_)) the tasks continue,
%   so the repeated executions are a phase of their own; after a cascaded one
%   they begin again, so the phases are before and after.  Without failures
%   there is one phase.

phases(_, Executions, [], [Executions]) :-
    !.
phases(atomic(_, _, _), Executions, Failures, [Others, Redone]) :-
    !,
    partition(redone(Failures), Executions, Redone, Others).
phases(_, Executions, Failures, [Before, After]) :-
    partition(before_failure(Failures), Executions, Before, After).

%   Hosts fail one after the other, so each has its own failure time.

before_failure(Failures, execution(_, Host, Start, _)) :-
    (   memberchk(failure(Time, Host, _), Failures)
    ->  true
    ;   Failures = [failure(Time, _, _)|_]
    ),
    Start < Time.

redone(Failures, execution(Task, Host, Start, _)) :-
    member(failure(Time, Host, Task), Failures),
    Time =< Start,
    !.

%!  healing(+Executions, +Failures, +Steps, -Measures) is det.
%
%   Measures is a list of Name(Value); empty without failures:
%
%     - failed_at(Time), failed_by(Time): the first and the last failure
%     - lost(Count), hosts(Count): number of completed tasks that were lost, and
%       of hosts that lost them
%     - redone(Count): number of lost tasks that were executed again
%     - healed_at(Time): the end of the last of these executions
%     - meanwhile(Count): number of other executions that began in between
%     - healing_tau(Tau): the most distinct tasks required in between
%     - later_tau(Tau): the most distinct tasks required afterwards

healing(_, [], _, []) :-
    !.
healing(Executions, Failures, Steps, Measures) :-
    Failures = [failure(From, _, _)|_],
    last(Failures, failure(Last, _, _)),
    include(was_completed(Executions), Failures, Lost),
    length(Lost, LostCount),
    aggregate_all(count, distinct_host(Lost), Hosts),
    findall(End, redone_at(Executions, Lost, End), Ends),
    length(Ends, Redone),
    max_list([Last|Ends], Healed),
    meanwhile(Executions, Failures, Last, Healed, Meanwhile),
    tau_between(Steps, Last, Healed, HealingTau),
    tau_between(Steps, Healed, inf, LaterTau),
    Measures = [ failed_at(From), failed_by(Last), lost(LostCount),
                 lost_hosts(Hosts), redone(Redone), healed_at(Healed),
                 meanwhile(Meanwhile), healing_tau(HealingTau),
                 later_tau(LaterTau)
               ].

meanwhile(Executions, Failures, From, To, Count) :-
    aggregate_all(count,
                  ( member(E, Executions),
                    E = execution(_, _, Start, _),
                    Start > From, Start < To,
                    \+ redone(Failures, E)
                  ),
                  Count).

was_completed(Executions, failure(Time, Host, Task)) :-
    member(execution(Task, Host, _, End), Executions),
    End =< Time,
    !.

distinct_host(Lost) :-
    findall(Host, member(failure(_, Host, _), Lost), Hosts0),
    sort(Hosts0, Hosts),
    member(_, Hosts).

redone_at(Executions, Lost, End) :-
    member(failure(Time, Host, Task), Lost),
    once(( member(execution(Task, Host, Start, End), Executions),
           Start >= Time )).

%   Tau is the greatest value between From and To, including the value at From.

tau_between(Steps, From, To, Tau) :-
    findall(Time-T, ( member(Time-T, Steps), Time =< From ), Before),
    findall(T, ( member(Time-T, Steps), Time > From, Time < To ), Within),
    (   last(Before, _-T0)
    ->  max_member(Tau, [T0|Within])
    ;   max_member(Tau, [0|Within])
    ).
