%   Sequences of tasks on parts of the hosts of a grid.
%
%   Expects the parameters `hosts`, `agents`, `sequences` and `share`.  Gives:
%   network/3, view/2, the measures of one run, a_sequence/2, subsets/4,
%   tasks/2.

:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module(metrics).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).

fixed(tasks, 3, assumed("of each sequence")).
fixed(delta, 0.3, assumed("other hosts neither reward nor penalise")).
fixed(task_time, 3, assumed("as in chapter 5")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(limit, 5000, assumed("host seconds; a run that takes longer fails")).

label(total, "Time until all tasks are completed (s)").
label(idle, "Idle time between the tasks of a sequence (s)").
label(overlaps, "Overlapped executions").
label(premature, "Overlaps before all had begun the previous task").
label(missing, "Executions missing").
label(out_of_order, "Executions out of order").

network(Case, grid(Rows, 10), [hop_time(uniform(Min, Max))]) :-
    Rows is Case.hosts // 10,
    Min-Max = Case.hop_time.

a_sequence(Case, Name) :-
    between(1, Case.sequences, N),
    atom_concat(sequence, N, Name).

tasks(Case, Tasks) :-
    findall(Task-sleep(Case.task_time), between(1, Case.tasks, Task), Tasks).

%   subsets(+Names, +Case, +Hosts, -Pairs): for each of Names the hosts that
%   take part in it, drawn from the seed.

subsets(Names, Case, Hosts, Pairs) :-
    chosen(Case, Count),
    chance_seed(Case.seed, Chance),
    foldl(subset(Count, Hosts), Names, Pairs, Chance, _).

chosen(Case, Count) :-
    Count is round(Case.share*Case.hosts).

subset(Count, Hosts, Name, Name-Set, Chance0, Chance) :-
    chance_sample(Count, Hosts, Set, Chance0, Chance).

%   The view has Name-part(Hosts, Executions) for each sequence.  Each host that
%   takes part has a plan, so it either executes or has a task missing.

view(Log, view{case:(Log.case), parts:Parts}) :-
    from_start(Log.events, Events),
    findall(Name-part(Hosts, Executions),
            ( a_sequence(Log.case, Name), part(Events, Name, Hosts, Executions) ),
            Parts).

part(Events, Name, Hosts, Executions) :-
    include(of(Name), Events, Own),
    executions(Own, Executions),
    findall(Host, member(execution(_, Host, _, _), Executions), All),
    sort(All, Hosts).

of(Name, event(_, _, _, executing(Name, _))).
of(Name, event(_, _, _, completed(Name, _))).

measure(wanted, View, Count) :-
    chosen(View.case, Hosts),
    Count is Hosts * View.case.tasks * View.case.sequences.
measure(executions, View, Count) :-
    aggregate_all(count, an_execution(View, _), Count).
measure(missing, View, Missing) :-
    measure(wanted, View, Wanted),
    findall(Name-Host-Task,
            ( member(Name-part(_, Executions), View.parts),
              member(execution(Task, Host, _, _), Executions) ),
            Done0),
    sort(Done0, Done),
    length(Done, Count),
    Missing is Wanted - Count.
measure(total, View, Total) :-
    aggregate_all(max(End), an_execution(View, execution(_, _, _, End)), Total).
measure(idle, View, Mean) :-
    findall(Idle,
            ( member(_-part(_, Executions), View.parts),
              task_rows(Executions, Rows),
              idle_time(Rows, Idle) ),
            Idles),
    sum_list(Idles, Sum),
    Mean is Sum/View.case.sequences.
measure(Name, View, Count) :-
    member(Name, [overlaps, premature, out_of_order]),
    findall(E,
            ( member(_-part(_, Executions), View.parts),
              call(Name, Executions, Found),
              member(E, Found) ),
            Es),
    length(Es, Count).

an_execution(View, Execution) :-
    member(_-part(_, Executions), View.parts),
    member(Execution, Executions).
