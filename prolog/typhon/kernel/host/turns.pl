:- module(typhon_turns,
          [ turn_begins/1,              % +What
            turn_of/3,                  % +Agent, -Thread, -Seconds
            turns_now/3,                % ?Agent, -Thread, -Seconds
            turn_in/3,                  % +Thread, -What, -Since
            turn_if_short/2,            % +Kind, :Turn
            turns_not_short/2,          % +Kind, +Seconds
            turns_paused/0,
            turns_pause/0,
            turns_go_on/1,              % -Agents
            turn_later/1,               % +Agent
            context_set/3,              % +Host, +Agent, +Module
            context_clear/0,
            context/3,                  % -Host, -Agent, -Module
            context_now/2,              % ?Host, -Agent
            context_host/1,             % -Host
            context_agent/1,            % -Agent
            in_context/2                % +Host, :Goal
          ]).
:- use_module(library(lists), [member/2, min_member/2]).
:- use_module('../base/monotonic', [monotonic_time/1]).

/** <module> Turns of agents

Each thread that runs agents has two flags, which it sets when a turn begins:
the agent, and the time of day.  This costs a fifth of a microsecond, and any
thread may read them.  The end of a turn is not recorded: ask only for agents
that run.

The thread that reads an agent from a connection may run it at once, rather
than wake a worker, as long as its turns are short.  Turns of a kind count as
short until one was long, and count again after a while.  A turn is long by the
inferences it takes.  On a busy machine any turn may take long by the clock; but
if two of a few successive turns of one kind do, they wait for something.

While turns are paused no alarm goes off, and no agent begins a turn: agents
that get a turn are kept until the pause ends.

While a worker runs an agent, or a thread runs a goal in the place of a host,
the vocabulary needs the host and the agent: the context, a global variable of
the thread.

*Threading*: turn_begins/1 in the thread that runs the agent; any thread asks.
One mutex for kinds that are not short.  One for the pause: the thread that
pauses turns ends the pause.
*/

:- meta_predicate turn_if_short(+, 0).

:- set_prolog_flag(optimise, true).     % arithmetic without calls

:- dynamic
    keys/3,                     % Thread number, flag of agent, of time
    slow/2,                     % Kind, Until
    turns_paused/0,
    kept/1.                     % Agent: it got a turn during the pause

%!  turn_begins(+What) is det.
%
%   Record that this thread begins to run What, an agent or a goal of that name.

turn_begins(What) :-
    (   nb_current(typhon_turn_keys, keys(AgentKey, TimeKey))
    ->  true
    ;   make_keys(AgentKey, TimeKey)
    ),
    monotonic_time(Now),
    set_flag(TimeKey, Now),
    set_flag(AgentKey, What).

%   Thread numbers are reused, and flags are never deleted.

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
%   Agent, which runs, has been running in Thread for Seconds of the time of
%   day.

turn_of(Agent, Thread, Seconds) :-
    findall(Seconds0-Thread0, turns_now(Agent, Thread0, Seconds0), Turns),
    min_member(Seconds-Thread, Turns).

%!  turns_now(?Agent, -Thread, -Seconds:float) is nondet.
%
%   The last turn of each thread that exists. It may be over.

turns_now(Agent, Thread, Seconds) :-
    monotonic_time(Now),
    keys(Number, AgentKey, TimeKey),
    get_flag(AgentKey, Agent),
    get_flag(TimeKey, At),
    Seconds is max(0.0, Now-At),
    thread_property(Thread, id(Number)).

%!  turn_in(+Thread, -What, -Since:float) is semidet.
%
%   The last turn of Thread, which may be over, was one of What and began at
%   Since.  Fails if it had none: the flags are those of an earlier thread.

turn_in(Thread, What, Since) :-
    catch(( thread_property(Thread, id(Number)),
            thread_statistics(Thread, epoch, Start) ),
          error(_, _), fail),
    keys(Number, AgentKey, TimeKey),
    !,
    get_flag(TimeKey, Since),
    Since >= Start,
    get_flag(AgentKey, What).

                /*******************************
                *          SHORT TURNS         *
                *******************************/

%   Two turns that took long by the clock are close if fewer inferences than
%   these lie between them.  A turn takes some thousand.

few_turns(5000).

%   remembered(?What, -Seconds): for so long a kind does not count as short
%   after a turn that was long, or that waited.

remembered(long, 1).
remembered(waits, 10).

%!  turn_if_short(+Kind, :Turn) is semidet.
%
%   Call Turn, of an agent of that Kind. Fails if such a turn may be long.  It is
%   short below so many inferences, which cost as much as some wake-ups, and
%   below so many seconds.  If the time of day is set meanwhile, the next turns
%   count as long for a while, at worst.

