:- module(study_series,
          [ is_series/1,                % @Value
            counted/4,                  % +Times, +Every, +End, -Series
            stepped/4,                  % +Changes, +Every, +End, -Series
            runs_over_time/3            % +Runs, +Measures, -Expanded
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Measures over time

A series is a measure whose value is a list of pairs Time-Number.  Studies make
series with counted/4 and stepped/4, without an import.

*Threading*: pure.
*/

%!  is_series(@Value) is semidet.

is_series(Value) :-
    is_list(Value),
    Value = [_|_],
    maplist(is_step, Value).

is_step(Step) :-
    nonvar(Step),
    Step = Time-Number,
    number(Time),
    number(Number).

%!  counted(+Times:list(number), +Every:number, +End:number, -Series) is det.
%
%   Series counts the Times up to 0, Every, 2*Every and so on to End.

counted(Times, Every, End, Series) :-
    msort(Times, Sorted),
    length(Sorted, Count),
    findall(N, between(1, Count, N), Ns),
    pairs_keys_values(Changes, Sorted, Ns),
    stepped([-inf-0|Changes], Every, End, Series).

%!  stepped(+Changes:list(pair), +Every:number, +End:number, -Series) is det.
%
%   Changes are pairs Time-Value, in the order of time: Series has the last
%   value at 0, Every, 2*Every and so on to End.  Before the first change there
%   is no value.

stepped(Changes, Every, End, Series) :-
    must_be(number, Every),
    must_be(number, End),
    ( Every > 0 -> true ; domain_error(step_of_time, Every) ),
    steps(0, Every, End, Changes, none, Series).

steps(I, Every, End, Changes0, Value0, Series) :-
    Time is I*Every,
    (   Time > End
    ->  Series = []
    ;   up_to(Changes0, Time, Value0, Changes, Value),
        (   Value == none
        ->  Series = More
        ;   Series = [Time-Value|More]
        ),
        I1 is I + 1,
        steps(I1, Every, End, Changes, Value, More)
    ).

up_to([At-Value1|Changes0], Time, _, Changes, Value) :-
    At =< Time,
    !,
    up_to(Changes0, Time, Value1, Changes, Value).
up_to(Changes, _, Value, Changes, Value).

%!  runs_over_time(+Runs, +Measures:list(atom), -Expanded) is det.
%
%   Expanded has one run for each of Runs, run(Case, Seed, Ms), and each step of
%   the series Measures; its case has the additional parameter `time`.

runs_over_time(Runs, Measures, Expanded) :-
    findall(run(TimedCase, Seed, Step),
            ( member(run(Case, Seed, Ms), Runs),
              findall(Measure-Series,
                      ( member(Measure, Measures),
                        get_dict(Measure, Ms, Series),
                        is_series(Series) ),
                      All),
              step(All, Time, Pairs),
              dict_create(Step, measures, Pairs),
              put_dict(time, Case, Time, TimedCase) ),
            Expanded).

step(All, Time, Pairs) :-
    findall(T, ( member(_-Series, All), member(T-_, Series) ), Times0),
    sort(Times0, Times),
    member(Time, Times),
    findall(Measure-Value,
            ( member(Measure-Series, All), memberchk(Time-Value, Series) ),
            Pairs).
