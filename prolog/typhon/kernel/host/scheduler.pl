:- module(typhon_scheduler,
          [ work_do/2,                  % +Work, :Again
            scheduler_limited/2,        % +Host, +Boolean
            agent_parked/1,             % ?Agent
            schedule/2,                 % +Host, +Agent
            schedule_stays/2,           % +Here, +There
            schedule_here/3,            % +Host, +Kind, :Turn
            schedule_adopt/1,           % +Thread
            scheduler_call/1,           % :Goal
            alarms_begin/0,
            alarms_end/0,
            alarm_add/3,                % +Stamp, +Agent, +Token
            alarm_stamp/3,              % ?Stamp, +Agent, ?Token
            alarms_go_off/1,            % +Stamp
            index_make/1,               % -Index
            index_update/2,             % +Index0, -Index
            index_delete/3,             % +Index0, +Stamp, -Index
            index_first/2               % +Index, -Stamp
          ]).

/** <module> The runtime `real`: a pool of few threads for many agents

Work waits in the run queue.  A worker takes work, runs the agent until it has
to wait, and takes the next.  Work is agent(Agent), agent(Host, Agent) for an
agent that has a turn on Host, or goal(Goal).  Errors are printed, and do not
reach the worker.  There is no record of an agent that sleeps, waits or is
resident.  Module `time` decides which thread does the work, and when alarms go
off.

The pool grows when the queue is stuck: work waits, and no worker has begun a
turn for `stuck_seconds`.  A worker that has been idle for long ends if there
are enough others.

A native goal that blocks occupies its worker.  Which goals block is known only
at run time: each thread records when its turn began (module `turns`), and a
worker whose turn has lasted for `blocked_seconds` is blocked.  The pool may
grow beyond `max_workers` by as many workers as are blocked, and a warning names
their agents.

At `blocked_workers` workers, or when no thread can be created, work of the
kinds that block is held until workers are free again; agents of one program
are of one kind.  The pool may then grow by its maximum for the other kinds.

The timer has an index of the stamps of all alarms and waits for the first of
them.  A module records the purpose of an alarm before it sets it: the timer
may call over/2 at once. Most alarms never go off, so setting one seldom wakes
the timer: only if it is earlier than the next one, or if the timer has many new
stamps to read. No alarm is lost if the timer fails: it starts again with a new
index.

An option may limit the number of agents that run at a time on a host.  An agent
that is ready there takes a turn by the hook takes_turn/3, or is parked until an
agent that runs releases one, and next_turn/2 passes it on.

Higher layers define agents by the hooks run/1, fire/2, over/2 and kind/2.

An alarm is a fact: call fire(Agent, Token) at Stamp.

An alarm that is no longer needed does no harm and is not deleted at once.  The
modules that set alarms define by over/2 which alarms are obsolete.  Obsolete
alarms are deleted after as many new alarms have been set as there were alarms.
So there are never more than twice as many alarms as are needed, plus some
hundreds.

The stamps of new alarms are put in a queue, from which the timer reads them.
The timer keeps an index of the stamps of all alarms, and of some alarms that
are gone.  After Left more alarms have been set it deletes obsolete alarms and
rebuilds the index.  The index is a tree, index(Stamps, Left), or, where a tree
would fill the stack, least(Stamp, Left) with the first stamp alone; then the
timer searches for the next stamp after each alarm.

*Threading*: any thread; no two threads run the same agent.  A mutex makes
starting and stopping the pool atomic: no worker is added after the run queue
is gone.  The flag typhon_next holds the stamp that the timer waits for.  The
timer writes it before it looks for new alarms for the last time, and a thread
that adds an alarm reads it after that: so one of the two sees the other. The
index of stamps is on the stack of the timer.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- autoload(library(rbtrees),
            [ ord_list_to_rbtree/2, rb_delete/3, rb_insert/4, rb_min/3,
              rb_size/2 ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/bounds', [memory_short/0]).
:- use_module('../base/error_text',
              [error_lines/3, is_abort/1, print_error/2]).
:- use_module('../base/fifo', [fifo_size/2]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module('../base/own_thread', [stop_thread/1]).
:- use_module('../base/server',
              [ server_answer/2, server_cast/2, server_check/1,
                server_start/4, server_stop/1 ]).
:- use_module(time,
              [ alarm_in/3, time_adopt/1, time_day_wait/3,
                time_here/2, time_kind/1, time_work/1 ]).
:- use_module(turns,
              [ turn_begins/1, turn_if_short/2, turn_in/3, turns_go_on/1,
                turns_not_short/2, turns_pause/0, turns_paused/0 ]).

:- setting(min_workers, positive_integer, 2,
           "Workers kept when idle").
:- setting(max_workers, positive_integer, 256,
           "Maximum number of workers, not counting blocked ones").
:- setting(idle_seconds, number, 10,
           "Idle workers beyond the minimum end").
:- setting(stuck_seconds, number, 0.01,
           "Seconds without a new turn after which the pool grows").
:- setting(blocked_seconds, number, 1,
           "Seconds of a turn after which its worker is blocked").
:- setting(blocked_workers, positive_integer, 768,
           "Number of workers from which work that blocks is held").

:- meta_predicate
    work_do(+, 1),
    schedule_here(+, +, 0),
    scheduler_call(0).

:- dynamic
    run_queue/1,                        % Queue
    worker/1,                           % Thread
    timer/1,                            % Server
    limited/1,                          % Host
    alarm/3,                            % Stamp, Agent, Token
    new/1,                              % Queue of stamps
    blocked_kind/1,                     % Kind: its work is held
    held/1,                             % Work of these kinds
    warned/0.                           % the pool has passed its maximum

:- multifile
    typhon_time:adopt/2,
    typhon_time:alarm/4,
    typhon_time:alone/1,
    typhon_time:due/4,
    typhon_time:here/3,
    typhon_time:hold/2,
    typhon_time:leave/1,
    typhon_time:let_go/2,
    typhon_time:signal/2,
    typhon_time:starts/1,
    typhon_time:stops/1,
    typhon_time:wait/4,
    typhon_time:work/2,
    prolog:message//1,
    run/1,                              % Agent: run it until it has to wait
    run_on/4,                           % Agent, Host, Context, Goals: run it, which
                                        % has no status, from Goals
    fire/2,                             % Agent, Token: an alarm went off
    over/2,                             % Agent, Token: this alarm is obsolete
    kind/2,                             % Agent, Kind: work that may block
    takes_turn/3,                       % Host, Agent, Work: Agent may run on Host
    next_turn/2,                        % Host, Work: a turn on Host is free for Work
    agent_parked/1,
    typhon_on_demand:worker_call/1.

:- public timed/3.

                /*******************************
                *        START AND STOP        *
                *******************************/

