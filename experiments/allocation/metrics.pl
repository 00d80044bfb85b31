:- module(allocation_metrics,
          [ communications/2,           % +Events, -Sum
            kind_sums/2,                % +Events, -Pairs
            completed/2,                % +Events, -Pairs
            backoffs/2,                 % +Events, -Seconds
            lasted/3,                   % +Events, ?Task, -Seconds
            overdue/3,                  % +Events, -Reported, -Free
            from_first/2,               % +Events0, -Events
            mean/2                      % +Numbers, -Mean
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [max_list/2, member/2, memberchk/2, min_list/2, sum_list/2]).

/** <module> Measures of allocations, from an event log

Events are event(Time, Host, Agent, What); all mechanisms log the same terms.

*Threading*: pure.
*/

%!  communications(+Events, -Sum:integer) is det.
%
%   Sum is the number of messages over one link and of migrations: the sum of
%   the logged communications(Kind, Count).

communications(Events, Sum) :-
    aggregate_all(sum(Count), happened(Events, communications(_, Count)),
                  Sum).

%!  kind_sums(+Events, -Pairs) is det.
%
%   Pairs are Kind-Count; communications/2 gives their sum.

kind_sums(Events, Pairs) :-
    findall(Kind, happened(Events, communications(Kind, _)), Kinds0),
    sort(Kinds0, Kinds),
    findall(Kind-Sum,
            ( member(Kind, Kinds),
              aggregate_all(sum(Count),
                            happened(Events, communications(Kind, Count)),
                            Sum) ),
            Pairs).

happened(Events, What) :-
    member(event(_, _, _, What), Events).

%!  completed(+Events, -Pairs) is det.
%
%   Pairs are Task-Seconds, in the order of completion; Seconds count from the
%   start of the first allocator.

completed(Events, Completed) :-
    findall(Time, member(event(Time, _, _, begun(_)), Events), Begins),
    min_list([inf|Begins], First),
    findall(Task-Seconds,
            ( member(event(Time, _, _, completed(Task)), Events),
              Seconds is Time - First ),
            Completed).

%!  backoffs(+Events, -Seconds:list) is det.
%
%   The planned duration of each back-off.

backoffs(Events, Intervals) :-
    findall(Seconds, happened(Events, backoff(Seconds)), Intervals).

%!  lasted(+Events, ?Task, -Seconds) is nondet.
%
%   Seconds is the time from the start of the allocator of Task to the
%   completion of Task.

lasted(Events, Task, Seconds) :-
    member(event(End, _, _, completed(Task)), Events),
    memberchk(event(Begin, _, _, begun(Task)), Events),
    Seconds is End - Begin.

%!  overdue(+Events, -Reported, -Free) is nondet.
%
%   For each missed task Reported is the time from its deadline to the report,
%   Free the time from its deadline until its last robot was free, in seconds.

overdue(Events, Reported, Free) :-
    member(event(Missed, _, _, missed(Task, Deadline)), Events),
    memberchk(event(Begin, _, _, begun(Task)), Events),
    Due is Begin + Deadline,
    Reported is Missed - Due,
    findall(Time, member(event(Time, _, _, released(_, _, Task)), Events),
            Times),
    max_list([Missed|Times], Last),
    Free is Last - Due.

%!  from_first(+Events0, -Events) is det.
%
%   Time 0 of Events is the start of the first allocator.

from_first(Events0, Events) :-
    (   memberchk(event(Start, _, _, begun(_)), Events0)
    ->  true
    ;   Start = 0
    ),
    findall(event(Time, Host, Agent, What),
            ( member(event(Time0, Host, Agent, What), Events0),
              Time is Time0 - Start ),
            Events).

%!  mean(+Numbers, -Mean) is semidet.
%
%   Fails for an empty list.

mean(Numbers, Mean) :-
    length(Numbers, Count),
    Count > 0,
    sum_list(Numbers, Sum),
    Mean is Sum/Count.
