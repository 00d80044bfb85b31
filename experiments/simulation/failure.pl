:- module(simulation_failure,
          [ failure_trace/6             % +Execution, +Hosts, +Trace0, -Trace,
                                        % +Chance0, -Chance
          ]).
:- use_module('../../prolog/typhon/base/chance', [chance_sample/5]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(lists), [member/2, numlist/3]).

/** <module> Completed tasks that are lost

As task_fail/4 and tasks_fail/4 of the operator do in a network.

*Threading*: as simulation_model.
*/

%!  failure_trace(+Execution, +Hosts, +Trace0, -Trace, +Chance0, -Chance)
%!      is det.
%
%   Trace is trace(Executions, Failure, Failures), the latest execution
%   first, Failure being still to come. It comes when its task begins: then
%   Hosts lose what they have done.

failure_trace(Execution, Hosts, trace(Executions, Failure, _),
              trace(Kept, none, Failures), Chance0, Chance) :-
    compound(Failure),
    Execution = execution(During, _, Now, _),
    arg(3, Failure, During),
    !,
    Failure =.. [Kind, Task, Count, _],
    functor(Hosts, _, N),
    numlist(1, N, Numbers),
    Most is min(Count, N),
    chance_sample(Most, Numbers, Drawn, Chance0, Chance),
    findall(failure(Now, Host, Lost),
            lost(Kind, Task, Now, Drawn, Hosts, Host, Lost), Failures),
    maplist(lose(Kind, Task, Hosts), Failures),
    exclude(in_vain(Failures), [Execution|Executions], Kept).
failure_trace(Execution, _, trace(Executions, Failure, Failures),
              trace([Execution|Executions], Failure, Failures),
              Chance, Chance).

%   Only a host that has completed Task loses something.

lost(Kind, Task, Now, Drawn, Hosts, Host, Lost) :-
    member(Host, Drawn),
    arg(Host, Hosts, host(Free, Last, Done, _)),
    Done /\ (1 << Task) =\= 0,
    \+ ( Last =:= Task, Now < Free ),
    (   Kind == atomic
    ->  Lost = Task
    ;   Most is msb(Done),
        between(Task, Most, Lost),
        Done /\ (1 << Lost) =\= 0
    ).

lose(Kind, Root, Hosts, failure(_, Host, Lost)) :-
    arg(Host, Hosts, host(Free, Last, Done0, Failed0)),
    Done is Done0 /\ \ (1 << Lost),
    (   Kind == cascaded
    ->  Failed = [Lost-Root|Failed0]
    ;   Failed = Failed0
    ),
    setarg(Host, Hosts, host(Free, Last, Done, Failed)).

in_vain(Failures, execution(Task, Host, _, End)) :-
    member(failure(Time, Host, Task), Failures),
    Time < End,
    !.
