:- module(allocation_metrics,
          [ allocation_measures/2,      % +Events, -Measures
            communications/2,           % +Events, -Sum
            from_first/2,               % +Events0, -Events
            measure/3                   % +Name, +Result, -Value
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [max_list/2, member/2, memberchk/2, min_list/2, sum_list/2]).

/** <module> What an event log says about allocations

Of events event(Time, Host, Agent, What), which all mechanisms log alike.

*Threading*: pure.
*/

%!  allocation_measures(+Events, -Measures:list) is det.
%
%   Measures are, for the whole run:
%
%     - communications(N): messages over one link, and migrations
%     - kinds(Pairs): Kind-N, of which these are the sum
%     - time(Seconds): host seconds from when the first allocator has begun
%       until the last task is completed, `none` if none is
%     - backoffs(Mean): back-offs per allocator
%     - interval(Mean): host seconds of a back-off, `none` without any
%     - completed(Pairs): Task-Seconds, in the order of completion, in host
%       seconds since the first has begun

allocation_measures(Events,
                    [ communications(Sum), kinds(Kinds), time(Time),
                      backoffs(Backoffs), interval(Interval),
                      completed(Completed) ]) :-
    communications(Events, Sum),
    kinds(Events, Kinds),
    completed(Events, Completed),
    last_time(Completed, Time),
    findall(Task, happened(Events, begun(Task)), Tasks),
    findall(Seconds, happened(Events, backoff(Seconds)), Intervals),
    length(Tasks, Allocators),
    length(Intervals, Count),
    mean(Intervals, Interval),
    Backoffs is Count/max(1, Allocators).

%!  from_first(+Events0, -Events) is det.
%
%   The time begins when the first allocator begins.

from_first(Events0, Events) :-
    (   memberchk(event(Start, _, _, begun(_)), Events0)
    ->  true
    ;   Start = 0
    ),
    findall(event(Time, Host, Agent, What),
            ( member(event(Time0, Host, Agent, What), Events0),
              Time is Time0 - Start ),
            Events).

happened(Events, What) :-
    member(event(_, _, _, What), Events).

completed(Events, Completed) :-
    findall(Time, member(event(Time, _, _, begun(_)), Events), Begins),
    min_list([inf|Begins], First),
    findall(Task-Seconds,
            ( member(event(Time, _, _, completed(Task)), Events),
              Seconds is Time - First ),
            Completed).

last_time([], none) :-
    !.
last_time(Completed, Time) :-
    findall(Seconds, member(_-Seconds, Completed), All),
    max_list(All, Time).

mean([], none) :-
    !.
mean(Numbers, Mean) :-
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

%!  communications(+Events, -Sum:integer) is det.
%
%   Sum is that of what was logged as communications(Kind, Count).

communications(Events, Sum) :-
    aggregate_all(sum(Count), happened(Events, communications(_, Count)),
                  Sum).

kinds(Events, Kinds) :-
    findall(Kind, happened(Events, communications(Kind, _)), All),
    sort(All, Names),
    findall(Kind-Sum,
            ( member(Kind, Names),
              aggregate_all(sum(Count),
                            happened(Events, communications(Kind, Count)),
                            Sum) ),
            Kinds).

%!  measure(+Name, +Result, -Value) is semidet.
%
%   Value is the number that Result, a list, has as Name(Value); fails if
%   it is none.

measure(Name, Result, Value) :-
    Measure =.. [Name, Value0],
    memberchk(Measure, Result),
    number(Value0),
    Value = Value0.