%   Start or stop workers and timer; does nothing if they run, or are stopped.

typhon_time:starts(real) :-
    with_mutex(typhon_scheduler, start).

start :-
    run_queue(_),
    !.
start :-
    message_queue_create(Queue),
    assertz(run_queue(Queue)),
    set_flag(typhon_pool_looks, 0),
    set_flag(typhon_pool_releases, 0),
    setting(min_workers, N),
    catch(( timer_start,
            forall(between(1, N, _), add_worker(Queue)) ),
          error(Formal, Context),
          ( stop,
            throw(error(Formal, Context)) )).

typhon_time:stops(real) :-
    stop.

stop :-
    with_mutex(typhon_scheduler, retract(run_queue(Queue))),
    !,
    timer_stop,
    end_workers(Queue),
    message_queue_destroy(Queue),
    blocked_forget,
    turns_go_on(_).
stop.

%   Workers get the order to stop; then those that are busy are interrupted.

end_workers(Queue) :-
    findall(Worker, worker(Worker), Workers),
    forall(member(_, Workers), thread_send_message(Queue, stop)),
    maplist(stop_thread, Workers),
    retractall(worker(_)).

typhon_time:signal(real, Goal) :-
    forall(worker(Worker),
           catch(thread_signal(Worker, Goal),
                 error(existence_error(_, _), _), true)).

                /*******************************
                *         THE RUN QUEUE        *
                *******************************/

typhon_time:work(real, Work) :-
    enqueue(Work).

enqueue(Work) :-
    run_queue(Queue),
    !,
    thread_send_message(Queue, Work),
    (   message_queue_property(Queue, waiting(_))
    ->  true
    ;   look_soon
    ).
