:- module(typhon_time,
          [ time_start/1,               % +Kind
            time_stop/0,
            time_kind/1,                % ?Kind
            time_default/1,             % -Kind
            time_wanted/2,              % +Options, -Kind
            time_apart/2,               % ?Kind, -Address
            time_repeats/2,             % ?Kind, -Mark
            time_now/1,                 % -Stamp
            time_flag/1,                % -Flag
            time_work/1,                % +Work
            time_here/2,                % +Agents, :Turn
            time_adopt/1,               % +Thread
            time_leave/0,
            time_wait/3,                % +Queue, -Message, +Stamp
            time_day_wait/3,            % +Queue, -Message, +Stamp
            agents_run/1,               % +Seconds
            time_signal/1,              % :Goal
            time_seed/1,                % +Seed
            time_hold/1,                % +Seconds
            time_state/1,               % -State
            time_let_go/1,              % -Agents
            time_due/3,                 % +Agent, +Token, -Stamp
            time_again/2,               % +State, -Agents
            alarm_set/3,                % +Stamp, +Agent, +Token
            alarm_in/3,                 % +Seconds, +Agent, +Token
            clock_set/3,                % +Host, +Epoch, +Rate
            clock_clear/1,              % +Host
            clock/3,                    % ?Host, ?Epoch, ?Rate
            host_time/2,                % +Host, -Seconds
            real_time/3                 % +Host, +Seconds, -Stamp
          ]).

/** <module> The runtime: the threads that do the work, and time

A runtime of some Kind does the work, fires the alarms, and serves callers that
wait.  The kernel has `real`, a pool of threads, see typhon_scheduler; an option has
`single`, for a Prolog without threads, see typhon_single.  Both use
monotonic_time/1.  A process has one kind as long as it has hosts.  Stamps are
seconds, of that time or of the clock of the runtime.

A runtime defines the hooks below for its Kind.  It must define those of the
first group; each of the others describes a property that a runtime may lack.

A host has a clock: host seconds are (real time - Epoch) * Rate.  The default,
epoch 0 and rate 1, is the time of day, but for what the clock of the computer
was set by.  Hosts of one network share epoch and rate, so that agents and
experiments are written in host seconds and run as fast as Rate says.

*Threading*: any thread; callers serialize time_start/1 and time_stop/0.
*/

:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../base/options', [options_load/2]).

:- meta_predicate
    time_here(+, 0),
    time_signal(0).

:- dynamic
    state/2,
    time_kind/1,                        % Kind: while it runs
    time_flag/1,                        % Flag, as in clock/2: while it runs
    clock/3.                            % Host, Epoch, Rate

:- multifile
    starts/1,                           % Kind
    stops/1,                            % Kind
    work/2,                             % Kind, Work: see time_work/1
    alone/1,                            % Kind: no other work waits
    alarm/4,                            % Kind, Stamp, Agent, Token: see alarm_set/3
    wait/4,                             % Kind, Queue, Message, Stamp: see time_wait/3
    signal/2,                           % Kind, Goal: see time_signal/1
    hold/2,                             % Kind, Seconds: see time_hold/1
    let_go/2,                           % Kind, Agents: see time_let_go/1
    clock/2,                            % Kind, Flag: it holds the time, which stands
                                        % still while a goal runs; if there is none,
                                        % the time is monotonic_time/1
    wanted/2,                           % Option, Kind: see time_wanted/2
    apart/2,                            % Kind, Address: see time_apart/2
    repeats/2,                          % Kind, Mark: see time_repeats/2
    here/3,                             % Kind, Agents, Turn: see time_here/2; needs
                                        % adopt/2 and leave/1
    adopt/2,                            % Kind, Thread: see time_adopt/1
    leave/1,                            % Kind: see time_leave/0
    due/4,                              % Kind, Agent, Token, Stamp: see time_due/3
    seed/2,                             % Kind, Seed: see time_seed/1
    state/2,                            % Kind, State: see time_state/1
    again/3,                            % Kind, State, Agents: see time_again/2
    prolog:error_message//1.

%!  time_kind(?Kind) is semidet.
%
%   The runtime of this process runs, and is of Kind.

%!  time_start(+Kind) is det.
%
%   Start the runtime; does nothing if it runs already.

