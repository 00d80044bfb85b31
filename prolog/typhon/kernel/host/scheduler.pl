:- module(typhon_scheduler,
          [ work_do/2,                  % +Work, :Again
            scheduler_limited/2,        % +Host, +Boolean
            agent_parked/1,             % ?Agent
            schedule/2,                 % +Host, +Agent
            schedule_stays/2,           % +Here, +There
            schedule_here/3,            % +Host, +Kind, :Turn
            schedule_adopt/1,           % +Thread
            scheduler_call/1            % :Goal
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../base/error_text', [is_abort/1, print_error/2]).
:- use_module(turns, [turn_begins/1, turn_in/3, turns_not_short/2]).
:- use_module(time,
              [time_adopt/1, time_alone/0, time_here/2, time_work/1]).

/** <module> The scheduler: agents that are ready, and their turns

The scheduler queues work: agents that are ready, and goals.  It has no record
of an agent that sleeps, waits or is resident.  Module `time` decides which
thread does the work, and when alarms go off.

Work is agent(Agent), agent(Host, Agent) for an agent that has a turn on Host,
or goal(Goal).  Errors are printed, and do not reach the worker.

An option may limit the number of agents that run at a time on a host.  An agent
that is ready there takes a turn by the hook takes_turn/3, or is parked until an
agent that runs releases one, and next_turn/2 passes it on.

Higher layers define agents by the hooks run/1, fire/2, over/2 and kind/2.

*Threading*: any thread; no two threads run the same agent.
*/

:- meta_predicate work_do(+, 1).

:- dynamic limited/1.           % Host

%!  work_do(+Work, :Again) is det.
%
%   Do Work; call(Again, Work2) for work that becomes possible when it is done.

work_do(Work, Again) :-
    catch(do(Work, Again), Ball, report_error(Ball)).

do(agent(Agent), _) :-
    run_one(Agent).
do(agent(Host, Agent), Again) :-
    call_cleanup(run_one(Agent), turn_passes(Host, Again)).
do(goal(Goal), _) :-
    strip_module(Goal, _, Plain),
    functor(Plain, Name, _),
    turn_begins(Name),
    (   \+ \+ call(Goal)                % undo what it did to constraints
    ->  true
    ;   print_message(warning, typhon(goal_failed(Goal)))
    ).

run_one(Agent) :-
    (   typhon_scheduler:run(Agent)
    ->  true
    ;   print_message(error, typhon(run_failed(Agent)))
    ).

turn_passes(Host, Again) :-
    (   next_turn(Host, Work)
    ->  call(Again, Work)
    ;   true
    ).

report_error(Ball) :-
    is_abort(Ball),
    !.
report_error(Ball) :-
    print_error(error, Ball).

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
    kind/2,                     % Agent, Kind: its kind, see typhon_blocked
    takes_turn/3,               % Host, Agent, Work: Agent may run on Host
    next_turn/2,                % Host, Work: a turn on Host is free for Work
    agent_parked/1.

%!  scheduler_limited(+Host, +Boolean) is det.
%
%   An option limits the agents that run at a time on Host, or ceases to.

scheduler_limited(Host, Boolean) :-
    (   Boolean == false
    ->  retractall(limited(Host))
    ;   limited(Host)
    ->  true
    ;   assertz(limited(Host))
    ).

limited(Host1, Host2) :-
    limited(_),                         % usually no host is
    ( limited(Host1) ; limited(Host2) ),
    !.

%!  agent_parked(?Agent) is nondet.
%
%   Agent waits for a turn on its host, which is limited. The option defines
%   this.

%!  schedule(+Host, +Agent) is det.
%
%   Queue Agent, which is on Host and ready to run.

schedule(Host, Agent) :-
    (   \+ limited(Host)
    ->  time_work(agent(Agent))
    ;   takes_turn(Host, Agent, Work)
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
    time_here(Kind, catch(Turn, Ball, typhon_scheduler:report_error(Ball))).

%!  schedule_adopt(+Thread) is det.
%
%   Make Thread a worker until it calls time_leave/0.  It runs an agent by
%   schedule_here/3, and has no other duties now.

blocks(60).                             % seconds without short turns

schedule_adopt(Thread) :-
    blocks(Seconds),
    forall(( turn_in(Thread, Agent, _), kind(Agent, Kind) ),
           turns_not_short(Kind, Seconds)),
    time_adopt(Thread).

%!  scheduler_call(:Goal) is det.
%
%   Queue Goal; a worker runs it once.

scheduler_call(Goal) :-
    time_work(goal(Goal)).

%   Workers load code on demand.

:- multifile typhon_on_demand:worker_call/1.

typhon_on_demand:worker_call(Goal) :-
    scheduler_call(Goal).