enqueue(_).                             % the pool is stopping

typhon_time:alone(real) :-
    run_queue(Queue),
    message_queue_property(Queue, size(0)).

waits(Queue) :-
    message_queue_property(Queue, size(Size)),
    Size > 0.

%   The calling thread is not in the pool, so it gets only short turns.

typhon_time:here(real, Agents, Turn) :-
    turn_if_short(Agents, Turn).

                /*******************************
                *         ALARMS, WAITING      *
                *******************************/

typhon_time:alarm(real, Stamp, Agent, Token) :-
    timer_alarm(Stamp, Agent, Token).

typhon_time:due(real, Agent, Token, Stamp) :-
    alarm_stamp(Stamp, Agent, Token).

typhon_time:wait(real, Queue, Message, Stamp) :-
    time_day_wait(Queue, Message, Stamp).

typhon_time:hold(real, _) :-
    turns_pause.

typhon_time:let_go(real, Agents) :-
    turns_go_on(Agents),
    alarms_overdue.

                /*******************************
                *            WORKERS           *
                *******************************/

workers_count(Count) :-
    predicate_property(worker(_), number_of_clauses(Count)),
    !.
workers_count(0).

%   @error resource_error(What) where no thread can be created

add_worker(Queue) :-
    flag(typhon_worker, N, N+1),
    atom_concat(typhon_worker_, N, Alias),
    thread_create(serve(Queue), Worker,
                  [ alias(Alias), at_exit(typhon_scheduler:replace_worker) ]),
    assertz(worker(Worker)).

%   Called when a worker was aborted in the middle of a goal.  If no thread can
%   be created now, the pool grows when the queue is stuck.

replace_worker :-
    thread_self(Me),
    with_mutex(typhon_scheduler, replace_worker(Me)).

replace_worker(Me) :-
    run_queue(Queue),
    retract(worker(Me)),
    !,
    debug(typhon(scheduler), '~w has ended', [Me]),
    thread_detach(Me),
    catch(add_worker(Queue), error(_, _), true).
replace_worker(_).

%   The setting is looked up once for each idle period, not for each turn.

serve(Queue) :-
    setting(idle_seconds, Seconds),
    serve(Queue, Seconds).

serve(Queue, Seconds) :-
    (   thread_get_message(Queue, Work, [timeout(Seconds)])
    ->  look_if_last(Queue),
        serve(Work, Queue, Seconds)
    ;   timer_check,
        (   superfluous
        ->  look_if_work_waits(Queue)   % that work may have woken this worker
        ;   serve(Queue)
        )
    ).

serve(stop, _, _) :-
    !.
serve(Work, Queue, Seconds) :-
    (   blocked_kind(_),
        blocked_held(Work)
    ->  true
    ;   work_do(Work, enqueue)
    ),
    serve(Queue, Seconds).

superfluous :-
    thread_self(Me),
    with_mutex(typhon_scheduler, superfluous(Me)).

superfluous(Me) :-
    run_queue(_),
    workers_count(Count),
    setting(min_workers, Min),
    Count > Min,
    retract(worker(Me)),
    thread_detach(Me),
    debug(typhon(scheduler), '~w ends, of ~D workers', [Me, Count]).

%   Thread becomes a worker for a while, and no other thread joins it.

typhon_time:adopt(real, Thread) :-
    with_mutex(typhon_scheduler, adopt(Thread)).

adopt(Thread) :-
    (   run_queue(_)
    ->  assertz(worker(Thread))
    ;   thread_detach(Thread)
    ).

typhon_time:leave(real) :-
    thread_self(Me),
    with_mutex(typhon_scheduler, leave(Me)).

leave(Me) :-
    (   run_queue(_),
        retract(worker(Me))
    ->  prolog_listen(this_thread_exit, thread_detach(Me))
                                        % an abort is not reported then
    ;   true                            % stopping the pool joins it
    ).

                /*******************************
                *            GROWTH            *
                *******************************/

%   Called when a worker has taken work, or ends.  Work that was queued while a
%   worker was idle may find no idle worker when its turn comes.

look_if_last(Queue) :-
    (   message_queue_property(Queue, size(0))
    ->  true
    ;   message_queue_property(Queue, waiting(_))
    ->  true
    ;   look_soon
    ).

