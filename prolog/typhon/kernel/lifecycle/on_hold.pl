:- module(typhon_on_hold,
          [ held_put/4,                 % +Id, +Probe, +Goals, +Seen
            held_parts/3,               % +Held, -Goals, -Seen
            held_seen/2,                % +Id, +Held
            held_on/2,                  % +Id, +Held
            held_probe/2,               % +Held, -Probe
            held_dropped/1              % +Goals
          ]).
:- use_module('../program', [probe_stop/1]).
:- use_module('../host', [schedule/2]).
:- use_module('../agent', [agent/5, agent_put/3]).

/** <module> Agents that are held

An agent that is held, see typhon_stepping, has the status `held`, and when it
is to go on `resumed`, until a worker has it.  In place of its goals there is

    held(Probe, Goals, Seen)

Goals being what comes next and Seen whether a caller was notified.  It holds no
thread, and is ended as others that rest are.  Orders wait for its next
effect.

*Threading*: inside with_agent/2 of the agent.
*/

%!  held_put(+Id, +Probe, +Goals:list, +Seen:boolean) is det.
%!  held_parts(+Held, -Goals:list, -Seen:boolean) is semidet.
%!  held_seen(+Id, +Held) is det.
%!  held_on(+Id, +Held) is det.
%
%   Id, which was running, is held; what Held is; a caller was notified where it
%   is; it is to go on.

held_put(Id, Probe, Goals, Seen) :-
    agent_put(Id, held, held(Probe, Goals, Seen)).

held_parts(Held, Goals, Seen) :-
    nonvar(Held),
    Held = held(_, Goals, Seen).

held_seen(Id, held(Probe, Goals, _)) :-
    held_put(Id, Probe, Goals, true).

held_on(Id, Held) :-
    agent_put(Id, resumed, Held),
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).

%!  held_probe(+Held, -Probe) is det.

held_probe(held(Probe, _, _), Probe).

%!  held_dropped(+Goals) is det.
%
%   An agent ends in the place of whose goals there was Goals.

held_dropped(Goals) :-
    (   nonvar(Goals),
        Goals = held(Probe, _, _)
    ->  probe_stop(Probe)
    ;   true
    ).