turn_if_short(Kind, Turn) :-
    (   slow(Kind, Until)
    ->  monotonic_time(Now),
        Now > Until
    ;   true
    ),
    get_time(Time0),
    statistics(inferences, Count0),
    call(Turn),
    statistics(inferences, Count),
    get_time(Time),
    (   Count-Count0 > 20000
    ->  remember(long, Kind)
    ;   Time-Time0 < 0.004
    ->  true
    ;   waited(Kind, Count)
    ).

waited(Kind, Count) :-
    (   nb_current(typhon_long_turn, Kind-Before),
        few_turns(Few),
        Count-Before < Few
    ->  remember(waits, Kind)
    ;   nb_setval(typhon_long_turn, Kind-Count)
    ).

remember(What, Kind) :-
    remembered(What, Seconds),
    turns_not_short(Kind, Seconds).

%!  turns_not_short(+Kind, +Seconds) is det.
%
%   Let no turn of that Kind count as short for Seconds.

turns_not_short(Kind, Seconds) :-
    monotonic_time(Now),
    Until is Now+Seconds,
    with_mutex(typhon_short_turns, slow_until(Kind, Until, Now)).

slow_until(Kind, Until, _) :-
    slow(Kind, Until0),
    Until0 > Until,
    !.
slow_until(Kind, Until, Now) :-
    findall(Old, ( slow(Old, Until0), Until0 < Now ), Olds),
    forall(member(Old, [Kind|Olds]), retractall(slow(Old, _))),
    assertz(slow(Kind, Until)).

                /*******************************
                *           THE PAUSE          *
                *******************************/

%!  turns_paused is semidet.
%
%   Turns are paused.

%!  turns_pause is det.
%
%   Pause turns.

turns_pause :-
    with_mutex(typhon_turns,
               (   turns_paused
               ->  true
               ;   assertz(turns_paused)
               )).

%!  turns_go_on(-Agents:list) is det.
%
%   End the pause. Agents got a turn during the pause and must be scheduled.

turns_go_on(Agents) :-
    with_mutex(typhon_turns,
               ( retractall(turns_paused),
                 findall(Agent, kept(Agent), Agents),
                 retractall(kept(_)) )).

%!  turn_later(+Agent) is semidet.
%
%   Turns are paused: keep Agent until the pause ends.

turn_later(Agent) :-
    turns_paused,
    with_mutex(typhon_turns, ( turns_paused, assertz(kept(Agent)) )).

                /*******************************
                *           CONTEXT            *
                *******************************/

:- meta_predicate in_context(+, 0).

%!  context_set(+Host, +Agent, +Module) is det.
%
%   Set the context: this thread runs Agent, whose module is Module, on Host.

context_set(Host, Agent, Module) :-
    nb_linkval(typhon_turns, context(Host, Agent, Module)),  % a new ground term
    turn_begins(Agent).

%!  context_clear is det.
%
%   Clear the context: this thread runs no agent.

context_clear :-
    nb_linkval(typhon_turns, none).

%!  context_now(?Host, -Agent) is semidet.
%
%   Agent is the running agent, or `none` for another goal on Host.  Fails if
%   neither runs.

context_now(Host, Agent) :-
    nb_current(typhon_turns, context(Host, Agent, _)).

%!  context(-Host, -Agent, -Module) is det.
%
%   The host, the id and the module of the running agent.
%
%   @error existence_error(running_agent, here)

context(Host, Agent, Module) :-
    (   nb_current(typhon_turns, context(Host, Agent, Module)),
        Agent \== none
    ->  true
    ;   throw(error(existence_error(running_agent, here),
                    context(_, 'only an agent can do this')))
    ).

%!  context_agent(-Agent) is det.
%
%   Agent is the running agent.
%
%   @error as context/3

context_agent(Agent) :-
    context(_, Agent, _).

%!  context_host(-Host) is det.
%
%   @error existence_error(host, here)

context_host(Host) :-
    (   context_now(Host, _)
    ->  true
    ;   throw(error(existence_error(host, here),
                    context(_, 'only an agent or remote/2 can do this')))
    ).

%!  in_context(+Host, :Goal) is semidet.
%
%   Run Goal once on Host, not as an agent.

in_context(Host, Goal) :-
    (   nb_current(typhon_turns, Old)
    ->  true
    ;   Old = none
    ),
    setup_call_cleanup(
        nb_setval(typhon_turns, context(Host, none, none)),
        once(Goal),
        nb_setval(typhon_turns, Old)).
