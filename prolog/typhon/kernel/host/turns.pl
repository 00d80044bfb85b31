:- module(typhon_turns,
          [ turn_begins/1,              % +Agent
            turn_of/3,                  % +Agent, -Thread, -Seconds
            turns_now/3,                % -Agent, -Thread, -Seconds
            turn_in/3                   % +Thread, -What, -Since
          ]).
:- use_module(library(lists), [member/2]).

/** <module> The thread that runs an agent, and since when

Each thread that runs agents has two flags, which it sets when a turn
begins: the agent, and the time of day.  This costs a fifth of a
microsecond, and anybody may look.  A turn that is over is not noted: ask
only for agents that run.

*Threading*: turn_begins/1 in the thread that runs the agent; anybody asks.
*/

:- dynamic
    keys/3.                     % Thread number, flag of agent, of time

%!  turn_begins(+What) is det.
%
%   This thread runs What from now on, an agent or the goal of that name.

turn_begins(What) :-
    (   nb_current(typhon_turn_keys, keys(AgentKey, TimeKey))
    ->  true
    ;   make_keys(AgentKey, TimeKey)
    ),
    get_time(Now),
    set_flag(TimeKey, Now),
    set_flag(AgentKey, What).

%   Numbers of threads are used again, flags never go.

make_keys(AgentKey, TimeKey) :-
    thread_self(Me),
    thread_property(Me, id(Number)),
    atom_concat('typhon turn agent ', Number, AgentKey),
    atom_concat('typhon turn time ', Number, TimeKey),
    (   keys(Number, _, _)
    ->  true
    ;   assertz(keys(Number, AgentKey, TimeKey))
    ),
    nb_setval(typhon_turn_keys, keys(AgentKey, TimeKey)).

%!  turn_of(+Agent, -Thread, -Seconds:float) is semidet.
%
%   Agent, which runs, does so in Thread, and has not stopped for so many
%   Seconds of the time of day.

turn_of(Agent, Thread, Seconds) :-
    findall(At-Number,
            ( keys(Number, AgentKey, TimeKey),
              get_flag(AgentKey, Agent),
              get_flag(TimeKey, At) ),
            Turns),
    latest(Turns, Since-Number),
    thread_property(Thread, id(Number)),
    !,
    get_time(Now),
    Seconds is max(0.0, Now-Since).

%!  turns_now(-Agent, -Thread, -Seconds:float) is nondet.
%
%   The last turn of each thread that there is, which may be over.

turns_now(Agent, Thread, Seconds) :-
    get_time(Now),
    keys(Number, AgentKey, TimeKey),
    get_flag(AgentKey, Agent),
    get_flag(TimeKey, At),
    Seconds is max(0.0, Now-At),
    thread_property(Thread, id(Number)).

%!  turn_in(+Thread, -What, -Since:float) is semidet.
%
%   The last turn of Thread, which may be over, is one of What, and began at
%   Since.

turn_in(Thread, What, Since) :-
    catch(thread_property(Thread, id(Number)), error(_, _), fail),
    keys(Number, AgentKey, TimeKey),
    !,
    get_flag(AgentKey, What),
    get_flag(TimeKey, Since).

latest(Turns, Latest) :-
    member(Latest, Turns),
    Latest = At-_,
    \+ ( member(Other-_, Turns), Other > At ),
    !.
