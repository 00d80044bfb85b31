:- module(allocation_tasks,
          [ check_task/1                % @Task
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [type_error/2]).

/** <module> The format of tasks

*Threading*: pure.
*/

%!  check_task(@Task) is det.
%
%   True if Task is task(Name, Teams, Details): Name is atomic, Teams a list
%   of at least one team, Count-Requirements, and Details a list.  See
%   allocation_operator.
%
%   @error type_error(task, Task)

check_task(Task) :-
    (   subsumes_term(task(_, _, _), Task),
        Task = task(Name, [Team|Teams], Details),
        atomic(Name),
        is_list(Details),
        is_list(Teams),
        maplist(team, [Team|Teams])
    ->  true
    ;   type_error(task, Task)
    ).

team(Team) :-
    subsumes_term(_-_, Team),
    Team = Count-Requirements,
    integer(Count),
    Count > 0,
    is_list(Requirements).
