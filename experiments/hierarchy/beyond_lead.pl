%   A hierarchy above synchronised execution, while the network changes.

:- include(ground).
:- use_module('../../agents/hierarchy/operator', [hierarchy_serve/4]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../../prolog/typhon', [network_property/2]).
:- use_module('../sync/metrics',
              [executions/2, from_start/2, idle_time/2, overlaps/2,
               task_rows/2]).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).

study(lead,
      "Leaders and an observer of tasks in step, while the demand changes").
text("Three leaders have a part of a grid each. In rounds 1 and 4 one row of \c
each part has tasks, in rounds 2 and 3 all four. The penalty bias δ is \c
constant (0.5, as in the thesis for a grid, or 0.1), or each leader adapts it \c
for its workers to its observations on the hosts of its part, or an observer \c
adapts it to the observations of all leaders.").

vary(control, [bold, cautious, leaders, observer]).
derive(delta, Case, Delta) :-
    ( Case.control == cautious -> Delta = 0.1 ; Delta = 0.5 ).
fixed(parts, 3, assumed("leaders")).
fixed(rows, [1,4,4,1], assumed("of six hosts, that have tasks in each part, by \c
round")).
fixed(workers, 1, assumed("of each leader")).
fixed(tasks, 3, assumed("of a round")).
fixed(task_time, 3, assumed("as in chapter 5")).
fixed(limit, 3000, assumed("host seconds; a round that takes longer fails")).

label(bold, "δ = 0.5").
label(cautious, "δ = 0.1").
label(overlaps, "Overlapped executions, all rounds").
label(settled, "Overlapped executions, rounds with unchanged hosts").
label(total, "Time in which tasks were executed (s), all rounds").
label(idle, "Idle time between tasks (s), all rounds").
label(missing, "Executions missing").
label(deltas, "Penalty bias δ, mean of the leaders").

network(Case, grid(Rows, 6), [hop_time(uniform(Min, Max))]) :-
    max_list(Case.rows, Most),
    Rows is Case.parts*Most,
    Min-Max = Case.hop_time.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    max_list(Case.rows, Most),
    Size is Most*6,
    parts(Case.parts, Size, Hosts, Parts),
    findall(Home, member([Home|_], Parts), Homes),
    lead(Case, Homes, steps, [pool-robots, delta-(Case.delta)], Leaders),
    findall(Task-sleep(Case.task_time), between(1, Case.tasks, Task), Tasks),
    forall(nth1(N, Case.rows, Rows), served(Case, N, Rows, Parts, Tasks, Leaders)).

served(Case, N, Rows, Parts0, Tasks, Leaders) :-
    Count is Rows*6,
    maplist(first(Count), Parts0, Parts),
    append(Parts, Hosts),
    round_name(N, Round),
    sequence_start(Round, Hosts, Tasks, [agents(0), pool(robots)], _),
    Timeout is 2*Case.limit,
    hierarchy_serve(Leaders, Round, Parts, Timeout).

parts(0, _, _, []) :-
    !.
parts(Count, Size, Hosts, [Part|Parts]) :-
    length(Part, Size),
    append(Part, Rest, Hosts),
    Left is Count - 1,
    parts(Left, Size, Rest, Parts).

first(Count, List, First) :-
    length(First, Count),
    append(First, _, List).

round_name(N, Round) :-
    atom_concat(round, N, Round).

                /*******************************
                *           MEASURES           *
                *******************************/

view(Log, view{case:(Log.case), rounds:Rounds, deltas:Deltas}) :-
    from_start(Log.events, Events),
    findall(Executions,
            ( a_round(Log.case, _, Round),
              include(of(Round), Events, Own),
              executions(Own, Executions) ),
            Rounds),
    findall(N-Delta,
            ( a_round(Log.case, N, Round), mean_delta(Events, Round, Delta) ),
            Deltas).

a_round(Case, N, Round) :-
    nth1(N, Case.rows, _),
    round_name(N, Round).

mean_delta(Events, Round, Delta) :-
    findall(D, ( member(event(_, _, _, leads(Round, Settings)), Events),
                 memberchk(delta-D, Settings) ), Ds),
    sum_list(Ds, Sum),
    length(Ds, Count),
    Delta is Sum/Count.

of(Round, event(_, _, _, executing(Round, _))).
of(Round, event(_, _, _, completed(Round, _))).

measure(overlaps, View, Count) :-
    overlapping(View, _, Count).
measure(settled, View, Count) :-
    Rows = View.case.rows,
    aggregate_all(sum(Some),
                  ( nth1(N, Rows, Same), Before is N - 1, nth1(Before, Rows, Same),
                    overlapping(View, N, Some) ),
                  Count).
measure(total, View, Total) :-
    aggregate_all(sum(Span),
                  ( member(Executions, View.rounds),
                    aggregate_all(span(min(S), max(E)),
                                  member(execution(_, _, S, E), Executions),
                                  span(First, Last)),
                    Span is Last - First ),
                  Total).
measure(idle, View, Total) :-
    aggregate_all(sum(Idle),
                  ( member(Executions, View.rounds),
                    task_rows(Executions, Rows),
                    idle_time(Rows, Idle) ),
                  Total).
measure(missing, View, Missing) :-
    Case = View.case,
    sum_list(Case.rows, Rows),
    aggregate_all(count, ( member(Executions, View.rounds), member(_, Executions) ),
                  Done),
    Missing is Rows*6*Case.parts*Case.tasks - Done.
measure(deltas, View, View.deltas).
measure(overlaps_by_round, View, Pairs) :-
    findall(N-Count, ( nth1(N, View.rounds, _), overlapping(View, N, Count) ),
            Pairs).

overlapping(View, N, Count) :-
    aggregate_all(count,
                  ( nth1(N, View.rounds, Executions),
                    overlaps(Executions, Overlapping),
                    member(_, Overlapping) ),
                  Count).

                /*******************************
                *            CLAIMS            *
                *******************************/

claim("with an observer no execution is missing", [ours],
      at([control=observer], missing =:= 0)).
claim("with an observer fewer executions overlap than with δ = 0.5", [ours],
      at([control=observer], overlaps < at([control=bold], overlaps))).
claim("with an observer fewer executions overlap than with leaders only",
      [ours],
      at([control=observer], overlaps < at([control=leaders], overlaps))).
claim("with leaders only fewer executions overlap than with δ = 0.5", [ours],
      at([control=leaders], overlaps < at([control=bold], overlaps))).
claim("with an observer none overlap in the rounds in which \c
hosts are those of the round before", [ours],
      at([control=observer], settled =:= 0)).
claim("an observer takes less time than δ = 0.1", [ours],
      at([control=observer], total < at([control=cautious], total))).
claim("an observer takes less time than leaders only", [ours],
      at([control=observer], total < at([control=leaders], total))).

plot(lead, "Tasks in step, while the demand changes",
     lines([x(control), y([overlaps, settled, total])])).
plot(lead_deltas, "Penalty bias and overlaps, round by round",
     over_time([y([deltas, overlaps_by_round]), line(control), xlabel("round")])).

label(overlaps_by_round, "Overlapped executions of a round").
