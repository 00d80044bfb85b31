% Expects: nothing; pure.
% Gives: fit/2, required/2, open_team/4, detail/4, task_goal/2.

/*  Requirements of a task and properties of a robot.

    A robot has properties: capabilities, any terms, and states,
    Name=Value.  A task needs teams, Count-Requirements; a requirement is a
    term that unifies with a property, or Name>=X or Name=<X.
*/

:- use_module(library(aggregate)).
:- use_module(library(lists)).

%!  fit(+Requirements, +Properties) is semidet.
%
%   True when Properties meet all Requirements.  A variable that several
%   requirements share has one value.

fit(Requirements, Properties) :-
    \+ \+ met(Requirements, Properties).

met([], _).
met([Requirement|Requirements], Properties) :-
    holds(Requirement, Properties),
    met(Requirements, Properties).

holds(Name >= Least, Properties) :-
    !,
    member(Name=Value, Properties),
    Value >= Least.
holds(Name =< Most, Properties) :-
    !,
    member(Name=Value, Properties),
    Value =< Most.
holds(Requirement, Properties) :-
    member(Requirement, Properties).

%!  required(+Teams, -Count) is det.
%
%   Count is the number of robots that all Teams need together.

required([], 0).
required([Count0-_|Teams], Count) :-
    required(Teams, Count1),
    Count is Count0 + Count1.

%!  open_team(+Teams, +Taken, -Number, -Requirements) is nondet.
%
%   The incomplete teams; Number counts from 1.  Taken are the team numbers of
%   the robots held.

open_team(Teams, Taken, Number, Requirements) :-
    nth1(Number, Teams, Count-Requirements),
    aggregate_all(count, member(Number, Taken), Have),
    Have < Count.

%!  detail(+Name, +Details, +Default, -Value) is det.
%
%   Value of a detail Name(Value) of a task.

detail(Name, Details, Default, Value) :-
    Detail =.. [Name, Value0],
    (   memberchk(Detail, Details)
    ->  Value = Value0
    ;   Value = Default
    ).

%!  task_goal(+Details, -Goal) is det.
%
%   Goal is what each robot executes.

task_goal(Details, Goal) :-
    detail(duration, Details, 5, Seconds),
    detail(goal, Details, sleep(Seconds), Goal).
