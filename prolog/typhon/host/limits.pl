:- module(typhon_limits,
          [ limit_set/2,                % +Host, +Concurrency
            limit_clear/2,              % +Host, -Agents
            limit_enter/3,              % +Host, +Agent, -Work
            limit_leave/2,              % +Host, -Agent
            limited/1,                  % +Host
            limits_forget/0
          ]).

/** <module> Hosts that run few agents at a time

A host may have a limit on the number of its agents that run at a time.
An agent that is ready takes a turn, or is parked until one that runs
gives it its own.

*Threading*: any thread; one mutex.
*/

:- dynamic
    limit/2,                    % Host, Concurrency
    parked/2.                   % Host, Agent: waits for its turn on Host

%!  limit_set(+Host, +Concurrency) is det.
%
%   At most Concurrency agents of Host run at a time; `inf` is no limit.

limit_set(_, inf) :-
    !.
limit_set(Host, Concurrency) :-
    running_key(Host, Key),
    flag(Key, _, 0),
    assertz(limit(Host, Concurrency)).

%!  limit_clear(+Host, -Agents) is det.
%
%   Host has no limit any more; Agents were parked.

limit_clear(Host, Agents) :-
    with_mutex(typhon_park,
               ( retractall(limit(Host, _)),
                 findall(Agent, parked(Host, Agent), Agents),
                 retractall(parked(Host, _)) )).

%!  limited(+Host) is semidet.

limited(Host) :-
    limit(Host, _),
    !.

%!  limits_forget is det.

limits_forget :-
    with_mutex(typhon_park,
               ( retractall(limit(_, _)),
                 retractall(parked(_, _)) )).

%!  limit_enter(+Host, +Agent, -Work) is semidet.
%
%   Agent, which stands on Host, may run: Work is agent(Agent), or
%   agent(Host, Agent) if it has a turn to give back by limit_leave/2.
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

%!  limit_leave(+Host, -Agent) is semidet.
%
%   An agent that had a turn on Host gives it back; if one is parked there
%   the turn is that Agent's.

limit_leave(Host, Agent) :-
    with_mutex(typhon_park, pass_turn(Host, Agent)).

pass_turn(Host, Agent) :-
    retract(parked(Host, Agent)),
    !.
pass_turn(Host, _) :-
    running_key(Host, Key),
    flag(Key, Running, max(0, Running-1)),
    fail.

running_key(Host, Key) :-
    atom_concat('typhon running ', Host, Key).
