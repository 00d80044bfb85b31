:- module(learning_measures,
          [ value/3,                    % +Measure, +Results, -Value
            measured/4,                 % +Measure, +Cases, -Values, -Text
            looked/4,                   % +What, +Result, -Verdict, -Note
            distance/4,                 % +Line, +Result, +Cells, -Mean
            path/2,                     % +Result, -Cells
            learner/2,                  % +Results, -Learner
            truth/2                     % :Goal, -Verdict
          ]).
:- use_module(maze, [maze_path/3, maze_size/2]).
:- use_module(metrics,
              [bins/4, executions/2, mean/2, overlap/2, sharing/2, slope/3]).
:- use_module(library(apply), [foldl/4, maplist/3, maplist/4]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> What runs of agents that learn are compared by

Results are those of learning_run/3, of runs of one case.

*Threading*: any thread; no state.
*/

:- meta_predicate truth(0, -).

%!  value(+Measure, +Results, -Value:number) is det.
%
%   Measure is `executions` or `sharing`, see learning_metrics; `total`,
%   executions of all agents of a run, its mean; or `overlaps`, the mean
%   overlap of final paths.

value(executions, Results, Value) :-
    executions(Results, Value).
value(sharing, Results, Value) :-
    sharing(Results, Value).
value(total, Results, Value) :-
    executions(Results, Mean),
    Results = [Result|_],
    memberchk(agents(Agents), Result),
    Value is Mean*Agents.
value(overlaps, Results, Value) :-
    findall(Overlap, ( member(Result, Results), paths(Result, Paths),
                       overlap(Paths, Overlap) ), Overlaps),
    mean(Overlaps, Value).

%!  measured(+Measure, +Cases:list(list), -Values, -Text) is det.
%
%   Values are those of Cases, each the results of one case.  Text has them,
%   and their standard errors where there are several runs.

measured(Measure, All, Values, Found) :-
    maplist(value(Measure), All, Values),
    maplist(text(Measure), All, Values, Texts),
    atomic_list_concat(Texts, ', ', Found).

text(Measure, Results, Value, Text) :-
    decimals(Value, Digits),
    (   Results = [_,_|_]
    ->  error(Measure, Results, Error),
        format(atom(Text), '~*f±~*f', [Digits, Value, Digits, Error])
    ;   format(atom(Text), '~*f', [Digits, Value])
    ).

decimals(Value, Digits) :-
    (   Value < 10
    ->  Digits = 2
    ;   Digits = 1
    ).

error(Measure, Results, Error) :-
    findall(V, ( member(R, Results), value(Measure, [R], V) ), Vs),
    mean(Vs, Mean),
    length(Vs, Count),
    foldl(squared(Mean), Vs, 0, Sum),
    Error is sqrt(Sum/(Count - 1)/Count).

squared(Mean, V, Sum0, Sum) :-
    Sum is Sum0 + (V - Mean)**2.

%!  looked(+What, +Result, -Verdict, -Note) is det.
%
%   Whether final paths are `distinct`, `same` or `overlapped`, or sharing
%   events are `falling`; Verdict is `true` or `false`.

looked(distinct, Result, Verdict, Note) :-
    different(Result, Different, All),
    truth(( All > 0, Different =:= All ), Verdict),
    format(atom(Note), '~d of ~d', [Different, All]).
looked(same, Result, Verdict, Note) :-
    different(Result, Different, _),
    truth(Different =:= 1, Verdict),
    format(atom(Note), '~d different', [Different]).
looked(overlapped, Result, Verdict, Note) :-
    paths(Result, Paths),
    overlap(Paths, Overlap),
    truth(Overlap >= 0.8, Verdict),
    format(atom(Note), '~2f', [Overlap]).
looked(falling, Result, Verdict, Note) :-
    memberchk(duration(End), Result),
    findall(T, ( learner([Result], learner(_, Times, _)), member(T, Times) ),
            All),
    bins(All, End, 30, Points),
    slope(Points, Slope, First),
    truth(Slope < 0, Verdict),
    Last is First + Slope*End,
    Seconds is End/30,
    format(atom(Note), 'from ~0f to ~0f events in ~0f s',
           [First, Last, Seconds]).

paths(Result, Paths) :-
    findall(Cells, path(Result, Cells), Paths).

%!  path(+Result, -Cells) is nondet.
%
%   The final path of an agent that converged.

path(Result, Cells) :-
    memberchk(settings(Settings), Result),
    learner([Result], learner(_, _, converged(_, _, Actions))),
    maze_path(Settings, Actions, Cells).

different(Result, Different, All) :-
    paths(Result, Paths0),
    maplist(sort, Paths0, Paths),
    sort(Paths, Set),
    length(Set, Different),
    length(Paths, All).

%!  distance(+Line, +Result, +Cells, -Mean) is det.
%
%   How far Cells are, on average, from the `diagonal`; or, from the `wall`,
%   those that are on the side of the start, below its end.

distance(diagonal, Result, Cells, Mean) :-
    memberchk(settings(Settings), Result),
    maze_size(Settings, Size),
    findall(D, ( member(X-Y, Cells), D is abs(X + Y - Size)/sqrt(2) ), Ds),
    mean(Ds, Mean).
distance(wall, Result, Cells, Mean) :-
    memberchk(settings(Settings), Result),
    memberchk(obstacles-[(W,_)-(W,Top)|_], Settings),
    findall(D, ( member(X-Y, Cells), X > W, Y =< Top, D is X - W - 1 ), Ds),
    mean(Ds, Mean).

%!  learner(+Results, -Learner) is nondet.
%!  truth(:Goal, -Verdict) is det.
%
%   Verdict is `true` if Goal holds, and else `false`.

learner(Results, Learner) :-
    member(Result, Results),
    memberchk(learners(Learners), Result),
    member(Learner, Learners).

truth(Goal, Verdict) :-
    (   call(Goal)
    ->  Verdict = true
    ;   Verdict = false
    ).
