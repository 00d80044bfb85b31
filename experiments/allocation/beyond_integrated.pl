%   Beyond the thesis: chapter 7 finds robots, chapter 6 has them execute
%   sequences of tasks in step.

:- include(robots).
:- use_module('../../prolog/typhon', [network_advance/2]).
:- use_module('../../agents/allocation/sequence',
              [sequence_begin/6, sequence_over/3, sequence_proceed/2]).
:- use_module(faults, [no_reservation_faults/1]).
:- use_module(mechanisms, [allocators_end/2]).
:- use_module(timetable).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [member/2, numlist/3]).

study(integrated, "Sequences of tasks on allocated robots").
text("Two sequences of three tasks need ten of the same fifteen robots each.  \c
For each an allocator finds and holds robots, and a self-regulating \c
population of agents has them execute the tasks in step.").

fixed(sequences, 2, assumed("so that one has to wait")).
fixed(length, 3, assumed("tasks of each")).
fixed(task_time, 5, assumed("seconds")).
fixed(hosts, 30, assumed("agents of chapter 6 search all hosts")).
fixed(probability, 0.2, assumed("six links at a host")).
derive(allocators, Case, Case.sequences).

label(found, "The last sequence has its robots (s)").
label(completed, "The last sequence is completed (s)").
label(faulty, "Robots that did not execute each task once").
label(strangers, "Hosts that executed without being allocated").
label(overlaps, "Executions before the previous task was completed").
label(disorder, "Executions out of order").
label(both, "Executions for two sequences at once").
label(communications, "Communications of the allocators").

run(Case, Network) :-
    places(Case, Network, Starts),
    names(Case, Names),
    maplist(begin(Case), Names, Starts, Sequences),
    proceed(Sequences, Case.limit, Network),
    allocators_end(Network, Case.limit).

begin(Case, Name, Host, Sequence) :-
    findall(Task-sleep(Case.task_time), between(1, Case.length, Task), Tasks),
    sequence_begin(Name, [Case.required-[push]], Host, Tasks,
                   [ deadline(Case.limit),
                     allocation([settings([seed-Case.seed])]),
                     population([seed(Case.seed)]) ],
                   Sequence).

proceed(Sequences0, Limit, Network) :-
    Limit > 0,
    maplist(sequence_proceed, Sequences0, Sequences),
    (   forall(member(Sequence, Sequences),
               sequence_over(Sequence, _, completed))
    ->  true
    ;   network_advance(Network, 0.5),
        Left is Limit - 0.5,
        proceed(Sequences, Left, Network)
    ).

names(Case, Names) :-
    findall(Name, ( between(1, Case.sequences, I),
                    atom_concat(sequence, I, Name) ), Names).

view(Log, View) :-
    no_reservation_faults(Log.events),
    names(Log.case, Names),
    timetable(Log.events, Names, Log.case.length, View).

measure(Name, View, Value) :-
    timetable_measure(Name, View, Value).

claim("each robot of a sequence executes each of its tasks once", [ours],
      faulty =:= 0).
claim("no other robot executes any task", [ours], strangers =:= 0).
claim("no task begins before all robots have completed the previous one",
      [ours],
      overlaps =:= 0).
claim("all tasks are executed in order", [ours], disorder =:= 0).
claim("no robot executes for two sequences at once", [ours], both =:= 0).

plot(integrated, "Two sequences of tasks on allocated robots",
     script('timetable.gp', [held-held_rows, executed-executed_rows],
            [seed(first), size(1000, 600), variables(timetable_extent)])).
