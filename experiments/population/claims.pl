:- module(population_claims,
          [ population_claims/2,        % +Results, -Claims
            size_claims/2,              % +Groups, -Claims
            task_spans/2,               % +Result, -Spans
            task_gaps/2                 % +Result, -Gaps
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module('../sync/metrics', [out_of_order/2, overlaps/2]).
:- use_module(metrics, [peak/3, peak/4, population_at/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [ append/2, max_list/2, member/2, memberchk/2, min_list/2,
                min_member/2, nth1/3
              ]).

:- meta_predicate
    truth(0, -).

/** <module> What the thesis says of populations of specialists, checked

*Threading*: pure.
*/

%!  population_claims(+Results, -Claims) is det.
%
%   Claims is a list of claim(Text, Held, Found) about the Results of
%   population_run/3, runs of one kind and size.  A claim holds if it holds
%   in each of them; Found says in how many, and between which values.

population_claims(Results, Claims) :-
    Results = [Result|_],
    memberchk(crash(Crash), Result),
    findall(claim(Text, Held, Found),
            ( claim(Name, Kind, Text, Unit),
              ( Kind == any -> true ; Crash > 0 ),
              verdict(Name, Unit, Results, Held, Found)
            ),
            Claims0),
    maplist(sized(Result), Claims0, Claims).

sized(Result, claim(Text0, Held, Found), claim(Text, Held, Found)) :-
    memberchk(nodes(Nodes), Result),
    format(atom(Text), '~w hosts: ~w', [Nodes, Text0]).

claim(done, any, 'every host executes all tasks', 'executions').
claim(order, any, 'and in their order', 'out of order').
claim(overlap, any, 'at most one execution overlaps with an earlier task',
      'overlapped').
claim(span, any, 'each task takes 30 to 60 s', 's').
claim(gap, any, 'the agents are idle between any two tasks', 's').
claim(peaks, any, 'the populations peak in the order of the tasks', 's').
claim(kinds, any, 'each kind rises to about 0.6 agents for each host',
      'agents').
claim(total, any, 'all together to about 0.6 agents for each host',
      'agents').
claim(back, any, 'in the end only the first agents are left', 'agents').
claim(again, healing, 'all that lost T2 execute it again, nothing else is',
      'again').
claim(rise, healing, 'meanwhile there are a few more Agent-2', 'more').
claim(small, healing, 'fewer than when all hosts lacked T2', 'agents').
claim(later, healing, 'T4 and T5 keep their order', 'overlapped').

verdict(Name, Unit, Results, Held, Found) :-
    maplist(checked(Name), Results, Pairs),
    length(Pairs, Count),
    aggregate_all(count, member(true-_, Pairs), Times),
    truth(Times =:= Count, Held),
    findall(Value, ( member(_-Values, Pairs), member(Value, Values) ), All),
    range(All, Range),
    format(atom(Found), '~d of ~d runs; ~w ~w',
           [Times, Count, Range, Unit]).

checked(Name, Result, Held-Values) :-
    (   check(Name, Result, Held0, Values0)
    ->  Held = Held0,
        Values = Values0
    ;   Held = false,
        Values = []
    ).

range([], none).
range([Value|Values], Range) :-
    min_list([Value|Values], Least),
    max_list([Value|Values], Most),
    text(Least, LeastText),
    text(Most, MostText),
    (   LeastText == MostText
    ->  Range = LeastText
    ;   atomic_list_concat([LeastText, ' to ', MostText], Range)
    ).

text(Value, Text) :-
    (   float(Value)
    ->  format(atom(Text), '~1f', [Value])
    ;   Text = Value
    ).

                /*******************************
                *            CHECKS            *
                *******************************/

%   check(+Name, +Result, -Held, -Values) is semidet.

check(done, Result, Held, [Count]) :-
    memberchk(nodes(Nodes), Result),
    memberchk(tasks(Tasks), Result),
    memberchk(executions(Executions), Result),
    length(Tasks, TaskCount),
    length(Executions, Count),
    truth(Count =:= Nodes*TaskCount, Held).
check(order, Result, Held, [Count]) :-
    memberchk(executions(Executions), Result),
    out_of_order(Executions, OutOfOrder),
    length(OutOfOrder, Count),
    truth(Count =:= 0, Held).
check(overlap, Result, Held, [Count]) :-
    memberchk(executions(Executions), Result),
    overlaps(Executions, Overlapping),
    length(Overlapping, Count),
    truth(Count =< 1, Held).
check(span, Result, Held, Spans) :-
    task_spans(Result, Spans),
    truth(forall(member(Span, Spans), ( Span >= 30, Span =< 60 )), Held).
check(gap, Result, Held, Gaps) :-
    task_gaps(Result, Gaps),
    truth(forall(member(Gap, Gaps), Gap > 0), Held).
check(peaks, Result, Held, Times) :-
    memberchk(tasks(Tasks), Result),
    memberchk(steps(Steps), Result),
    findall(Time, ( member(Task, Tasks), peak(Task, Steps, Time-_) ), Times),
    msort(Times, Sorted),
    truth(Sorted == Times, Held).
check(kinds, Result, Held, Peaks) :-
    memberchk(nodes(Nodes), Result),
    memberchk(tasks(Tasks), Result),
    memberchk(steps(Steps), Result),
    findall(Peak, ( member(Task, Tasks), peak(Task, Steps, _-Peak) ), Peaks),
    truth(forall(member(Peak, Peaks), about(Peak, 0.6*Nodes)), Held).
check(total, Result, Held, [Peak]) :-
    memberchk(nodes(Nodes), Result),
    memberchk(steps(Steps), Result),
    peak(total, Steps, _-Peak),
    truth(about(Peak, 0.6*Nodes), Held).
check(back, Result, Held, [Alive]) :-
    memberchk(tasks(Tasks), Result),
    memberchk(steps(Steps), Result),
    memberchk(end(End), Result),
    population_at(End, Steps, Counts),
    sum(Counts, Alive),
    length(Tasks, TaskCount),
    truth(Alive =:= TaskCount, Held).
check(again, Result, Held, [Count]) :-
    memberchk(again(Again), Result),
    findall(Host, member(execution(2, Host, _, _), Again), Hosts0),
    msort(Hosts0, Hosts),
    crashed(Result, Crashed),
    length(Again, Count),
    length(Crashed, CrashedCount),
    truth(( Hosts == Crashed, Count =:= CrashedCount ), Held).
check(rise, Result, Held, [More]) :-
    agent2(Result, Before, Peak, _),
    More is Peak - Before,
    truth(More > 0, Held).
check(small, Result, Held, [Peak]) :-
    agent2(Result, _, Peak, First),
    truth(Peak < First, Held).
check(later, Result, Held, [Count]) :-
    memberchk(executions(Executions), Result),
    findall(E, ( member(E, Executions), E = execution(Task, _, _, _),
                 Task >= 4 ),
            Later),
    overlaps(Later, Overlapping),
    length(Overlapping, Count),
    truth(Count =:= 0, Held).

crashed(Result, Hosts) :-
    memberchk(failures(Failures), Result),
    findall(Host, member(_-Host, Failures), Hosts0),
    msort(Hosts0, Hosts).

%   agent2(+Result, -Before, -Peak, -First): the number of Agent-2 at the
%   crash, the most there were from then on, and in the whole run.

agent2(Result, Before, Peak, First) :-
    memberchk(failures(Failures), Result),
    memberchk(steps(Steps), Result),
    min_member(Time-_, Failures),
    population_at(Time, Steps, Counts),
    nth1(2, Counts, Before),
    peak(2, Time, Steps, _-Peak),
    peak(2, Steps, _-First).

sum(Counts, Sum) :-
    aggregate_all(sum(Count), member(Count, Counts), Sum).

%   About: a third more or less.

about(Value, Expected) :-
    Value >= Expected*2/3,
    Value =< Expected*4/3.

truth(Goal, Truth) :-
    (   call(Goal)
    ->  Truth = true
    ;   Truth = false
    ).

                /*******************************
                *           MEASURES           *
                *******************************/

%!  task_spans(+Result, -Spans) is det.
%!  task_gaps(+Result, -Gaps) is det.
%
%   Spans are the times from the first start to the last end of each task;
%   Gaps, those from the last end of a task to the first start of the next,
%   negative where they overlap.

task_spans(Result, Spans) :-
    memberchk(rows(Rows), Result),
    findall(Span,
            ( member(task(_, First, _, End, _, _), Rows),
              Span is End - First
            ),
            Spans).

task_gaps(Result, Gaps) :-
    memberchk(rows(Rows), Result),
    gaps(Rows, Gaps).

gaps([task(_, _, _, End, _, _)|Rows], [Gap|Gaps]) :-
    Rows = [task(_, Next, _, _, _, _)|_],
    !,
    Gap is Next - End,
    gaps(Rows, Gaps).
gaps(_, []).

%!  size_claims(+Groups, -Claims) is det.
%
%   Groups are pairs Nodes-Results, of runs of one size.  There are claims
%   where one size is twice another.

size_claims(Groups, Claims) :-
    findall(Claim, size_claim(Groups, Claim), Nested),
    append(Nested, Claims).

size_claim(Groups, [ claim(Text1, Held1, Found1),
                     claim(Text2, Held2, Found2) ]) :-
    member(Small-SmallResults, Groups),
    Large is 2*Small,
    memberchk(Large-LargeResults, Groups),
    median_of(total_peak, SmallResults, P1),
    median_of(total_peak, LargeResults, P2),
    Ratio is P2/P1,
    truth(( Ratio >= 1.5, Ratio =< 2.5 ), Held1),
    format(atom(Text1), '~d hosts have about twice the population of ~d',
           [Large, Small]),
    format(atom(Found1), '~w and ~w agents at most, ~2f times (medians)',
           [P1, P2, Ratio]),
    median_of(longest_gap, SmallResults, G1),
    median_of(longest_gap, LargeResults, G2),
    Times is G2/G1,
    truth(( Times >= 2/3, Times =< 3/2 ), Held2),
    format(atom(Text2), '~d and ~d hosts have idle times alike',
           [Small, Large]),
    format(atom(Found2), 'at most ~1f and ~1f s (medians)', [G1, G2]).

median_of(Measure, Results, Median) :-
    findall(Value, ( member(Result, Results),
                     call(Measure, Result, Value) ), Values),
    median(Values, Median).

total_peak(Result, Peak) :-
    memberchk(steps(Steps), Result),
    peak(total, Steps, _-Peak).

longest_gap(Result, Gap) :-
    task_gaps(Result, Gaps),
    max_list(Gaps, Gap).
