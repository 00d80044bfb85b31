:- module(typhon_work,
          [ work_do/2                   % +Work, :Again
          ]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(limits, [limit_leave/2]).

/** <module> What there is to do

Work is agent(Agent), agent(Host, Agent) for one that has a turn on Host, or
goal(Goal).  Errors are printed, and do not reach the worker.

*Threading*: any thread; no two have the same agent.
*/

:- multifile
    typhon_scheduler:run/1.     % Agent: run it until it has to wait

:- meta_predicate work_do(+, 1).

%!  work_do(+Work, :Again) is det.
%
%   Do Work; call(Again, Work2) for what may be done now that it is done.

work_do(Work, Again) :-
    catch(do(Work, Again), Ball, survive(Ball)).

do(agent(Agent), _) :-
    run_one(Agent).
do(agent(Host, Agent), Again) :-
    call_cleanup(run_one(Agent), next_turn(Host, Again)).
do(goal(Goal), _) :-
    (   call(Goal)
    ->  true
    ;   print_message(warning, typhon(goal_failed(Goal)))
    ).

run_one(Agent) :-
    (   typhon_scheduler:run(Agent)
    ->  true
    ;   print_message(error, typhon(run_failed(Agent)))
    ).

next_turn(Host, Again) :-
    (   limit_leave(Host, Agent)
    ->  call(Again, agent(Host, Agent))
    ;   true
    ).

survive('$aborted') :-
    !.
survive(unwind(_)) :-                   % SWI-Prolog 9.3 and later
    !.
survive(Ball) :-
    print_error(error, Ball).