time_start(Kind) :-
    time_kind(Kind),
    !.
time_start(Kind) :-
    starts(Kind),
    forall(clock(Kind, Flag), assertz(time_flag(Flag))),
    assertz(time_kind(Kind)).

%!  time_stop is det.
%
%   Stop the runtime; does nothing if none runs.

time_stop :-
    (   retract(time_kind(Kind))
    ->  retractall(time_flag(_)),
        stops(Kind)
    ;   true
    ).

                /*******************************
                *           PROPERTIES         *
                *******************************/

%!  time_default(-Kind) is det.
%
%   The kind for hosts whose options name none.

time_default(Kind) :-
    (   current_prolog_flag(threads, true)
    ->  Kind = real
    ;   Kind = single
    ).

%!  time_wanted(+Options, -Kind) is semidet.
%
%   The options of a host name another Kind than the default.

time_wanted(Options, Kind) :-
    options_load(host_option, Options),
    member(Option, Options),
    wanted(Option, Kind),
    !.

%!  time_apart(?Kind, -Address) is semidet.
%
%   A process with that Kind of runtime cannot reach other processes.  Address
%   is that of its endpoint.

time_apart(Kind, Address) :-
    apart(Kind, Address),
    !.

%!  time_repeats(?Kind, -Mark) is semidet.
%
%   Runs are reproducible from the programs alone: the same ids are made again,
%   and contain Mark.

time_repeats(Kind, Mark) :-
    repeats(Kind, Mark),
    !.

                /*******************************
                *              TIME            *
                *******************************/

%!  time_now(-Stamp:float) is det.
%
%   The time now, of the clock of the runtime.

time_now(Stamp) :-
    time_flag(Flag),
    !,
    get_flag(Flag, Stamp).
time_now(Stamp) :-
    monotonic_time(Stamp).

%!  time_flag(-Flag) is semidet.
%
%   Flag holds the time, which stands still while a goal runs.

%!  alarm_set(+Stamp, +Agent, +Token) is det.
%
%   Set an alarm that calls fire(Agent, Token) at Stamp.

alarm_set(Stamp, Agent, Token) :-
    time_kind(Kind),
    !,
    alarm(Kind, Stamp, Agent, Token).
alarm_set(_, _, _).

%!  alarm_in(+Seconds, +Agent, +Token) is det.
%
%   Set an alarm that calls fire(Agent, Token) in Seconds.

alarm_in(Seconds, Agent, Token) :-
    time_now(Now),
    Stamp is Now+Seconds,
    alarm_set(Stamp, Agent, Token).

%!  time_due(+Agent, +Token, -Stamp) is semidet.
%
%   The alarm goes off at Stamp.  Fails where time_state/1 has a term for all
%   alarms.

time_due(Agent, Token, Stamp) :-
    time_kind(Kind),
    due(Kind, Agent, Token, Stamp),
    !.

%!  time_wait(+Queue, -Message, +Stamp) is semidet.
%
%   Take the first Message of Queue, from which no other thread takes.  Fails
%   if there is none before Stamp, a number or `inf`.

time_wait(Queue, Message, Stamp) :-
    (   time_kind(Kind)
    ->  wait(Kind, Queue, Message, Stamp)
    ;   time_day_wait(Queue, Message, Stamp)
    ).

%!  time_day_wait(+Queue, -Message, +Stamp) is semidet.
%
%   As time_wait/3, but Stamp is a monotonic_time/1.

time_day_wait(Queue, Message, Stamp) :-
    wait_before(Stamp, thread_get_message(Queue, Message)).

%!  agents_run(+Seconds) is det.
%
%   Wait for Seconds, while agents run.  In a runtime without threads Seconds
%   may be `inf`: until no agent has anything left to do.
%
%   @error type_error(number, Seconds)

agents_run(Seconds) :-
    (   Seconds == inf,
        time_kind(single)
    ->  Stamp = inf
    ;   must_be(number, Seconds),
        time_now(Now),
        Stamp is Now+Seconds
    ),
    setup_call_cleanup(
        message_queue_create(Queue),
        catch(ignore(time_wait(Queue, _, Stamp)),
              error(no_agent_can_run, _), true),
        message_queue_destroy(Queue)).

