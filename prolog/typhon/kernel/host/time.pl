:- module(typhon_time,
          [ time_start/1,               % +Kind
            time_stop/0,
            time_kind/1,                % ?Kind
            time_now/1,                 % -Stamp
            time_work/1,                % +Work
            time_alone/0,
            time_here/1,                % +Agent
            time_wait/3,                % +Queue, -Message, +Stamp
            time_signal/1,              % :Goal
            time_seed/1,                % +Seed
            time_hold/1,                % +Seconds
            time_stands/1,              % -Standing
            time_let_go/1,              % -Agents
            time_due/3,                 % +Agent, +Token, -Stamp
            time_again/2,               % +Standing, -Agents
            alarm_set/3,                % +Stamp, +Agent, +Token
            alarm_in/3                  % +Seconds, +Agent, +Token
          ]).
:- use_module(pool,
              [ pool_here/1, pool_idle/0, pool_signal/1, pool_start/0,
                pool_stop/0, pool_work/1 ]).
:- use_module(alarms, [alarm_stamp/3]).
:- use_module(pause, [still_begin/0, still_end/1]).
:- use_module(timer, [alarm_set/3 as timer_set, alarms_overdue/0]).
:- use_module(virtual,
              [ virtual_again/2, virtual_alarm/3, virtual_hold/1,
                virtual_let_go/0, virtual_signal/1, virtual_stands/1,
                virtual_start/0, virtual_stop/0, virtual_wait/3,
                virtual_work/1 ]).
:- use_module(virtual_loop, [virtual_alone/0, virtual_now/1]).

/** <module> The kinds of time

Work, alarms and waiting callers are
served in one of two ways:

  | real    | by a pool of threads, when the time of day has come: module pool |
  | virtual | by one thread, as quick as it can; time jumps: module virtual   |

A process has one kind of time for as long as it has hosts.  Stamps are
seconds: those of the time of day, or those since virtual time began.

*Threading*: any thread; time_start/1 and time_stop/0 are called by one at a
time.
*/

:- meta_predicate time_signal(0).

:- dynamic time_kind/1.                 % real or virtual: while it runs

%!  time_kind(?Kind) is semidet.
%
%   Time runs, and is of that Kind.

%!  time_start(+Kind) is det.
%!  time_stop is det.
%
%   Nothing to do where it runs already, or not.

time_start(Kind) :-
    time_kind(Kind),
    !.
time_start(Kind) :-
    start(Kind),
    assertz(time_kind(Kind)).

time_stop :-
    (   retract(time_kind(Kind))
    ->  stop(Kind)
    ;   true
    ).

start(real)    :- pool_start.
start(virtual) :- virtual_start.

stop(real)    :- pool_stop.
stop(virtual) :- virtual_stop.

%!  time_now(-Stamp:float) is det.

time_now(Stamp) :-
    time_kind(virtual),
    !,
    virtual_now(Stamp).
time_now(Stamp) :-
    get_time(Stamp).

%!  time_seed(+Seed:integer) is det.
%
%   Where one thread does all work, what it draws by library(random) follows
%   from Seed.

time_seed(Seed) :-
    time_kind(Kind),
    seed(Kind, Seed).

seed(real, _).
seed(virtual, Seed) :- virtual_work(goal(set_random(seed(Seed)))).

%!  time_hold(+Seconds) is semidet.
%!  time_stands(-Standing) is det.
%!  time_let_go(-Agents:list) is det.
%!  time_again(+Standing, -Agents:list) is det.
%
%   No agent gets a turn any more, and no alarm goes off; fails if that cannot be
%   had in Seconds of the time of day.  In virtual time that is at once so, and
%   Standing all that time knows of what comes next.  It goes on, which is to be
%   said in either case: Agents have missed their turn.  What comes next is as
%   Standing says; Agents have their turns.

time_hold(Seconds) :-
    time_kind(Kind),
    hold(Kind, Seconds).

hold(virtual, Seconds) :- virtual_hold(Seconds).
hold(real, _)          :- still_begin.

time_stands(Standing) :-
    time_kind(Kind),
    stands(Kind, Standing).

stands(virtual, Standing) :- virtual_stands(Standing).
stands(real, real).

time_let_go(Agents) :-
    (   time_kind(Kind)
    ->  let_go(Kind, Agents)
    ;   Agents = [],
        still_end(_)                    % it has ended meanwhile
    ).

let_go(virtual, []) :-
    virtual_let_go.
let_go(real, Agents) :-
    still_end(Agents),
    alarms_overdue.

time_again(Standing, Agents) :-
    (   Standing == real
    ->  Agents = []
    ;   virtual_again(Standing, Agents)
    ).

%!  time_due(+Agent, +Token, -Stamp) is semidet.
%
%   In real time, when the alarm goes off.

time_due(Agent, Token, Stamp) :-
    time_kind(real),
    alarm_stamp(Stamp, Agent, Token),
    !.

%!  time_work(+Work) is det.
%
%   Work, see module `work`, is done some time soon.

time_work(Work) :-
    time_kind(Kind),
    !,
    work(Kind, Work).
time_work(_).                           % stopping

work(real, Work)    :- pool_work(Work).
work(virtual, Work) :- virtual_work(Work).

%!  time_alone is semidet.
%
%   Nothing else waits to be done: the thread may go on.

time_alone :-
    time_kind(Kind),
    alone(Kind).

alone(real)    :- pool_idle.
alone(virtual) :- virtual_alone.

%!  time_here(+Agent) is semidet.
%
%   Run Agent in this thread, which has other things to do, too; fails
%   where it is to be done by workers.

time_here(Agent) :-
    time_kind(real),
    pool_here(Agent).

%!  alarm_set(+Stamp, +Agent, +Token) is det.
%!  alarm_in(+Seconds, +Agent, +Token) is det.
%
%   Have fire(Agent, Token) called at Stamp, or in Seconds.

alarm_set(Stamp, Agent, Token) :-
    time_kind(Kind),
    !,
    alarm_set(Kind, Stamp, Agent, Token).
alarm_set(_, _, _).

alarm_in(Seconds, Agent, Token) :-
    time_now(Now),
    Stamp is Now+Seconds,
    alarm_set(Stamp, Agent, Token).

alarm_set(real, Stamp, Agent, Token)    :- timer_set(Stamp, Agent, Token).
alarm_set(virtual, Stamp, Agent, Token) :- virtual_alarm(Stamp, Agent, Token).

%!  time_wait(+Queue, -Message, +Stamp) is semidet.
%
%   Take the first Message of Queue, from which no other thread takes.  Fails if
%   there is none before Stamp, a number or `inf`.

time_wait(Queue, Message, Stamp) :-
    time_kind(virtual),
    !,
    virtual_wait(Queue, Message, Stamp).
time_wait(Queue, Message, inf) :-
    !,
    thread_get_message(Queue, Message).
time_wait(Queue, Message, Stamp) :-
    thread_get_message(Queue, Message, [deadline(Stamp)]).

%!  time_signal(:Goal) is det.
%
%   Run Goal in all threads that do work, in the middle of whatever they do.

time_signal(Goal) :-
    time_kind(Kind),
    !,
    signal(Kind, Goal).
time_signal(_).

signal(real, Goal)    :- pool_signal(Goal).
signal(virtual, Goal) :- virtual_signal(Goal).
