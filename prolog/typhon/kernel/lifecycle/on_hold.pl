:- module(typhon_on_hold,
          [ held_put/3,                 % +Id, +State, +Goals
            held_parts/3,               % +Held, -State, -Goals
            held_on/2,                  % +Id, +Held
            held_dropped/1              % +Goals
          ]).
:- use_module('../host', [schedule/2]).
:- use_module('../agent', [agent/5, agent_put/3]).

/** <module> Agents that are held in the middle of their goals

The engine of a turn, see typhon_turn, may put an agent down before any goal.
The agent then has the status `held`, and when it is to go on `resumed`, until
a worker has it.  In place of its goals there is

    held(State, Goals)

State being what the engine needs to go on, and Goals what comes next.  It
holds no thread, and is ended as others that rest are.  Orders wait for its
next effect.

*Threading*: inside with_agent/2 of the agent.
*/

:- multifile dropped/1.         % State: the agent ends, and goes on no more

%!  held_put(+Id, +State, +Goals:list) is det.
%!  held_parts(+Held, -State, -Goals:list) is semidet.
%!  held_on(+Id, +Held) is det.
%
%   Id, which was running, is held; what Held is; it is to go on.

held_put(Id, State, Goals) :-
    agent_put(Id, held, held(State, Goals)).

held_parts(Held, State, Goals) :-
    nonvar(Held),
    Held = held(State, Goals).

held_on(Id, Held) :-
    agent_put(Id, resumed, Held),
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).

%!  held_dropped(+Goals) is det.
%
%   An agent ends in the place of whose goals there was Goals.

held_dropped(Goals) :-
    (   held_parts(Goals, State, _),
        dropped(State)
    ->  true
    ;   true
    ).
