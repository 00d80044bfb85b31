:- module(typhon_held,
          [ held_room/2,                % +Count, +Max
            held_full/1,                % +Why
            held_back/1,                % +Work
            held_review/3,              % +Count, +Max, -Works
            held_forget/0
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(worker_activity,
              [ census/1, census_begin/0, census_end/0, held_count/3,
                held_since/3, turn_of/2, work_doer/3 ]).

/** <module> What is done when workers are held

A native goal that blocks holds its worker; which goals do is not known
beforehand.  When all workers the pool may have are busy and the run queue
does not move, a census begins, see module `worker_activity`.  A worker that has not
come back for `held_seconds` is held.  The pool may grow beyond its maximum
by as many as are held, so there are workers for what does not block, and
a warning names the agents.

When there are `held_workers`, or no more threads can be made, the pool is
full.  Then it matters what kinds of work hold workers: agents of one
program are of one kind.  These kinds are held back until fewer workers are
held.  `max_workers` more can be made for the other kinds.

The census ends when few workers are held.

*Threading*: workers ask held_back/1.  The rest is for the timer's thread
alone.
*/

:- multifile
    typhon_scheduler:kind/2,            % Agent, Kind
    typhon_scheduler:running/1,         % Agent
    prolog:message//1.

:- setting(held_seconds, number, 1,
           "A worker that does one thing for longer is held").
:- setting(held_workers, positive_integer, 768,
           "When there are so many workers, what blocks is held back").

:- dynamic
    full/1,                     % Why there can be no more workers
    noted/0,                    % it is known what blocks
    blocking/1,                 % Kind: is held back
    back/1,                     % Work that is held back
    warned/0.                   % that the pool is beyond its maximum

%!  held_forget is det.

held_forget :-
    census_end,
    retractall(full(_)),
    retractall(noted),
    retractall(blocking(_)),
    retractall(back(_)),
    retractall(warned).

                /*******************************
                *          IS THERE ROOM       *
                *******************************/

%!  held_room(+Count, +Max) is semidet.
%
%   The run queue is stuck with Count workers.  There may be one more: so
%   many are held that Max others are not reached.

held_room(Count, Max) :-
    Count < Max,
    !.
held_room(Count, Max) :-
    census_begin,
    long_ago(Stamp),
    held_count(Count, Stamp, Held),
    Count-Held < Max,
    setting(held_workers, Most),
    (   Count < Most
    ->  warn(Count)
    ;   held_full(held_workers),
        noted,
        Count < Most+Max
    ).

long_ago(Stamp) :-
    setting(held_seconds, Seconds),
    get_time(Now),
    Stamp is Now-Seconds.

%!  held_full(+Why) is det.
%
%   There cannot be more workers.

held_full(Why) :-
    census_begin,
    (   full(_)
    ->  true
    ;   assertz(full(Why))
    ).

%!  held_review(+Count, +Max, -Works) is semidet.
%
%   From time to time: what blocks is held back when the pool is full, and
%   when few workers are held, Works that were held back may be done, and
%   the census ends.  Fails when there is none any more.

held_review(Count, Max, Works) :-
    census(Began),
    long_ago(Stamp),
    held_count(Count, Stamp, Held),
    debug(typhon(scheduler), '~D of ~D workers are held', [Held, Count]),
    (   Began < Stamp,
        few(Count, Held, Max)
    ->  let_go(Works),
        census_end
    ;   Works = [],
        full(Why)
    ->  hold_back(Count, Why, Stamp)
    ;   Works = []
    ).

%   The pool is far from full.

few(Count, Held, Max) :-
    full(_),
    !,
    Held < Count//2,
    Held < Max.
few(_, Held, Max) :-
    Held < Max//2.

let_go(Works) :-
    retractall(warned),
    with_mutex(typhon_held,
               ( retractall(full(_)),
                 retractall(noted),
                 retractall(blocking(_)),
                 findall(Work, back(Work), Works),
                 retractall(back(_)) )).

hold_back(Count, Why, Stamp) :-
    findall(Kind, ( doer(Stamp, Type, What), kind(Type, What, Kind) ),
            Kinds0),
    sort(Kinds0, Kinds),
    findall(Kind, blocking(Kind), Old),
    subtract(Kinds, Old, New),
    forall(member(Kind, New), assertz(blocking(Kind))),
    (   noted
    ->  true
    ;   assertz(noted)
    ),
    (   New == []
    ->  true
    ;   doers(Doers),
        print_message(warning, typhon(held_full(Count, Why, Doers)))
    ).

kind(agent, Agent, Kind) :-
    typhon_scheduler:kind(Agent, Kind),
    !.
kind(goal, Goal, goal(Goal)).

%   doer(+Stamp, ?Type, ?What): it holds a worker since before Stamp.  What
%   began before the census is not on record, but agents that run are known.

doer(Stamp, Type, What) :-
    held_since(Stamp, Type, What).
doer(_, agent, Agent) :-
    typhon_scheduler:running(Agent),
    \+ turn_of(agent, Agent).

warn(_) :-
    warned,
    !.
warn(Count) :-
    assertz(warned),
    doers(Doers),
    print_message(warning, typhon(held(Count, Doers))).

doers(Doers) :-
    long_ago(Stamp),
    findall(What, doer(Stamp, _, What), Doers).

                /*******************************
                *           HELD BACK          *
                *******************************/

%!  held_back(+Work) is semidet.
%
%   Work is of a kind that blocks, at a time when there is no worker for
%   such: it is put back.

held_back(Work) :-
    blocking(_),
    work_doer(Work, Type, What),
    kind(Type, What, Kind),
    with_mutex(typhon_held, put_back(Kind, Work)).

put_back(Kind, Work) :-
    blocking(Kind),
    !,
    assertz(back(Work)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(held(Count, Doers))) -->
    [ 'All ~D workers are held by what blocks; there are more now.'-[Count],
      nl ],
    doers(Doers).
prolog:message(typhon(held_full(Count, Why, Doers))) -->
    [ '~D workers are held or busy, and there cannot be more (~w).'-
      [Count, Why], nl,
      'The like of what blocks waits until some have come back.'-[], nl ],
    doers(Doers).

doers(Doers) -->
    { length(First, 10),
      append(First, More, Doers),
      !,
      length(More, Count)
    },
    [ 'It is ~p and ~D more'-[First, Count] ].
doers(Doers) -->
    [ 'It is ~p'-[Doers] ].