%!  time_seed(+Seed:integer) is det.
%
%   Seed library(random) for agents, in a runtime that makes runs reproducible.

time_seed(Seed) :-
    (   time_kind(Kind),
        seed(Kind, Seed)
    ->  true
    ;   true
    ).

                /*******************************
                *              WORK            *
                *******************************/

%!  time_work(+Work) is det.
%
%   Queue Work, see typhon_scheduler.

time_work(Work) :-
    time_kind(Kind),
    !,
    work(Kind, Work).
time_work(_).                           % the runtime is stopping

%!  time_here(+Agents, :Turn) is semidet.
%
%   Call Turn, of an agent of the kind Agents, in this thread, which also has
%   other duties.  Fails where workers must do it.

time_here(Agents, Turn) :-
    time_kind(Kind),
    here(Kind, Agents, Turn).

%!  time_adopt(+Thread) is det.
%
%   Make Thread, which runs an agent by time_here/2, a worker until it calls
%   time_leave/0.

time_adopt(Thread) :-
    time_kind(Kind),
    !,
    adopt(Kind, Thread).
time_adopt(Thread) :-
    thread_detach(Thread).              % the runtime is stopping

%!  time_leave is det.
%
%   End time_adopt/1: this thread is no longer a worker.

time_leave :-
    (   time_kind(Kind)
    ->  leave(Kind)
    ;   true
    ).

%!  time_signal(:Goal) is det.
%
%   Run Goal in all threads that do work, as a signal.

time_signal(Goal) :-
    time_kind(Kind),
    !,
    signal(Kind, Goal).
time_signal(_).

                /*******************************
                *             HOLDING          *
                *******************************/

%!  time_hold(+Seconds) is semidet.
%
%   Hold time: no agent gets a turn, and no alarm goes off.  Fails if that is
%   not so within Seconds of real time.

time_hold(Seconds) :-
    time_kind(Kind),
    hold(Kind, Seconds).

%!  time_state(-State) is det.
%
%   While time is held: State is all that the runtime has planned, or its
%   Kind if it has no such term.

time_state(State) :-
    time_kind(Kind),
    (   state(Kind, State0)
    ->  State = State0
    ;   State = Kind
    ).

%!  time_let_go(-Agents:list) is det.
%
%   End time_hold/1. Agents have missed their turn.

time_let_go(Agents) :-
    (   time_kind(Kind)
    ->  let_go(Kind, Agents)
    ;   Agents = []                     % the runtime has stopped meanwhile
    ).

%!  time_again(+State, -Agents:list) is det.
%
%   Plan what State contains. Agents must be scheduled.

time_again(State, Agents) :-
    (   time_kind(Kind),
        again(Kind, State, Agents0)
    ->  Agents = Agents0
    ;   Agents = []
    ).

                /*******************************
                *            CLOCKS            *
                *******************************/

%!  clock(?Host, ?Epoch, ?Rate) is nondet.
%
%   The clocks that clock_set/3 has set.

%!  clock_set(+Host, +Epoch, +Rate) is det.
%
%   Epoch is a time stamp in real seconds, Rate a positive number.

clock_set(Host, Epoch, Rate) :-
    must_be(number, Epoch),
    must_be(number, Rate),
    (   Rate > 0
    ->  true
    ;   domain_error(clock_rate, Rate)
    ),
    clock_clear(Host),
    assertz(clock(Host, Epoch, Rate)).

%!  clock_clear(+Host) is det.

clock_clear(Host) :-
    retractall(clock(Host, _, _)).

%!  host_time(+Host, -Seconds:float) is semidet.
%
%   The clock of Host shows Seconds. Fails if Host has no clock.

host_time(Host, Seconds) :-
    clock(Host, Epoch, Rate),
    time_now(Now),
    Seconds is (Now-Epoch)*Rate.

%!  real_time(+Host, +Seconds, -Stamp:float) is semidet.
%
%   Stamp is the real time at which the clock of Host shows Seconds.

real_time(Host, Seconds, Stamp) :-
    clock(Host, Epoch, Rate),
    Stamp is Epoch+Seconds/Rate.

%   Runtimes without threads raise this.

prolog:error_message(no_agent_can_run) -->
    [ 'This wait cannot end: no agent is ready, and no alarm is set' ].