look_if_work_waits(Queue) :-
    (   waits(Queue)
    ->  look_soon
    ;   true
    ).

%   Only one such alarm is set at a time. get_flag/2 comes first, because a
%   write to a flag takes a system mutex.

look_soon :-
    (   get_flag(typhon_pool_looks, 1)
    ->  true
    ;   setting(stuck_seconds, Seconds),
        look_in(Seconds)
    ).

look_in(Seconds) :-
    flag(typhon_pool_looks, Looks, 1),
    (   Looks =:= 0
    ->  monotonic_time(Now),
        alarm_in(Seconds, pool, stuck(Now))
    ;   true
    ).

typhon_scheduler:fire(pool, stuck(Since)) :-
    !,
    set_flag(typhon_pool_looks, 0),
    (   run_queue(Queue),
        waits(Queue)
    ->  with_mutex(typhon_scheduler, grow_if_stuck(Queue, Since, Seconds)),
        look_in(Seconds),
        release_later
    ;   true
    ).
typhon_scheduler:fire(pool, release) :-
    !,
    set_flag(typhon_pool_releases, 0),
    (   run_queue(Queue),
        mostly_free(Queue)
    ->  blocked_release(Works),
        maplist(enqueue, Works)
    ;   release_later
    ).

%   grow_if_stuck(+Queue, +Since, -Seconds): check again in Seconds.

grow_if_stuck(Queue, Since, Seconds) :-
    findall(Worker, worker(Worker), Workers),
    \+ turn_since(Workers, Since),
    \+ grow(Queue, Workers),
    !,
    setting(blocked_seconds, Blocked),
    Seconds is Blocked/4.
grow_if_stuck(_, _, Seconds) :-
    setting(stuck_seconds, Seconds).

turn_since(Workers, Since) :-
    member(Worker, Workers),
    turn_in(Worker, _, Began),
    Began > Since,
    !.

%   Fails when the pool is full, no thread can be created, or memory is short.

