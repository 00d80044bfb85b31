:- module(typhon_scheduler,
          [ work_do/2,                  % +Work, :Again
            work_survives/1,            % :Turn
            limit_parked/1,             % ?Agent
            scheduler_limit/2,          % +Host, +Concurrency
            scheduler_unlimit/1,        % +Host
            scheduler_forget/0,
            schedule/2,                 % +Host, +Agent
            schedule_stays/2,           % +Here, +There
            schedule_here/3,            % +Host, +Kind, :Turn
            schedule_adopt/1,           % +Thread
            schedule_leave/0,
            scheduler_call/1            % :Goal
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/error_text', [is_abort/1, print_error/2]).
:- use_module(turns, [turn_begins/1, turn_in/3, turns_not_short/2]).
:- use_module(time,
              [ time_adopt/1, time_alone/0, time_here/2, time_leave/0,
                time_work/1 ]).

/** <module> The scheduler: agents that are ready, and their turns

The scheduler queues work: agents that are ready, and goals.  It has no record
of an agent that sleeps, waits or is resident.  Module `time` decides which
thread does the work, and when alarms go off.

Work is agent(Agent), agent(Host, Agent) for an agent that has a turn on Host,
or goal(Goal).  Errors are printed, and do not reach the worker.

A host may limit the number of its agents that run at a time.  An agent that is
ready takes one of these turns, or is parked until an agent that runs releases
one.

Higher layers define agents by the hooks run/1, fire/2, over/2 and kind/2.

*Threading*: any thread; no two threads run the same agent.  One mutex for
limits.
*/

:- meta_predicate
    work_do(+, 1),
    work_survives(0).

:- dynamic
    limit/2,                    % Host, Concurrency
    parked/2.                   % Host, Agent: waits for its turn on Host

%!  work_do(+Work, :Again) is det.
%
%   Do Work; call(Again, Work2) for work that becomes possible when it is done.

work_do(Work, Again) :-
    catch(do(Work, Again), Ball, report_error(Ball)).

%!  work_survives(:Turn) is semidet.
%
%   Call Turn, and catch and print its errors.

work_survives(Turn) :-
    catch(Turn, Ball, report_error(Ball)).

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

report_error(Ball) :-
    is_abort(Ball),
    !.
report_error(Ball) :-
    print_error(error, Ball).

                /*******************************
                *            LIMITS            *
                *******************************/

%   limit_set(+Host, +Concurrency, -Work:list) is det.
%
%   From now on at most Concurrency agents of Host run at a time; `inf` is no
%   limit.  Work lists the parked agents that may run, as in limit_enter/3.
%   Running agents are not stopped.

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

%   limit_clear(+Host, -Agents) is det.
%
%   Remove the limit of Host. Agents were parked.

limit_clear(Host, Agents) :-
    with_mutex(typhon_park,
               ( retractall(limit(Host, _)),
                 findall(Agent, parked(Host, Agent), Agents),
                 retractall(parked(Host, _)) )).

%   limited(+Host) is semidet.
%   limited(+Host1, +Host2) is semidet.
%
%   Host has a limit; one of the two hosts has a limit.

limited(Host) :-
    limit(Host, _),
    !.

limited(Host1, Host2) :-
    limit(_, _),                        % usually no host has one
    ( limit(Host1, _) ; limit(Host2, _) ),
    !.

%!  limit_parked(?Agent) is nondet.
%
%   Agent waits for a turn.

limit_parked(Agent) :-
    parked(_, Agent).

%!  scheduler_forget is det.
%
%   Remove all limits and parked agents.

scheduler_forget :-
    with_mutex(typhon_park,
               ( retractall(limit(_, _)),
                 retractall(parked(_, _)) )).

%   limit_enter(+Host, +Agent, -Work) is semidet.
%
%   Agent, which is on Host, may run: Work is agent(Agent), or agent(Host,
%   Agent) if it has a turn to release.  Fails when the agent is parked.

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
    ;   Work = agent(Agent)             % the limit was removed meanwhile
    ).

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

running_key(Host, Key) :-
    atom_concat('typhon running ', Host, Key).

                /*******************************
                *          SCHEDULER           *
                *******************************/

:- meta_predicate
    schedule_here(+, +, 0),
    scheduler_call(0).

:- multifile
    run/1,                      % Agent: run it until it has to wait
    run_on/4,                   % Agent, Host, Context, Goals: run it, which
                                % has no status, from Goals
    fire/2,                     % Agent, Token: an alarm went off
    over/2,                     % Agent, Token: this alarm is obsolete
    kind/2.                     % Agent, Kind: its kind, see typhon_blocked

%!  scheduler_limit(+Host, +Concurrency) is det.
%
%   From now on at most Concurrency agents of Host run at a time.

scheduler_limit(Host, Concurrency) :-
    limit_set(Host, Concurrency, Work),
    forall(member(One, Work), time_work(One)).

%!  scheduler_unlimit(+Host) is det.
%
%   Remove the limit of Host and schedule its parked agents.

scheduler_unlimit(Host) :-
    limit_clear(Host, Agents),
    forall(member(Agent, Agents), time_work(agent(Agent))).

%!  schedule(+Host, +Agent) is det.
%
%   Queue Agent, which is on Host and ready to run.

schedule(Host, Agent) :-
    (   limit_enter(Host, Agent, Work)
    ->  time_work(Work)
    ;   debug(typhon(scheduler), '~w waits for its turn on ~w',
              [Agent, Host])
    ).

%!  schedule_stays(+Here, +There) is semidet.
%
%   The worker that runs an agent on Here may go on with it on There: no other
%   agent waits to be run.  To wake another thread would cost as much as the
%   hop.

schedule_stays(Here, There) :-
    \+ limited(Here, There),
    time_alone.

%!  schedule_here(+Host, +Kind, :Turn) is semidet.
%
%   Call Turn, which runs an agent of that Kind, in this thread.  Fails if such
%   turns may be long, or Host has a limit.

schedule_here(Host, Kind, Turn) :-
    \+ limited(Host),
    time_here(Kind, Turn).

%!  schedule_adopt(+Thread) is det.
%
%   Make Thread a worker until it calls schedule_leave/0.  It runs an agent by
%   schedule_here/3, and has no other duties now.

blocks(60).                             % seconds without short turns

schedule_adopt(Thread) :-
    blocks(Seconds),
    forall(( turn_in(Thread, Agent, _), kind(Agent, Kind) ),
           turns_not_short(Kind, Seconds)),
    time_adopt(Thread).

%!  schedule_leave is det.
%
%   End schedule_adopt/1: this thread is no longer a worker.

schedule_leave :-
    time_leave.

%!  scheduler_call(:Goal) is det.
%
%   Queue Goal; a worker runs it once.

scheduler_call(Goal) :-
    time_work(goal(Goal)).

%   Workers load code on demand.

:- multifile typhon_on_demand:worker_call/1.

typhon_on_demand:worker_call(Goal) :-
    scheduler_call(Goal).
