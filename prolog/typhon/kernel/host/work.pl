:- module(typhon_work,
          [ work_do/2,                  % +Work, :Again
            work_survives/1,            % :Turn
            limit_set/3,                % +Host, +Concurrency, -Work
            limit_clear/2,              % +Host, -Agents
            limit_enter/3,              % +Host, +Agent, -Work
            limited/1,                  % +Host
            limited/2,                  % +Host1, +Host2
            limit_parked/1,             % ?Agent
            limits_forget/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(turns, [turn_begins/1]).

/** <module> Work: turns of agents, and goals

Work is agent(Agent), agent(Host, Agent) for one that has a turn on Host, or
goal(Goal).  Errors are printed, and do not reach the worker.

A host may have a limit on the number of its agents that run at a time.  An
agent that is ready takes a turn there, or is parked until one that runs gives
it its own.

*Threading*: any thread; no two have the same agent.  One mutex for limits.
*/

:- meta_predicate
    work_do(+, 1),
    work_survives(0).

:- multifile
    typhon_scheduler:run/1.     % Agent: run it until it has to wait

:- dynamic
    limit/2,                    % Host, Concurrency
    parked/2.                   % Host, Agent: waits for its turn on Host

%!  work_do(+Work, :Again) is det.
%
%   Do Work; call(Again, Work2) for what may be done now that it is done.

work_do(Work, Again) :-
    catch(do(Work, Again), Ball, survive(Ball)).

%!  work_survives(:Turn) is semidet.
%
%   Call Turn, whose errors do not reach the caller.

work_survives(Turn) :-
    catch(Turn, Ball, survive(Ball)).

do(agent(Agent), _) :-
    run_one(Agent).
do(agent(Host, Agent), Again) :-
    call_cleanup(run_one(Agent), next_turn(Host, Again)).
do(goal(Goal), _) :-
    strip_module(Goal, _, Plain),
    functor(Plain, Name, _),
    turn_begins(Name),
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
    (   with_mutex(typhon_park, pass_turn(Host, Agent))
    ->  call(Again, agent(Host, Agent))
    ;   true
    ).

survive('$aborted') :-
    !.
survive(unwind(_)) :-                   % SWI-Prolog 9.3 and later
    !.
survive(Ball) :-
    print_error(error, Ball).

                /*******************************
                *            LIMITS            *
                *******************************/

%!  limit_set(+Host, +Concurrency, -Work:list) is det.
%
%   From now on at most Concurrency agents of Host run at a time; `inf` is no
%   limit.  Parked agents that may run are in Work, as of limit_enter/3.
%   Running ones are not stopped.

limit_set(Host, inf, Work) :-
    !,
    limit_clear(Host, Agents),
    findall(agent(Agent), member(Agent, Agents), Work).
limit_set(Host, Concurrency, Work) :-
    with_mutex(typhon_park, set(Host, Concurrency, Work)).

set(Host, Concurrency, Work) :-
    (   retract(limit(Host, _))
    ->  true
    ;   running_key(Host, Key),
        flag(Key, _, 0)
    ),
    assertz(limit(Host, Concurrency)),
    unpark(Host, Concurrency, Work).

unpark(Host, Concurrency, [agent(Host, Agent)|Work]) :-
    running_key(Host, Key),
    flag(Key, Running, Running),
    Running < Concurrency,
    retract(parked(Host, Agent)),
    !,
    flag(Key, _, Running+1),
    unpark(Host, Concurrency, Work).
unpark(_, _, []).

%   The agents that wait for a turn, and how many have one.

:- durable(turns, Host, Running, Agents, turns_item(Host, Running, Agents),
           turns_restore(Host, Running, Agents)).

turns_item(Host, Running, Agents) :-
    limit(Host, _),
    running_key(Host, Key),
    flag(Key, Running, Running),
    findall(Agent, parked(Host, Agent), Agents).

turns_restore(Host, Running, Agents) :-
    running_key(Host, Key),
    flag(Key, _, Running),
    forall(member(Agent, Agents), assertz(parked(Host, Agent))).

%!  limit_clear(+Host, -Agents) is det.
%
%   Host has no limit any more; Agents were parked.

limit_clear(Host, Agents) :-
    with_mutex(typhon_park,
               ( retractall(limit(Host, _)),
                 findall(Agent, parked(Host, Agent), Agents),
                 retractall(parked(Host, _)) )).

%!  limited(+Host) is semidet.
%!  limited(+Host1, +Host2) is semidet.
%
%   There is a limit on Host; on one of them, or both.

limited(Host) :-
    limit(Host, _),
    !.

limited(Host1, Host2) :-
    limit(_, _),                        % mostly none at all
    ( limit(Host1, _) ; limit(Host2, _) ),
    !.

%!  limit_parked(?Agent) is nondet.
%
%   Agent waits for its turn.

limit_parked(Agent) :-
    parked(_, Agent).

%!  limits_forget is det.

limits_forget :-
    with_mutex(typhon_park,
               ( retractall(limit(_, _)),
                 retractall(parked(_, _)) )).

%!  limit_enter(+Host, +Agent, -Work) is semidet.
%
%   Agent, which stands on Host, may run: Work is agent(Agent), or
%   agent(Host, Agent) if it has a turn to give back.
%   Fails when it is parked.

limit_enter(Host, Agent, Work) :-
    limit(Host, _),
    !,
    with_mutex(typhon_park, take_turn(Host, Agent, Work)).
limit_enter(_, Agent, agent(Agent)).

take_turn(Host, Agent, Work) :-
    (   limit(Host, Limit)
    ->  running_key(Host, Key),
        flag(Key, Running, Running),
        (   Running < Limit
        ->  flag(Key, _, Running+1),
            Work = agent(Host, Agent)
        ;   assertz(parked(Host, Agent)),
            fail
        )
    ;   Work = agent(Agent)             % cleared since we looked
    ).

%   pass_turn(+Host, -Agent): an agent that had a turn on Host gives it back;
%   if one is parked there the turn is that Agent's.

pass_turn(Host, Agent) :-
    \+ crowded(Host),
    retract(parked(Host, Agent)),
    !.
pass_turn(Host, _) :-
    running_key(Host, Key),
    flag(Key, Running, max(0, Running-1)),
    fail.

%   Its limit has become lower.

crowded(Host) :-
    limit(Host, Limit),
    running_key(Host, Key),
    flag(Key, Running, Running),
    Running > Limit.

running_key(Host, Key) :-
    atom_concat('typhon running ', Host, Key).
