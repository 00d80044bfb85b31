:- module(typhon_concurrency, []).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../kernel/base/durable', [durable/6]).
:- use_module('../kernel/host', [scheduler_limited/2, time_work/1]).

/** <module> Hosts on which only so many agents run at a time

The option concurrency(N) of a host limits the number of its agents that run at
a time.  An agent that is ready takes one of N turns, or is parked until an agent
that runs releases one.

*Threading*: any thread; one mutex.
*/

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:ends/1,
    typhon_hosting:closes/1,
    typhon_options:declared/4,
    typhon_runtime:ending/1,
    typhon_scheduler:agent_parked/1,
    typhon_scheduler:next_turn/2,
    typhon_scheduler:takes_turn/3.

:- dynamic
    limit/2,                    % Host, Concurrency
    parked/2.                   % Host, Agent: waits for its turn on Host

typhon_options:declared(host_option, concurrency(X), positive_integer, X).
typhon_options:declared(host_option, concurrency(X), oneof([inf]), X).

typhon_host_parts:begins(Host, _, Options) :-
    option(concurrency(Concurrency), Options, inf),
    limit(Host, Concurrency, _).

typhon_host_parts:changeable(concurrency(_)).

typhon_host_parts:changes(concurrency(Concurrency), Host) :-
    limit(Host, Concurrency, Work),
    forall(member(One, Work), time_work(One)).

typhon_hosting:closes(Host) :-
    limit(Host, inf, Work),
    forall(member(One, Work), time_work(One)).

typhon_host_parts:ends(Host) :-
    limit(Host, inf, _).

typhon_runtime:ending(after) :-
    with_mutex(typhon_park,
               ( forall(limit(Host, _), scheduler_limited(Host, false)),
                 retractall(limit(_, _)),
                 retractall(parked(_, _)) )).

%   limit(+Host, +Concurrency, -Work:list): from now on at most Concurrency
%   agents of Host run at a time; `inf` is no limit.  Work lists the parked
%   agents that may run, as in takes_turn/3.  Running agents are not stopped.

limit(Host, inf, Work) :-
    !,
    with_mutex(typhon_park,
               ( retractall(limit(Host, _)),
                 findall(agent(Agent), parked(Host, Agent), Work),
                 retractall(parked(Host, _)) )),
    scheduler_limited(Host, false).
limit(Host, Concurrency, Work) :-
    with_mutex(typhon_park, set(Host, Concurrency, Work)),
    scheduler_limited(Host, true).

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

running_key(Host, Key) :-
    atom_concat('typhon running ', Host, Key).

typhon_scheduler:agent_parked(Agent) :-
    parked(_, Agent).

%   Work is agent(Agent), or agent(Host, Agent) if it has a turn to release.
%   Fails when the agent is parked.

typhon_scheduler:takes_turn(Host, Agent, Work) :-
    with_mutex(typhon_park, take_turn(Host, Agent, Work)).

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
    ;   Work = agent(Agent)             % the limit was removed meanwhile
    ).

typhon_scheduler:next_turn(Host, agent(Host, Agent)) :-
    with_mutex(typhon_park, pass_turn(Host, Agent)).

%   pass_turn(+Host, -Agent): an agent releases its turn on Host, and Agent,
%   which was parked there, gets it.  Fails if no agent is parked.

pass_turn(Host, Agent) :-
    \+ crowded(Host),
    retract(parked(Host, Agent)),
    !.
pass_turn(Host, _) :-
    running_key(Host, Key),
    flag(Key, Running, max(0, Running-1)),
    fail.

%   More agents run than the limit, which has been lowered.

crowded(Host) :-
    limit(Host, Limit),
    running_key(Host, Key),
    flag(Key, Running, Running),
    Running > Limit.

%   The agents that wait for a turn, and the number of agents that have one.

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
