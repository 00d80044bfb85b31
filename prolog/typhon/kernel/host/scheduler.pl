:- module(typhon_scheduler,
          [ scheduler_limit/2,          % +Host, +Concurrency
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
:- use_module(turns, [turn_in/3, turns_not_short/2]).
:- use_module(time,
              [ time_adopt/1, time_alone/0, time_here/2, time_leave/0,
                time_work/1 ]).
:- use_module(work,
              [ limit_clear/2, limit_enter/3, limit_set/3, limited/1,
                limited/2, limits_forget/0 ]).

/** <module> The scheduler: agents that are ready, and their turns

An agent that is ready is among the work to be done once; an agent that
sleeps, waits or is resident is not here at all.  Module `time` decides which
thread does the work, and when alarms go off.

Higher layers define agents by the hooks run/1, fire/2, over/2 and kind/2.

*Threading*: any thread.
*/

:- meta_predicate
    schedule_here(+, +, 0),
    scheduler_call(0).

:- multifile
    run/1,                      % Agent: run it until it has to wait
    run_on/4,                   % Agent, Host, Context, Goals: run it, which has
                                % no status, from there
    fire/2,                     % Agent, Token: an alarm went off
    over/2,                     % Agent, Token: this alarm is not needed any more
    kind/2.                     % Agent, Kind: agents that may block alike

%!  scheduler_limit(+Host, +Concurrency) is det.
%
%   From now on at most Concurrency agents of Host run at a time.

scheduler_limit(Host, Concurrency) :-
    limit_set(Host, Concurrency, Work),
    forall(member(One, Work), time_work(One)).

%!  scheduler_unlimit(+Host) is det.

scheduler_unlimit(Host) :-
    limit_clear(Host, Agents),
    forall(member(Agent, Agents), time_work(agent(Agent))).

%!  scheduler_forget is det.
%
%   Forget all limits.

scheduler_forget :-
    limits_forget.

%!  schedule(+Host, +Agent) is det.
%
%   Agent, which stands on Host, is ready to run.

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
%   turns may take long, or have to wait for others.

schedule_here(Host, Kind, Turn) :-
    \+ limited(Host),
    time_here(Kind, Turn).

%!  schedule_adopt(+Thread) is det.
%!  schedule_leave is det.
%
%   Thread runs an agent by schedule_here/3, and has nothing else to do any
%   more: it is a worker, until it calls schedule_leave/0.

blocks(60).                             % seconds for which it is believed to

schedule_adopt(Thread) :-
    blocks(Seconds),
    forall(( turn_in(Thread, Agent, _), kind(Agent, Kind) ),
           turns_not_short(Kind, Seconds)),
    time_adopt(Thread).

schedule_leave :-
    time_leave.

%!  scheduler_call(:Goal) is det.
%
%   Run Goal once in a worker, some time soon.

scheduler_call(Goal) :-
    time_work(goal(Goal)).

%   What is loaded on demand is loaded by workers.

:- multifile typhon_on_demand:worker_call/1.

typhon_on_demand:worker_call(Goal) :-
    scheduler_call(Goal).
