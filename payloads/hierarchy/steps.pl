:- payload(steps, [provides([crew/4, seen/2, decided/4])]).

/*  Leaders of synchronised execution (agents/hierarchy/leader.pl): workers
    are agents(sync/traveller), a round is a sequence of tasks, and the
    mechanism learns the penalty bias.

    No task may begin before all hosts have completed the previous one.  The
    completion times on the hosts give the spread of a task, the time from its
    first host to its last one, and the step, the time until the next task is
    first completed.  The step is nearly proportional to 1/delta
    (doc/analysis.md), so the mechanism changes delta until the next task
    follows one spread after the last host.  delta decreases fast and increases
    slowly, because executions that overlap cannot be undone.
*/

crew(Round, Hosts, Settings, Orders) :-
    memberchk(workers-Count, Settings),
    sense(plan(Round, Version, Tasks)),
    findall(setting(Name, Value), member(Name-Value, Settings), Facts),
    length(Hosts, Length),
    findall(order(agents(sync/traveller),
                  [ host(Host),
                    facts([ plan(Round, Version, Tasks), setting(start, order)
                          | Facts ]) ]),
            ( between(1, Count, I),
              Index is (I - 1)*Length // Count,
              nth0(Index, Hosts, Host) ),
            Orders).

seen(Round, Facts) :-
    findall(done(Task, Time), sense(task(Round, Task, completed, Time)), Facts).

%   Without two completed tasks there is no step, and delta does not change.

decided(Reports, Memory, Memory, Orders) :-
    findall(Task-Time,
            ( member(_-report(_, _, Facts), Reports),
              member(done(Task, Time), Facts) ),
            Times),
    findall(Delta,
            ( member(_-report(Settings, _, _), Reports),
              memberchk(delta-Delta, Settings) ),
            Deltas),
    sum_list(Deltas, Sum),
    length(Deltas, Count),
    Delta0 is Sum/Count,
    better(Times, Delta0, Delta),
    findall(Leader-[delta-Delta], member(Leader-_, Reports), Orders).

better(Times, Delta0, Delta) :-
    findall(step(First, Last), task_times(Times, First, Last), Steps0),
    sort(1, @=<, Steps0, Steps),
    findall(Gap, ( append(_, [step(A, _), step(B, _)|_], Steps), Gap is B - A ),
            Gaps),
    Gaps = [_|_],
    !,
    findall(Spread, ( member(step(A, B), Steps), Spread is B - A ), Spreads),
    min_list(Gaps, Least),
    max_list(Spreads, Most),
    Change is Least/max(0.001, 2*Most),
    Delta is min(2.0, max(0.02, Delta0*min(1.2, max(0.2, Change)))).
better(_, Delta, Delta).

task_times(Times, First, Last) :-
    findall(Task, member(Task-_, Times), Tasks0),
    sort(Tasks0, Tasks),
    member(Task, Tasks),
    findall(Time, member(Task-Time, Times), Own),
    min_list(Own, First),
    max_list(Own, Last).
