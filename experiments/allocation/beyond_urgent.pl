%   Beyond the thesis: an urgent task that arrives late, and deadlines.

:- include(robots).
:- use_module('../../prolog/typhon', [network_advance/2]).
:- use_module(faults, [no_reservation_faults/1]).
:- use_module(mechanisms, [allocators_end/2, task_start/3]).
:- use_module(metrics, [lasted/3, mean/2, overdue/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

study(urgent, "An urgent task that arrives late, and deadlines").
text("Of five tasks that need the same robots the last one arrives while the \c
others are being allocated.  It may have a priority: it takes over robots \c
that are reserved, but not executing yet.  Or all tasks have a deadline.").

vary(priority, [0, 1]).
vary(deadline, [0, 30, 60, 120]).
skip(Case) :-
    Case.priority > 0,
    Case.deadline > 0.
fixed(late, 3, assumed("seconds until the last task arrives")).

label(late, "From arrival to completion: the last task (s)").
label(others, "From arrival to completion: the other tasks, mean (s)").
label(done, "Tasks completed").
label(missed, "Tasks missed").
label(reported, "From the deadline to the report of a missed task (s)").
label(free, "From the deadline until all its robots are free (s)").

run(Case, Network) :-
    places(Case, Network, Starts),
    tasks(Case, Tasks0),
    maplist(detailed(Case), Tasks0, Tasks),
    pairs_keys_values(Pairs, Tasks, Starts),
    append(Early, [Task1-Host1], Pairs),
    !,
    forall(member(Task-Host, Early), task_start(Task, Host, Case)),
    network_advance(Network, Case.late),
    task_start(Task1, Host1, Case),
    allocators_end(Network, Case.limit).

%   Names are numbers; the last task has the greatest.

detailed(Case, task(Name, Teams, Details0), task(Name, Teams, Details)) :-
    findall(Detail,
            (   Name == Case.allocators, Detail = priority(Case.priority)
            ;   Case.deadline > 0, Detail = deadline(Case.deadline)
            ),
            More),
    append(More, Details0, Details).

view(Log, View) :-
    no_reservation_faults(Log.events),
    View = view{case:Log.case, events:Log.events},
    measure(done, View, Done),
    measure(missed, View, Missed),
    Log.case.allocators =:= Done + Missed.

measure(late, View, Seconds) :-
    lasted(View.events, View.case.allocators, Seconds).
measure(others, View, Mean) :-
    findall(Seconds, ( lasted(View.events, Task, Seconds),
                       Task \== View.case.allocators ), All),
    mean(All, Mean).
measure(done, View, Count) :-
    aggregate_all(count, lasted(View.events, _, _), Count).
measure(missed, View, Count) :-
    aggregate_all(count, member(event(_, _, _, missed(_, _)), View.events),
                  Count).
measure(reported, View, Seconds) :-
    aggregate_all(max(S), overdue(View.events, S, _), Seconds).
measure(free, View, Seconds) :-
    aggregate_all(max(S), overdue(View.events, _, S), Seconds).

claim("the last task is completed sooner if it is urgent", [ours],
      at([deadline=0], falls(late, along(priority)))).
claim("the others are completed as well, on average in less than half as much \c
time again", [ours],
      at([deadline=0, priority=1], others < 3/2*at([priority=0], others))).
claim("a missed deadline is reported within 2 s", [ours], reported =< 2).
claim("all robots of a task that is missed are free within 60 s, when they \c
would ask", [ours], free =< 60).
claim("the later the deadline, the more tasks are completed", [ours],
      ( at([deadline=30], done =< at([deadline=60], done)),
        at([deadline=60], done =< at([deadline=120], done)),
        at([deadline=30], done < at([deadline=120], done)) )).

plot(urgent, "Priorities: the last task arrives late",
     lines([ x(priority), y([late, others]), where([deadline=0]) ])).
plot(deadlines, "Deadlines for all tasks",
     lines([ x(deadline), y([done, reported, free]),
             where([deadline=in([30, 60, 120])]) ])).
