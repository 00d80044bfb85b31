:- module(learning_metrics,
          [ learners/2,                 % +Events, -Learners
            first_executions/2,         % +Events, -Agents
            executed/2,                 % +Learners, -Count
            shared_times/2,             % +Learners, -Times
            duration/2,                 % +Learners, -Time
            spread/2,                   % +Learners, -Share
            overlap/2,                  % +Ways, -Overlap
            mean/2,                     % +Numbers, -Mean
            trend/3,                    % +Points, -Slope, -Level
            bins/4                      % +Times, +End, +Count, -Points
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2, nth1/3,
               sum_list/2]).
:- use_module(library(ordsets), [ord_intersection/3, ord_union/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Measures of learning agents, from an event log

*Threading*: pure.
*/

%!  learners(+Events, -Learners:list) is det.
%
%   Terms learner(Lengths, Shared, End), in the order of the first
%   executions: Lengths are the lengths of its executed plans, Shared the times
%   at which another agent shared something with it, and End is
%   converged(Time, Hops, Actions) or `none`.  Times are in host seconds
%   after the first execution of all agents.

learners(Events, Learners) :-
    first_executions(Events, Agents),
    findall(Time, member(event(Time, _, _, executed(1, _, _, _)), Events),
            Times),
    (   Times = [T0|_]
    ->  true
    ;   T0 = 0
    ),
    findall(Agent-What,
            ( member(event(Time, _, Agent, Told), Events),
              T is Time - T0,
              told(Told, T, What) ),
            Pairs),
    keysort(Pairs, ByAgent),
    maplist(learner(ByAgent), Agents, Learners).

%!  first_executions(+Events, -Agents) is det.
%
%   Agents in the order of their first executions.

first_executions(Events, Agents) :-
    findall(Agent, member(event(_, _, Agent, executed(1, _, _, _)), Events),
            Agents).

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

%!  executed(+Learners, -Count:integer) is det.
%!  shared_times(+Learners, -Times:list) is det.
%!  duration(+Learners, -Time) is det.
%
%   Count is the number of executions of all learners, Times are the times of
%   all sharing events, and Time is when the last learner has converged.

executed(Learners, Count) :-
    aggregate_all(count,
                  ( member(learner(Lengths, _, _), Learners),
                    member(_, Lengths) ),
                  Count).

shared_times(Learners, Times) :-
    findall(T, ( member(learner(_, Shared, _), Learners),
                 member(T, Shared) ), Times).

duration(Learners, Time) :-
    findall(T, member(learner(_, _, converged(T, _, _)), Learners), Ts),
    max_list([0|Ts], Time).

%!  mean(+Numbers, -Mean) is semidet.
%
%   Fails for an empty list.

mean(Numbers, Mean) :-
    length(Numbers, Count),
    Count > 0,
    sum_list(Numbers, Sum),
    Mean is Sum/Count.

%!  spread(+Learners, -Share) is det.
%
%   How much plans differ in length: the standard deviation of the lengths at
%   the same execution, divided by their mean, over all executions that all
%   agents have made.  Without the division plans that grow faster would seem to
%   differ more.

spread([learner(First, _, _)|Others], Share) :-
    findall(Deviation-Mean,
            ( nth1(I, First, Length),
              maplist(length_at(I), Others, Lengths),
              deviation([Length|Lengths], Mean, Deviation) ),
            Pairs),
    pairs_keys_values(Pairs, Deviations, Means),
    sum_list(Deviations, Deviated),
    sum_list(Means, Length),
    Share is Deviated/max(1, Length).

length_at(I, learner(Lengths, _, _), Length) :-
    nth1(I, Lengths, Length).

deviation(Numbers, Mean, Deviation) :-
    mean(Numbers, Mean),
    findall(Square, ( member(N, Numbers), Square is (N - Mean)**2 ),
            Squares),
    mean(Squares, Variance),
    Deviation is sqrt(Variance).

%!  overlap(+Ways:list(list), -Overlap) is det.
%
%   The mean, over all pairs of Ways, of the number of cells in both divided by
%   the number of cells in at least one.  1 if all ways have the same cells, or
%   there is only one way.

overlap(Ways0, Overlap) :-
    maplist(sort, Ways0, Ways),
    findall(Share,
            ( append(_, [Way|Others], Ways),
              member(Other, Others),
              common(Way, Other, Share) ),
            Shares),
    (   mean(Shares, Overlap)
    ->  true
    ;   Overlap = 1
    ).

common(Way, Other, Share) :-
    ord_intersection(Way, Other, Both),
    ord_union(Way, Other, Either),
    length(Both, Count),
    length(Either, All),
    Share is Count/max(1, All).

%!  trend(+Points, -Slope, -Level) is semidet.
%
%   The line Y = Level + Slope*X fitted to Points, pairs X-Y, by least squares.
%   Fails if Points do not have two different X.

trend(Points, Slope, Level) :-
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
%   Divides the time from 0 to End into Count equal parts: Points are pairs
%   Middle-Number, Number is the number of Times in the part.

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