grow(Queue, Workers) :-
    run_queue(Queue),
    setting(max_workers, Max),
    blocked_room(Workers, Max, Room),
    length(Workers, Count),
    More is min(Room, 1+Count//8),
    More > 0,
    debug(typhon(scheduler), '~D workers, and ~D more', [Count, More]),
    forall(between(1, More, _), add_if_possible(Queue, Workers)).

add_if_possible(Queue, Workers) :-
    (   memory_short
    ->  Why = no_memory
    ;   catch(add_worker(Queue), error(resource_error(Why), _), true)
    ),
    (   var(Why)
    ->  true
    ;   blocked_full(Workers, Why),
        fail
    ).

%   Check again later while kinds of work are held.

release_later :-
    (   blocked_kind(_),
        flag(typhon_pool_releases, 0, 1)
    ->  setting(blocked_seconds, Seconds),
        alarm_in(Seconds, pool, release)
    ;   true
    ).

mostly_free(Queue) :-
    workers_count(Count),
    message_queue_property(Queue, waiting(Idle)),
    setting(max_workers, Max),
    Count-Idle < min(Max, (Count+1)//2).

                /*******************************
                *    WORKERS THAT GOALS BLOCK   *
                *******************************/

%   Workers call blocked_held/1, and the thread of the timer the others.

%   blocked_room(+Workers, +Max, -Room): the run queue is stuck, and all Workers
%   are busy: Room more workers may be added.  At most Max workers are not
%   blocked.

blocked_room(Workers, Max, Room) :-
    length(Workers, Count),
    (   Count < Max
    ->  Room is Max-Count,
        retractall(warned)
    ;   blocked(Workers, Blocked),
        limit(Count, Max, Blocked, Limit),
        length(Blocked, Apart),
        Room is min(Max-(Count-Apart), Limit-Count)
    ).

limit(Count, Max, Blocked, Limit) :-
    setting(blocked_workers, Most),
    (   Count < Most
    ->  Limit = Most,
        warn(Count, Blocked)
    ;   Limit is Most+Max,
        hold(Count, blocked_workers, Blocked)
    ).

blocked(Workers, Blocked) :-
    setting(blocked_seconds, Seconds),
    monotonic_time(Now),
    findall(What,
            ( member(Worker, Workers),
              turn_in(Worker, What, Since),
              Now-Since > Seconds ),
            Blocked).

warn(_, []) :-
    !.
warn(_, _) :-
    warned,
    !.
warn(Count, Blocked) :-
    assertz(warned),
    print_message(warning, typhon(workers_blocked(Count, Blocked))).

%   blocked_full(+Workers, +Why): the run queue is stuck, and no worker can be
%   added: hold work of the kinds that block.

blocked_full(Workers, Why) :-
    length(Workers, Count),
    blocked(Workers, Blocked),
    hold(Count, Why, Blocked).

hold(Count, Why, Blocked) :-
    findall(Kind,
            ( member(What, Blocked),
              kind_of(What, Kind),
              \+ blocked_kind(Kind) ),
            Kinds0),
    sort(Kinds0, Kinds),
    (   Kinds == []
    ->  true
    ;   forall(member(Kind, Kinds), assertz(blocked_kind(Kind))),
        print_message(warning, typhon(pool_full(Count, Why, Blocked)))
    ).

kind_of(What, Kind) :-
    (   kind(What, Kind0)
    ->  Kind = Kind0
    ;   Kind = goal(What)
    ).

%   blocked_held(+Work) is semidet: Work is of a kind that is held; keep it.

blocked_held(Work) :-
    work_of(Work, What),
    kind_of(What, Kind),
    with_mutex(typhon_blocked, keep(Kind, Work)).

work_of(agent(Agent), Agent).
work_of(agent(_, Agent), Agent).
work_of(goal(_:Goal), Name) :-
    functor(Goal, Name, _).

keep(Kind, Work) :-
    blocked_kind(Kind),
    !,
    assertz(held(Work)).

%   blocked_release(-Works): stop holding work. Works is the work that was held.

blocked_release(Works) :-
    with_mutex(typhon_blocked, release(Works)).

release(Works) :-
    retractall(blocked_kind(_)),
    findall(Work, held(Work), Works),
    retractall(held(_)).

blocked_forget :-
    blocked_release(_),
    retractall(warned).

                /*******************************
                *            TIMER             *
                *******************************/

%!  timer_start is det.

timer_start :-
    alarms_begin,
    announce(inf),
    server_start(timer, typhon_scheduler:timed, none, Timer),
    assertz(timer(Timer)).

%   timer_stop: stop the timer and delete all alarms.

timer_stop :-
    (   retract(timer(Timer))
    ->  server_stop(Timer)
    ;   true
    ),
    alarms_end.

%   timer_check: if the timer has been started, and has lost its thread, create
%   another.

timer_check :-
    (   timer(Timer)
    ->  server_check(Timer)
    ;   true
    ).

                /*******************************
                *            ALARMS            *
                *******************************/

%   timer_alarm(+Stamp, +Agent, +Token): set an alarm that calls fire(Agent,
%   Token) at Stamp, a monotonic_time/1.

timer_alarm(Stamp0, Agent, Token) :-
    Stamp is float(Stamp0),
    (   timer(Timer),
        alarm_add(Stamp, Agent, Token)
    ->  hasten(Stamp, Timer)
    ;   true
    ).

hasten(Stamp, Timer) :-
    (   urgent(Stamp)
    ->  ignore(server_cast(Timer, look))
    ;   server_check(Timer)
    ).

urgent(Stamp) :-
    get_flag(typhon_next, Next),
    Stamp < Next,
    !.
urgent(_) :-
    alarms_new(Count),
    Count > 500.

%   alarms_overdue: set off the alarms that were due while turns were paused.

alarms_overdue :-
    (   timer(Timer)
    ->  monotonic_time(Now),
        alarms_renew(Now),
        ignore(server_cast(Timer, look))
    ;   true
    ).

                /*******************************
                *           THE TIMER          *
                *******************************/

%   Only the wait of the timer is interrupted when Prolog halts: 9.0.4 reports
%   an exception that arrives in the middle of a predicate written in C, and
%   loses it.

timed(Message, Index, Next) :-
    sig_atomic(handled(Message, Index, Next)).

handled(begin, _, Next) :-
    index_make(Index),
    wait_for_next(Index, Next).
handled(timeout, Index0, Next) :-
    index_first(Index0, Stamp),
    alarms_if_due(Stamp, Index0, Index),
    wait_for_next(Index, Next).
handled(look, Index, Next) :-
    wait_for_next(Index, Next).
handled(call(count, Caller), Index, Next) :-
    index_size(Index, Size),
    server_answer(Caller, Size),
    wait_for_next(Index, Next).

wait_for_next(Index0, until(Stamp, Index)) :-
    index_update(Index0, Index1),
    index_first(Index1, First),
    announce(First),
    (   alarms_new(0)
    ->  Stamp = First,
        Index = Index1
    ;   wait_for_next(Index1, until(Stamp, Index))
    ).

announce(Stamp) :-
    Next is min(Stamp, 1.0e300),
    set_flag(typhon_next, Next).

alarms_if_due(Stamp, Index0, Index) :-
    monotonic_time(Now),
    Stamp =< Now,
    !,
    (   turns_paused
    ->  true                            % they go off after the pause
    ;   alarms_go_off(Stamp)
    ),
    index_delete(Index0, Stamp, Index).
alarms_if_due(_, Index, Index).

                /*******************************
                *       AGENTS AND TURNS       *
                *******************************/

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
    (   limited(_)                      % usually no host is
    ->  \+ limited(Here),
        \+ limited(There)
    ;   true
    ),
    time_kind(Kind),
    typhon_time:alone(Kind).

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

typhon_on_demand:worker_call(Goal) :-
    scheduler_call(Goal).

                /*******************************
                *            ALARMS            *
                *******************************/

%!  alarms_begin is det.

alarms_begin :-
    message_queue_create(New),
    assertz(new(New)).

%!  alarms_end is det.
%
%   Delete all alarms. No alarm can be added until alarms_begin/0.

alarms_end :-
    findall(New, new(New), Queues),
    retractall(new(_)),
    maplist(message_queue_destroy, Queues),
    retractall(alarm(_, _, _)).

%!  alarm_add(+Stamp, +Agent, +Token) is semidet.
%
%   Fails if this alarm is set already.

alarm_add(Stamp, Agent, Token) :-
    \+ alarm(Stamp, Agent, Token),
    new(New),
    !,
    assertz(alarm(Stamp, Agent, Token)),
    catch(thread_send_message(New, Stamp), error(existence_error(_, _), _),
          true).                        % the timer is stopping

%   alarms_renew(+Stamp): put the stamps of all alarms that are not later than
%   Stamp in the timer's queue again.

alarms_renew(Stamp) :-
    new(New),
    !,
    findall(Due, ( alarm(Due, _, _), Due =< Stamp ), Stamps),
    maplist(thread_send_message(New), Stamps).
alarms_renew(_).

%!  alarm_stamp(?Stamp, +Agent, ?Token) is nondet.

alarm_stamp(Stamp, Agent, Token) :-
    alarm(Stamp, Agent, Token).

%   alarms_new(-Count): Count stamps are in the queue, and the timer has not
%   read them yet.

alarms_new(Count) :-
    (   new(New)
    ->  fifo_size(New, Count)
    ;   Count = 0
    ).

%!  alarms_go_off(+Stamp) is det.
%
%   Call fire/2 for each alarm set to Stamp.  An alarm goes off exactly once,
%   even if signals arrive in the thread.

alarms_go_off(Stamp) :-
    findall(Alarm, clause(alarm(Stamp, _, _), true, Alarm), Alarms),
    maplist(go_off, Alarms).

go_off(Alarm) :-
    sig_atomic(( alarm_take(Alarm, Agent, Token)
               ->  debug(typhon(scheduler), 'alarm ~p of ~p', [Token, Agent]),
                   catch(ignore(typhon_scheduler:fire(Agent, Token)), Ball,
                         print_message(error, typhon(alarm(Ball))))
               ;   true
               )).

alarm_take(Alarm, Agent, Token) :-
    clause(alarm(_, Agent, Token), true, Alarm),
    catch(erase(Alarm), error(existence_error(_, _), _), fail).

                /*******************************
                *           THE INDEX          *
                *******************************/

%!  index_make(-Index) is det.
%
%   Delete obsolete alarms, and make an index of the others.

index_make(Index) :-
    alarms_thin,
    predicate_property(alarm(_, _, _), number_of_clauses(Count)),
    More is max(500, Count),
    current_prolog_flag(stack_limit, Bytes),
    Space is Bytes//512-Count,
    (   Space > 0
    ->  tree(Stamps),
        Left is min(Space, More),
        Index = index(Stamps, Left)
    ;   print_message(warning, typhon(no_index(Count))),
        alarm_least(Stamp),
        Index = least(Stamp, More)
    ).

tree(Stamps) :-
    findall(Stamp, alarm(Stamp, _, _), List),
    sort(List, Set),
    pairs_keys_values(Pairs, Set, Set),
    ord_list_to_rbtree(Pairs, Stamps).

alarms_thin :-
    forall(clause(alarm(_, Agent, Token), true, Alarm),
           forget_if_over(Alarm, Agent, Token)).

forget_if_over(Alarm, Agent, Token) :-
    (   catch(typhon_scheduler:over(Agent, Token), error(_, _), fail)
    ->  catch(erase(Alarm), error(existence_error(_, _), _), true)
    ;   true
    ).

%   Stamp is the least stamp, or `inf`. There may be a million stamps, so this
%   makes no list of them.

alarm_least(Stamp) :-
    Least = least(inf),
    forall(( alarm(Stamp0, _, _), arg(1, Least, Stamp1), Stamp0 < Stamp1 ),
           nb_setarg(1, Least, Stamp0)),
    arg(1, Least, Stamp).

%!  index_update(+Index0, -Index) is det.
%
%   Index is Index0 with the stamps of new alarms, which are taken from their
%   queue.

index_update(Index0, Index) :-
    (   new(New),
        thread_peek_message(New, _)
    ->  thread_get_message(New, Stamp),
        index_insert(Index0, Stamp, Index1),
        index_update(Index1, Index)
    ;   Index = Index0
    ).

index_insert(Index0, _, Index) :-
    arg(2, Index0, 0),
    !,
    index_make(Index).
index_insert(least(Stamp0, Left0), Stamp1, least(Stamp, Left)) :-
    Left is Left0-1,
    Stamp is min(Stamp0, Stamp1).
index_insert(index(Stamps0, Left0), Stamp, index(Stamps, Left)) :-
    Left is Left0-1,
    rb_insert(Stamps0, Stamp, Stamp, Stamps).

%!  index_delete(+Index0, +Stamp, -Index) is det.

index_delete(least(_, Left), _, least(Stamp, Left)) :-
    alarm_least(Stamp).
index_delete(index(Stamps0, Left), Stamp, index(Stamps, Left)) :-
    (   rb_delete(Stamps0, Stamp, Stamps)
    ->  true
    ;   Stamps = Stamps0
    ).

%!  index_first(+Index, -Stamp) is det.
%
%   Stamp is the first stamp, or `inf` if the index is empty.

index_first(least(Stamp, _), Stamp).
index_first(index(Stamps, _), Stamp) :-
    (   rb_min(Stamps, First, _)
    ->  Stamp = First
    ;   Stamp = inf
    ).

%!  index_size(+Index, -Count) is det.

index_size(least(_, _), 1).
index_size(index(Stamps, _), Size) :-
    rb_size(Stamps, Size).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(alarm(Ball))) -->
    [ 'An alarm raised an error; other alarms are not affected', nl ],
    error_lines(Ball).
prolog:message(typhon(no_index(Count))) -->
    [ 'The timer has no memory for an index of ~D alarms, and is slow'-
      [Count] ].
prolog:message(typhon(workers_blocked(Count, Blocked))) -->
    { length(Blocked, Length) },
    [ 'Native goals block ~D of ~D workers; the pool grows beyond its maximum.'-
      [Length, Count], nl ],
    blocked_agents(Blocked).
prolog:message(typhon(pool_full(Count, Why, Blocked))) -->
    [ '~D workers are blocked or busy, and no more can be added (~w).'-
      [Count, Why], nl,
      'Agents of the programs that block wait until workers are free.'-[],
      nl ],
    blocked_agents(Blocked).

blocked_agents(Blocked) -->
    { length(First, 10),
      append(First, More, Blocked),
      !,
      length(More, Count)
    },
    [ 'Blocked: ~p and ~D more'-[First, Count] ].
blocked_agents(Blocked) -->
    [ 'Blocked: ~p'-[Blocked] ].
