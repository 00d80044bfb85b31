:- module(learning_metrics,
          [ learning_result/2,          % +Events, -Result
            executions/2,               % +Results, -Mean
            sharing/2,                  % +Results, -Ratio
            mean/2,                     % +Numbers, -Mean
            spread/3,                   % +Results, -Actions, -Share
            overlap/2,                  % +Paths, -Overlap
            slope/3,                    % +Points, -Slope, -Level
            bins/4                      % +Times, +End, +Count, -Points
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, nth1/3, sum_list/2]).
:- use_module(library(ordsets),
              [ord_intersection/3, ord_union/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> What an event log says about agents that learn

*Threading*: pure.
*/

%!  learning_result(+Events, -Result) is det.
%
%   What came of a run, as a list.  Times are in host seconds after the
%   first execution.
%
%     - learners(List)
%       Of terms learner(Lengths, Shared, End), in the order of the first
%       executions.  Lengths are those of the plans that it had executed,
%       Shared the times at which another agent shared something with it,
%       End is converged(Time, Hops, Actions) or `none`.
%     - duration(Time)
%       Until the last of them had converged.
%     - unanswered(Count)
%       How often a trainer did not answer in time.

learning_result(Events, [ learners(Learners), duration(Duration),
                          unanswered(Unanswered) ]) :-
    findall(Agent-Time,
            member(event(Time, _, Agent, executed(1, _, _, _)), Events),
            Firsts),
    first_time(Firsts, T0),
    pairs_keys_values(Firsts, Agents, _),
    by_agent(Events, T0, ByAgent),
    findall(Learner,
            ( member(Agent, Agents), learner(ByAgent, Agent, Learner) ),
            Learners),
    aggregate_all(max(T), last_time(Events, T0, T), Duration0),
    Duration is max(0, Duration0),
    aggregate_all(count, member(event(_, _, _, unanswered(_)), Events),
                  Unanswered).

first_time([_-T0|_], T0).
first_time([], 0).

last_time(_, _, 0).
last_time(Events, T0, Time) :-
    (   member(event(T, _, _, converged(_, _, _)), Events)
    ;   member(event(T, _, _, executed(_, _, _, _)), Events)
    ),
    Time is T - T0.

by_agent(Events, T0, ByAgent) :-
    findall(Agent-What,
            ( member(event(Time, _, Agent, Told), Events),
              T is Time - T0,
              told(Told, T, What) ),
            Pairs),
    keysort(Pairs, ByAgent).

told(executed(_, Length, _, _), _, length(Length)).
told(shared(_, _), T, shared(T)).
told(converged(_, Hops, Actions), T, converged(T, Hops, Actions)).

learner(ByAgent, Agent, learner(Lengths, Shared, End)) :-
    findall(L, member(Agent-length(L), ByAgent), Lengths),
    findall(T, member(Agent-shared(T), ByAgent), Shared),
    (   memberchk(Agent-converged(T, Hops, Actions), ByAgent)
    ->  End = converged(T, Hops, Actions)
    ;   End = none
    ).

                /*******************************
                *           MEASURES           *
                *******************************/

%!  executions(+Results, -Mean) is det.
%
%   Executions in all runs by the number of agents (thesis section 4.4).

executions(Results, Mean) :-
    total(Results, executed, Executions),
    total(Results, one, Agents),
    Mean is Executions/Agents.

%!  sharing(+Results, -Ratio) is det.
%
%   Sharing events per execution: the average of the runs by the average of
%   the runs (thesis section 4.4.4).

sharing(Results, Ratio) :-
    total(Results, shared, Events),
    total(Results, executed, Executions),
    Ratio is Events/max(1, Executions).

total(Results, What, Total) :-
    findall(N,
            ( member(Result, Results),
              memberchk(learners(Learners), Result),
              member(Learner, Learners),
              number_of(What, Learner, N) ),
            Ns),
    sum_list(Ns, Total).

number_of(executed, learner(Lengths, _, _), N) :-
    length(Lengths, N).
number_of(shared, learner(_, Shared, _), N) :-
    length(Shared, N).
number_of(one, _, 1).

%!  mean(+Numbers, -Mean) is semidet.
%
%   Fails for an empty list.

mean(Numbers, Mean) :-
    length(Numbers, Count),
    Count > 0,
    sum_list(Numbers, Sum),
    Mean is Sum/Count.

%!  spread(+Results, -Actions, -Share) is det.
%
%   How far the plans of the agents of one run differ in length: Actions is
%   the standard deviation of their lengths at one and the same execution,
%   the mean of all executions that all agents have made, in all runs.
%   Share is this by the mean length: plans that grow faster differ by more
%   actions, though the agents are as near to each other.

spread(Results, Actions, Share) :-
    findall(Deviation-Mean,
            ( member(Result, Results),
              memberchk(learners(Learners), Result),
              Learners = [learner(First, _, _)|Others],
              nth1(I, First, Length),
              maplist(length_at(I), Others, Lengths),
              deviation([Length|Lengths], Mean, Deviation) ),
            Pairs),
    pairs_keys_values(Pairs, Deviations, Means),
    sum_list(Deviations, Deviated),
    sum_list(Means, Length),
    length(Pairs, Count),
    Actions is Deviated/max(1, Count),
    Share is Deviated/max(1, Length).

length_at(I, learner(Lengths, _, _), Length) :-
    nth1(I, Lengths, Length).

deviation(Numbers, Mean, Deviation) :-
    mean(Numbers, Mean),
    findall(Square, ( member(N, Numbers), Square is (N - Mean)**2 ),
            Squares),
    mean(Squares, Variance),
    Deviation is sqrt(Variance).

%!  overlap(+Paths:list(list), -Overlap) is det.
%
%   How much of two Paths is the same: the cells that are in both by those
%   that are in one of them, the mean of all pairs.  1 if all go through the
%   same cells, or there is one only.

overlap(Paths0, Overlap) :-
    maplist(sort, Paths0, Paths),
    findall(Share,
            ( append(_, [Path|Others], Paths),
              member(Other, Others),
              common(Path, Other, Share) ),
            Shares),
    (   mean(Shares, Overlap)
    ->  true
    ;   Overlap = 1
    ).

common(Path, Other, Share) :-
    ord_intersection(Path, Other, Both),
    ord_union(Path, Other, Either),
    length(Both, Count),
    length(Either, All),
    Share is Count/max(1, All).

%!  slope(+Points, -Slope, -Level) is semidet.
%
%   The line Y = Level + Slope*X that is nearest to Points, pairs X-Y, by
%   least squares.  Fails if they have not two different X.

slope(Points, Slope, Level) :-
    pairs_keys_values(Points, Xs, Ys),
    mean(Xs, MeanX),
    mean(Ys, MeanY),
    foldl(deviations(MeanX, MeanY), Points, 0-0, Sxy-Sxx),
    Sxx > 0,
    Slope is Sxy/Sxx,
    Level is MeanY - Slope*MeanX.

deviations(MeanX, MeanY, X-Y, Sxy0-Sxx0, Sxy-Sxx) :-
    Sxy is Sxy0 + (X - MeanX)*(Y - MeanY),
    Sxx is Sxx0 + (X - MeanX)**2.

%!  bins(+Times, +End, +Count:integer, -Points) is det.
%
%   The time from 0 to End in Count equal parts: Points are pairs
%   Middle-Number, so many of Times being in the part.

bins(Times, End, Count, Points) :-
    Width is max(End, 1.0e-6)/Count,
    Last is Count - 1,
    findall(Middle-Number,
            ( between(0, Last, I),
              Middle is (I + 0.5)*Width,
              aggregate_all(count,
                            ( member(T, Times),
                              I =:= max(0, min(Last, floor(T/Width))) ),
                            Number) ),
            Points).
