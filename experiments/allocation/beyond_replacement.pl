%   Beyond the thesis: robots fail in the middle of a sequence of tasks, and
%   their replacements execute it.

:- include(robots).
:- use_module('../../prolog/typhon', [network_advance/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module('../../agents/allocation/operator', [robot_fail/1]).
:- use_module('../../agents/allocation/sequence',
              [sequence_begin/6, sequence_over/3, sequence_proceed/2]).
:- use_module('../sync/metrics', [executions/2]).
:- use_module(faults, [no_reservation_faults/1]).
:- use_module(mechanisms, [allocators_end/2]).
:- use_module(timetable).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [last/2, member/2, memberchk/2, subtract/3]).

study(replacement, "Replacement of robots that fail during a sequence").
text("Half of the robots are eligible, but no more than fifty.  An allocator \c
holds two thirds of these, and agents have them execute three tasks in step.  \c
When half of them have completed the second task, one or three tenths of the \c
robots fail.  The allocator replaces them, and the new robots execute the \c
sequence from its beginning.").

vary(hosts, [30, 100]).
vary(failing, [0, 0.1, 0.3]).
derive(eligible, Case, Count) :- Count is min(50, Case.hosts // 2).
derive(required, Case, Count) :- Count is 2*Case.eligible // 3.
derive(failures, Case, Count) :- Count is round(Case.failing*Case.required).
derive(probability, Case, P) :- P is 6/Case.hosts.
derive(links, Case, Links) :-
    ( Case.hosts > 100 -> Links = static ; Links = (dynamic) ).
skip(Case) :-
    Case.hosts > 30,
    Case.failing =:= 0.1.
fixed(length, 3, assumed("tasks")).
fixed(task_time, 5, assumed("seconds")).
fixed(allocators, 1, assumed("no other allocator asks for the robots")).
fixed(threshold, 0.01, assumed("default of the agents of chapter 6")).
fixed(lifetime, 10, printed("section 6.5")).

label(completed, "The sequence is completed (s)").
label(replaced, "Robots that replaced others").
label(catching_up,
      "From the last replacement until it has executed all tasks (s)").
label(overlaps, "Executions before the previous task was completed").
label(faulty, "Robots that did not execute each task once").
label(disorder, "Executions out of order").
label(after, "Executions begun by lost robots after their loss").

run(Case, Network) :-
    places(Case, Network, [Host]),
    findall(Task-sleep(Case.task_time), between(1, Case.length, Task), Tasks),
    sequence_begin(main, [Case.required-[push]], Host, Tasks,
                   [ deadline(Case.limit),
                     allocation([settings([seed-Case.seed])]),
                     population([ seed(Case.seed),
                                  settings([ threshold-(Case.threshold),
                                             lifetime-(Case.lifetime) ]) ]) ],
                   Sequence0),
    until(half_way, Sequence0, Case.limit, Network, Sequence),
    fail_some(Case, Sequence),
    until(all_done, Sequence, Case.limit, Network, _),
    allocators_end(Network, Case.limit).

:- public half_way/1, all_done/1.

half_way(sequence(executing(Robots, _), _, _)) :-
    aggregate_all(count,
                  ( member(Robot, Robots),
                    remote(Robot, sense(task(main, 2, completed, _))) ),
                  Count),
    length(Robots, All),
    2*Count >= All.

all_done(Sequence) :-
    sequence_over(Sequence, _, completed).

until(Goal, Sequence0, Limit, Network, Sequence) :-
    Limit > 0,
    sequence_proceed(Sequence0, Sequence1),
    (   call(Goal, Sequence1)
    ->  Sequence = Sequence1
    ;   network_advance(Network, 0.5),
        Left is Limit - 0.5,
        until(Goal, Sequence1, Left, Network, Sequence)
    ).

fail_some(Case, sequence(executing(Robots, _), _, _)) :-
    chance_seed(Case.seed, Chance),
    chance_sample(Case.failures, Robots, Victims, Chance, _),
    forall(member(Victim, Victims), robot_fail(Victim)).

view(Log, view{timetable:Timetable, all:Executions, lost:Lost,
               first:First, robots:Robots, allocated:Time}) :-
    no_reservation_faults(Log.events),
    timetable(Log.events, [main], Log.case.length, Timetable),
    executions(Log.events, Executions),
    findall(Host-At, member(event(At, _, _, lost(Host, _)), Log.events), Lost),
    findall(At-Hosts, member(event(At, _, _, allocated(main, Hosts)),
                             Log.events),
            Allocations),
    Allocations = [_-First|_],
    last(Allocations, Time-Robots).

measure(Name, View, Value) :-
    member(Name, [completed, overlaps, faulty, disorder, timetable]),
    timetable_measure(Name, View.timetable, Value).
measure(replaced, View, Count) :-
    new_robots(View, New),
    length(New, Count).
measure(catching_up, View, Seconds) :-
    new_robots(View, New),
    aggregate_all(max(End), ( member(execution(_, Host, _, End), View.all),
                              memberchk(Host, New) ), Last),
    Seconds is Last - View.allocated.
measure(after, View, Count) :-
    aggregate_all(count, ( member(Host-Time, View.lost),
                           member(execution(_, Host, Start, _), View.all),
                           Start > Time + 1 ),
                  Count).

new_robots(View, New) :-
    subtract(View.robots, View.first, New).

claim("each robot that fails is replaced", [ours], replaced =:= failures).
claim("each robot held at the end has executed each task once",
      [ours], faulty =:= 0).
claim("all tasks are executed in order", [ours], disorder =:= 0).
claim("lost robots begin no task later than a second after their loss",
      [ours], after =:= 0).
claim("without failures no task begins before all have completed the one \c
before", [ours], at([failing=0], overlaps =:= 0)).
claim("if three of ten fail, the sequence takes less than 1.5 times as long",
      [ours],
      at([failing=0.3], completed < 1.5*at([failing=0], completed))).

plot(replacement, "Robots fail, and their replacements execute the sequence",
     lines([x(failing), y([completed, catching_up]), line(hosts)])).
