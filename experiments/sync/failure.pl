%   Completed tasks that are lost: section 5.6.6.
%
%   Expects: the parameter `failure`.  Gives: prepare_failure/3.

:- use_module('../../prolog/typhon', [network_at/3, remote/2]).
:- use_module('../../agents/lib/starts', [starts/4]).
:- use_module('../../agents/sync/operator', [task_fail/4, tasks_fail/4]).
:- use_module(library(lists)).

%   A failure is atomic(Task, Count, During): Count hosts lose Task when some
%   host executes During; or cascaded(Task, Count, During): they lose Task and
%   all later ones. The hosts are polled every second.

prepare_failure(Case, _, _) :-
    Case.failure == none,
    !.
prepare_failure(Case, Network, Hosts) :-
    Case.failure =.. [Kind, Task, Count, During],
    Seed is Case.seed + 1000,              % not the start hosts of the agents
    starts(Count, Hosts, [seed(Seed)], Drawn),
    fail_during(During, fail_now(Kind, Task, Drawn), Network, Hosts, 1).

fail_during(During, Failure, Network, Hosts, Time) :-
    network_at(Network, Time,
               (   member(Host, Hosts),
                   remote(Host, sense(task(main, During, executing, _)))
               ->  call(Failure)
               ;   Next is Time + 1,
                   fail_during(During, Failure, Network, Hosts, Next)
               )).

fail_now(atomic, Task, Hosts) :-
    task_fail(main, Task, Hosts, _).
fail_now(cascaded, Task, Hosts) :-
    tasks_fail(main, Task, Hosts, _).
